"""Several contacts under any forces: independent systems side by side, sets of closed contacts, springs by SciPy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lcpstep import EventDriven, Kind, Status, simulate
from tests.models import GRAVITY

# --- two systems that know nothing of each other move as each does alone


def table(t, q, v, p, out):
    out[0, 0] = 0.01 * math.sin(40.0 * t)
    out[0, 1] = 0.4 * math.cos(40.0 * t)
    out[0, 2] = -16.0 * math.sin(40.0 * t)


def table_and_stop(t, q, v, p, out):
    table(t, q, v, p, out)
    out[1, 0] = out[1, 1] = out[1, 2] = 0.0


def weight_and_drive(t, q, v, p, out):
    out[0] = -9.81
    out[1] = 2.0 * math.cos(0.25 * t) - 0.1 * v[1] - q[1]


def drive(t, q, v, p, out):
    out[0] = 2.0 * math.cos(0.25 * t) - 0.1 * v[0] - q[0]


def test_chatter_in_one_contact_does_not_disturb_the_other():
    # a ball chatters, sticks and is released; an oscillator strikes its stop and chatters to rest there
    T, period = 3.0, 2 * math.pi / 40.0
    stops = LinearContacts(
        G=[[1.0, 0.0], [0.0, -1.0]], offset=[0.0, 0.5], restitution=[0.3, 0.6], motion=table_and_stop
    )
    system = System(2, np.eye(2), weight_and_drive)
    both = simulate(Scene(system, [0.02, 0.0], [0.0, 0.0], (0.0, T), stops, period=period), EventDriven())
    one = LinearContacts(G=1.0, restitution=0.3, motion=table)
    ball = simulate(
        Scene(LinearSystem(M=1.0, force=-9.81), 0.02, 0.0, (0.0, T), one, period=period), EventDriven()
    )
    other = LinearContacts(G=-1.0, offset=0.5, restitution=0.6)
    bob = simulate(Scene(System(1, 1.0, drive), 0.0, 0.0, (0.0, T), other), EventDriven())
    t = np.linspace(0.0, T, 301)
    q = both.at(t)[0]
    np.testing.assert_allclose(q[:, :1], ball.at(t)[0], rtol=0, atol=1e-10)
    np.testing.assert_allclose(q[:, 1:], bob.at(t)[0], rtol=0, atol=1e-10)
    for c, alone in enumerate((ball, bob)):
        for kind in (Kind.ACCUMULATION, Kind.STICK, Kind.RELEASE):
            ours = both.impacts.time[(both.impacts.contact == c) & (both.impacts.kind == kind)]
            theirs = alone.impacts.time[alone.impacts.kind == kind]
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
        assert both.impulse[:, c].sum() == pytest.approx(alone.impulse.sum(), abs=1e-9)


# --- sets of closed contacts that change


def walking_load(t, q, v, p, out):
    out[0] = -GRAVITY * (1.0 + p[0])
    out[1] = -GRAVITY * p[0] * p[1] * t


@pytest.mark.parametrize("feet", [2, 3, 7])
def test_a_plank_tips_when_the_load_has_walked_far_enough(feet):
    # plank of 1 kg on feet from -1/2 to 1/2; a load P at x = c t. About the last foot: 1/2 = P (x - 1/2)
    P, c = 0.8, 0.3
    place = np.linspace(-0.5, 0.5, feet)
    scene = Scene(
        LinearSystem(M=np.diag([1.0, 0.2]), force=walking_load), [0.0, 0.0], [0.0, 0.0], (0.0, 5.0),
        LinearContacts(G=np.stack([np.ones(feet), place], axis=1)), p=[P, c],
    )  # fmt: skip
    tips = (0.5 + 0.5 / P) / c
    m = simulate(scene, EventDriven())
    assert m.status is Status.DONE
    release = m.impacts[m.impacts.kind == Kind.RELEASE]
    assert set(release.contact) == set(range(feet - 1))
    np.testing.assert_allclose(release.time[release.contact == 0], tips, rtol=0, atol=1e-10)
    rest = m.t < tips - 1e-9
    assert np.max(np.abs(m.q[rest])) < 1e-14
    assert np.max(np.abs(m.v[rest])) < 1e-14
    # the feet carry the weights and their moment, however they share them
    k = np.flatnonzero(rest)[-1]
    carried = m.impulse[: k + 1].sum(0)
    assert np.all(m.impulse >= -1e-12)
    assert carried.sum() == pytest.approx(GRAVITY * (1.0 + P) * m.t[k], rel=1e-10)
    assert carried @ place == pytest.approx(0.5 * GRAVITY * P * c * m.t[k] ** 2, rel=1e-10)


@pytest.mark.parametrize("depth", [1e-2, 1e-6, 1e-10, 1e-12])
def test_a_touch_between_two_looks_is_not_missed(depth):
    # gap (t - t0)^2 - depth while another contact rests; touched at t0 - sqrt(depth)
    t0 = 0.71
    scene = Scene(
        System(2, np.eye(2), parabola), [0.0, t0 * t0 - depth], [0.0, -2.0 * t0], (0.0, 1.0),
        LinearContacts(G=np.eye(2), restitution=[0.0, 1.0]),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    hit = m.impacts[(m.impacts.contact == 1) & (m.impacts.kind == Kind.IMPACT)]
    assert len(hit) == 1
    assert hit[0].time == pytest.approx(t0 - math.sqrt(depth), abs=max(1e-12, 1e-14 / math.sqrt(depth)))


def parabola(t, q, v, p, out):
    out[0], out[1] = -1.0 - t, 2.0


# --- a block that falls on its two corners


def corners(t, q, v, p, out):
    s, c = math.sin(q[1]), math.cos(q[1])
    out[0] = q[0] - 0.1 * s - 0.4 * c
    out[1] = q[0] + 0.1 * s - 0.4 * c


def corners_jacobian(t, q, v, p, out):
    s, c = math.sin(q[1]), math.cos(q[1])
    out[0, 0], out[0, 1] = 1.0, -0.1 * c + 0.4 * s
    out[1, 0], out[1, 1] = 1.0, 0.1 * c + 0.4 * s


@pytest.mark.parametrize("r", [0.0, 0.5])
@pytest.mark.parametrize("tilt", [0.0, 0.05, -0.13])
def test_a_block_on_a_smooth_floor_comes_to_rest_on_both_corners(r, tilt):
    inertia = (0.2**2 + 0.8**2) / 12.0
    system = LinearSystem(M=np.diag([1.0, inertia]), force=[-GRAVITY, 0.0])
    contacts = Contacts(2, corners, corners_jacobian, restitution=r)
    m = simulate(Scene(system, [0.43, tilt], [0.0, 0.0], (0.0, 6.0), contacts), EventDriven(), keep=1)
    assert m.status is Status.DONE
    energy = 0.5 * m.v[:, 0] ** 2 + 0.5 * inertia * m.v[:, 1] ** 2 + GRAVITY * m.q[:, 0]
    assert np.max(np.diff(energy)) < 1e-10
    np.testing.assert_allclose(m.q[-1], [0.4, 0.0], rtol=0, atol=1e-11)
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-11)
    gaps = [m.scene.gap(*state)[0].min() for state in zip(m.t, m.q, m.v, strict=True)]
    assert min(gaps) > -1e-11


# --- random pairs of springs between two walls, against SciPy


def springs(t, q, v, p, out):
    out[0] = math.cos(3.0 * t) - p[0] * q[0] - p[1] * q[1]
    out[1] = -p[1] * q[0] - p[2] * q[1]


def springs_by_scipy(scene, p):
    (t, t_end), G, offset = scene.t_span, np.asarray(scene.contacts.G), np.asarray(scene.contacts.offset)
    y, hits = np.concatenate([scene.q0, scene.v0]), []

    def rate(t, y):
        a = np.zeros(2)
        springs(t, y[:2], y[2:], p, a)
        return np.concatenate([y[2:], np.linalg.solve(scene.system.mass, a)])

    def wall(c):
        def gap(t, y):
            return G[c] @ y[:2] + offset[c]

        gap.terminal, gap.direction = True, -1.0
        return gap

    walls = [wall(0), wall(1)]
    while t < t_end:
        s = solve_ivp(rate, (t, t_end), y, "DOP853", rtol=1e-12, atol=1e-13, events=walls, max_step=0.02)
        t, y = s.t[-1], s.y[:, -1].copy()
        if s.status == 1:
            c = 0 if len(s.t_events[0]) else 1
            MG = np.linalg.solve(scene.system.mass, G[c])
            y[2:] -= (1.0 + scene.contacts.restitution[c]) * MG * (G[c] @ y[2:]) / (G[c] @ MG)
            hits.append((t, c))
    return y, hits


@pytest.mark.parametrize("seed", range(3, 8))
def test_coupled_springs_between_walls_move_as_scipy_says(seed):
    rng = np.random.default_rng(seed)
    M, K = (A @ A.T + np.eye(2) for A in rng.normal(size=(2, 2, 2)))
    p = [4.0 * K[0, 0], 4.0 * K[0, 1], 4.0 * K[1, 1]]
    contacts = LinearContacts(
        G=rng.normal(size=(2, 2)), offset=rng.uniform(0.1, 0.3, 2), restitution=rng.uniform(0.6, 1.0, 2)
    )
    scene = Scene(System(2, M, springs), [0.0, 0.0], 2.0 * rng.normal(size=2), (0.0, 8.0), contacts, p=p)
    m = simulate(scene, EventDriven())
    y, hits = springs_by_scipy(scene, p)
    assert len(hits) >= 7
    np.testing.assert_array_equal(m.impacts.contact, [c for _, c in hits])
    np.testing.assert_allclose(m.impacts.time, [t for t, _ in hits], rtol=0, atol=1e-10)
    np.testing.assert_allclose(np.concatenate([m.q[-1], m.v[-1]]), y, rtol=0, atol=1e-10)
