"""What proofs are made of: jets, Krawczyk's operator, formulas of obstacles, enclosures of flights."""

import itertools
import math

import mpmath
import numpy as np
import pytest
from flint import arb, arb_mat, arb_series, ctx

from lagrangian import scenes
from lagrangian.profiles import Arc, CamProfile, rotating_cam
from lagrangian.scenes.cam_follower import PROFILE
from lcpstep.analysis.proofs import NotProved
from lcpstep.analysis.proofs.flights import Flight
from lcpstep.analysis.proofs.formulas import formulas
from lcpstep.analysis.proofs.jets import Jet, applied, exponential
from lcpstep.analysis.proofs.newton import improved, zero
from lcpstep.analysis.proofs.obstacles import above, below, stretch, stretches, turning_cam


@pytest.fixture(autouse=True)
def _precision():
    with ctx.workprec(128), mpmath.workdps(45):
        yield


def number(x):
    """The midpoint of a ball for mpmath."""
    return mpmath.mpf(x.mid().str(40, radius=False))


def test_jets_bear_first_and_mixed_derivatives():
    x, y = Jet([arb("0.7"), 1, 0, 0]), Jet([arb("1.3"), 0, 1, 0])
    z = (x * y + 2).through((x * y + 2).series().sin().coeffs()) * (3 - x) * y.inverse()

    def f(a, b):
        return mpmath.sin(a * b + 2) * (3 - a) / b

    at = mpmath.mpf("0.7"), mpmath.mpf("1.3")
    for part, order in enumerate([(0, 0), (1, 0), (0, 1), (1, 1)]):
        assert abs(number(z.c[part]) - mpmath.diff(f, at, order)) < 1e-30


def test_the_exponential_of_jets_has_the_derivatives_of_a_matrix_exponential():
    A, B = arb_mat([[0, 1], [-2, -0.5]]), arb_mat([[0.25, 0], [1, 0]])
    a, b = Jet([arb("0.8"), 1, 0, 0]), Jet([arb("0.3"), 0, 1, 0])
    parts = exponential([(a, A), (b, B)])
    P, Q = (mpmath.matrix([[float(X[i, j]) for j in range(2)] for i in range(2)]) for X in (A, B))
    at = mpmath.mpf("0.8"), mpmath.mpf("0.3")
    for i in range(2):
        for j in range(2):

            def entry(x, y, i=i, j=j):
                return mpmath.expm(x * P + y * Q)[i, j]

            for part, order in enumerate([(0, 0), (1, 0), (0, 1), (1, 1)]):
                assert abs(number(parts[part][i, j]) - mpmath.diff(entry, at, order)) < 1e-20


def test_a_derivative_that_may_be_zero_is_kept():
    A = arb_mat([[0, 1], [-1, 0]])
    found = applied(exponential([(Jet([1, arb(0, 1)]), A)]), [Jet([1, 0]), Jet([0, 0])])
    assert found[0].c[1].contains(-arb(1).sin())
    assert found[0].c[1].contains(arb(1).sin())


def test_keys_tell_jets_apart_to_the_last_bit():
    one, other = Jet([arb(1), arb(0, 1e-30)]), Jet([arb(1), arb(0, 2e-30)])
    assert one.key() == Jet([arb(1), arb(0, 1e-30)]).key()
    assert one.key() != other.key()
    assert Jet([arb("nan")]).key() == Jet([arb("inf")]).key()


def roots(c):
    return lambda x: [x[0] * x[0] - c]


def test_a_root_is_enclosed_and_is_the_only_one_within_its_radius():
    x = improved(roots(2), [arb(1.5)])
    found = zero(roots(2), x, [arb(1)], lambda box: True)
    assert found.balls[0].contains(arb(2).sqrt())
    assert found.balls[0].rad() < 1e-35
    assert 1e-2 < float(found.radii[0]) < 2.0 * math.sqrt(2.0)


@pytest.mark.parametrize("c", [0, -1])
def test_a_double_root_and_none_are_not_proved(c):
    with pytest.raises(NotProved):
        zero(roots(c), improved(roots(c), [arb(0.3)]), [arb(1)], lambda box: True)


def test_a_box_that_is_not_allowed_is_not_used():
    x = improved(roots(2), [arb(1.5)])
    found = zero(roots(2), x, [arb(1)], lambda box: bool(box[0].rad() < 1e-5))
    assert float(found.radii[0]) < 1e-5
    with pytest.raises(NotProved):
        zero(roots(2), x, [arb(1)], lambda box: False)


@pytest.mark.parametrize("x", [arb(0.1), arb(1) / 3, arb(-2.5, 1e-9), arb("1e-400"), arb(7)])
def test_floats_beside_a_ball_enclose_it(x):
    assert arb(below(x)) <= x
    assert arb(above(x)) >= x


ROUND = CamProfile((Arc(2.0 * math.pi, 0.1, 0.4, 0.5),), offset=0.2, symmetric=False)


@pytest.mark.parametrize("profile", [PROFILE, ROUND])
@pytest.mark.parametrize(
    ("multiple", "lead"), [(1, 0.0), (1, math.pi / 2.0), (3, -1.1), (-1, 0.7), (-2, 9.0)]
)
def test_the_cam_is_that_of_the_scene_at_every_phase_with_its_derivatives(profile, multiple, lead):
    p = profile.pack(float(multiple), lead)
    cam = turning_cam(p.tolist(), multiple)
    for phase in np.random.default_rng(1).uniform(-20.0, 20.0, 100):
        out = np.zeros((1, 3))
        rotating_cam(phase, out[0], out[0], p, out)
        piece = stretch(cam, phase)
        assert piece.start is None or piece.holds(arb(phase))
        series = [*piece.formula(arb_series([arb(phase), 1], prec=3)).coeffs(), arb(0), arb(0)]
        found = [float(series[0]), float(series[1]), 2.0 * float(series[2])]
        assert found == pytest.approx(out[0].tolist(), rel=1e-11, abs=1e-12)


def test_stretches_cover_a_flight_without_a_hole():
    cam = turning_cam(PROFILE.pack(1.0, math.pi / 2.0).tolist(), 1)
    ways = stretches(cam, 0.3, 13.0)
    assert len(ways) == 13  # six corners a turn
    assert float(ways[0].start) <= 0.3
    assert float(ways[-1].end) >= 13.0
    assert all(one.end.overlaps(other.start) for one, other in itertools.pairwise(ways))


@pytest.mark.parametrize("seed", range(4))
def test_the_gap_of_a_flight_lies_in_its_enclosure(seed):
    rng = np.random.default_rng(seed)
    w, zeta, a = rng.uniform(0.7, 3.0), rng.uniform(0.0, 0.4), rng.uniform(0.5, 2.0)
    f = formulas(scenes.impact_oscillator(zeta, w, a, 0.3))
    y0, v0 = rng.normal(), rng.normal()
    s = 1 / f.omega
    z = arb_mat(5, 1, [arb(y0), arb(v0) * s, 1, 1, 0])
    flight = Flight(f, f.A0 + s * f.A1 + s * s * f.A2, arb(0), z, arb(10), 0, 0)
    W, Z, C = mpmath.mpf(w), mpmath.mpf(2.0 * zeta) / 2, mpmath.mpf(a)
    amplitude = C / (1 - W**2 + 2j * Z * W)
    turn = mpmath.sqrt(1 - Z**2)
    c, d = y0 - amplitude.real, v0 - (1j * W * amplitude).real

    def gap(theta):
        t = theta / W
        free = mpmath.exp(-Z * t) * (c * mpmath.cos(turn * t) + (d + Z * c) / turn * mpmath.sin(turn * t))
        return mpmath.mpf(0.3) - free - (amplitude * mpmath.expj(W * t)).real

    way = stretch(f.contacts[0].obstacle, 0.0)
    for _ in range(20):
        start = rng.uniform(0.0, 9.0)
        end = start + 10.0 ** rng.uniform(-4.0, 0.0)
        _, over, rate = flight.gap(0, way, start, end)
        for theta in np.linspace(start, end, 7)[1:-1]:
            assert over.contains(arb(mpmath.nstr(gap(mpmath.mpf(theta)), 40)))
            assert rate.contains(arb(mpmath.nstr(mpmath.diff(gap, mpmath.mpf(theta)), 25)))
        if end - start < 1e-2:
            assert float(over.rad()) < 3.0 * (end - start)
