"""Motions that have no end in finite numbers: a run that says NOT_FINITE there is right.

That is told by the scene alone, not by methods that agree: free motions that grow without bound, and obstacles that
close upon a body.
"""

from __future__ import annotations

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import Run

HUGE = 700.0  # log of 1e304: four powers of ten are left for what products and squares of steps need
ROUNDING = 1e-9  # of the numbers that a gap is made of


def grows_beyond(d: Description, r: Run) -> bool:
    """Whether the free motion has had the time to grow to the largest numbers, as on a spring of negative stiffness.

    Obstacles at rest give no energy, so nothing grows faster than exp(rate t) but for the size it begins with; a run
    that has left the finite numbers before that has done so by itself.
    """
    return growth(d) * float(r.motion.t[-1] - d.t_span[0]) >= HUGE


def growth(d: Description) -> float:
    """Largest rate at which the free motion grows, of M a + C v + K q = f(t); 0 of other systems [1/s]."""
    if d.general or d.curved or d.moving or len(d.J):
        return 0.0
    inverse = np.linalg.inv(d.matrix("M"))
    upper = np.hstack([np.zeros((d.n, d.n)), np.eye(d.n)])
    lower = np.hstack([-inverse @ d.matrix("K"), -inverse @ d.matrix("C")])
    return max(0.0, float(np.max(np.linalg.eigvals(np.vstack([upper, lower])).real)))


def closed_up(d: Description, r: Run) -> bool:
    """Whether an obstacle has left no place above it: each blow throws the body back harder, without end.

    What counts as none is measured by the scene: a run that has left the finite numbers knows no lengths.
    """
    sizes = np.abs(d.row("offset", d.contacts)) + np.abs(d.row("amplitude", d.contacts))
    return bool(np.any(physics.highest(d, float(r.motion.t[-1])) <= ROUNDING * sizes))
