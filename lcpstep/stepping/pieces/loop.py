"""The loop of `Located`, as kernels: steps, and within each step the impacts at their own times.

A step is a chain of pieces of smooth motion (`smooth`). A piece ends where the first gap closes, at a corner of
the scene, or with the step; there the impulses are found (`impulses`), and the next piece begins with the
velocities after them. Gaps of contacts that have just fired count from zero, so a chain of ever shorter hops is
followed without loss of digits.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.course import AHEAD, ARRIVED, Stepwise
from lcpstep.kernels.dynamics import external_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.status import BUFFER_FULL, DONE, LCP_FAILED, NOT_FINITE, TOO_MANY_EVENTS
from lcpstep.kernels.vectors import clear, copy, finite, product, size_of_product
from lcpstep.pointers import abs, max
from lcpstep.stepping.pieces.carried import put_kept_back
from lcpstep.stepping.pieces.codes import AGAIN, CLOSED, CORNER, GROUND, NOBODY, OPEN, STOPPED
from lcpstep.stepping.pieces.corners import find_corners, go_beyond, obstacles_move
from lcpstep.stepping.pieces.event import remeasure
from lcpstep.stepping.pieces.glide import glide
from lcpstep.stepping.pieces.impulses import zero_speeds
from lcpstep.stepping.pieces.keep import keep, keep_now
from lcpstep.stepping.pieces.magnitudes import acceleration_terms
from lcpstep.stepping.pieces.scan import closing_now
from lcpstep.stepping.pieces.settle import settle
from lcpstep.stepping.pieces.smooth import free_acceleration, gap_bias, measure, respond
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within
from lcpstep.stepping.steps import LATE


class Steps(Stepwise):
    """The loop over steps, and over the pieces of motion in a step; how a piece begins and goes on is an order's own.

    tau      how long the piece at hand is,
    found    whose event ends it, or NOBODY,
    ends     and whether it ends with the smooth interval
    gliding  whether one linear degree of freedom goes on in registers while nothing happens
    told     whether the velocities of all gaps are compared at both ends of a piece, to find jumps: of flat
             contacts, by order 2; else those of closed contacts, which must stay zero
    doubtful whether one of them may jump within the smooth interval
    own      kept states that are in the coordinates of the scene

    Parameters
    ----------
    m : Model;  plan : Plan;  w : Work, which has the record of the run
    """

    def __init__(self, m: Model, plan: Plan, w: Work) -> None:
        super().__init__()
        self.m, self.plan, self.w = m, plan, w
        self.gliding = self.ends = self.doubtful = False
        self.tau, self.found, self.own, self.told = 0.0, NOBODY, 0, False

    @cython.ccall
    def begin(self, t: float) -> int:
        """The initial state, at time t; a code."""
        with cython.nogil:
            return begin_motion(self.m, self.plan, self.w, t)

    @cython.ccall
    def put_back(self, end: int) -> None:
        """Kept states up to before the end, which are in the kernels' coordinates, in those of the scene."""
        if end > self.own:
            put_kept_back(self.m, self.w.record, self.own, end)
            self.own = end

    def stage(self, goal: int) -> int:
        """Whether there are steps to be taken."""
        return AHEAD if self.w.steps < goal else ARRIVED

    def move(self) -> int:
        """A step, or the rest of it; says why no more can be taken."""
        t0, first = self.t0, self.first
        if not self.w.under_way:
            if self.gliding and (self.w.n_c == 0 or self.w.status[0] == OPEN):
                if self.w.pausing:
                    end = self.w.record.quiet_until(self.w.steps, self.plan.h, t0, first, self.last)
                else:
                    end = self.w.record.untimed_until(self.plan.h, t0, first, self.last)
                glide(self.m, self.plan, self.w, t0, first, end)
                if self.w.steps >= self.last:
                    return DONE
            begin_step(self.m, self.plan, self.w)
        self.w.t_step = t0 + self.plan.h * (self.w.steps - first)
        code = self.step()
        if code != DONE:
            return code
        t_next = self.w.goal if self.w.pausing else t0 + self.plan.h * (self.w.steps + 1 - first)
        return end_step(self.plan, self.w, t_next)

    def step(self) -> int:
        """The rest of the step: from w.sigma to its end."""
        while True:
            if self.w.record.full(4 * self.w.n_c + 4):
                return BUFFER_FULL
            if self.w.record.event + self.w.idle > self.w.events_left:
                return TOO_MANY_EVENTS
            self.found, code = NOBODY, DONE
            if self.w.sigma >= self.w.end:
                if self.w.end >= self.plan.h:
                    return DONE
                code = self.begin_interval()
            if self.found == NOBODY and code == DONE:
                code = self.piece()
            if self.found != NOBODY and code == DONE:
                code = self.take_event()
            if code == LCP_FAILED and not (is_finite(self.w) and finite(self.w.W, self.w.n_c * self.w.n_c)):
                return NOT_FINITE
            if code != DONE and code != AGAIN:
                return code

    def piece(self) -> int:
        """One piece of motion, up to the event that ends it; AGAIN where the motion goes on otherwise."""
        code = self.begin_piece()
        if code != DONE:
            return code
        if self.w.stalled > 0.0 or self.w.events > self.plan.per_step:  # without end
            code = settle(self.m, self.plan, self.w)
            return AGAIN if code == DONE else code
        code = self.find()
        if code != DONE:
            return code
        code = self.follow()
        return STOPPED if code == DONE and self.w.blind > 0.0 else code

    def take_event(self) -> int:
        """The event that was found; STOPPED where steps by a tolerance want to look at it."""
        pausing = self.w.pausing and self.found != CORNER
        if pausing:
            copy(self.w.v_struck, self.w.v, self.w.n_q)
        code = self.strike()
        return STOPPED if pausing and code == DONE else code

    def begin_interval(self) -> int:
        """The smooth interval from w.sigma to the next corner or the end of the step.

        `found` is CORNER if it begins at one at which velocities of gaps may jump, a contact if the start strikes it.
        """
        now, self.found = self.w.t_step + self.w.sigma, NOBODY
        if now >= self.w.high - self.w.margin:
            self.w.low, self.w.high = find_corners(self.plan, self.w, now)
            if self.w.jump not in (self.w.low, self.w.high):
                self.w.margin = self.plan.margin
            jumps = self.w.low == self.w.jump
            if jumps or obstacles_move(self.m):
                self.found = CORNER
            if jumps and not self.m.flat:
                go_beyond(self.m, self.w, now)
            if not self.pass_corner(now):
                return NOT_FINITE
        self.end_interval()
        if self.w.fresh:
            self.w.fresh = False
            # What rests takes part: there was no time for the forces to part them
            if self.found == NOBODY and self.w.closed_now > 0:
                self.found = closing_now(self.w)
        return DONE

    def end_interval(self) -> None:
        """Where the smooth interval at hand ends within the step."""
        t = self.w.t_step
        self.w.end = self.plan.h
        if t + self.plan.h > self.w.high + self.w.margin:
            self.w.end = max(self.w.high - t, self.w.sigma)
        self.doubtful = not self.told
        self.next_forces(t + self.w.end)

    def cut(self) -> int:
        """A velocity jumps within the piece, where the interval ends now; steps by a tolerance are made again."""
        self.end_interval()
        return STOPPED if self.w.pausing else AGAIN

    # --- what the orders differ in -----------------------------------------------------------------------------

    def pass_corner(self, t: float) -> bool:
        """What is kept of the forces at time t, at which they may jump; False where the mass matrix fails."""
        return True

    def next_forces(self, t: float) -> None:
        """What is to be known of the end t of a smooth interval."""

    def begin_piece(self) -> int:
        """Accelerations and contact forces at w.sigma; AGAIN if there is nothing to be gone through."""
        return NOT_FINITE

    def find(self) -> int:
        """How far the piece goes that begins at w.sigma: `tau`, `found` and `ends`."""
        return NOT_FINITE

    def measure_at(self, t: float, tau: float) -> None:
        """State, Jacobian and rates of gaps at tau after the base, which is at t, into w.q_try and others."""

    def follow(self) -> int:
        """Go on by `tau`."""
        return NOT_FINITE

    def strike(self) -> int:
        """The event at w.sigma of the contact that was `found`, or of a corner, and what it changes."""
        return NOT_FINITE


def end_step(plan: Plan, w: Work, t: float) -> int:
    """What is kept where a step ends, at time t; whether the run goes on.

    States asked for at rounding after it are the next step's, which an impact may begin; at the span's end none is.
    """
    late = t + LATE * plan.h + 4.0 * RESOLUTION * abs(t)
    keep_now(w, late if late >= plan.clock.t_end else t)
    w.steps += 1
    w.under_way = False
    if not (is_finite(w) and finite(w.impulse, w.n_c)):
        return NOT_FINITE
    if w.record.is_due(w.steps):
        keep(w, t, 0.0, w.q, w.v)
    return DONE


def begin_step(m: Model, plan: Plan, w: Work) -> None:
    """Nothing has happened in this step yet, but for what happened at the very end of the last one."""
    end = w.sigma
    if w.events > 0 and w.closed_now > 0:
        zero_speeds(w, w.swing)
    if plan.plain and (w.events > 0 or w.closed_now > 0):
        remeasure(m, plan, w)
    if w.events > 0:
        w.settled = w.stalled = 0.0
        clear(w.swing, w.n_q)
    w.sigma = w.end = 0.0
    w.events, w.under_way = 0, True
    for c in range(w.n_c):
        w.hits[c] = w.close_hits[c] = 0
        w.last[c] = 0.0 if end > 0.0 and w.last[c] == end else -1.0
        w.turned[c] -= end


def is_finite(w: Work) -> bool:
    """Whether state and gaps are finite, and their accelerations in the last piece."""
    known = finite(w.q, w.n_q) and finite(w.v, w.n_q)
    return known and finite(w.gap, w.n_c) and finite(w.velocity, w.n_c) and finite(w.half, w.n_c)


def begin_motion(m: Model, plan: Plan, w: Work, t: float) -> int:
    """Forces, gaps and status of the initial state, which is kept where states are."""
    w.low, w.high = find_corners(plan, w, t)
    w.margin = plan.margin
    w.fresh = True
    if m.linear:
        external_force(m, within(w, t), w.q, w.v, w.force)
    elif not free_acceleration(m, w, within(w, t), w.q, w.v, w.a_free):
        return NOT_FINITE
    w.force_evaluations += 1
    if plan.steady:
        for i in range(w.n_q):
            w.a_free[i] = product(plan.A_inverse, w.force, i, w.n_q)
    measure(m, w, t)
    if plan.constant:
        respond(m, w)
        for c in range(w.n_c):
            w.alpha[c] = product(m.G, w.a_free, c, w.n_q)
    if not plan.plain:
        gap_bias(m, w, t, w.q, w.v)
    for c in range(w.n_c):
        if w.gap[c] <= plan.slack:
            w.gap[c], w.grounded[c] = 0.0, GROUND
            size = abs(w.gap_t[c]) + size_of_product(w.G, w.v, c, w.n_q)
            size += plan.h * acceleration_terms(m, w, c)
            # What its obstacle changes its velocity by in what time is rounded by, and moved off a corner
            rounded = (plan.margin + 4.0 * RESOLUTION * abs(t)) * abs(w.bias[c])
            if abs(w.velocity[c]) <= NOISE * size + rounded:
                w.velocity[c], w.status[c] = 0.0, CLOSED
                w.closed_now += 1
    if w.record.n_times == 0:
        keep(w, t, 0.0, w.q, w.v)
    keep_now(w, t)
    return DONE
