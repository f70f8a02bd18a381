"""Every complementary basis in turn, for tiny problems: it finds a solution whenever a basis has one.

The 2^n sets of positive z are tried in the order of binary counting; each answer is refined and judged.

A singular W may have solutions of which none belongs to a basis: W = [[0, 2], [0, 0]], b = (-2, 0) has z_2 = 1, and
W_22 = 0. The solutions with z > 0 at most in a set and w = 0 there are a polyhedron without a line, so that it has a
vertex if it is not empty: columns S of positive z and as many rows T with w = 0 and W_TS not singular. All pairs of S
and T are tried: (2n)!/(n!)^2.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.elimination import back_substitute, factorise
from lcpstep.lcp.judge import judge
from lcpstep.lcp.principal import clip, solve_chosen
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, max

TINY = 8  # unknowns up to which vertices are few enough


def enumerate_bases(
    W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, limit: int, work: Workspace
) -> int:
    """Try at most `limit` bases: SOLVED by one of them, FAILED by all, or MAX_ITERATIONS."""
    for i in range(n):
        work.trial[i] = 0.0
    for subset in range(1 << n):
        if subset >= limit:
            return MAX_ITERATIONS
        for i in range(n):
            work.chosen[i] = (subset >> i) & 1
        work.iterations += 1
        if (
            solve_chosen(W, b, z, n, tolerance, work)
            and work.residual <= tolerance
            and clip(W, b, z, n, work) <= tolerance
        ):
            return SOLVED
    return FAILED


def enumerate_vertices(W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, work: Workspace) -> int:
    """Try every pair of a set of z and a set of rows of one size: SOLVED by one of them, or FAILED by all."""
    for columns in range(1, 1 << n):
        for rows in range(1, 1 << n):
            if rows != columns and size_of(rows) == size_of(columns):
                work.iterations += 1
                if solve_pair(W, b, z, n, rows, columns, work):
                    work.residual = judge(W, b, z, n, work.slack, work.size)
                    if work.residual <= tolerance:
                        return SOLVED
    return FAILED


def size_of(subset: int) -> int:
    """Number of elements."""
    k = 0
    while subset > 0:
        k += subset & 1
        subset >>= 1
    return k


def solve_pair(W: Doubles, b: Doubles, z: Doubles, n: int, rows: int, columns: int, work: Workspace) -> bool:
    """The z of these columns that are zero in these rows of W z + b; False where it has none that is positive."""
    F, y, scale, k, p = work.factor, work.left, work.x, 0, 0
    for j in range(n):
        z[j] = 0.0
        if (columns >> j) & 1:
            work.active[k] = j
            k += 1
    for i in range(n):
        if (rows >> i) & 1:
            largest = 0.0
            for q in range(k):
                largest = max(largest, abs(W[i * n + work.active[q]]))
            if not largest > 0.0:
                return False
            for q in range(k):
                F[p * n + q] = W[i * n + work.active[q]] / largest
            work.order[p], scale[i] = i, largest
            p += 1
    if factorise(F, k, n, work) != k:
        return False
    for p in range(k):
        y[p] = -b[work.order[p]] / scale[work.order[p]]
    back_substitute(F, y, k, n)
    for q in range(k):
        if not y[q] > 0.0:
            return False
        z[work.active[q]] = y[q]
    return True
