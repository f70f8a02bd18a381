"""The loop of `Located`, as kernels: steps, and within each step the impacts at their own times.

A step is a chain of pieces of smooth motion (`smooth`). A piece ends where the first gap closes, at a corner of
the scene, or with the step; there the impulses are found (`impulses`), and the next piece begins with the
velocities after them. Gaps of contacts that have just fired count from zero, so a chain of ever shorter hops is
followed without loss of digits.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import external_force, gap_rates, gaps, obstacle, product
from lcpstep.model import ABSENT
from lcpstep.recording import LEAD, quiet_until, write_row
from lcpstep.recording import TIME as ROW_TIME
from lcpstep.stepping.corners import at_corner, find_corners, obstacles_move
from lcpstep.stepping.impulses import hold, land, settle_rest, stick, strike
from lcpstep.stepping.located_joints import (
    joints_failed,
    load_joints,
    put_on_joints,
    share_out,
    take_back,
    turn_with_joints,
    write_joints,
)
from lcpstep.stepping.located_work import (
    A_FROM,
    ALPHA,
    BEND,
    BIAS,
    BUFFER_FULL,
    CHANGE,
    CHOSEN,
    CLOSE_HITS,
    CLOSED,
    CLOSED_NOW,
    CORNER,
    CUT,
    END,
    END_S,
    EPS,
    EVENT,
    EVENTS,
    EVENTS_LEFT,
    FINISHED,
    FORCE,
    FORCE_NOW,
    FORCES,
    FREE,
    GAP,
    GAP_T,
    GAP_TRY,
    GROUNDED,
    HALF,
    HIGH,
    HITS,
    IMPULSE,
    IMPULSE_FROM,
    LAST,
    LCP_FAILED,
    LOW,
    NEXT_FORCE,
    NEXT_TIME,
    NOBODY,
    NOT_FINITE,
    OPEN,
    Q_FROM,
    Q_TIME,
    Q_TRY,
    RATE,
    ROUNDING,
    ROW,
    SIGMA,
    STATUS,
    STEP,
    TOO_MANY_EVENTS,
    UNCHANGED,
    UNDER_WAY,
    V_FROM,
    V_TRY,
    WHOLE,
    A,
    Q,
    V,
)
from lcpstep.stepping.quadratic import first_zero, may_reach_zero
from lcpstep.stepping.race import race
from lcpstep.stepping.smooth import (
    ON_THE_SURFACE,
    accelerate,
    advance,
    free_acceleration,
    gap_bias,
    lift,
    measure,
    put_on_surface,
    refactor,
    respond,
    settle_state,
    within,
)

POLISHING = 8  # Newton iterations onto a gap that is no quadratic
SAME_TIME = 8 * EPS  # relative: an impact as little after the end of a step belongs to it
LATE = 1e-9  # of a step: what rounding may take from the last one's end


def begin(m: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, t: float) -> int:
    """Forces, gaps and status of the initial state, which is kept where states are."""
    x[LOW], x[HIGH] = find_corners(plan, t)
    if plan.trapezoidal:
        external_force(m, within(plan, x, t), w.vec[Q], w.vec[V], w.vec[FORCE])
    elif not free_acceleration(m, w, t, w.vec[Q], w.vec[V], w.vec[FREE]):
        return NOT_FINITE
    count[FORCES] += 1
    if plan.steady:
        for i in range(w.vec.shape[1]):
            w.vec[FREE, i] = product(plan.A_inverse[WHOLE], w.vec[FORCE], i)
    measure(m, plan, w, x, t)
    if plan.constant:
        respond(m, w)
        for c in range(w.num.shape[1]):
            w.num[ALPHA, c] = product(m.G, w.vec[FREE], c)
    for c in range(w.num.shape[1]):
        if w.num[GAP, c] <= plan.slack:
            w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, 1
            size = abs(w.num[GAP_T, c])
            for i in range(w.vec.shape[1]):
                size += abs(w.G[c, i] * w.vec[V, i])
            if abs(w.num[RATE, c]) <= 64 * EPS * size:
                w.num[RATE, c], w.mark[STATUS, c] = 0.0, CLOSED
                x[CLOSED_NOW] += 1
    if len(record.times) == 0:
        keep(w, record, count, t)
    elif record.times[0] == t:
        keep(w, record, count, t)
        count[NEXT_TIME] = 1
    return FINISHED


def run(
    model: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, t0: float, first: int, last: int
) -> int:
    """Steps count[STEP] .. last - 1, step `first` beginning at t0; says why it returned."""
    n_c = w.num.shape[1]
    single = plan.trapezoidal and model.flat and n_c <= 1 and w.vec.shape[1] == 1
    while count[STEP] < last:
        if x[UNDER_WAY] == 0.0:
            if single and (n_c == 0 or w.mark[STATUS, 0] == OPEN):
                end = quiet_until(record, count[STEP], count[NEXT_TIME], plan.h, t0, first, last)
                glide(model, plan, w, x, count, t0, first, end)
                if count[STEP] >= last:
                    return FINISHED
            begin_step(w, x)
        t = t0 + plan.h * (count[STEP] - first)
        code = step(model, plan, w, x, record, count, t)
        if code != FINISHED:
            return code
        t_next = t0 + plan.h * (count[STEP] + 1 - first)
        keep_times(model, plan, w, x, record, count, t_next + LATE * plan.h, t_next + LATE * plan.h)
        count[STEP] += 1
        x[UNDER_WAY] = 0.0
        if not finite(w):
            return NOT_FINITE
        code = joints_failed(w)
        if code != FINISHED:
            return code
        if record.every > 0 and count[STEP] % record.every == 0:
            keep(w, record, count, t_next)
    return FINISHED


@inline
def glide(model: Any, plan: Any, w: Any, x: Any, count: Any, t0: float, first: int, last: int) -> None:
    """Steps of one linear degree of freedom without events, up to the first that may have one.

    The arithmetic is that of `step` to the last bit; only the state stays in registers, which halves the time.
    """
    h = plan.h
    A_inverse, C, K = plan.A_inverse[WHOLE, 0, 0], model.C[0, 0], model.K[0, 0]
    q, v, f = w.vec[Q, 0], w.vec[V, 0], w.vec[FORCE, 0]
    g, u, G, offset, s = math.inf, 0.0, 0.0, 0.0, 0.0
    contact, moving = w.num.shape[1] > 0, model.motion != ABSENT
    if contact:
        g, u, G, offset = w.num[GAP, 0], w.num[RATE, 0], model.G[0, 0], model.offset[0]
        if moving:
            obstacle(model, within(plan, x, t0 + h * (count[STEP] - first)), w.vec[Q], w.vec[V])
            s = model.motion_now[0, 2]
    k = start = count[STEP]
    while k < last:
        t = t0 + h * (k - first) + h
        if t > x[HIGH]:
            break
        inner = within(plan, x, t)
        external_force(model, inner, w.vec[Q], w.vec[V], w.vec[NEXT_FORCE])
        f_next = w.vec[NEXT_FORCE, 0]
        a = A_inverse * (0.5 * (f + f_next) - (C * v + K * (q + 0.5 * h * v)))
        if a - a != 0.0:
            break
        if contact:
            half, s_next = 0.5 * (G * a), 0.0
            if moving:
                obstacle(model, inner, w.vec[Q], w.vec[V])
                s_next = model.motion_now[0, 2]
                half = 0.5 * ((G * a - 0.5 * (s + s_next)) + (s_next - s) / 6.0)
            latest = h + SAME_TIME * (abs(t) + h)
            if may_reach_zero(g, u, half, latest) and first_zero(g, u, half) <= latest:
                break
            if moving:
                if inner != t:
                    obstacle(model, t, w.vec[Q], w.vec[V])
                q_next, v_next = q + h * (v + 0.5 * h * a), v + h * a
                g_next = offset - model.motion_now[0, 0] + G * q_next
                if not g_next > 0.0:
                    break
                g, u, s = g_next, G * v_next - model.motion_now[0, 1], s_next
            else:
                g, u = g + h * (u + h * half), u + 2.0 * h * half
        q, v, f = q + h * (v + 0.5 * h * a), v + h * a, f_next
        k += 1
    w.vec[Q, 0], w.vec[V, 0], w.vec[FORCE, 0] = q, v, f
    if contact:
        w.num[GAP, 0], w.num[RATE, 0] = g, u
    count[STEP] = k
    count[FORCES] += k - start


@inline
def begin_step(w: Any, x: Any) -> None:
    """Nothing has happened in this step yet, but for what happened at the very end of the last one."""
    end = x[SIGMA]
    x[SIGMA] = x[EVENTS] = x[END] = 0.0
    x[UNDER_WAY] = 1.0
    for c in range(w.num.shape[1]):
        w.mark[HITS, c] = w.mark[CLOSE_HITS, c] = 0
        w.num[LAST, c] = 0.0 if end > 0.0 and w.num[LAST, c] == end else -1.0


@inline
def step(model: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, t: float) -> int:
    """The rest of the step that began at t: from x[SIGMA] to its end."""
    n_c = w.num.shape[1]
    settled = False
    while True:
        if count[EVENT] + 4 * n_c + 4 > len(record.events) or count[ROW] + 4 > len(record.rows):
            return BUFFER_FULL
        if count[EVENT] > count[EVENTS_LEFT]:
            return TOO_MANY_EVENTS
        c = NOBODY
        if x[SIGMA] >= x[END]:
            if x[END] >= plan.h:
                return FINISHED
            settled = False
            c = CORNER if begin_interval(model, plan, w, x, count, t) else NOBODY
        if c == NOBODY:
            if not begin_piece(model, plan, w, x, record, t + x[SIGMA], count):
                return LCP_FAILED if finite(w) else NOT_FINITE
            rest = x[END] - x[SIGMA]
            tau = rest
            if not settled and x[EVENTS] > plan.per_step:
                settled = True
                count[CUT] += 1
                if not settle_rest(model, plan, w, x, record, t + x[SIGMA], count):
                    return LCP_FAILED
            if not settled:
                c, tau = first_contact(plan, w, rest, t + x[END])
                if c != NOBODY and not plan.plain:
                    c, tau = polish(model, plan, w, c, t + x[SIGMA], tau, rest)
                if c != NOBODY and plan.plain and plan.steady and racing(w, x, record, count, t):
                    most = min(count[EVENTS_LEFT] - count[EVENT], plan.per_step - int(x[EVENTS])) + 1
                    most = min(
                        most, len(record.events) - count[EVENT] - 4 * n_c, len(record.rows) - count[ROW] - 4
                    )
                    done = race(
                        w.vec, w.num, w.mark, w.G, w.MG, w.W, model.restitution, model.offset, record, count,
                        t, x[SIGMA], x[END], plan.h, plan.slack, most, plan.many,
                    )  # fmt: skip
                    if done > 0:
                        x[SIGMA] = w.vec[Q_TIME, 0]
                        x[EVENTS] += done
                        continue
                if c != NOBODY and at_corner(plan, x, t + x[SIGMA] + tau):
                    c, tau = NOBODY, rest
            x[EVENTS] += 1.0 if c == NOBODY and tau < rest else 0.0
            code = move(model, plan, w, x, record, t, tau, c == NOBODY and tau == rest, count)
            if code != FINISHED:
                return code
        if c != NOBODY:
            code = event(model, plan, w, x, record, t, c, count)
            if code != FINISHED:
                return code


def racing(w: Any, x: Any, record: Any, count: Any, t: float) -> bool:
    """Whether impacts of several bodies in free flight may be taken in turn, no state being asked for meanwhile."""
    wanted = count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] <= t + x[END]
    return w.num.shape[1] > 1 and x[CLOSED_NOW] == 0 and not wanted


def begin_interval(m: Any, plan: Any, w: Any, x: Any, count: Any, t: float) -> bool:
    """The smooth interval from x[SIGMA] to the next corner or the end of the step; forces at its ends.

    Whether it begins at a corner at which velocities of gaps may jump.
    """
    now, turns = t + x[SIGMA], False
    if now >= x[HIGH] - plan.margin:
        x[LOW], x[HIGH] = find_corners(plan, now)
        turns = obstacles_move(m) or plan.joined
        if plan.trapezoidal and not plan.steady:
            external_force(m, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FORCE])
        elif not plan.trapezoidal:
            turn_with_joints(w, within(plan, x, now))
            free_acceleration(m, w, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FREE])
        count[FORCES] += 1
    x[END] = plan.h
    if t + plan.h > x[HIGH] + plan.margin:
        x[END] = max(x[HIGH] - t, x[SIGMA])
    end = within(plan, x, t + x[END])
    if plan.trapezoidal and not plan.steady:
        external_force(m, end, w.vec[Q], w.vec[V], w.vec[NEXT_FORCE])
        count[FORCES] += 1
    if m.flat and m.motion != ABSENT:
        obstacle(m, end, w.vec[Q], w.vec[V])
        for c in range(w.num.shape[1]):
            w.num[END_S, c] = m.motion_now[c, 2]
    return turns


@inline
def begin_piece(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, count: Any) -> bool:
    """Accelerations and gap quadratics of the piece that begins at t."""
    n_c = w.num.shape[1]
    place = accelerate(m, plan, w, x, t)
    if n_c == 0:
        assign(w.vec[A], w.vec[FREE])
        return True
    closed = x[CLOSED_NOW] > 0
    if x[UNCHANGED] == 1.0 and not closed:
        return True
    x[UNCHANGED] = 1.0 if plan.steady and plan.plain and not closed else 0.0
    if m.flat:
        flat_accelerations(m, plan, w, t, x)
    elif needs_bias(w):
        gap_bias(m, w, within(plan, x, t), w.vec[Q], w.vec[V])
        for c in range(n_c):
            w.num[ALPHA, c] = product(w.G, w.vec[FREE], c) + w.num[BIAS, c]
    if closed and not plan.constant:
        if not refactor(m, w, t):
            return False
        respond(m, w)
    if not hold(m, plan, w, x, record, place, t, count):
        return False
    if plan.constant:
        for c in range(n_c):
            w.num[HALF, c] = 0.5 * (w.num[ALPHA, c] + w.num[BEND, c])
        if closed:
            pressed(w, place)
    else:
        fitted(m, w, t, x[END] - x[SIGMA])
    for c in range(n_c):
        if w.mark[STATUS, c] == CLOSED:
            w.num[GAP, c] = w.num[RATE, c] = w.num[HALF, c] = 0.0
        elif w.mark[GROUNDED, c] == 1 and w.num[RATE, c] == 0.0:  # just released
            w.num[HALF, c] = max(w.num[HALF, c], 0.0)
    return True


def flat_accelerations(m: Any, plan: Any, w: Any, t: float, x: Any) -> None:
    """Mean accelerations of the gaps of flat contacts over the piece without contact forces.

    In w.num[ALPHA] so that the velocity is right at the end; w.num[BEND] is what must be added for the position.
    """
    if not plan.steady or m.motion != ABSENT:
        for c in range(w.num.shape[1]):
            w.num[ALPHA, c] = product(m.G, w.vec[FREE], c)
    if m.motion != ABSENT:
        obstacle(m, within(plan, x, t), w.vec[Q], w.vec[V])
        for c in range(w.num.shape[1]):
            s, s_end = m.motion_now[c, 2], w.num[END_S, c]
            w.num[ALPHA, c] -= 0.5 * (s + s_end)
            w.num[BEND, c] = (s_end - s) / 6.0
            w.num[BIAS, c] = -0.5 * (s + s_end)


@inline
def pressed(w: Any, place: int) -> None:
    """Add to the gap quadratics what contact forces do."""
    for d in range(w.num.shape[1]):
        force = w.num[FORCE_NOW, d]
        if w.mark[STATUS, d] == CLOSED and force > 0.0:
            for c in range(w.num.shape[1]):
                w.num[HALF, c] += 0.5 * w.WA[place, c, d] * force


def fitted(m: Any, w: Any, t: float, rest: float) -> None:
    """Gap quadratics that fit the gap at the end of the piece; from accelerations for contacts just left."""
    for i in range(w.vec.shape[1]):
        w.vec[Q_TRY, i] = w.vec[Q, i] + rest * (w.vec[V, i] + 0.5 * rest * w.vec[A, i])
    gaps(m, t + rest, w.vec[Q_TRY], w.vec[V], w.num[GAP_TRY])
    for c in range(w.num.shape[1]):
        if w.mark[GROUNDED, c] == 1:
            w.num[HALF, c] = 0.5 * (product(w.G, w.vec[A], c) + w.num[BIAS, c])
        else:
            w.num[HALF, c] = (w.num[GAP_TRY, c] - w.num[GAP, c] - rest * w.num[RATE, c]) / (rest * rest)


@inline
def needs_bias(w: Any) -> bool:
    """Whether some contact is closed or has just been left."""
    some = False
    for c in range(w.num.shape[1]):
        some = some or w.mark[STATUS, c] == CLOSED or w.mark[GROUNDED, c] == 1
    return some


@inline
def first_contact(plan: Any, w: Any, rest: float, t_end: float) -> tuple[int, float]:
    """Which gap closes first, and when; NOBODY and the end of the piece if none does."""
    found, tau = NOBODY, rest + SAME_TIME * (abs(t_end) + plan.h)
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == OPEN and may_reach_zero(w.num[GAP, c], w.num[RATE, c], w.num[HALF, c], tau):
            zero = first_zero(w.num[GAP, c], w.num[RATE, c], w.num[HALF, c])
            if zero < tau or (zero == 0.0 and tau == 0.0 and w.num[RATE, c] < w.num[RATE, found]):
                found, tau = c, zero
    return found, min(tau, rest)


@inline
def polish(m: Any, plan: Any, w: Any, c: int, t: float, tau: float, rest: float) -> tuple[int, float]:
    """The zero of a gap that is a quadratic but approximately; NOBODY where the quadratic was wrong."""
    if tau == 0.0:
        return c, 0.0
    for _ in range(POLISHING):
        for i in range(w.vec.shape[1]):
            w.vec[Q_TRY, i] = w.vec[Q, i] + tau * (w.vec[V, i] + 0.5 * tau * w.vec[A, i])
        put_on_joints(w, t + tau, plan.slack, w.vec[Q_TRY])
        gaps(m, t + tau, w.vec[Q_TRY], w.vec[V], w.num[GAP_TRY])
        u = w.num[RATE, c] + 2.0 * tau * w.num[HALF, c]
        if abs(w.num[GAP_TRY, c]) <= 0.125 * plan.slack:
            return c, tau
        if u >= 0.0:
            break
        change = -w.num[GAP_TRY, c] / u
        if tau + change > rest:
            return NOBODY, rest
        if tau + change <= 0.0:
            break
        tau += change
        if abs(change) <= EPS * tau:
            return c, tau
    if w.num[GAP_TRY, c] > 0.0:
        return NOBODY, tau
    return c, tau


@inline
def move(
    m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, tau: float, to_end: bool, count: Any
) -> int:
    """Go on to x[SIGMA] + tau; contacts that were closed all the way stay on the surface."""
    now, first_row = t + x[SIGMA], count[ROW]
    load_joints(w)
    end = now + tau - SAME_TIME * (abs(now + tau) + plan.h)  # to rounding: states there come after the impact
    wanted = count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < end
    if wanted and plan.plain:
        keep_times(m, plan, w, x, record, count, now, end)
    elif wanted:
        remember(w)
    if tau > 0.0:
        for c in range(w.num.shape[1]):
            w.mark[GROUNDED, c] = 0
        if not advance(m, plan, w, x, within(plan, x, now), tau, count):
            return NOT_FINITE
    x[SIGMA] = x[END] if to_end else x[SIGMA] + tau
    if to_end and plan.trapezoidal and not plan.steady:
        assign(w.vec[FORCE], w.vec[NEXT_FORCE])
    if tau > 0.0 and (x[CLOSED_NOW] > 0 or penetrates(plan, w)):
        if plan.plain:
            if to_end:
                put_on_surface(m, plan, w, now + tau)
        else:
            if not plan.constant:
                if not refactor(m, w, now + tau):
                    return NOT_FINITE
                respond(m, w)
            if not land(m, plan, w, x, record, now + tau, tau, count):
                return LCP_FAILED
            if penetrates(plan, w):
                put_on_surface(m, plan, w, now + tau)
            measure(m, plan, w, x, now + tau)
    if wanted and not plan.plain:
        keep_between(m, plan, w, x, record, count, now, tau, end)
    share_out(w, record, count, first_row, now, tau)
    return FINISHED


@inline
def penetrates(plan: Any, w: Any) -> bool:
    """Whether an open contact has been closed by what its quadratic neglects."""
    lowest = 0.0
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == OPEN:
            lowest = min(lowest, w.num[GAP, c])
    return not plan.plain and lowest < -ON_THE_SURFACE * plan.slack


def event(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, c: int, count: Any) -> int:
    """The impact of contact c at x[SIGMA], or that of a corner, and what it changes."""
    now = t + x[SIGMA]
    if c != CORNER and w.num[RATE, c] >= 0.0:  # a touch: the velocity at the end of the piece does not strike
        w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, 1
        if w.num[RATE, c] == 0.0:
            stick(w, record, count, x, c, now)
        return FINISHED
    if not plan.constant:
        if not refactor(m, w, now):
            return NOT_FINITE
        respond(m, w)
    n_s = strike(m, plan, w, x, record, c, now, count)
    if n_s <= 0:
        return LCP_FAILED if n_s < 0 else FINISHED
    if plan.plain:  # rounding of the state must not add up over many impacts
        for k in range(n_s):
            d = w.mark[CHOSEN, k]
            lift(m, plan, w, w.vec[Q], d, -height(m, w, d))
            straighten(m, plan, w, d)
    if plan.trapezoidal and not plan.steady:
        external_force(m, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FORCE])
        count[FORCES] += 1
    elif not plan.trapezoidal:
        if not free_acceleration(m, w, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FREE]):
            return NOT_FINITE
        count[FORCES] += 1
    if record.on_events or record.every == 1:
        keep(w, record, count, now)
    return FINISHED


def straighten(m: Any, plan: Any, w: Any, d: int) -> None:
    """The velocities that gap d has left with, and the gap velocities of the contacts in flight that go with them.

    Without the latter the rounding of the Delassus matrix acts the same way at every impact: at a mass ratio of 1e12
    it turns the motion by a ten-thousandth. Gap velocities finer than the velocities resolve stay as they are.
    """
    error = w.num[RATE, d] - product(m.G, w.vec[V], d)
    if error == 0.0 or not w.W[d, d] > 0.0:
        return
    lift(m, plan, w, w.vec[V], d, error)
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == OPEN and w.mark[GROUNDED, c] == 0:
            change = w.W[c, d] * error / w.W[d, d]
            if abs(change) <= ROUNDING * abs(w.num[RATE, c]):
                w.num[RATE, c] += change


@inline
def height(m: Any, w: Any, c: int) -> float:
    """The gap c of a flat contact at rest, from the coordinates."""
    return product(m.G, w.vec[Q], c) + m.offset[c]


@inline
def finite(w: Any) -> bool:
    """Whether state and gaps are finite."""
    total = 0.0
    for i in range(w.vec.shape[1]):
        total += (w.vec[Q, i] - w.vec[Q, i]) + (w.vec[V, i] - w.vec[V, i])
    for c in range(w.num.shape[1]):
        total += (w.num[GAP, c] - w.num[GAP, c]) + (w.num[RATE, c] - w.num[RATE, c])
    return total == 0.0


# --- what is kept ---------------------------------------------------------------------------------------------


def keep_times(m: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, now: float, before: float) -> None:
    """Keep the states asked for before the given time, along the piece that begins now."""
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < before:
        t = record.times[count[NEXT_TIME]]
        tau = max(0.0, t - now)
        for i in range(w.vec.shape[1]):
            w.vec[Q_TRY, i] = w.vec[Q, i] + tau * (w.vec[V, i] + 0.5 * tau * w.vec[A, i])
            w.vec[V_TRY, i] = w.vec[V, i] + tau * w.vec[A, i]
        write_row(record.rows[count[ROW]], t, 0.0, w.vec[Q_TRY], w.vec[V_TRY], w.num[IMPULSE])
        write_joints(w, record.rows[count[ROW]])
        count[ROW] += 1
        count[NEXT_TIME] += 1


def remember(w: Any) -> None:
    """Note the base of a piece, within which states will be asked for once its end is known."""
    assign(w.vec[Q_FROM], w.vec[Q])
    assign(w.vec[V_FROM], w.vec[V])
    assign(w.vec[A_FROM], w.vec[A])
    assign(w.num[IMPULSE_FROM], w.num[IMPULSE])


def keep_between(
    m: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, base: float, tau: float, end: float
) -> None:
    """Keep the states asked for within the piece that has been made, bent so that they meet the state at its end.

    Velocities along the acceleration of the base alone would be of order one.
    """
    n, n_c, share = w.vec.shape[1], w.num.shape[1], 0.0
    for c in range(n_c):
        w.num[CHANGE, c] = w.num[IMPULSE, c] - w.num[IMPULSE_FROM, c]
        w.num[IMPULSE, c] = w.num[IMPULSE_FROM, c]
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < end:
        t = record.times[count[NEXT_TIME]]
        s = min(max(0.0, t - base), tau)
        r = s / tau
        for i in range(n):
            q, v, a = w.vec[Q_FROM, i], w.vec[V_FROM, i], w.vec[A_FROM, i]
            bent = w.vec[Q, i] - q - tau * (v + 0.5 * tau * a)
            w.vec[Q_TRY, i] = q + s * (v + 0.5 * s * a) + r * r * r * bent
            w.vec[V_TRY, i] = v + s * a + r * r * (w.vec[V, i] - v - tau * a)
        for c in range(n_c):
            w.num[IMPULSE, c] += (r - share) * w.num[CHANGE, c]
        share = r
        settle_state(m, plan, w, x, t, w.vec[Q_TRY])
        write_row(record.rows[count[ROW]], t, 0.0, w.vec[Q_TRY], w.vec[V_TRY], w.num[IMPULSE])
        write_joints(w, record.rows[count[ROW]])
        count[ROW] += 1
        count[NEXT_TIME] += 1
    for c in range(n_c):
        w.num[IMPULSE, c] += (1.0 - share) * w.num[CHANGE, c]
    if not plan.constant:  # `settle_state` has looked elsewhere
        gap_rates(m, within(plan, x, base + tau), w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
        refactor(m, w, base + tau)


def keep(w: Any, record: Any, count: Any, t: float) -> None:
    """Keep the current state; states at one time share a row."""
    if count[ROW] > 0 and record.rows[count[ROW] - 1, ROW_TIME] == t:
        count[ROW] -= 1
        for c in range(w.num.shape[1]):
            w.num[IMPULSE, c] += record.rows[count[ROW], LEAD + 2 * w.vec.shape[1] + c]
        take_back(w, record.rows[count[ROW]])
    write_row(record.rows[count[ROW]], t, 0.0, w.vec[Q], w.vec[V], w.num[IMPULSE])
    write_joints(w, record.rows[count[ROW]])
    count[ROW] += 1
