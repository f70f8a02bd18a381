"""A body that strikes as the run begins: the state kept of that time is that after the blow, whatever is kept."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, simulate

TIMES = np.array([1.0, 2.0, 2.5])


def weight(t, q, v, p, out):
    out[0] = -2.0


def height(t, q, v, p, out):
    out[0] = q[0]


def upward(t, q, v, p, out):
    out[0, 0] = 1.0


def falls(system, contacts):
    """From a floor onto which it falls with 2 m/s at 1 s; it is back two seconds later, and goes up in between."""
    n = system.n_q
    return Scene(system, np.zeros(n), np.full(n, -2.0), (1.0, 2.5), contacts=contacts)


SCENES = {
    "linear": falls(LinearSystem(1.0, force=-2.0), LinearContacts(1.0, restitution=1.0)),
    "general": falls(System(1, [[1.0]], weight), Contacts(1, height, upward, restitution=1.0)),
    "two bodies": falls(
        LinearSystem(np.eye(2), force=[-2.0] * 2), LinearContacts(np.eye(2), restitution=1.0)
    ),
}
METHODS = [
    EventDriven(),
    Located(0.25),
    Located(0.25, order=4),
    Located(0.5, tolerance=1e-6),
    Located(0.5, order=4, tolerance=1e-6),
]


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("method", METHODS, ids=repr)
@pytest.mark.parametrize("keep", [1, 3, TIMES, "impacts"], ids=["1", "3", "times", "impacts"])
def test_the_state_of_the_start_is_that_after_its_blow(name, method, keep):
    run = simulate(SCENES[name], method, keep=keep)
    since = run.t - 1.0
    np.testing.assert_allclose(run.v[:, 0], 2.0 - 2.0 * since, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.q[:, 0], 2.0 * since - since**2, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.impulse[:, 0].sum(), 4.0, rtol=1e-14)
    if isinstance(keep, int) and keep == 1:
        np.testing.assert_allclose(run.at(1.0)[1][0], 2.0, rtol=0, atol=1e-12)


def beads(masses, q0, v0, t_end, weight=0.0, **more):
    """Beads on a line above a floor at 0, each touched by the next where both have one place."""
    n = len(masses)
    rows = np.eye(n) - np.eye(n, k=-1)
    system = LinearSystem(np.diag(masses), force=-weight * np.array(masses))
    return Scene(system, q0, v0, (0.0, t_end), contacts=LinearContacts(rows, **more))


@pytest.mark.parametrize("method", [Located(1e-3), Located(1e-3, order=4), EventDriven()], ids=repr)
def test_pairs_that_touch_at_the_start_strike_before_what_lies_between_them(method):
    """Two pairs of beads, 1 and 0.5 kg, 1 and 2 kg: Newton's law for each, which then meet in the middle."""
    scene = beads((1.0, 0.5, 1.0, 2.0), [0.1] * 4, (0.0, -1.0, 0.0, -1.0), 0.05, weight=10.0, restitution=1.0)
    log = simulate(scene, method).impacts[:3]
    speeds = -2.0 / 3.0, 1.0 / 3.0, -4.0 / 3.0, -1.0 / 3.0  # after the two impacts
    assert set(log.contact[:2]) == {1, 3}
    assert log.contact[2] == 2
    np.testing.assert_allclose(log.before, (-1.0, -1.0, speeds[2] - speeds[1]), rtol=1e-12)


@pytest.mark.parametrize("method", [Located(1e-2), Located(1e-2, order=4), EventDriven()], ids=repr)
def test_a_bead_brought_to_rest_on_a_wall_is_held_by_it_when_struck_again(method):
    """Nothing presses it there: the gap that is zero takes part in the next impact."""
    rows = [[-1.0, 1.0], [0.0, -1.0]]  # a bead of 2 kg before one of 1 kg, and a wall at 1 m
    contacts = LinearContacts(rows, offset=(0.0, 1.0), restitution=0.5)
    scene = Scene(LinearSystem(np.diag([2.0, 1.0])), (1.0, 1.0), (0.0, -2.0), (0.0, 2.0), contacts=contacts)
    first = simulate(scene, method)
    np.testing.assert_allclose(first.v[-1], (-1.0, 0.0), rtol=0, atol=1e-15)  # 2 * 2/3 * 1.5 / 2, and nothing
    assert first.q[-1, 1] == 1.0
    # back from another wall with 1 m/s
    again = replace(scene, q0=(0.5, 1.0), v0=(1.0, 0.0), t_span=(0.0, 2.0))
    run = simulate(again, method)
    np.testing.assert_allclose(run.v[-1], (-0.5, 0.0), rtol=0, atol=1e-12)
