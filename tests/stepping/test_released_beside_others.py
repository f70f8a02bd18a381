"""When a contact opens beside others that stay closed: a ladder leaves its wall at sin = 2/3 of sin at first."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Scene, System
from lcpstep import Kind, Located, simulate

GRAVITY = 9.81
STEPS = 0.004, 0.0028, 0.002, 0.0014, 0.001, 0.0007, 0.0005, 0.00025, 1e-4, 1e-5


def mass(t, q, v, p, out):
    out[:, :] = 0.0
    out[0, 0], out[1, 1], out[2, 2] = 1.0, 1.0, 1.0 / 3.0


def weight(t, q, v, p, out):
    out[0], out[1], out[2] = 0.0, -9.81, 0.0


def gap(t, q, v, p, out):
    out[0], out[1] = q[1] - math.sin(q[2]), q[0] - math.cos(q[2])


def jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 1.0, -math.cos(q[2])
    out[1, 0], out[1, 1], out[1, 2] = 1.0, 0.0, math.sin(q[2])


def bias(t, q, v, p, out):
    out[0], out[1] = math.sin(q[2]) * v[2] ** 2, math.cos(q[2]) * v[2] ** 2


def time_to_leave(first, last):
    """Integral of dtheta / sqrt(k (sin first - sin theta)), by theta = first - s^2 without its root."""
    k = 1.5 * GRAVITY
    nodes, weights = np.polynomial.legendre.leggauss(40)
    end = math.sqrt(first - last)
    s = 0.5 * end * (nodes + 1.0)
    return float(0.5 * end * weights @ (2.0 * s / np.sqrt(k * (math.sin(first) - np.sin(first - s**2)))))


@pytest.mark.parametrize("start", [0.5, 1.2, 1.5])
def test_the_time_at_which_a_ladder_leaves_its_wall_is_of_order_two(start):
    """The floor, which stays closed, answers what the wall would have to pull with: it was forgotten, order one."""
    leaves = time_to_leave(start, math.asin(2.0 / 3.0 * math.sin(start)))
    scene = Scene(
        System(3, mass, weight),
        q0=[math.cos(start), math.sin(start), start],
        v0=np.zeros(3),
        t_span=(0.0, leaves + 0.05),
        contacts=Contacts(2, gap, jacobian, bias=bias),
    )
    for h in STEPS:
        log = simulate(scene, Located(h)).impacts
        (opened,) = log.time[(log.kind == Kind.RELEASE) & (log.contact == 1)]
        assert abs(opened - leaves) < h**2
