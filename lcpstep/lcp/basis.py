"""The basis of Lemke's method in revised form: an inverse that changes by one row, one column or both.

The system is w = b + sum_j A_j z_j with the columns A_j of W and, last, the covering vector A_n. While the z
in the list BASIC are not zero and the w in the list TIGHT are, the basic z solve

    K x = -b_tight,     K[p, q] = A_basic[q] at row tight[p].

A pivot adds a row and a column to K, removes both, or replaces one of either; the inverse V = K^-1 follows
by an update of rank one (J. Sherman and W. J. Morrison, Ann. Math. Stat. 21 (1950) 124). Every direction is
checked against A itself and, where rounding has gathered, refined; where that does not help, the inverse is
computed afresh. So errors do not grow along the path, as they do in a tableau.
"""

from __future__ import annotations

from typing import Any

from lcpstep.lcp.elimination import copy, dot, invert, subtract
from lcpstep.lcp.workspace import BASIC, DSLACK, DX, LEFT, SCALED_B, SLACK, TIGHT, W_PLACE, Z_PLACE, X

DRIFT = 1e-12  # error of a direction, relative to its size, above which it is refined


def set_direction(entering: int, m: int, n: int, work: Any) -> None:
    """Fill dx and dw, the change of the basic variables with the entering one: z_j is j, w_i is n + 1 + i."""
    solve_direction(entering, m, n, work)
    for _ in range(2):
        if drift(m, work) <= DRIFT:
            return
        refine(work.vectors[DX], work.vectors[DSLACK], m, work)
        follow(entering, m, n, work)
    if not drift(m, work) <= DRIFT and refactorise(m, n, work):
        solve_direction(entering, m, n, work)


def solve_direction(entering: int, m: int, n: int, work: Any) -> None:
    """K dx = -A_s on the tight rows for an entering z_s, a unit vector for an entering w."""
    V, dx = work.inverse, work.vectors[DX]
    if entering > n:
        place = work.indices[W_PLACE, entering - n - 1]
        for q in range(m):
            dx[q] = V[q, place]
    else:
        column, right, tight = work.columns[entering], work.vectors[LEFT], work.indices[TIGHT]
        for p in range(m):
            right[p] = column[tight[p]]
        for q in range(m):
            dx[q] = -dot(V[q], right, m)
    follow(entering, m, n, work)


def follow(entering: int, m: int, n: int, work: Any) -> None:
    """Dw = A dx plus the entering column, over all rows; on the tight rows this is the error of dx."""
    columns, basic, dx, dw = work.columns, work.indices[BASIC], work.vectors[DX], work.vectors[DSLACK]
    if entering > n:
        for i in range(n):
            dw[i] = 0.0
        dw[entering - n - 1] = -1.0
    else:
        copy(dw, columns[entering], n)
    for q in range(m):
        subtract(dw, columns[basic[q]], -dx[q], n)


def drift(m: int, work: Any) -> float:
    """Largest error of the direction on the tight rows, relative to its largest component."""
    tight, dx, dw = work.indices[TIGHT], work.vectors[DX], work.vectors[DSLACK]
    error, size = 0.0, 1.0
    for p in range(m):
        error = max(error, abs(dw[tight[p]]))
        size = max(size, abs(dx[p]))
    return error / size


def refine(x: Any, w: Any, m: int, work: Any) -> None:
    """Correct x by K^-1 times what w leaves on the tight rows."""
    V, error, tight = work.inverse, work.vectors[LEFT], work.indices[TIGHT]
    for p in range(m):
        error[p] = w[tight[p]]
    for q in range(m):
        x[q] -= dot(V[q], error, m)


def refactorise(m: int, n: int, work: Any) -> bool:
    """Compute the inverse and the basic values from A and b; False if K is singular."""
    V, columns, basic, tight = work.inverse, work.columns, work.indices[BASIC], work.indices[TIGHT]
    x, w = work.vectors[X], work.vectors[SLACK]
    for p in range(m):
        for q in range(m):
            V[p, q] = columns[basic[q], tight[p]]
    if not invert(V, m, work.indices):
        return False
    for q in range(m):
        x[q] = 0.0
    for _ in range(2):
        copy(w, work.vectors[SCALED_B], n)
        for q in range(m):
            subtract(w, columns[basic[q]], -x[q], n)
        refine(x, w, m, work)
    return True


def pivot(entering: int, leaving: int, m: int, n: int, work: Any) -> int:
    """Exchange two variables in the basis and in the inverse; returns the new size of K."""
    z_place, w_place = work.indices[Z_PLACE], work.indices[W_PLACE]
    if entering <= n:
        if leaving <= n:
            return replace_column(entering, z_place[leaving], m, work)
        return add_row_and_column(entering, leaving - n - 1, m, work)
    if leaving <= n:
        return drop_row_and_column(w_place[entering - n - 1], z_place[leaving], m, work)
    return replace_row(w_place[entering - n - 1], leaving - n - 1, m, work)


def replace_column(j: int, q: int, m: int, work: Any) -> int:
    """z_j takes the place q of another z; dx is -K^-1 A_j."""
    V, dx, basic, z_place = work.inverse, work.vectors[DX], work.indices[BASIC], work.indices[Z_PLACE]
    for p in range(m):
        V[q, p] /= -dx[q]
    for i in range(m):
        if i != q:
            subtract(V[i], V[q], -dx[i], m)
    z_place[basic[q]], z_place[j], basic[q] = -1, q, j
    return m


def replace_row(p: int, i: int, m: int, work: Any) -> int:
    """w_i becomes tight at the place p of another w."""
    V, left, tight, w_place = work.inverse, work.vectors[LEFT], work.indices[TIGHT], work.indices[W_PLACE]
    left_product(i, m, work)
    for q in range(m):
        factor = V[q, p] / left[p]
        subtract(V[q], left, factor, m)
        V[q, p] = factor
    w_place[tight[p]], w_place[i], tight[p] = -1, p, i
    return m


def add_row_and_column(j: int, i: int, m: int, work: Any) -> int:
    """z_j becomes basic and w_i tight; the pivot is dw_i."""
    V, dx, left = work.inverse, work.vectors[DX], work.vectors[LEFT]
    reciprocal = 1.0 / work.vectors[DSLACK, i]
    left_product(i, m, work)
    for q in range(m):
        factor = dx[q] * reciprocal
        subtract(V[q], left, factor, m)
        V[q, m] = factor
    for p in range(m):
        V[m, p] = -left[p] * reciprocal
    V[m, m] = reciprocal
    work.indices[BASIC, m], work.indices[Z_PLACE, j] = j, m
    work.indices[TIGHT, m], work.indices[W_PLACE, i] = i, m
    return m + 1


def left_product(i: int, m: int, work: Any) -> None:
    """Row i of the basic columns, times K^-1."""
    V, columns, left, basic = work.inverse, work.columns, work.vectors[LEFT], work.indices[BASIC]
    for p in range(m):
        left[p] = 0.0
    for q in range(m):
        subtract(left, V[q], -columns[basic[q], i], m)


def drop_row_and_column(p: int, q: int, m: int, work: Any) -> int:
    """The tight w at place p becomes basic, the basic z at place q zero; the last ones take their places."""
    V, x, last = work.inverse, work.vectors[X], m - 1
    basic, tight = work.indices[BASIC], work.indices[TIGHT]
    reciprocal = 1.0 / V[q, p]
    for i in range(m):
        if i != q:
            subtract(V[i], V[q], V[i, p] * reciprocal, m)
    for i in range(m):
        V[q, i] = V[last, i]
    for i in range(last):
        V[i, p] = V[i, last]
    work.indices[Z_PLACE, basic[q]], work.indices[W_PLACE, tight[p]] = -1, -1
    if q < last:
        basic[q], x[q] = basic[last], x[last]
        work.indices[Z_PLACE, basic[q]] = q
    if p < last:
        tight[p] = tight[last]
        work.indices[W_PLACE, tight[p]] = p
    return last
