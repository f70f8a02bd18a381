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

import cython

from lcpstep.kernels.acceleration import factor_mass, response
from lcpstep.kernels.coulomb import solve_contacts
from lcpstep.kernels.dynamics import gap_rates, gaps, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.status import DONE, LCP_FAILED, PROJECTION_FAILED
from lcpstep.kernels.vectors import add, copy
from lcpstep.pointers import abs, after, inf, max
from lcpstep.stepping.theta_method.joint_rows import NEARLY, arrived, distribute, eliminate
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.responses import mobilities

PROJECTIONS = 20  # of Newton


def project(m: Model, plan: Plan, s: State, c: Rows, t: float) -> int:
    """Correct next_q at time t, whose gaps are `entered`; says whether a position was found that satisfies all."""
    for i in range(c.n_c):
        c.near[i] = 0
    before = inf
    for _ in range(PROJECTIONS):
        if c.n_c > 0:
            gaps(m, t, s.next_q, s.next_v, c.gaps)
        if before == inf:
            copy(c.entered, c.gaps, c.n_c)
        if c.n_j > 0:
            gaps(c.joints, t, s.next_q, s.next_v, c.joint_gaps)
        off = worst = 0.0
        for i in range(c.n_j):
            off = max(off, abs(c.joint_gaps[i]))
        for i in range(c.n_c):
            worst = max(worst, -c.gaps[i])
        worst = max(worst, off)
        if arrived(worst, before, plan.slack, c.H, c.n, s.next_q, s.n_q):
            if before < inf and not m.linear:  # the next step begins with the forces of its own start
                total_force(m, t, s.next_q, s.next_v, s.next_force)
                s.forces += 1
            return DONE
        if not worst < inf:
            return PROJECTION_FAILED
        before = worst
        if not correct(m, s, c, t, c.turning and off > plan.slack):
            return LCP_FAILED
    return PROJECTION_FAILED


def correct(m: Model, s: State, c: Rows, t: float, astray: bool) -> bool:
    """One step of Newton's method; False where the linearised gaps allow no position.

    The gap of a contact whose normal the joints hold is that of a position on the joints: no change could mend it.
    Astray from joints that turn nobody knows which contacts they hold: those that they nearly hold wait.
    """
    n_a = 0
    # A contact once in danger stays in the problem, so that none is pushed through another.
    for i in range(c.n_c):
        if c.gaps[i] < 0.0 or c.p[i] > 0.0:
            c.near[i] = 1
        if c.near[i] == 1:
            c.problem.ids[n_a] = i
            n_a += 1
    for j in range(c.n_j):
        c.problem.ids[n_a + j] = c.n_c + c.n_t + j
    if n_a > 0:
        gap_rates(m, t, s.next_q, s.next_v, c.H, c.H_t)
    if c.n_j > 0:
        gap_rates(c.joints, t, s.next_q, s.next_v, c.J, c.J_t)
    if not factor_mass(m, t, s.next_q, s.next_v, c.M):
        return False
    n_k = n_a + c.n_j
    for k in range(n_k):
        i = c.problem.ids[k]
        response(m, c.M, s.try_q, after(c.H, i * s.n_q), after(c.Y, i * s.n_q))
    mobilities(c.H, c.Y, c.problem.ids, n_k, c.S, c.n, s.n_q)
    without_joints(s, c, n_a)
    if astray and c.elimination.swept:
        n_a = leave_out_nearly_held(c, n_a)
        n_k = n_a + c.n_j
        without_joints(s, c, n_a)
    R, rate = c.problem.mobility, c.problem.rate
    for k in range(n_a):
        if not R[k * n_a + k] > 0.0:
            rate[k] = 0.0
    if n_a > 0 and not solve_contacts(c.problem, n_a, 0):
        return False
    distribute(c.elimination, c.problem.impulse, c.problem.ids, n_a, n_k, c.push, c.n)
    for k in range(n_k):
        i = c.problem.ids[k]
        add(s.next_q, c.push[i], after(c.Y, i * s.n_q), s.n_q)
    return True


def without_joints(s: State, c: Rows, n_a: int) -> None:
    """The problem of n_a contacts alone; joints follow them."""
    R, rate, ids, n_k = c.problem.mobility, c.problem.rate, c.problem.ids, n_a + c.n_j
    for k in range(n_k):
        rate[k] = c.gaps[ids[k]] if k < n_a else c.joint_gaps[k - n_a]
    eliminate(c.elimination, c.S, c.n, c.H, c.Y, s.n_q, ids, n_a, n_k, R, rate)


def leave_out_nearly_held(c: Rows, n_a: int) -> int:
    """Leave out contacts of whose rows joints have left next to nothing; how many are left."""
    ids, n = c.problem.ids, 0
    for k in range(n_a):
        i = ids[k]
        if c.problem.mobility[k * n_a + k] > NEARLY * c.S[i * c.n + i]:
            ids[n] = i
            n += 1
    for j in range(c.n_j):
        ids[n + j] = ids[n_a + j]
    return n
