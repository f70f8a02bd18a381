"""Differences that stand in for a missing bias, or a belt's acceleration, where all is short and quick."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Status, simulate

HIGH, FAST, WIDE, SWAY = 5e-5, 2.1e4, 2e-5, 1.94e4  # a conveyor of 3 kHz [m, rad/s]


def height(t, q, v, p, out):
    out[0] = q[1] - HIGH * math.sin(FAST * t)


def up(t, q, v, p, out):
    out[0, 0], out[0, 1] = 0.0, 1.0


def rising(t, q, v, p, out):
    out[0] = -HIGH * FAST * math.cos(FAST * t)


def moved(t, q, v, p, out):
    out[0, 0], out[0, 1] = HIGH * math.sin(FAST * t), HIGH * FAST * math.cos(FAST * t)
    out[0, 2] = -HIGH * FAST**2 * math.sin(FAST * t)


def along(t, q, v, p, out):
    out[0, 0], out[0, 1] = 1.0, 0.0


def sways(t, q, v, p, out):
    out[0] = -WIDE * SWAY * math.cos(SWAY * t)


@pytest.mark.parametrize(("mu", "stiffness"), [(0.6, 0.0), (0.6, 1.4e8)])
def test_a_conveyor_of_kilohertz_is_followed_without_its_accelerations(mu, stiffness):
    """Differences begin over a millisecond, three periods: nothing is seen of a gap there."""
    body = LinearSystem(np.eye(2), K=np.diag([stiffness, 0.0]), force=[0.0, -9810.0])
    told = LinearContacts(
        [[0.0, 1.0]],
        motion=moved,
        friction=Coulomb(mu, [[1.0, 0.0]], Harmonic(cosine=-WIDE * SWAY, omega=SWAY)),
    )
    untold = Contacts(1, height, up, rising, friction=Coulomb(mu, along, sways))
    m, known = (
        simulate(Scene(body, [0.0, 0.0], [0.0, 0.0], (0.0, 1.5e-3), contacts), EventDriven(1e-12, 1e-15))
        for contacts in (untold, told)
    )
    assert known.status is m.status is Status.DONE
    assert m.counts.steps < 3 * known.counts.steps
    np.testing.assert_allclose(m.q[-1], known.q[-1], rtol=0, atol=1e-10)


def above_a_parabola(t, q, v, p, out):
    out[0] = q[1] - q[0] * q[0]


def coarse(t, q, v, p, out):
    out[0, 0], out[0, 1] = -np.float32(2.0 * q[0]), 1.0


def fine(t, q, v, p, out):
    out[0, 0], out[0, 1] = -2.0 * q[0], 1.0


def test_a_jacobian_of_few_digits_is_no_gap_that_bends():
    """Differences see its noise at every step, and more of it at shorter ones."""
    body = LinearSystem(np.eye(2), force=[0.0, -9.81])
    m, known = (
        simulate(
            Scene(body, [0.5, 0.25], [0.5, 0.5], (0.0, 0.02), Contacts(1, above_a_parabola, jacobian)),
            EventDriven(1e-8, 1e-8),
        )
        for jacobian in (coarse, fine)
    )
    assert m.status is Status.DONE
    assert m.counts.steps < 1000
    np.testing.assert_allclose(m.q[-1], known.q[-1], rtol=0, atol=1e-6)
