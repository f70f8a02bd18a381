"""Narrow burrs of tables and jerks of belts that the scene knows are not lost where friction acts."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from benchmarks.audit.judge import Belt, follow
from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, simulate
from lcpstep.turns import turns
from tests.marks import slow
from tests.turns.test_burrs import FAST, OFFSET, bell, bump, strikes

GRAVITY, MU = 9.81, 0.3
METHODS = [EventDriven(), Located(1e-2), Located(1e-2, order=4)]


def over_a_table(motion, p, phase):
    """A body that drifts along a table, one oscillation a second above it."""
    return Scene(
        system=LinearSystem(M=np.eye(2), K=np.diag([0.0, FAST**2])),
        contacts=LinearContacts([[0.0, 1.0]], OFFSET, 0.8, motion=motion, friction=Coulomb(MU, [[1.0, 0.0]])),
        q0=[0.0, math.cos(phase)], v0=[1.0, -FAST * math.sin(phase)], t_span=(0.0, 10.0), p=p,
    )  # fmt: skip


def tangent(t, q, v, p, out):
    """Along the belt."""
    out[0, 0], out[0, 1] = 1.0, 0.0


def jerk(t, q, v, p, out):
    """A belt at rest, but for a jerk of velocity p[0] (1 - s^2)^3 about p[2]."""
    s = (t - p[2]) / p[1]
    out[0] = -p[0] * (1.0 - s * s) ** 3 if abs(s) < 1.0 else 0.0


def on_a_belt(p, slip=jerk, speed=0.0, period=math.inf):
    """A body of 1 kg on it."""
    return Scene(
        system=LinearSystem(M=np.eye(2), force=[0.0, -GRAVITY]),
        contacts=LinearContacts([[0.0, 1.0]], 0.0, 0.0, friction=Coulomb(MU, tangent, slip)),
        q0=[0.0, 0.0], v0=[speed, 0.0], t_span=(0.0, 10.0), p=p, period=period,
    )  # fmt: skip


def carried(speed, length):
    """How far it is carried: it sticks until the belt is too fast for friction, is pulled until the belt comes down
    to its speed, and slides to rest.
    """
    a, belt = (
        MU * GRAVITY,
        np.polynomial.Polynomial([speed, 0.0, -3.0 * speed, 0.0, 3.0 * speed, 0.0, -speed]),
    )
    off = brentq(belt.deriv() - a * length, -1.0, -0.45, xtol=1e-16)
    met = brentq(lambda s: belt(off) + a * length * (s - off) - belt(s), 0.0, 1.0, xtol=1e-16)
    slow, fast = belt(off), belt(off) + a * length * (met - off)
    sticks = length * (belt.integ()(off) - belt.integ()(-1.0))
    return sticks + 0.5 * (slow + fast) * length * (met - off) + fast**2 / (2.0 * a)


@pytest.mark.parametrize("motion", [bump, bell])
@pytest.mark.parametrize("width", slow([1e-1, 1e-2, 1e-3, 1e-4], 1e-3, longest=[1e-1, 1e-2, 1e-4]))
def test_no_burr_of_a_table_is_flown_through(motion, width):
    rng = np.random.default_rng(int(1e4 * width))
    for k in range(9):
        phase, place = rng.uniform(0.0, FAST), rng.uniform(0.5, 9.5)
        p = [rng.uniform(0.05, 1.0), width, place, 10.0]
        meets, clear = strikes(motion, p, phase)
        struck = len(simulate(over_a_table(motion, p, phase), METHODS[k % len(METHODS)]).impacts) > 0
        assert struck or not meets
        assert not struck or not clear


@pytest.mark.parametrize("place", [0.7137, 3.1, 8.613])
@pytest.mark.parametrize("length", [1e-1, 1e-2, 1e-3, 1e-4, 1e-5])
def test_no_jerk_of_a_belt_is_lost(length, place):
    run = simulate(on_a_belt([1.0, length, place]), EventDriven())
    assert run.q[-1, 0] == pytest.approx(carried(1.0, length), rel=1e-8)
    assert abs(run.v[-1, 0]) < 1e-12


@pytest.mark.parametrize(
    ("method", "off"),
    [(Located(1e-2), 1e-3), (Located(1e-2, order=4), 1e-5), (Located(1e-2, tolerance=1e-8), 1e-7)],
)
@pytest.mark.parametrize("length", [1e-2, 1e-3, 1e-4, 1e-5])
def test_nor_by_steps_that_are_longer_than_it(length, method, off):
    run = simulate(on_a_belt([1.0, length, 3.1]), method)
    assert run.q[-1, 0] == pytest.approx(carried(1.0, length), rel=off)


def running(t, q, v, p, out):
    """A belt that runs at p[3] + sin(p[4] t), with such a jerk; p[0] / p[1] is beyond friction."""
    s = (t - p[2]) / p[1]
    out[0] = -(p[3] + math.sin(p[4] * t) + (p[0] * (1.0 - s * s) ** 3 if abs(s) < 1.0 else 0.0))


@pytest.mark.parametrize("length", slow([1e-2, 1e-3, 1e-4, 1e-5], longest=[1e-3, 1e-4]))
@pytest.mark.parametrize("sway", [0.0, 0.3])
def test_a_jerk_of_a_belt_that_runs_is_seen_however_small_beside_its_speed(length, sway):
    p = [0.05, length, 4.7137, 1.0, sway]
    true = follow(Belt([*p[:4], 1.0, sway, 10.0], False), MU * GRAVITY, 0.0, 1.0, 10.0)
    run = simulate(on_a_belt(p, running, 1.0), EventDriven())
    assert Kind.SLIP in [x.kind for x in run.impacts]
    assert run.q[-1, 0] == pytest.approx(true[0], abs=1e-11)


def test_a_belt_that_runs_steadily_or_sways_has_no_stops_and_kinks_have():
    def steady(t, q, v, p, out):
        out[0] = -1.0 - 0.5 * math.sin(2.0 * t) * math.cos(t)

    def saw(t, q, v, p, out):
        x = t - math.floor(t)
        out[0] = -2.0 * x if x < 0.5 else 2.0 * x - 2.0

    def stops(slip, period=math.inf):
        return turns(on_a_belt([], slip, period=period), with_belts=True).stops

    assert len(stops(steady)) == 0
    np.testing.assert_allclose(stops(saw, 1.0), [0.5], atol=1e-6)
    whole = stops(saw)
    for k in range(1, 20):  # but for those at which it is looked at anyway they lie on both sides
        assert np.min(np.abs(whole - 0.5 * k)) < 1e-6


def test_belts_whose_rate_has_no_bounds_are_told_by_their_velocity():
    places, heights = np.array([0.0, 3.0, 3.001, 3.002, 10.0]), np.array([0.0, 0.0, 1.0, 0.0, 0.0])

    def table(t, q, v, p, out):
        out[0] = -np.interp(t, places, heights)

    found = turns(on_a_belt([], table), with_belts=True).stops
    assert 2 <= len(found) < 80
    assert np.all((found > 2.99) & (found < 3.012))
