"""A chain of n hinged links that falls on a rough floor, described by sparse matrices.

The coordinates are the places of the n + 1 hinges, q = (x_0, y_0, x_1, y_1, ...). A uniform rod of mass m between two
of them has the energies m (v_a^2 + v_a v_b + v_b^2)/6 and m g (y_a + y_b)/2, so the mass matrix is constant, and that
it keeps its length is the joint (|r_b - r_a|^2 - l^2)/(2 l) = 0. Every hinge meets the floor y = 0 with friction.
Source: J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems (Springer 1994), section 4.
What usually goes wrong: dense matrices; lying flat, rods and sticking hinges say the same thing twice, and the
forces between them are not unique.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.contacts import LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.joints import Joints
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem


def lengths(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Joints (|r_b - r_a|^2 - l^2) / (2 l); p = (l, n)."""
    for k in range(int(p[1])):
        x, y = q[2 * k + 2] - q[2 * k], q[2 * k + 3] - q[2 * k + 1]
        out[k] = (x * x + y * y - p[0] * p[0]) / (2.0 * p[0])


def directions(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Entries of their Jacobian, four a link."""
    for k in range(int(p[1])):
        x, y = (q[2 * k + 2] - q[2 * k]) / p[0], (q[2 * k + 3] - q[2 * k + 1]) / p[0]
        out[4 * k], out[4 * k + 1], out[4 * k + 2], out[4 * k + 3] = -x, -y, x, y


def turning(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Second derivatives of the joints at v' = 0."""
    for k in range(int(p[1])):
        x, y = v[2 * k + 2] - v[2 * k], v[2 * k + 3] - v[2 * k + 1]
        out[k] = (x * x + y * y) / p[0]


@checked
def hinged_chain(
    n: int = 8,
    link: float = 0.1,
    slope: float = 0.8,
    height: float = 0.05,
    speed: float = 0.5,
    mu: float = 0.3,
    restitution: float = 0.0,
    g: float = 9.81,
    t_end: float = 0.5,
) -> Scene:
    """Chain of n links of 1 kg and `link` [m], thrown along a rough floor with `speed` [m/s].

    Link k starts at the angle slope sin(k) [rad] to the floor, the lowest hinge at `height` [m] above it.
    """
    from scipy import sparse

    checks.count("n", n)
    checks.positive("link", link)
    checks.positive("g", g)
    checks.number("height", height, least=0.0)
    checks.number("mu", mu, least=0.0)
    angle = slope * np.sin(np.arange(n))
    places = np.zeros((n + 1, 2))
    places[1:] = link * np.cumsum(np.column_stack([np.cos(angle), np.sin(angle)]), axis=0)
    places[:, 1] += height - np.min(places[:, 1])
    k, weights = np.arange(n), np.full(n + 1, g)
    weights[[0, -1]] *= 0.5
    halves = sparse.diags_array([np.full(n, 1.0 / 6.0)] * 2, offsets=[-1, 1])
    M = sparse.kron(sparse.diags_array(weights * 2.0 / (3.0 * g)) + halves, sparse.eye_array(2))
    rows, columns = np.arange(n + 1), 2 * np.arange(n + 1)
    along, up = (
        sparse.csr_array((np.ones(n + 1), (rows, columns + i)), shape=(n + 1, 2 * n + 2)) for i in (0, 1)
    )
    pattern = np.repeat(k, 4), (2 * k[:, None] + np.arange(4)).ravel()
    return Scene(
        system=LinearSystem(M, force=Harmonic(constant=np.kron(-weights, [0.0, 1.0]))),
        contacts=LinearContacts(up, restitution=restitution, friction=Coulomb(mu, along)),
        joints=Joints(n, lengths, directions, bias=turning, pattern=pattern),
        q0=places.ravel(),
        v0=np.tile([speed, 0.0], n + 1),
        t_span=(0.0, t_end),
        p=[link, float(n)],
        parameters={
            "n": n, "link": link, "slope": slope, "height": height, "speed": speed, "mu": mu,
            "restitution": restitution, "g": g,
        },
        name="hinged-chain",
    )  # fmt: skip
