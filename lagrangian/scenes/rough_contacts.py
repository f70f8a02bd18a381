"""Mechanisms that move by their friction: the woodpecker toy, and a rod that slides on a rough floor (Painleve).

What usually goes wrong: the toy's orbit is a chain of impacts, sticking and sliding of which none may be missed; the
rod has no contact force, or two, from a coefficient of friction on, and a solver that does not say so makes one up.
"""

from __future__ import annotations

import math
from typing import Any

from lagrangian import checks
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import LinearSystem, System

CLEARANCE = 0.0006  # of the sleeve's hole around the pole [m]
HALF_HEIGHT = 0.0058  # of the sleeve [m]


@checked
def woodpecker(mu: float = 0.3, g: float = 9.81, t_end: float = 1.0) -> Scene:
    """Woodpecker on a sleeve that slides down a pole; beak, upper and lower edge of the sleeve touch it.

    The coordinates are the height of the sleeve [m], and the angles of the sleeve and of the bird [rad]. The start is
    near its periodic orbit, at an impact of the upper edge. Source, also of the numbers: R. I. Leine, C. Glocker, D.
    H. van Campen, Nonlinear dynamics and modeling of various wooden toys with impact and friction, Journal of
    Vibration and Control 9 (2003) 25.
    """
    checks.positive("mu", mu)
    m_sleeve, J_sleeve, m_bird, J_bird, stiffness = 0.0003, 5.0e-9, 0.0045, 7.0e-7, 0.0056
    r, r_pole, l_sleeve, l_bird, h_beak, l_beak = 0.0031, 0.0025, 0.010, 0.015, 0.02, 0.0201
    m = m_bird
    M = [
        [m + m_sleeve, m * l_sleeve, m * l_bird],
        [m * l_sleeve, J_sleeve + m * l_sleeve**2, m * l_sleeve * l_bird],
        [m * l_bird, m * l_sleeve * l_bird, J_bird + m * l_bird**2],
    ]
    spring = [[0.0, 0.0, 0.0], [0.0, stiffness, -stiffness], [0.0, -stiffness, stiffness]]
    load = [-(m + m_sleeve) * g, -m * l_sleeve * g, -m * l_bird * g]
    tangents = [[1.0, l_sleeve, l_bird - l_beak], [1.0, r, 0.0], [1.0, r, 0.0]]
    return Scene(
        system=LinearSystem(M=M, K=spring, force=load),
        contacts=LinearContacts(
            G=[[0.0, 0.0, -h_beak], [0.0, HALF_HEIGHT, 0.0], [0.0, -HALF_HEIGHT, 0.0]],
            offset=[l_sleeve + l_bird - l_beak - r_pole, CLEARANCE, CLEARANCE],
            restitution=[0.5, 0.0, 0.0],
            friction=Coulomb(mu, tangents, restitution=0.0),
        ),
        q0=[0.0, -CLEARANCE / HALF_HEIGHT, -0.2788],
        v0=[-0.3411, 0.0, -7.4583],
        t_span=(0.0, t_end),
        parameters={"mu": mu, "g": g},
        name="woodpecker",
        coordinates=["height of the sleeve [m]", "angle of the sleeve [rad]", "angle of the bird [rad]"],
    )


def weight(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """The weight of the rod."""
    out[0], out[1], out[2] = 0.0, -p[1], 0.0


def tip_gap(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Height of the lower tip above the floor; p = (half length, g)."""
    out[0] = q[1] - p[0] * math.sin(q[2])


def tip_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative."""
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 1.0, -p[0] * math.cos(q[2])


def tip_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Gap acceleration at v' = 0."""
    out[0] = p[0] * math.sin(q[2]) * v[2] * v[2]


def tip_tangent(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Sliding velocity of the tip."""
    out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, p[0] * math.sin(q[2])


@checked
def falling_rod(
    mu: float = 0.5, angle: float = 1.0, v0: float = -1.0, g: float = 9.81, t_end: float = 0.2
) -> Scene:
    """Uniform rod of 1 kg and 1 m that slides on its lower tip, `angle` [rad] above the floor, and falls.

    The coordinates are those of the centre [m] and the angle. Sliding towards the side to which the tip points
    (v0 < 0), it has no contact force, or two, from `critical_friction(angle)` on: never below 4/3. Source: P.
    Painleve, Comptes Rendus 121 (1895) 112; F. Genot, B. Brogliato, European Journal of Mechanics A/Solids 18 (1999)
    653.
    """
    checks.positive("mu", mu)
    if not 0.0 < angle < 0.5 * math.pi:
        raise ValueError(f"angle: expected an angle in (0, pi/2), got {angle!r}")
    return Scene(
        system=System(3, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0 / 12.0]], weight),
        contacts=Contacts(1, tip_gap, tip_jacobian, bias=tip_bias, friction=Coulomb(mu, tip_tangent)),
        q0=[0.0, 0.5 * math.sin(angle), angle],
        v0=[v0, 0.0, 0.0],
        t_span=(0.0, t_end),
        p=[0.5, g],
        parameters={"mu": mu, "angle": angle, "v0": v0, "g": g},
        name="falling-rod",
        coordinates=["x [m]", "y [m]", "angle [rad]"],
    )


def critical_friction(angle: float) -> float:
    """The coefficient of friction from which on the sliding rod jams at this angle [rad]; 4/3 at least."""
    return (1.0 + 3.0 * math.cos(angle) ** 2) / (3.0 * math.sin(angle) * math.cos(angle))
