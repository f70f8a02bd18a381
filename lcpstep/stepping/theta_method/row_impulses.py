"""The rows of a step and their impulses, for a given velocity without contact.

A row is a direction h of the velocities with its rate u = h v + h_t and its impulse; `ids` lists the rows that take
part in a step, the normals of the active contacts first, then tangents, then joints. Matrices of all n rows lie row
by row: H and X have n_q columns, W has n. Law and source: `theta_step`.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.coulomb import DEGENERATE, motion_of, solve_contacts
from lcpstep.kernels.energetic import strike_in_turn
from lcpstep.kernels.model import Model
from lcpstep.kernels.status import DONE, LCP_FAILED, NOT_FINITE
from lcpstep.kernels.stiction import rest_where_possible, solve_steps
from lcpstep.kernels.vectors import finite, largest, product, size_of_product
from lcpstep.pointers import Doubles, Indices, abs, after, max
from lcpstep.stepping.steps import CANCELLED, CONVERGED, NO_APPROACH, RESTING, ROUNDING
from lcpstep.stepping.theta_method.codes import NEED_LCP
from lcpstep.stepping.theta_method.joint_rows import distribute, eliminate, lost
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.reached import reach
from lcpstep.stepping.theta_method.responses import respond
from lcpstep.stepping.theta_method.turned_rows import put_rows_on_joints, sweep_out_turned

ALIKE = 1e-6  # relative: velocities that two ways to share a load leave, where both are found by turns,
LESS = 0.5  # which is where they change by no less than this share of the last change
LEAVES = 1e-9  # of the terms of a rate: what joints may leave of it where they leave nothing of its row


def impulses(m: Model, plan: Plan, s: State, c: Rows, n_a: int, t_next: float, rebounds: bool) -> int:
    """Impulses of the rows that take part, for the velocities before the blow at hand and the position at hand."""
    impact = pose(m, plan, s, c, n_a, t_next, rebounds)
    n_k, rate, ids = n_a + c.n_f + c.n_j, c.problem.rate, c.problem.ids
    if not (finite(rate, n_k) and (plan.constant or usable(plan.W, ids, n_k, c.n))):
        return NOT_FINITE
    if n_a > 0:
        if c.external and not c.solved:
            return NEED_LCP
        s.problems += 1
        if not c.solved and not solve(m, s, c, n_a, c.n_f, t_next, impact):
            forget_tiny(c.problem.rate, n_a + c.n_f)
            if not solve(m, s, c, n_a, c.n_f, t_next, impact):
                impact = pose(m, plan, s, c, n_a, t_next, False)
                if not search(m, s, c, n_a, t_next, impact):
                    return LCP_FAILED
        if c.n_j > 0 and loads_nothing(s, c, n_a):
            return LCP_FAILED
    distribute(c.elimination, c.problem.impulse, ids, n_a + c.n_f, n_k, c.p, c.n)
    return DONE


def pose(m: Model, plan: Plan, s: State, c: Rows, n_a: int, t_next: float, rebounds: bool) -> bool:
    """The problem of the rows that take part, joints eliminated; whether it is an impact, as `rates` says."""
    impact = without_joints(m, plan, s, c, n_a, rebounds)
    if c.turning and put_rows_on_joints(c.elimination, m, plan, s, c, n_a, n_a + c.n_f, t_next):
        respond(m.linear, plan, s, c, n_a + c.n_f + c.n_j)
        impact = without_joints(m, plan, s, c, n_a, rebounds)
    if c.n_j > 0 and leave_out_what_bears_nothing(c, n_a):
        impact = without_joints(m, plan, s, c, n_a, rebounds)
    if impact and rebounds and not c.in_turn:
        tie_tangents(m, c, n_a)
    return impact


def tie_tangents(m: Model, c: Rows, n_a: int) -> None:
    """Where a tangent can only move with its normal, so did it before the blow.

    As of a mechanism of one coordinate. Rows before the step are others, by O(h), and where friction jams no impulse
    answers what these leave of the sliding when the normal has got its rebound.
    """
    R, rate, n = c.problem.mobility, c.problem.rate, n_a + c.n_f
    for f in range(c.n_f):
        k, T = c.problem.carrier[f], n_a + f
        R_NN, R_TT, R_TN = R[k * n + k], R[T * n + T], R[T * n + k]
        u = c.blows.u[c.problem.ids[k]]
        if abs(R_NN * R_TT - R[k * n + T] * R_TN) <= DEGENERATE * R_NN * R_TT and abs(u) > c.blows.least:
            r = c.tangent_restitution[c.problem.ids[k]]
            own = rate[T] - r * c.blows.sliding[c.problem.ids[k]]
            with_normal = R_TN / R_NN * (rate[k] - m.restitution[c.problem.ids[k]] * u)
            belt = own - with_normal
            if abs(belt) <= ROUNDING * (abs(own) + abs(with_normal)):
                belt = 0.0
            rate[T] = with_normal + belt + r * (R_TN / R_NN * u + belt)


def without_joints(m: Model, plan: Plan, s: State, c: Rows, n_a: int, rebounds: bool) -> bool:
    """Mobilities and rates of contacts and tangents that take part, joints after them eliminated; is it an impact?

    A row that says what joints say has nothing left but the rounding of its rate, which no impulse could change.
    """
    impact, n, n_k = rates(m, s, c, n_a, rebounds), n_a + c.n_f, n_a + c.n_f + c.n_j
    R, rate, ids = c.problem.mobility, c.problem.rate, c.problem.ids
    eliminate(c.elimination, plan.W, c.n, c.H, plan.X, s.n_q, ids, n, n_k, R, rate)
    if c.turning and c.elimination.swept:
        sweep_out_turned(c.elimination, m.linear, plan, s, c, n, n_k)
    if c.n_j > 0:
        for k in range(n):
            if not R[k * n + k] > 0.0 and abs(rate[k]) <= LEAVES * size_of_rate(c, c.blows.v, ids[k], s.n_q):
                rate[k] = 0.0
    return impact


def leave_out_what_bears_nothing(c: Rows, n_a: int) -> bool:
    """Leave out the tangents of contacts whose normals the joints hold already, as theirs; were there any?"""
    n_f, ids, carrier = 0, c.problem.ids, c.problem.carrier
    for f in range(c.n_f):
        k = carrier[f]
        if c.problem.mobility[k * (n_a + c.n_f) + k] > 0.0:
            carrier[n_f], ids[n_a + n_f] = k, ids[n_a + f]
            n_f += 1
    if n_f == c.n_f:
        return False
    for j in range(c.n_j):
        ids[n_a + n_f + j] = ids[n_a + c.n_f + j]
    c.n_f = n_f
    return True


def loads_nothing(s: State, c: Rows, n_a: int) -> bool:
    """Whether a contact bears of whose row joints have left next to nothing."""
    for k in range(n_a):
        if c.problem.impulse[k] > 0.0 and lost(c.elimination, c.H, s.n_q, c.problem.ids[k], k):
            return True
    return False


def rates(m: Model, s: State, c: Rows, n_a: int, rebounds: bool) -> bool:
    """What the impulses are asked for, of every row that takes part; whether friction, or contacts in turn, take it
    as an impact: without these nobody asks.

    `c.blows.v` and `c.blows.u` are `s.v_free` and `s.u` (`Blows.begin`), unless blows follow one another. What is
    held from all sides cannot leave every obstacle as its restitution asks: where no impulses answer, they are asked
    for an end of the approach alone, up to its rounding.
    """
    ids, rate, n_f, impact = c.problem.ids, c.problem.rate, c.n_f, False
    for k in range(n_a + n_f + c.n_j):
        rate[k] = product(c.H, c.blows.v, ids[k], s.n_q) + c.H_t[ids[k]]
    if n_f > 0 or c.in_turn:
        round_off(c, c.blows.v, n_a + n_f, s.n_q)
        impact = strikes(s, c, n_a)
    if not rebounds:
        for k in range(n_a):
            rate[k] += ROUNDING * size_of_rate(c, c.blows.v, ids[k], s.n_q)
    elif not c.in_turn:
        for k in range(n_a):
            u = c.blows.u[ids[k]]
            if c.blows.taken > 0 and -c.blows.slow <= u <= 0.0:
                rate[k] = 0.0  # what forces move is the next step's: this blow may not close it faster
            else:
                rate[k] += (m.restitution[ids[k]] if abs(u) > c.blows.least else 0.0) * u
        for f in range(n_f if impact else 0):
            i = ids[c.problem.carrier[f]]
            rate[n_a + f] += c.tangent_restitution[i] * c.blows.sliding[i]
    return impact


def solve(m: Model, s: State, c: Rows, n_a: int, n_f: int, t_next: float, impact: bool) -> bool:
    """Impulses of the contacts from their rates; False where there are none."""
    if impact and c.in_turn:
        c.coefficients.use(c.problem.mu)
        for k in range(n_a):
            c.problem.slow[k] = max(c.problem.slow[k], c.blows.least)
            c.problem.made[k] = max(0.0, c.blows.u[c.problem.ids[k]] - c.problem.rate[k])
        return strike_in_turn(c.problem, m.restitution, n_a, n_f, -1)
    if n_f > 0 and c.coefficients.two:
        if impact:
            for k in range(n_a):
                c.problem.sum[k] = 1.0 if c.blows.u[c.problem.ids[k]] < -c.problem.slow[k] else 0.0
            if not reach(m, s, c, n_a, n_f, t_next):
                return False
        return solve_steps(c.problem, c.coefficients, s.sticks, c.sliding, n_a, n_f, impact)
    found = solve_contacts(c.problem, n_a, n_f)
    if found and n_f > 0 and not impact:
        rest_where_possible(c.problem, s.sticks, c.sliding, n_a, n_f)
    return found


def search(m: Model, s: State, c: Rows, n_a: int, t_next: float, impact: bool) -> bool:
    """The same, for seconds if need be: the run would end here.

    Of rows that nearly say the same, as of the ends of links above a floor, few starts lead to the impulses.
    """
    if solve(m, s, c, n_a, c.n_f, t_next, impact):
        return True
    c.problem.work.thorough = True
    found = solve(m, s, c, n_a, c.n_f, t_next, impact)
    c.problem.work.thorough = False
    return found


def note_sticking(s: State, c: Rows, n_a: int, n_f: int) -> None:
    """Which contacts do not slide at the end of the step, those among them that nothing presses at the moment.

    Of more feet than a body stands on some carry no load: they may be needed to hold it in the next step.
    """
    for i in range(s.n_c):
        s.sticks[i] = 0
    for f in range(n_f):
        i = c.problem.ids[c.problem.carrier[f]]
        u = c.T_t[i] + product(c.T, s.next_v, i, s.n_q)
        _, size = motion_of(c.problem, c.problem.impulse, n_a + f, n_a + n_f)
        size += size_of_rate(c, s.next_v, c.n_c + i, s.n_q)
        s.sticks[i] = 1 if abs(u) <= NO_APPROACH * size else 0


def take_part(c: Rows, n_a: int) -> None:
    """List after the normals of active contacts the tangents of the n_f frictional ones, and all joints."""
    n_f, ids = 0, c.problem.ids
    for k in range(n_a if c.n_t > 0 else 0):
        if c.coefficients.rough[ids[k]] == 1:
            c.problem.carrier[n_f], ids[n_a + n_f] = k, c.n_c + ids[k]
            n_f += 1
    for j in range(c.n_j):
        ids[n_a + n_f + j] = c.n_c + c.n_t + j
    c.n_f = n_f


def round_off(c: Rows, v: Doubles, n_k: int, n_q: int) -> None:
    """Rates of contacts and tangents that are nothing but rounding are zero.

    For a frictional contact that stays closed has no approach: whether it jams must not hang on a rounding's sign.
    """
    for k in range(n_k):
        if not abs(c.problem.rate[k]) > NO_APPROACH * size_of_rate(c, v, c.problem.ids[k], n_q):
            c.problem.rate[k] = 0.0


def forget_tiny(rate: Doubles, n: int) -> None:
    """Rates of what lies at rest, next to those of a blow, are zero: no solver finds impulses for both."""
    least = ROUNDING * largest(rate, 0.0, n)
    for k in range(n):
        if abs(rate[k]) <= least:
            rate[k] = 0.0


def size_of_rate(c: Rows, v: Doubles, i: int, n_q: int) -> float:
    """Size of what the rate of row i is a sum of."""
    return abs(c.H_t[i]) + size_of_product(c.H, v, i, n_q)


def usable(W: Doubles, ids: Indices, n_k: int, n: int) -> bool:
    """Whether the mobilities are finite."""
    total = 0.0
    for k in range(n_k):
        for m in range(n_k):
            total += W[ids[k] * n + ids[m]] - W[ids[k] * n + ids[m]]
    return total == 0.0


def strikes(s: State, c: Rows, n_a: int) -> bool:
    """Whether a contact closes faster than the forces of one step could move it; rates are without restitution."""
    size_v, ids, found = largest(s.v, 0.0, s.n_q), c.problem.ids, False
    for k in range(n_a):
        c.problem.slow[k] = forced(s, c, ids[k], c.problem.rate[k], size_v)
        found = found or c.blows.u[ids[k]] < -c.problem.slow[k]
    return found


def forced(s: State, c: Rows, i: int, rate: float, size_v: float) -> float:
    """How far the forces of a step move the gap velocity of contact i, to `rate`, and the rounding of it."""
    return abs(rate - c.blows.u[i]) + ROUNDING * largest(after(c.H, i * s.n_q), 0.0, s.n_q) * size_v


def apply(plan: Plan, s: State, c: Rows, n_k: int) -> bool:
    """next_v = v_free + X^T p; whether that has hardly changed it.

    Where friction acts, a velocity that is nothing but rounding is zero: what sticks is at rest.
    """
    n_q, ids, X, p = s.n_q, c.problem.ids, plan.X, c.p
    change = size = moved = 0.0
    for i in range(n_q):
        total, terms = s.v_free[i], abs(s.v_free[i])
        for k in range(n_k):
            term = X[ids[k] * n_q + i] * p[ids[k]]
            total += term
            terms += abs(term)
        if c.n_f > 0 and abs(total) <= ROUNDING * terms:
            total = 0.0
        change = max(change, abs(total - s.next_v[i]))
        moved = max(moved, plan.h * abs(total - s.next_v[i]))
        size = max(max(size, abs(total)), max(abs(s.v[i]), CANCELLED * terms))
        s.next_v[i] = total
    s.moved = max(0.0, moved - RESTING * largest(s.q, 0.0, n_q))
    if c.n_j > 0 and change > LESS * s.changed and change <= ALIKE * size:
        s.moved = 0.0
    s.changed = change
    return change <= CONVERGED * size


def apply_once(plan: Plan, s: State, c: Rows, n_k: int) -> None:
    """next_v = v_free + X^T p without friction, where one pass is enough."""
    n_q, ids, X, p = s.n_q, c.problem.ids, plan.X, c.p
    for i in range(n_q):
        total = s.v_free[i]
        for k in range(n_k):
            total += X[ids[k] * n_q + i] * p[ids[k]]
        s.next_v[i] = total
