"""The loop of `Located` of order four and of exact motion, as kernels: steps made of polynomial pieces.

Like `loop`, but a piece is a polynomial (`polynomial`) on which events are searched for (`scan`): landings,
and releases where a contact force vanishes.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.dynamics import gap_rates
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import abs, max, min
    from lcpstep.stepping.pieces.codes import (
        BUFFER_FULL,
        CLOSED,
        CORNER,
        EPS,
        FINISHED,
        GROUND,
        LCP_FAILED,
        LEFT,
        NOBODY,
        NOT_FINITE,
        ROUNDING,
        SAME_TIME,
        STOPPED,
        TOO_MANY_EVENTS,
    )
    from lcpstep.stepping.pieces.corners import find_corners, obstacles_move
    from lcpstep.stepping.pieces.impulses import strike
    from lcpstep.stepping.pieces.keep import keep
    from lcpstep.stepping.pieces.loop import Steps, finite
    from lcpstep.stepping.pieces.magnitudes import speed_terms
    from lcpstep.stepping.pieces.piece import penetrates
    from lcpstep.stepping.pieces.polynomial import (
        NODES,
        WEIGHTS,
        Polynomial,
        acceleration,
        biases,
        expand,
        force_at,
        on_surface,
        state_at,
    )
    from lcpstep.stepping.pieces.polynomial_forces import UNDECIDED, load
    from lcpstep.stepping.pieces.scan import NOWHERE, first_landing, first_release
    from lcpstep.stepping.pieces.settle import endless, settle
    from lcpstep.stepping.pieces.smooth import (
        measure,
        newton_step,
        put_on_surface,
        refactor,
        respond,
        settle_state,
    )
    from lcpstep.stepping.pieces.state import Plan, Work
    from lcpstep.stepping.pieces.switches import idle, release, stick, turn
    from lcpstep.stepping.pieces.times import at_corner, within

SLOW = 1e-3  # of a step: a touch is no event twice within so short a time


class PolynomialSteps(Steps):
    """Steps of order four, or of exact motion.

    Parameters
    ----------
    m : Model;  plan : Plan;  w : Work;  record : Record
    """

    def __init__(self, m: Model, plan: Plan, w: Work, record: Record) -> None:
        super().__init__(m, plan, w, record)
        self.gliding, self.z = False, Polynomial(m.n_q, m.n_c)

    def step(self, t: float) -> int:
        """The rest of the step that began at t: from w.sigma to its end."""
        return step(self.m, self.plan, self.w, self.z, self.record, t)


def step(m: Model, plan: Plan, w: Work, z: Polynomial, record: Record, t: float) -> int:
    """The rest of the step that began at t: from w.sigma to its end."""
    n_c = w.n_c
    while True:
        if record.full(4 * n_c + 4) or record.row + 4 > record.row_capacity:
            return BUFFER_FULL
        if record.event + w.idle > w.events_left:
            return TOO_MANY_EVENTS
        now = t + w.sigma
        if w.sigma >= w.end:
            if w.end >= plan.h:
                return FINISHED
            if now >= w.high - plan.margin:
                w.low, w.high = find_corners(plan, now)
                if obstacles_move(m):
                    code = touch(m, plan, w, z, record, now, CORNER)
                    if code != FINISHED:
                        return code
            w.end = plan.h
            if t + plan.h > w.high + plan.margin:
                w.end = max(w.high - t, w.sigma)
            continue
        if w.end - w.sigma <= SAME_TIME * (
            abs(now) + plan.h
        ):  # too short for positions to tell its ends apart
            w.sigma = w.end
            continue
        length = min(w.end - w.sigma, plan.longest)
        if not load(m, plan, w, z, record, now, length):
            return LCP_FAILED if finite(w) else NOT_FINITE
        if endless(plan, w):
            code = settle(m, plan, w, record, t)
            if code != FINISHED:
                return code
            continue
        if not expand(m, plan, w, z, now, length):
            return NOT_FINITE
        if w.blind > 0.0:
            opening, landing, tau = NOBODY, NOBODY, min(length, w.blind)
        else:
            opening, stop = first_release(m, plan, w, z, now, length)
            landing, tau = first_landing(m, plan, w, z, now, stop)
            if landing == NOWHERE:
                return NOT_FINITE
        if landing != NOBODY and at_corner(plan, w, now + tau):
            landing, tau = NOBODY, stop
        ends = landing == NOBODY and opening == NOBODY and tau == length
        ends = ends and w.sigma + length >= w.end * (1.0 - EPS)
        code = follow(m, plan, w, z, record, t, tau, ends)
        if code == FINISHED and w.blind > 0.0:
            code = STOPPED
        if code != FINISHED:
            return code
        if w.pausing:
            copy(w.v_struck, w.v, w.n_q)
        if landing != NOBODY:
            code = touch(m, plan, w, z, record, t + w.sigma, landing)
            if code != FINISHED:
                return code
        elif opening != NOBODY:
            lose_force(m, plan, w, record, t + w.sigma, opening)
        if w.pausing and (landing != NOBODY or opening != NOBODY):
            return STOPPED


def lose_force(m: Model, plan: Plan, w: Work, record: Record, t: float, c: int) -> None:
    """The force of closed contact c has vanished: it opens, or where others are closed they decide together."""
    if w.closed_now > 1:
        w.ahead = UNDECIDED
        idle(w)
        return
    release(m, plan, w, record, c, t, 0.0)
    w.grounded[c] = LEFT
    if record.keeps_events():
        keep(w, record, t, 1.0)


def follow(
    m: Model, plan: Plan, w: Work, z: Polynomial, record: Record, t: float, tau: float, ends: bool
) -> int:
    """Go on to w.sigma + tau along the polynomial."""
    now = t + w.sigma
    end = now + tau - SAME_TIME * (abs(now + tau) + plan.h)  # to rounding: states there come after the impact
    while record.next_time < record.n_times and record.times[record.next_time] < end:
        state_at(m, plan, w, z, now, max(0.0, record.times[record.next_time] - now))
        settle_state(m, plan, w, record.times[record.next_time], z.q)
        record.keep(record.times[record.next_time], 0.0, z.q, z.v, w.impulse)
        record.next_time += 1
    w.sigma = w.end if ends else w.sigma + tau
    if tau == 0.0:
        return FINISHED
    if w.closed_now > 0:
        for k in range(4):
            if not force_at(m, plan, w, z, now, NODES[k] * tau):
                return NOT_FINITE
            for c in range(w.n_c):
                w.impulse[c] += WEIGHTS[k] * tau * max(w.p[c], 0.0)  # else a zero's rounding
    state_at(m, plan, w, z, now, tau)
    copy(w.q, z.q, w.n_q)
    copy(w.v, z.v, w.n_q)
    for c in range(w.n_c):
        w.grounded[c] = 0
    measure(m, plan, w, now + tau)
    if not on_surface(m, plan, w) and (w.closed_now > 0 or penetrates(plan, w)):
        if not plan.constant:
            if not refactor(m, w, now + tau):
                return NOT_FINITE
            respond(m, w)
        put_on_surface(m, plan, w, now + tau)
        slide(m, w, within(plan, w, now + tau))
        measure(m, plan, w, now + tau)
    return FINISHED


def slide(m: Model, w: Work, t: float) -> None:
    """Velocities of closed contacts along the surface, against the drift of the integration."""
    gap_rates(m, t, w.q, w.v, w.G, w.gap_t)
    for c in range(w.n_c):
        w.gap_try[c] = product(w.G, w.v, c, w.n_q) + w.gap_t[c] if w.status[c] == CLOSED else 0.0
    newton_step(w, w.v)


def touch(m: Model, plan: Plan, w: Work, z: Polynomial, record: Record, t: float, c: int) -> int:
    """Contact c lands at w.sigma: an impact, or a touch without one."""
    still = ROUNDING * speed_terms(plan, w, c) if c != CORNER else 0.0
    if c != CORNER and w.rate[c] >= -still:
        w.gap[c], w.grounded[c] = 0.0, GROUND
        if w.rate[c] <= still or w.sigma - w.last[c] <= SLOW * plan.h:
            stick(w, record, c, t)
            turn(m, plan, w, c, 0.0, False)
        w.last[c] = w.sigma
        idle(w)
        return FINISHED
    if not acceleration(m, plan, w, t, w.q, w.v, w.a):
        return NOT_FINITE
    gap_rates(m, t, w.q, w.v, w.G, w.gap_t)
    biases(m, plan, w, t, w.q, w.v)
    if not plan.constant:
        if not refactor(m, w, t):
            return NOT_FINITE
        respond(m, w)
    for d in range(w.n_c):
        w.half[d] = 0.5 * (product(w.G, w.a, d, w.n_q) + w.bias[d])
    n_s = strike(m, plan, w, record, c, t)
    if n_s <= 0:
        idle(w)
        return LCP_FAILED if n_s < 0 else FINISHED
    for k in range(n_s):  # rounding of the velocity must not be larger than that of small hops
        d = w.chosen[k]
        W, error = w.W[d * w.n_c + d], w.rate[d] - product(w.G, w.v, d, w.n_q) - w.gap_t[d]
        if W > 0.0:
            for i in range(w.n_q):
                w.v[i] += w.MG[d * w.n_q + i] * error / W
    if record.keeps_events():
        keep(w, record, t, 1.0)
    return FINISHED
