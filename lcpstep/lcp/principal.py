"""Complementary bases: given which z may be positive, the answer is a linear system.

With the index set a, z_a = -W_aa^-1 b_a and z = 0 elsewhere. The factors are fresh (LU) and the answer is
refined against W itself, so it is as accurate as the conditioning of W_aa allows, however the set was found.
Indices whose column depends on the others (a contact given twice) are left out of the set. Where z or w comes
out negative the indices change sides, all at once (M. M. Kostreva, Linear Algebra Appl. 21 (1978) 263; the
same as Newton's method on min(z, w) = 0), which ends after a few exchanges or is given up.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.elimination import back_substitute, copy, factorise
from lcpstep.lcp.judge import judge, share
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED
from lcpstep.lcp.workspace import (
    ACTIVE,
    BEST,
    BEST_RESIDUAL,
    CHOSEN,
    DX,
    ITERATIONS,
    LEFT,
    ORDER,
    RESIDUAL,
    SIZE,
    SLACK,
    TRIAL,
    X,
)

REFINEMENTS = 3
ROUNDING = 4e-16  # relative error of a row below which there is nothing to refine
UNDECIDED = 1e-9  # the same while the set is still changing
NOISE = 1e-13  # a scaled z this small next to the largest may be rounding
PATIENCE = (
    6  # one in so many of the exchanges granted may pass in a row without fewer indices on the wrong side
)


def exchange_indices(W: Any, b: Any, z: Any, tolerance: float, limit: int, work: Any) -> int:
    """Principal pivoting from the set marked in CHOSEN; every answer is judged. Returns a status.

    The last answer is in z, its residual in report[RESIDUAL]; iterations are added to report[ITERATIONS].
    """
    n = b.shape[0]
    copy(work.vectors[TRIAL], b, n)
    fewest, patience = n + 1, limit // PATIENCE
    for _ in range(limit):
        work.report[ITERATIONS] += 1.0
        if not solve_chosen(W, b, z, tolerance, work):
            return FAILED
        if work.report[RESIDUAL] <= tolerance and clip(W, b, z, work) <= tolerance:
            return SOLVED
        wrong = change_sides(W, z, tolerance, work)
        if work.report[RESIDUAL] <= work.report[BEST_RESIDUAL]:
            keep_best(W, b, z, work)
        if wrong < fewest:
            fewest, patience = wrong, limit // PATIENCE
        elif patience == 0:
            return FAILED
        else:
            patience -= 1
    return MAX_ITERATIONS


def solve_chosen(W: Any, b: Any, z: Any, tolerance: float, work: Any) -> bool:
    """Fill z with the judged answer of the set in CHOSEN, refined if it passes; False if W_aa is singular."""
    n, F = b.shape[0], work.factor
    k = factorise(F, load(W, n, work), work.indices)
    if k < 0:
        return False
    w, change = work.vectors[SLACK], work.vectors[LEFT]
    for i in range(n):
        z[i], w[i] = 0.0, b[i]
    error = 1.0
    for _ in range(1 + REFINEMENTS):
        for p in range(k):
            i = work.indices[ORDER, p]
            change[p] = w[i] * work.vectors[X, i]
        back_substitute(F, change, k)
        for q in range(k):
            j = work.indices[ACTIVE, q]
            z[j] -= change[q] * work.vectors[DX, j]
        work.report[RESIDUAL] = judge(W, b, z, w, work.vectors[SIZE])
        before, error = error, row_error(k, work)
        good_enough = error <= (ROUNDING if work.report[RESIDUAL] <= tolerance else UNDECIDED)
        if good_enough or error > 0.5 * before:
            break
    if work.report[RESIDUAL] > tolerance:
        drop_noise(W, b, z, k, work)
    return True


def drop_noise(W: Any, b: Any, z: Any, k: int, work: Any) -> None:
    """Set z to zero where it is rounding next to the others: a row of such terms alone has no sign.

    Only if the judge finds the answer better for it: a small z may also be what other rows wait for.
    """
    largest, some, kept, before = 0.0, False, work.vectors[LEFT], work.report[RESIDUAL]
    for q in range(k):
        j = work.indices[ACTIVE, q]
        kept[q] = z[j]
        largest = max(largest, abs(z[j]) / work.vectors[DX, j])
    for q in range(k):
        j = work.indices[ACTIVE, q]
        if z[j] != 0.0 and abs(z[j]) <= NOISE * largest * work.vectors[DX, j]:
            z[j], some = 0.0, True
    if not some:
        return
    work.report[RESIDUAL] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
    if work.report[RESIDUAL] >= before:
        for q in range(k):
            z[work.indices[ACTIVE, q]] = kept[q]
        work.report[RESIDUAL] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])


def load(W: Any, n: int, work: Any) -> int:
    """Copy the submatrix of the set, scaled by X in rows and DX in columns; returns its size."""
    F, active, r, c = work.factor, work.indices[ACTIVE], work.vectors[X], work.vectors[DX]
    k = list_chosen(n, work)
    for p in range(k):
        c[active[p]] = 0.0
    for p in range(k):
        i, largest = active[p], 0.0
        for q in range(k):
            F[p, q] = W[i, active[q]]
            largest = max(largest, abs(F[p, q]))
        r[i] = 1.0 / largest if largest > 0.0 else 1.0
        for q in range(k):
            F[p, q] *= r[i]
            c[active[q]] = max(c[active[q]], abs(F[p, q]))
    for q in range(k):
        c[active[q]] = 1.0 / c[active[q]] if c[active[q]] > 0.0 else 1.0
    for p in range(k):
        for q in range(k):
            F[p, q] *= c[active[q]]
    return k


def list_chosen(n: int, work: Any) -> int:
    """List the set in ACTIVE and ORDER; returns its size.

    The indices with the lowest w come first (TRIAL holds w of the last answer, relative), so that of two
    dependent ones the violated one is kept.
    """
    active, order, w, k = work.indices[ACTIVE], work.indices[ORDER], work.vectors[TRIAL], 0
    for i in range(n):
        if work.indices[CHOSEN, i]:
            place = k
            while place > 0 and w[i] < w[active[place - 1]]:
                active[place] = active[place - 1]
                place -= 1
            active[place] = i
            k += 1
    for p in range(k):
        order[p] = active[p]
    return k


def row_error(k: int, work: Any) -> float:
    """Largest |w|, relative to the size of its terms, where it should be zero."""
    error = 0.0
    for p in range(k):
        i = work.indices[ACTIVE, p]
        if work.vectors[SIZE, i] > 0.0:
            error = max(error, abs(work.vectors[SLACK, i]) / work.vectors[SIZE, i])
    return error


def change_sides(W: Any, z: Any, tolerance: float, work: Any) -> int:
    """Indices with negative z leave the set, those with negative w enter it; returns how many did."""
    w, size, relative, wrong = work.vectors[SLACK], work.vectors[SIZE], work.vectors[TRIAL], 0
    for i in range(z.shape[0]):
        relative[i] = 0.0
        if work.indices[CHOSEN, i]:
            if z[i] < 0.0 and share(W, z, size, i) > tolerance:
                work.indices[CHOSEN, i] = 0
                wrong += 1
        elif w[i] < -tolerance * size[i]:
            work.indices[CHOSEN, i] = 1
            relative[i] = w[i] / size[i]
            wrong += 1
    return wrong


def clip(W: Any, b: Any, z: Any, work: Any) -> float:
    """Cut what rounding left of negative z and, if there was any, judge the rest; returns the residual."""
    cut = False
    for i in range(z.shape[0]):
        if z[i] < 0.0:
            z[i], cut = 0.0, True
    if cut:
        work.report[RESIDUAL] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
    return float(work.report[RESIDUAL])


def keep_best(W: Any, b: Any, z: Any, work: Any) -> None:
    """Remember an answer that is no worse than the best so far, its negative z cut."""
    n, best = z.shape[0], work.vectors[BEST]
    for i in range(n):
        work.vectors[LEFT, i], z[i] = z[i], max(z[i], 0.0)
    found = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
    if found <= work.report[BEST_RESIDUAL]:
        work.report[BEST_RESIDUAL] = found
        copy(best, z, n)
    copy(z, work.vectors[LEFT], n)
