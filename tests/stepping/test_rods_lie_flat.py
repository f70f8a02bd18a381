"""Three hinged rods thrown on a rough floor lie flat on it: heights and angles die away below the smallest numbers.

Coordinates are place and angle of every rod. Along the chain a joint then moves with an angle by 1e-320 of a metre a
radian, and so by nothing at all once that is multiplied.
"""

import math

import numpy as np
import pytest

from lagrangian import Contacts, Coulomb, Joints, Scene, System
from lcpstep import EventDriven, Located, Status, simulate

N, HALF, MU, G0, SPEED = 3, 0.2, 0.8, 9.81, 3.0


def weight(t, q, v, p, out):
    """Of 1 kg a rod."""
    for k in range(9):
        out[k] = -9.81 if k % 3 == 1 else 0.0


def hinges(t, q, v, p, out):
    """What the ends of neighbours are apart."""
    for k in range(2):
        i, j = 3 * k, 3 * k + 3
        out[2 * k] = q[i] - q[j] + 0.2 * math.cos(q[i + 2]) + 0.2 * math.cos(q[j + 2])
        out[2 * k + 1] = q[i + 1] - q[j + 1] + 0.2 * math.sin(q[i + 2]) + 0.2 * math.sin(q[j + 2])


def hinges_q(t, q, v, p, out):
    """Their Jacobian."""
    out[:, :] = 0.0
    for k in range(2):
        i, j = 3 * k, 3 * k + 3
        out[2 * k, i], out[2 * k, j], out[2 * k + 1, i + 1], out[2 * k + 1, j + 1] = 1.0, -1.0, 1.0, -1.0
        for a in (i + 2, j + 2):
            out[2 * k, a], out[2 * k + 1, a] = -0.2 * math.sin(q[a]), 0.2 * math.cos(q[a])


def hinges_bias(t, q, v, p, out):
    """Their accelerations at v' = 0."""
    for k in range(2):
        a, b = 3 * k + 2, 3 * k + 5
        out[2 * k] = -0.2 * (math.cos(q[a]) * v[a] * v[a] + math.cos(q[b]) * v[b] * v[b])
        out[2 * k + 1] = -0.2 * (math.sin(q[a]) * v[a] * v[a] + math.sin(q[b]) * v[b] * v[b])


def heights(t, q, v, p, out):
    """Of the first end, and of the far ends of all rods."""
    out[0] = q[1] - 0.2 * math.sin(q[2])
    for k in range(3):
        out[k + 1] = q[3 * k + 1] + 0.2 * math.sin(q[3 * k + 2])


def heights_q(t, q, v, p, out):
    """Their Jacobian."""
    out[:, :] = 0.0
    out[0, 1], out[0, 2] = 1.0, -0.2 * math.cos(q[2])
    for k in range(3):
        out[k + 1, 3 * k + 1], out[k + 1, 3 * k + 2] = 1.0, 0.2 * math.cos(q[3 * k + 2])


def heights_bias(t, q, v, p, out):
    """Their accelerations at v' = 0."""
    out[0] = 0.2 * math.sin(q[2]) * v[2] * v[2]
    for k in range(3):
        out[k + 1] = -0.2 * math.sin(q[3 * k + 2]) * v[3 * k + 2] * v[3 * k + 2]


def along(t, q, v, p, out):
    """Velocities of the same ends along the floor."""
    out[:, :] = 0.0
    out[0, 0], out[0, 2] = 1.0, 0.2 * math.sin(q[2])
    for k in range(3):
        out[k + 1, 3 * k], out[k + 1, 3 * k + 2] = 1.0, -0.2 * math.sin(q[3 * k + 2])


def thrown():
    q0, x, y = [], 0.0, 0.5
    for angle in (0.6, -0.42, 0.6):
        c, s = HALF * math.cos(angle), HALF * math.sin(angle)
        q0 += [x + c, y + s, angle]
        x, y = x + 2.0 * c, y + 2.0 * s
    rod = [1.0, 1.0, (2.0 * HALF) ** 2 / 12.0]
    contacts = Contacts(N + 1, heights, heights_q, bias=heights_bias, friction=Coulomb(MU, along))
    joints = Joints(2 * N - 2, hinges, hinges_q, bias=hinges_bias)
    system = System(3 * N, np.diag(rod * N), weight)
    return Scene(system, q0, [SPEED, 0.0, 0.0] * N, (0.0, 1.5), contacts, joints)


@pytest.mark.parametrize(
    ("method", "near"),
    [
        (Located(4e-3), 1e-3),
        (Located(5e-4), 2e-5),
        (Located(0.1, tolerance=1e-4), 2e-4),
        (Located(0.1, tolerance=1e-6), 2e-6),
        (Located(0.1, order=4, tolerance=1e-8), 2e-8),
    ],
)
def test_rods_that_lie_flat_stay_so(method, near):
    run, exact = simulate(thrown(), method), simulate(thrown(), EventDriven(1e-12, 1e-12))
    assert run.status == exact.status == Status.DONE
    np.testing.assert_allclose(run.q[-1], exact.q[-1], atol=near)
    np.testing.assert_allclose(run.q[-1].reshape(N, 3)[:, 1:], 0.0, atol=1e-12)
    # The floor has taken the momentum of the throw, and carries the weight since
    np.testing.assert_allclose(run.friction_impulse.sum(), -N * SPEED, rtol=1e-9)
    np.testing.assert_allclose(run.impulse.sum(), N * G0 * 1.5, rtol=1e-9)
