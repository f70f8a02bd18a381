"""What impulses of the rows of a step do: A^-1 times the rows' directions, and the mobilities between rows.

Rows of joints are taken at the end of the step, as far as it is known, and so are rows of contacts beside joints that
turn; the joints' forces act along the mean of both ends. Law and source: `theta_step`.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gap_rates, implicit_mass
from lcpstep.kernels.linear import invert_matrix
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles, Indices, after
from lcpstep.stepping.theta_method.implicit import REFRESH, compliance
from lcpstep.stepping.theta_method.moving import Plan, Rows, State

FOLLOWED = 12  # iterations, by which contacts' rows are at the end of the step as far as they ever are


def prepare(m: Model, plan: Plan, s: State, c: Rows, n_a: int, t_next: float) -> None:
    """What impulses of the rows that take part do, at the position at hand."""
    if c.n_j > 0:
        rows_at_the_end(m, s, c, n_a, t_next)
    if not plan.constant and (s.iteration % REFRESH == 0 or c.turning):
        respond(m.linear, plan, s, c, n_a + c.n_f + c.n_j)


def rows_at_the_end(m: Model, s: State, c: Rows, n_a: int, t: float) -> None:
    """Rows of joints at the end of the step, as far as it is known; where these turn, also those of contacts.

    Where a normal is always a combination of the joints' it is none of theirs at another place.
    """
    gap_rates(c.joints, t, s.next_q, s.next_v, c.J, c.J_t)
    if n_a > 0 and c.turning and s.iteration < FOLLOWED:
        if not m.flat:
            gap_rates(m, t, s.next_q, s.next_v, c.H, c.H_t)
        if c.n_f > 0 and not c.tangents.flat:
            gap_rates(c.tangents, t, s.next_q, s.next_v, c.T, c.T_t)


def respond(linear: bool, plan: Plan, s: State, c: Rows, n_k: int) -> None:
    """A^-1 times the directions of the rows that take part, and their mobilities."""
    n, first_joint = s.n_q, c.n_c + c.n_t
    for i in range(c.n_j * n):
        c.D[i] = plan.theta * c.J[i] + (1.0 - plan.theta) * c.J_start[i]
    for k in range(n_k):
        i = c.problem.ids[k]
        row = after(c.H, i * n) if i < first_joint else after(c.D, (i - first_joint) * n)
        compliance(linear, plan, s, row, after(plan.X, i * n))
    mobilities(c.H, plan.X, c.problem.ids, n_k, plan.W, c.n, n)


def mobilities(H: Doubles, X: Doubles, ids: Indices, n_k: int, W: Doubles, n: int, n_q: int) -> None:
    """W = H X^T on the rows that take part."""
    for k in range(n_k):
        for m in range(n_k):
            W[ids[k] * n + ids[m]] = product(H, after(X, ids[m] * n_q), ids[k], n_q)


def refit(m: Model, plan: Plan, s: State, c: Rows, t: float) -> None:
    """The matrices of a linear scene for steps of the size that the plan now has; see `Plan`."""
    n, x = s.n_q, plan.h * plan.theta
    implicit_mass(m, x, s.A)
    invert_matrix(s.A, s.pivots, plan.h, s.R, plan.A_f, n)
    for i in range(n):
        for j in range(n):
            stiff = damped = 0.0
            for k in range(n):
                stiff += plan.A_f[i * n + k] * m.K[k * n + j]
                damped += plan.A_f[i * n + k] * m.C[k * n + j]
            plan.A_q[i * n + j], plan.A_v[i * n + j] = stiff, damped + x * stiff
    if plan.constant:
        constant_rows(m, plan, s, c, t)


@cython.ccall
@cython.nogil
def constant_rows(m: Model, plan: Plan, s: State, c: Rows, t: float) -> None:
    """X and W of a linear scene in which no row ever changes."""
    gap_rates(m, t, s.q, s.v, c.H, c.H_t)
    gap_rates(c.tangents, t, s.q, s.v, c.T, c.T_t)
    gap_rates(c.joints, t, s.q, s.v, c.J, c.J_t)
    for i in range(c.n):
        compliance(True, plan, s, after(c.H, i * s.n_q), after(plan.X, i * s.n_q))
        c.problem.ids[i] = i
    mobilities(c.H, plan.X, c.problem.ids, c.n, plan.W, c.n, s.n_q)
