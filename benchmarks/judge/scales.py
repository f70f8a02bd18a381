"""How large the quantities of a motion are, so that rounding can be told from error, also where nothing moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.start import shortest

EPS = 2.0**-52
DRIFT, WITHIN = 4.0, 1e2  # times the rounding of what impulses give to gaps: over all steps, and within one
STILL = 1e-6  # of the length that forces would move it by: the size of a motion that stands still


@dataclass(frozen=True)
class Scales:
    """Of one motion.

    time : its shortest time, or the span; force (n,): the largest sum of the terms of the forces
    travel : how far it goes; reach : how far its speeds and forces would carry it in that time
    place (contacts,) : how large the numbers are that gaps are made of, times among them
    energy : its kinetic energy and the range of its potential; energies : the terms of these
    impulse : of forces during that time, and of momenta
    """

    time: float
    force: Any
    travel: float
    reach: float
    place: Any
    energy: float
    energies: float
    impulse: float

    @property
    def length(self) -> float:
        """A length with which differences of positions are compared."""
        return max(self.travel, STILL * self.reach, 1e-300)


def scales(d: Description, q: Any, v: Any) -> Scales:
    """Scales of a motion through states q, v (m, n)."""
    far, fast = np.max(np.abs(q), axis=0), np.maximum(np.max(np.abs(v), axis=0), np.abs(d.v0))
    time = min(shortest(d), d.length)
    b = np.abs(d.row("b"))
    bend = abs(d.pendulum) + abs(d.spread) * (b @ fast) ** 2
    force = sum(np.abs(d.row(x)) for x in ("constant", "cosine", "sine")) + bend * b
    force = force + np.abs(d.matrix("K")) @ far + np.abs(d.matrix("C")) @ fast + d.frame_force()
    inverse = np.abs(np.linalg.inv(physics.masses(d, q[0])))
    reach = float(np.max(fast) * time + np.max(inverse @ force) * time**2)
    bent = np.abs(d.row("bend", d.contacts)) * np.max(far) * max(1.0, float(np.max(far)))
    place = np.abs(np.array(d.G).reshape(-1, d.n)) @ far + np.abs(d.row("offset", d.contacts)) + bent
    moved = np.abs(np.array(d.G).reshape(-1, d.n)) @ (fast + d.omega * np.abs(d.row("frame")))
    moved = moved + d.omega * np.abs(d.row("amplitude", d.contacts))
    place = place + np.abs(d.row("amplitude", d.contacts)) + moved * max(map(abs, d.t_span))
    kinetic, potential = physics.energy(d, q, v)
    terms = 0.5 * far @ np.abs(d.matrix("K")) @ far + far @ np.abs(d.row("constant")) + abs(d.pendulum)
    mass = np.abs(physics.masses(d, q[0]))
    return Scales(
        time=time, force=force, travel=float(np.max(np.ptp(q, axis=0))), reach=reach, place=place,
        energy=float(np.max(kinetic) + np.ptp(potential)),
        energies=float(np.max(kinetic) + terms + force @ (inverse @ force) * time**2),
        impulse=float(np.max(mass @ fast) + np.max(force) * time),
    )  # fmt: skip


def drift(d: Description, m: Any) -> Any:
    """How far rounding of impulses has moved gaps by the end of each kept step, (kept - 1, contacts).

    What rests is struck alike in every step: speeds are what impulses leave of each other, the rounding of that sum
    has the same sign each time, and gaps follow its sum over the steps.
    """
    G, h = np.abs(physics.jacobians(d, m.q[0])), np.diff(m.t)[:, None]
    mobility = G @ np.abs(np.linalg.inv(physics.masses(d, m.q[0]))) @ G.T
    single = np.diag(mobility) * np.max(m.impulse, initial=0.0) * np.max(h)
    return EPS * (WITHIN * single + DRIFT * np.cumsum(h * (m.impulse[1:] @ mobility), axis=0))
