"""Obstacles that leap, in time or with the place, take nothing along in silence; fast ones do not leap."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Located, Moreau, Status, simulate

G = 9.81
METHODS = [EventDriven(), Located(1e-3), Located(1e-3, order=4), Located(1e-2, tolerance=1e-6)]
IDS = ["event", "order 2", "order 4", "tolerance"]
BALL = LinearSystem(1.0, force=-G)


def floor(heights, until):
    """A floor that is at heights[k] up to the time until[k], as a table held between its entries."""

    def motion(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = heights[np.searchsorted(until, t, side="right")], 0.0, 0.0

    def gap(t, q, v, p, out):
        out[0] = q[0] - heights[np.searchsorted(until, t, side="right")]

    def jacobian(t, q, v, p, out):
        out[0, 0] = 1.0

    return LinearContacts(1.0, motion=motion), Contacts(1, gap, jacobian)


@pytest.mark.parametrize("corners", [(), (1.0037,)])
@pytest.mark.parametrize("flat", [True, False])
@pytest.mark.parametrize("to", [-0.1, 0.1])
@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_what_a_leaping_floor_takes_along_is_told(method, to, flat, corners):
    """A body at rest falls where the floor is gone, by g (t - 1.0037)^2/2; each method has it at -0.1 m at once."""
    contacts = floor(np.array([0.0, to]), np.array([1.0037]))[0 if flat else 1]
    run = simulate(Scene(BALL, 0.0, 0.0, (0.0, 2.0), contacts, corners=corners), method)
    if run.status == Status.STEP_TOO_SMALL:  # a method that does not get over it
        assert run.t[-1] == pytest.approx(1.0037)
        return
    assert run.status == Status.DONE
    later = 1.05
    assert abs(run.at(later)[0][0] + 0.5 * G * (later - 1.0037) ** 2) > 0.05
    assert run.doubt.startswith("the gap of contact 0 leaps by 0.1 m at t = 1.0037 s")
    assert run.doubt in run.message


def curb(high, start):
    """The ground ahead is higher: what slides there meets no wall, for there is none in the gap."""

    def gap(t, q, v, p, out):
        out[0] = q[1] - (high if q[0] > start else 0.0)

    def jacobian(t, q, v, p, out):
        out[0, 0], out[0, 1] = 0.0, 1.0

    return Contacts(1, gap, jacobian)


@pytest.mark.parametrize("method", METHODS, ids=IDS)
@pytest.mark.parametrize("high", [0.2, -0.2])
def test_a_curb_is_told(method, high):
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -G]), [0.0, 0.0], [1.0, 0.0], (0.0, 1.9), curb(high, 1.0)
    )
    run = simulate(scene, method)
    if run.status == Status.STEP_TOO_SMALL:
        assert run.q[-1, 0] == pytest.approx(1.0)
    elif abs(run.q[-1, 1] - high) < 0.01 and np.max(np.abs(run.v[:, 1])) < 0.1:
        assert "leaps by 0.2 m at t = 1 s" in run.doubt
    else:  # it has fallen
        assert high < 0.0


@pytest.mark.parametrize("method", [*METHODS, Moreau(1e-3)], ids=[*IDS, "moreau"])
def test_what_flies_over_a_leap_is_not_told(method):
    """Steps down, each left in flight: parabolas between impacts that are known."""
    run = simulate(
        Scene(BALL, 1.0, 0.0, (0.0, 0.6), floor(np.array([0.0, -0.3]), np.array([0.41]))[0]), method
    )
    assert run.status == Status.DONE
    assert run.doubt == ""
    assert run.impacts.time[0] == pytest.approx(math.sqrt(2.6 / G), abs=2e-3)


@pytest.mark.parametrize("width", [1e-2, 1e-4])
@pytest.mark.parametrize("method", METHODS[:3], ids=IDS[:3])
def test_a_floor_that_is_fast_is_no_leap(method, width):
    """It sinks by 0.1 m within so short a time, and throws nothing: what stood there lands on it."""

    def motion(t, q, v, p, out):
        x = math.tanh((t - 0.3) / width)
        out[0, 0], out[0, 1] = -0.05 * (1.0 + x), -0.05 * (1.0 - x * x) / width
        out[0, 2] = 0.1 * x * (1.0 - x * x) / width**2

    run = simulate(
        Scene(BALL, 0.0, 0.0, (0.0, 1.0), LinearContacts(1.0, motion=motion), corners=[0.3]), method
    )
    assert run.status == Status.DONE
    assert "leaps" not in run.doubt


def test_a_fall_in_one_step_onto_putty_is_no_leap():
    """It is kept at rest above, and at rest below, and has gone on by parabola in between."""
    still = Contacts(1, lambda t, q, v, p, out: out.fill(q[0]), lambda t, q, v, p, out: out.fill(1.0))
    body = System(1, 1.0, lambda t, q, v, p, out: out.fill(-G))
    run = simulate(Scene(body, 1.0, 0.0, (0.0, 2.0), still), EventDriven(), keep=[0.0, 1.0, 2.0])
    assert np.abs(np.diff(run.q[:, 0])).max() == pytest.approx(1.0)
    assert np.all(run.v == 0.0)
    assert run.doubt == ""


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_rounding_of_a_gap_is_no_leap(method):
    """A body creeps to the lowest place of a bowl of 1 m, until a step goes less than its gap can tell."""

    def gap(t, q, v, p, out):
        out[0] = 1.0 - math.sqrt(q[0] ** 2 + (q[1] - 1.0) ** 2)

    def jacobian(t, q, v, p, out):
        d = math.sqrt(q[0] ** 2 + (q[1] - 1.0) ** 2)
        out[0, 0], out[0, 1] = -q[0] / d, (1.0 - q[1]) / d

    system = LinearSystem(np.eye(2), C=20.0 * np.eye(2), force=[0.0, -G])
    scene = Scene(
        system, [1e-7, 1.0 - math.sqrt(1.0 - 1e-14)], [0.0, 0.0], (0.0, 3.0), Contacts(1, gap, jacobian)
    )
    run = simulate(scene, method)
    assert run.status == Status.DONE
    assert not run.doubt
