"""Steps of `Located` of order two, as kernels: pieces of motion with one acceleration, gaps that are quadratics.

A piece ends where the first gap closes (`piece`), at a corner of the scene, or with the step; there the impulses are
found (`event`). Impacts of many bodies in free flight are taken in turn (`race`).
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import external_force, gap_rates, moves, obstacle
from lcpstep.kernels.model import Model
from lcpstep.kernels.status import DONE, LCP_FAILED
from lcpstep.kernels.vectors import product
from lcpstep.pointers import abs, min
from lcpstep.stepping.pieces.codes import AGAIN, NOBODY
from lcpstep.stepping.pieces.event import event
from lcpstep.stepping.pieces.jumps import find_jump
from lcpstep.stepping.pieces.loop import Steps
from lcpstep.stepping.pieces.piece import begin_piece, first_contact, move, polish
from lcpstep.stepping.pieces.race import race
from lcpstep.stepping.pieces.smooth import look_along, renew_forces
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import idle
from lcpstep.stepping.pieces.times import at_corner, within


class QuadraticSteps(Steps):
    """Steps of order two; parameters are those of `Steps`."""

    def __init__(self, m: Model, plan: Plan, w: Work) -> None:
        super().__init__(m, plan, w)
        self.told = m.flat
        self.gliding = plan.constant and m.n_c <= 1 and m.n_q == 1

    def pass_corner(self, t: float) -> bool:
        """Forces on the far side of a corner."""
        return renew_forces(self.m, self.plan, self.w, t)

    def next_forces(self, t: float) -> None:
        """Forces, and what moves obstacles, at the end of a smooth interval.

        Since the end of the one before, where this one begins, an obstacle's velocity may have jumped where it is
        another than the accelerations make it.
        """
        near, length = within(self.w, t), self.w.end - self.w.sigma
        if self.m.linear and not self.plan.steady:
            external_force(self.m, near, self.w.q, self.w.v, self.w.next_force)
            self.w.force_evaluations += 1
        if self.m.flat and moves(self.m):
            obstacle(self.m, near, self.w.q, self.w.v)
            for c in range(self.w.n_c):
                u, s = self.m.motion_now[c * 3 + 1], self.m.motion_now[c * 3 + 2]
                change = 0.5 * length * (self.w.end_s[c] + s)
                off = abs(u - self.w.end_u[c] - change)
                self.doubtful = self.doubtful or off > self.w.sudden.drift
                self.w.end_u[c], self.w.end_s[c] = u, s

    def begin_piece(self) -> int:
        """Accelerations and gap quadratics."""
        return DONE if begin_piece(self.m, self.plan, self.w, self.w.t_step + self.w.sigma) else LCP_FAILED

    def find(self) -> int:
        """The first gap that closes; AGAIN after impacts of many bodies."""
        rest = self.w.end - self.w.sigma
        self.found, self.tau = NOBODY, rest
        if self.doubtful and find_jump(self, self.w, self.w.t_step + self.w.sigma, rest):
            return self.cut()
        if self.w.blind > 0.0:
            self.tau = min(rest, self.w.blind)
        else:
            self.found, self.tau = closing(self.m, self.plan, self.w, rest)
            if self.found != NOBODY and take_in_turn(self.m, self.plan, self.w):
                return AGAIN
        self.ends = self.found == NOBODY and self.tau == rest
        return DONE

    def measure_at(self, t: float, tau: float) -> None:
        """State, Jacobian and rates of gaps at tau after the base, along the quadratics.

        Of flat contacts what obstacles alone make, beside accelerations that are linear over the piece.
        """
        look_along(self.w, tau)
        at = within(self.w, t + tau)
        gap_rates(self.m, at, self.w.q_try, self.w.v_try, self.w.G_try, self.w.gap_t_try)
        for c in range(self.w.n_c if self.m.flat and moves(self.m) else 0):
            begins = -2.0 * self.w.bias[c] - self.w.end_s[c]
            mean = begins + 0.5 * tau / (self.w.end - self.w.sigma) * (self.w.end_s[c] - begins)
            own = mean - product(self.m.G, self.w.a, c, self.w.n_q)
            self.w.gap_t_try[c] = self.w.gap_t_try[c] + tau * own

    def follow(self) -> int:
        """Go on along the quadratics."""
        return move(self.m, self.plan, self.w, self.tau, self.ends)

    def strike(self) -> int:
        """The impact of a contact, or that of a corner."""
        return event(self.m, self.plan, self.w, self.found)


def closing(m: Model, plan: Plan, w: Work, rest: float) -> tuple[int, float]:
    """Which gap closes first in the rest of the smooth interval, and when; or NOBODY and how far one can go.

    One that closes later than its quadratic says, or never, hides none that closes before.
    """
    found, until, past, but, searching = NOBODY, rest, -1.0, NOBODY, True
    now = w.t_step + w.sigma
    while searching:
        c, tau = first_contact(plan, w, until, w.t_step + w.end, past, but)
        past, but, searching = tau, c, c != NOBODY and not plan.plain
        if searching:
            c, tau = polish(m, plan, w, c, now, tau, rest)
        if tau < until or (c != NOBODY and found == NOBODY):
            found, until = c, tau
    if found != NOBODY and at_corner(plan, w, now + until):
        return NOBODY, rest
    if found == NOBODY and until < rest:
        idle(w)
    return found, until


def take_in_turn(m: Model, plan: Plan, w: Work) -> bool:
    """Impacts of many bodies, one after another, where these can be followed so; whether there were any."""
    if not (plan.plain and plan.steady and w.n_c > 1 and w.closed_now == 0):
        return False
    return race(m, plan, w, room(plan, w)) > 0


def room(plan: Plan, w: Work) -> int:
    """How many impacts may be taken in turn."""
    most, left = w.events_left - w.record.event, plan.per_step - w.events
    most = (left if left < most else most) + 1
    left = w.record.event_capacity - w.record.event - 4 * w.n_c
    most = left if left < most else most
    left = w.record.row_capacity - w.record.row - 4
    return left if w.record.keeps_events() and left < most else most
