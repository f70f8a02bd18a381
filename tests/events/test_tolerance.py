"""Errors against tolerances: positions at any time are within ten, where the motion does not magnify more."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
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


@pytest.mark.parametrize("speed", [1e-3, 0.0, -1e-3])
def test_a_start_within_the_tolerance_of_a_surface_keeps_its_height(speed):
    """A contact that moves there is in a hop: v^2 = v0^2 + 2 |a| g0. One that is still there rests."""
    gap, pressure, tolerance = 5e-7, 10.0, 1e-6
    scene = Scene(
        system=LinearSystem(M=np.eye(2), K=np.eye(2), force=[-pressure, 0.0]),
        contacts=LinearContacts(G=[[1.0, 0.0]], restitution=1.0), q0=[gap, 1.0], v0=[speed, 0.0], t_span=(0.0, 0.01),
    )  # fmt: skip
    m = simulate(scene, EventDriven(tolerance, tolerance))
    if speed == 0.0:
        assert not np.any(m.v[:, 0])
        assert m.impulse.sum() == pytest.approx(pressure * 0.01, rel=1e-6)
    else:
        strikes = m.impacts.before
        assert len(strikes) > 10
        assert strikes == pytest.approx(-np.sqrt(speed**2 + 2.0 * pressure * gap), rel=1e-5)


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-10])
def test_impacts_of_a_motion_that_dies_away_below_the_tolerance_are_those_of_a_tight_one(tolerance):
    """Steps longer than its periods had let a contact go, and held it again, thousands of times."""
    scene = scenes.double_pendulum(t_end=432.0)
    tight = simulate(scene, EventDriven(1e-13, 1e-13)).impacts
    loose = simulate(scene, EventDriven(tolerance, tolerance)).impacts
    assert len(loose) == len(tight)
    assert np.array_equal(loose.kind, tight.kind)
