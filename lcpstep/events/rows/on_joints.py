"""Contacts and tangents on the joints, as kernels: what is left of their rows once the joints are held.

    P_i = R_i - sum_j share_ij P_j  over the joints j held,      P_i M^-1 P_j^T = 0,      S = P M^-1 P^T

written R_on and D_on here, M^-1 P^T as MR_on.

Where a normal is nearly that of a joint, the difference of Delassus matrices, D - D_J D_JJ^-1 D_J^T, keeps nothing
of it but rounding, which may be negative: contacts then had no forces, or were passed. S is made of the rows that
are left instead. Source: G. Golub, C. Van Loan, Matrix Computations, algorithm 5.2.6 (modified Gram-Schmidt).
"""

from __future__ import annotations

import cython

from lcpstep.events.rows.equations import other
from lcpstep.events.rows.state import Rows
from lcpstep.kernels.acceleration import response
from lcpstep.kernels.linear import uncouple
from lcpstep.kernels.vectors import add, clear, copy, product
from lcpstep.pointers import Doubles, abs, after

# Of a row's mobility: what is left of one that is a joint's own; more where rows turn
SAME, DEPENDENT = 1e-22, 1e-12
# The same of what joints lead along a surface
LED = 1e-4
# Of the terms of an acceleration: what a row that has nothing left may show of one; more where steps bring velocities
# that are off the joints, and rows turn
TOLD, TURNED = 1e-9, 1e-6


def leave_joints(s: Rows) -> None:
    """Rows and their Delassus matrix on the joints held, and the biases that belong to them."""
    s.on_joints = True
    if s.n_j == 0:  # they are R and D
        return
    for i in range(s.n_j, s.n_r):
        put_on_joints(s, i)
        for k in range(s.n_j, i + 1):
            couple_on_joints(s, i, k)
    uncouple(s.D_on, s.R_on, s.MR_on, s.n_j, s.n_r, s.n_r, s.n_q)


def leave_joints_again(s: Rows, count: int) -> None:
    """The same for what is to be held again beside the joints: `row` up to `count`."""
    if s.n_j == 0:
        return
    for m in range(s.n_kept, count):
        i = s.row[m]
        put_on_joints(s, i)
        if s.share[i] != 0.0:
            put_on_joints(s, other(s, i))
    for m in range(s.n_kept, count):
        for n in range(s.n_kept, count):
            couple_on_joints(s, s.row[m], s.row[n])
            if s.share[s.row[n]] != 0.0:
                couple_on_joints(s, s.row[m], other(s, s.row[n]))


def couple_on_joints(s: Rows, i: int, k: int) -> None:
    """Rows i and k of the Delassus matrix on the joints."""
    i, k = (i, k) if i > k else (k, i)
    s.D_on[i * s.n_r + k] = s.D_on[k * s.n_r + i] = product(s.R_on, after(s.MR_on, k * s.n_q), i, s.n_q)


def put_on_joints(s: Rows, i: int) -> None:
    """What is left of row i on the joints kept so far. A row of which nothing is left is a joint's own: zero.

    M^-1 P_i^T is that of the row that is left: a difference of two such would be off from it by rounding of both.
    """
    n, row, way = s.n_q, after(s.R_on, i * s.n_q), after(s.MR_on, i * s.n_q)
    copy(row, after(s.R, i * n), n)
    s.bias_on[i] = s.bias[i]
    for m in range(s.n_kept):
        j = s.row[m]
        share = product(s.R_on, after(s.MR_on, j * n), i, n) / s.D_on[j * s.n_r + j]
        if share != 0.0:
            add(row, -share, after(s.R_on, j * n), n)
            s.bias_on[i] = s.bias_on[i] - share * s.bias_on[j]
    response(s.model, s.M, s.work, row, way)
    s.D_on[i * s.n_r + i] = product(s.R_on, way, i, n)
    if i >= s.n_j and s.D_on[i * s.n_r + i] <= (SAME if s.fixed else DEPENDENT) * s.D[i * s.n_r + i]:
        clear(row, n)
        clear(way, n)
        s.D_on[i * s.n_r + i] = 0.0


def can_bear(s: Rows, c: int) -> bool:
    """Whether the joints leave anything of contact c's normal."""
    i = s.n_j + c
    return s.D_on[i * s.n_r + i] > 0.0


def is_led(s: Rows, c: int) -> bool:
    """Whether the joints, once held, leave so little of contact c's normal that they lead along its surface."""
    i = s.n_j + c
    return s.n_j > 0 and s.D_on[i * s.n_r + i] <= LED * s.D[i * s.n_r + i]


def acceleration_on_joints(s: Rows, i: int, a: Doubles) -> float:
    """The acceleration of contact or tangent row i under a, which the joints allow."""
    if s.D_on[i * s.n_r + i] > 0.0:
        return product(s.R_on, a, i, s.n_q) + s.bias_on[i]
    alpha, size = s.bias[i], abs(s.bias[i])
    for k in range(s.n_q):
        alpha += s.R[i * s.n_q + k] * a[k]
        size += abs(s.R[i * s.n_q + k] * a[k])
    return alpha if abs(alpha) > (TOLD if s.fixed else TURNED) * size else 0.0
