"""Cam profiles as chains of circular arcs, with their corners.

An arc with centre at polar position (kappa, psi) and radius rho has, seen from the cam's axis, the radius

    c(beta) = kappa cos(beta - psi) + sqrt(rho^2 - kappa^2 sin^2(beta - psi))

at the angle beta; kappa = 0 is a dwell. Where two arcs meet smoothly, c and c' are continuous and c'' jumps:
a corner (of degree two). Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array

TWO_PI = 2.0 * math.pi
SAMPLES = 65  # angles at which an arc is checked
AHEAD = 1.0 + 2.0**-52  # times an angle: the next one
HEAD = 5  # numbers before the arcs in a packed profile: omega, phase, offset, fold, number of arcs


@dataclass(frozen=True)
class Arc:
    """Circular arc up to the angle `end` [rad]; centre (kappa, psi) [m, rad], radius rho [m]."""

    end: float
    kappa: float
    psi: float
    rho: float


@dataclass(frozen=True)
class CamProfile:
    """Closed chain of arcs from beta = 0 on, minus a constant offset.

    Parameters
    ----------
    arcs : the arcs in order; the last one ends at pi (symmetric) or at 2 pi
    offset : subtracted from the radius to give the lift [m]
    symmetric : the second half of the turn mirrors the first

    Raises
    ------
    ValueError   the arcs are out of order, do not close, or the lift jumps between two of them
    """

    arcs: tuple[Arc, ...]
    offset: float = 0.0
    symmetric: bool = True

    def __post_init__(self) -> None:
        for k, arc in enumerate(self.arcs):
            for name in ("end", "kappa", "psi", "rho"):
                checks.number(f"arcs: {name} of arc {k}", getattr(arc, name))
        ends = [arc.end for arc in self.arcs]
        if not ends or sorted(ends) != ends or ends[0] <= 0.0:
            raise ValueError(f"arcs: expected increasing positive angles `end`, got {ends}")
        if abs(ends[-1] - self._fold) > 1e-12:
            raise ValueError(f"arcs: expected the last one to end at {self._fold:.6f}, got {ends[-1]}")
        starts = [0.0, *ends[:-1]]
        for k, (start, arc) in enumerate(zip(starts, self.arcs, strict=True)):
            reach = np.abs(arc.kappa * np.sin(np.linspace(start, arc.end, SAMPLES) - arc.psi))
            if not np.max(reach) < arc.rho:
                raise ValueError(
                    f"arcs: arc {k}: seen from the axis, the circle does not reach all angles of {arc}"
                )
        for beta in self.corners():
            before, after = (self.lift(beta + side)[0] for side in (-1e-12, 1e-12))
            if not abs(before - after) <= 1e-9 * max(arc.rho for arc in self.arcs):
                raise ValueError(f"arcs: the lift jumps from {before} to {after} at the angle {beta}")

    @property
    def _fold(self) -> float:
        return math.pi if self.symmetric else TWO_PI

    def corners(self) -> Array:
        """Angles in [0, 2 pi) at which one arc meets the next [rad], increasing; mirror images included."""
        inner = [arc.end for arc in self.arcs[:-1]]
        if self.symmetric:
            return np.array(inner + [TWO_PI - end for end in reversed(inner)])
        return np.array([0.0, *inner])

    def lift(self, beta: float) -> Array:
        """Lift c [m] and its derivatives dc/dbeta, d2c/dbeta2 at the angle beta [rad]; shape (3,)."""
        out = np.zeros((1, 3))
        rotating_cam(beta, out[0], out[0], self.pack(omega=1.0, phase=0.0), out)
        return out[0]

    def pack(self, omega: float, phase: float) -> Array:
        """Parameters p of `rotating_cam` for this profile turning at omega [rad/s] from the angle `phase`."""
        checks.number("omega", omega)
        arcs = [x for arc in self.arcs for x in (arc.end, arc.kappa, arc.psi, arc.rho)]
        return np.array([omega, phase, self.offset, self._fold, float(len(self.arcs)), *arcs])


def rotating_cam(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Lift of a turning cam with its time derivatives, out[0] = (c, c', c''); p from `CamProfile.pack`.

    A callback for `LinearSystem.frame` (the follower relative to the cam) or `LinearContacts.motion`. On a corner it
    tells of the arc that begins there.
    """
    omega, fold = p[0], p[3]
    beta = omega * t + p[1]
    beta -= TWO_PI * math.floor(beta / TWO_PI)  # faster than the remainder
    if omega < 0.0 and beta == 0.0:
        beta = TWO_PI
    direction = omega
    if beta > fold:
        beta, direction = TWO_PI - beta, -omega
    ahead = beta * AHEAD if direction > 0.0 else beta
    at = HEAD
    last = HEAD + 4 * (int(p[4]) - 1)
    while at < last and ahead > p[at]:
        at += 4
    kappa, rho = p[at + 1], p[at + 3]
    if kappa == 0.0:
        out[0, 0], out[0, 1], out[0, 2] = rho - p[2], 0.0, 0.0
        return
    a, b = kappa * math.cos(beta - p[at + 2]), kappa * math.sin(beta - p[at + 2])
    root = math.sqrt(rho * rho - b * b)
    out[0, 0] = a + root - p[2]
    out[0, 1] = direction * (-b - a * b / root)
    out[0, 2] = omega * omega * (-a - (a * a - b * b) / root - (a * b) ** 2 / root**3)
