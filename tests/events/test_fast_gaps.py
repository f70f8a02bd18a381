"""Obstacles that turn much faster than the span of the run suggests, and that nobody has given a period for."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, simulate
from lcpstep.events.scan import PER_FORCING, scan_interval
from lcpstep.model import model

GRAVITY, RESTITUTION = 9.81, 0.5


def fall(t, q, v, p, out):
    out[0] = -GRAVITY


def shaken(t, q, v, p, out):
    a, w = p[0], p[1]
    out[0, 0], out[0, 1] = a * math.sin(w * t), a * w * math.cos(w * t)
    out[0, 2] = -a * w * w * math.sin(w * t)


def fly_over(t, q, v, p, out):
    out[0], out[1] = 0.0, -GRAVITY


def washboard(t, q, v, p, out):
    out[0] = q[1] - p[0] * math.sin(p[1] * q[0])


def slope(t, q, v, p, out):
    out[0, 0], out[0, 1] = -p[0] * p[1] * math.cos(p[1] * q[0]), 1.0


def impacts(amplitude: float, omega: float, n: int) -> np.ndarray:
    """First impacts of a ball dropped from 1 m, by a fine scan of the closed form."""
    t, q, v, found = 0.0, 1.0, 0.0, []
    while len(found) < n:

        def gap(s, t=t, q=q, v=v):
            return q + v * s - 0.5 * GRAVITY * s * s - amplitude * np.sin(omega * (t + s))

        s = np.arange(1e-7, 2.0, 1e-2 / omega)
        k = int(np.argmax(gap(s) < 0.0))
        s_hit = brentq(gap, s[k - 1], s[k], xtol=1e-15, rtol=1e-14)
        q, t = q + v * s_hit - 0.5 * GRAVITY * s_hit**2, t + s_hit
        rate = amplitude * omega * math.cos(omega * t)
        v = rate - RESTITUTION * (v - GRAVITY * s_hit - rate)
        found.append(t)
    return np.array(found)


@pytest.mark.parametrize("system", [LinearSystem(1.0, force=-GRAVITY), System(1, 1.0, fall)])
def test_a_shaken_floor_without_period_is_not_flown_through(system):
    amplitude, omega = 0.01, 100.0
    floor = LinearContacts(1.0, restitution=RESTITUTION, motion=shaken)
    scene = Scene(system, q0=1.0, v0=0.0, t_span=(0.0, 20.0), contacts=floor, p=[amplitude, omega])
    run = simulate(scene, EventDriven())
    t = np.linspace(0.0, 20.0, 50_001)
    gap = run.at(t)[0][:, 0] - amplitude * np.sin(omega * t)
    assert gap.min() > -1e-10
    np.testing.assert_allclose(run.impacts.time[:4], impacts(amplitude, omega, 4), atol=1e-10)


def test_a_gap_that_turns_fast_along_the_motion_is_seen():
    """Without damping or friction the washboard leaves the energy alone."""
    board = Contacts(1, washboard, slope, restitution=1.0)
    system = System(2, np.eye(2), fly_over)
    scene = Scene(system, q0=[0.0, 0.3], v0=[20.0, 0.0], t_span=(0.0, 3.0), contacts=board, p=[0.001, 100.0])
    run = simulate(scene, EventDriven(rtol=1e-11, atol=1e-11))
    t = np.linspace(0.0, 3.0, 50_001)
    q, v = run.at(t)
    assert len(run.impacts) > 3
    assert (q[:, 1] - 0.001 * np.sin(100.0 * q[:, 0])).min() > -1e-9
    energy = 0.5 * (v**2).sum(axis=1) + GRAVITY * q[:, 1]
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_a_cam_is_not_looked_at_more_finely_than_its_period_asks_for():
    cam = scenes.cam_follower(rpm=660.0, t_end=1.0)
    assert scan_interval(cam, model(cam), 0.0) == cam.period / PER_FORCING


def test_a_gear_of_many_teeth_in_a_period_is_looked_at_more_finely():
    floor = LinearContacts(1.0, motion=shaken)
    gear = Scene(LinearSystem(1.0), 1.0, 0.0, (0.0, 9.0), floor, p=[1e-3, 200.0 * math.pi], period=1.0)
    assert scan_interval(gear, model(gear), 0.0) == pytest.approx(0.01 / PER_FORCING, rel=1e-2)


def shaken_gap(t, q, v, p, out):
    out[0], out[1] = q[0] - p[0] * math.sin(p[1] * t), q[0] + 5.0


def shaken_rate(t, q, v, p, out):
    out[0], out[1] = -p[0] * p[1] * math.cos(p[1] * t), 0.0


def upwards(t, q, v, p, out):
    out[0, 0], out[1, 0] = 1.0, 1.0


def test_a_shaken_floor_of_several_general_contacts_is_not_flown_through():
    floor = Contacts(2, shaken_gap, upwards, shaken_rate, restitution=RESTITUTION)
    scene = Scene(System(1, 1.0, fall), 1.0, 0.0, (0.0, 10.0), floor, p=[0.01, 100.0])
    run = simulate(scene, EventDriven())
    t = np.linspace(0.0, 10.0, 20_001)
    assert (run.at(t)[0][:, 0] - 0.01 * np.sin(100.0 * t)).min() > -1e-8  # the bias is differenced
    np.testing.assert_allclose(run.impacts.time[:4], impacts(0.01, 100.0, 4), atol=1e-9)


def corrugated(t, q, v, p, out):
    out[0] = q[1] - p[0] * math.cos(p[1] * q[0] + p[2])


def along_it(t, q, v, p, out):
    out[0, 0], out[0, 1] = p[0] * p[1] * math.sin(p[1] * q[0] + p[2]), 1.0


@pytest.mark.parametrize("seed", range(40))
def test_a_body_without_forces_meets_the_first_crest_that_it_comes_to(seed):
    """Its motion is one line, whose steps are as long as the scan allows; the gap turns eight times between looks."""
    rng = np.random.default_rng(seed)
    height, k, phase = (
        10.0 ** rng.uniform(-3.0, 0.0),
        2.0 * np.pi * 10.0 ** rng.uniform(0.0, 3.2),
        rng.uniform(0.0, 6.28),
    )
    y = height * rng.uniform(1.2, 6.0)
    fall = y / rng.uniform(0.3, 1.0)
    contacts = Contacts(1, corrugated, along_it)
    scene = Scene(
        LinearSystem(M=np.eye(2)), (0.0, y), (1.0, -fall), (0.0, 1.0), contacts, p=(height, k, phase)
    )
    t = np.linspace(0.0, 1.0, 400_001)
    first = t[np.argmax(y - fall * t - height * np.cos(k * t + phase) <= 0.0)]
    struck = simulate(scene, EventDriven(1e-10, 1e-10, max_events=3), keep="impacts").impacts
    assert struck.time[0] == pytest.approx(first, abs=3e-6)
