"""Positions put back onto joints and out of obstacles: what is repaired, and what it may not touch."""

import dataclasses
import math

import numpy as np
import pytest

from lagrangian import Joints, LinearContacts, LinearJoints, LinearSystem, Scene, System, scenes
from lcpstep import Moreau, simulate
from tests.models import BOWL, RISING_CIRCLE, bowl_scene

SCALE = 1e-12


def lowest_gap(scene, m):
    return min(np.min(scene.gap(t, q, v)[0]) for t, q, v in zip(m.t, m.q, m.v, strict=True))


def rolling_ball_in_a_bowl(t_end=3.0):
    return bowl_scene([math.sin(1.0), -math.cos(1.0)], [0.0, 0.0], t_end)


def falling_on_a_rising_circle():
    return Scene(
        system=LinearSystem(M=np.diag([1.0, 2.0]), force=[0.0, -2.0]),
        contacts=dataclasses.replace(RISING_CIRCLE, restitution=0.4),
        q0=[0.05, 1.6], v0=[0.0, 0.0], t_span=(0.0, 3.0), name="rising circle",
    )  # fmt: skip


@pytest.mark.parametrize(
    "scene",
    [
        scenes.bouncing_ball(t_end=3.0),
        rolling_ball_in_a_bowl(),
        falling_on_a_rising_circle(),
        scenes.double_pendulum(t_end=4.0),
        scenes.slope_landing(),
        scenes.cam_follower(rpm=660.0, t_end=0.3),
    ],
    ids=lambda s: s.name,
)
def test_no_obstacle_is_entered(scene):
    span = scene.t_span[1] - scene.t_span[0]
    plain, projected = (simulate(scene, Moreau(span / 700, projected=on)) for on in (False, True))
    assert projected.status.name == "DONE"
    assert lowest_gap(scene, plain) < -1e-7
    assert lowest_gap(scene, projected) >= -SCALE * max(1.0, np.max(np.abs(projected.q)))


@pytest.mark.parametrize("theta", [0.5, 1.0])
def test_forces_are_those_of_the_place_that_is_put_back(theta):
    """A step of a `System` began with the forces of the place inside the obstacle, not of a `LinearSystem`."""
    M, C, K, F = np.diag([1.0, 2.0]), 0.3 * np.eye(2), np.array([[300.0, -40.0], [-40.0, 50.0]]), [-30.0, 2.0]

    def force(t, q, v, p, out):
        out[0] = -30.0 - 0.3 * v[0] - 300.0 * q[0] + 40.0 * q[1]
        out[1] = 2.0 - 0.3 * v[1] + 40.0 * q[0] - 50.0 * q[1]

    contacts = LinearContacts([[1.0, 0.4], [-1.0, 0.3]], offset=[0.05, 0.1], restitution=0.6)
    linear, general = (
        simulate(
            Scene(system, [0.1, 0.0], [0.0, 1.0], (0.0, 2.0), contacts), Moreau(1e-2, theta, projected=True)
        )
        for system in (LinearSystem(M, C, K, F), System(2, M, force))
    )
    assert len(linear.impacts) > 5
    np.testing.assert_allclose(general.v, linear.v, atol=1e-8)


def test_a_ball_slides_on_the_bowl_without_leaving_it():
    scene = rolling_ball_in_a_bowl()
    errors = []
    for h in (1e-2, 2.5e-3):
        m = simulate(scene, Moreau(h, projected=True))
        assert np.max(np.hypot(*m.q.T) - 1.0) < SCALE
        assert np.max(1.0 - np.hypot(*m.q.T)) < h * h  # what falls back within a step stays free
        closed = m.impulse[1:, 0] > 0.0
        assert closed.mean() > 0.99
        errors.append(np.max(np.abs(0.5 * np.sum(m.v**2, axis=1) + m.q[:, 1] + math.cos(1.0))))
    assert errors[1] < 0.3 * errors[0]


def test_projection_moves_along_the_mass_metric_and_leaves_the_velocity():
    # one step of a mass that flies into a slanted wall: v is not touched by the projection, and q goes back by
    # M^-1 G^T lambda with G M^-1 G^T lambda = -g
    M, G = np.array([[2.0, 0.3], [0.3, 1.0]]), np.array([[0.6, 0.8]])
    scene = Scene(
        system=LinearSystem(M=M), contacts=LinearContacts(G, offset=0.08, restitution=0.5),
        q0=[0.0, 0.0], v0=[-1.0, -1.0], t_span=(0.0, 0.1), name="wall",
    )  # fmt: skip
    plain, projected = (simulate(scene, Moreau(0.1, projected=on)) for on in (False, True))
    np.testing.assert_array_equal(projected.v[-1], plain.v[-1])
    g = G @ plain.q[-1] + 0.08
    assert g[0] < -0.01
    X = np.linalg.solve(M, G.T)
    np.testing.assert_allclose(projected.q[-1], plain.q[-1] - X @ np.linalg.solve(G @ X, g), rtol=1e-14)


def test_a_pile_falls_to_rest_without_penetration():
    n = 8
    G = np.vstack([np.eye(n)[:1], np.diff(np.eye(n), axis=0)])
    scene = Scene(
        system=LinearSystem(M=np.eye(n), force=np.full(n, -9.81)), contacts=LinearContacts(G, restitution=0.5),
        q0=0.1 * np.arange(1, n + 1), v0=np.zeros(n), t_span=(0.0, 2.0), name="pile",
    )  # fmt: skip
    m = simulate(scene, Moreau(2e-3, projected=True))
    assert lowest_gap(scene, m) >= -SCALE
    assert np.max(np.abs(m.v[-1])) < 1e-12
    np.testing.assert_allclose(m.impulse[-1] / 2e-3, 9.81 * np.arange(n, 0, -1), rtol=1e-9)


def test_what_needs_no_correction_gets_none():
    scene = scenes.sliding_block()
    plain, projected = (simulate(scene, Moreau(1e-3, projected=on)) for on in (False, True))
    np.testing.assert_array_equal(projected.q, plain.q)
    np.testing.assert_array_equal(projected.v, plain.v)


def rods(t, q, v, p, out):
    """Closed chain: crank 1, coupler 2, rocker 1.5 on a ground of 2; q is (crank pin, rocker pin)."""
    out[0] = 0.5 * (q[0] ** 2 + q[1] ** 2 - 1.0)
    out[1] = 0.5 * ((q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - 4.0)
    out[2] = 0.5 * ((q[2] - 2.0) ** 2 + q[3] ** 2 - 2.25)


def rods_jacobian(t, q, v, p, out):
    for i in range(3):
        for j in range(4):
            out[i, j] = 0.0
    for i in range(2):
        out[0, i] = q[i]
        out[1, i], out[1, 2 + i] = q[i] - q[2 + i], q[2 + i] - q[i]
    out[2, 2], out[2, 3] = q[2] - 2.0, q[3]


def test_a_four_bar_linkage_stays_closed_and_keeps_its_energy():
    # crank pin at (0, 1): the rocker pin is where circles about it and about (2, 0) meet
    crank, ground = np.array([0.0, 1.0]), np.array([2.0, 0.0])
    d = np.linalg.norm(ground - crank)
    along = (4.0 - 2.25 + d * d) / (2.0 * d)
    e = (ground - crank) / d
    rocker = crank + along * e + math.sqrt(4.0 - along**2) * np.array([-e[1], e[0]])
    scene = Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, 2.0, 2.0]), force=[0.0, -9.81, 0.0, -19.62]),
        joints=Joints(3, rods, rods_jacobian),
        q0=[*crank, *rocker], v0=np.zeros(4), t_span=(0.0, 2.0), name="four-bar",
    )  # fmt: skip
    energies = []
    for h in (2e-3, 1e-3):
        m = simulate(scene, Moreau(h, projected=True))
        assert m.status.name == "DONE"
        g = np.zeros((len(m.t), 3))
        for row, q in zip(g, m.q, strict=True):
            rods(0.0, q, q, q, row)
        assert np.max(np.abs(g)) < SCALE
        E = 0.5 * m.v**2 @ [1.0, 1.0, 2.0, 2.0] + 9.81 * m.q @ [0.0, 1.0, 0.0, 2.0]
        assert np.ptp(m.q[:, 0]) > 0.5
        energies.append(np.ptp(E))
    assert energies[1] < 0.3 * energies[0]


def test_a_joint_and_an_obstacle_are_repaired_together():
    scene = Scene(
        system=LinearSystem(M=np.eye(3), force=[0.0, -1.0, 0.0]), joints=LinearJoints([[1.0, 0.0, -1.0]]),
        contacts=dataclasses.replace(BOWL_IN_SPACE, restitution=0.3),
        q0=[0.5, 0.0, 0.5], v0=[0.0, 0.0, 0.0], t_span=(0.0, 4.0), name="joined",
    )  # fmt: skip
    m = simulate(scene, Moreau(5e-3, projected=True))
    assert len(m.impacts) > 2
    assert lowest_gap(scene, m) >= -SCALE
    assert np.max(np.abs(m.q[:, 0] - m.q[:, 2])) < SCALE


def bowl_in_space_jacobian(t, q, v, p, out):
    r = math.hypot(q[0], q[1])
    out[0, 0], out[0, 1], out[0, 2] = -q[0] / r, -q[1] / r, 0.0


BOWL_IN_SPACE = dataclasses.replace(BOWL, jacobian=bowl_in_space_jacobian, bias=None)


def moved(t, q, v, p, out):
    """A position, and the same with a support that moves although its rate is not given."""
    out[0] = q[0] - 1.0
    out[1] = 2.0 * q[0] - 2.0 - 1e-3 * max(0.0, t - 0.1)


def moved_jacobian(t, q, v, p, out):
    out[0, 0], out[1, 0] = 1.0, 2.0


def test_joints_that_no_position_satisfies_end_the_run_in_words():
    scene = Scene(
        system=LinearSystem(M=1.0), joints=Joints(2, moved, moved_jacobian),
        q0=1.0, v0=0.0, t_span=(0.0, 1.0), name="moved",
    )  # fmt: skip
    m = simulate(scene, Moreau(1e-2, projected=True))
    assert m.status.name == "PROJECTION_FAILED"
    assert m.message.startswith("no position near satisfies all joints and contacts in step 10 at t = 0.1")
    assert m.t[-1] == pytest.approx(0.1)
    assert np.all(np.isfinite(m.q))
