"""One Newton iteration of the theta-method for a general system M(t, q) v' = f(t, q, v).

The step's velocity v solves, with q(v) = q_i + h [theta v + (1-theta) v_i],

    R(v) = M_theta (v - v_i) - h [theta f(t+h, q(v), v) + (1-theta) f(t, q_i, v_i)] = G^T p,
    M_theta = theta M(t+h, q(v)) + (1-theta) M(t, q_i)

and is linearised as R(v_k) + A (v - v_k): v_free = v_k - A^-1 R(v_k), A ~ dR/dv. For constant M, C, K this is
the linear theta-method and one iteration is exact. A is made at the start of a step, and again where that is slow.
Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), section 10.1.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call, inline
from lcpstep.dense import add, assign, factorise, positive_definite, solve
from lcpstep.dynamics import mass, product, total_force
from lcpstep.model import ABSENT

STEP_FOR_DIFFERENCES = 1e-7  # relative; A only steers the iteration, its error does not enter the motion
FORCES, ITERATION = 4, 5  # places in the array of counters
REFRESH = 5  # iterations with one A


@by_address
class Newton(NamedTuple):
    """Work space."""

    R: Any  # (n_q,)
    v: Any  # (n_q,)
    q: Any  # (n_q,)
    f: Any  # (n_q,)
    M: Any  # (n_q, n_q)
    M_start: Any  # (n_q, n_q)
    A: Any  # (n_q, n_q)
    J: Any  # (n_q, n_q)
    pivots: Any  # (n_q,)


@inline
def linearise(model: Any, plan: Any, state: Any, t: float, t_next: float, contact: bool, count: Any) -> bool:
    """v_free about next_v, and for active contacts A^-1 G^T and W; False if A is singular or not finite."""
    work, n, fresh = state.newton, len(state.q), count[ITERATION] % REFRESH == 0
    given = model.force_q != ABSENT and model.force_v != ABSENT
    if count[ITERATION] == 0:
        mass(model, t, state.q, state.v, work.M_start)
        assign(work.J, work.M_start)
        if not positive_definite(work.J):
            return False
    shift = difference(state.next_v)
    for j in range(n if fresh and not given else 0, -1, -1):  # the last one at next_v itself
        assign(work.v, state.next_v)
        if j > 0:
            work.v[j - 1] += shift
        residual(model, plan, state, t_next, work.v, work.R, count)
        for i in range(n if j > 0 else 0):
            work.A[i, j - 1] = work.R[i] / shift
    assign(state.next_force, work.f)
    if fresh:
        if given:
            given_jacobian(model, plan, state, t_next)
        else:
            for i in range(n):
                for j in range(n):
                    work.A[i, j] -= work.R[i] / shift
        if not factorise(work.A, work.pivots):
            return False
    solve(work.A, work.pivots, work.R)
    for i in range(n):
        state.v_free[i] = state.next_v[i] - work.R[i]
    if contact and fresh:
        respond(plan.A_g, plan.W, state.G, work.A, work.pivots, work.R)
    return True


def respond(A_g: Any, W: Any, G: Any, A: Any, pivots: Any, x: Any) -> None:
    """A^-1 G^T and W = G A^-1 G^T of all contacts."""
    for c in range(len(G)):
        assign(x, G[c])
        solve(A, pivots, x)
        for i in range(len(x)):
            A_g[i, c] = x[i]
        for d in range(len(G)):
            W[d, c] = product(G, x, d)


def difference(v: Any) -> float:
    """Step of the differences."""
    size = 1e-3
    for i in range(len(v)):
        size = max(size, abs(v[i]))
    return STEP_FOR_DIFFERENCES * size


@inline
def residual(model: Any, plan: Any, state: Any, t_next: float, v: Any, R: Any, count: Any) -> None:
    """R(v); leaves q(v), M_theta and f(t+h, q(v), v) in the work space."""
    work, theta, h = state.newton, plan.theta, plan.h
    for i in range(len(v)):
        work.q[i] = state.q[i] + h * (theta * v[i] + (1.0 - theta) * state.v[i])
    mass(model, t_next, work.q, v, work.M)
    total_force(model, t_next, work.q, v, work.f)
    count[FORCES] += 1
    for i in range(len(v)):
        R[i] = -h * (theta * work.f[i] + (1.0 - theta) * state.force[i])
        for j in range(len(v)):
            work.M[i, j] = theta * work.M[i, j] + (1.0 - theta) * work.M_start[i, j]
            R[i] += work.M[i, j] * (v[j] - state.v[j])


@inline
def given_jacobian(model: Any, plan: Any, state: Any, t_next: float) -> None:
    """A = M_theta - h theta (df/dv + h theta df/dq), the change of M left out."""
    work, ht = state.newton, plan.h * plan.theta
    assign(work.A, work.M)
    call(model.force_v, t_next, work.q, state.next_v, model.p, work.J)
    add(work.A, -ht, work.J)
    call(model.force_q, t_next, work.q, state.next_v, model.p, work.J)
    add(work.A, -ht * ht, work.J)
