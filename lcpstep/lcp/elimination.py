"""Dense elimination in place, on the leading block of a larger array.

LU factors of a principal submatrix, in which dependent indices are recognised and left out, and the inverse
of Lemke's basis by Gauss and Jordan. LAPACK would allocate and would cost more than the whole problem at the
sizes of a time step. The matrices come scaled, entries near one.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.workspace import ACTIVE, CHOSEN, ORDER

SINGULAR = 1e-14  # a pivot below this, next to entries of size one, is rounding
PREFERENCE = 0.1  # a diagonal pivot is taken if it has this part of the largest one


def dot(x: Any, y: Any, m: int) -> float:
    """Sum of x_i y_i for i < m, in four partial sums that the processor can overlap."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = m - m % 4
    for i in range(0, whole, 4):
        a += x[i] * y[i]
        b += x[i + 1] * y[i + 1]
        c += x[i + 2] * y[i + 2]
        d += x[i + 3] * y[i + 3]
    for i in range(whole, m):
        a += x[i] * y[i]
    return (a + b) + (c + d)


def subtract(target: Any, source: Any, factor: float, m: int) -> None:
    """Target -= factor * source in the first m entries."""
    for i in range(m):
        target[i] -= factor * source[i]


def copy(target: Any, source: Any, m: int) -> None:
    """Target = source in the first m entries."""
    for i in range(m):
        target[i] = source[i]


def largest_below(F: Any, s: int, k: int) -> int:
    """The row at or below s with the largest entry in column s."""
    row = s
    for p in range(s + 1, k):
        if abs(F[p, s]) > abs(F[row, s]):
            row = p
    return row


def swap_rows(F: Any, i: int, j: int, k: int) -> None:
    """Interchange two rows of the leading k columns."""
    if i != j:
        for q in range(k):
            F[i, q], F[j, q] = F[j, q], F[i, q]


def swap_columns(F: Any, i: int, j: int, k: int) -> None:
    """Interchange two columns of the leading k rows."""
    if i != j:
        for p in range(k):
            F[p, i], F[p, j] = F[p, j], F[p, i]


def factorise(F: Any, k: int, indices: Any) -> int:
    """LU factors of the leading k x k block, rows and columns of which are listed in ORDER and ACTIVE.

    An index whose column depends on those before it is left out of the block and of CHOSEN. Returns the
    size that remains, or -1 if the row of such an index has been used already.
    """
    order, s = indices[ORDER], 0
    while s < k:
        row = largest_below(F, s, k)
        if not abs(F[row, s]) > SINGULAR:
            k = leave_out(F, s, k, indices)
            if k < 0:
                return k
            continue
        if abs(F[s, s]) < PREFERENCE * abs(F[row, s]):
            swap_rows(F, s, row, k)
            order[s], order[row] = order[row], order[s]
        reciprocal = 1.0 / F[s, s]
        for p in range(s + 1, k):
            factor = F[p, s] * reciprocal
            F[p, s] = factor
            if factor != 0.0:
                subtract(F[p, s + 1 :], F[s, s + 1 :], factor, k - s - 1)
        s += 1
    return k


def leave_out(F: Any, s: int, k: int, indices: Any) -> int:
    """Move row and column of the dependent index at place s to the end; returns the size without it."""
    order, active, last = indices[ORDER], indices[ACTIVE], k - 1
    index, row = active[s], s
    while row < k and order[row] != index:
        row += 1
    if row == k:
        return -1
    swap_columns(F, s, last, k)
    swap_rows(F, row, last, k)
    active[s], active[last] = active[last], active[s]
    order[row], order[last] = order[last], order[row]
    indices[CHOSEN, index] = 0
    return last


def back_substitute(F: Any, y: Any, k: int) -> None:
    """Replace the right-hand side y, in the order of the rows, by the solution of the factorised system."""
    for p in range(1, k):
        y[p] -= dot(F[p], y, p)
    for p in range(k - 1, -1, -1):
        y[p] = (y[p] - dot(F[p, p + 1 :], y[p + 1 :], k - p - 1)) / F[p, p]


def invert(V: Any, m: int, indices: Any) -> bool:
    """Inverse of the leading m x m block, in place; False if it is singular."""
    order = indices[ORDER]
    for s in range(m):
        order[s] = largest_below(V, s, m)
        swap_rows(V, s, order[s], m)
        if not abs(V[s, s]) > SINGULAR:
            return False
        clear_column(V, s, m)
    for s in range(m - 1, -1, -1):
        swap_columns(V, s, order[s], m)
    return True


def clear_column(V: Any, s: int, m: int) -> None:
    """One step of Gauss and Jordan: the unit vector in column s, whose place the inverse takes."""
    reciprocal = 1.0 / V[s, s]
    V[s, s] = 1.0
    for q in range(m):
        V[s, q] *= reciprocal
    for p in range(m):
        factor = V[p, s]
        if p != s and factor != 0.0:
            V[p, s] = 0.0
            subtract(V[p], V[s], factor, m)
