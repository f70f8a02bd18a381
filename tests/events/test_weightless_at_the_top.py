"""A pile on a table that shakes as hard as gravity pulls: at the top of each swing its forces but touch zero.

The table moves by a sin(omega t + phase) with a omega^2 = g; what lies on it never leaves it.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Status, simulate

MASSES = np.array([1.0, 2.0, 0.5])
HIGH = 0.3  # above the pile: a ball that bounces on it for ever [m]


def table(t, q, v, p, out):
    out[:] = 0.0
    s, c = p[0] * math.sin(p[1] * t + p[2]), p[0] * math.cos(p[1] * t + p[2])
    out[0, 0], out[0, 1], out[0, 2] = s, p[1] * c, -p[1] * p[1] * s


@pytest.mark.parametrize("g", [9.81, 10.0])
@pytest.mark.parametrize("phase", [0.0, 0.5 * math.pi])
@pytest.mark.parametrize("amplitude", [0.01, 0.1, 1.0])
def test_what_lies_on_it_stays_there_below_a_ball_that_bounces(amplitude, phase, g):
    omega, n = math.sqrt(g / amplitude), len(MASSES)
    q0 = np.full(n, amplitude * math.sin(phase))
    q0[-1] += HIGH
    contacts = LinearContacts(np.eye(n) - np.eye(n, k=-1), restitution=(0.0, 0.0, 1.0), motion=table)
    scene = Scene(
        LinearSystem(np.diag(MASSES), force=-g * MASSES),
        q0, np.full(n, amplitude * omega * math.cos(phase)), (0.0, 5.0), contacts=contacts,
        parameters={"amplitude": amplitude, "omega": omega, "phase": phase},
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    assert run.status is Status.DONE
    assert not run.doubt
    times = np.linspace(0.0, 5.0, 500)
    q = run.at(times)[0]
    place = amplitude * np.sin(omega * times + phase)
    np.testing.assert_allclose(q[:, :-1], np.stack([place] * (n - 1), axis=1), rtol=0, atol=1e-9)
    assert np.min(q[:, -1] - place) > -1e-9


@pytest.mark.parametrize("restitution", [0.5, 1.0])
@pytest.mark.parametrize("tolerance", [1e-12, 1e-8])
def test_what_begins_at_rest_at_the_top_is_not_struck_by_what_cosines_make_of_zero(tolerance, restitution):
    """A body on the table and one that falls onto it from 1 m: its is the first impact."""
    g, amplitude = 10.0, 0.1
    contacts = LinearContacts([[1.0, 0.0], [-1.0, 1.0]], restitution=restitution, motion=table)
    scene = Scene(
        LinearSystem(np.diag([3.0, 2.0]), force=(-3.0 * g, -2.0 * g)),
        (amplitude, amplitude + 1.0), (0.0, 0.0), (0.0, 1.0), contacts=contacts,
        parameters={"amplitude": amplitude, "omega": 10.0, "phase": 0.5 * math.pi},
    )  # fmt: skip
    log = simulate(scene, EventDriven(tolerance, tolerance)).impacts
    blows = log[log.kind == Kind.IMPACT]
    lands = brentq(
        lambda t: 1.0 - 0.5 * g * t * t + amplitude * (1.0 - math.cos(10.0 * t)), 0.1, 0.6, xtol=1e-15
    )
    assert set(blows.contact[blows.time < lands + 1e-9]) == {0, 1}  # the body below passes it on to the table
    np.testing.assert_allclose(blows.time[:2], lands, rtol=0, atol=10.0 * tolerance)
