"""A cart held between two rough walls without clearance, at rest: it is wedged, and never moves.

The more one wall presses the more the other does, so friction takes any load. A pendulum that hangs on the cart
swings as on a fixed pivot, which is known in closed form; at the edges of cones the cart must not break loose.
"""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, Joints, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Kind, Located, Status, simulate
from tests.marks import seeds
from tests.stepping.jointed import G0, swing


def rod(t, q, v, p, out):
    out[0] = 0.5 * ((q[2] - q[0]) ** 2 + (q[3] - q[1]) ** 2 - 1.0)


def rod_jacobian(t, q, v, p, out):
    for i in range(2):
        out[0, i], out[0, 2 + i] = q[i] - q[2 + i], q[2 + i] - q[i]


def guide(masses, slope, mu, mu_s, amplitude, t_end):
    """The cart, its guide inclined, and the pendulum let go at rest."""
    normal, along = (
        (-math.sin(slope), math.cos(slope), 0.0, 0.0),
        (math.cos(slope), math.sin(slope), 0.0, 0.0),
    )
    M = np.repeat(masses, 2)
    return Scene(
        LinearSystem(M=np.diag(M), force=-G0 * M * [0.0, 1.0, 0.0, 1.0]),
        q0=[0.0, 0.0, math.sin(amplitude), -math.cos(amplitude)], v0=np.zeros(4), t_span=(0.0, t_end),
        contacts=LinearContacts([normal, np.negative(normal)], 0.0, friction=Coulomb(mu, [along] * 2, mu_s=mu_s)),
        joints=Joints(1, rod, rod_jacobian),
    )  # fmt: skip


def off(m, amplitude):
    """How far the cart is from where it was, and the pendulum from where it swings."""
    angle, _ = swing(m.t, amplitude, math.sqrt(G0))
    own = np.stack([0.0 * m.t, 0.0 * m.t, np.sin(angle), -np.cos(angle)], axis=1)
    return np.max(np.abs(m.q - own)[:, :2]), np.max(np.abs(m.q - own))


@pytest.mark.parametrize("h", [5e-3, 2e-3, 1e-3, 7e-4, 5e-4])
def test_cart_stays_wedged_by_steps_of_any_size(h):
    amplitude = 0.5 * math.pi
    scene = guide([2.0, 1.0], 0.0, [0.1, 0.1], [0.13, 0.13], amplitude, 6.0)
    m, exact = simulate(scene, Located(h)), simulate(scene, EventDriven(1e-11))
    moved, far = off(m, amplitude)
    assert moved < 1e-15
    assert far < 40.0 * h * h
    assert np.max(np.abs(m.q[-1] - exact.q[-1])) < 40.0 * h * h
    assert np.sum(m.impacts.kind == Kind.SLIP) == np.sum(exact.impacts.kind == Kind.SLIP)
    assert np.sum(m.impacts.kind == Kind.REVERSE) < 3


@pytest.mark.parametrize("numbers", seeds(60, 30))
@pytest.mark.parametrize(
    ("method", "near"),
    [(EventDriven(1e-10), 1e-7), (Located(1e-3), 1e-4), (Located(2e-3, order=4), 1e-7)],
    ids=repr,
)
def test_cart_stays_wedged(method, near, numbers):
    for seed in numbers:
        rng = np.random.default_rng(seed)
        mu = rng.uniform(0.02, 0.5, 2)
        amplitude = rng.uniform(0.3, 3.0)
        more = rng.choice([1.0, 1.3])
        scene = guide(rng.uniform(0.5, 3.0, 2), rng.uniform(-0.6, 0.6), mu, more * mu, amplitude, 3.0)
        m = simulate(scene, method)
        moved, far = off(m, amplitude)
        assert m.status == Status.DONE, (seed, m.message)
        assert moved < 1e-9, seed
        assert far < near, seed
