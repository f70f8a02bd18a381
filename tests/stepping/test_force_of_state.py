"""Steps that solve for the force of a `LinearSystem` say where it is none of time alone."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, simulate


def damped(t, q, v, p, out):
    out[0] = -9.81 - 5.0 * v[0]


def ball(system):
    return Scene(system, 1.0, 0.0, (0.0, 1.0), LinearContacts([[1.0]], restitution=0.5))


@pytest.mark.parametrize("method", [Located(1e-2), Located(1e-2, tolerance=1e-6)])
def test_a_force_of_the_velocity_is_refused_by_name(method):
    """It had been taken for one of time, in silence: 0.4 m off at every step size."""
    for _ in range(2):
        with pytest.raises(ValueError, match=r"system\.force \(.*\): expected a function of time alone"):
            simulate(ball(LinearSystem(1.0, force=damped)), method)


@pytest.mark.parametrize("method", [EventDriven(1e-10, 1e-10), Located(1e-3, order=4)])
def test_methods_that_ask_for_it_along_the_motion_take_it(method):
    alike = [
        simulate(ball(s), method).q[-1] for s in (LinearSystem(1.0, force=damped), System(1, 1.0, damped))
    ]
    np.testing.assert_allclose(*alike, rtol=0, atol=1e-9)
