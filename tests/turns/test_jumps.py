"""Velocities that jump: the time is a stop, to rounding, also where windows end there."""

import math

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate
from lcpstep.turns import turns

G = 9.81


def begins(t, q, v, p, out):
    """An obstacle that has the velocity p[1] from t = p[0] on."""
    late = t > p[0]
    out[0, 0] = p[1] * (t - p[0]) if late else 0.0
    out[0, 1] = p[1] if late else 0.0
    out[0, 2] = 0.0


def sampled(t, q, v, p, out):
    """The same as no interval arithmetic can take it, and with a sway."""
    begins(t, q, v, p, out)
    out[0, 0] += 0.0 * math.gamma(2.0 + t) + 0.01 * math.sin(3.0 * t)
    out[0, 1] += 0.03 * math.cos(3.0 * t)
    out[0, 2] -= 0.09 * math.sin(3.0 * t)


def above(motion, p):
    """A ball at rest on it, for a second."""
    table = LinearContacts([[1.0]], 0.0, 0.5, motion=motion)
    out = np.zeros((1, 3))
    motion(0.0, [0.0], [0.0], p, out)
    return Scene(
        LinearSystem(1.0, force=Harmonic(constant=[-G])), out[0, 0], out[0, 1], (0.0, 1.0), table, p=p
    )


@pytest.mark.parametrize("motion", [begins, sampled])
@pytest.mark.parametrize("time", [0.5, 0.3, 0.5123456])
def test_the_time_is_a_stop(motion, time):
    np.testing.assert_allclose(turns(above(motion, [time, 0.4])).stops, [time], rtol=0, atol=2e-16)


def pulse(t, q, v, p, out):
    """A bump of the width p[1] that is over at once, as far as windows tell; no velocity is another one after it."""
    s = (t - p[0]) / p[1]
    e = math.exp(-s * s) if abs(s) < 26.0 else 0.0
    out[0, 0] = p[1] * e
    out[0, 1] = -2.0 * s * e
    out[0, 2] = (4.0 * s * s - 2.0) * e / p[1]


def test_a_pulse_is_no_jump():
    """Its stops lie on both sides of it, where it has no velocity."""
    stops = turns(above(pulse, [0.4123456, 1e-10])).stops
    assert len(stops) >= 2
    assert np.all(np.abs(stops - 0.4123456) > 4e-10)


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2, "exact")])
@pytest.mark.parametrize("time", [0.5, 0.5123456])
@pytest.mark.parametrize("speed", [0.4, -4.5])
def test_motion_in_closed_form_is_not_dragged_along(method, time, speed):
    """A ball on an obstacle that drops had stayed on it, DONE."""
    rest = 1.0 - time
    scene = above(begins, [time, speed])
    run = simulate(Scene(scene.system, 0.0, 0.0, (0.0, 1.0), scene.contacts, p=scene.p), method)
    end = (speed * rest, speed) if speed > 0.0 else (-0.5 * G * rest**2, -G * rest)
    np.testing.assert_allclose([run.q[-1, 0], run.v[-1, 0]], end, rtol=0, atol=1e-11)
