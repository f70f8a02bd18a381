"""The impact that creates energy: a double pendulum of two uniform rods whose tip strikes a rough floor.

Newton's law on the normal with Coulomb's law between the impulses, restitution none on the tangent, raises the
kinetic energy by 58.75 % here; with Moreau's law, which has the restitution on the tangent too, it falls by 43.76
%, and it cannot rise where the impact is integrated over its impulse (Stronge). Source: T. R. Kane, D. A. Levinson,
Dynamics: Theory and Applications (McGraw-Hill 1985); V. Acary, B. Brogliato, Numerical Methods for Nonsmooth
Dynamical Systems (Springer 2008), section 3. What usually goes wrong: the energy is created silently.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lagrangian.checks import Array
from lagrangian.contacts import Contacts
from lagrangian.friction import Coulomb
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import System

SETTLED = 1e-12  # of a law of impact found to hold


def mass(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """M of two uniform rods of unit mass and length."""
    out[0, 0], out[1, 1] = 4.0 / 3.0, 1.0 / 3.0
    out[0, 1] = out[1, 0] = 0.5 * math.cos(q[0] - q[1])


def force(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """F - N; p = (g, floor)."""
    s = math.sin(q[0] - q[1])
    out[0] = -0.5 * s * v[1] * v[1] - 1.5 * p[0] * math.sin(q[0])
    out[1] = 0.5 * s * v[0] * v[0] - 0.5 * p[0] * math.sin(q[1])


def floor_gap(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Height of the tip above the floor."""
    out[0] = p[1] - math.cos(q[0]) - math.cos(q[1])


def floor_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative."""
    out[0, 0], out[0, 1] = math.sin(q[0]), math.sin(q[1])


def floor_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Gap acceleration at v' = 0."""
    out[0] = math.cos(q[0]) * v[0] * v[0] + math.cos(q[1]) * v[1] * v[1]


def floor_tangent(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Sliding velocity of the tip."""
    out[0, 0], out[0, 1] = math.cos(q[0]), math.cos(q[1])


@checked
def kane_pendulum(
    restitution: float = 0.5, mu: float = 0.5, law: str = "moreau", g: float = 0.0, t_end: float = 0.01
) -> Scene:
    """Two rods at 20 and 30 degrees, with rates -0.1 and -0.2 rad/s, at the instant at which the tip strikes.

    Parameters
    ----------
    law : "moreau": restitution on the tangent too; "newton": none on the tangent; "stronge": of energy
    """
    a, b = math.radians(20.0), math.radians(30.0)
    friction = Coulomb(mu, floor_tangent, law=law)
    return Scene(
        system=System(2, mass, force),
        contacts=Contacts(
            1, floor_gap, floor_jacobian, bias=floor_bias, restitution=restitution, friction=friction
        ),
        q0=[a, b],
        v0=[-0.1, -0.2],
        t_span=(0.0, t_end),
        p=[g, math.cos(a) + math.cos(b)],
        parameters={"restitution": restitution, "mu": mu, "law": law, "g": g},
        name="kane-pendulum",
        coordinates=["angle 1 [rad]", "angle 2 [rad]"],
    )


def kinetic_energy(q: Array, v: Array) -> float:
    """Kinetic energy of the rods [J]."""
    M = np.zeros((2, 2))
    mass(0.0, q, v, v, M)
    return 0.5 * float(v @ M @ v)


def after_impact(scene: Scene) -> Array:
    """Velocities after the impact at the start, by Moreau's law or Newton's: sticking or sliding either way.

    With u_N+ = -r u_N, the tangent sticks at u_T+ = -r_T u_T where that takes |p_T| <= mu p_N, and slides with
    p_T = -+mu p_N where u_T+ + r_T u_T is then of the opposite sign.
    """
    q, v = np.array(scene.q0), np.array(scene.v0)
    r, mu = float(scene.parameters["restitution"]), float(scene.parameters["mu"])
    r_T = r if scene.parameters["law"] == "moreau" else 0.0
    M, D = np.zeros((2, 2)), np.zeros((2, 2))
    mass(0.0, q, v, v, M)
    floor_jacobian(0.0, q, v, v, D[:1])
    floor_tangent(0.0, q, v, v, D[1:])
    W, u = D @ np.linalg.solve(M, D.T), D @ v
    wanted = -np.array([(1.0 + r) * u[0], (1.0 + r_T) * u[1]])
    found = []
    p = np.linalg.solve(W, wanted)
    if p[0] >= 0.0 and abs(p[1]) <= mu * p[0] + SETTLED:
        found.append(p)
    for sign in (1.0, -1.0):
        p_N = wanted[0] / (W[0, 0] + sign * mu * W[0, 1])
        p = p_N * np.array([1.0, sign * mu])
        if p_N >= 0.0 and sign * ((W @ p)[1] - wanted[1]) <= SETTLED:
            found.append(p)
    if len(found) != 1:
        raise ValueError(f"mu: the law of impact has {len(found)} solutions here")
    return np.asarray(v + np.linalg.solve(M, D.T @ found[0]), dtype=float)


def energy_change(scene: Scene) -> float:
    """Kinetic energy gained in the impact, relative to that before it."""
    q = np.array(scene.q0)
    return kinetic_energy(q, after_impact(scene)) / kinetic_energy(q, np.array(scene.v0)) - 1.0
