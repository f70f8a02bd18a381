"""Distance of two bifurcation diagrams: against exact transport, and as the step of time-stepping goes down."""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from lagrangian.scenes import cam_follower
from lcpstep import Moreau
from lcpstep.analysis.agreement import (
    agreement,
    circle_distance,
    summary,
    tolerance_of_stepping,
)
from lcpstep.analysis.bifurcation import bifurcation

pytest.importorskip("xarray")
SETTINGS = {"drop": 200, "keep": 20}


def transported(a, b):
    """Least mean distance on the circle over all matchings of samples of one length."""
    apart = np.abs(a[:, None] - b[None, :])
    cost = np.minimum(apart, 1.0 - apart)
    i, j = linear_sum_assignment(cost)
    return np.mean(cost[i, j])


@pytest.mark.parametrize("seed", range(5))
def test_distances_are_those_of_optimal_transport(seed):
    random = np.random.default_rng(seed)
    n = 12
    x, y = random.uniform(size=n), (0.9 + 0.3 * random.uniform(size=n)) % 1.0
    assert circle_distance(x, y) == pytest.approx(transported(x, y), rel=1e-9)
    turned = circle_distance((x + 0.37) % 1.0, (y + 0.37) % 1.0)
    assert turned == pytest.approx(circle_distance(x, y), rel=1e-9)
    assert circle_distance(np.repeat(x, 3), y) == pytest.approx(circle_distance(x, y), rel=1e-9)


def test_points_on_either_side_of_the_cut_are_near():
    assert circle_distance(np.array([0.99]), np.array([0.02])) == pytest.approx(0.03)
    assert circle_distance(np.zeros(0), np.zeros(0)) == 0.0
    assert circle_distance(np.zeros(0), np.array([0.5])) == np.inf


def diagram(speeds, method=None, **more):
    return bifurcation(cam_follower, "rpm", speeds, method=method, **(SETTINGS | more))


def distances(speeds, steps, **more):
    exact = diagram(speeds, **more)
    found = []
    for h in steps:
        stepped = diagram(speeds, Moreau(h=h), **more)
        found.append(summary(agreement(stepped, exact, tolerance_of_stepping(h, 60.0 / speeds))))
    return found


@pytest.mark.slow
def test_a_diagram_of_time_stepping_approaches_the_event_driven_one_with_order_one():
    steps = np.array([8e-4, 2e-4, 5e-5])
    found = distances(np.linspace(690.0, 735.0, 10), steps)  # O(1, 1), stable throughout
    for name in ("phase", "state"):
        order = np.polyfit(np.log(steps), np.log([getattr(x, name) for x in found]), 1)[0]
        assert order == pytest.approx(1.0, abs=0.3)
    assert found[-1].same == 1.0
    assert found[-1].phase_floor < 1e-12  # a periodic motion repeats


@pytest.mark.slow
def test_chaotic_columns_come_as_near_as_samples_of_one_motion():
    found = distances(np.linspace(662.0, 668.0, 4), (1e-3, 5e-5), keep=400)
    assert found[0].phase > 3.0 * found[0].phase_floor
    assert found[1].phase < 2.0 * found[1].phase_floor
    assert found[1].same == 1.0  # aperiodic by both


def test_a_diagram_agrees_with_itself_and_refuses_one_of_other_values():
    speeds = np.linspace(690.0, 735.0, 3)
    one = diagram(speeds)
    itself = agreement(one, one)
    assert np.all(itself["same"])
    assert np.all(itself["phase_distance"] == 0.0)
    assert itself["name"].values.tolist() == ["O(1, 1)"] * 3
    with pytest.raises(ValueError, match="data: expected the values of rpm"):
        agreement(diagram(speeds + 1.0), one)
    with pytest.raises(ValueError, match="data: expected keep = 20, got 10"):
        agreement(diagram(speeds, keep=10), one)
    with pytest.raises(ValueError, match="tolerance"):
        agreement(one, one, 0.0)
