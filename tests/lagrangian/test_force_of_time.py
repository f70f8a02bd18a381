"""Forces of a `LinearSystem` are of time, masses of time and places: what solves for them does not ask at a state."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Moreau, SimulationError, simulate


def damped(t, q, v, p, out):
    out[0] = -9.81 - 5.0 * v[0]


def sprung(t, q, v, p, out):
    out[0] = math.cos(2.0 * t) - 4.0 * q[0]


def of_time(t, q, v, p, out):
    out[0] = math.cos(2.0 * t) - 9.81


def late(t, q, v, p, out):
    out[0] = -9.81 - (5.0 * v[0] if t > 0.3 else 0.0)


def ball(system):
    return Scene(system, 1.0, 0.0, (0.0, 1.0), LinearContacts([[1.0]], restitution=0.5))


@pytest.mark.parametrize("force", [damped, sprung])
def test_a_force_of_the_state_is_refused_by_name(force):
    """It was taken for one of time: `Moreau` 0.3 m off at any step, multipliers of orbits those of another one."""
    with pytest.raises(
        ValueError, match=r"^system\.force \(that of a System may.*\): expected a function of time alone"
    ):
        ball(LinearSystem(1.0, force=force))


def test_one_that_depends_on_the_state_later_on_is_refused_after_the_run():
    with pytest.raises(SimulationError, match=r"^system\.force \(.*\): expected a function of time alone"):
        simulate(ball(LinearSystem(1.0, force=late)), Moreau(1e-3))


def test_a_force_of_time_is_taken_as_by_a_general_system():
    ends = [
        simulate(ball(s), EventDriven()).q[-1]
        for s in (LinearSystem(1.0, force=of_time), System(1, 1.0, of_time))
    ]
    np.testing.assert_allclose(*ends, rtol=0, atol=1e-10)


def heavier(t, q, v, p, out):
    out[0, 0] = 1.0 + 0.5 * v[0] ** 2


def test_a_mass_that_depends_on_the_velocity_is_refused_by_name():
    """It ran, and was told to have steps that are too long, at whatever step: the energy is another one."""
    with pytest.raises(ValueError, match=r"^system\.mass: expected a function of time and coordinates alone"):
        ball(System(1, heavier, of_time))
