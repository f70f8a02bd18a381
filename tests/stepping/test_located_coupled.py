"""Located impacts of coupled contacts: grooves, slits, clusters, contact forces that begin at zero."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from tests.marks import seeds, shared, slow
from tests.stepping import coupled

ORDERS = [2, 4, "exact"]


def drawn(kind, seed, k, restitution):
    return getattr(coupled, kind)(np.random.default_rng([seed, k]), restitution)


def check_groove(k, restitution):
    """The particle ends at rest at the lowest point; the planes carry its weight."""
    scene = drawn("groove", 71, k, restitution)
    for order in ORDERS:
        m = simulate(scene, Located(0.01, order))
        coupled.check_bodies(scene, m)
        energy = 0.5 * np.sum(m.v**2, axis=1) + coupled.G * m.q[:, 1]
        assert np.max(np.diff(energy)) < 1e-12
        if np.max(np.abs(m.q[-1])) < 1e-6:  # a flat groove takes longer than the span
            np.testing.assert_allclose(m.q[-1], 0.0, rtol=0, atol=1e-13)
            np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-13)
            forces = m.impulse[-1] / (m.t[-1] - m.t[-2])
            np.testing.assert_allclose(scene.contacts.G.T @ forces, [0.0, coupled.G], rtol=0, atol=1e-10)


def check_slit(k, restitution):
    """Whatever the force, the body stays; the walls take its velocity and the impulse of the force."""
    scene = drawn("slit", 72, k, restitution)
    f, t = scene.system.force, scene.t_span[1]
    turned = f.cosine[0] * np.sin(f.omega * t) + f.sine[0] * (1.0 - np.cos(f.omega * t))
    given = f.constant[0] * t + turned / f.omega
    for order in ORDERS:
        m = simulate(scene, Located(0.01, order))
        assert m.message == "reached the end of the span"
        np.testing.assert_allclose(m.q, 0.0, rtol=0, atol=1e-12)
        assert np.min(m.impulse) >= 0.0
        walls, M = np.sum(m.impulse, axis=0), scene.system.M[0, 0]
        np.testing.assert_allclose(walls[0] - walls[1], -M * scene.v0[0] - given, rtol=0, atol=2e-4)


def check_cluster(k, restitution):
    """Under a constant force all orders are exact: they agree with the event-driven integrator."""
    scene = drawn("three_by_three", 73, k, restitution)
    reference = simulate(scene, EventDriven())
    for order in ORDERS:
        m = simulate(scene, Located(0.01, order))
        coupled.check_bodies(scene, m)
        np.testing.assert_allclose(m.q[-1], reference.q[-1], rtol=0, atol=1e-7)


def check_unloaded(k, restitution):
    """Contact forces that begin at zero: which contacts stay closed is decided once, and rightly.

    Motions are compared up to the first impact: where more planes meet than there are coordinates, the order of
    impacts that come together is a matter of rounding.
    """
    scene = drawn("unloaded", 74, k, restitution)
    at = np.linspace(0.0, scene.t_span[1], 76)
    runs = [simulate(scene, Located(0.01, order), keep=at) for order in ORDERS]
    for m in runs:
        coupled.check_bodies(scene, m)
        assert len(m.impacts) < 1000  # true sequences of ever shorter hops have hundreds
    stepped = simulate(scene, Moreau(2e-5), keep=at)
    struck = [np.min(m.impacts.time[m.impacts.before < 0.0], initial=np.inf) for m in runs]
    smooth = at < min(struck) - 1e-3
    for m, atol in zip([*runs[:2], stepped], (2e-3, 2e-6, 2e-4), strict=True):
        np.testing.assert_allclose(m.q[smooth], runs[2].q[smooth], rtol=0, atol=atol)


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.5])
def test_a_particle_comes_to_rest_in_a_groove(restitution):
    for k in range(6):
        check_groove(k, restitution)


@pytest.mark.parametrize("restitution", slow([0.0, 0.3, 0.5], 0.3, longest=[0.0, 0.5]))
def test_a_particle_comes_to_rest_in_every_groove(restitution):
    for k in range(6, 60):
        check_groove(k, restitution)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_nothing_moves_between_walls_without_clearance(restitution):
    for k in range(8):
        check_slit(k, restitution)


def test_systems_of_three_coordinates_and_three_contacts_move_as_event_by_event():
    for k in range(10):
        check_cluster(k, [0.0, 0.4][k % 2])


@pytest.mark.parametrize("numbers", seeds(260, 100, pytest.mark.slow))
@pytest.mark.parametrize("restitution", [0.0, 0.4])
def test_many_systems_of_three_coordinates_and_three_contacts_move_as_event_by_event(restitution, numbers):
    for k in numbers:
        check_cluster(k, restitution)


def test_contact_forces_that_begin_at_zero_decide_once():
    for k in range(12):
        check_unloaded(k, [0.0, 0.5][k % 2])


@pytest.mark.parametrize("numbers", seeds(150, 40))
@pytest.mark.parametrize("restitution", shared([0.5, 0.0], 2))
def test_contact_forces_that_begin_at_zero_decide_once_in_many_systems(restitution, numbers):
    for k in numbers:
        check_unloaded(k, restitution)


@pytest.mark.slow
@pytest.mark.parametrize("order", [2, 4])
def test_rods_that_fall_between_walls_are_followed_to_the_end(order):
    for k in range(200):
        scene = drawn("dumbbell", 75, k, [0.0, 0.3, 0.5][k % 3])
        m = simulate(scene, Located(0.01, order))
        coupled.check_bodies(scene, m, depth=1e-11)
        height, speed = m.q[:, 1], np.sum(np.diag(scene.system.mass) * m.v**2, axis=1)
        energy = 0.5 * speed + coupled.G * scene.parameters["mass"] * height
        assert np.max(energy) < energy[0] * (1 + 1e-2)  # order two makes a step's error


@pytest.mark.parametrize("order", ORDERS)
def test_the_walls_of_a_slit_take_turns(order):
    # the force 1 + 2 cos 3t changes its sign where cos 3t = -1/2
    scene = Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=1.0, cosine=2.0, omega=3.0)),
        contacts=LinearContacts(G=[[1.0], [-1.0]], restitution=0.0), q0=[0.0], v0=[-1.0], t_span=(0.0, 5.0),
    )  # fmt: skip
    m = simulate(scene, Located(0.01, order))
    assert m.message == "reached the end of the span"
    assert np.max(np.abs(m.q)) < 1e-15
    force = 1.0 + 2.0 * np.cos(3.0 * (m.t[1:] - 0.005))
    np.testing.assert_allclose(m.impulse[1:, 1] / 0.01, np.maximum(force, 0.0), rtol=0, atol=2e-2)
    np.testing.assert_allclose(m.impulse[1:, 0] / 0.01, np.maximum(-force, 0.0), rtol=0, atol=2e-2)


@pytest.mark.parametrize("order", ORDERS)
def test_a_force_that_is_zero_where_a_mass_lands_holds_it(order):
    # two masses and a spring; the front one meets the wall where spring and force balance
    k, M = 40.0, np.array([2.0, 3.0])
    scene = Scene(
        system=LinearSystem(
            M=np.diag(M), K=k * np.array([[1.0, -1.0], [-1.0, 1.0]]), force=Harmonic(constant=[-k, k])
        ),
        contacts=LinearContacts(G=[[1.0, 0.0]], restitution=0.0), q0=[0.3, 1.3], v0=[-1.2, -1.2], t_span=(0.0, 1.0),
    )  # fmt: skip
    m = simulate(scene, Located(0.012, order))
    assert m.message == "reached the end of the span"
    assert len(m.impacts) <= 3
    held = m.t > 0.25
    w = np.sqrt(
        k / M[1]
    )  # the rear one swings about the natural length until the wall must pull: half a period
    swing = 1.0 - 1.2 / w * np.sin(w * (m.t[held] - 0.25))
    atol = {2: 2e-4, 4: 1e-6, "exact": 1e-12}[order]
    np.testing.assert_allclose(m.q[held, 1], swing, rtol=0, atol=atol)
    np.testing.assert_allclose(m.q[held, 0], 0.0, rtol=0, atol=1e-14)


@pytest.mark.parametrize("n", [2, 4, 7, 13, pytest.param(20, marks=pytest.mark.slow)])
@pytest.mark.parametrize("order", ORDERS)
def test_a_block_stands_on_its_feet(n, order):
    scene = scenes.block_on_feet(n, t_end=0.5)
    m = simulate(scene, Located(0.01, order))
    assert m.message == "reached the end of the span"
    assert len(m.impacts) == 0
    assert np.max(np.abs(m.v)) < 1e-13
    forces = m.impulse[1:] / np.diff(m.t)[:, None]
    np.testing.assert_allclose(np.sum(forces, axis=1), 9.81, rtol=1e-12)
    np.testing.assert_allclose(forces @ np.linspace(-0.5, 0.5, n), 0.981, rtol=1e-12)


@pytest.mark.parametrize("order", ORDERS)
def test_a_light_block_on_a_very_heavy_one_weighs_what_it_weighs(order):
    M = np.array([1.0, 1e9, 1e-9])
    rows = np.vstack([np.eye(3)[0], np.diff(np.eye(3), axis=0)])
    scene = Scene(
        system=LinearSystem(M=np.diag(M), force=Harmonic(constant=-9.81 * M)),
        contacts=LinearContacts(G=rows), q0=np.zeros(3), v0=np.zeros(3), t_span=(0.0, 0.1),
    )  # fmt: skip
    m = simulate(scene, Located(0.01, order))
    weight = 9.81 * np.cumsum(M[::-1])[::-1]
    np.testing.assert_allclose(m.impulse[1:] / np.diff(m.t)[:, None], np.tile(weight, (10, 1)), rtol=2e-14)


@pytest.mark.parametrize("order", ORDERS)
def test_hops_between_nearly_parallel_planes_come_to_an_end(order):
    # hops grow shorter up to where rounding makes them: from there on they would go on for ever
    scene = coupled.unloaded(np.random.default_rng([74, 47]), 0.0, (0.5, 0.25))
    m, reference = simulate(scene, Located(0.01, order)), simulate(scene, EventDriven())
    coupled.check_bodies(scene, m)
    assert len(m.impacts) < 500
    atol = {2: 1e-4, 4: 1e-8, "exact": 1e-12}[order]
    np.testing.assert_allclose(m.q[-1], reference.q[-1], rtol=0, atol=atol)


def lifting(t, q, v, p, out):
    """The second plane moves; of places at so late a time no more than eleven digits are known."""
    out[0, 0] = out[0, 1] = out[0, 2] = 0.0
    out[1, 0] = -0.003 * math.cos(3.0 * t)
    out[1, 1] = 0.009 * math.sin(3.0 * t)
    out[1, 2] = 0.027 * math.cos(3.0 * t)


@pytest.mark.parametrize("order", [2, 4])
def test_hops_between_planes_that_move_come_to_an_end_long_after_the_start_of_time(order):
    t = 27400.0
    rows = np.array([[-0.085, 0.904], [-0.2, 0.98]])
    s = np.zeros((2, 3))
    lifting(t, None, None, None, s)
    scene = Scene(
        system=LinearSystem(M=np.eye(2), K=[[2.4, 0.0], [0.0, 13.5]], force=[0.0, -9.81]),
        contacts=LinearContacts(G=rows, offset=s[:, 0] + [0.0, 1e-4], restitution=[0.49, 0.0], motion=lifting),
        q0=[0.0, 0.0], v0=[0.08, 0.02], t_span=(t, t + 1.0),
    )  # fmt: skip
    m = simulate(scene, Located(0.0055, order, max_events=20_000))
    assert m.status.name == "DONE"
    assert len(m.impacts) < 10_000
    reference = simulate(scene, EventDriven())
    np.testing.assert_allclose(m.q[-1], reference.q[-1], rtol=0, atol=1e-4)


@pytest.mark.parametrize("order", ORDERS)
def test_elastic_hops_too_short_to_be_followed_come_to_an_end(order):
    # what is left of the motion of beads that fall onto each other: hops of 1e-12 s, which no step can follow
    scene = Scene(
        system=LinearSystem(M=np.eye(2), force=[-9.81, -9.81]),
        contacts=LinearContacts(G=[[1.0, 0.0], [-1.0, 1.0]], restitution=[0.4, 1.0]), q0=[0.0, 0.0], v0=[0.0, 4e-12],
        t_span=(0.0, 1.0),
    )  # fmt: skip
    m = simulate(scene, Located(0.05, order, max_events=50_000))
    assert m.status.name == "DONE"
    np.testing.assert_allclose(m.q[-1], 0.0, rtol=0, atol=1e-12)


def test_what_rounding_has_left_of_rest_is_rest():
    # a slit at rest: had its body 5e-35 m/s, the step would be cut in two where it touches the other wall
    force = Harmonic(constant=[0.05, -0.4], cosine=[0.18, -0.18], sine=[-0.1, -0.38], omega=0.46)
    scene = Scene(
        system=LinearSystem(M=np.diag([1.2, 1.15]), K=[[0.07, -0.11], [-0.11, 1.64]], force=force),
        contacts=LinearContacts(G=[[1.0, 0.0], [-1.0, 0.0]]), q0=[0.0, -0.5], v0=[0.0, -0.12], t_span=(0.0, 2.0),
    )  # fmt: skip
    rest, left = (simulate(replace(scene, v0=[v, -0.12]), Located(0.09, 4)) for v in (0.0, 5e-35))
    assert len(left.impacts) == len(rest.impacts)
    np.testing.assert_allclose(left.q, rest.q, rtol=0, atol=1e-15)


@pytest.mark.parametrize("order", ORDERS)
def test_an_unfinished_run_can_be_asked_for_any_time_in_it(order):
    scene = drawn("groove", 71, 0, 0.5)
    m = simulate(scene, Located(0.01, order, max_events=5))
    assert m.status.name == "TOO_MANY_EVENTS"
    q, v = m.at(m.t)
    np.testing.assert_allclose(q, m.q, rtol=0, atol=1e-12)
    np.testing.assert_allclose(v[-1], m.v[-1], rtol=0, atol=1e-12)
    q, _ = m.at(m.t[-1])
    np.testing.assert_array_equal(q, m.q[-1])


def test_elastic_walls_without_clearance_end_and_tell():
    # no law says how an elastic body goes on between walls that touch it on both sides
    scene = Scene(
        system=LinearSystem(M=1.0, force=0.5), contacts=LinearContacts(G=[[1.0], [-1.0]], restitution=1.0),
        q0=[0.0], v0=[1.0], t_span=(0.0, 0.1),
    )  # fmt: skip
    m = simulate(scene, Located(0.01))
    assert "plastic" in m.message
    assert np.max(np.abs(m.q)) < 1e-15


def test_a_cluster_of_three_is_not_cut_short():
    # a finite sequence of impacts within 1e-14 s at speeds of 1e-4: eight of them in a row are no collapse
    scene = drawn("three_by_three", 9001, 69, 0.4)
    coarse, fine = (simulate(scene, Located(h)) for h in (0.01, 0.003))
    np.testing.assert_allclose(coarse.q[-1], fine.q[-1], rtol=0, atol=1e-8)
