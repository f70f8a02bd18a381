"""Positions put back onto joints and out of obstacles, after a step whose velocities are kept.

The velocity of a step obeys g' >= 0 and g' = 0 at one position; the gaps themselves drift. The smallest change of the
position, in the metric of the mass, that repairs them,

    minimise (q - q+)^T M (q - q+) / 2    with  g_J(t, q) = 0  on joints  and  g(t, q) >= 0  on contacts,

is found by Newton's method: q <- q + M^-1 (G_J^T mu + G^T lambda), where 0 <= lambda is complementary to
g + G M^-1 G^T lambda >= 0. Kinetic energy is that of the velocities, so with a constant mass it does not change.

Source: T. Schindler, S. Rezaei, J. Kursawe, V. Acary, Comput. Methods Appl. Mech. Engrg. 290 (2015) 250, combined
projection; V. Acary, Appl. Numer. Math. 73 (2013) 43.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.dense import assign, positive_definite, solve_definite
from lcpstep.dynamics import gap_rates, gaps, mass
from lcpstep.stepping.friction import solve_contacts
from lcpstep.stepping.joints import distribute, eliminate
from lcpstep.stepping.rows import mobilities

PROJECTIONS = 20  # of Newton
STALLED = 1e4  # of the slack: how much rounding in the gaps' own arithmetic may leave
DONE, NO_POSITION, INFEASIBLE = range(3)


def project(model: Any, plan: Any, state: Any, c: Any, t: float) -> int:
    """Correct next_q at time t; says whether a position was found that satisfies all."""
    n_c, n_j = len(state.u), len(c.joint_gaps)
    for i in range(n_c):
        c.near[i] = 0
    before = np.inf
    for _ in range(PROJECTIONS):
        if n_c > 0:
            gaps(model, t, state.next_q, state.next_v, c.gaps)
        if n_j > 0:
            gaps(c.joints, t, state.next_q, state.next_v, c.joint_gaps)
        worst = 0.0
        for i in range(n_c):
            worst = max(worst, -c.gaps[i])
        for i in range(n_j):
            worst = max(worst, abs(c.joint_gaps[i]))
        if worst <= plan.slack or 0.5 * before < worst <= STALLED * plan.slack:
            return DONE
        if not worst < np.inf:
            return NO_POSITION
        before = worst
        if not correct(model, plan, state, c, t):
            return INFEASIBLE
    return NO_POSITION


def correct(model: Any, plan: Any, state: Any, c: Any, t: float) -> bool:
    """One step of Newton's method; False where the linearised gaps allow no position."""
    n_c, n_j = len(state.u), len(c.joint_gaps)
    n_a = 0
    # A contact once in danger stays in the problem, so that none is pushed through another.
    for i in range(n_c):
        if c.gaps[i] < 0.0 or state.p[i] > 0.0:
            c.near[i] = 1
        if c.near[i] == 1:
            c.ids[n_a] = i
            n_a += 1
    for j in range(n_j):
        c.ids[n_a + j] = c.first_joint + j
    if n_a > 0:
        gap_rates(model, t, state.next_q, state.next_v, state.G, state.g_t)
    if n_j > 0:
        gap_rates(c.joints, t, state.next_q, state.next_v, c.J, c.J_t)
    if not model.linear:
        mass(model, t, state.next_q, state.next_v, c.M)
        if not positive_definite(c.M):
            return False
    n_k = n_a + n_j
    for k in range(n_k):
        i = c.ids[k]
        c.b[i] = c.gaps[i] if k < n_a else c.joint_gaps[k - n_a]
        divide_by_mass(model.linear, model.M_inverse, c.M, c.H[i], c.X[i])
    mobilities(c.H, c.X, c.ids, n_k, c.W)
    eliminate(c.joint_work, c.W, c.b, c.ids, n_a, n_k, c.problem.R, c.problem.reduced)
    if n_a > 0 and not solve_contacts(c.problem, n_a, 0):
        return False
    distribute(c.joint_work, c.problem.solution, c.ids, n_a, n_k, c.p)
    for k in range(n_k):
        for i in range(len(state.q)):
            state.next_q[i] += c.X[c.ids[k], i] * c.p[c.ids[k]]
    return True


def divide_by_mass(linear: bool, inverse: Any, L: Any, row: Any, out: Any) -> None:
    """Out <- M^-1 row, by the inverse of a constant mass or else by Cholesky's factor L."""
    assign(out, row)
    if not linear:
        solve_definite(L, out)
        return
    for i in range(len(row)):
        out[i] = 0.0
        for j in range(len(row)):
            out[i] += inverse[i, j] * row[j]
