"""What runs say of contacts that share a normal, and not the direction of their friction; tangents that follow v."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, simulate

METHODS = [EventDriven(), Located(1e-2), Located(1e-2, order=4), Moreau(1e-3)]
WEIGHT = np.array([0.0, 0.0, -9.81])
FLOOR, SIDEWAYS = [[0.0, 0.0, 1.0]] * 2, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]


def puck(mu, tangents, v0, push=(0.0, 0.0, 0.0), G=FLOOR):
    contacts = LinearContacts(G, friction=Coulomb(mu, tangents))
    return Scene(LinearSystem(np.eye(3), force=WEIGHT + push), np.zeros(3), v0, (0.0, 0.2), contacts)


@pytest.mark.parametrize("method", METHODS)
def test_a_puck_that_slides_on_two_contacts_of_one_normal_is_doubted(method):
    run = simulate(puck(0.3, SIDEWAYS, [1.0, 0.5, 0.0]), method)
    assert run.doubt.startswith(
        "contacts 0 and 1 share their normal, and not their tangents, and slide at t = "
    )


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(
    "scene",
    [
        puck(0.3, SIDEWAYS, [0.0, 0.0, 0.0], (1.0, -1.0, 0.0)),
        puck(0.3, [[1.0, 0.0, 0.0], [2.0, 0.0, 1.0]], [1.0, 0.0, 0.0]),
        puck([0.3, 0.0], SIDEWAYS, [1.0, 0.5, 0.0]),
        puck(0.3, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [1.0, 0.5, 0.0], G=[[0.0, 0.0, 1.0], [0.0, 0.3, 1.0]]),
    ],
    ids=["at rest", "one direction", "one without friction", "two normals"],
)
def test_what_sticks_or_slides_in_one_direction_or_on_two_normals_is_not(method, scene):
    assert simulate(scene, method).doubt == ""


@pytest.mark.parametrize("method", METHODS)
def test_rounding_of_what_rests_on_a_slope_is_no_sliding(method):
    n, along = np.array([0.6, 0.0, 0.8]), [[0.8, 0.0, -0.6], [0.0, 1.0, 0.0]]
    assert simulate(puck(1.0, along, np.zeros(3), (0.3, 0.1, 0.0), G=[n, n]), method).doubt == ""


@pytest.mark.parametrize("theta", [0.5, 1.0])
def test_a_contact_that_parts_takes_no_share_of_a_load(theta):
    # the obstacle of the second one sinks by 1 m/s^2
    def sinks(t, q, v, p, out):
        out[:] = 0.0
        out[1, 0], out[1, 1], out[1, 2] = -0.5 * t * t, -t, -1.0

    friction = Coulomb(1.0, SIDEWAYS)
    contacts = LinearContacts(FLOOR, motion=sinks, friction=friction)
    pushed = LinearSystem(np.eye(3), force=np.array([1.0, 0.0, -9.81]))
    run = simulate(Scene(pushed, np.zeros(3), np.zeros(3), (0.0, 0.05), contacts), Moreau(1e-2, theta=theta))
    assert run.impulse[1:] == pytest.approx(np.tile([0.0981, 0.0], (len(run.t) - 1, 1)), abs=1e-12)


@pytest.mark.parametrize("method", METHODS)
def test_the_same_in_a_bowl(method):
    def gap(t, q, v, p, out):
        out[0] = out[1] = 1.0 - math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2])

    def jacobian(t, q, v, p, out):
        r = math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2])
        for c in range(2):
            for k in range(3):
                out[c, k] = -q[k] / r

    def tangent(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = -q[2], 0.0, q[0]
        out[1, 0], out[1, 1], out[1, 2] = 0.0, -q[2], q[1]

    bowl = Contacts(2, gap, jacobian, friction=Coulomb(0.2, tangent))
    scene = Scene(LinearSystem(np.eye(3), force=WEIGHT), [0.0, 0.0, -1.0], [1.0, 0.7, 0.0], (0.0, 0.2), bowl)
    assert "share their normal" in simulate(scene, method).doubt


@pytest.mark.parametrize("v0", [[1.0, 0.5, 0.0], [0.0, 0.0, 0.0]])
def test_tangents_and_belts_that_follow_the_velocity_are_named(v0):
    def along(t, q, v, p, out):
        speed = math.hypot(v[0], v[1])
        out[0, 0], out[0, 1] = (v[0] / speed, v[1] / speed) if speed > 0.0 else (1.0, 0.0)
        out[0, 2] = 0.0

    def fixed(t, q, v, p, out):
        out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, 0.0

    def belt(t, q, v, p, out):
        out[0] = -0.1 * v[0]

    for name, friction in (
        ("tangent", Coulomb(0.3, along)),
        ("slip", Coulomb(0.3, fixed, slip=belt)),
    ):
        contacts = LinearContacts([[0.0, 0.0, 1.0]], friction=friction)
        with pytest.raises(
            ValueError, match=rf"friction\.{name}: expected a function of time and coordinates"
        ):
            Scene(LinearSystem(np.eye(3), force=WEIGHT), np.zeros(3), v0, (0.0, 1.0), contacts)


def test_two_directions_for_one_contact_are_told_apart_from_two_contacts():
    with pytest.raises(ValueError, match="acts along one direction a contact"):
        LinearContacts([[0.0, 0.0, 1.0]], friction=Coulomb(0.3, SIDEWAYS))
