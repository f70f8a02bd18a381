"""Forces that jump at a time: what each method makes of one that `corners` name, and of one that nobody has told."""

import pytest

from lagrangian import LinearContacts, Scene, System
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
