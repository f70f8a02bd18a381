"""Joints and contacts in the steps with located impacts: against closed forms, angles, event-driven motions."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Contacts, Joints, LinearContacts, LinearJoints, LinearSystem, Scene, scenes
from lagrangian.scenes.double_pendulum import REFERENCE_STATES, REFERENCE_TIMES, as_points
from lagrangian.scenes.pendulum import tension
from lcpstep import EventDriven, Kind, LcpStepError, Located, simulate
from tests.known import SPREAD
from tests.stepping.jointed import G0, errors_of, place, point_on_a_rod, two_rods, two_rods_jacobian
from tests.stepping.test_order import slope

# --- the pendulum with a stop


def test_a_point_on_a_rod_strikes_a_stop_with_order_two():
    scene = scenes.pendulum_stop(form="rod")
    at, levels = np.linspace(*scene.t_span, 50), (125, 250, 500)
    assert slope(levels, errors_of(scene, levels, at, scene.exact(at)[0])) >= 1.9


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [1.0, 0.8, 0.0])
def test_a_point_on_a_rod_strikes_a_stop_as_the_angle_does(restitution):
    rod, angle = (scenes.pendulum_stop(form=form, restitution=restitution) for form in ("rod", "angle"))
    at, levels = np.linspace(*rod.t_span, 200), (125, 250, 500, 1000, 2000)
    errors = errors_of(rod, levels, at, rod.exact(at)[0], SPREAD[:3])
    assert slope(levels, errors) >= 1.9
    for n in levels[::2]:
        a, b = (simulate(scene, Located(5.0 / n), keep=at) for scene in (rod, angle))
        assert np.sum(a.impacts.before < -1e-6) == np.sum(b.impacts.before < -1e-6)
        assert np.max(np.abs(np.arctan2(a.q[:, 0], -a.q[:, 1]) - b.q[:, 0])) < 3.0 * errors[levels.index(n)]


def test_the_tension_of_the_rod_is_of_order_two():
    scene, angle = scenes.pendulum_stop(form="rod"), scenes.pendulum_stop().exact
    times = np.arange(0.0, 5.0, 0.05)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    levels, errors = (100, 200, 400), []
    for n in levels:
        m = simulate(scene, Located(5.0 / n), keep=times)
        worst = 0.0
        for k in range(1, len(times)):
            if not np.any((m.impacts.time >= times[k - 1]) & (m.impacts.time <= times[k])):
                theta, rate = angle(times[k - 1] + 0.025 * (1.0 + nodes))
                mean = 0.5 * weights @ tension(theta, rate, 1.0, 9.81)[:, 0]
                worst = max(worst, abs(-m.joint_impulse[k, 0] / 0.05 - mean))
        errors.append(worst)
    assert slope(levels, errors) >= 1.9
    assert errors[-1] < 5e-3


@pytest.mark.slow
def test_a_rod_swings_for_long_without_drift_and_keeps_its_energy():
    scene = point_on_a_rod(2.0, 100.0)
    drifts = []
    for h in (2e-2, 1e-2):
        m = simulate(scene, Located(h))
        energy = 0.5 * np.sum(m.v**2, axis=1) + G0 * m.q[:, 1]
        drifts.append(np.max(np.abs(energy - energy[0])))
        assert np.max(m.joint_drift) < 1e-12
        assert np.max(np.abs(np.sum(m.q * m.v, axis=1))) < 1e-12
    assert drifts[1] < 0.3 * drifts[0]


def test_impulses_add_up_between_kept_states():
    scene = scenes.pendulum_stop(form="rod", t_end=2.0)
    every, some = simulate(scene, Located(1e-2)), simulate(scene, Located(1e-2), keep=[0.123, 0.777, 2.0])
    hits = simulate(scene, Located(1e-2), keep="impacts")
    for m in (every, some, hits):
        assert m.joint_impulse.shape == (len(m.t), 1)
    np.testing.assert_allclose(some.joint_impulse.sum(), every.joint_impulse.sum(), rtol=1e-13)
    np.testing.assert_allclose(hits.joint_impulse.sum(), every.joint_impulse.sum(), rtol=1e-13)


@pytest.mark.parametrize("method", [Located(0.05), Located(0.05, 4), Located(0.05, 4, tolerance=1e-5)])
def test_states_between_lead_up_to_the_next_kept_one(method):
    """What the joints have put back at the end of a step, by its error, is part of the motion within it."""
    m = simulate(scenes.pendulum_stop(form="rod", t_end=2.0), method)
    q, v = m.at(np.nextafter(m.t[1:], -np.inf))
    struck = np.isin(m.t[1:], m.impacts.time)
    assert 0 < np.sum(struck) < len(struck)
    assert np.max(np.abs(q - m.q[1:])) < 1e-14
    assert np.max(np.abs(v - m.v[1:])[~struck]) < 1e-13


# --- two rods


def wall(t, q, v, p, out):
    out[0] = p[0] - q[2]


def wall_jacobian(t, q, v, p, out):
    out[0, 0] = out[0, 1] = out[0, 3] = 0.0
    out[0, 2] = -1.0


def two_points(a, b, t_end, contacts=None, p=None):
    """Two unit masses on two unit rods, one hung on the other."""
    return Scene(
        LinearSystem(M=np.eye(4), force=[0.0, -G0, 0.0, -G0]), place(a, b), np.zeros(4), (0.0, t_end),
        contacts=contacts, joints=Joints(2, two_rods, two_rods_jacobian), p=p, name="two rods",
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("curved", [False, True])
def test_a_double_pendulum_by_joints_strikes_a_wall_as_in_angles(curved):
    scene = scenes.double_pendulum(form="rods")
    if curved:
        scene = replace(scene, contacts=Contacts(1, wall, wall_jacobian, restitution=0.7), p=[0.0])
    levels = (300, 600, 1200, 2400)
    errors = errors_of(scene, levels, REFERENCE_TIMES, as_points(REFERENCE_STATES)[:, :4], SPREAD[:3])
    assert slope(levels, errors) >= 1.9


def both_stops(restitution):
    """A wall on either side of the double pendulum: the upper mass strikes the left one, the tip the right one."""
    G = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0]]
    return two_points(0.5, -0.2, 2.0, LinearContacts(G, offset=[0.0, 0.3], restitution=restitution))


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [0.6, 0.0])
def test_two_rods_between_two_stops_converge_with_order_two(restitution):
    scene = both_stops(restitution)
    at = np.linspace(0.0, 2.0, 101)
    exact = simulate(scene, EventDriven(), keep=at)
    assert len(set(exact.impacts.contact)) == 2
    levels = (100, 200, 400, 800, 1600)
    errors = errors_of(scene, levels, at, exact.q, SPREAD[:3])
    assert slope(levels, errors) >= 1.9
    fine = simulate(scene, Located(1e-3), keep=at)
    assert np.max(np.abs(fine.impulse.sum(axis=0) - exact.impulse.sum(axis=0))) < 2e-3
    assert np.max(np.abs(fine.joint_impulse.sum(axis=0) - exact.joint_impulse.sum(axis=0))) < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize("restitution", [0.9, [1.0, 0.3], 0.0])
def test_impacts_never_create_energy_and_leave_the_joints_alone(restitution):
    scene = both_stops(restitution)
    m = simulate(scene, Located(1e-2), keep="impacts")
    energy = 0.5 * np.sum(m.v**2, axis=1)
    before = simulate(scene, Located(1e-2), keep=np.unique(m.impacts.time - 1e-9))
    for t in np.unique(m.impacts.time[m.impacts.kind == Kind.IMPACT]):
        i, k = np.argmin(np.abs(m.t - t)), np.argmin(np.abs(before.t - t))
        assert energy[i] <= 0.5 * np.sum(before.v[k] ** 2) + 1e-6
    J, rates = np.zeros((2, 4)), []
    for q, v in zip(m.q, m.v, strict=True):
        two_rods_jacobian(0.0, q, v, [], J)
        rates.append(J @ v)
    assert np.max(np.abs(rates)) < 1e-12
    assert np.max(m.joint_drift) < 1e-12


def test_the_blow_at_the_tip_is_shared_by_both_rods():
    # hanging straight, the tip is struck sideways: the rods turn, and no rod feels the blow; along them both do
    G = [[0.0, 0.0, 0.0, 1.0]]
    scene = Scene(
        LinearSystem(M=np.diag([1.0, 1.0, 2.0, 2.0]), force=np.zeros(4)), [0.0, 0.0, 0.0, -1.0],
        [0.0, -2.0, 0.0, -2.0], (0.0, 1.0), joints=LinearJoints([[0.0, 1.0, 0.0, -1.0]], offset=-1.0),
        contacts=LinearContacts(G, offset=1.5, restitution=0.5),
    )  # fmt: skip
    m = simulate(scene, Located(1e-2))
    assert m.impacts.time[0] == pytest.approx(0.25, abs=1e-14)
    np.testing.assert_allclose(m.v[-1], [0.0, 1.0, 0.0, 1.0], atol=1e-14)
    assert m.impulse.sum() == pytest.approx(3.0 * 3.0, rel=1e-13)
    assert m.joint_impulse.sum() == pytest.approx(3.0, rel=1e-13)


# --- sticking and release


@pytest.mark.slow
def test_a_mass_rests_sticks_and_leaves_as_the_joint_lets_it():
    """A driven mass tied to another one, which lies on a floor until the tie pulls it up."""
    scene = Scene(
        LinearSystem(M=np.eye(2), force=[0.0, -G0]), [0.0, 0.0], [0.0, 0.0], (0.0, 4.0),
        joints=LinearJoints([[1.0, -1.0]], motion=heave), contacts=LinearContacts([[0.0, 1.0]], restitution=0.3),
        p=[1.5 * G0],
    )  # fmt: skip
    exact = simulate(scene, EventDriven())
    kinds = set(exact.impacts.kind)
    assert {Kind.IMPACT, Kind.STICK, Kind.RELEASE} <= kinds
    at = np.linspace(0.0, 4.0, 201)
    errors = errors_of(scene, (200, 400, 800, 1600), at, exact.at(at)[0], SPREAD[:3])
    assert max(errors) < 1e-10  # under constant forces, on a joint whose place is known


def heave(t, q, v, p, out):
    """Distance of the first mass from the second one: its mass pulls the second up and lets it down again."""
    w = 2.0
    out[0, 0] = p[0] * (1.0 - math.cos(w * t)) / w**2 * 2.0
    out[0, 1] = p[0] * math.sin(w * t) / w * 2.0
    out[0, 2] = p[0] * math.cos(w * t) * 2.0


def test_a_joint_and_a_floor_hold_a_mass_in_balance():
    # on the line x = y, above the floor 0.6 x + 0.8 y = 0: 1.4 lambda = g
    h = 1e-2
    scene = Scene(
        LinearSystem(M=np.eye(2), force=[0.0, -G0]), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0),
        joints=LinearJoints([[1.0, -1.0]]), contacts=LinearContacts([[0.6, 0.8]], restitution=0.5),
    )  # fmt: skip
    m = simulate(scene, Located(h))
    assert np.max(np.abs(m.q)) < 1e-13
    np.testing.assert_allclose(m.impulse[1:, 0], h * G0 / 1.4, rtol=1e-10)
    np.testing.assert_allclose(m.joint_impulse[1:, 0], -0.6 * h * G0 / 1.4, rtol=1e-10)


# --- order 4, and a tolerance


@pytest.mark.parametrize("scene", [scenes.pendulum_stop(form="rod"), scenes.double_pendulum(form="rods")])
def test_order_four_and_tolerances_take_joints_and_contacts(scene):
    times = np.linspace(*scene.t_span, 41)[1:]
    exact = simulate(scene, EventDriven(1e-13, 1e-13), keep=times)

    def error(method):
        run = simulate(scene, method, keep=times)
        assert run.status.name == "DONE"
        assert run.friction_impulse.shape[1] == 0
        assert np.max(np.abs(run.joint_impulse.sum(axis=0) - exact.joint_impulse.sum(axis=0))) < 0.01
        return np.max(np.abs(run.q[-40:] - exact.q[-40:]))

    errors = [error(Located(h, order=4)) for h in (1e-2, 5e-3, 2.5e-3)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.7)
    for tolerance in (1e-4, 1e-6, 1e-8):
        assert error(Located(0.1, order=4, tolerance=tolerance)) < 2.0 * tolerance
    assert error(Located(0.1, tolerance=1e-5)) < 2e-5


def test_order_four_takes_joints_alone():
    """A pendulum on a rod, without its stop."""
    stop = scenes.pendulum_stop(form="rod")
    scene = replace(stop, contacts=None, exact=None, t_span=(0.0, 3.0))
    exact = simulate(scene, EventDriven(1e-13, 1e-13), keep=[3.0])
    errors = []
    for h in (2e-2, 1e-2, 5e-3):
        run = simulate(scene, Located(h, order=4), keep=[3.0])
        errors.append(np.max(np.abs(run.q[-1] - exact.q[-1])))
    assert np.all(np.log2(np.array(errors[:-1]) / errors[1:]) > 3.6)
    assert np.max(np.abs(simulate(scene, Located(0.1, order=4, tolerance=1e-8)).q[-1] - exact.q[-1])) < 1e-7


# --- what is refused


@pytest.mark.parametrize("options", [{"order": "exact"}])
def test_joints_are_refused_where_they_are_not_treated(options):
    with pytest.raises(LcpStepError, match="joints"):
        simulate(scenes.pendulum_stop(form="rod"), Located(1e-2, **options))


def test_a_start_beside_its_joints_by_rounding_is_at_rest():
    """It has speeds of 1e-14 m/s, by as much off the joints, which no impulses of the contacts could satisfy."""
    scene = Scene(
        LinearSystem(M=np.eye(4), force=[0.0, 0.0, 0.0, -9.81]),
        q0=[-1.1300000000000041, -0.409999999999983, -1.6200000000000025, 0.06160000000003222],
        v0=[0.0, 0.0, 0.0, -5.678790770957676e-14], t_span=(0.32674, 0.3844),
        contacts=LinearContacts(
            G=[[0.888, 0.461, -0.292, -0.147], [-0.932, -1.16, 0.829, 0.547], [-0.32, -1.89, 0.555, 0.846]],
            offset=[0.7284651999999998, -0.21947519999999976, -0.2895135999999998], restitution=0.99,
        ),
        joints=LinearJoints([[0.8, 0.7, 0.7, -0.3], [0.8, -0.2, 0.9, 0.2]], [2.3434799999999996, 2.26768]),
    )  # fmt: skip
    run = simulate(scene, Located(0.00961))
    assert run.t[-1] == 0.3844
    assert np.max(np.abs(run.q - scene.q0)) < 1e-13
