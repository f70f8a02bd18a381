"""What joints that turn within a step leave of rows of contacts.

Rates of the joints are of their rows at the end of the step, J; their forces act along others, D (`theta_step`). So
what is left of a contact's row is

    P = G - y J,     G A^-1 D^T = y J A^-1 D^T,

the part of its rate that no force of a joint changes. Where the joints hold the contact, G = y J, it is nothing. What
is left of a row is also what its force moves; the rest of that acts as the joints' forces do. For D = J that is the
direction G.

The joints' positions drift, and off the joints G need be no combination of J even where it always is on them. So of
rows of which next to nothing is left that is taken at a place on the joints.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gap_rates, gaps
from lcpstep.kernels.linear import factorise
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import add, clear, copy, largest, product
from lcpstep.pointers import Doubles, after
from lcpstep.stepping.theta_method.implicit import compliance
from lcpstep.stepping.theta_method.joint_rows import (
    NEARLY,
    Elimination,
    factorise_joints,
    leave,
    solve_joints,
)
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.responses import mobilities

LANDINGS = 20  # of Newton
LANDED = 1e-13  # of a way: the last one of these
HELD = 1e-9  # of a row: what is left of it where the place is off joints that turn by rounding


def sweep_out_turned(e: Elimination, linear: bool, plan: Plan, s: State, c: Rows, n: int, n_k: int) -> None:
    """The problem of the first n rows that take part, without the joints that follow them, of what these leave.

    The joints are factorised, and rates are without them. Rows of which more is left stay as they are.
    """
    n_q, n_j = s.n_q, c.n_j
    ids, R = c.problem.ids, c.problem.mobility
    transpose(e)
    for k in range(n):
        H, P, share = after(c.H, ids[k] * n_q), after(e.P, k * n_q), after(e.Z, k * n_j)
        copy(P, H, n_q)
        if nearly_held(plan, c, k, n):
            for j in range(n_j):
                e.y[j] = plan.W[ids[k] * c.n + ids[n + j]]
            solve_joints(e, share)
            leave(e, H, c.J, share, n_q, P)
            forget_rounding(P, H, n_q)
    transpose(e)
    for k in range(n):
        X, X_J, share = after(plan.X, ids[k] * n_q), after(plan.X, ids[n] * n_q), after(e.Z, k * n_j)
        if nearly_held(plan, c, k, n):
            compliance(linear, plan, s, after(e.P, k * n_q), X)
            for j in range(n_j):
                e.y[j] = product(c.J, X, j, n_q)
            for j in range(n_j):
                add(X, share[j], after(X_J, j * n_q), n_q)
            solve_joints(e, e.y)
            add(share, 1.0, e.y, n_j)
        leave(e, X, X_J, share, n_q, e.way)
        for i in range(n):
            R[i * n + k] = product(e.P, e.way, i, n_q)
    mobilities(c.H, plan.X, ids, n_k, plan.W, c.n, n_q)


def nearly_held(plan: Plan, c: Rows, k: int, n: int) -> bool:
    """Whether joints leave next to nothing of the k-th of n rows."""
    i = c.problem.ids[k]
    return not c.problem.mobility[k * n + k] > NEARLY * plan.W[i * c.n + i]


def put_rows_on_joints(
    e: Elimination, m: Model, plan: Plan, s: State, c: Rows, n_a: int, n: int, t: float
) -> bool:
    """Take what joints leave of contacts that they nearly hold at a place on the joints; were there any?

    H <- P + y J, and gap velocities before the step are those of what is left.
    """
    n_q, n_j, first, some = s.n_q, c.n_j, c.problem.ids[n], False
    for k in range(n_a if e.swept else 0):
        some = some or nearly_held(plan, c, k, n)
    if not (some and land_on_joints(e, plan, s, c, first, t)):
        return False
    gap_rates(m, t, s.q_between, s.next_v, c.G, c.G_t)
    for j in range(n_j):
        for i in range(n_j):
            c.S_there[i * n_j + j] = product(c.J_there, after(plan.X, (first + j) * n_q), i, n_q)
    factorise_joints(e, c.S_there, n_j, 0)
    transpose(e)
    for k in range(n_a):
        i = c.problem.ids[k]
        if nearly_held(plan, c, k, n):
            H, P, share = after(c.H, i * n_q), after(e.P, k * n_q), after(e.Z, k * n_j)
            for j in range(n_j):
                e.y[j] = product(c.G, after(plan.X, (first + j) * n_q), i, n_q)
            solve_joints(e, share)
            leave(e, after(c.G, i * n_q), c.J_there, share, n_q, P)
            forget_rounding(P, after(c.G, i * n_q), n_q)
            copy(H, P, n_q)
            left = c.G_t[i]
            for j in range(n_j):
                left -= share[j] * c.J_t_there[j]
                add(H, share[j], after(c.J, j * n_q), n_q)
            s.u[i] = c.H_t[i] = left
            for j in range(n_j):
                c.H_t[i] += share[j] * c.J_t[j]
            for j in range(n_q):
                s.u[i] += P[j] * s.v[j]
    return True


def land_on_joints(e: Elimination, plan: Plan, s: State, c: Rows, first: int, t: float) -> bool:
    """A place on the joints near next_q, into q_between, and their rows there; False where none is found."""
    n_q, n_j, way = s.n_q, c.n_j, s.v_between
    copy(s.q_between, s.next_q, n_q)
    for _ in range(LANDINGS):
        gaps(c.joints, t, s.q_between, s.next_v, e.y)
        for i in range(n_j):
            e.y[i] = -e.y[i]
        solve_joints(e, e.y)
        clear(way, n_q)
        for j in range(n_j):
            add(way, e.y[j], after(plan.X, (first + j) * n_q), n_q)
        add(s.q_between, 1.0, way, n_q)
        if largest(way, 0.0, n_q) <= LANDED * largest(s.q_between, plan.h * largest(s.v, 0.0, n_q), n_q):
            gap_rates(c.joints, t, s.q_between, s.next_v, c.J_there, c.J_t_there)
            return True
    return False


def forget_rounding(left: Doubles, row: Doubles, n_q: int) -> None:
    """What joints that turn leave of a row is nothing if it may be no more than the rounding of the place."""
    if largest(left, 0.0, n_q) <= HELD * largest(row, 0.0, n_q):
        clear(left, n_q)


def transpose(e: Elimination) -> None:
    """S^T in the place of S; the eigenvectors of their symmetric part are the same."""
    n = e.n_j
    for i in range(n):
        for j in range(i):
            e.S[i * n + j], e.S[j * n + i] = e.S[j * n + i], e.S[i * n + j]
    if not e.redundant:
        copy(e.F, e.S, n * n)
        factorise(e.F, e.pivots, n)
