"""Steps of `Moreau` by a tolerance: when friction gives way and turns about, which both runs may have wrong."""

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Moreau, simulate
from tests.stepping.test_adaptive_moreau import along, shaken


@pytest.mark.parametrize("tolerance", [1e-6, 1e-8])
def test_sliding_that_stops_at_the_end_of_a_step_only_because_it_turns_within_is_seen(tolerance):
    """Both runs ended at rest on the table, which no friction could hold there: 6e-3 m by a tolerance of 1e-8."""
    friction = Coulomb(mu=0.3, tangent=along, slip=shaken)
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -9.81]), [0.0, 0.0], [0.0, 0.0], (0.0, 3.0),
        LinearContacts([[0.0, 1.0]], restitution=0.0, friction=friction), p=[0.02, 20.0],
    )  # fmt: skip
    true = simulate(scene, EventDriven(), keep=[3.0]).q[-1, 0]
    for h in (0.01, 0.07):
        assert abs(simulate(scene, Moreau(h, tolerance=tolerance)).q[-1, 0] - true) <= tolerance


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6])
def test_friction_that_falls_when_sliding_begins_does_so_in_time(tolerance):
    """Both runs let go at the same one of their ends, too early or too late: by 240 tolerances of 1e-6."""
    scene = scenes.stick_slip_belt(t_end=30.0)
    m = simulate(scene, Moreau(0.05, tolerance=tolerance), keep=np.linspace(0.0, 30.0, 61))
    assert np.max(np.abs(m.q - scene.exact(m.t)[0])) <= tolerance


@pytest.mark.parametrize("smooth", [0.0, 0.3])
def test_feet_that_share_their_loads_give_way_in_time(smooth):
    """Forces of feet that slide do not tell when they gave way: by 6 tolerances too early, whatever the tolerance."""
    friction = Coulomb([smooth, 0.5], [[1.0, 0.0, 0.3]] * 2, mu_s=[1.5 * smooth, 0.75])
    pull = Harmonic(constant=[0.0, -9.81, 0.0], sine=[6.0, 0.0, 0.0], omega=2.0)
    block = LinearSystem(np.diag([1.0, 1.0, 0.1]), K=np.diag([30.0, 0.0, 0.0]), force=pull)
    feet = LinearContacts([[0.0, 1.0, 0.3], [0.0, 1.0, -0.3]], friction=friction)
    scene = Scene(block, np.zeros(3), np.zeros(3), (0.0, 3.0), feet)
    true = simulate(scene, EventDriven(), keep=[3.0]).q[-1, 0]
    for h in (0.02, 0.03):
        assert abs(simulate(scene, Moreau(h, tolerance=1e-7)).q[-1, 0] - true) <= 1e-7


def test_what_sticks_takes_long_steps_again():
    """Its velocity was followed to less than the rounding that is taken for rest: steps stayed at 3e-10 s."""
    friction = Coulomb(mu=0.558, tangent=[[1.0, 0.0, 0.3]], mu_s=0.5692)
    disc = LinearSystem(
        np.diag([1.0, 1.0, 0.045]),
        C=np.diag([0.50674295, 0.3726256, 0.07271261]),
        force=[-0.35712306, -9.81, 0.0],
    )
    floor = LinearContacts([[0.0, 1.0, 0.0]], friction=friction)
    scene = Scene(disc, [0.0, 0.2, 0.0], [0.52239977, 0.85083283, -1.42560017], (0.0, 0.311), floor)
    assert simulate(scene, Moreau(0.02, tolerance=1e-6)).counts.steps < 3000
