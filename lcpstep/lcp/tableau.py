"""Lemke's method on a tableau: the fast attempt, whose answer is refined and judged.

The tableau holds the basic variables y in terms of the other ones, x: at first w in terms of z and the
covering variable,

    y_i = q_i + sum_c T_ci x_c.

Only the columns of x are kept, each in one piece; a pivot changes all of them by a multiple of the entering
one. In large problems a column is changed when it is asked for, as it enters or breaks a tie, four changes at a
time: many never are, and a change takes nothing of a column that is zero in the row of its pivot. Rounding gathers
in T, so the answer is corrected with the inverse that T contains until W z + b is right to rounding; if the judge
refuses it all the same, `kernel` starts again with fresh factors.
Rules of the path, numbers of the variables and sources: see `lemke`.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.judge import judge
from lcpstep.lcp.status import MAX_ITERATIONS, RAY, SOLVED
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, after, indices_after, inf, max, min
from lcpstep.rows import add_four, copy, excesses, largest_entry, lowest_entry, multiply, ratios, subtract

SMALLEST_PIVOT = 1e-11  # relative to the largest entry of its column
TIE = 1e-13  # values this close, relative to the largest basic value, reach zero together
ROUNDING = 1e-15  # relative error of a row of W z + b below which there is nothing to correct
CORRECTIONS = 3
MOST = 2  # changes per unknown that are put off
CACHED = 32  # changes made in all columns before the next: they stay in the processor's caches
LARGE = 40  # unknowns from which putting changes off pays
NOTHING = -1


def pivot_tableau(n: int, max_pivots: int, work: Workspace) -> int:
    """Pivot from z = 0 on the scaled problem in the work arrays to a complementary basis; returns a status."""
    basic, nonbasic, place = work.basic, work.nonbasic, work.place
    for i in range(n):
        basic[i], nonbasic[i], work.columns[n * n + i] = n + 1 + i, i, 1.0
        place[i], place[n + 1 + i], work.made[i] = i, NOTHING, 0
    nonbasic[n], place[n], work.made[n], work.waiting = n, n, 0, 0
    s, p, most = n, last_lowest(work.scaled_b, n), MOST * n if n >= LARGE else 1
    for _ in range(max_pivots):
        entering, leaving = nonbasic[s], basic[p]
        advance(p, s, n, work)
        basic[p], nonbasic[s], place[entering], place[leaving] = entering, leaving, NOTHING, s
        if work.waiting == most:
            change_all(n, work)
        work.iterations += 1
        if leaving == n:
            return SOLVED
        s = place[leaving + n + 1 if leaving < n else leaving - n - 1]
        bring_up_to_date(s, work.waiting, n, work)
        tied = list_ties(s, n, work)
        if tied == 0:
            return RAY
        p = first_of_ties(tied, s, n, work)
    return MAX_ITERATIONS


def last_lowest(q: Doubles, n: int) -> int:
    """The row that the covering variable, falling from infinity, brings to zero first; the last of equal ones."""
    p = 0
    for i in range(n):
        if q[i] <= q[p]:
            p = i
    return p


def advance(p: int, s: int, n: int, work: Workspace) -> None:
    """Exchange row p and column s, which is up to date; the change of the other columns is put on the list."""
    column, q, k = after(work.columns, s * n), work.scaled_b, work.waiting
    change = after(work.changes, k * n)
    copy(change, column, n)
    reciprocal = 1.0 / change[p]
    theta = max(-q[p] * reciprocal, 0.0)
    subtract(q, change, -theta, n)
    q[p], change[p] = theta, 0.0
    multiply(column, reciprocal, n)
    column[p] = reciprocal
    work.row[k], work.reciprocal[k], work.made[s], work.waiting = p, reciprocal, k + 1, k + 1


def bring_up_to_date(s: int, until: int, n: int, work: Workspace) -> None:
    """Make the changes before `until` in column s that have not been made there."""
    if work.made[s] < until:
        make_all(after(work.columns, s * n), work.made[s], until, n, work)
        work.made[s] = until


def make_all(column: Doubles, k: int, until: int, n: int, work: Workspace) -> None:
    """Make the changes from k on before `until` in a column."""
    while k + 4 <= until:
        make_four(column, k, n, work)
        k += 4
    while k < until:
        make(column, k, n, work)
        k += 1


def make(column: Doubles, k: int, n: int, work: Workspace) -> None:
    """Make change k in a column."""
    p = work.row[k]
    share = -column[p] * work.reciprocal[k]
    if share != 0.0:
        subtract(column, after(work.changes, k * n), -share, n)
    column[p] = share


def make_four(column: Doubles, k: int, n: int, work: Workspace) -> None:
    """Make changes k to k + 3; what each takes of the column is known from its entries in their rows alone."""
    share, row, some = work.trial, indices_after(work.row, k), False
    for i in range(4):
        value = column[row[i]]
        for j in range(i):
            if row[j] == row[i]:
                value = share[j]
            else:
                value += share[j] * work.changes[(k + j) * n + row[i]]
        share[i] = -value * work.reciprocal[k + i]
        some = some or share[i] != 0.0
    if some:
        add_four(column, after(work.changes, k * n), n, share, 1, n)
    for i in range(4):
        value = share[i]
        for j in range(i + 1, 4):
            value += share[j] * work.changes[(k + j) * n + row[i]]
        column[row[i]] = value


def change_all(n: int, work: Workspace) -> None:
    """Make all changes in all columns, so many at a time as stay in the processor's caches."""
    until = 0
    while until < work.waiting:
        until = until + CACHED if until + CACHED < work.waiting else work.waiting
        for c in range(n + 1):
            bring_up_to_date(c, until, n, work)
    for c in range(n + 1):
        work.made[c] = 0
    work.waiting = 0


def list_ties(s: int, n: int, work: Workspace) -> int:
    """List in `tied` the rows that bound the entering variable of column s, the covering one alone if it does."""
    q, d, rows, trial = work.scaled_b, after(work.columns, s * n), work.tied, work.trial
    smallest = SMALLEST_PIVOT * max(1.0, largest_entry(d, n))
    slack = TIE * largest_entry(q, n)
    ratios(trial, q, slack, d, smallest, n)
    bound, tied = lowest_entry(trial, n), 0
    excesses(trial, q, bound, d, smallest, n)
    i = 0
    while i < n:
        if i + 4 <= n and min(min(trial[i], trial[i + 1]), min(trial[i + 2], trial[i + 3])) > 0.0:
            i += 4  # four that bound nothing, as most
            continue
        if trial[i] <= 0.0:
            if work.basic[i] == n:
                rows[0] = i
                return 1
            rows[tied] = i
            tied += 1
        i += 1
    return tied


def first_of_ties(tied: int, s: int, n: int, work: Workspace) -> int:
    """Of the tied rows the one that is lowest lexicographically."""
    rows, j = work.tied, 0
    while tied > 1 and j < n:
        c = work.place[n + 1 + j]
        if c == NOTHING:
            tied = leave_out(n + 1 + j, tied, work)
        else:
            tied = keep_lowest(c, tied, s, n, work)
        j += 1
    return rows[0]


def leave_out(variable: int, tied: int, work: Workspace) -> int:
    """Take the row of a basic w_j off the list of ties: b_j moves it up, and none of the others."""
    rows, kept = work.tied, 0
    for t in range(tied):
        if work.basic[rows[t]] != variable:
            rows[kept] = rows[t]
            kept += 1
    return kept


def keep_lowest(c: int, tied: int, s: int, n: int, work: Workspace) -> int:
    """Keep of the ties those that b_j moves least: its coefficient over the pivot; w_j is that of column c."""
    rows, lowest, kept = work.tied, inf, 0
    bring_up_to_date(c, work.waiting, n, work)
    for t in range(tied):
        i = rows[t]
        value = work.columns[c * n + i] / work.columns[s * n + i]
        if value < lowest - TIE * max(1.0, abs(value)):
            lowest, kept = value, 0
        if value <= lowest + TIE * max(1.0, abs(value)):
            rows[kept] = i
            kept += 1
    return kept


def correct(W: Doubles, b: Doubles, z: Doubles, n: int, tolerance: float, work: Workspace) -> float:
    """Fill z with the answer of the tableau, corrected until its rows are right to rounding; its residual."""
    q, w, s = work.scaled_b, work.slack, work.size
    before, residual = inf, inf
    for _ in range(1 + CORRECTIONS):
        read_off(q, 0.0, z, n, work)
        residual, error = judge(W, b, z, n, w, s), row_error(n, work)
        if error <= ROUNDING or error > 0.5 * before:
            break
        before = error
        subtract_errors(q, w, n, work)
    if residual > tolerance:  # what should be zero may be rounding: it has no sign
        read_off(q, TIE, z, n, work)
        residual = judge(W, b, z, n, w, s)
    work.residual = residual
    return residual


def subtract_errors(q: Doubles, w: Doubles, n: int, work: Workspace) -> None:
    """Subtract from q what the nonbasic w, which should be zero, have added to it: the sum of T_c w_c.

    Of columns that are not up to date the sum is, change by change, as far as each of them is.
    """
    total, first, next_one, done = work.x, work.z_place, work.w_place, 0
    for i in range(n):
        total[i] = 0.0
    list_by_changes(n, work)
    for k in range(work.waiting + 1):
        c = first[k]
        if c != NOTHING or k == work.waiting:
            make_all(total, done, k, n, work)
            done = k
        while c != NOTHING:
            i = work.nonbasic[c] - n - 1
            subtract(total, after(work.columns, c * n), -w[i] * work.row_scale[i], n)
            c = next_one[c]
    subtract(q, total, 1.0, n)


def list_by_changes(n: int, work: Workspace) -> None:
    """Chain columns of nonbasic w that have as many changes made in them: `z_place` begins, `w_place` goes on."""
    for k in range(work.waiting + 1):
        work.z_place[k] = NOTHING
    for c in range(n, -1, -1):
        if work.nonbasic[c] > n:
            work.w_place[c] = work.z_place[work.made[c]]
            work.z_place[work.made[c]] = c


def read_off(q: Doubles, least: float, z: Doubles, n: int, work: Workspace) -> None:
    """Fill z with the basic values, zero where they are not above `least` of the largest."""
    basic, largest = work.basic, 0.0
    for i in range(n):
        z[i] = 0.0
        if basic[i] < n:
            largest = max(largest, q[i])
    for i in range(n):
        if basic[i] < n and q[i] > least * largest:
            z[basic[i]] = q[i] * work.column_scale[basic[i]]


def row_error(n: int, work: Workspace) -> float:
    """Largest |w|, relative to the size of its terms, where it should be zero."""
    error, w, size = 0.0, work.slack, work.size
    for i in range(n):
        if work.place[n + 1 + i] != NOTHING and size[i] > 0.0:
            error = max(error, abs(w[i]) / size[i])
    return error


def mark_basis(n: int, work: Workspace) -> None:
    """Mark the basic z in `chosen`."""
    for j in range(n):
        work.chosen[j] = 1 if work.place[j] == NOTHING else 0
