"""Complementary bases: given which z may be positive, the answer is a linear system.

With the index set a, z_a = -W_aa^-1 b_a and z = 0 elsewhere. The factors are fresh (LU with row
interchanges) and the answer is refined against W itself, so it is as accurate as the conditioning of W_aa
allows, however the set was found. If some z or w comes out negative, their indices change sides: all of
them while their number falls, else only the last (J. J. Judice and F. M. Pires, Comput. Oper. Res. 21 (1994)
587; K. G. Murty, Opsearch 11 (1974) 123), which is finite for P-matrices.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.elimination import back_substitute, copy, factorise, subtract
from lcpstep.lcp.judge import judge, share
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED
from lcpstep.lcp.workspace import ACTIVE, CHOSEN, COLUMN_SCALE, DSLACK, SCALED_B, SIZE, SLACK, TRIAL

REFINEMENTS = 2
PATIENCE = 3  # exchanges of all indices that may pass without progress


def solve_active(z: Any, k: int, work: Any) -> bool:
    """Fill z with the refined solution for the first k indices of ACTIVE; False if W_aa is singular."""
    F, columns, active = work.factor, work.columns, work.indices[ACTIVE]
    for p in range(k):
        for q in range(k):
            F[p, q] = columns[active[q], active[p]]
    if not factorise(F, k, work.indices):
        return False
    n, x, w, change = z.shape[0], work.vectors[TRIAL], work.vectors[SLACK], work.vectors[DSLACK]
    for i in range(n):
        x[i] = 0.0
    for _ in range(1 + REFINEMENTS):
        copy(w, work.vectors[SCALED_B], n)
        for q in range(k):
            subtract(w, columns[active[q]], -x[active[q]], n)
        for p in range(k):
            change[p] = w[active[p]]
        back_substitute(F, change, k, work.indices)
        for q in range(k):
            x[active[q]] -= change[q]
    for i in range(n):
        z[i] = x[i] * work.vectors[COLUMN_SCALE, i]
    return True


def exchange_indices(W: Any, b: Any, z: Any, tolerance: float, limit: int, work: Any) -> int:
    """Principal pivoting from the set marked in CHOSEN; every answer is judged. Returns a status.

    The last answer is in z, its residual in report[0]; iterations are added to report[1].
    """
    n = b.shape[0]
    fewest, patience = n + 1, PATIENCE
    for _ in range(limit):
        work.report[1] += 1.0
        if not solve_active(z, list_chosen(n, work), work):
            return FAILED
        work.report[0] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
        if work.report[0] <= tolerance:
            return judge_clipped(W, b, z, tolerance, work)
        wrong, last = mark_wrong(W, z, tolerance, work)
        if wrong < fewest:
            fewest, patience = wrong, PATIENCE
        else:
            patience -= 1
        for i in range(n):
            if work.vectors[TRIAL, i] != 0.0 and (patience > 0 or i == last):
                work.indices[CHOSEN, i] = 1 - work.indices[CHOSEN, i]
    return MAX_ITERATIONS


def list_chosen(n: int, work: Any) -> int:
    """List the marked indices in ACTIVE; returns how many there are."""
    k = 0
    for i in range(n):
        if work.indices[CHOSEN, i]:
            work.indices[ACTIVE, k] = i
            k += 1
    return k


def mark_wrong(W: Any, z: Any, tolerance: float, work: Any) -> tuple[int, int]:
    """Mark in TRIAL where z or w is negative beyond the tolerance; returns how many and the last."""
    wrong, last = 0, -1
    for i in range(z.shape[0]):
        negative_z = z[i] < 0.0 and share(W, z, work.vectors[SIZE], i) > tolerance
        negative_w = (
            work.indices[CHOSEN, i] == 0 and work.vectors[SLACK, i] < -tolerance * work.vectors[SIZE, i]
        )
        work.vectors[TRIAL, i] = 0.0
        if negative_z or negative_w:
            work.vectors[TRIAL, i] = 1.0
            wrong, last = wrong + 1, i
    return wrong, last


def judge_clipped(W: Any, b: Any, z: Any, tolerance: float, work: Any) -> int:
    """Cut what rounding left of negative z and judge the rest."""
    for i in range(z.shape[0]):
        z[i] = max(z[i], 0.0)
    work.report[0] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
    return SOLVED if work.report[0] <= tolerance else FAILED
