"""Joints in the time-stepping, against motions in closed form and in fewer coordinates."""

import dataclasses
import math
from functools import partial

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrangian import Joints, LinearContacts, LinearJoints, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.errors import LcpStepError
from tests.stepping.jointed import (
    G0,
    locked,
    locked_jacobian,
    place,
    platform,
    platform_jacobian,
    point_on_a_rod,
    shaker,
    swing,
    three_parting,
    two_rods,
    two_rods_jacobian,
    wire,
    wire_jacobian,
    wire_rate,
)

LEVELS = (1e-2, 5e-3, 2.5e-3)


def order(errors, levels=LEVELS):
    return np.polyfit(np.log(levels), np.log(errors), 1)[0]


# --- one rod


def test_a_point_on_a_rod_moves_as_a_pendulum():
    errors, drifts, tensions = [], [], []
    for h in LEVELS:
        m = simulate(point_on_a_rod(2.0, 3.0), Moreau(h))
        angle, _ = swing(m.t, 2.0, math.sqrt(G0))
        errors.append(np.max(np.abs(m.q - np.stack([np.sin(angle), -np.cos(angle)], axis=1))))
        drifts.append(np.max(np.abs(np.hypot(*m.q.T) - 1.0)))
        _, rate = swing(m.t[1:] - 0.5 * h, 2.0, math.sqrt(G0))
        middle, _ = swing(m.t[1:] - 0.5 * h, 2.0, math.sqrt(G0))
        tensions.append(np.max(np.abs(-m.joint_impulse[1:, 0] / h - (rate**2 + G0 * np.cos(middle)))))
    assert order(errors) == pytest.approx(2.0, abs=0.1)
    assert order(drifts) == pytest.approx(2.0, abs=0.1)
    assert order(tensions) > 0.9
    assert errors[-1] < 2e-3


def test_a_point_on_a_rod_strikes_a_stop_as_the_angle_does():
    scene = scenes.pendulum_stop(form="rod", t_end=2.0)
    errors, levels = [], (8e-3, 2e-3, 5e-4)
    for h in levels:
        close = [simulate(scene, Moreau(h / s)) for s in (1.0, 1.07, 1.13, 1.21, 1.29, 1.37)]
        errors.append(np.mean([np.mean(np.abs(m.q - scene.exact(m.t)[0])) for m in close]))
        assert all(len(m.impacts) >= 2 for m in close)
    assert order(errors, levels) == pytest.approx(1.0, abs=0.3)


# --- more coordinates than freedom


def double_pendulum(t, y):
    a, b, da, db = y
    M = [[2.0, math.cos(a - b)], [math.cos(a - b), 1.0]]
    f = [-(db**2) * math.sin(a - b) - 2 * G0 * math.sin(a), da**2 * math.sin(a - b) - G0 * math.sin(b)]
    return [da, db, *np.linalg.solve(M, f)]


@pytest.mark.parametrize("projected", [False, True])
def test_two_points_on_rods_move_as_the_double_pendulum_in_angles(projected):
    known = solve_ivp(double_pendulum, (0.0, 1.5), [1.0, 2.0, 0.0, 0.0], rtol=1e-11, atol=1e-11).y[:2, -1]
    scene = Scene(
        system=LinearSystem(M=np.eye(4), force=[0.0, -G0, 0.0, -G0]),
        joints=Joints(2, two_rods, two_rods_jacobian),
        q0=place(1.0, 2.0), v0=np.zeros(4), t_span=(0.0, 1.5), name="two rods",
    )  # fmt: skip
    errors = []
    for h in LEVELS:
        m = simulate(scene, Moreau(h, projected=projected))
        errors.append(np.max(np.abs(m.q[-1] - place(*known))))
    assert order(errors) == pytest.approx(2.0, abs=0.15)
    if projected:
        g = np.array([np.hypot(*m.q[:, :2].T), np.hypot(*(m.q[:, 2:] - m.q[:, :2]).T)])
        assert np.max(np.abs(g - 1.0)) < 1e-12


@pytest.mark.parametrize("curved", [False, True])
def test_a_joint_locks_a_mechanism_whose_mass_depends_on_its_position(curved):
    # a double pendulum with its hinge locked: one rigid pendulum with (1 + 4) w' = -(1 + 2) g sin
    free = scenes.double_pendulum()
    joint = Joints(1, locked, locked_jacobian) if curved else LinearJoints([[1.0, -1.0]])
    scene = dataclasses.replace(
        free, contacts=None, joints=joint, q0=[1.0, 1.0], v0=[0.0, 0.0], t_span=(0.0, 2.0), exact=None
    )
    errors = []
    for h in LEVELS:
        m = simulate(scene, Moreau(h))
        errors.append(np.max(np.abs(m.q - swing(m.t, 1.0, math.sqrt(0.6 * G0))[0][:, None])))
        assert np.max(np.abs(m.q[:, 0] - m.q[:, 1])) < 1e-11
    assert order(errors) == pytest.approx(2.0, abs=0.1)


# --- joints that move


def test_a_bead_flies_out_along_a_turning_wire():
    w, t_end = 1.5, 1.5
    scene = Scene(
        system=LinearSystem(M=np.eye(2)), joints=Joints(1, wire, wire_jacobian, wire_rate), p=[w],
        q0=[1.0, 0.0], v0=[0.0, w], t_span=(0.0, t_end), name="wire",
    )  # fmt: skip
    errors, forces = [], []
    for h in LEVELS:
        m = simulate(scene, Moreau(h))
        r = np.cosh(w * m.t)
        exact = np.stack([r * np.cos(w * m.t), r * np.sin(w * m.t)], axis=1)
        errors.append(np.max(np.abs(m.q - exact)))
        coriolis = 2.0 * w * w * np.sinh(w * (m.t[1:] - 0.5 * h))
        forces.append(np.max(np.abs(m.joint_impulse[1:, 0] / h - coriolis)))
    assert order(errors) == pytest.approx(2.0, abs=0.1)
    assert order(forces) > 0.9


def test_a_driven_support_shakes_a_mass_on_a_spring():
    # x'' = -(x - sin 2t) from rest: x = (2 sin t - sin 2t) / 3
    scene = Scene(
        system=LinearSystem(M=np.eye(2), K=[[1.0, -1.0], [-1.0, 1.0]]),
        joints=LinearJoints([[1.0, 0.0]], motion=shaker),
        q0=[0.0, 0.0], v0=[2.0, 0.0], t_span=(0.0, 5.0), name="shaker",
    )  # fmt: skip
    errors = []
    for h in LEVELS:
        m = simulate(scene, Moreau(h))
        errors.append(np.max(np.abs(m.q[:, 1] - (2.0 * np.sin(m.t) - np.sin(2.0 * m.t)) / 3.0)))
    assert order(errors) == pytest.approx(2.0, abs=0.1)


# --- joints that say the same, or the contrary


@pytest.mark.parametrize("projected", [False, True])
def test_a_platform_on_three_parallel_rods_is_not_locked_by_the_third(projected):
    # it moves along a circle without turning, as a pendulum; two rods would do
    scene = Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, 0.2]), force=[0.0, -G0, 0.0]), p=[-1.0, 0.3, 1.0],
        joints=Joints(3, platform, platform_jacobian),
        q0=[math.sin(1.0), -math.cos(1.0), 0.0], v0=np.zeros(3), t_span=(0.0, 3.0), name="platform",
    )  # fmt: skip
    errors = []
    for h in LEVELS:
        m = simulate(scene, Moreau(h, projected=projected))
        assert m.status.name == "DONE"
        angle, _ = swing(m.t, 1.0, math.sqrt(G0))
        errors.append(np.max(np.abs(m.q[:, :2] - np.stack([np.sin(angle), -np.cos(angle)], axis=1))))
        assert np.max(np.abs(m.q[:, 2])) < 1e-9
    assert order(errors) == pytest.approx(2.0, abs=0.15)


def event_driven(h):
    """EventDriven, its states kept at steps of h."""
    return EventDriven()


@pytest.mark.parametrize("method", [Moreau, Located, partial(Located, order=4), event_driven])
def test_redundant_joints_share_the_force_and_change_no_motion(method):
    # the same joint three times, once doubled, once reversed: each carries a third, in its own unit
    def pair(G):
        return Scene(
            system=LinearSystem(M=np.diag([1.0, 2.0]), force=[1.0, 0.0]), joints=LinearJoints(G),
            q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.0), name="pair",
        )  # fmt: skip

    h = 1e-2
    one, three = (
        simulate(pair(G), method(h), keep=np.linspace(0.0, 1.0, 101))
        for G in ([[1, -1]], [[1, -1], [2, -2], [-1, 1]])
    )
    np.testing.assert_allclose(three.q, one.q, rtol=0, atol=1e-15)
    np.testing.assert_allclose(one.q[-1], 1 / 6, rtol=1e-12)
    np.testing.assert_allclose(one.joint_impulse[1:, 0], -2 / 3 * h, rtol=1e-12)
    np.testing.assert_allclose(
        three.joint_impulse[1:], np.tile(np.array([-2, -1, 2]) / 9 * h, (100, 1)), rtol=1e-12
    )


@pytest.mark.parametrize("order", [2, 4])
def test_three_parallel_rods_share_the_tension_alike_by_steps_and_from_event_to_event(order):
    # as far as the platform hangs on each of them, whose shares turn with it, through a blow of its wall
    scene = Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, 0.2]), force=[0.0, -G0, 0.0]), p=[-1.0, 0.3, 1.0],
        joints=Joints(3, platform, platform_jacobian), q0=[math.sin(1.0), -math.cos(1.0), 0.0], v0=np.zeros(3),
        t_span=(0.0, 2.0), contacts=LinearContacts([[1.0, 0.0, 0.0]], offset=0.3, restitution=0.7), name="platform",
    )  # fmt: skip
    at = np.linspace(0.0, 2.0, 21)
    exact = simulate(scene, EventDriven(1e-12, 1e-12), keep=at)
    assert len(exact.impacts) > 1
    assert np.all(np.abs(exact.joint_impulse.sum(axis=0)) > 1.0)
    errors = []
    for n in (100, 200, 400):
        m = simulate(scene, Located(2.0 / n, order), keep=at)
        errors.append(np.max(np.abs(np.cumsum(m.joint_impulse - exact.joint_impulse, axis=0))))
    assert np.log2(errors[0] / errors[-1]) / 2.0 > order - 0.3


def test_contradicting_joints_end_the_run_with_their_names():
    scene = Scene(
        system=LinearSystem(M=np.eye(3)),
        joints=LinearJoints([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], motion=three_parting),
        q0=np.zeros(3), v0=[0.0, 1.0, 0.0], t_span=(0.0, 1.0), name="parting",
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-2))
    assert m.status.name == "JOINTS_FAILED"
    assert m.message.startswith("joints [1, 2] contradict each other in step 50 at t = 0.5 s")
    assert m.t[-1] == pytest.approx(0.5)
    assert np.all(np.isfinite(m.q))


def test_a_joint_and_a_floor_hold_a_mass_in_balance():
    # on the line x = y, above the floor 0.6 x + 0.8 y = 0: 1.4 lambda = g
    h = 1e-3
    scene = Scene(
        system=LinearSystem(M=np.eye(2), force=[0.0, -G0]), joints=LinearJoints([[1.0, -1.0]]),
        contacts=LinearContacts([[0.6, 0.8]], restitution=0.5),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 1.0), name="balance",
    )  # fmt: skip
    m = simulate(scene, Moreau(h))
    assert np.max(np.abs(m.q)) < 1e-13
    np.testing.assert_allclose(m.impulse[1:, 0], h * G0 / 1.4, rtol=1e-10)
    np.testing.assert_allclose(m.joint_impulse[1:, 0], -0.6 * h * G0 / 1.4, rtol=1e-10)


def test_impulses_add_up_between_kept_states():
    scene = point_on_a_rod(1.0, 1.0, LinearContacts([[1.0, 0.0]], restitution=0.5))
    every, tenth = (simulate(scene, Moreau(1e-2), keep=k) for k in (1, 10))
    assert every.joint_impulse.shape == (101, 1)
    assert every.friction_impulse.shape == (101, 0)
    np.testing.assert_allclose(
        tenth.joint_impulse[1:, 0], every.joint_impulse[1:, 0].reshape(10, 10).sum(axis=1), rtol=1e-14
    )
    np.testing.assert_allclose(
        tenth.impulse[1:, 0], every.impulse[1:, 0].reshape(10, 10).sum(axis=1), rtol=1e-14
    )


def test_solvers_that_are_not_compiled_with_the_loop_are_refused():
    with pytest.raises(LcpStepError, match="take lcp='lemke'"):
        simulate(point_on_a_rod(1.0, 1.0), Moreau(1e-2, lcp="qp"))


def broken(t, q, v, p, out):
    out[0] = float("nan") if t > 0.2 else 0.0
    out[1] = 0.0


def test_a_callback_that_breaks_in_a_scene_with_joints_is_named():
    from lcpstep.errors import SimulationError

    scene = Scene(
        system=System(2, np.eye(2), broken), joints=LinearJoints([[1.0, 0.0]]),
        q0=[0.0, 0.0], v0=[0.0, 1.0], t_span=(0.0, 1.0), name="broken",
    )  # fmt: skip
    with pytest.raises(SimulationError, match=r"system\.force") as caught:
        simulate(scene, Moreau(1e-2))
    assert np.all(np.isfinite(caught.value.trajectory.q))


@pytest.mark.parametrize("ratio", [1e4, 1e6])
def test_a_heavy_body_held_by_a_light_one_stays(ratio):
    scene = Scene(
        LinearSystem(np.diag([ratio, 1.0]), force=[ratio, 0.0]), q0=[0, 0], v0=[0, 0], t_span=(0.0, 0.1),
        joints=LinearJoints([[1.0, -1.0], [0.0, 1.0]]),
    )  # fmt: skip
    m = simulate(scene, Moreau(h=1e-2))
    assert m.status.name == "DONE"
    np.testing.assert_allclose(m.q, 0.0, atol=1e-10)
    np.testing.assert_allclose(m.joint_impulse[-1], [-ratio * 1e-2, -ratio * 1e-2], rtol=1e-6)
