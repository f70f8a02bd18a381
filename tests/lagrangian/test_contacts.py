"""Contacts: gap velocities and accelerations are derivatives of the gap along a motion."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearContacts
from tests.differences import derivative, jacobian
from tests.models import BOWL, RISING_CIRCLE, TABLE

STEP = 1e-2  # of eighth-order differences: truncation 1e-16, rounding 1e-14
NOTHING = np.zeros(0)


def along(contacts, q, v, p, t):
    """Gap and gap velocity on the straight motion q + (s - t) v."""
    return lambda s: contacts.state(s, q + (s - t) * v, v, p)


MOVING = [
    pytest.param(BOWL, np.array([0.3, -0.4]), NOTHING, id="bowl"),
    pytest.param(RISING_CIRCLE, np.array([1.3, 0.9]), NOTHING, id="rising circle"),
]


@pytest.mark.parametrize(("contacts", "q", "p"), MOVING)
def test_gap_velocity_is_the_derivative_of_the_gap(contacts, q, p):
    v, t = np.array([0.7, -0.2]), 0.35
    motion = along(contacts, q, v, p, t)
    _, u = motion(t)
    np.testing.assert_allclose(u, derivative(lambda s: motion(s)[0], t, STEP), rtol=0, atol=1e-12)


@pytest.mark.parametrize(("contacts", "q", "p"), MOVING)
def test_jacobian_is_the_derivative_by_the_coordinates(contacts, q, p):
    G, v = np.zeros((contacts.n_c, len(q))), np.zeros(len(q))
    contacts.jacobian(0.35, q, v, p, G)
    differences = jacobian(lambda x: contacts.state(0.35, x, v, p)[0], q, STEP)
    np.testing.assert_allclose(G, differences, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("contacts", "q", "p"), MOVING)
def test_time_derivative_is_the_partial_one(contacts, q, p):
    _, g_t = contacts.state(0.35, q, np.zeros(len(q)), p)
    differences = derivative(lambda s: contacts.state(s, q, np.zeros(len(q)), p)[0], 0.35, STEP)
    np.testing.assert_allclose(g_t, differences, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("contacts", "q", "p"), MOVING)
def test_bias_is_the_gap_acceleration_of_a_straight_motion(contacts, q, p):
    v, t, out = np.array([0.7, -0.2]), 0.35, np.zeros(1)
    contacts.bias(t, q, v, p, out)
    motion = along(contacts, q, v, p, t)
    np.testing.assert_allclose(out, derivative(lambda s: motion(s)[1], t, STEP), rtol=0, atol=1e-12)


def test_a_moving_table_has_its_velocity_in_the_gap():
    A, w = 0.01, 40.0
    contacts = LinearContacts(G=1.0, motion=TABLE)
    g, u = contacts.state(0.1, np.array([0.2]), np.array([0.3]), np.array([A, w]))
    assert g[0] == pytest.approx(0.2 - A * math.sin(4.0), rel=1e-15)
    assert u[0] == pytest.approx(0.3 - A * w * math.cos(4.0), rel=1e-15)


def test_one_number_stands_for_all_offsets_and_restitutions():
    contacts = LinearContacts(G=np.eye(3), offset=0.5, restitution=0.25)
    np.testing.assert_array_equal(contacts.offset, [0.5] * 3)
    np.testing.assert_array_equal(contacts.restitution, [0.25] * 3)
    assert contacts.n_c == 3
    assert Contacts(n_c=2, gap=BOWL.gap, jacobian=BOWL.jacobian, restitution=1.0).restitution.shape == (2,)
