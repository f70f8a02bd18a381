"""The slider-crank with clearance: crank, rod, and a slider whose four corners strike the guide.

Angles of crank, rod and slider; the slider's corners at (+-a, +-b) from its middle lie within the half height b + c
of the guide, c being the clearance. Parameters: P. Flores, R. Leine, C. Glocker, Modeling and analysis of planar
rigid multibody systems with translational clearance joints based on the non-smooth dynamics approach, Multibody
System Dynamics 23 (2010), table 1. What usually goes wrong: many nearly simultaneous impacts of the corners.
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

# p: crank and rod length, half length and half height of the slider, clearance [m], masses [kg], moments of
# inertia [kg m^2], gravity [m/s^2]
L1, L2, A, B, C, M1, M2, M3, J1, J2, J3, G = range(12)
TABLE_1 = (0.153, 0.306, 0.05, 0.025, 0.001, 0.038, 0.038, 0.076, 7.4e-5, 5.9e-4, 2.7e-6, 9.81)


def mass(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """M."""
    coupling = (0.5 * p[M2] + p[M3]) * p[L1] * p[L2] * math.cos(q[0] - q[1])
    out[0, 0] = p[J1] + (0.25 * p[M1] + p[M2] + p[M3]) * p[L1] * p[L1]
    out[1, 1] = p[J2] + (0.25 * p[M2] + p[M3]) * p[L2] * p[L2]
    out[2, 2] = p[J3]
    out[0, 1] = out[1, 0] = coupling
    out[0, 2] = out[2, 0] = out[1, 2] = out[2, 1] = 0.0


def force(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """F - N."""
    coupling = (0.5 * p[M2] + p[M3]) * p[L1] * p[L2] * math.sin(q[0] - q[1])
    out[0] = -coupling * v[1] * v[1] - (0.5 * p[M1] + p[M2] + p[M3]) * p[G] * p[L1] * math.cos(q[0])
    out[1] = coupling * v[0] * v[0] - (0.5 * p[M2] + p[M3]) * p[G] * p[L2] * math.cos(q[1])
    out[2] = 0.0


def corner_gaps(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Distances of the corners from the guide: upper left and right, lower left and right."""
    middle = p[L1] * math.sin(q[0]) + p[L2] * math.sin(q[1])
    s, c = p[A] * math.sin(q[2]), p[B] * math.cos(q[2])
    for k in range(4):
        side, up = (-1.0 if k % 2 == 0 else 1.0), (1.0 if k < 2 else -1.0)
        out[k] = p[B] + p[C] - up * (middle + side * s + up * c)


def corner_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Their derivatives."""
    for k in range(4):
        side, up = (-1.0 if k % 2 == 0 else 1.0), (1.0 if k < 2 else -1.0)
        out[k, 0] = -up * p[L1] * math.cos(q[0])
        out[k, 1] = -up * p[L2] * math.cos(q[1])
        out[k, 2] = -up * (side * p[A] * math.cos(q[2]) - up * p[B] * math.sin(q[2]))


def corner_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Their accelerations at v' = 0."""
    for k in range(4):
        side, up = (-1.0 if k % 2 == 0 else 1.0), (1.0 if k < 2 else -1.0)
        out[k] = up * (
            p[L1] * math.sin(q[0]) * v[0] * v[0]
            + p[L2] * math.sin(q[1]) * v[1] * v[1]
            + (side * p[A] * math.sin(q[2]) + up * p[B] * math.cos(q[2])) * v[2] * v[2]
        )


def corner_tangent(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Sliding velocities of the corners along the guide."""
    for k in range(4):
        side, up = (-1.0 if k % 2 == 0 else 1.0), (1.0 if k < 2 else -1.0)
        out[k, 0] = -p[L1] * math.sin(q[0])
        out[k, 1] = -p[L2] * math.sin(q[1])
        out[k, 2] = -side * p[A] * math.sin(q[2]) - up * p[B] * math.cos(q[2])


@checked
def slider_crank(
    clearance: float = 0.001,
    restitution: float = 0.4,
    mu: float = 0.01,
    rate: float = 150.0,
    t_end: float = 0.05,
) -> Scene:
    """Slider-crank started stretched out, with the crank at `rate` [rad/s], the slider in the middle of its guide.

    Parameters
    ----------
    clearance : between slider and guide, on each side [m]
    mu : friction of the corners, which has no restitution on the tangent; 0 for none
    """
    p = np.array(TABLE_1)
    p[C] = clearance
    friction = Coulomb(mu, corner_tangent, restitution=0.0) if mu != 0.0 else None
    return Scene(
        system=System(3, mass, force),
        contacts=Contacts(
            4, corner_gaps, corner_jacobian, bias=corner_bias, restitution=restitution, friction=friction
        ),
        q0=[0.0, 0.0, 0.0],
        v0=[rate, -rate * p[L1] / p[L2], 0.0],
        t_span=(0.0, t_end),
        p=p,
        parameters={"clearance": clearance, "restitution": restitution, "mu": mu, "rate": rate},
        name="slider-crank",
        coordinates=["angle of the crank [rad]", "of the rod [rad]", "of the slider [rad]"],
    )


def energy(q: Array, v: Array) -> Array:
    """Energy of the mechanism of table 1 at states q, v of shape (m, 3) [J]; impacts and friction only lower it."""
    p, total = np.array(TABLE_1), []
    M = np.zeros((3, 3))
    for x, dx in zip(q, v, strict=True):
        mass(0.0, x, dx, p, M)
        height = (0.5 * p[M1] + p[M2] + p[M3]) * p[L1] * math.sin(x[0])
        height += (0.5 * p[M2] + p[M3]) * p[L2] * math.sin(x[1])
        total.append(0.5 * dx @ M @ dx + p[G] * height)
    return np.array(total)
