"""One step of the Moreau theta-method, from t to t + h, with contacts, tangents and joints as rows of one problem.

    v_free  velocity without contact (a theta-method: linear systems by constant matrices, others by Newton)
    active  contacts whose predicted gap g + (h/2) u is not positive, but for what rounding, or the error of steps
            by a tolerance, may have opened closed ones by
    p       0 <= u+ + r u  complementary to  p_N >= 0   on the active contacts,  u+ = G v+ + g_t;  blow after blow
            where some of these separate while others strike, without those that separate: see `blows`
            law of friction and impact on their tangents, see `kernels.coulomb`
            G_J v+ + g_t = 0  on joints, see `joint_rows`
    v+      v_free + A^-1 (G^T p_N + T^T p_T + D_J^T p_J),        D_J = theta G_J(q+) + (1 - theta) G_J(q)
    q+      q + h [theta v+ + (1 - theta) v]

For moving obstacles g_t is taken at the end of the step in u+ and at its start in u, so that relative and absolute
coordinates obey the same law. The joints' rows are taken at the end of the step, which is iterated for; their force
acts along the average of its two ends, which makes the step of second order for theta = 1/2 where nothing strikes.
Rows of contacts are of the position that the velocity at the start leads to, but at the end of the step beside joints
that turn: a normal that is always one of theirs must be theirs in the step (`turned_rows`).
Restitution on the tangent belongs to impacts: it is left out in steps in which no contact closes faster than the
forces of one step could move it, so that what slides comes to rest.

Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.17-3.34; V. Acary, B. Brogliato, Numerical
Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 10.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import RELEASE
from lcpstep.kernels.dynamics import external_force, gap_rates, gaps
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import DONE, JOINTS_FAILED, NEWTON_FAILED, NOT_FINITE
from lcpstep.kernels.vectors import add, clear, copy, finite, product, size_of_product
from lcpstep.pointers import abs, after, max, whole
from lcpstep.stepping.steps import RESTING, UNTOLD
from lcpstep.stepping.theta_method.blows import one_after_another, separates
from lcpstep.stepping.theta_method.codes import MAX_ITERATIONS, NO_EVENT
from lcpstep.stepping.theta_method.idle import leave_out_idle, take_back_idle
from lcpstep.stepping.theta_method.implicit import linearise
from lcpstep.stepping.theta_method.joint_rows import joints_hold
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.one_contact import closed_since, kind_of
from lcpstep.stepping.theta_method.repair import project
from lcpstep.stepping.theta_method.responses import prepare
from lcpstep.stepping.theta_method.row_impulses import (
    apply,
    apply_once,
    impulses,
    note_sticking,
    take_part,
)

SETTLED = 6  # iterations after which impulses are sought where the last were: others may be as good
UNDECIDED = 14  # iterations after which loads are shared by turns: contacts that bear nothing are left out


def take_step(m: Model, plan: Plan, s: State, c: Rows, t: float, t_next: float) -> int:
    """One step into next_q, next_v and the impulses; its events are noted. Says how it went."""
    if not c.solved:
        predict_active(m, plan, s, c, t)
    code = step(m, plan, s, c, t, t_next)
    while c.projected and code == DONE and closes_again(m, s, c, t_next):
        code = step(m, plan, s, c, t, t_next)
    if code != DONE:
        return code
    log_events(m, s, c, t_next)
    add(s.impulse, 1.0, c.p, c.n)
    return project(m, plan, s, c, t_next) if c.projected else DONE


def predict_active(m: Model, plan: Plan, s: State, c: Rows, t: float) -> None:
    """Contacts with g + (h/2) u <= 0, up to rounding, are active: first of the rows that take part."""
    n_a = 0
    for i in range(c.n_c):
        far = size_of_product(m.G if m.flat else c.H, s.q, i, s.n_q) if s.closed[i] > 0 else 0.0
        s.far[i] = max(s.far[i], far) if s.closed[i] > 0 else 0.0
        gap = s.g[i] + 0.5 * plan.h * s.u[i]
        held = s.opened if s.closed[i] > 1 else 0.0
        if gap <= s.slack[i] + held or (s.closed[i] > 0 and gap <= s.slack[i] + drifted(m, plan, s, c, i, t)):
            c.problem.ids[n_a] = i
            n_a += 1
    s.active = n_a


def drifted(m: Model, plan: Plan, s: State, c: Rows, i: int, t: float) -> float:
    """How far rounding may have opened a closed gap: each step rounds the coordinates, which may have been far away.

    It rounds velocities too, to what the impulses of the last step, which cancel, have each made of them; and times,
    so that an obstacle has moved for a little longer or shorter than the body on it.
    """
    size, n, G = 0.0, s.n_q, m.G if m.flat else c.H
    for j in range(n):
        pushed = 0.0
        for k in range(c.n_c):
            if c.p[k] > 0.0:
                pushed += abs(plan.X[k * n + j]) * c.p[k]
        size += abs(G[i * n + j]) * plan.h * pushed
    return (RESTING + RESOLUTION * s.steps) * (s.far[i] + size) + UNTOLD * abs(t * c.H_t[i])


def closes_again(m: Model, s: State, c: Rows, t_next: float) -> bool:
    """Add to the active ones those contacts that were closed before, and are entered; were there any?

    A projected gap is zero, not below, so that the prediction g + (h/2) u alone would open what rests.
    """
    if c.n_c > 0:
        gaps(m, t_next, s.next_q, s.next_v, c.gaps)
    n_a = more = s.active
    for i in range(c.n_c):
        entered = s.closed[i] > 0 and c.gaps[i] < -s.slack[i]
        for k in range(n_a):
            entered = entered and c.problem.ids[k] != i
        if entered:
            c.problem.ids[more] = i
            more += 1
    s.active = more
    return more > n_a


def step(m: Model, plan: Plan, s: State, c: Rows, t: float, t_next: float) -> int:
    """One step with the active contacts into next_q, next_v, and the impulses; nothing is predicted or logged.

    It may be made several times, as by `closes_again`, and anew once a named solver has solved its problem.
    """
    if not begin_step(m, plan, s, c, t, t_next):
        return NOT_FINITE
    code = iterate(m, plan, s, c, t, t_next)
    if code != DONE:
        return code
    position(plan, s)
    if c.n_j == 0:
        return DONE
    hold = joints_hold(
        c.J, c.J_t, c.J_start, c.n_j, s.v, s.v_free, s.next_v, s.n_q, plan.X, c.p, c.n, c.turning, c.failed
    )
    return DONE if hold else JOINTS_FAILED


def begin_step(m: Model, plan: Plan, s: State, c: Rows, t: float, t_next: float) -> bool:
    """Rows that take part, and what an iteration does not change of them; False where they are not finite."""
    c.n_f = 0
    if c.n > c.n_c:
        take_part(c, s.active)
    if s.active > 0:
        for i in range(s.n_q):  # where the velocity at the start leads to
            s.next_q[i] = s.q[i] + plan.h * s.v[i]
        gap_rates(m, t_next, s.next_q, s.v, c.H, c.H_t)
    if c.n_f > 0 and not tangent_rates(s, c, t, t_next):
        return False
    if c.n_j > 0:
        gap_rates(c.joints, t, s.q, s.v, c.J_start, c.J_t)
    if s.active + c.n_j == 0:
        clear(c.p, c.n)
    if not c.solved:
        copy(s.next_v, s.v, s.n_q)
        s.iteration = 0
    if m.linear:
        free_velocity(m, plan, s, t_next)
    return True


def iterate(m: Model, plan: Plan, s: State, c: Rows, t: float, t_next: float) -> int:
    """Velocity and impulses of the step: one pass of a linear system, else until the velocity changes no more."""
    idle, once = 0, m.linear and not c.turning
    while True:
        code = find_impulses(m, plan, s, c, t, t_next)
        if code != DONE:
            return code
        n_k = s.active + c.n_f + c.n_j
        if once and c.n_f == 0:
            apply_once(plan, s, c, n_k)
            break
        if apply(plan, s, c, n_k) or once:
            break
        s.iteration += 1
        if s.moved == 0.0 and s.iteration >= (UNDECIDED if c.n_j > 0 else MAX_ITERATIONS):
            break  # forces that cancel, or loads shared by turns, at places which nothing tells apart
        if s.iteration >= MAX_ITERATIONS:
            return NEWTON_FAILED
        if s.iteration >= UNDECIDED and c.n_j > 0:
            idle = leave_out_idle(s, c, idle)
    if c.coefficients.two or c.n_f > 1:
        note_sticking(s, c, s.active, c.n_f)
    return DONE if idle == 0 or take_back_idle(s, c, idle) else NEWTON_FAILED


def find_impulses(m: Model, plan: Plan, s: State, c: Rows, t: float, t_next: float) -> int:
    """Velocity without contact, and impulses of the rows that take part, from the velocity found so far."""
    if c.n_j > 0:
        position(plan, s)
    if not m.linear and not linearise(m, plan, s, t, t_next):
        return NOT_FINITE
    if not finite(s.v_free, s.n_q):
        return NOT_FINITE
    if s.active + c.n_j == 0:
        return DONE
    c.problem.again = s.iteration >= SETTLED
    if not c.solved:
        c.blows.several = s.active > 1 and not c.in_turn and separates(plan, s, c, c.blows, s.active)
    if c.blows.several:
        code = one_after_another(m, plan, s, c, c.blows, t_next)
    else:
        if c.n_j > 0 or not plan.constant:
            prepare(m, plan, s, c, s.active, t_next)
        code = impulses(m, plan, s, c, s.active, t_next, True)
    c.solved = c.solved and code != DONE
    return code


def position(plan: Plan, s: State) -> None:
    """Q + h [theta v+ + (1 - theta) v]."""
    h, theta = plan.h, plan.theta
    for i in range(s.n_q):
        s.next_q[i] = s.q[i] + h * (theta * s.next_v[i] + (1.0 - theta) * s.v[i])


def tangent_rates(s: State, c: Rows, t: float, t_next: float) -> bool:
    """Sliding velocities at the start of the step; T and T_t at its end, where it is predicted.

    False where they have no coefficients of friction.
    """
    gap_rates(c.tangents, t, s.q, s.v, c.T, c.T_t)
    for i in range(c.n_t):
        c.sliding[i] = product(c.T, s.v, i, s.n_q) + c.T_t[i]
        c.at_rest[i] = 0.0 if s.sticks[i] == 1 else c.sliding[i]
    gap_rates(c.tangents, t_next, s.next_q, s.v, c.T, c.T_t)
    return c.coefficients.measure(t, s.q, c.at_rest)


def free_velocity(m: Model, plan: Plan, s: State, t_next: float) -> None:
    """v_free = v + A^-1 (-h C v - h K q - h^2 theta K v + h [theta F(t+h) + (1-theta) F(t)])."""
    n, theta = s.n_q, plan.theta
    external_force(m, t_next, s.q, s.v, s.next_force)
    s.forces += 1
    for i in range(n):
        total, low, high = s.v[i], 0, n
        if not plan.stiff:
            low, high = m.M_ends[2 * i], m.M_ends[2 * i + 1]
        for j in range(low, high):
            k = i * n + j
            total += (
                plan.A_f[k] * (theta * s.next_force[j] + (1.0 - theta) * s.force[j])
                - plan.A_q[k] * s.q[j]
                - plan.A_v[k] * s.v[j]
            )
        s.v_free[i] = total


def log_events(m: Model, s: State, c: Rows, t_next: float) -> None:
    """Note impacts, the beginning of lasting contact, and its end; count the steps that contacts have been closed."""
    first, released = s.record.event, False
    for i in range(c.n_c):
        kind = kind_of(c.p[i], s.closed[i])
        s.closed[i] = closed_since(c.p[i], s.closed[i])
        released = released or kind == RELEASE
        if kind != NO_EVENT:
            u = 0.0 if kind == RELEASE else product(c.H, s.next_v, i, s.n_q) + c.H_t[i]
            s.record.note(t_next, i, s.u[i], u, c.p[i], kind)
    if not released:
        return
    # Rows at hand are those of contacts that took part in the law: a release has its velocity from rows of now
    gap_rates(m, t_next, s.next_q, s.next_v, c.H, c.H_t)
    for k in range(first, s.record.event):
        line = after(s.record.events, k * COLUMNS)
        if line[5] == RELEASE:
            line[3] = product(c.H, s.next_v, whole(line[1]), s.n_q) + c.H_t[whole(line[1])]
