"""One Newton iteration of the theta-method for a general system M(t, q) v' = f(t, q, v).

The step's velocity v solves, with q(v) = q_i + h [theta v + (1-theta) v_i],

    R(v) = M_theta (v - v_i) - h [theta f(t+h, q(v), v) + (1-theta) f(t, q_i, v_i)] = G^T p,
    M_theta = theta M(t+h, q(v)) + (1-theta) M(t, q_i)

and is linearised as R(v_k) + A (v - v_k): v_free = v_k - A^-1 R(v_k), A ~ dR/dv. For constant M, C, K this is
the linear theta-method and one iteration is exact. A is made at the start of a step, and again, with the change of
M in it, where that is slow.
Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), section 10.1.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import mass, total_force
from lcpstep.kernels.linear import factorise, positive_definite, solve
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import add, copy, largest, product
from lcpstep.pointers import Doubles, abs, max
from lcpstep.stepping.theta_method.moving import Plan, State

DIFFERENCE = 1e-7  # relative; A only steers the iteration, its error does not enter the motion
SLOW = 1e-3  # velocities below it are as good as none, as are this share of what the forces make in a step,
FAR = 1e-7  # and this of the way to where the body is, in a step: differences are to be none of rounding
REFRESH = 5  # iterations with one A


def linearise(m: Model, plan: Plan, s: State, t: float, t_next: float) -> bool:
    """v_free about next_v, and the factors of A; False if A is singular or not finite."""
    n, fresh = s.n_q, s.iteration % REFRESH == 0
    given = m.force_q.given and m.force_v.given
    if s.iteration == 0:
        mass(m, t, s.q, s.v, s.M_start)
        copy(s.J, s.M_start, n * n)
        if not positive_definite(s.J, n):
            return False
    residual(m, plan, s, t_next)
    copy(s.next_force, s.try_f, n)
    if fresh:
        if given:
            given_jacobian(m, plan, s, t_next)
        else:
            differenced_jacobian(m, plan, s, t_next)
        if s.iteration > 0 and m.mass.given:
            add_change_of_mass(m, plan, s, t_next)
        if not factorise(s.A, s.pivots, n):
            return False
    solve(s.A, s.pivots, s.R, n)
    for i in range(n):
        s.v_free[i] = s.next_v[i] - s.R[i]
    return True


def least_speed(s: State, h: float) -> float:
    """The velocity below which a body counts as being at rest, whatever the units."""
    least = SLOW
    for i in range(s.n_q):
        made = h * abs(s.force[i]) / s.M_start[i * s.n_q + i]
        least = max(least, max(SLOW * made, FAR * abs(s.q[i]) / h))
    return least


def residual(m: Model, plan: Plan, s: State, t_next: float) -> None:
    """R(v) at next_v into s.R; leaves q(v), M_theta and f(t+h, q(v), v) in the work space."""
    n, theta = s.n_q, plan.theta
    forces(m, plan, s, t_next, s.next_v)
    mass(m, t_next, s.try_q, s.next_v, s.M)
    for i in range(n):
        s.R[i] = -plan.h * (theta * s.try_f[i] + (1.0 - theta) * s.force[i])
        for j in range(n):
            s.M[i * n + j] = theta * s.M[i * n + j] + (1.0 - theta) * s.M_start[i * n + j]
            s.R[i] += s.M[i * n + j] * (s.next_v[j] - s.v[j])


def forces(m: Model, plan: Plan, s: State, t_next: float, v: Doubles) -> None:
    """q(v) and f(t+h, q(v), v) into the work space."""
    for i in range(s.n_q):
        s.try_q[i] = s.q[i] + plan.h * (plan.theta * v[i] + (1.0 - plan.theta) * s.v[i])
    total_force(m, t_next, s.try_q, v, s.try_f)
    s.forces += 1


def differenced_jacobian(m: Model, plan: Plan, s: State, t_next: float) -> None:
    """A = M_theta - h theta df/dv along q(v), the change of M aside.

    M as it is, for after an impact differences of M (v - v_i) are rounding of the jump, however short the step.
    """
    n, shift = s.n_q, DIFFERENCE * largest(s.next_v, least_speed(s, plan.h), s.n_q)
    for j in range(n):
        copy(s.try_v, s.next_v, n)
        s.try_v[j] += shift
        forces(m, plan, s, t_next, s.try_v)
        for i in range(n):
            s.A[i * n + j] = s.M[i * n + j] - plan.h * plan.theta * (s.try_f[i] - s.next_force[i]) / shift


def add_change_of_mass(m: Model, plan: Plan, s: State, t_next: float) -> None:
    """Add h theta (dM_theta/dq) (v - v_i) to A, for an iteration that is slow without."""
    n, ht = s.n_q, plan.h * plan.theta
    for i in range(n):
        s.try_q[i] = s.q[i] + plan.h * (plan.theta * s.next_v[i] + (1.0 - plan.theta) * s.v[i])
    shift = DIFFERENCE * max(largest(s.try_q, 0.0, n), plan.h * largest(s.next_v, least_speed(s, plan.h), n))
    for j in range(n):
        place = s.try_q[j]
        s.try_q[j] = place + shift
        mass(m, t_next, s.try_q, s.next_v, s.J)
        s.try_q[j] = place
        for i in range(n):
            for k in range(n):
                moved = plan.theta * s.J[i * n + k] + (1.0 - plan.theta) * s.M_start[i * n + k]
                s.A[i * n + j] += ht * (moved - s.M[i * n + k]) / shift * (s.next_v[k] - s.v[k])


def given_jacobian(m: Model, plan: Plan, s: State, t_next: float) -> None:
    """A = M_theta - h theta (df/dv + h theta df/dq), the change of M aside."""
    n, ht = s.n_q, plan.h * plan.theta
    copy(s.A, s.M, n * n)
    m.force_v.fill(t_next, s.try_q, s.next_v, s.J)
    add(s.A, -ht, s.J, n * n)
    m.force_q.fill(t_next, s.try_q, s.next_v, s.J)
    add(s.A, -ht * ht, s.J, n * n)


def compliance(linear: bool, plan: Plan, s: State, row: Doubles, out: Doubles) -> None:
    """Out <- A^-1 row."""
    if linear:
        for i in range(s.n_q):
            out[i] = product(plan.A_f, row, i, s.n_q) / plan.h
    else:
        copy(out, row, s.n_q)
        solve(s.A, s.pivots, out, s.n_q)
