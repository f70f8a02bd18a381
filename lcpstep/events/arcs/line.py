"""Which scenes with friction move along a line under a constant normal force, and their equation of motion.

Two coordinates, one contact that is closed and stays so: q = q_N + d z with G d = 0, T d = 1, and from the equation
of motion, multiplied by d and by e (e T = 0, e G = 1),

    m z'' + c z' + k z = F(t) + lambda_T,    lambda_N = e (M d z'' + C d z' + K (q_N + d z) - F(t))

The second is a constant where e M d, e C d, e K d and e F's harmonic terms vanish. The sliding velocity is
z' + slip(t).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep.events.flight.oscillator import Oscillator, oscillator
from lcpstep.kernels.roundings import NOISE

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Line:
    """Motion along the surface of a contact.

    oscillator      of z, without friction;  mass : m;  fc, fs : harmonic force over m
    place, way : (2,)   q_N and d
    normal          lambda_N
    pull, most      friction over m of what slides, and the most of what sticks
    slip : (4,)     constant, cosine and sine of the sliding velocity at rest, and their frequency
    z, dz           at the start
    """

    oscillator: Oscillator
    mass: float
    fc: float
    fs: float
    place: Array
    way: Array
    normal: float
    pull: float
    most: float
    slip: tuple[float, float, float, float]
    z: float
    dz: float


def line_of(scene: Scene) -> Line | None:
    """The motion of a scene along its contact; None where it is not one of this kind."""
    system, contacts = scene.system, scene.contacts
    if not (isinstance(system, LinearSystem) and isinstance(contacts, LinearContacts)) or system.sparse:
        return None
    friction, force = contacts.friction, system.force
    shape = scene.n_q == 2 and scene.n_c == 1 and scene.n_j == 0 and np.size(scene.corners) == 0
    if not shape or friction is None or not isinstance(force, Harmonic):
        return None
    if (
        system.frame is not None
        or contacts.motion is not None
        or callable(friction.mu)
        or callable(friction.tangent)
    ):
        return None
    mu = float(np.asarray(friction.mu)[0])
    mu_s = mu if friction.mu_s is None else float(np.asarray(friction.mu_s)[0])
    return None if mu_s == 0.0 else _along(scene, system, force, contacts, friction, mu, mu_s)


def _along(
    scene: Scene, system: Any, force: Harmonic, contacts: Any, friction: Any, mu: float, mu_s: float
) -> Line | None:
    """The same, of two coordinates and one contact with these coefficients of friction."""
    G, T = np.asarray(contacts.G)[0], np.asarray(friction.tangent)[0]
    q, v = np.asarray(scene.q0), np.asarray(scene.v0)
    area = float(T[0] * G[1] - T[1] * G[0])
    gap = [*(G * q), float(np.asarray(contacts.offset)[0])]
    if area == 0.0 or not (_nothing(gap) and _nothing(G * v)):
        return None
    d, e = np.array([G[1], -G[0]]) / area, np.array([-T[1], T[0]]) / area
    place = q - d * (T @ q)  # G q_N = -offset, T q_N = 0
    M, C, K = system.M, system.C, system.K
    constant, cosine, sine = force.terms(2)
    pushes = [e[:, None] * A * d for A in (M, C, K)] + [e * f for f in (cosine, sine)]
    if not all(map(_nothing, pushes)):
        return None
    normal = float(e @ (K @ place - constant))
    mass, forces = float(d @ M @ d), (float(d @ (constant - K @ place)), float(d @ cosine), float(d @ sine))
    o = oscillator(mass, float(d @ C @ d), float(d @ K @ d), *forces, force.omega)
    if not normal > 0.0 or o is None:
        return None
    delta, w2 = float(o.delta), float(o.w2)
    if not ((delta == 0.0 and w2 == 0.0) or (delta >= 0.0 and w2 > delta * delta)):
        return None  # no bound on derivatives of the free motion is known
    swings = o.Omega != 0.0
    return Line(
        o, mass, forces[1] / mass if swings else 0.0, forces[2] / mass if swings else 0.0, place, d, normal,
        mu * normal / mass, mu_s * normal / mass, _slip(friction.slip), float(T @ q), float(T @ v),
    )  # fmt: skip


def _nothing(terms: Any) -> bool:
    """Whether a sum is zero to rounding."""
    return abs(float(np.sum(terms))) <= NOISE * float(np.sum(np.abs(terms)))


def _slip(slip: Any) -> tuple[float, float, float, float]:
    """Constant, cosine, sine and frequency of the sliding velocity of what is at rest."""
    if not isinstance(slip, Harmonic):
        return float(np.asarray(slip)[0]), 0.0, 0.0, 0.0
    constant, cosine, sine = (float(x[0]) for x in slip.terms(1))
    if slip.omega == 0.0 or math.hypot(cosine, sine) == 0.0:
        return constant + (cosine if slip.omega == 0.0 else 0.0), 0.0, 0.0, 0.0
    return constant, cosine, sine, float(slip.omega)
