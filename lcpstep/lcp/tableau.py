"""Lemke's method on a tableau: the fast attempt, whose answer is refined and judged.

The tableau holds the basic variables y in terms of the other ones, x: at first w in terms of z and the
covering variable,

    y_i = q_i + sum_c T_ci x_c.

Only the columns of x are kept, each in one piece; a pivot changes all of them by a multiple of the entering
one. These changes are put off and made several at a time, so that the tableau passes through the processor's
caches less often. Rounding gathers in T, so the answer is corrected with the inverse that T contains until
W z + b is right to rounding; if the judge refuses it all the same, `kernel` starts again with fresh factors.
Rules of the path, numbers of the variables and sources: see `lemke`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.compiled import inline
from lcpstep.lcp.elimination import copy, subtract
from lcpstep.lcp.judge import judge
from lcpstep.lcp.status import MAX_ITERATIONS, RAY, SOLVED
from lcpstep.lcp.workspace import (
    BASIC,
    CHANGES,
    CHOSEN,
    COLUMN_SCALE,
    ITERATIONS,
    NONBASIC,
    PLACE,
    RESIDUAL,
    ROW_SCALE,
    SCALED_B,
    SHARES,
    SIZE,
    SLACK,
    TIED,
    TRIAL,
)

SMALLEST_PIVOT = 1e-11  # relative to the largest entry of its column
TIE = 1e-13  # values this close, relative to the largest basic value, reach zero together
ROUNDING = 1e-15  # relative error of a row of W z + b below which there is nothing to correct
CORRECTIONS = 3
TOGETHER = 4  # changes made at a time
LARGE = 40  # unknowns from which putting changes off pays
NOTHING = -1


def pivot_tableau(n: int, max_pivots: int, work: Any) -> int:
    """Pivot from z = 0 on the scaled problem in the work arrays to a complementary basis; returns a status."""
    basic, nonbasic, place = work.indices[BASIC], work.indices[NONBASIC], work.indices[PLACE]
    for i in range(n):
        basic[i], nonbasic[i], work.columns[n, i] = n + 1 + i, i, 1.0
        place[i], place[n + 1 + i] = i, NOTHING
    nonbasic[n], place[n] = n, n
    s, p, waiting, together = n, last_lowest(work.vectors[SCALED_B], n), 0, TOGETHER if n >= LARGE else 1
    for _ in range(max_pivots):
        entering, leaving = nonbasic[s], basic[p]
        advance(p, s, waiting, n, work)
        basic[p], nonbasic[s], place[entering], place[leaving] = entering, leaving, NOTHING, s
        waiting += 1
        if waiting == together or leaving == n:
            waiting = change_all(waiting, n, work)
        work.report[ITERATIONS] += 1.0
        if leaving == n:
            return SOLVED
        s = place[leaving + n + 1 if leaving < n else leaving - n - 1]
        bring_up_to_date(s, waiting, n, work)
        tied = list_ties(s, n, work)
        if tied == 0:
            return RAY
        p = first_of_ties(tied, s, waiting, n, work)
    return MAX_ITERATIONS


def last_lowest(q: Any, n: int) -> int:
    """The row that the covering variable, falling from infinity, brings to zero first; the last of equal ones."""
    p = 0
    for i in range(n):
        if q[i] <= q[p]:
            p = i
    return p


@inline
def bring_up_to_date(s: int, waiting: int, n: int, work: Any) -> None:
    """Make the waiting changes in one column."""
    for k in range(waiting):
        subtract(work.columns[s], work.vectors[CHANGES + k], -work.vectors[SHARES + k, s], n)
        work.vectors[SHARES + k, s] = 0.0


@inline
def advance(p: int, s: int, waiting: int, n: int, work: Any) -> None:
    """Exchange row p and column s, which is up to date; the change of the other columns is put on the list."""
    T, q = work.columns, work.vectors[SCALED_B]
    change, shares = work.vectors[CHANGES + waiting], work.vectors[SHARES + waiting]
    copy(change, T[s], n)
    reciprocal = 1.0 / change[p]
    for c in range(n + 1):
        shares[c] = T[c, p]
    for k in range(waiting):
        subtract(shares, work.vectors[SHARES + k], -work.vectors[CHANGES + k, p], n + 1)
    for c in range(n + 1):
        shares[c] *= -reciprocal
    theta = max(-q[p] * reciprocal, 0.0)
    subtract(q, change, -theta, n)
    q[p] = theta
    for k in range(waiting + 1):
        work.vectors[CHANGES + k, p] = 0.0
    for c in range(n + 1):
        T[c, p] = shares[c]
    for i in range(n):
        T[s, i] = change[i] * reciprocal
    shares[s], T[s, p] = 0.0, reciprocal


@inline
def change_all(waiting: int, n: int, work: Any) -> int:
    """Make the waiting changes in all columns; returns how many are left: none."""
    T, change = work.columns, work.vectors[CHANGES : CHANGES + TOGETHER]
    share = work.vectors[SHARES : SHARES + TOGETHER]
    for c in range(n + 1):
        if waiting == TOGETHER:
            change_column(T[c], change, share[0, c], share[1, c], share[2, c], share[3, c], n)
        else:
            for k in range(waiting):
                if share[k, c] != 0.0:
                    subtract(T[c], change[k], -share[k, c], n)
    return 0


def change_column(column: Any, change: Any, d: float, e: float, f: float, g: float, n: int) -> None:
    """Four changes of one column."""
    if d == 0.0 and e == 0.0 and f == 0.0 and g == 0.0:
        return
    t, u, v, w = change[0], change[1], change[2], change[3]
    for i in range(n):
        column[i] += (d * t[i] + e * u[i]) + (f * v[i] + g * w[i])


@inline
def list_ties(s: int, n: int, work: Any) -> int:
    """List in TIED the rows that bound the entering variable of column s, the covering one alone if it does."""
    q, d, rows, growth = work.vectors[SCALED_B], work.columns[s], work.indices[TIED], work.vectors[TRIAL]
    smallest = SMALLEST_PIVOT * max(1.0, largest_entry(d, n))
    slack = TIE * largest_entry(q, n)
    for i in range(n):  # without branches: several rows at a time
        growth[i] = (max(q[i], 0.0) + slack) / -d[i] if -d[i] > smallest else np.inf
    bound, tied = lowest_entry(growth, n), 0
    for i in range(n):
        if (-d[i] > smallest) & (q[i] <= -bound * d[i]):
            if work.indices[BASIC, i] == n:
                rows[0] = i
                return 1
            rows[tied] = i
            tied += 1
    return tied


def first_of_ties(tied: int, s: int, waiting: int, n: int, work: Any) -> int:
    """Of the tied rows the one that is lowest lexicographically."""
    rows, j = work.indices[TIED], 0
    while tied > 1 and j < n:
        c = work.indices[PLACE, n + 1 + j]
        if c == NOTHING:
            tied = leave_out(n + 1 + j, tied, work)
        else:
            tied = keep_lowest(c, tied, s, waiting, work)
        j += 1
    return rows[0]


def leave_out(variable: int, tied: int, work: Any) -> int:
    """Take the row of a basic w_j off the list of ties: b_j moves it up, and none of the others."""
    rows, kept = work.indices[TIED], 0
    for t in range(tied):
        if work.indices[BASIC, rows[t]] != variable:
            rows[kept] = rows[t]
            kept += 1
    return kept


def keep_lowest(c: int, tied: int, s: int, waiting: int, work: Any) -> int:
    """Keep of the ties those that b_j moves least: its coefficient over the pivot; w_j is that of column c."""
    rows, lowest, kept = work.indices[TIED], np.inf, 0
    for t in range(tied):
        i = rows[t]
        value = work.columns[c, i]
        for k in range(waiting):
            value += work.vectors[SHARES + k, c] * work.vectors[CHANGES + k, i]
        value /= work.columns[s, i]
        if value < lowest - TIE * max(1.0, abs(value)):
            lowest, kept = value, 0
        if value <= lowest + TIE * max(1.0, abs(value)):
            rows[kept] = i
            kept += 1
    return kept


def largest_entry(x: Any, n: int) -> float:
    """Largest |x_i| for i < n, in four parts that the processor can overlap."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = n - n % 4
    for i in range(0, whole, 4):
        a, b = max(a, abs(x[i])), max(b, abs(x[i + 1]))
        c, d = max(c, abs(x[i + 2])), max(d, abs(x[i + 3]))
    for i in range(whole, n):
        a = max(a, abs(x[i]))
    return max(max(a, b), max(c, d))


def lowest_entry(x: Any, n: int) -> float:
    """Lowest x_i for i < n, in four parts as well."""
    a, b, c, d = np.inf, np.inf, np.inf, np.inf
    whole = n - n % 4
    for i in range(0, whole, 4):
        a, b, c, d = min(a, x[i]), min(b, x[i + 1]), min(c, x[i + 2]), min(d, x[i + 3])
    for i in range(whole, n):
        a = min(a, x[i])
    return min(min(a, b), min(c, d))


def correct(W: Any, b: Any, z: Any, tolerance: float, work: Any) -> float:
    """Fill z with the answer of the tableau, corrected until its rows are right to rounding; its residual."""
    n, q, w, s = b.shape[0], work.vectors[SCALED_B], work.vectors[SLACK], work.vectors[SIZE]
    before, residual = np.inf, np.inf
    for _ in range(1 + CORRECTIONS):
        read_off(q, 0.0, z, work)
        residual, error = judge(W, b, z, w, s), row_error(n, work)
        if error <= ROUNDING or error > 0.5 * before:
            break
        before = error
        for c in range(n + 1):
            i = work.indices[NONBASIC, c] - n - 1
            if i >= 0:
                subtract(q, work.columns[c], w[i] * work.vectors[ROW_SCALE, i], n)
    if residual > tolerance:  # what should be zero may be rounding: it has no sign
        read_off(q, TIE, z, work)
        residual = judge(W, b, z, w, s)
    work.report[RESIDUAL] = residual
    return residual


def read_off(q: Any, least: float, z: Any, work: Any) -> None:
    """Fill z with the basic values, zero where they are not above `least` of the largest."""
    n, basic, largest = z.shape[0], work.indices[BASIC], 0.0
    for i in range(n):
        z[i] = 0.0
        if basic[i] < n:
            largest = max(largest, q[i])
    for i in range(n):
        if basic[i] < n and q[i] > least * largest:
            z[basic[i]] = q[i] * work.vectors[COLUMN_SCALE, basic[i]]


def row_error(n: int, work: Any) -> float:
    """Largest |w|, relative to the size of its terms, where it should be zero."""
    error, w, size = 0.0, work.vectors[SLACK], work.vectors[SIZE]
    for i in range(n):
        if work.indices[PLACE, n + 1 + i] != NOTHING and size[i] > 0.0:
            error = max(error, abs(w[i]) / size[i])
    return error


def mark_basis(n: int, work: Any) -> None:
    """Mark the basic z in CHOSEN."""
    for j in range(n):
        work.indices[CHOSEN, j] = 1 if work.indices[PLACE, j] == NOTHING else 0
