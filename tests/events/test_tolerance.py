"""Errors against tolerances: positions at any time are within ten, where the motion does not magnify more."""

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import EventDriven, Status, simulate

TIMES = 4001
SCENES = {
    "pendulum": scenes.pendulum_stop(form="angle"),
    "pendulum on a rod": scenes.pendulum_stop(form="rod"),
    "bowl": scenes.bowl(),
    "chain": scenes.elastic_chain(),
    "rocking block": scenes.rocking_block(),
    "double pendulum": scenes.double_pendulum(),
    "another double pendulum": scenes.double_pendulum(a=-0.8, b=-0.8, restitution=0.9),
    "slider-crank": scenes.slider_crank(mu=0.0),
    "slider-crank, longer": scenes.slider_crank(mu=0.0, t_end=0.1),
    "double pendulum of rods": scenes.double_pendulum(form="rods"),
}


def true_positions(scene, times):
    """In closed form where there is one; elsewhere by a run at 1e-14."""
    if scene.exact is not None:
        return scene.exact(times)[0]
    return simulate(scene, EventDriven(1e-14, 1e-14)).at(times)[0]


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_positions_at_any_time_are_within_ten_tolerances(scene):
    times = np.linspace(*scene.t_span, TIMES)
    truth = true_positions(scene, times)
    for tolerance in 10.0 ** -np.arange(4.0, 12.5):
        m = simulate(scene, EventDriven(tolerance, tolerance))
        assert m.status is Status.DONE
        over = np.max(np.abs(m.at(times)[0] - truth) / (1.0 + np.abs(truth))) / tolerance
        assert over < 10.0, f"{over:.3g} tolerances of {tolerance:g}"
