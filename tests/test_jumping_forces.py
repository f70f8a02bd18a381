"""Forces that jump at a time: what each method makes of one that `corners` name, and of one that nobody has told."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, Scene, System
from lcpstep import EventDriven, Located, Moreau, simulate

JUMP, G, UP, REBOUND = 0.5123456, 9.81, 20.19, 0.5
END = 0.9


def weight(t, q, v, p, out):
    out[0] = -9.81 if t <= 0.5123456 else 20.19


def height():
    """In closed form: it falls from 1 m, bounces once at half of its speed, and is carried up from the jump on."""
    meets = (2.0 / G) ** 0.5
    flight, up = JUMP - meets, REBOUND * G * meets
    q, v = up * flight - 0.5 * G * flight**2, up - G * flight
    rest = END - JUMP
    return q + v * rest + 0.5 * UP * rest**2


def error(method, *corners):
    ball = LinearContacts([[1.0]], restitution=REBOUND)
    scene = Scene(System(1, [[1.0]], weight), 1.0, 0.0, (0.0, END), contacts=ball, corners=corners)
    return abs(simulate(scene, method).q[-1, 0] - height())


@pytest.mark.parametrize("order", [2, 4])
def test_steps_of_one_size_are_of_order_one_over_a_jump_that_is_not_told(order):
    assert error(Located(1e-3, order), JUMP) < 1e-12
    assert 1e-4 < error(Located(1e-3, order)) < UP * 1e-3


@pytest.mark.parametrize(
    ("method", "bound"),
    [(EventDriven(), 1e-10), (Located(1e-2, tolerance=1e-4), 1e-4), (Moreau(1e-2, tolerance=1e-4), 1e-4)],
    ids=["event-driven", "located", "moreau"],
)
def test_methods_that_choose_their_steps_find_it(method, bound):
    assert error(method) < bound


def push(t, q, v, p, out):
    late = t >= p[0]
    out[0], out[1] = (p[3], p[4]) if late else (p[1], p[2])


@pytest.mark.parametrize("time", [0.25, 1.0 / 3.0, 0.5123456])
@pytest.mark.parametrize(
    ("before", "after", "acceleration"),
    [
        ((1.0, -10.0), (6.0, -10.0), (3.0, 0.0)), ((2.5, -10.0), (-1.0, 2.0), (-1.0, 2.0)),
        ((0.5, -9.0), (-1.0, -0.1), (-0.97, 0.0)),
    ],
    ids=["beyond the cone", "up", "next to no weight"],
)  # fmt: skip
def test_what_friction_holds_is_let_go_by_a_force_that_jumps(time, before, after, acceleration):
    """At rest up to the jump, which no error of the motion shows; it had stayed there for the rest of the run."""
    floor = LinearContacts([[0.0, 1.0]], restitution=REBOUND, friction=Coulomb(0.3, [[1.0, 0.0]]))
    scene = Scene(
        System(2, np.eye(2), push), [0.0, 0.0], [0.0, 0.0], (0.0, 1.0), floor, p=[time, *before, *after]
    )
    run = simulate(scene, EventDriven(1e-9, 1e-9))
    way = 0.5 * (1.0 - time) ** 2 * np.array(acceleration)
    np.testing.assert_allclose(run.q[-1], way, rtol=0, atol=1e-9)
