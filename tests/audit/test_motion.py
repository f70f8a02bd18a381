"""Bounds of computed motions hold the motion and its derivatives."""

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, simulate
from lcpstep.audit.pieces import moved
from lcpstep.audit.polynomials import by_steps, derivatives, through
from lcpstep.model import model

RNG = np.random.default_rng(11)
FORCE = Harmonic(constant=0.3, cosine=0.5, sine=-0.2, omega=3.0)


@pytest.mark.parametrize(
    ("c", "k", "force"),
    [
        (0.0, 0.0, Harmonic(constant=-1.0)), (0.0, 8.0, FORCE), (0.4, 9.0, FORCE), (8.0, 9.0, FORCE),
        (6.0, 9.0, FORCE),
        (0.5, 0.0, FORCE), (0.2, -1.0, FORCE), (-0.1, 4.0, FORCE), (0.0, 4.0, None),
    ],
)  # fmt: skip
def test_closed_forms_lie_within_their_bounds(c, k, force):
    scene = Scene(
        system=LinearSystem(M=1.0, C=c, K=k, force=force), contacts=LinearContacts(G=1.0, offset=50.0),
        q0=1.0, v0=-0.7, t_span=(0.0, 4.0),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    motion, t, _, _ = moved(m, model(scene))
    rows = RNG.integers(0, len(t) - 1, 60)
    h = np.diff(t)[rows]
    a = t[rows] + h * RNG.uniform(0.0, 0.5, 60)
    b = a + h * 10.0 ** RNG.uniform(-6.0, np.log10(0.5), 60)
    G = np.full((60, 1), 2.0)
    bounds, at_a, at_b = motion.along(G, rows, a, b)
    np.testing.assert_allclose([at_a, at_b], [2.0 * m.at(x)[0][:, 0] for x in (a, b)], rtol=0, atol=1e-11)
    for share in np.linspace(0.0, 1.0, 21):
        times = a + share * (b - a)
        q, v = m.at(times)
        f = (
            0.0
            if force is None
            else force.constant + force.cosine * np.cos(3.0 * times) * (force.omega == 3.0)
        )
        f = f + (0.0 if force is None else force.sine * np.sin(3.0 * times))
        acceleration = f - c * v[:, 0] - k * q[:, 0]
        for bound, true in zip(bounds, (q[:, 0], v[:, 0], acceleration), strict=True):
            assert np.all(bound.lo <= 2.0 * true + 1e-11)
            assert np.all(2.0 * true - 1e-11 <= bound.hi)
    narrow = b - a < 1e-4 * h
    assert np.all((bounds.curve.hi - bounds.curve.lo)[narrow] < 0.1)


def test_dense_output_lies_within_the_bounds_of_its_polynomials():
    m = simulate(scenes.double_pendulum(t_end=1.0), EventDriven())
    s, F = m.dense.s, m.dense.F
    motion = by_steps(s.t, s.q, F[:-1], s.length[:-1])
    rows = np.flatnonzero(np.diff(s.t) > 0.0)
    boxes, q_a, q_b = motion.boxes(rows, s.t[rows], s.t[rows + 1])
    np.testing.assert_allclose(q_a, s.q[rows], rtol=0, atol=1e-12)
    np.testing.assert_allclose(q_b, s.q[rows + 1], rtol=0, atol=1e-10)
    for share in np.linspace(0.01, 0.99, 15):
        q, v = m.at(s.t[rows] + share * np.diff(s.t)[rows])
        for i, box in enumerate(boxes):
            assert np.all((box.place.lo <= q[:, i]) & (q[:, i] <= box.place.hi))
            assert np.all((box.speed.lo - 1e-8 <= v[:, i]) & (v[:, i] <= box.speed.hi + 1e-8))


def test_a_polynomial_is_found_through_its_values():
    t = np.array([1.0, 3.0])
    p = np.polynomial.Polynomial([0.5, -1.0, 2.0, 0.3, -0.7])
    q, v = p(t)[:, None], p.deriv()(t)[:, None]
    motion = through(t, q, v, p(1.0 + 2.0 * np.array([0.25, 0.5, 0.75]))[None, :, None])
    x = motion.windows(np.array([0]), np.array([1.5]), np.array([2.5]))[:, :, 0]
    bounds = derivatives(x, np.array([1.0]))
    times = np.linspace(1.5, 2.5, 101)
    for k, bound in enumerate(bounds):
        values = p.deriv(k)(times)
        assert bound.lo[0] <= values.min()
        assert values.max() <= bound.hi[0]
        assert bound.hi[0] - bound.lo[0] < 3.0 * np.ptp(values) + 1e-9
