"""The loop of `Located`, as kernels: steps, and within each step the impacts at their own times.

A step is a chain of pieces of smooth motion (`smooth`). A piece ends where the first gap closes, at a corner of
the scene, or with the step; there the impulses are found (`impulses`), and the next piece begins with the
velocities after them. Gaps of contacts that have just fired count from zero, so a chain of ever shorter hops is
followed without loss of digits.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.dynamics import external_force, moves, obstacle
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import abs, max, min
    from lcpstep.stepping.pieces.carried import put_kept_back
    from lcpstep.stepping.pieces.codes import (
        BUFFER_FULL,
        CLOSED,
        CORNER,
        EPS,
        FINISHED,
        GROUND,
        LCP_FAILED,
        NOBODY,
        NOT_FINITE,
        OPEN,
        STOPPED,
        TOO_MANY_EVENTS,
    )
    from lcpstep.stepping.pieces.corners import find_corners, obstacles_move
    from lcpstep.stepping.pieces.event import event
    from lcpstep.stepping.pieces.glide import glide
    from lcpstep.stepping.pieces.jointed import joints_failed, turn_with_joints
    from lcpstep.stepping.pieces.keep import keep, keep_times
    from lcpstep.stepping.pieces.magnitudes import acceleration_terms
    from lcpstep.stepping.pieces.piece import begin_piece, first_contact, move, polish
    from lcpstep.stepping.pieces.race import race
    from lcpstep.stepping.pieces.settle import endless, settle
    from lcpstep.stepping.pieces.smooth import free_acceleration, measure, respond
    from lcpstep.stepping.pieces.state import Plan, Work
    from lcpstep.stepping.pieces.switches import idle
    from lcpstep.stepping.pieces.times import at_corner, just_after, within


def begin_motion(m: Model, plan: Plan, w: Work, record: Record, t: float) -> int:
    """Forces, gaps and status of the initial state, which is kept where states are."""
    w.low, w.high = find_corners(plan, t)
    if plan.trapezoidal:
        external_force(m, within(plan, w, t), w.q, w.v, w.force)
    elif not free_acceleration(m, w, within(plan, w, t), w.q, w.v, w.free):
        return NOT_FINITE
    w.force_evaluations += 1
    if plan.steady:
        for i in range(w.n_q):
            w.free[i] = product(plan.A_inverse, w.force, i, w.n_q)
    measure(m, plan, w, t)
    if plan.constant:
        respond(m, w)
        for c in range(w.n_c):
            w.alpha[c] = product(m.G, w.free, c, w.n_q)
    for c in range(w.n_c):
        if w.gap[c] <= plan.slack:
            w.gap[c], w.grounded[c] = 0.0, GROUND
            size = abs(w.gap_t[c]) + plan.h * acceleration_terms(m, w, c)
            for i in range(w.n_q):
                size += abs(w.G[c * w.n_q + i] * w.v[i])
            if abs(w.rate[c]) <= 64 * EPS * size:
                w.rate[c], w.status[c] = 0.0, CLOSED
                w.closed_now += 1
    if record.n_times == 0:
        keep(w, record, t, 0.0)
    elif record.times[0] == t:
        keep(w, record, t, 0.0)
        record.next_time = 1
    return FINISHED


class Steps:
    """Steps of `Located` of order two; those of the other orders differ in `step` (`polynomial_loop`).

    Parameters
    ----------
    m : Model;  plan : Plan;  w : Work;  record : Record
    """

    def __init__(self, m: Model, plan: Plan, w: Work, record: Record) -> None:
        self.m, self.plan, self.w, self.record = m, plan, w, record
        self.gliding = plan.trapezoidal and m.flat and m.n_c <= 1 and m.n_q == 1

    def begin(self, t: float) -> int:
        """The initial state, at time t; a code."""
        return self.start(t)

    def put_back(self) -> None:
        """Kept states, which are in the kernels' coordinates, in those of the scene."""
        put_kept_back(self.m, self.record)

    def start(self, t: float) -> int:
        """Kernel of `begin`."""
        with cython.nogil:
            return begin_motion(self.m, self.plan, self.w, self.record, t)

    def run(self, t0: float, first: int, last: int) -> int:
        """`take`, called from Python."""
        with cython.nogil:
            return self.take(t0, first, last)

    def take(self, t0: float, first: int, last: int) -> int:
        """Steps w.steps .. last - 1, step `first` beginning at t0; says why it returned."""
        while self.w.steps < last:
            if not self.w.under_way:
                if self.gliding and (self.w.n_c == 0 or self.w.status[0] == OPEN):
                    if self.w.pausing:
                        end = self.record.quiet_until(self.w.steps, self.plan.h, t0, first, last)
                    else:
                        end = self.record.untimed_until(self.plan.h, t0, first, last)
                    glide(self.m, self.plan, self.w, self.record, t0, first, end)
                    if self.w.steps >= last:
                        return FINISHED
                begin_step(self.w)
            t = t0 + self.plan.h * (self.w.steps - first)
            code = self.step(t)
            if code != FINISHED:
                return code
            t_next = self.w.goal if self.w.pausing else t0 + self.plan.h * (self.w.steps + 1 - first)
            code = end_step(self.plan, self.w, self.record, t_next)
            if code != FINISHED:
                return code
        return FINISHED

    def step(self, t: float) -> int:
        """The rest of the step that began at t: from w.sigma to its end."""
        return finish_step(self.m, self.plan, self.w, self.record, t)


def end_step(plan: Plan, w: Work, record: Record, t: float) -> int:
    """What is kept where a step ends, at time t; whether the run goes on."""
    late = just_after(plan, t)
    keep_times(w, record, late, late)
    w.steps += 1
    w.under_way = False
    if not finite(w):
        return NOT_FINITE
    code = joints_failed(w) if w.joined else FINISHED
    if code == FINISHED and record.is_due(w.steps):
        keep(w, record, t, 0.0)
    return code


def begin_step(w: Work) -> None:
    """Nothing has happened in this step yet, but for what happened at the very end of the last one."""
    end = w.sigma
    if w.events > 0:
        w.settled = w.stalled = 0.0
        for i in range(w.n_q):
            w.swing[i] = 0.0
    w.sigma = w.end = 0.0
    w.events, w.under_way = 0, True
    for c in range(w.n_c):
        w.hits[c] = w.close_hits[c] = 0
        w.last[c] = 0.0 if end > 0.0 and w.last[c] == end else -1.0
        w.turned[c] -= end


def finish_step(m: Model, plan: Plan, w: Work, record: Record, t: float) -> int:
    """The rest of the step that began at t: from w.sigma to its end."""
    n_c = w.n_c
    while True:
        if record.full(4 * n_c + 4) or record.row + 4 > record.row_capacity:
            return BUFFER_FULL
        if record.event + w.idle > w.events_left:
            return TOO_MANY_EVENTS
        c = NOBODY
        if w.sigma >= w.end:
            if w.end >= plan.h:
                return FINISHED
            c = CORNER if begin_interval(m, plan, w, t) else NOBODY
        if c == NOBODY:
            if not begin_piece(m, plan, w, record, t + w.sigma):
                return LCP_FAILED if finite(w) else NOT_FINITE
            if endless(plan, w):
                code = settle(m, plan, w, record, t)
                if code != FINISHED:
                    return code
                continue
            rest = w.end - w.sigma
            tau = rest
            if w.blind > 0.0:
                tau = min(rest, w.blind)
            else:
                c, tau = first_contact(plan, w, rest, t + w.end)
                if c != NOBODY and not plan.plain:
                    c, tau = polish(m, plan, w, c, t + w.sigma, tau, rest)
                if c != NOBODY and plan.plain and plan.steady and racing(w, record, t):
                    done = race(m, plan, w, record, t, w.sigma, w.end, room(plan, w, record))
                    if done > 0:
                        w.sigma = w.q_time[0]
                        w.events += done
                        continue
                if c != NOBODY and at_corner(plan, w, t + w.sigma + tau):
                    c, tau = NOBODY, rest
                if c == NOBODY and tau < rest:
                    idle(w)
            code = move(m, plan, w, record, t, tau, c == NOBODY and tau == rest)
            if code == FINISHED and w.blind > 0.0:
                code = STOPPED
            if code != FINISHED:
                return code
        if c != NOBODY:
            code = struck(m, plan, w, record, t, c)
            if code != FINISHED:
                return code


def struck(m: Model, plan: Plan, w: Work, record: Record, t: float, c: int) -> int:
    """The impact of a contact or of a corner; STOPPED where steps by a tolerance want to look at it."""
    pausing = w.pausing and c != CORNER
    if pausing:
        copy(w.v_struck, w.v, w.n_q)
    code = event(m, plan, w, record, t, c)
    return STOPPED if pausing and code == FINISHED else code


def room(plan: Plan, w: Work, record: Record) -> int:
    """How many impacts may be taken in turn."""
    most, left = w.events_left - record.event, plan.per_step - w.events
    most = (left if left < most else most) + 1
    left = record.event_capacity - record.event - 4 * w.n_c
    most = left if left < most else most
    left = record.row_capacity - record.row - 4
    return left if left < most else most


def racing(w: Work, record: Record, t: float) -> bool:
    """Whether impacts of several bodies in free flight may be taken in turn, no state being asked for meanwhile."""
    wanted = record.next_time < record.n_times and record.times[record.next_time] <= t + w.end
    return w.n_c > 1 and w.closed_now == 0 and not wanted


def begin_interval(m: Model, plan: Plan, w: Work, t: float) -> bool:
    """The smooth interval from w.sigma to the next corner or the end of the step; forces at its ends.

    Whether it begins at a corner at which velocities of gaps may jump.
    """
    now, turns = t + w.sigma, False
    if now >= w.high - plan.margin:
        w.low, w.high = find_corners(plan, now)
        turns = obstacles_move(m) or plan.joined
        if plan.trapezoidal and not plan.steady:
            external_force(m, within(plan, w, now), w.q, w.v, w.force)
        elif not plan.trapezoidal:
            if w.joined:
                turn_with_joints(w, within(plan, w, now))
            free_acceleration(m, w, within(plan, w, now), w.q, w.v, w.free)
        w.force_evaluations += 1
    w.end = plan.h
    if t + plan.h > w.high + plan.margin:
        w.end = max(w.high - t, w.sigma)
    end = within(plan, w, t + w.end)
    if plan.trapezoidal and not plan.steady:
        external_force(m, end, w.q, w.v, w.next_force)
        w.force_evaluations += 1
    if m.flat and moves(m):
        obstacle(m, end, w.q, w.v)
        for c in range(w.n_c):
            w.end_s[c] = m.motion_now[c * 3 + 2]
    return turns


def finite(w: Work) -> bool:
    """Whether state and gaps are finite, and their accelerations in the last piece."""
    total = 0.0
    for i in range(w.n_q):
        total += (w.q[i] - w.q[i]) + (w.v[i] - w.v[i])
    for c in range(w.n_c):
        total += (w.gap[c] - w.gap[c]) + (w.rate[c] - w.rate[c])
        total += w.half[c] - w.half[c]
    return total == 0.0
