"""Impulses and forces of some contacts together, and what is done where they have no answer.

What is held from all sides, bodies between walls without clearance or a point that three planes hold, has an answer
only as far as what is asked for agrees:

    y^T b >= 0   where   y >= 0,   W y = 0.

Of bodies at rest every b is rounding, and so is the sign of such a sum. Where there is no answer, contacts are let
close by what rounding may make of b, before it counts as none.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.pointers import max
from lcpstep.stepping.pieces.magnitudes import acceleration_terms, speed_terms
from lcpstep.stepping.pieces.refine import FORCES, NONE, solve_several
from lcpstep.stepping.pieces.smooth import mobilities
from lcpstep.stepping.pieces.state import Plan, Work


def solve_chosen(m: Model, plan: Plan, w: Work, place: int, n: int, guess: int) -> bool:
    """0 <= z, W z + b >= 0 on the chosen contacts; W = G A^-1 G^T with the A of `place`.

    w.z comes as a guess, of FORCES or IMPULSES; zeros: NONE. False where there is no answer; the chosen are then
    noted as the culprits.
    """
    w.lcp_calls += 1
    w.members = n
    if n == 1:
        own = mobilities(plan, w, place)[w.chosen[0] * (w.n_c + 1)]
        if own > 0.0:
            w.z[0] = max(0.0, -w.b[0] / own)
            return True
    if solve_several(m, plan, w, place, n, guess):
        return True
    loosen(m, plan, w, n, guess == FORCES)
    return solve_several(m, plan, w, place, n, NONE)


def loosen(m: Model, plan: Plan, w: Work, n: int, forces: bool) -> None:
    """Let the chosen contacts close by what rounding may make of b: accelerations, or speeds."""
    for k in range(n):
        c = w.chosen[k]
        w.b[k] += NOISE * (acceleration_terms(m, w, c) if forces else speed_terms(plan, w, c))
        w.z[k] = 0.0
