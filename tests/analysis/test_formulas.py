"""Maps given by formulas, against what is known of them: exponents, cascades, border collisions, period adding."""

import json
import math

import numpy as np
import pytest

from lcpstep.analysis.border_collision import PiecewiseLinearMap, classify
from lcpstep.analysis.continuation import continue_point
from lcpstep.analysis.derivative import differences
from lcpstep.analysis.fixed_points import periodic_point
from lcpstep.analysis.map_diagram import exponent, map_diagram, periodic_points, settled
from lcpstep.cli.common import DONE
from lcpstep.errors import LcpStepError
from lcpstep.maps.formulas import MAPS, piecewise_linear
from tests.commands import run_map

LOGISTIC, NORMAL_FORM, GRAZING = MAPS["logistic"], MAPS["border-collision"], MAPS["grazing"]


# --- the logistic map


def test_its_exponent_at_four_is_the_logarithm_of_two():
    found = exponent(LOGISTIC.at(r=4.0), [0.3], 30_000)
    assert found.largest == pytest.approx(math.log(2.0), abs=4.0 * found.error)
    assert found.error < 5e-3
    assert found.chaotic


@pytest.mark.parametrize("r", [3.1, 3.2, 3.4])
def test_its_period_two_and_multiplier_are_those_in_closed_form(r):
    root = math.sqrt((r - 3.0) * (r + 1.0))
    points = [(r + 1.0 - root) / (2.0 * r), (r + 1.0 + root) / (2.0 * r)]
    (found,) = periodic_points(LOGISTIC.at(r=r), [[-0.5], [1.5]], 2)
    assert np.sort(found.points[:, 0]) == pytest.approx(points, abs=2e-11)  # Newton's residual is 1e-11
    multiplier = 4.0 + 2.0 * r - r * r
    assert found.multipliers[0].real == pytest.approx(multiplier, abs=1e-9)
    assert exponent(LOGISTIC.at(r=r), found.points[0], 1, 2).largest == pytest.approx(
        0.5 * math.log(abs(multiplier)), abs=1e-8
    )


def test_its_periods_double_at_three_and_at_one_plus_the_root_of_six():
    def family(r):
        return LOGISTIC.at(r=r)

    one = continue_point(family, [0.6], 2.5, (2.2, 3.4))
    assert [s.p for s in one.of_kind("flip")] == pytest.approx([3.0], abs=1e-10)
    two = continue_point(family, [0.513], 3.2, (3.1, 3.6), n=2)
    assert [s.p for s in two.of_kind("flip")] == pytest.approx([1.0 + math.sqrt(6.0)], abs=1e-9)


@pytest.mark.slow
def test_its_period_three_is_born_at_one_plus_the_root_of_eight():
    born = 1.0 + math.sqrt(8.0)
    assert periodic_points(LOGISTIC.at(r=born - 1e-3), [[0.0], [1.0]], 3) == []
    assert len(periodic_points(LOGISTIC.at(r=born + 1e-3), [[0.0], [1.0]], 3)) == 2


def test_its_diagram_has_exponents_and_goes_on_where_it_was_interrupted(tmp_path):
    values = np.linspace(2.9, 4.0, 40)
    seen = []

    def stop(done, total):
        seen.append(done)
        if done:  # one at least: two may end at once
            raise LcpStepError("stopped")

    with pytest.raises(LcpStepError, match="stopped"):
        map_diagram(LOGISTIC, "r", values, drop=200, keep=100, jobs=1, out=tmp_path, progress=stop)
    data = map_diagram(LOGISTIC, "r", values, drop=200, keep=100, jobs=1, out=tmp_path)
    whole = map_diagram(LOGISTIC, "r", values, drop=200, keep=100)
    assert np.array_equal(data["x"].values, whole["x"].values)
    assert data["lyapunov"].values[-1] == pytest.approx(math.log(2.0), abs=0.1)
    period_one = values < 3.0 - 1e-9
    expected = np.log(np.abs(2.0 - values[period_one]))
    assert data["lyapunov"].values[period_one] == pytest.approx(expected, abs=1e-2)


# --- piecewise-linear maps


@pytest.mark.parametrize(
    ("values", "verdict", "fixed_below", "fixed_above"),
    [
        ((0.3, 0.2, -0.6, 0.3), "persistence", ["minus"], ["plus"]),
        ((1.6, 0.5, 0.2, 0.3), "nonsmooth fold", [], ["minus", "plus"]),
        ((0.4, 0.3, -1.6, 0.3), "persistence, with a period-two orbit", ["minus"], ["plus"]),
    ],
)
def test_border_collisions_of_the_normal_form_have_known_verdicts(
    capsys, values, verdict, fixed_below, fixed_above
):
    settings = [
        f"{name}={x}"
        for name, x in zip(("tau_minus", "delta_minus", "tau_plus", "delta_plus"), values, strict=True)
    ]
    status, out, _ = run_map(capsys, "border-collision", "--set", *settings, "--json")
    assert status == DONE
    found = json.loads(out)["border_collision"]
    assert found["verdict"] == verdict
    # x = m/(1 - tau + delta) has x1 < 0 or > 0, on its own side or not
    for name, sign, expected in (("m < 0", -1.0, fixed_below), ("m > 0", 1.0, fixed_above)):
        sides = [
            side
            for side, (tau, delta), own in (("minus", values[:2], -1.0), ("plus", values[2:], 1.0))
            if own * sign / (1.0 - tau + delta) > 0.0
        ]
        assert found["fixed_points"][name] == sides
        assert sides == expected or verdict == "nonsmooth fold"


def test_own_matrices_give_the_same_as_the_normal_form(capsys):
    matrices = [
        "--A-minus",
        "0.4",
        "1",
        "-0.3",
        "0",
        "--A-plus",
        "-1.6",
        "1",
        "-0.3",
        "0",
        "--B-minus",
        "1",
        "0",
        "--B-plus",
        "1",
        "0",
        "--C",
        "1",
        "0",
    ]
    own = json.loads(run_map(capsys, "piecewise-linear", *matrices, "--json")[1])
    ready = json.loads(run_map(capsys, "border-collision", "--json")[1])
    for name in ("orbit", "points", "lyapunov", "periodic", "border_collision"):
        assert own[name] == ready[name]


@pytest.mark.slow
def test_fixed_points_of_piecewise_linear_maps_solve_their_equations():
    random = np.random.default_rng(5)
    for _ in range(20):
        A, E = random.uniform(-1.2, 1.2, (3, 3)), random.uniform(-1.0, 1.0, 3)
        C, D, B = random.uniform(-1.0, 1.0, 3), 0.3, random.uniform(-1.0, 1.0, 3)
        family = piecewise_linear(A, A + np.outer(E, C), B, B + E * D, C, D)
        P = family.at(m=0.7)
        found = periodic_points(P, [[-20.0] * 3, [20.0] * 3], 1, starts=60)
        collision = classify(PiecewiseLinearMap(**family.border(family.parameters)))
        known = [x for x, exists in ((collision.fixed.minus, collision.fixed.minus_exists[1]),
                                     (collision.fixed.plus, collision.fixed.plus_exists[1])) if exists]  # fmt: skip
        near = [x for x in known if np.max(np.abs(x)) < 20.0]
        for x in near:
            assert min(np.max(np.abs(point.points[0] - 0.7 * x)) for point in found) < 1e-9
        x = random.uniform(-1.0, 1.0, 3)
        np.testing.assert_allclose(P.jacobian(x), differences(P, x, 1e-6), atol=1e-8)


# --- the grazing normal form


def window(alpha, m):
    """Stable orbit of period m with one point right of zero: where it flips, and where its last point comes to zero.

    s^2 = rho (1 - alpha^m)/(1 - alpha) - alpha^(m-1) s with x1 = s^2: the flip at 2 s = alpha^(m-1), the border at
    s^2 = rho.
    """
    flip = 0.75 * alpha ** (2 * m - 2) * (1.0 - alpha) / (1.0 - alpha**m)
    border = (alpha ** (m - 2) * (1.0 - alpha) / (1.0 - alpha ** (m - 1))) ** 2
    return flip, border


@pytest.mark.parametrize("alpha", [0.15, 0.2])
@pytest.mark.parametrize("m", [2, 3, 4, 5])
def test_the_square_root_map_adds_periods(alpha, m):
    flip, border = window(alpha, m)
    for rho in (flip + 0.02 * (border - flip), 0.5 * (flip + border), border - 0.02 * (border - flip)):
        s = 0.5 * (
            -(alpha ** (m - 1))
            + math.sqrt(alpha ** (2 * m - 2) + 4.0 * rho * (1.0 - alpha**m) / (1.0 - alpha))
        )
        point = periodic_point(GRAZING.at(alpha=alpha, rho=rho), [s * s, 0.0], m)
        assert np.sum(point.points[:, 0] > 0.0) == 1
        assert point.points[0, 0] == pytest.approx(s * s, rel=1e-9)
        assert point.multipliers[0].real == pytest.approx(-(alpha ** (m - 1)) / (2.0 * s), rel=1e-8)
        assert point.stable


def test_the_attractor_of_the_square_root_map_goes_from_one_period_to_the_next():
    alpha = 0.2
    for m in (2, 3, 4):
        next_border = window(alpha, m + 1)[1]
        orbit = settled(GRAZING.at(alpha=alpha, rho=1.02 * next_border), [0.0, 0.0], 2000, 4 * m)
        assert np.max(np.abs(orbit[m:] - orbit[:-m])) < 1e-9


def test_the_derivative_of_the_grazing_map_is_that_of_its_differences():
    P = GRAZING.at(alpha=0.4, gamma=0.3, tau=0.7, rho=0.1)
    for x in ([0.5, -0.2], [-0.3, 0.4], [2.0, 1.0]):
        np.testing.assert_allclose(P.jacobian(np.array(x)), differences(P, x), atol=1e-9)


# --- maps of ones own


@pytest.mark.parametrize(
    ("n", "known"),
    [
        (1, 2),
        (2, 1),
        *(pytest.param(*x, marks=pytest.mark.slow) for x in [(3, 0), (4, 1), (5, 0), (6, 2), (7, 4)]),
    ],
)
def test_the_map_of_henon_has_as_many_cycles_as_are_known(n, known):
    """O. Biham, W. Wenzel, Physical Review Letters 63 (1989): all cycles at a = 1.4, b = 0.3."""

    def henon(x):
        return np.array([1.0 - 1.4 * x[0] ** 2 + x[1], 0.3 * x[0]])

    with np.errstate(over="ignore", invalid="ignore"):  # steps may lead far away
        found = periodic_points(henon, [[-2.0, -0.7], [2.0, 0.7]], n, starts=400)
    assert len(found) == known
    for point in found:
        assert henon(point.points[-1]) == pytest.approx(point.points[0], abs=1e-12)


def test_where_two_cycles_are_born_one_is_found_not_many_beside_it():
    found = periodic_points(LOGISTIC.at(r=1.0 + math.sqrt(8.0)), [[0.0], [1.0]], 3)
    assert len(found) == 1
    assert found[0].multipliers[0] == pytest.approx(1.0, abs=1e-5)  # half of the digits: it is a double root


def test_an_orbit_that_nears_a_periodic_one_slowly_is_not_called_aperiodic(capsys):
    """At r = 3.01 deviations from the period two shrink by 4 + 2 r - r^2 = 0.96 in two iterations."""
    _, out, _ = run_map(capsys, "logistic", "--set", "r=3.01", "--drop", 100)
    assert out.splitlines()[0].endswith(
        "unsettled, nearing a periodic orbit: 100 iterations dropped are too few (--drop)"
    )
    _, out, _ = run_map(capsys, "logistic", "--set", "r=3.01", "--drop", 3000)
    assert out.splitlines()[0].endswith(": period 2")
