"""What slides along a curve and is damped: damping answers the contact force within a step, as it does in flight."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lagrangian import Contacts, LinearSystem, Scene
from lcpstep import Located, simulate

ALONG, DOWN, GRAVITY = 0.1, 3.0, 9.81  # damping of both directions


def within_circle(t, q, v, p, out):
    out[0] = 1.0 - np.sqrt(q[0] ** 2 + q[1] ** 2)


def inwards(t, q, v, p, out):
    r = np.sqrt(q[0] ** 2 + q[1] ** 2)
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def bead(angle, t_end):
    """A bead in a bowl of radius 1: a damped pendulum."""
    system = LinearSystem(np.eye(2), C=np.diag([ALONG, DOWN]), force=[0.0, -GRAVITY])
    contacts = Contacts(1, within_circle, inwards, restitution=0.5)
    return Scene(system, [np.sin(angle), -np.cos(angle)], [0.0, 0.0], (0.0, t_end), contacts)


def pendulum(angle, t):
    """Its position at times t."""

    def rates(_, x):
        damping = ALONG * np.cos(x[0]) ** 2 + DOWN * np.sin(x[0]) ** 2
        return [x[1], -damping * x[1] - GRAVITY * np.sin(x[0])]

    theta = solve_ivp(rates, (0.0, t[-1]), [angle, 0.0], t_eval=t, rtol=1e-11, atol=1e-12).y[0]
    return np.column_stack([np.sin(theta), -np.cos(theta)])


@pytest.mark.parametrize("angle", [0.4, 1.3])
def test_errors_fall_with_the_square_of_the_step(angle):
    at, errors, steps = np.linspace(0.0, 2.0, 21), [], (0.02, 0.01, 0.005)
    for h in steps:
        m = simulate(bead(angle, 2.0), Located(h), keep=at)
        assert len(m.impacts) == 0
        errors.append(np.max(np.abs(m.q - pendulum(angle, at))))
    assert 1.9 < np.polyfit(np.log(steps), np.log(errors), 1)[0] < 2.1
    assert errors[-1] < 2e-4


def test_steps_by_a_tolerance_are_as_many_as_order_two_needs():
    at = np.linspace(0.0, 2.0, 21)
    m = simulate(bead(1.3, 2.0), Located(0.5, tolerance=1e-4), keep=at)
    assert np.max(np.abs(m.q - pendulum(1.3, at))) < 2e-4
    assert m.counts.steps < 2000
