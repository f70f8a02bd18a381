"""Joints that move, lock, or say the same, in the steps with located impacts: against closed forms."""

import math

import numpy as np
import pytest

from lagrangian import Joints, LinearContacts, LinearJoints, LinearSystem, Scene, scenes
from lcpstep import Located, simulate
from tests.stepping.jointed import (
    G0,
    errors_of,
    locked,
    locked_jacobian,
    platform,
    platform_jacobian,
    shaker,
    swing,
    three_parting,
    wire,
    wire_jacobian,
    wire_rate,
)
from tests.stepping.test_order import slope

# --- joints that move, masses that depend on the position


@pytest.mark.parametrize("curved", [False, True])
def test_a_joint_locks_a_mechanism_whose_mass_depends_on_its_position(curved):
    # a double pendulum with its hinge locked: one rigid pendulum with (1 + 4) w' = -(1 + 2) g sin
    joints = Joints(1, locked, locked_jacobian) if curved else LinearJoints([[1.0, -1.0]])
    free = scenes.double_pendulum()
    scene = Scene(free.system, [1.0, 1.0], [0.0, 0.0], (0.0, 2.0), joints=joints, p=free.p)
    at, levels = np.linspace(0.0, 2.0, 101), (100, 200, 400)
    errors = errors_of(scene, levels, at, swing(at, 1.0, math.sqrt(0.6 * G0))[0][:, None])
    assert slope(levels, errors) >= 1.9


def test_a_bead_flies_out_along_a_turning_wire():
    w, t_end = 1.5, 1.5
    scene = Scene(
        LinearSystem(M=np.eye(2)), [1.0, 0.0], [0.0, w], (0.0, t_end),
        joints=Joints(1, wire, wire_jacobian, wire_rate), p=[w],
    )  # fmt: skip
    at, levels = np.linspace(0.0, t_end, 101), (75, 150, 300)
    r = np.cosh(w * at)
    known = np.stack([r * np.cos(w * at), r * np.sin(w * at)], axis=1)
    assert slope(levels, errors_of(scene, levels, at, known)) >= 1.9
    forces = []
    for n in levels:
        m = simulate(scene, Located(t_end / n))
        middle = 0.5 * (m.t[1:] + m.t[:-1])
        coriolis = 2.0 * w * w * np.sinh(w * middle)
        forces.append(np.max(np.abs(m.joint_impulse[1:, 0] / (t_end / n) - coriolis)))
    assert slope(levels, forces) >= 1.9


def test_a_driven_support_shakes_a_mass_on_a_spring():
    # x'' = -(x - sin 2t) from rest: x = (2 sin t - sin 2t) / 3
    scene = Scene(
        LinearSystem(M=np.eye(2), K=[[1.0, -1.0], [-1.0, 1.0]]), [0.0, 0.0], [2.0, 0.0], (0.0, 5.0),
        joints=LinearJoints([[1.0, 0.0]], motion=shaker),
    )  # fmt: skip
    at, levels = np.linspace(0.0, 5.0, 101), (100, 200, 400)
    known = np.stack([np.sin(2.0 * at), (2.0 * np.sin(at) - np.sin(2.0 * at)) / 3.0], axis=1)
    assert slope(levels, errors_of(scene, levels, at, known)) >= 1.9


def shaken(t, q, v, p, out):
    out[:] = 0.0
    out[0] = 0.1 * math.sin(3.0 * t), 0.3 * math.cos(3.0 * t), -0.9 * math.sin(3.0 * t)


def shaking_force(t, q, v, p, out):
    out[0], out[1] = 0.9 * math.sin(3.0 * t) - 0.4 * math.sin(3.0 * t), -3.0


def test_a_joint_in_a_moving_frame_feels_the_force_of_the_frame_alone():
    # M v' + K q = F - M c'' - K c, and the joint as it is
    def scene(**options):
        return Scene(
            LinearSystem(M=np.diag([1.0, 2.0]), K=np.diag([4.0, 0.0]), **options), [0.1, 0.1], [0.0, 0.0], (0.0, 5.0),
            contacts=LinearContacts(G=[[1.0, 0.0]], offset=0.2, restitution=0.5), joints=LinearJoints([[1.0, -1.0]]),
        )  # fmt: skip

    frame = simulate(scene(force=[0.0, -3.0], frame=shaken), Located(1e-2), keep=1)
    force = simulate(scene(force=shaking_force), Located(1e-2), keep=1)
    assert len(frame.impacts) == len(force.impacts) > 10
    np.testing.assert_allclose(frame.q, force.q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(frame.joint_impulse, force.joint_impulse, rtol=0, atol=1e-12)
    assert np.max(np.abs(frame.joint_drift)) < 1e-13


# --- joints that say the same, or the contrary


def test_a_platform_on_three_parallel_rods_is_not_locked_by_the_third():
    # it moves along a circle without turning, as a pendulum; two rods would do
    scene = Scene(
        LinearSystem(M=np.diag([1.0, 1.0, 0.2]), force=[0.0, -G0, 0.0]), [math.sin(1.0), -math.cos(1.0), 0.0],
        np.zeros(3), (0.0, 3.0), joints=Joints(3, platform, platform_jacobian), p=[-1.0, 0.3, 1.0],
    )  # fmt: skip
    at, levels = np.linspace(0.0, 3.0, 101), (100, 200, 400)
    angle, _ = swing(at, 1.0, math.sqrt(G0))
    known = np.stack([np.sin(angle), -np.cos(angle), 0.0 * angle], axis=1)
    assert slope(levels, errors_of(scene, levels, at, known)) >= 1.9


def test_contradicting_joints_end_the_run():
    scene = Scene(
        LinearSystem(M=np.eye(3)), np.zeros(3), [0.0, 1.0, 0.0], (0.0, 1.0),
        joints=LinearJoints([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], motion=three_parting),
    )  # fmt: skip
    m = simulate(scene, Located(1e-2))
    assert m.status.name in ("JOINTS_FAILED", "PROJECTION_FAILED")
    assert m.t[-1] == pytest.approx(0.5, abs=2e-2)
    assert np.all(np.isfinite(m.q))
