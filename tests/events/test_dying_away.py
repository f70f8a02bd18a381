"""Motions of which impacts leave nothing, at the bottom of wedges, slits and cages: they end, at rest, in few steps.

What is left beside the last impacts is rounding: of speeds, of forces that cancel, of what has yet to come to rest.
"""

import numpy as np
import pytest

from benchmarks.judge.describe import Description
from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate
from tests.marks import slow

METHODS = [EventDriven(), EventDriven(1e-9, 1e-9)]


def at_rest(scene, method, place):
    """The finished run, which ends at this place."""
    m = simulate(scene, method)
    assert m.status is Status.DONE, m.message
    np.testing.assert_allclose(m.q[-1], place, rtol=0, atol=1e-10)
    np.testing.assert_allclose(m.v[-1], 0.0, rtol=0, atol=1e-10)
    return m


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_an_elastic_wall_bears_what_the_others_have_stopped(method):
    # four walls of a wedge: the last hops end when three are closed, and the fourth, elastic, is on its way
    G = np.array(
        [[-0.363, -0.907, 0.213], [0.116, -0.0463, 0.992], [0.121, 0.302, 0.945], [-0.751, 0.301, 0.588]]
    )
    masses, q0 = np.array([2.16, 1.09, 1.26]), np.array([0.418, 0.432, -0.92])
    system = LinearSystem(M=np.diag(masses), C=np.diag(0.0154 * masses), force=[0.0, 0.0, -12.4])
    walls = LinearContacts(G, -G @ q0, [0.56, 0.0, 0.4, 1.0])
    at_rest(Scene(system, q0, [-0.295, 0.0904, 0.134], (0.0, 4.0), walls), method, q0)


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_a_rocking_plank_comes_to_rest_on_all_its_feet(method):
    # on ground that moves: it dies away by halves down to what a time that cannot be told leaves of it
    G = tuple((1.0, x) for x in (-0.5, -0.357, -0.214, -0.0714, 0.0714, 0.214, 0.357, 0.5))
    plank = Description(
        M=((1.0, 0.0), (0.0, 0.119)), q0=(0.0, 0.0), v0=(0.0, 0.0), t_span=(0.0, 2.97414), h=0.00369, G=G,
        offset=(0.0,) * 8, restitution=0.5, K=((67.5, 11.8), (11.8, 46.9)), constant=(-9.81, 0.0),
        frame=(0.128, 0.108), omega=2.15, form=1, family="feet",
    )  # fmt: skip
    at_rest(plank.scene(), method, 0.0)


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_in_a_slit_forces_that_cancel_leave_nothing_to_look_for(method):
    K = np.array([[98.3, 20.6, 80.2], [20.6, 84.5, 3.54], [80.2, 3.54, 187.0]])
    q0 = np.array([0.939, 0.66, 1.41])
    slit = LinearContacts([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], [-0.939, 0.939], [0.93, 0.75])
    system = LinearSystem(M=np.eye(3), K=K, force=[218.9817, 80.1048, 341.3142])
    m = at_rest(Scene(system, q0, np.zeros(3), (0.0, 38.0), slit), method, q0)
    assert m.counts.steps < 1000


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_beads_without_room_come_to_rest_where_rounding_contradicts_the_last_blow(method):
    # three beads between two walls, all in touch: the gaps add up to zero
    beads = Description(
        M=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)), q0=(0.287, -0.343, 1.39), v0=(-1.04, -0.983, 0.143),
        t_span=(0.0, 0.1578), h=0.0789, G=((-1.0, 1.0, 0.0), (0.0, -1.0, 1.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
        offset=(0.63, -1.7329999999999999, -0.287, 1.39), restitution=0.63,
        K=((0.942, -0.269, 0.227), (-0.269, 0.621, -0.525), (0.227, -0.525, 0.743)),
        C=((0.0461, -0.00963, 0.00812), (-0.00963, 0.0346, -0.0188), (0.00812, -0.0188, 0.039)),
        constant=(0.0, 0.0, -9.81), family="beads",
    )  # fmt: skip
    at_rest(beads.scene(), method, beads.q0)


@pytest.mark.parametrize("tolerance", slow([1e-5, 1e-7, 1e-9], 1e-5, 1e-7))
def test_bodies_that_come_to_rest_where_their_springs_do_stay_there(tolerance):
    """Plastic beads end on the floor, at the ends of their springs: what is left of the forces has no digits."""
    G = np.vstack([np.diff(np.eye(5), axis=0), np.eye(5)[0]])
    system = LinearSystem(M=np.eye(5), K=np.diag([1.0, 4.0, 1.0, 1.0, 1.0]))
    contacts = LinearContacts(G=G, restitution=0.0)
    scene = Scene(system, [2.0, 2.0, 4.0, 4.0, 6.0], [1.0, 2.0, 2.0, -2.0, -1.0], (0.0, 3.0), contacts)
    run = simulate(scene, EventDriven(tolerance, tolerance))
    assert run.status.name == "DONE"
    np.testing.assert_allclose(run.q[-1], 0.0, rtol=0, atol=1e-300)
