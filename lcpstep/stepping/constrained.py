"""The loop of the theta-method for scenes with joints or friction, or with projected positions, as kernels.

The step is that of `theta`, with more rows in its problem. Normals G, tangents T and joints G_J act together:

    v+ = v_free + A^-1 (G^T p_N + T^T p_T + D_J^T p_J),        D_J = theta G_J(q+) + (1 - theta) G_J(q)
    G_J v+ + g_t = 0                            joints (see `joints`)
    law of contact, friction and impact         see `friction`

The joints' rows are taken at the end of the step, which is iterated for; their force acts along the average of
its two ends, which makes the step of second order for theta = 1/2 where nothing strikes. Restitution on the tangent
belongs to impacts: it is left out in steps in which no contact closes faster than the forces of one step could move
it, so that what slides comes to rest.

Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 10.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, inline
from lcpstep.dense import assign, solve
from lcpstep.dynamics import gap_rates, gaps, product
from lcpstep.stepping.friction import solve_contacts
from lcpstep.stepping.joints import distribute, eliminate
from lcpstep.stepping.newton import linearise
from lcpstep.stepping.projection import DONE, NO_POSITION, project
from lcpstep.stepping.rows import (
    apply,
    average,
    joints_hold,
    mobilities,
    position,
    rates,
    restitute,
    take_part,
    usable,
)
from lcpstep.stepping.theta import (
    CONVERGED,
    EVENT,
    FINISHED,
    FORCES,
    ITERATION,
    LCP_CALLS,
    LCP_FAILED,
    LOG_FULL,
    MAX_ITERATIONS,
    NEWTON_FAILED,
    NOT_FINITE,
    STEP,
    advance,
    finite,
    keep,
    keep_times,
    linear_free_velocity,
    log_events,
    predict_active,
    predicted_rates,
)

JOINTS_FAILED, PROJECTION_FAILED = 6, 7  # why the loop returned, besides the reasons in `theta`


@by_address
class Constraints(NamedTuple):
    """Joints and tangents of a scene, and the rows of a step: all normals first, then tangents, then joints.

    The rows of H and their g_t are the state's G and g_t, then T, T_t, then J, J_t, without copies.
    """

    joints: Any  # models: see `lcpstep.model`
    tangents: Any
    tangent_restitution: Any  # (n_c,)
    constant: bool  # the rows never change
    projected: bool
    first_joint: int
    H: Any  # (n, n_q) rows of the velocities
    H_t: Any  # (n,) their g_t
    T: Any  # (n_c or 0, n_q)
    T_t: Any
    J: Any  # (n_j, n_q)
    J_t: Any
    J_start: Any
    D: Any  # (n_j, n_q) rows of the joints' forces
    X: Any  # (n, n_q) A^-1 times the rows of the forces
    W: Any  # (n, n) mobilities, H A^-1 (G, T, D)^T
    b: Any  # (n,) rates without impulses, with restitution
    p: Any  # (n,) impulses
    ids: Any  # (n,) the rows that take part: normals, tangents, joints
    sliding: Any  # (n_c or 0,) sliding velocities at the start of the step
    near: Any  # (n_c,) contacts that the projection looks at
    gaps: Any  # (n_c,)
    joint_gaps: Any  # (n_j,)
    M: Any  # (n_q, n_q)
    failed: Any  # (n_j,) 1 for joints that contradict others
    problem: Any  # see `friction.Problem`
    joint_work: Any


def run(
    model: Any,
    plan: Any,
    state: Any,
    record: Any,
    count: Any,
    t0: float,
    first: int,
    last: int,
    c: Any,
) -> int:
    """Steps count[STEP] .. last - 1, step `first` beginning at t0; says why it returned."""
    n_c, n = len(state.u), len(c.p)
    if c.constant:
        constant_rows(model, plan, state, c, t0)
    while count[STEP] < last:
        if count[EVENT] + 2 * n_c > len(record.events):
            return LOG_FULL
        t, t_next = t0 + plan.h * (count[STEP] - first), t0 + plan.h * (count[STEP] + 1 - first)
        n_a, before = predict_active(plan, state), -1
        code = FINISHED
        while n_a > before and code == FINISHED:
            before = n_a
            code = step(model, plan, state, c, count, n_a, t, t_next)
            if c.projected and n_c > 0:
                n_a = closes_again(model, plan, state, c, n_a, t_next)
        if code != FINISHED:
            return code
        events = log_events(model, plan, state, record, count, t_next)
        for i in range(n_c, n):
            state.impulse[i] += c.p[i]
        if c.projected:
            found = project(model, plan, state, c, t_next)
            if found != DONE:
                return PROJECTION_FAILED if found == NO_POSITION else LCP_FAILED
        keep_times(plan, state, record, count, t, t_next)
        advance(model, state, t_next)
        count[STEP] += 1
        if not (finite(state.g) and finite(state.u)):
            return NOT_FINITE
        if (record.every > 0 and count[STEP] % record.every == 0) or (record.on_events and events):
            keep(state, record, count, t_next)
    return FINISHED


@inline
def step(model: Any, plan: Any, state: Any, c: Any, count: Any, n_a: int, t: float, t_next: float) -> int:
    """One step with n_a active contacts into next_q, next_v, and the impulses."""
    n_j = len(c.J_t)
    n_f = take_part(state.active, c.problem.mu, c.ids, c.problem.carrier, n_a, len(c.T_t), n_j)
    n_k = n_a + n_f + n_j
    if n_a > 0:
        predicted_rates(model, plan, state, t_next)
    if n_f > 0:
        tangent_rates(c.tangents, state.q, state.v, state.next_q, t, t_next, c.T, c.T_t, c.sliding)
    if n_j > 0:
        gap_rates(c.joints, t, state.q, state.v, c.J_start, c.J_t)
    assign(state.next_v, state.v)
    for i in range(len(c.p)):
        c.p[i] = 0.0
    iterate = not model.linear or not c.joints.flat
    if model.linear:
        linear_free_velocity(model, plan, state, t_next)
        count[FORCES] += 1
    count[ITERATION] = 0
    while True:
        position(plan.h, plan.theta, state.q, state.v, state.next_v, state.next_q)
        if not model.linear and not linearise(model, plan, state, t, t_next, False, count):
            return NOT_FINITE
        if not finite(state.v_free):
            return NOT_FINITE
        if n_k > 0:
            code = impulses(model, plan, state, c, count, n_a, n_f, n_k, t_next)
            if code != FINISHED:
                return code
        change = apply(state.v, state.v_free, c.X, c.p, c.ids, n_f, n_k, state.next_v)
        if not iterate or change <= CONVERGED:
            break
        count[ITERATION] += 1
        if count[ITERATION] >= MAX_ITERATIONS:
            return NEWTON_FAILED
    assign(state.p, c.p[: len(state.p)])
    position(plan.h, plan.theta, state.q, state.v, state.next_v, state.next_q)
    if n_j == 0:
        return FINISHED
    turning = 0.0 if c.joints.flat else 1.0
    hold = joints_hold(
        c.J, c.J_t, c.J_start, state.v, state.v_free, state.next_v, c.X, c.p, turning, c.failed
    )
    return FINISHED if hold else JOINTS_FAILED


@inline
def impulses(
    model: Any, plan: Any, state: Any, c: Any, count: Any, n_a: int, n_f: int, n_k: int, t_next: float
) -> int:
    """Impulses of the rows that take part, for the velocity v_free and the position at hand."""
    if n_k > n_a + n_f:
        gap_rates(c.joints, t_next, state.next_q, state.next_v, c.J, c.J_t)
    if not c.constant:
        average(c.J, c.J_start, plan.theta, c.D)
        for k in range(n_k):
            i = c.ids[k]
            row = c.H[i] if i < c.first_joint else c.D[i - c.first_joint]
            compliance(model.linear, plan, state.newton, row, c.X[i])
        mobilities(c.H, c.X, c.ids, n_k, c.W)
    rates(c.H, c.H_t, state.v_free, c.ids, n_k, n_a + n_f if n_f > 0 else 0, c.b)
    if not usable(c.b, c.W, c.ids, n_k):
        return NOT_FINITE
    restitute(
        state.u,
        c.sliding,
        state.v,
        c.H,
        model.restitution,
        c.tangent_restitution,
        c.ids,
        c.problem.carrier,
        n_a,
        n_f,
        c.b,
    )
    eliminate(c.joint_work, c.W, c.b, c.ids, n_a + n_f, n_k, c.problem.R, c.problem.reduced)
    if n_a > 0:
        count[LCP_CALLS] += 1
        if not solve_contacts(c.problem, n_a, n_f):
            return LCP_FAILED
    distribute(c.joint_work, c.problem.solution, c.ids, n_a + n_f, n_k, c.p)
    return FINISHED


@inline
def closes_again(model: Any, plan: Any, state: Any, c: Any, n_a: int, t_next: float) -> int:
    """Make those contacts active that were left out, were closed before, and are entered; how many are active.

    A projected gap is zero, not below, so that the prediction g + (h/2) u alone would open what rests.
    """
    gaps(model, t_next, state.next_q, state.next_v, c.gaps)
    more = n_a
    for i in range(len(state.u)):
        entered = state.closed[i] > 0 and c.gaps[i] < -plan.slack
        for k in range(n_a):
            entered = entered and state.active[k] != i
        if entered:
            state.active[more] = i
            more += 1
    return more


@inline
def tangent_rates(
    tangents: Any, q: Any, v: Any, q_next: Any, t: float, t_next: float, T: Any, T_t: Any, sliding: Any
) -> None:
    """Sliding velocities at the start of the step; T and T_t at its end, where it is predicted."""
    gap_rates(tangents, t, q, v, T, T_t)
    for i in range(len(sliding)):
        sliding[i] = product(T, v, i) + T_t[i]
    gap_rates(tangents, t_next, q_next, v, T, T_t)


@inline
def compliance(linear: bool, plan: Any, newton: Any, row: Any, out: Any) -> None:
    """Out <- A^-1 row."""
    assign(out, row)
    if not linear:
        solve(newton.A, newton.pivots, out)
        return
    for i in range(len(row)):
        out[i] = 0.0
        for j in range(len(row)):
            out[i] += plan.A_f[i, j] * row[j]
        out[i] /= plan.h


@inline
def constant_rows(model: Any, plan: Any, state: Any, c: Any, t: float) -> None:
    """All rows and mobilities of a scene in which they never change."""
    gap_rates(model, t, state.q, state.v, state.G, state.g_t)
    gap_rates(c.tangents, t, state.q, state.v, c.T, c.T_t)
    gap_rates(c.joints, t, state.q, state.v, c.J, c.J_t)
    for i in range(len(c.p)):
        compliance(True, plan, state.newton, c.H[i], c.X[i])
        c.ids[i] = i
    mobilities(c.H, c.X, c.ids, len(c.p), c.W)
