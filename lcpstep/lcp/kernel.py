"""Small dense problems, from within compiled code: one status out, nothing allocated.

    status = solve_small(W, b, z, work)

z holds a guess (zeros: none) and receives the solution. One unknown has a closed form, two are enumerated;
beyond, principal pivoting starts from the positive z of the guess, or where b is negative if n is small;
where a few exchanges do not end it, Lemke's method finds a basis on a tableau and, where the judge refuses
that answer and exchanges from its basis do not mend it, again in revised form with fresh factors. Every
answer is judged before it is called one, and a problem of a few unknowns is enumerated at last.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.elimination import copy
from lcpstep.lcp.enumeration import enumerate_bases
from lcpstep.lcp.judge import judge, proves_infeasible
from lcpstep.lcp.lemke import lemke
from lcpstep.lcp.principal import exchange_indices
from lcpstep.lcp.scaling import equilibrate
from lcpstep.lcp.small import solve_one, solve_two
from lcpstep.lcp.status import FAILED, INFEASIBLE, RAY, SOLVED, TOLERANCE
from lcpstep.lcp.tableau import correct, mark_basis, pivot_tableau
from lcpstep.lcp.workspace import (
    BEST,
    BEST_RESIDUAL,
    CHOSEN,
    ITERATIONS,
    RAY_DIRECTION,
    RAY_START,
    RESIDUAL,
    SIZE,
    SLACK,
    Workspace,
    workspace,
)

__all__ = ["Workspace", "solve_small", "workspace"]

FEW = 8  # unknowns up to which exchanges without a guess are faster than Lemke's path
EXCHANGES = 12  # exchanges of indices granted to a guess, and to Lemke's basis if the judge refuses it
SPREADING = (
    4,
    200,
)  # more of them per unknown, and at most: what is violated by rounding may spread from row to row
STRICT = 1e-13  # residual at which nobody looks for a better answer; one within the tolerance may do at last
ALMOST = 0.1  # of the tolerance: residual at which the path is not gone again for more unknowns than TINY
STARTS = 12  # times that Lemke's method is started
STRIDE = 7919  # a prime that scatters them
SMALLEST_PIVOTS = (1e-11, 1e-8)  # relative to the largest entry of a direction, in turn
TINY = 8  # up to this size every basis is tried at last
ENOUGH = 1000  # pivots granted, and as many more per unknown:
PER_UNKNOWN = 20


def solve_small(W: Any, b: Any, z: Any, work: Any) -> int:
    """Solve 0 <= z, W z + b >= 0, z^T (W z + b) = 0 for a small dense W.

    Parameters
    ----------
    W : (n, n), b : (n,) float arrays, C-contiguous; not modified
    z : (n,) in: a guess, zeros if there is none; out: the solution, or the last attempt
    work : Workspace for n unknowns or more; its report holds the residual and the number of iterations

    Returns
    -------
    A Status as an int, SOLVED = 0.
    """
    n = b.shape[0]
    return solve_dense(W, b, z, TOLERANCE, ENOUGH + PER_UNKNOWN * n, work)


def solve_dense(W: Any, b: Any, z: Any, tolerance: float, max_pivots: int, work: Any) -> int:
    """`solve_small` with the judge's tolerance and the limit on pivots."""
    n = b.shape[0]
    work.report[RESIDUAL] = work.report[ITERATIONS] = 0.0
    if n <= 2:
        work.report[RESIDUAL] = solve_closed(W, b, z, work.vectors[SLACK], work.vectors[SIZE], tolerance)
        if work.report[RESIDUAL] <= tolerance:
            return SOLVED
    if n == 1:
        work.vectors[RAY_DIRECTION, 0] = 1.0  # W <= 0 and b < 0: it proves itself
        return INFEASIBLE if b[0] < 0.0 and W[0, 0] <= 0.0 else FAILED
    work.report[BEST_RESIDUAL] = tolerance
    strict = min(tolerance, STRICT)
    promising = choose_positive(z, work) or not choose_negative(b, work) or n <= FEW
    if promising and exchange_indices(W, b, z, strict, EXCHANGES, work) == SOLVED:
        return SOLVED
    if pivot_fast(W, b, z, strict, max_pivots, work) == SOLVED:
        return SOLVED
    if n > TINY and work.report[BEST_RESIDUAL] <= ALMOST * tolerance:
        return conclude(W, b, z, tolerance, FAILED, work)
    return pivot_on(W, b, z, tolerance, max_pivots, work)


def solve_closed(W: Any, b: Any, z: Any, w: Any, s: Any, tolerance: float) -> float:
    """Residual of the closed form for one or two unknowns; fills z, w and the sizes s of the terms of w."""
    if b.shape[0] == 1:
        return solve_one(W, b, z, w, s)
    return solve_two(W, b, z, w, s, tolerance)


def pivot_fast(W: Any, b: Any, z: Any, strict: float, max_pivots: int, work: Any) -> int:
    """Lemke's method on a tableau; its basis by fresh factors where the judge refuses the answer."""
    n = b.shape[0]
    equilibrate(W, b, work)
    if pivot_tableau(n, max_pivots, work) != SOLVED:
        return FAILED
    if correct(W, b, z, strict, work) <= strict:
        return SOLVED
    mark_basis(n, work)
    return exchange_indices(W, b, z, strict, EXCHANGES, work)


def pivot_on(W: Any, b: Any, z: Any, tolerance: float, max_pivots: int, work: Any) -> int:
    """Lemke's method in revised form, from z = 0 and, after a ray or a refused answer, from other bases."""
    n, strict, status = b.shape[0], min(tolerance, STRICT), FAILED
    equilibrate(W, b, work)
    for attempt in range(STARTS):
        choose_start(attempt, n, work)
        smallest = SMALLEST_PIVOTS[attempt % len(SMALLEST_PIVOTS)]
        ended = lemke(n, max_pivots, smallest, attempt == 0, work)
        granted = EXCHANGES + (min(SPREADING[0] * n, SPREADING[1]) if attempt == 0 else 0)
        if ended == SOLVED and exchange_indices(W, b, z, strict, granted, work) == SOLVED:
            return SOLVED
        if work.report[BEST_RESIDUAL] < tolerance:
            break
        if attempt == 0:
            status = ended
            if ended == RAY and proves_infeasible(W, b, work.vectors[RAY_DIRECTION]):
                status = INFEASIBLE
                break
    return conclude(W, b, z, tolerance, status, work)


def conclude(W: Any, b: Any, z: Any, tolerance: float, status: int, work: Any) -> int:
    """The best answer that passes; or every basis of a few unknowns; or why there is none."""
    n = b.shape[0]
    open_question = status != INFEASIBLE and not work.report[BEST_RESIDUAL] < tolerance
    if open_question and n <= TINY and enumerate_bases(W, b, z, tolerance, 2**n, work) == SOLVED:
        return SOLVED
    if work.report[BEST_RESIDUAL] < tolerance:
        copy(z, work.vectors[BEST], n)
        status = SOLVED
    elif status in (RAY, INFEASIBLE):
        copy(z, work.vectors[RAY_START], n)
    else:
        status = FAILED if status == SOLVED else status
        for i in range(n):
            z[i] = max(z[i], 0.0)
    work.report[RESIDUAL] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
    return status


def choose_start(attempt: int, n: int, work: Any) -> None:
    """The basis to start from: z = 0 twice, then one positive z, with a partner if its diagonal is small."""
    columns, chosen = work.columns, work.indices[CHOSEN]
    for i in range(n):
        chosen[i] = 0
    if attempt < len(SMALLEST_PIVOTS):
        return
    i = (STRIDE * attempt) % n
    partner = i
    for j in range(n):
        if abs(columns[i, j] * columns[j, i]) > 4.0 * abs(columns[i, partner] * columns[partner, i]):
            partner = j
    chosen[i] = chosen[partner] = 1


def choose_positive(z: Any, work: Any) -> bool:
    """Mark the positive z of a guess; False if there is none."""
    some = False
    for i in range(z.shape[0]):
        work.indices[CHOSEN, i] = 1 if z[i] > 0.0 else 0
        some = some or z[i] > 0.0
    return some


def choose_negative(b: Any, work: Any) -> bool:
    """Mark the indices with b < 0, where w would be negative without z; False if there is none."""
    some = False
    for i in range(b.shape[0]):
        work.indices[CHOSEN, i] = 1 if b[i] < 0.0 else 0
        some = some or b[i] < 0.0
    return some
