"""Complementary bases: given which z may be positive, the answer is a linear system.

With the index set a, z_a = -W_aa^-1 b_a and z = 0 elsewhere. The factors are fresh (LU) and the answer is
refined against W itself, so it is as accurate as the conditioning of W_aa allows, however the set was found.
Indices whose column depends on the others (a contact given twice) are left out of the set. Where z or w comes
out negative the indices change sides, all at once (M. M. Kostreva, Linear Algebra Appl. 21 (1978) 263; the
same as Newton's method on min(z, w) = 0), which ends after a few exchanges or is given up.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.elimination import back_substitute, factorise
from lcpstep.lcp.judge import judge, share
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, inf, max
from lcpstep.rows import copy

REFINEMENTS = 3
ROUNDING = 4e-16  # relative error of a row below which there is nothing to refine
UNDECIDED = 1e-9  # the same while the set is still changing
NOISE = 1e-13  # a scaled z this small next to the largest may be rounding
PATIENCE = 6  # one in so many of the exchanges granted may pass in a row without fewer on the wrong side


def exchange_indices(
    W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, limit: int, work: Workspace
) -> int:
    """Principal pivoting from the set marked in `chosen`; every answer is judged. Returns a status.

    The last answer is in z, its residual in `residual`; iterations are added to `iterations`.
    """
    copy(work.trial, b, n)
    fewest, patience = n + 1, limit // PATIENCE
    for _ in range(limit):
        work.iterations += 1
        if not solve_chosen(W, b, z, n, tolerance, work):
            return FAILED
        if work.residual <= tolerance and clip(W, b, z, n, work) <= tolerance:
            return SOLVED
        wrong = change_sides(W, z, n, tolerance, work)
        if work.residual <= work.best_residual:
            keep_best(W, b, z, n, work)
        if wrong < fewest:
            fewest, patience = wrong, limit // PATIENCE
        elif patience == 0:
            return FAILED
        else:
            patience -= 1
    return MAX_ITERATIONS


def solve_chosen(W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, work: Workspace) -> bool:
    """Fill z with the judged answer of the set in `chosen`, refined if it passes; False if W_aa is singular."""
    F = work.factor
    k = factorise(F, load(W, n, work), n, work)
    if k < 0:
        return False
    w, change = work.slack, work.left
    for i in range(n):
        z[i], w[i] = 0.0, b[i]
    error = inf  # a first answer is refined even where a row of it is rounding alone, of relative error 1
    for _ in range(1 + REFINEMENTS):
        for p in range(k):
            i = work.order[p]
            change[p] = w[i] * work.x[i]
        back_substitute(F, change, k, n)
        for q in range(k):
            j = work.active[q]
            z[j] -= change[q] * work.dx[j]
        work.residual = judge(W, b, z, n, w, work.size)
        before, error = error, row_error(k, work)
        good_enough = error <= (ROUNDING if work.residual <= tolerance else UNDECIDED)
        if good_enough or error > 0.5 * before:
            break
    if work.residual > tolerance:
        drop_noise(W, b, z, n, k, work)
    return True


def drop_noise(W: Doubles, b: Doubles, z: Doubles, n: int, k: int, work: Workspace) -> None:
    """Set z to zero where it is rounding next to the others: a row of such terms alone has no sign.

    Only if the judge finds the answer better for it: a small z may also be what other rows wait for.
    """
    largest, some, kept, before = 0.0, False, work.left, work.residual
    for q in range(k):
        j = work.active[q]
        kept[q] = z[j]
        largest = max(largest, abs(z[j]) / work.dx[j])
    for q in range(k):
        j = work.active[q]
        if z[j] != 0.0 and abs(z[j]) <= NOISE * largest * work.dx[j]:
            z[j], some = 0.0, True
    if not some:
        return
    work.residual = judge(W, b, z, n, work.slack, work.size)
    if work.residual >= before:
        for q in range(k):
            z[work.active[q]] = kept[q]
        work.residual = judge(W, b, z, n, work.slack, work.size)


def load(W: Doubles, n: int, work: Workspace) -> int:
    """Copy the submatrix of the set, scaled by `x` in rows and `dx` in columns; returns its size."""
    F, active, r, c = work.factor, work.active, work.x, work.dx
    k = list_chosen(n, work)
    for p in range(k):
        c[active[p]] = 0.0
    for p in range(k):
        i, largest = active[p], 0.0
        for q in range(k):
            F[p * n + q] = W[i * n + active[q]]
            largest = max(largest, abs(F[p * n + q]))
        r[i] = 1.0 / largest if largest > 0.0 else 1.0
        for q in range(k):
            F[p * n + q] *= r[i]
            c[active[q]] = max(c[active[q]], abs(F[p * n + q]))
    for q in range(k):
        c[active[q]] = 1.0 / c[active[q]] if c[active[q]] > 0.0 else 1.0
    for p in range(k):
        for q in range(k):
            F[p * n + q] *= c[active[q]]
    return k


def list_chosen(n: int, work: Workspace) -> int:
    """List the set in `active` and `order`; returns its size.

    The indices with the lowest w come first (`trial` holds w of the last answer, relative), so that of two
    dependent ones the violated one is kept.
    """
    active, order, w, k = work.active, work.order, work.trial, 0
    for i in range(n):
        if work.chosen[i]:
            place = k
            while place > 0 and w[i] < w[active[place - 1]]:
                active[place] = active[place - 1]
                place -= 1
            active[place] = i
            k += 1
    for p in range(k):
        order[p] = active[p]
    return k


def row_error(k: int, work: Workspace) -> float:
    """Largest |w|, relative to the size of its terms, where it should be zero."""
    error = 0.0
    for p in range(k):
        i = work.active[p]
        if work.size[i] > 0.0:
            error = max(error, abs(work.slack[i]) / work.size[i])
    return error


def change_sides(W: Doubles, z: Doubles, n: int, tolerance: float, work: Workspace) -> int:
    """Indices with negative z leave the set, those with negative w enter it; returns how many did."""
    w, size, relative, wrong = work.slack, work.size, work.trial, 0
    for i in range(n):
        relative[i] = 0.0
        if work.chosen[i]:
            if z[i] < 0.0 and share(W, z, n, size, i) > tolerance:
                work.chosen[i] = 0
                wrong += 1
        elif w[i] < -tolerance * size[i]:
            work.chosen[i] = 1
            relative[i] = w[i] / size[i]
            wrong += 1
    return wrong


def clip(W: Doubles, b: Doubles, z: Doubles, n: int, work: Workspace) -> float:
    """Cut what rounding left of negative z and, if there was any, judge the rest; returns the residual."""
    cut = False
    for i in range(n):
        if z[i] < 0.0:
            z[i], cut = 0.0, True
    if cut:
        work.residual = judge(W, b, z, n, work.slack, work.size)
    return work.residual


def keep_best(W: Doubles, b: Doubles, z: Doubles, n: int, work: Workspace) -> None:
    """Remember an answer that is no worse than the best so far, its negative z cut."""
    best = work.best
    for i in range(n):
        work.left[i], z[i] = z[i], max(z[i], 0.0)
    found = judge(W, b, z, n, work.slack, work.size)
    if found <= work.best_residual:
        work.best_residual = found
        copy(best, z, n)
    copy(z, work.left, n)
