"""Contacts and tangents on the joints, as kernels: what is left of their rows once the joints are held.

    P_i = R_i - sum_j share_ij P_j  over the joints j held,      P_i M^-1 P_j^T = 0,      S = P M^-1 P^T

Where a normal is nearly that of a joint, the difference of Delassus matrices, W - W_J W_JJ^-1 W_J^T, keeps nothing
of it but rounding, which may be negative: contacts without friction then had no forces. S is made of the rows that
are left instead. Source: G. Golub, C. Van Loan, Matrix Computations, algorithm 5.2.6 (modified Gram-Schmidt).
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.kernels.acceleration import response
    from lcpstep.kernels.vectors import add, clear, copy, product
    from lcpstep.pointers import abs, after

# Of a row's mobility: what is left of one that is a joint's own; more where rows turn
SAME, DEPENDENT = 1e-22, 1e-12
# Of the terms of an acceleration: what a row that has nothing left may show of one; more where steps bring velocities
# that are off the joints, and rows turn
TOLD, TURNED = 1e-9, 1e-6


def leave_joints(s: Rubbing) -> None:
    """P and S on the joints held, which must be all that is; and the biases that belong to them, into `bent`.

    A row of which nothing is left is a joint's own: zero.
    """
    n, n_j, r = s.n_q, s.n_j, s.n_r
    s.n_kept = s.rows.n_held
    copy(s.bent, s.bias, r)
    if n_j == 0:  # S is W, and P is R
        return
    copy(s.P, s.R, r * n)
    for m in range(s.rows.n_held):
        sweep(s, s.rows.row[m])
    least = SAME if s.constant else DEPENDENT
    for i in range(n_j, r):
        respond_on_joints(s, i)
        if product(s.P, after(s.MP, i * n), i, n) <= least * s.W[i * r + i]:
            clear(after(s.P, i * n), n)
            clear(after(s.MP, i * n), n)
        for k in range(n_j, i + 1):
            s.S[i * r + k] = s.S[k * r + i] = product(s.P, after(s.MP, k * n), i, n)


def sweep(s: Rubbing, j: int) -> None:
    """Take the direction of joint j out of the rows after it."""
    n, way = s.n_q, after(s.MP, j * s.n_q)
    respond_on_joints(s, j)
    own = product(s.P, way, j, n)
    for i in range(j + 1, s.n_r):
        share = product(s.P, way, i, n) / own
        if share != 0.0:
            add(after(s.P, i * n), -share, after(s.P, j * n), n)
            s.bent[i] = s.bent[i] - share * s.bent[j]


def respond_on_joints(s: Rubbing, i: int) -> None:
    """M^-1 P_i^T: of the row that is left, for a difference of two such would be off from it by rounding of both."""
    response(s.model, s.rows.M, s.rows.work, after(s.P, i * s.n_q), after(s.MP, i * s.n_q))


def rubs(s: Rubbing, c: int) -> bool:
    """Whether contact c may have friction: one whose normal the joints hold already bears nothing to rub with."""
    return s.coefficients.rough[c] == 1 and can_bear(s, c)


def can_bear(s: Rubbing, c: int) -> bool:
    """Whether the joints leave anything of contact c's normal."""
    i = s.n_j + c
    return s.S[i * s.n_r + i] > 0.0


def acceleration_on_joints(s: Rubbing, i: int) -> float:
    """The acceleration of contact or tangent row i under `a`, which the joints allow."""
    if s.S[i * s.n_r + i] > 0.0:
        return product(s.P, s.a, i, s.n_q) + s.bent[i]
    alpha, size = s.bias[i], abs(s.bias[i])
    for k in range(s.n_q):
        alpha += s.R[i * s.n_q + k] * s.a[k]
        size += abs(s.R[i * s.n_q + k] * s.a[k])
    return alpha if abs(alpha) > (TOLD if s.constant else TURNED) * size else 0.0
