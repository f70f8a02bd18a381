"""Dense elimination with row interchanges, in place, on the leading block of a larger array.

LU factors and, for Lemke's basis, the inverse by Gauss and Jordan. LAPACK would allocate and cost more than
the whole problem at the sizes of a time step. The matrices come scaled, entries near one.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.workspace import ORDER

SINGULAR = 1e-14  # a pivot below this, next to entries of size one, is rounding


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


def factorise(F: Any, k: int, indices: Any) -> bool:
    """LU factors of the leading k x k block, in place; False if it is singular."""
    order = indices[ORDER]
    for s in range(k):
        order[s] = largest_below(F, s, k)
        swap_rows(F, s, order[s], k)
        if not abs(F[s, s]) > SINGULAR:
            return False
        for p in range(s + 1, k):
            factor = F[p, s] / F[s, s]
            if factor != 0.0:
                subtract(F[p, s:], F[s, s:], factor, k - s)
            F[p, s] = factor
    return True


def back_substitute(F: Any, y: Any, k: int, indices: Any) -> None:
    """Replace the right-hand side y by the solution of the factorised system."""
    for s in range(k):
        row = indices[ORDER, s]
        y[s], y[row] = y[row], y[s]
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
        if order[s] != s:
            for p in range(m):
                V[p, s], V[p, order[s]] = V[p, order[s]], V[p, s]
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
