"""Pendulums by rods and in angles, a double one between walls: joints with contacts, masses that vary."""

from __future__ import annotations

import importlib
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrangian import (
    Contacts,
    Coulomb,
    Joints,
    LinearContacts,
    LinearJoints,
    LinearSystem,
    Scene,
    System,
    scenes,
)
from lcpstep import EventDriven, Status, simulate
from tests.events.rough import rod, rod_row
from tests.models import GRAVITY

double_pendulum = importlib.import_module("lagrangian.scenes.double_pendulum")
pendulums = importlib.import_module("lagrangian.scenes.pendulum")


# --- rods


def above_a_floor(angle, height, t_end, restitution=0.5, friction=None):
    """A point on a rod of length 1, let go at an angle; the floor is `height` above its lowest place."""
    return Scene(
        LinearSystem(np.eye(2), force=[0.0, -GRAVITY]), q0=[math.sin(angle), -math.cos(angle)], v0=[0.0, 0.0],
        t_span=(0.0, t_end), joints=Joints(1, rod, rod_row),
        contacts=LinearContacts([[0.0, 1.0]], 1.0 - height, restitution, friction=friction),
    )  # fmt: skip


def swung(angle, until, **settings):
    """The angle and its speed of a free pendulum, by its equation in the angle."""
    return solve_ivp(
        lambda t, x: [x[1], -GRAVITY * math.sin(x[0])], (0.0, until), [angle, 0.0], method="DOP853", rtol=1e-13,
        atol=1e-13, **settings,
    )  # fmt: skip


@pytest.mark.parametrize("law", [None, "moreau", "newton", "stronge"])
@pytest.mark.parametrize("angle", [0.01, 0.1, 0.5, 1.0, -1.3, 2.0, 2.5])
@pytest.mark.parametrize("tolerance", [1e-6, 1e-8, 1e-10, 1e-11, 1e-12])
def test_a_point_that_a_rod_leads_along_the_floor_swings_freely(tolerance, angle, law):
    friction = None if law is None else Coulomb(0.3, [[1.0, 0.0]], law=law)
    m = simulate(above_a_floor(angle, 0.0, 3.0, friction=friction), EventDriven(tolerance, tolerance))
    assert m.status is Status.DONE
    assert len(m.impacts) == 0
    (phi, _) = swung(angle, 3.0).y[:, -1]
    np.testing.assert_allclose(m.q[-1], [math.sin(phi), -math.cos(phi)], rtol=0, atol=tolerance + 1e-10)


@pytest.mark.parametrize("tolerance", [1e-12, 1e-10, 1e-8])
@pytest.mark.parametrize("normal", [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.6, 0.8)])
@pytest.mark.parametrize(("weight", "speed"), [(0.0, 3.0), (0.0, 20.0), (10.0, 7.0), (10.0, 20.0)])
def test_a_point_that_goes_round_on_a_rod_passes_a_wall_that_its_circle_touches(
    weight, speed, normal, tolerance
):
    """Turn for turn it touches the wall at full speed, by no more than errors of its gap."""
    low = (0.0, -1.0) if normal[0] else (1.0, 0.0)
    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -weight]), low, speed * np.array([-low[1], low[0]]), (0.0, 4.0),
        joints=Joints(1, rod, rod_row), contacts=LinearContacts([normal], 1.0, 0.5),
    )  # fmt: skip
    run = simulate(scene, EventDriven(tolerance, tolerance))
    energy = 0.5 * np.sum(run.v**2, axis=1) + weight * run.q[:, 1]
    assert np.ptp(energy) <= 20.0 * tolerance * speed**2
    free = simulate(replace(scene, contacts=None), EventDriven())
    np.testing.assert_allclose(run.q[-1], free.q[-1], rtol=0, atol=20.0 * tolerance * speed)


@pytest.mark.parametrize("height", [1e-3, 1e-5, 1e-7, 1e-9, 1e-11])
def test_a_floor_above_the_lowest_place_of_a_rod_turns_it_back(height):
    """Elastically: at twice the time of the impact it is where it began."""
    lowest = 2.0 * math.asin(math.sqrt(0.5 * height))

    def meets(t, x):
        return x[0] - lowest

    meets.terminal = True
    hit = swung(1.0, 3.0, events=meets).t[-1]
    m = simulate(above_a_floor(1.0, height, 2.0 * hit, restitution=1.0), EventDriven())
    assert m.impacts.time == pytest.approx([hit], abs=1e-10)
    np.testing.assert_allclose(m.q[-1], m.q[0], rtol=0, atol=1e-6)


@pytest.mark.parametrize("r", [0.0, 0.5, 1.0])
def test_a_point_on_a_rod_strikes_a_stop_like_a_pendulum(r):
    scene = scenes.pendulum_stop(form="rod", restitution=r, t_end=5.0)
    m = simulate(scene, EventDriven())
    q, v = scene.exact(m.t)
    np.testing.assert_allclose(m.q, q, rtol=0, atol=1e-10)
    away = np.min(np.abs(m.t[:, None] - m.impacts.time), axis=1) > 1e-9  # the same side of every jump
    np.testing.assert_allclose(m.v[away], v[away], rtol=0, atol=1e-10)
    assert np.max(np.abs(np.hypot(*m.q.T) - 1.0)) < 1e-12
    assert np.max(np.abs(np.sum(m.q * m.v, axis=1))) < 1e-12


def test_the_impulse_of_a_rod_is_that_of_its_tension():
    times = np.linspace(0.0, 2.0, 201)
    m = simulate(scenes.pendulum_stop(form="rod", t_end=2.0), EventDriven(), keep=times)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    exact = scenes.pendulum_stop(form="rod", t_end=2.0).exact
    for k in range(200):
        a, b = times[k], times[k + 1]
        if np.any((m.impacts.time >= a) & (m.impacts.time <= b)):
            continue
        q, v = exact(0.5 * (a + b) + 0.5 * (b - a) * nodes)
        rate = np.hypot(*v.T)
        tension = pendulums.tension(np.arctan2(q[:, 0], -q[:, 1]), rate, 1.0, GRAVITY)
        expected = -0.5 * (b - a) * weights @ tension
        assert m.joint_impulse[k + 1, 0] == pytest.approx(expected, abs=1e-8 * (b - a))


def circle_twice(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)
    out[1] = q[0] * q[0] + q[1] * q[1] - 1.0


def circle_twice_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]
    out[1, 0], out[1, 1] = 2.0 * q[0], 2.0 * q[1]


def circle_and_line(t, q, v, p, out):
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)
    out[1] = q[0] - 1.0


def circle_and_line_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = q[0], q[1]
    out[1, 0], out[1, 1] = 1.0, 0.0


def test_a_joint_given_twice_changes_nothing():
    system = LinearSystem(M=np.eye(2), force=[0.0, -GRAVITY])
    joints = Joints(2, circle_twice, circle_twice_jacobian)
    m = simulate(Scene(system, [1.0, 0.0], [0.0, 0.0], (0.0, 3.0), joints=joints), EventDriven())
    energy = 0.5 * np.sum(m.v**2, axis=1) + GRAVITY * m.q[:, 1]
    assert np.max(np.abs(energy)) < 1e-10
    assert np.max(np.abs(np.hypot(*m.q.T) - 1.0)) < 1e-12


def test_joints_that_contradict_each_other_are_named():
    # a point on the unit circle and on its tangent x = 1, which it cannot follow with the speed 1
    system = LinearSystem(M=np.eye(2), force=[0.0, -GRAVITY])
    joints = Joints(2, circle_and_line, circle_and_line_jacobian)
    m = simulate(Scene(system, [1.0, 0.0], [0.0, 1.0], (0.0, 1.0), joints=joints), EventDriven())
    assert m.status is Status.JOINTS_FAILED
    assert "joint 1" in m.message
    assert "t = 0" in m.message


def test_a_contact_meets_a_body_hung_on_a_joint():
    # two masses tied together fall on a floor under the first: the joint carries the blow to the second
    r, m1, m2 = 0.5, 2.0, 3.0
    scene = Scene(
        LinearSystem(M=np.diag([m1, m2]), force=[-GRAVITY * m1, -GRAVITY * m2]), [1.0, 2.0], [0.0, 0.0], (0.0, 0.6),
        LinearContacts(G=[[1.0, 0.0]], restitution=r), LinearJoints(G=[[-1.0, 1.0]], offset=-1.0),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    u = math.sqrt(2 * GRAVITY)
    (hit,) = m.impacts
    assert hit.time == pytest.approx(u / GRAVITY, abs=1e-14)
    assert hit.impulse == pytest.approx((1 + r) * u * (m1 + m2), rel=1e-14)
    assert m.joint_impulse.sum() == pytest.approx((1 + r) * u * m2, rel=1e-14)
    np.testing.assert_allclose(m.q[:, 1] - m.q[:, 0], 1.0, rtol=0, atol=1e-14)


# --- nonlinear mass


def two_walls(t, q, v, p, out):
    tip = math.sin(q[0]) + math.sin(q[1])
    out[0], out[1] = p[1] - tip, tip + 1.9


def two_walls_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = -math.cos(q[0]), -math.cos(q[1])
    out[1, 0], out[1, 1] = math.cos(q[0]), math.cos(q[1])


def wall_of_two(c):
    def hit(t, y):
        tip = math.sin(y[0]) + math.sin(y[1])
        return -tip if c == 0 else tip + 1.9

    hit.terminal, hit.direction = True, -1.0
    return hit


def smooth(t, y):
    M, f = np.zeros((2, 2)), np.zeros(2)
    double_pendulum.mass(t, y[:2], y[2:], None, M)
    double_pendulum.force(t, y[:2], y[2:], (GRAVITY, 0.0), f)
    return np.concatenate([y[2:], np.linalg.solve(M, f)])


def by_scipy(y, t_end, r):
    """The same motion, impact after impact, by SciPy's DOP853 and its events."""
    t, hits, walls = 0.0, [], [wall_of_two(0), wall_of_two(1)]
    while t < t_end:
        s = solve_ivp(smooth, (t, t_end), y, "DOP853", rtol=1e-13, atol=1e-13, events=walls)
        t, y = s.t[-1], s.y[:, -1].copy()
        if s.status == 1:
            M, G = np.zeros((2, 2)), np.zeros((2, 2))
            double_pendulum.mass(t, y[:2], y[2:], None, M)
            two_walls_jacobian(t, y[:2], y[2:], None, G)
            c = 0 if len(s.t_events[0]) else 1
            MG = np.linalg.solve(M, G[c])
            y[2:] -= (1 + r) * MG * (G[c] @ y[2:]) / (G[c] @ MG)
            hits.append((t, c))
    return y, hits


def test_a_double_pendulum_between_two_walls_moves_as_scipy_says():
    r, y0 = 0.7, np.array([-1.0, -1.2, 0.0, 0.0])
    scene = Scene(
        System(2, double_pendulum.mass, double_pendulum.force), y0[:2], y0[2:], (0.0, 2.5),
        Contacts(2, two_walls, two_walls_jacobian, restitution=r), p=[GRAVITY, 0.0],
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    y, hits = by_scipy(y0, 2.5, r)
    assert len(hits) >= 2
    np.testing.assert_allclose(m.impacts.time, [t for t, _ in hits], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(m.impacts.contact, [c for _, c in hits])
    np.testing.assert_allclose(np.concatenate([m.q[-1], m.v[-1]]), y, rtol=0, atol=1e-8)


def test_the_double_pendulum_of_many_digits():
    scene = scenes.double_pendulum()
    far = Contacts(2, two_walls_one_far, two_walls_jacobian, restitution=0.7)
    several = Scene(scene.system, scene.q0, scene.v0, scene.t_span, far, p=scene.p)
    m = simulate(several, EventDriven())
    np.testing.assert_allclose(m.impacts.time, double_pendulum.REFERENCE_IMPACTS, rtol=0, atol=1e-11)
    states = np.hstack(m.at(double_pendulum.REFERENCE_TIMES))
    np.testing.assert_allclose(states, double_pendulum.REFERENCE_STATES, rtol=0, atol=1e-10)


def two_walls_one_far(t, q, v, p, out):
    tip = math.sin(q[0]) + math.sin(q[1])
    out[0], out[1] = p[1] - tip, tip + 5.0
