"""The loop of `Located` of order four and of exact motion, as kernels: steps made of polynomial pieces.

Like `located_loop`, but a piece is a polynomial (`polynomial`) on which events are searched for (`scan`): landings,
and releases where a contact force vanishes.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import gap_rates, product
from lcpstep.recording import write_row
from lcpstep.stepping.corners import at_corner, find_corners, obstacles_move
from lcpstep.stepping.impulses import strike
from lcpstep.stepping.located_keep import just_after, keep
from lcpstep.stepping.located_loop import begin_step, finite
from lcpstep.stepping.located_piece import penetrates
from lcpstep.stepping.located_work import (
    AHEAD,
    BIAS,
    BLIND,
    BUFFER_FULL,
    CHOSEN,
    CLOSED,
    CLOSED_NOW,
    CORNER,
    END,
    EPS,
    EVENT,
    EVENTS_LEFT,
    FINISHED,
    GAP,
    GAP_T,
    GAP_TRY,
    GOAL,
    GROUND,
    GROUNDED,
    HALF,
    HIGH,
    IDLE,
    IMPULSE,
    LAST,
    LCP_FAILED,
    LEFT,
    LOW,
    NEXT_TIME,
    NOT_FINITE,
    PAUSING,
    RATE,
    ROUNDING,
    ROW,
    SAME_TIME,
    SIGMA,
    STATUS,
    STEP,
    STOPPED,
    TOO_MANY_EVENTS,
    UNDER_WAY,
    V_STRUCK,
    A,
    P,
    Q,
    V,
)
from lcpstep.stepping.magnitudes import speed_terms
from lcpstep.stepping.polynomial import (
    NODES,
    acceleration,
    biases,
    expand,
    force_at,
    on_surface,
    state_at,
)
from lcpstep.stepping.polynomial_forces import UNDECIDED, load
from lcpstep.stepping.scan import NOBODY, NOWHERE, first_landing, first_release
from lcpstep.stepping.settle import endless, settle
from lcpstep.stepping.smooth import (
    measure,
    newton_step,
    put_on_surface,
    refactor,
    respond,
    settle_state,
    within,
)
from lcpstep.stepping.switches import idle, release, stick, turn

SLOW = 1e-3  # of a step: a touch is no event twice within so short a time


def run(
    model: Any, plan: Any, w: Any, x: Any, z: Any, record: Any, count: Any, t0: float, first: int, last: int
) -> int:
    """Steps count[STEP] .. last - 1, step `first` beginning at t0; says why it returned."""
    while count[STEP] < last:
        if x[UNDER_WAY] == 0.0:
            begin_step(w, x)
        code = step(model, plan, w, x, z, record, count, t0 + plan.h * (count[STEP] - first))
        if code != FINISHED:
            return code
        t_next = x[GOAL] if x[PAUSING] == 1.0 else t0 + plan.h * (count[STEP] + 1 - first)
        late = just_after(plan, t_next)
        while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < late:
            keep_now(w, record, count, record.times[count[NEXT_TIME]], w.vec[Q], w.vec[V])
            count[NEXT_TIME] += 1
        count[STEP] += 1
        x[UNDER_WAY] = 0.0
        if not finite(w):
            return NOT_FINITE
        if record.every > 0 and count[STEP] % record.every == 0:
            keep(w, record, count, t_next, 0.0)
    return FINISHED


@inline
def step(m: Any, plan: Any, w: Any, x: Any, z: Any, record: Any, count: Any, t: float) -> int:
    """The rest of the step that began at t: from x[SIGMA] to its end."""
    n_c = w.num.shape[1]
    while True:
        if count[EVENT] + 4 * n_c + 4 > len(record.events) or count[ROW] + 4 > len(record.rows):
            return BUFFER_FULL
        if count[EVENT] + count[IDLE] > count[EVENTS_LEFT]:
            return TOO_MANY_EVENTS
        now = t + x[SIGMA]
        if x[SIGMA] >= x[END]:
            if x[END] >= plan.h:
                return FINISHED
            if now >= x[HIGH] - plan.margin:
                x[LOW], x[HIGH] = find_corners(plan, now)
                if obstacles_move(m):
                    code = touch(m, plan, w, x, z, record, now, CORNER, count)
                    if code != FINISHED:
                        return code
            x[END] = plan.h
            if t + plan.h > x[HIGH] + plan.margin:
                x[END] = max(x[HIGH] - t, x[SIGMA])
            continue
        if x[END] - x[SIGMA] <= SAME_TIME * (
            abs(now) + plan.h
        ):  # too short for positions to tell its ends apart
            x[SIGMA] = x[END]
            continue
        length = min(x[END] - x[SIGMA], plan.longest)
        if not load(m, plan, w, x, z, record, now, length, count):
            return LCP_FAILED if finite(w) else NOT_FINITE
        if endless(plan, x):
            code = settle(m, plan, w, x, record, t, count)
            if code != FINISHED:
                return code
            continue
        if not expand(m, plan, w, x, z, now, length, count):
            return NOT_FINITE
        if x[BLIND] > 0.0:
            opening, landing, tau = NOBODY, NOBODY, min(length, x[BLIND])
        else:
            opening, stop = first_release(m, plan, w, x, z, now, length, count)
            landing, tau = first_landing(m, plan, w, x, z, now, stop)
            if landing == NOWHERE:
                return NOT_FINITE
        if landing != NOBODY and at_corner(plan, x, now + tau):
            landing, tau = NOBODY, stop
        ends = landing == NOBODY and opening == NOBODY and tau == length
        ends = ends and x[SIGMA] + length >= x[END] * (1.0 - EPS)
        code = follow(m, plan, w, x, z, record, t, tau, ends, count)
        if code == FINISHED and x[BLIND] > 0.0:
            code = STOPPED
        if code != FINISHED:
            return code
        if x[PAUSING] == 1.0:
            assign(w.vec[V_STRUCK], w.vec[V])
        if landing != NOBODY:
            code = touch(m, plan, w, x, z, record, t + x[SIGMA], landing, count)
            if code != FINISHED:
                return code
        elif opening != NOBODY:
            lose_force(m, plan, w, x, record, t + x[SIGMA], opening, count)
        if x[PAUSING] == 1.0 and (landing != NOBODY or opening != NOBODY):
            return STOPPED


def lose_force(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, c: int, count: Any) -> None:
    """The force of closed contact c has vanished: it opens, or where others are closed they decide together."""
    if x[CLOSED_NOW] > 1:
        x[AHEAD] = UNDECIDED
        idle(x, count)
        return
    release(m, plan, w, record, count, x, c, t, 0.0)
    w.mark[GROUNDED, c] = LEFT
    if record.on_events or record.every == 1:
        keep(w, record, count, t, 1.0)


@inline
def follow(
    m: Any, plan: Any, w: Any, x: Any, z: Any, record: Any, t: float, tau: float, ends: bool, count: Any
) -> int:
    """Go on to x[SIGMA] + tau along the polynomial."""
    now = t + x[SIGMA]
    end = now + tau - SAME_TIME * (abs(now + tau) + plan.h)  # to rounding: states there come after the impact
    while count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < end:
        state_at(m, plan, w, x, z, now, max(0.0, record.times[count[NEXT_TIME]] - now))
        settle_state(m, plan, w, x, record.times[count[NEXT_TIME]], z.vec[Q])
        keep_now(w, record, count, record.times[count[NEXT_TIME]], z.vec[Q], z.vec[V])
        count[NEXT_TIME] += 1
    x[SIGMA] = x[END] if ends else x[SIGMA] + tau
    if tau == 0.0:
        return FINISHED
    if x[CLOSED_NOW] > 0:
        for node, weight in NODES:
            if not force_at(m, plan, w, x, z, now, node * tau, count):
                return NOT_FINITE
            for c in range(w.num.shape[1]):
                w.num[IMPULSE, c] += weight * tau * max(w.num[P, c], 0.0)  # else a zero's rounding
    state_at(m, plan, w, x, z, now, tau)
    assign(w.vec[Q], z.vec[Q])
    assign(w.vec[V], z.vec[V])
    for c in range(w.num.shape[1]):
        w.mark[GROUNDED, c] = 0
    measure(m, plan, w, x, now + tau)
    if not on_surface(m, plan, w, x) and (x[CLOSED_NOW] > 0 or penetrates(plan, w)):
        if not plan.constant:
            if not refactor(m, w, now + tau):
                return NOT_FINITE
            respond(m, w)
        put_on_surface(m, plan, w, now + tau)
        slide(m, w, within(plan, x, now + tau))
        measure(m, plan, w, x, now + tau)
    return FINISHED


def slide(m: Any, w: Any, t: float) -> None:
    """Velocities of closed contacts along the surface, against the drift of the integration."""
    gap_rates(m, t, w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
    for c in range(w.num.shape[1]):
        w.num[GAP_TRY, c] = (
            product(w.G, w.vec[V], c) + w.num[GAP_T, c] if w.mark[STATUS, c] == CLOSED else 0.0
        )
    newton_step(w, w.vec[V])


def touch(m: Any, plan: Any, w: Any, x: Any, z: Any, record: Any, t: float, c: int, count: Any) -> int:
    """Contact c lands at x[SIGMA]: an impact, or a touch without one."""
    still = ROUNDING * speed_terms(plan, w, c) if c != CORNER else 0.0
    if c != CORNER and w.num[RATE, c] >= -still:
        w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, GROUND
        if w.num[RATE, c] <= still or x[SIGMA] - w.num[LAST, c] <= SLOW * plan.h:
            stick(w, record, count, x, c, t)
            turn(m, plan, w, x, c, 0.0, False)
        w.num[LAST, c] = x[SIGMA]
        idle(x, count)
        return FINISHED
    if not acceleration(m, plan, w, x, t, w.vec[Q], w.vec[V], w.vec[A], count):
        return NOT_FINITE
    gap_rates(m, t, w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
    biases(m, plan, w, x, t, w.vec[Q], w.vec[V])
    if not plan.constant:
        if not refactor(m, w, t):
            return NOT_FINITE
        respond(m, w)
    for d in range(w.num.shape[1]):
        w.num[HALF, d] = 0.5 * (product(w.G, w.vec[A], d) + w.num[BIAS, d])
    n_s = strike(m, plan, w, x, record, c, t, count)
    if n_s <= 0:
        idle(x, count)
        return LCP_FAILED if n_s < 0 else FINISHED
    for k in range(n_s):  # rounding of the velocity must not be larger than that of small hops
        d = w.mark[CHOSEN, k]
        W, error = w.W[d, d], w.num[RATE, d] - product(w.G, w.vec[V], d) - w.num[GAP_T, d]
        if W > 0.0:
            for i in range(w.vec.shape[1]):
                w.vec[V, i] += w.MG[d, i] * error / W
    if record.on_events or record.every == 1:
        keep(w, record, count, t, 1.0)
    return FINISHED


@inline
def keep_now(w: Any, record: Any, count: Any, t: float, q: Any, v: Any) -> None:
    """Keep a state asked for."""
    write_row(record.rows[count[ROW]], t, 0.0, q, v, w.num[IMPULSE])
    count[ROW] += 1
