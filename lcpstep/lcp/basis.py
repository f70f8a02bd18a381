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

import cython

from lcpstep.lcp.elimination import invert
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, after, max
from lcpstep.rows import copy, dot, subtract

DRIFT = 1e-12  # error of a direction, relative to its size, above which it is refined


def set_direction(entering: int, m: int, n: int, work: Workspace) -> None:
    """Fill dx and dw, the change of the basic variables with the entering one: z_j is j, w_i is n + 1 + i."""
    find_direction(entering, m, n, work)
    for p in range(m):  # which are not basic
        work.dslack[work.tight[p]] = 0.0


def find_direction(entering: int, m: int, n: int, work: Workspace) -> None:
    """The same; on the tight rows dw is the error of dx."""
    solve_direction(entering, m, n, work)
    for _ in range(2):
        if drift(m, work) <= DRIFT:
            return
        refine(work.dx, work.dslack, m, n, work)
        follow(entering, m, n, work)
    if not drift(m, work) <= DRIFT and refactorise(m, n, work):
        solve_direction(entering, m, n, work)


def solve_direction(entering: int, m: int, n: int, work: Workspace) -> None:
    """K dx = -A_s on the tight rows for an entering z_s, a unit vector for an entering w."""
    V, dx = work.inverse, work.dx
    if entering > n:
        place = work.w_place[entering - n - 1]
        for q in range(m):
            dx[q] = V[q * n + place]
    else:
        column, right, tight = after(work.columns, entering * n), work.left, work.tight
        for p in range(m):
            right[p] = column[tight[p]]
        for q in range(m):
            dx[q] = -dot(after(V, q * n), right, m)
    follow(entering, m, n, work)


def follow(entering: int, m: int, n: int, work: Workspace) -> None:
    """Dw = A dx plus the entering column, over all rows; on the tight rows this is the error of dx."""
    columns, basic, dx, dw = work.columns, work.basic, work.dx, work.dslack
    if entering > n:
        for i in range(n):
            dw[i] = 0.0
        dw[entering - n - 1] = -1.0
    else:
        copy(dw, after(columns, entering * n), n)
    for q in range(m):
        subtract(dw, after(columns, basic[q] * n), -dx[q], n)


def drift(m: int, work: Workspace) -> float:
    """Largest error of the direction on the tight rows, relative to its largest component."""
    tight, dx, dw = work.tight, work.dx, work.dslack
    error, size = 0.0, 1.0
    for p in range(m):
        error = max(error, abs(dw[tight[p]]))
        size = max(size, abs(dx[p]))
    return error / size


def refine(x: Doubles, w: Doubles, m: int, n: int, work: Workspace) -> None:
    """Correct x by K^-1 times what w leaves on the tight rows."""
    V, error, tight = work.inverse, work.left, work.tight
    for p in range(m):
        error[p] = w[tight[p]]
    for q in range(m):
        x[q] -= dot(after(V, q * n), error, m)


def refactorise(m: int, n: int, work: Workspace) -> bool:
    """Compute the inverse and the basic values from A and b; False if K is singular."""
    V, columns, basic, tight = work.inverse, work.columns, work.basic, work.tight
    x, w = work.x, work.slack
    for p in range(m):
        for q in range(m):
            V[p * n + q] = columns[basic[q] * n + tight[p]]
    if not invert(V, m, n, work):
        return False
    for q in range(m):
        x[q] = 0.0
    for _ in range(2):
        copy(w, work.scaled_b, n)
        for q in range(m):
            subtract(w, after(columns, basic[q] * n), -x[q], n)
        refine(x, w, m, n, work)
    return True


def pivot(entering: int, leaving: int, m: int, n: int, work: Workspace) -> int:
    """Exchange two variables in the basis and in the inverse; returns the new size of K."""
    z_place, w_place = work.z_place, work.w_place
    if entering <= n:
        if leaving <= n:
            return replace_column(entering, z_place[leaving], m, n, work)
        return add_row_and_column(entering, leaving - n - 1, m, n, work)
    if leaving <= n:
        return drop_row_and_column(w_place[entering - n - 1], z_place[leaving], m, n, work)
    return replace_row(w_place[entering - n - 1], leaving - n - 1, m, n, work)


def replace_column(j: int, q: int, m: int, n: int, work: Workspace) -> int:
    """z_j takes the place q of another z; dx is -K^-1 A_j."""
    V, dx, basic, z_place = work.inverse, work.dx, work.basic, work.z_place
    for p in range(m):
        V[q * n + p] /= -dx[q]
    for i in range(m):
        if i != q:
            subtract(after(V, i * n), after(V, q * n), -dx[i], m)
    z_place[basic[q]], z_place[j], basic[q] = -1, q, j
    return m


def replace_row(p: int, i: int, m: int, n: int, work: Workspace) -> int:
    """w_i becomes tight at the place p of another w."""
    V, left, tight, w_place = work.inverse, work.left, work.tight, work.w_place
    left_product(i, m, n, work)
    for q in range(m):
        factor = V[q * n + p] / left[p]
        subtract(after(V, q * n), left, factor, m)
        V[q * n + p] = factor
    w_place[tight[p]], w_place[i], tight[p] = -1, p, i
    return m


def add_row_and_column(j: int, i: int, m: int, n: int, work: Workspace) -> int:
    """z_j becomes basic and w_i tight; the pivot is dw_i."""
    V, dx, left = work.inverse, work.dx, work.left
    reciprocal = 1.0 / work.dslack[i]
    left_product(i, m, n, work)
    for q in range(m):
        factor = dx[q] * reciprocal
        subtract(after(V, q * n), left, factor, m)
        V[q * n + m] = factor
    for p in range(m):
        V[m * n + p] = -left[p] * reciprocal
    V[m * n + m] = reciprocal
    work.basic[m], work.z_place[j] = j, m
    work.tight[m], work.w_place[i] = i, m
    return m + 1


def left_product(i: int, m: int, n: int, work: Workspace) -> None:
    """Row i of the basic columns, times K^-1."""
    V, columns, left, basic = work.inverse, work.columns, work.left, work.basic
    for p in range(m):
        left[p] = 0.0
    for q in range(m):
        subtract(left, after(V, q * n), -columns[basic[q] * n + i], m)


def drop_row_and_column(p: int, q: int, m: int, n: int, work: Workspace) -> int:
    """The tight w at place p becomes basic, the basic z at place q zero; the last ones take their places."""
    V, x, last = work.inverse, work.x, m - 1
    basic, tight = work.basic, work.tight
    reciprocal = 1.0 / V[q * n + p]
    for i in range(m):
        if i != q:
            subtract(after(V, i * n), after(V, q * n), V[i * n + p] * reciprocal, m)
    for i in range(m):
        V[q * n + i] = V[last * n + i]
    for i in range(last):
        V[i * n + p] = V[i * n + last]
    work.z_place[basic[q]], work.w_place[tight[p]] = -1, -1
    if q < last:
        basic[q], x[q] = basic[last], x[last]
        work.z_place[basic[q]] = q
    if p < last:
        tight[p] = tight[last]
        work.w_place[tight[p]] = p
    return last
