"""Small dense problems, from within compiled code: one status out, nothing allocated.

    status = solve_small(W, b, z, n, work)

z holds a guess (zeros: none) and receives the solution. One unknown has a closed form, two are enumerated;
beyond, principal pivoting starts from the positive z of the guess, or where b is negative if n is small;
where a few exchanges do not end it, Lemke's method finds a basis on a tableau and, where the judge refuses
that answer and exchanges from its basis do not mend it, again in revised form with fresh factors. Every
answer is judged before it is called one, and a problem of a few unknowns is enumerated at last.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles
from lcpstep.lcp.enumeration import TINY, enumerate_bases, enumerate_vertices
from lcpstep.lcp.judge import judge, proves_infeasible
from lcpstep.lcp.lemke import lemke
from lcpstep.lcp.principal import exchange_indices
from lcpstep.lcp.scaling import equilibrate
from lcpstep.lcp.small import solve_closed
from lcpstep.lcp.status import ENOUGH, FAILED, INFEASIBLE, PER_UNKNOWN, RAY, SOLVED, TOLERANCE
from lcpstep.lcp.tableau import correct, mark_basis, pivot_tableau
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, max, min
from lcpstep.rows import copy

FEW = 8  # unknowns up to which exchanges without a guess are faster than Lemke's path
EXCHANGES = 12  # exchanges of indices granted to a guess, and to Lemke's basis if the judge refuses it
LAST_EXCHANGES = 100  # granted to the set of negative b where all else has failed
SPREADING, MOST = 4, 200  # more of them per unknown, for rounding may spread from row to row; at most
STRICT = 1e-13  # residual at which nobody looks for a better answer; one within the tolerance may do at last
ALMOST = 0.1  # of the tolerance: residual at which the path is not gone again for more unknowns than TINY
STARTS, FEWEST_STARTS = 12, 2  # times that Lemke's method is started
STRIDE = 7919  # a prime that scatters them
PER_SQUARE, THOROUGH = 25, 3_000_000_000  # the same of a thorough search, times n^2, and at most this by n^3
PATIENT = 70_000_000_000_000  # or this by n^5: seconds where a search has a chance, up to a hundred unknowns
LONGEST = 10_000_000_000  # pivots times n^2 after which it ends whatever is left: some ten seconds
MULTIPLIER, MODULUS = 48271, 2147483647  # pseudo-random numbers of S. Park and K. Miller, CACM 31 (1988) 1192
SIXTHS = 6  # a start has one to six of them of all z
SMALLEST_PIVOT, LARGER_PIVOT = 1e-11, 1e-8  # relative to the largest entry of a direction, in turn


def solve_small(W: Doubles, b: Doubles, z: Doubles, n: int, work: Workspace) -> int:
    """Solve 0 <= z, W z + b >= 0, z^T (W z + b) = 0 for a small dense W.

    Parameters
    ----------
    W : (n, n), b : (n,) float arrays, C-contiguous; not modified
    z : (n,) in: a guess, zeros if there is none; out: the solution, or the last attempt
    work : Workspace for n unknowns or more; holds the residual and the number of iterations afterwards

    Returns
    -------
    A Status as an int, SOLVED = 0.
    """
    return solve_dense(W, b, z, n, TOLERANCE, ENOUGH + PER_UNKNOWN * n, work)


def solve_dense(
    W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, max_pivots: int, work: Workspace
) -> int:
    """`solve_small` with the judge's tolerance and the limit on pivots."""
    work.residual, work.iterations = 0.0, 0
    if n <= 2:
        work.residual = solve_closed(W, b, z, n, work.slack, work.size, tolerance)
        if work.residual <= tolerance:
            return SOLVED
    if n == 1:
        work.ray_direction[0] = 1.0  # W <= 0 and b < 0: it proves itself
        return INFEASIBLE if b[0] < 0.0 and W[0] <= 0.0 else FAILED
    work.best_residual = tolerance
    strict = min(tolerance, STRICT)
    promising = choose_positive(z, n, work) or not choose_negative(b, n, work) or n <= FEW
    if promising and exchange_indices(W, b, z, n, strict, EXCHANGES, work) == SOLVED:
        return SOLVED
    if pivot_fast(W, b, z, n, strict, max_pivots, work) == SOLVED:
        return SOLVED
    if n > TINY and work.best_residual <= ALMOST * tolerance:
        return conclude(W, b, z, n, tolerance, FAILED, work)
    return pivot_on(W, b, z, n, tolerance, max_pivots, work)


def pivot_fast(
    W: Doubles, b: Doubles, z: Doubles, n: int, strict: float, max_pivots: int, work: Workspace
) -> int:
    """Lemke's method on a tableau; its basis by fresh factors where the judge refuses the answer."""
    equilibrate(W, b, n, work)
    if pivot_tableau(n, max_pivots, work) != SOLVED:
        return FAILED
    if correct(W, b, z, n, strict, work) <= strict:
        return SOLVED
    mark_basis(n, work)
    return exchange_indices(W, b, z, n, strict, EXCHANGES, work)


def pivot_on(
    W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, max_pivots: int, work: Workspace
) -> int:
    """Lemke's method in revised form, from z = 0 and, after a ray or a refused answer, from other bases."""
    strict, status = min(tolerance, STRICT), FAILED
    equilibrate(W, b, n, work)
    for attempt in range(number_of_starts(n, work)):
        choose_start(attempt, n, work)
        smallest = SMALLEST_PIVOT if attempt % 2 == 0 else LARGER_PIVOT
        ended = lemke(n, max_pivots, smallest, attempt == 0, work)
        granted = EXCHANGES
        if attempt == 0:
            granted += SPREADING * n if SPREADING * n < MOST else MOST
        if ended == SOLVED and exchange_indices(W, b, z, n, strict, granted, work) == SOLVED:
            return SOLVED
        if work.best_residual < tolerance or (attempt >= STARTS and work.iterations * n * n > LONGEST):
            break
        if attempt == 0:
            status = ended
            if ended == RAY and proves_infeasible(W, b, work.ray_direction, n):
                status = INFEASIBLE
                break
    return conclude(W, b, z, n, tolerance, status, work)


def conclude(
    W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, status: int, work: Workspace
) -> int:
    """The best answer that passes; or every basis of a few unknowns; or why there is none."""
    open_question = status != INFEASIBLE and not work.best_residual < tolerance
    if open_question and n > TINY:
        if exchange_at_last(W, b, z, n, tolerance, work) == SOLVED:
            return SOLVED
        open_question = not work.best_residual < tolerance
    if open_question and n <= TINY and enumerate_bases(W, b, z, n, tolerance, 1 << n, work) == SOLVED:
        return SOLVED
    if (
        open_question
        and n <= TINY
        and work.thorough
        and enumerate_vertices(W, b, z, n, tolerance, work) == SOLVED
    ):
        return SOLVED
    if work.best_residual < tolerance:
        copy(z, work.best, n)
        status = SOLVED
    elif status in (RAY, INFEASIBLE):
        copy(z, work.ray_start, n)
    else:
        status = FAILED if status == SOLVED else status
        for i in range(n):
            z[i] = max(z[i], 0.0)
    work.residual = judge(W, b, z, n, work.slack, work.size)
    return status


def exchange_at_last(W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, work: Workspace) -> int:
    """Many exchanges, from the set of negative b and from all: they bear numbers of any size in one problem."""
    choose_negative(b, n, work)
    if exchange_indices(W, b, z, n, tolerance, LAST_EXCHANGES, work) == SOLVED:
        return SOLVED
    for i in range(n):
        work.chosen[i] = 1
    return exchange_indices(W, b, z, n, tolerance, LAST_EXCHANGES, work)


def number_of_starts(n: int, work: Workspace) -> int:
    """How often Lemke's method is started, within some seconds; a thorough search goes as far as these allow."""
    affordable, enough = THOROUGH // (n * n * n), STARTS
    if work.thorough and PER_SQUARE * n * n > STARTS:
        enough = PER_SQUARE * n * n
        if PATIENT // (n * n * n * n * n) > affordable:
            affordable = PATIENT // (n * n * n * n * n)
    if affordable < FEWEST_STARTS:
        return FEWEST_STARTS
    return affordable if affordable < enough else enough


def choose_start(attempt: int, n: int, work: Workspace) -> None:
    """The basis to start from: z = 0 twice, then one positive z, with a partner if its diagonal is small."""
    columns, chosen = work.columns, work.chosen
    for i in range(n):
        chosen[i] = 0
    if attempt < 2:
        return
    if attempt >= STARTS:
        number = STRIDE * attempt
        for i in range(n):
            number = (MULTIPLIER * number) % MODULUS
            chosen[i] = 1 if number % SIXTHS < 1 + attempt % SIXTHS else 0
        return
    i = (STRIDE * attempt) % n
    partner = i
    for j in range(n):
        if abs(columns[i * n + j] * columns[j * n + i]) > 4.0 * abs(
            columns[i * n + partner] * columns[partner * n + i]
        ):
            partner = j
    chosen[i] = 1
    chosen[partner] = 1


def choose_positive(z: Doubles, n: int, work: Workspace) -> bool:
    """Mark the positive z of a guess; False if there is none."""
    some = False
    for i in range(n):
        work.chosen[i] = 1 if z[i] > 0.0 else 0
        some = some or z[i] > 0.0
    return some


def choose_negative(b: Doubles, n: int, work: Workspace) -> bool:
    """Mark the indices with b < 0, where w would be negative without z; False if there is none."""
    some = False
    for i in range(n):
        work.chosen[i] = 1 if b[i] < 0.0 else 0
        some = some or b[i] < 0.0
    return some


def solve(W: Any, b: Any, z: Any, work: Workspace) -> int:
    """`solve_small`, called from Python."""
    return solve_small(doubles(W), doubles(b), doubles(z), len(b), work)
