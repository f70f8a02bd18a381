"""Dense elimination in place, on the leading block of a matrix of n columns, as kernels.

LU factors of a principal submatrix, in which dependent indices are recognised and left out, and the inverse
of Lemke's basis by Gauss and Jordan. LAPACK would cost more than the whole problem at the sizes of a time step.
The matrices come scaled, entries near one.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, after
from lcpstep.rows import add_four, dot, subtract

SINGULAR = 1e-14  # a pivot below this, next to entries of size one, is rounding
TOGETHER, LARGE = 4, 40  # pivots taken off at a time of blocks of so many unknowns or more
PREFERENCE = 0.1  # a diagonal pivot is taken if it has this part of the largest one


def largest_below(F: Doubles, s: int, k: int, n: int) -> int:
    """The row at or below s with the largest entry in column s."""
    row = s
    for p in range(s + 1, k):
        if abs(F[p * n + s]) > abs(F[row * n + s]):
            row = p
    return row


def swap_rows(F: Doubles, i: int, j: int, k: int, n: int) -> None:
    """Interchange two rows of the leading k columns."""
    if i != j:
        for q in range(k):
            F[i * n + q], F[j * n + q] = F[j * n + q], F[i * n + q]


def swap_columns(F: Doubles, i: int, j: int, k: int, n: int) -> None:
    """Interchange two columns of the leading k rows."""
    if i != j:
        for p in range(k):
            F[p * n + i], F[p * n + j] = F[p * n + j], F[p * n + i]


def factorise(F: Doubles, k: int, n: int, work: Workspace) -> int:
    """LU factors of the leading k x k block, rows and columns of which are listed in `order` and `active`.

    An index whose column depends on those before it is left out of the block and of `chosen`. Returns the
    size that remains, or -1 if the row of such an index has been used already. Of a large block four pivots at a
    time are taken off the rows below: until then a column is brought up to date when its turn comes.
    """
    order, s, done, together = work.order, 0, 0, TOGETHER if k >= LARGE else 1
    while s < k:
        for p in range(s, k):
            for q in range(done, s):
                F[p * n + s] -= F[p * n + q] * F[q * n + s]
        row = largest_below(F, s, k, n)
        if not abs(F[row * n + s]) > SINGULAR:
            k = leave_out(F, s, k, n, work)
            if k < 0:
                return k
            continue
        if abs(F[s * n + s]) < PREFERENCE * abs(F[row * n + s]):
            swap_rows(F, s, row, k, n)
            order[s], order[row] = order[row], order[s]
        for q in range(done, s):
            subtract(after(F, s * n + s + 1), after(F, q * n + s + 1), F[s * n + q], k - s - 1)
        reciprocal = 1.0 / F[s * n + s]
        for p in range(s + 1, k):
            F[p * n + s] *= reciprocal
        s += 1
        if s - done == together:
            take_off(F, done, s, k, n, work.left)
            done = s
    return k


def take_off(F: Doubles, done: int, s: int, k: int, n: int, by: Doubles) -> None:
    """Take the pivot rows from `done` on before s, one or four of them, off the rows below."""
    pivots, m = after(F, done * n + s), k - s
    for p in range(s, k):
        some = False
        for q in range(s - done):
            by[q] = -F[p * n + done + q]
            some = some or by[q] != 0.0
        if some and s - done == 1:
            subtract(after(F, p * n + s), pivots, -by[0], m)
        elif some:
            add_four(after(F, p * n + s), pivots, n, by, 1, m)


def leave_out(F: Doubles, s: int, k: int, n: int, work: Workspace) -> int:
    """Move row and column of the dependent index at place s to the end; returns the size without it."""
    order, active, last = work.order, work.active, k - 1
    index, row = active[s], s
    while row < k and order[row] != index:
        row += 1
    if row == k:
        return -1
    swap_columns(F, s, last, k, n)
    swap_rows(F, row, last, k, n)
    active[s], active[last] = active[last], active[s]
    order[row], order[last] = order[last], order[row]
    work.chosen[index] = 0
    return last


def back_substitute(F: Doubles, y: Doubles, k: int, n: int) -> None:
    """Replace the right-hand side y, in the order of the rows, by the solution of the factorised system."""
    for p in range(1, k):
        y[p] -= dot(after(F, p * n), y, p)
    for p in range(k - 1, -1, -1):
        y[p] = (y[p] - dot(after(F, p * n + p + 1), after(y, p + 1), k - p - 1)) / F[p * n + p]


def invert(V: Doubles, m: int, n: int, work: Workspace) -> bool:
    """Inverse of the leading m x m block, in place; False if it is singular."""
    order = work.order
    for s in range(m):
        order[s] = largest_below(V, s, m, n)
        swap_rows(V, s, order[s], m, n)
        if not abs(V[s * n + s]) > SINGULAR:
            return False
        clear_column(V, s, m, n)
    for s in range(m - 1, -1, -1):
        swap_columns(V, s, order[s], m, n)
    return True


def clear_column(V: Doubles, s: int, m: int, n: int) -> None:
    """One step of Gauss and Jordan: the unit vector in column s, whose place the inverse takes."""
    reciprocal = 1.0 / V[s * n + s]
    V[s * n + s] = 1.0
    for q in range(m):
        V[s * n + q] *= reciprocal
    for p in range(m):
        factor = V[p * n + s]
        if p != s and factor != 0.0:
            V[p * n + s] = 0.0
            subtract(after(V, p * n), after(V, s * n), factor, m)
