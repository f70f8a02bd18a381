"""Dry friction written as a force, -F sign(v): where a run cannot hold what it stops, it says what does."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate

STIFFNESS, LOAD, STOP = 100.0, 2.0, -0.03


def rubbing(t, q, v, p, out):
    out[0] = -STIFFNESS * q[0] - LOAD * np.sign(v[0])


def smooth(t, q, v, p, out):
    out[0] = -STIFFNESS * q[0] - LOAD * np.tanh(v[0] / 1e-3)


def scene(force):
    wall = LinearContacts(1.0, offset=-STOP, restitution=0.5)
    return Scene(System(1, 1.0, force), 0.1, 0.0, (0.0, 2.0), wall)


def where_it_stops():
    """Work of the spring and of friction, F a metre, down to the wall, and up again with half of the speed."""
    energy = 0.5 * STIFFNESS * (0.1**2 - STOP**2) - LOAD * (0.1 - STOP)
    up = 0.25 * energy + 0.5 * STIFFNESS * STOP**2 + LOAD * STOP  # k x^2/2 + F x there
    return (-LOAD + np.sqrt(LOAD**2 + 2.0 * STIFFNESS * up)) / STIFFNESS


@pytest.mark.parametrize(
    "method",
    [EventDriven(), Located(1e-2, order=4, tolerance=1e-6), Moreau(1e-2, tolerance=1e-4), Moreau(1e-3)],
    ids=["event", "located by tolerance", "moreau by tolerance", "moreau"],
)
def test_a_force_that_holds_a_velocity_at_zero_is_named(method):
    run = simulate(scene(rubbing), method)
    assert run.status in (Status.STEP_TOO_SMALL, Status.NEWTON_FAILED)
    place = where_it_stops()
    assert run.q[-1, 0] == pytest.approx(place, abs=3e-4)
    assert "system.force jumps as v[0] goes through zero and holds it there" in run.message
    before, after = (
        float(run.message.split(words)[1].split()[0]) for words in ("its acceleration being ", "before and ")
    )
    assert (before, after) == pytest.approx((LOAD - STIFFNESS * place, -LOAD - STIFFNESS * place), abs=0.03)
    assert "larger tolerance" not in run.message


def test_what_it_says_to_do_goes_through():
    """The same by Coulomb's law stays where it stops; a steep but smooth force creeps."""
    place = where_it_stops()
    smoothed = simulate(scene(smooth), EventDriven())
    assert smoothed.status == Status.DONE
    # A floor for the load and the wall: the same motion along x
    system = LinearSystem(M=np.eye(2), K=np.diag([STIFFNESS, 0.0]), force=[0.0, -LOAD])
    contacts = LinearContacts(
        [[0.0, 1.0], [1.0, 0.0]],
        [0.0, -STOP],
        [0.0, 0.5],
        friction=Coulomb([1.0, 0.0], [[1.0, 0.0], [0.0, 1.0]]),
    )
    stuck = simulate(Scene(system, [0.1, 0.0], [0.0, 0.0], (0.0, 2.0), contacts), EventDriven())
    assert stuck.status == Status.DONE
    assert stuck.q[-1, 0] == pytest.approx(place, abs=1e-9)
    assert stuck.v[-1, 0] == 0.0


def test_what_stops_for_another_reason_is_not_called_friction():
    def singular(t, q, v, p, out):
        out[0] = -STIFFNESS * q[0] - LOAD * np.sign(v[0] - 5.0) + 1e-3 / abs(t - 0.5) ** 1.5

    run = simulate(Scene(System(1, 1.0, singular), 0.1, 0.0, (0.0, 2.0)), EventDriven())
    assert run.status == Status.STEP_TOO_SMALL
    assert "holds it there" not in run.message
