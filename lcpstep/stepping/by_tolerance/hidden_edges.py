"""Edges of obstacles that the steps of `Moreau` by a tolerance pass unseen, as kernels.

Where the row of a contact jumps with the place its gap velocity does so at a time that no step shows: one step and
its halves may agree on what they make of it. Rows that turn smoothly do so about as much in either half,

    bend = |(G+ - G) v + g_t+ - g_t|  in one half  <=  what forces make of the gap velocity + EDGE bend in the other.

Beyond an edge what has slid leaves its obstacle, or is struck; what flies may have landed before it.
"""

from __future__ import annotations

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles, Indices, abs, after, max
from lcpstep.stepping.theta_method.moving import Rows, State

EDGE = 4.0  # times by which a row that turns smoothly may turn more in one half of a step than in the other


class Edges:
    """Rows of contacts in the halves of a step.

    bend, forced, below : (2, n_c)   see above; how deep a gap would be at the end of the half without its edge
    passed                           whether what lasts has passed an edge
    depth                            of a gap before the edge that hides it

    Parameters
    ----------
    n_c : int   contacts
    """

    def __init__(self, n_c: int) -> None:
        self.n_c, self.passed, self.depth = n_c, False, 0.0
        self.kept = np.zeros(6 * n_c)
        self.bend = doubles(self.kept)
        self.forced, self.below = after(self.bend, 2 * n_c), after(self.bend, 4 * n_c)

    def note(self, half: int, h: float, s: State, rows: Rows, v: Doubles, g: Doubles, u: Doubles) -> None:
        """A half, 0 or 1, of size h that has been taken from velocities v, gaps g and their velocities u."""
        for i in range(self.n_c):
            k, along = half * self.n_c + i, product(rows.H, v, i, s.n_q)
            forced = product(rows.H, s.v_free, i, s.n_q) - along
            self.bend[k], self.forced[k] = abs(along + rows.H_t[i] - u[i]), abs(forced)
            self.below[k] = -(g[i] + h * (u[i] + 0.5 * forced))

    def find(self, held: Indices, slow: float) -> None:
        """What edges do in the step whose halves have been noted; `held`: contacts that last."""
        self.passed, self.depth = False, 0.0
        for i in range(self.n_c):
            k, other = i, i + self.n_c
            if self.bend[other] > self.bend[k]:
                k, other = other, k
            if self.bend[k] > slow + self.forced[k] + EDGE * self.bend[other]:
                if held[i] > 0:
                    self.passed = True
                else:
                    self.depth = max(self.depth, self.below[k])


def dip(g: float, u: float, u_next: float, h: float) -> float:
    """How deep a gap that closes first and then opens has been below zero in between."""
    if not u < 0.0 < u_next:
        return 0.0
    return max(0.0, 0.5 * h * u * u / (u_next - u) - max(0.0, g))
