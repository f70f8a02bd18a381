"""Painleve's paradox answered by an impact without collision, where that is asked for."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lagrangian import Contacts, Coulomb, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.scenes.rough_contacts import critical_friction
from lcpstep import EventDriven, Kind, Located, Moreau, Status, energy, simulate
from lcpstep.explore import views
from lcpstep.export import Motion
from lcpstep.parameters import MEASURES

ASKED = EventDriven(1e-11, 1e-11, jamming="impact")


def rod(law="moreau", restitution=0.0, **parameters):
    scene = scenes.falling_rod(**parameters)
    friction = replace(scene.contacts.friction, law=law)
    return replace(scene, contacts=replace(scene.contacts, restitution=restitution, friction=friction))


def rows(scene):
    """Normal and tangent at the start, (2, 3), and their mobility."""
    at = (0.0, np.array(scene.q0), np.array(scene.v0), np.array(scene.p))
    D = np.vstack([scene.contacts.normals(*at), scene.contacts.friction.tangents(at, 1)])
    return D, D @ np.diag([1.0, 1.0, 12.0]) @ D.T


@pytest.mark.parametrize("law", ["moreau", "newton", "stronge"])
def test_the_tip_of_a_rod_that_jams_comes_to_rest_at_once(law):
    """Its sliding ends, and it sticks: the impulse takes both velocities of the tip."""
    scene = rod(law, mu=1.8, angle=1.1)
    run = simulate(scene, ASKED, keep=[1e-9])
    D, W = rows(scene)
    p = np.linalg.solve(W, -D @ np.asarray(scene.v0))
    expected = np.asarray(scene.v0) + np.diag([1.0, 1.0, 12.0]) @ D.T @ p
    assert run.status == Status.DONE
    assert np.max(np.abs(run.v[-1] - expected)) < 1e-7
    jam = run.impacts[run.impacts.kind == Kind.JAM]
    assert len(jam) == 1
    assert jam.before[0] == 0.0
    assert jam.impulse[0] == pytest.approx(p[0], rel=1e-12)
    assert run.impulse[0, 0] == pytest.approx(p[0], abs=1e-6)
    assert "jammed 1 time" in run.message


def test_restitution_of_energy_throws_the_rod_off_its_surface():
    """The jam presses the tip in: r^2 of that work comes back (Stronge), by the other laws nothing does."""
    for law, thrown in (("moreau", False), ("stronge", True)):
        run = simulate(rod(law, restitution=0.5, mu=1.8, angle=1.1), ASKED)
        jam = run.impacts[run.impacts.kind == Kind.JAM]
        assert (jam.after[0] > 1e-3) == thrown
        assert len(energy(run).created) == 0


@settings(max_examples=25, deadline=None)
@given(st.floats(0.5, 1.4), st.floats(0.9, 1.3), st.floats(-3.0, -0.3))
def test_moreaus_steps_jam_in_the_same_way_and_no_energy_is_made(angle, share, v0):
    scene = rod(mu=share * critical_friction(angle), angle=angle, v0=v0, t_end=0.05)
    run = simulate(scene, ASKED)
    E = 0.5 * np.einsum("ij,j,ij->i", run.v, [1.0, 1.0, 1.0 / 12.0], run.v) + 9.81 * run.q[:, 1]
    assert run.status == Status.DONE
    assert np.max(np.diff(E)) < 1e-9
    assert (simulate(scene, EventDriven(1e-11, 1e-11)).status == Status.DONE) == (
        not np.any(run.impacts.kind == Kind.JAM)
    )
    coarse, fine = (simulate(scene, Moreau(h), keep=[0.05]).q[-1] for h in (1e-3, 1e-5))
    assert np.max(np.abs(fine - run.q[-1])) < 0.1 * np.max(np.abs(coarse - run.q[-1])) + 1e-6


def test_what_is_to_follow_a_jam_is_named():
    with pytest.raises(ValueError, match="jamming: expected"):
        EventDriven(jamming="bounce")
    assert simulate(rod(mu=1.8, angle=1.1), EventDriven()).status == Status.PAINLEVE_INCONSISTENT


def corner(mu):
    """A mass in a corner of a floor and a wall, which are belts: each presses it against the other, and slides."""
    return Scene(
        system=LinearSystem(np.eye(2), force=[0.0, -9.81]),
        contacts=LinearContacts(np.eye(2)[::-1], friction=Coulomb(mu, np.eye(2), slip=[1.0, 1.0])),
        q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 0.1),
    )  # fmt: skip


METHODS = [EventDriven(), ASKED, Located(1e-3), Located(1e-2, order=4), Located(tolerance=1e-6)]


@pytest.mark.parametrize("method", METHODS, ids=repr)
@pytest.mark.parametrize("mu", [0.2, 0.9, 1.0, 1.1, 3.0])
def test_belts_that_press_a_mass_onto_each_other_leave_it_no_forces_from_one_on(mu, method):
    """p_floor = mu p_wall + g and p_wall = mu p_floor: only below one are they pushes; nor would one of them do."""
    run = simulate(corner(mu), method, keep=[0.1])
    if mu < 1.0:
        assert run.status == Status.DONE
        floor = 0.1 * 9.81 / (1.0 - mu**2)
        assert np.sum(run.impulse, axis=0)[:2] == pytest.approx([floor, mu * floor], rel=1e-9)
    else:
        assert run.status == Status.PAINLEVE_INCONSISTENT
        assert "no forces of the closed contacts [0, 1] together" in run.message


def gaps_of_ends(t, q, v, p, out):
    out[0], out[1] = q[1] - np.sin(q[2]), q[0] - np.cos(q[2])


def normals_of_ends(t, q, v, p, out):
    out[:] = 0.0
    out[0, 1], out[0, 2], out[1, 0], out[1, 2] = 1.0, -np.cos(q[2]), 1.0, np.sin(q[2])


def tangents_of_ends(t, q, v, p, out):
    out[:] = 0.0
    out[0, 0], out[0, 2], out[1, 1], out[1, 2] = 1.0, -np.sin(q[2]), 1.0, np.cos(q[2])


def ladder(angle, mu, rate):
    """A ladder of 2 m and 1 kg on a floor and against a wall, both rough, that is being pushed up the wall."""
    c, s = np.cos(angle), np.sin(angle)
    return Scene(
        system=LinearSystem(np.diag([1.0, 1.0, 1.0 / 3.0]), force=[0.0, -9.81, 0.0]),
        contacts=Contacts(2, gaps_of_ends, normals_of_ends, friction=Coulomb(mu, tangents_of_ends)),
        q0=[c, s, angle], v0=[-s * rate, c * rate, rate], t_span=(0.0, 0.05),
    )  # fmt: skip


@settings(max_examples=25, deadline=None)
@given(st.floats(0.8, 1.3), st.floats(1.1, 2.5), st.floats(0.3, 3.0))
def test_a_ladder_whose_ends_have_no_forces_together_stops_at_once(angle, mu, rate):
    """Its motion has one degree of freedom while both ends are closed: what ends their sliding ends all of it."""
    scene = ladder(angle, mu, rate)
    run = simulate(scene, ASKED)
    if simulate(scene, EventDriven()).status == Status.PAINLEVE_INCONSISTENT:
        jam = run.impacts[run.impacts.kind == Kind.JAM]
        assert run.status == Status.DONE
        assert len(set(jam.time)) == 1
        start = scene.v0 if jam.time[0] == 0.0 else run.at(jam.time[0] * (1.0 - 1e-9))[1]
        D, at = np.zeros((2, 3)), run.at(jam.time[0])[0]
        normals_of_ends(0.0, at, None, None, D)
        T = np.zeros((2, 3))
        tangents_of_ends(0.0, at, None, None, T)
        assert np.max(np.abs(np.vstack([D, T]) @ start)) > 1e-3
        assert np.max(np.abs(run.at(jam.time[0] + 1e-9)[1])) < 1e-7
        assert np.max(np.diff(energy(run).total)) < 1e-9
        coarse, fine = (simulate(scene, Moreau(h), keep=[0.05]).q[-1] for h in (1e-3, 1e-5))
        assert np.max(np.abs(fine - run.q[-1])) < 0.1 * np.max(np.abs(coarse - run.q[-1])) + 1e-6


def close_in(t, q, v, p, out):
    out[:, 0], out[:, 1], out[:, 2] = 0.5 * t**2, t, 1.0


@pytest.mark.parametrize("mu", [0.0, 0.5, 2.0])
def test_walls_that_close_in_have_no_forces_and_no_paradox(mu):
    """The same without friction: it is not friction that leaves none."""
    scene = Scene(
        system=LinearSystem(np.eye(2)),
        contacts=LinearContacts([[0.0, 1.0], [0.0, -1.0]], motion=close_in, friction=Coulomb(mu, [[1.0, 0.0]] * 2)),
        q0=[0.0, 0.0], v0=[1.0, 0.0], t_span=(0.0, 0.1),
    )  # fmt: skip
    assert simulate(scene, EventDriven()).status not in (Status.DONE, Status.PAINLEVE_INCONSISTENT)


def disc_in_a_box(v0, mu, restitution, tangential, beta, stiffness, g):
    """A disc of 0.25 m and 1 kg in a box 1 m wide without a lid, drawn to the wall on the left by a spring."""
    tangents = [[1.0, 0.0, 0.25], [0.0, 1.0, -0.25], [0.0, 1.0, 0.25]]
    contacts = LinearContacts(
        G=[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], offset=[-0.25, -0.25, 0.75], restitution=restitution,
        friction=Coulomb(mu, tangents, restitution=tangential),
    )  # fmt: skip
    M, K = np.diag([1.0, 1.0, beta * 0.25**2]), np.diag([stiffness, 0.0, 0.0])
    return Scene(LinearSystem(M=M, K=K, force=[0.0, -g, 0.0]), [0.75, 0.75, 0.0], v0, (0.0, 3.0), contacts)


BLOW = disc_in_a_box([2.0, 1.0, 8.0], 5.0, 0.0, 1.0, 1.0, 0.0, 1.0)
HOPS = disc_in_a_box([-1.0, -2.0, 0.0], 1.0, 0.5, 0.0, 0.4, 49.7, 9.81)


@pytest.mark.parametrize("scene", [BLOW, HOPS], ids=["blow", "hops"])
@pytest.mark.parametrize(
    "method", [EventDriven(), Located(0.01), Located(0.01, 4), Located(0.01, tolerance=1e-6)]
)
def test_a_disc_that_a_blow_or_hops_leave_in_a_rough_corner_rests_there(method, scene):
    """From mu = 1 on nothing that turns in the corner has forces; what is left of blow or hops does not turn."""
    run = simulate(scene, method)
    assert run.status.name == "DONE"
    np.testing.assert_allclose(run.q[-1, :2], 0.25, rtol=0, atol=1e-9)
    np.testing.assert_allclose(run.v[-1], 0.0, rtol=0, atol=1e-12)


def test_a_jam_counts_as_a_blow_wherever_blows_are_counted_and_drawn():
    """In a unit of FMI, on the page, in studies."""
    scene = rod(mu=1.8, angle=1.1)
    run, motion = simulate(scene, ASKED), Motion(scene, ASKED)
    motion.go_to(1e-3)
    assert motion.value("impacts") == 1.0
    assert motion.value("impulse0") == run.impacts.impulse[0] > 0.3
    assert MEASURES["impacts"][1](run) == 1
    assert list(views.impacts(run).kind) == [Kind.JAM]
