"""The loop of the Moreau theta-method, as kernels.

One step from t to t + h:

    v_free  velocity without contact (a theta-method: linear systems by constant matrices, others by Newton)
    active  contacts whose predicted gap g + (h/2) u is not positive
    p       0 <= u+ + r u  complementary to  p >= 0   on the active contacts,  u+ = G v+ + g_t
    v+      v_free + A^-1 G^T p,      q+ = q + h [theta v+ + (1 - theta) v]

Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.17-3.34; V. Acary, B. Brogliato, Numerical
Methods for Nonsmooth Dynamical Systems (Springer 2008). For moving obstacles g_t is taken at the end of the step
in u+ and at its start in u, so that relative and absolute coordinates obey the same law.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call_solver, inline
from lcpstep.dense import assign
from lcpstep.dynamics import external_force, gap_rates, gaps, obstacle, product, total_force
from lcpstep.recording import quiet_until, write_event, write_row
from lcpstep.stepping.newton import linearise

# Why the loop returned
FINISHED, LOG_FULL, NEED_LCP, NOT_FINITE, LCP_FAILED, NEWTON_FAILED = range(6)
# Places in the array of counters
STEP, ROW, EVENT, LCP_CALLS, FORCES, ITERATION, NEXT_TIME = range(7)
N_COUNTERS = 7
# Kinds of events, the values of `trajectory.Kind`
IMPACT, STICK, RELEASE = 0, 2, 3
MAX_ITERATIONS = 25  # of Newton, per step
LATE = 1e-9  # of a step: what rounding may take from the last one's end
CONVERGED = 1e-12  # change of the velocity, relative to it
CANCELLED = 0.1  # of the terms that it is the sum of: near rest it cannot be known better than these


@by_address
class Plan(NamedTuple):
    """What a step multiplies with. Constant for linear systems, made anew in each step for the others."""

    h: float
    theta: float
    A_q: Any  # (n_q, n_q)  A^-1 h K
    A_v: Any  # (n_q, n_q)  A^-1 (h C + h^2 theta K)
    A_f: Any  # (n_q, n_q)  h A^-1
    A_g: Any  # (n_q, n_c)  A^-1 G^T
    W: Any  # (n_c, n_c)  G A^-1 G^T, the Delassus matrix
    slack: float  # a predicted gap this small is closed: rounding must not open what rests


@by_address
class State(NamedTuple):
    """Where the motion is, and the work space of a step."""

    q: Any
    v: Any
    g: Any  # (n_c,) gaps
    u: Any  # (n_c,) gap velocities
    closed: Any  # (n_c,) 0 open, 1 struck in the last step, 2 closed for several steps
    force: Any  # (n_q,) F(t), of a general system f(t, q, v)
    impulse: Any  # (n_c,) since the last kept state
    next_force: Any
    next_q: Any
    next_v: Any
    v_free: Any
    q_between: Any  # a state within the step
    v_between: Any
    p: Any  # (n_c,) impulses of this step
    G: Any  # (n_c, n_q)
    g_t: Any
    active: Any  # (n_c,) indices of the active contacts
    W: Any  # (n_c * n_c,) Delassus matrix of the active contacts, row by row
    b: Any
    z: Any
    solver: Any  # the complementarity solver, a function or its address
    lcp: Any  # its work space
    newton: Any  # work space of `newton.linearise`


def begin(m: Any, state: Any, record: Any, count: Any, t: float, side: float) -> None:
    """Forces and gaps of the initial state, which is kept where states are; side: see `start`."""
    if m.linear:
        external_force(m, side, state.q, state.v, state.force)
    else:
        total_force(m, side, state.q, state.v, state.force)
    count[FORCES] += 1
    measure(m, state, side)
    if len(record.times) == 0:
        keep(state, record, count, t)
    elif record.times[0] == t:
        keep(state, record, count, t)
        count[NEXT_TIME] = 1


def run(
    model: Any,
    plan: Any,
    state: Any,
    record: Any,
    count: Any,
    t0: float,
    first: int,
    last: int,
    external: bool,
    solved: bool,
) -> int:
    """Steps count[STEP] .. last - 1, step `first` beginning at t0; says why it returned.

    `external`: active problems are handed out (NEED_LCP) and come back in state.z (solved = True).
    """
    n_c = len(state.u)
    single = model.linear and model.flat and n_c == 1 and len(state.q) == 1
    while count[STEP] < last:
        if count[EVENT] + 2 * n_c > len(record.events):
            return LOG_FULL
        if single and state.closed[0] == 0:
            end = quiet_until(record, count[STEP], count[NEXT_TIME], plan.h, t0, first, last)
            coast(model, plan, state, count, t0, first, end)
            if count[STEP] >= last:
                return FINISHED
        t, t_next = t0 + plan.h * (count[STEP] - first), t0 + plan.h * (count[STEP] + 1 - first)
        code = step(model, plan, state, count, t, t_next, external, solved)
        if code != FINISHED:
            return code
        solved = False
        events = log_events(model, plan, state, record, count, t_next)
        keep_times(plan, state, record, count, t, t_next)
        advance(model, state, t_next)
        count[STEP] += 1
        if not (finite(state.g) and finite(state.u)):
            return NOT_FINITE
        if (record.every > 0 and count[STEP] % record.every == 0) or (record.on_events and events):
            keep(state, record, count, t_next)
    return FINISHED


@inline
def coast(model: Any, plan: Any, state: Any, count: Any, t0: float, first: int, last: int) -> None:
    """Free steps of one linear degree of freedom, up to the first in which its contact is active.

    The arithmetic is that of `step` to the last bit; only the state stays in registers, which halves the time.
    """
    h, theta = plan.h, plan.theta
    A_f, A_q, A_v = plan.A_f[0, 0], plan.A_q[0, 0], plan.A_v[0, 0]
    G, offset = model.G[0, 0], model.offset[0]
    q, v, g, u, f = state.q[0], state.v[0], state.g[0], state.u[0], state.force[0]
    k = start = count[STEP]
    while k < last and g + 0.5 * h * u > plan.slack:
        t = t0 + h * (k + 1 - first)
        external_force(model, t, state.q, state.v, state.next_force)
        f_next = state.next_force[0]
        v_next = v + (A_f * (theta * f_next + (1.0 - theta) * f) - A_q * q - A_v * v)
        if v_next - v_next != 0.0:
            break
        q += h * (theta * v_next + (1.0 - theta) * v)
        v, f = v_next, f_next
        obstacle(model, t, state.q, state.v)
        g = offset - model.motion_now[0, 0] + G * q
        u = G * v - model.motion_now[0, 1]
        k += 1
    state.q[0], state.v[0], state.g[0], state.u[0], state.force[0] = q, v, g, u, f
    count[STEP] = k
    count[FORCES] += k - start


@inline
def step(
    model: Any, plan: Any, state: Any, count: Any, t: float, t_next: float, external: bool, solved: bool
) -> int:
    """One step into next_q, next_v, p."""
    n_a = predict_active(plan, state)
    if n_a > 0 and not (model.linear and model.flat):
        predicted_rates(model, plan, state, t_next)
    if count[ITERATION] == 0:
        assign(state.next_v, state.v)
    while True:
        if model.linear:
            linear_free_velocity(model, plan, state, t_next)
            count[FORCES] += 1
            if n_a > 0 and model.flat:
                gap_rates(model, t_next, state.q, state.v, state.G, state.g_t)
        elif not linearise(model, plan, state, t, t_next, n_a > 0, count):
            return NOT_FINITE
        if not finite(state.v_free):
            return NOT_FINITE
        if n_a > 0:
            assemble(model, plan, state, n_a)
            if not (finite(state.b[:n_a]) and finite(state.W[: n_a * n_a])):
                return NOT_FINITE
            if external and not solved:
                return NEED_LCP
            count[LCP_CALLS] += 1
            if not external and not solve_active(state, n_a):
                return LCP_FAILED
            solved = False
        change, size = apply_impulses(plan, state, n_a)
        if model.linear or change <= CONVERGED * size:
            break
        count[ITERATION] += 1
        if count[ITERATION] >= MAX_ITERATIONS:
            return NEWTON_FAILED
    count[ITERATION] = 0
    for i in range(len(state.q)):
        state.next_q[i] = state.q[i] + plan.h * (
            plan.theta * state.next_v[i] + (1.0 - plan.theta) * state.v[i]
        )
    return FINISHED


@inline
def solve_active(state: Any, n_a: int) -> bool:
    """Impulses of the active contacts into z: one contact by a division, several by the solver."""
    if n_a == 1 and state.W[0] > 0.0:
        state.z[0] = max(0.0, -state.b[0] / state.W[0])
        return True
    W = state.W[: n_a * n_a].reshape((n_a, n_a))
    return call_solver(state.solver, W, state.b[:n_a], state.z[:n_a], state.lcp) == 0


@inline
def predict_active(plan: Any, state: Any) -> int:
    """Contacts with g + (h/2) u <= 0, up to rounding, into `active`; their number."""
    n_a = 0
    for c in range(len(state.u)):
        state.p[c] = 0.0
        if state.g[c] + 0.5 * plan.h * state.u[c] <= plan.slack:
            state.active[n_a] = c
            n_a += 1
    return n_a


@inline
def predicted_rates(model: Any, plan: Any, state: Any, t_next: float) -> None:
    """G and g_t at the end of the step, at the position predicted by the velocity of its start."""
    for i in range(len(state.q)):
        state.next_q[i] = state.q[i] + plan.h * state.v[i]
    gap_rates(model, t_next, state.next_q, state.v, state.G, state.g_t)


@inline
def linear_free_velocity(model: Any, plan: Any, state: Any, t_next: float) -> None:
    """v_free = v + A^-1 (-h C v - h K q - h^2 theta K v + h [theta F(t+h) + (1-theta) F(t)])."""
    n, theta = len(state.q), plan.theta
    external_force(model, t_next, state.q, state.v, state.next_force)
    for i in range(n):
        total = state.v[i]
        for j in range(n):
            total += (
                plan.A_f[i, j] * (theta * state.next_force[j] + (1.0 - theta) * state.force[j])
                - plan.A_q[i, j] * state.q[j]
                - plan.A_v[i, j] * state.v[j]
            )
        state.v_free[i] = total


@inline
def assemble(model: Any, plan: Any, state: Any, n_a: int) -> None:
    """W = G A^-1 G^T and b = G v_free + g_t + r u on the active contacts; z starts from the last impulses."""
    curved = model.linear and not model.flat
    for i in range(n_a):
        c = state.active[i]
        state.b[i] = product(state.G, state.v_free, c) + state.g_t[c] + model.restitution[c] * state.u[c]
        for j in range(n_a):
            d = state.active[j]
            state.W[i * n_a + j] = plan.W[c, d]
            if curved:
                state.W[i * n_a + j] = mobility(plan, state, c, d)


@inline
def mobility(plan: Any, state: Any, c: int, d: int) -> float:
    """(G A^-1 G^T)_cd for a Jacobian that changes while A does not; A^-1 G^T into plan.A_g."""
    total = 0.0
    for i in range(len(state.q)):
        row = 0.0
        for j in range(len(state.q)):
            row += plan.A_f[i, j] * state.G[d, j]
        plan.A_g[i, d] = row / plan.h
        total += state.G[c, i] * plan.A_g[i, d]
    return total


@inline
def apply_impulses(plan: Any, state: Any, n_a: int) -> tuple[float, float]:
    """next_v = v_free + A^-1 G^T p; how much it changed, and the velocities' size."""
    for i in range(n_a):
        state.p[state.active[i]] = state.z[i]
    change = size = 0.0
    for i in range(len(state.v_free)):
        v = state.v_free[i]
        terms = abs(v)
        for k in range(n_a):
            c = state.active[k]
            v += plan.A_g[i, c] * state.p[c]
            terms += abs(plan.A_g[i, c] * state.p[c])
        change = max(change, abs(v - state.next_v[i]))
        size = max(size, abs(v), abs(state.v[i]), CANCELLED * terms)
        state.next_v[i] = v
    return change, size


@inline
def finite(x: Any) -> bool:
    """Whether no entry is nan or infinite."""
    total = 0.0
    for i in range(len(x)):
        total += x[i] - x[i]
    return total == 0.0


@inline
def log_events(model: Any, plan: Any, state: Any, record: Any, count: Any, t_next: float) -> bool:
    """Note impacts, the beginning of lasting contact, and its end; whether there was any."""
    happened = False
    for c in range(len(state.u)):
        state.impulse[c] += state.p[c]
        kind = -1
        if state.p[c] > 0.0:
            if state.closed[c] == 0:
                kind = IMPACT
            elif state.closed[c] == 1:
                kind = STICK
            state.closed[c] = min(2, state.closed[c] + 1)
        else:
            if state.closed[c] == 2:
                kind = RELEASE
            state.closed[c] = 0
        if kind >= 0:
            if kind == RELEASE:
                gap_rates(model, t_next, state.next_q, state.next_v, state.G, state.g_t)
            u = product(state.G, state.next_v, c) + state.g_t[c]
            write_event(record.events[count[EVENT]], t_next, c, state.u[c], u, state.p[c], kind)
            count[EVENT] += 1
            happened = True
    return happened


@inline
def advance(model: Any, state: Any, t: float) -> None:
    """Take over next_q, next_v; gaps and gap velocities at the new state."""
    assign(state.q, state.next_q)
    assign(state.v, state.next_v)
    assign(state.force, state.next_force)
    measure(model, state, t)


@inline
def measure(model: Any, state: Any, t: float) -> None:
    """Gaps and gap velocities of the current state."""
    n_c = len(state.u)
    if n_c == 0:
        return
    gaps(model, t, state.q, state.v, state.g)
    if model.flat:  # the obstacle's velocity came with the gap
        for c in range(n_c):
            state.u[c] = product(model.G, state.v, c) - model.motion_now[c, 1]
        return
    gap_rates(model, t, state.q, state.v, state.G, state.g_t)
    for c in range(n_c):
        state.u[c] = product(state.G, state.v, c) + state.g_t[c]


@inline
def keep_times(plan: Any, state: Any, record: Any, count: Any, t: float, t_next: float) -> None:
    """Keep the states asked for within the step, q and v interpolated linearly."""
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] <= t_next + LATE * plan.h:
        share = min(1.0, (record.times[count[NEXT_TIME]] - t) / (t_next - t))
        for i in range(len(state.q)):
            state.q_between[i] = (1.0 - share) * state.q[i] + share * state.next_q[i]
            state.v_between[i] = (1.0 - share) * state.v[i] + share * state.next_v[i]
        row = record.rows[count[ROW]]
        write_row(row, record.times[count[NEXT_TIME]], 0.0, state.q_between, state.v_between, state.impulse)
        count[ROW] += 1
        count[NEXT_TIME] += 1


@inline
def keep(state: Any, record: Any, count: Any, t: float) -> None:
    """Keep the current state."""
    write_row(record.rows[count[ROW]], t, 0.0, state.q, state.v, state.impulse)
    count[ROW] += 1
