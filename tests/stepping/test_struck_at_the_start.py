"""A body that strikes as the run begins: the state kept of that time is that after the blow, whatever is kept."""

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
