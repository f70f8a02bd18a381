"""Steps of `Located` of order four and of exact motion, as kernels: pieces of motion that are polynomials.

Events are searched for on the polynomial (`scan`): landings, and releases where a contact force vanishes.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gap_rates, moves
from lcpstep.kernels.model import Model
from lcpstep.kernels.quadrature import NODES_4, WEIGHTS_4
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import DONE, LCP_FAILED, NOT_FINITE
from lcpstep.kernels.vectors import copy, distance, product
from lcpstep.pointers import abs, max, min
from lcpstep.stepping.pieces.codes import AGAIN, CLOSED, CORNER, LEFT, NOBODY
from lcpstep.stepping.pieces.event import straighten_struck, take_touch
from lcpstep.stepping.pieces.impulses import strike
from lcpstep.stepping.pieces.jumps import find_jump
from lcpstep.stepping.pieces.keep import keep_event
from lcpstep.stepping.pieces.loop import Steps
from lcpstep.stepping.pieces.magnitudes import acceleration_terms, velocity_of
from lcpstep.stepping.pieces.piece import penetrates
from lcpstep.stepping.pieces.polynomial import (
    Polynomial,
    acceleration,
    expand,
    force_at,
    on_surface,
    state_at,
)
from lcpstep.stepping.pieces.polynomial_forces import UNDECIDED, load
from lcpstep.stepping.pieces.scan import LOW, NOWHERE, first_landing, first_release, hop_at, is_low
from lcpstep.stepping.pieces.smooth import (
    gap_bias,
    measure,
    newton_step,
    put_on_surface,
    renew_mobility,
    settle_state,
)
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import idle, release
from lcpstep.stepping.pieces.times import at_corner, untold, within

SLOW = 1e-3  # of a step: a touch is no event twice within so short a time


class PolynomialSteps(Steps):
    """Steps of order four, or of exact motion; parameters are those of `Steps`.

    z        the polynomial of the piece at hand
    watched  whether obstacles or rows by the place have velocities that may jump (`jumps`)
    opens    whether the contact that ends the piece loses its force there, and does not land
    """

    def __init__(self, m: Model, plan: Plan, w: Work) -> None:
        super().__init__(m, plan, w)
        self.z, self.opens = Polynomial(m.n_q, m.n_c), False
        self.watched = not plan.exact and (moves(m) or not m.flat)

    def begin_piece(self) -> int:
        """Accelerations, and which contacts are closed."""
        now = self.w.t_step + self.w.sigma
        # Of so short a rest positions cannot tell the ends apart
        if self.w.end - self.w.sigma <= untold(now, self.plan.h):
            self.w.sigma = self.w.end
            return AGAIN
        length = min(self.w.end - self.w.sigma, self.plan.longest)
        return DONE if load(self.m, self.plan, self.w, self.z, now, length) else LCP_FAILED

    def find(self) -> int:
        """The polynomial, and the first event on it."""
        now, length = self.w.t_step + self.w.sigma, min(self.w.end - self.w.sigma, self.plan.longest)
        self.found, self.opens, self.tau = NOBODY, False, length
        if not expand(self.m, self.plan, self.w, self.z, now, length):
            return NOT_FINITE
        if self.watched and is_off(self.w, self.z) and find_jump(self, self.w, now, length):
            self.w.ahead = UNDECIDED if self.w.ahead > 0.0 else 0.0
            return self.cut()
        if self.w.blind > 0.0:
            self.tau = min(length, self.w.blind)
        else:
            self.found, stop = first_release(self.m, self.plan, self.w, self.z, length)
            landing, self.tau = first_landing(self.m, self.plan, self.w, self.z, stop)
            if landing == NOWHERE:
                return NOT_FINITE
            if landing != NOBODY and at_corner(self.plan, self.w, now + self.tau):
                landing, self.tau = NOBODY, stop
            self.opens = landing == NOBODY and self.found != NOBODY
            if not self.opens:
                self.found = landing
        self.ends = self.found == NOBODY and self.tau == length
        self.ends = self.ends and self.w.sigma + length >= self.w.end * (1.0 - RESOLUTION)
        return DONE

    def measure_at(self, t: float, tau: float) -> None:
        """State and gaps at tau after the base, on the polynomial."""
        state_at(self.m, self.plan, self.w, self.z, tau)
        copy(self.w.q_try, self.z.q, self.w.n_q)
        copy(self.w.v_try, self.z.v, self.w.n_q)
        at = within(self.w, t + tau)
        gap_rates(self.m, at, self.w.q_try, self.w.v_try, self.w.G_try, self.w.gap_t_try)

    def follow(self) -> int:
        """Go on along the polynomial."""
        return follow(self.m, self.plan, self.w, self.z, self.tau, self.ends)

    def strike(self) -> int:
        """A contact opens, or lands, or a corner turns velocities."""
        now = self.w.t_step + self.w.sigma
        if self.found != CORNER and self.opens:
            lose_force(self.m, self.plan, self.w, now, self.found)
            return DONE
        return land(self.m, self.plan, self.w, now, self.found)


def is_off(w: Work, z: Polynomial) -> bool:
    """Whether a closed contact has a velocity at the end of a Runge-Kutta step, of which Jacobian and rates are."""
    doubtful = False
    for c in range(w.n_c):
        if w.status[c] == CLOSED:
            u = product(w.G, z.v_stage, c, w.n_q) + w.gap_t[c]
            doubtful = doubtful or abs(u) > w.sudden.drift
    return doubtful


def lose_force(m: Model, plan: Plan, w: Work, t: float, c: int) -> None:
    """The force of closed contact c has vanished: it opens, or where others are closed they decide together."""
    if w.closed_now > 1:
        w.ahead, w.grounded[c] = UNDECIDED, LEFT
        idle(w)
        return
    release(m, plan, w, c, t, 0.0)
    w.grounded[c] = LEFT
    keep_event(w, t)


def follow(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float, ends: bool) -> int:
    """Go on to w.sigma + tau along the polynomial."""
    now = w.t_step + w.sigma
    end = now + tau - untold(now + tau, plan.h)  # to rounding: states there come after the impact
    while w.record.awaited() < end:
        state_at(m, plan, w, z, max(0.0, w.record.awaited() - now))
        settle_state(m, plan, w, w.record.awaited(), z.q)
        w.record.keep_awaited(z.q, z.v, w.impulse)
    w.sigma = w.end if ends else w.sigma + tau
    if tau == 0.0:
        return DONE
    if w.closed_now > 0:
        for k in range(4):
            if not force_at(m, plan, w, z, NODES_4[k] * tau):
                return NOT_FINITE
            for c in range(w.n_c):
                p = WEIGHTS_4[k] * tau * max(w.p[c], 0.0)  # else a zero's rounding
                w.impulse[c] += p
                w.pushed[c] += p
    state_at(m, plan, w, z, tau)
    copy(w.q, z.q, w.n_q)
    copy(w.v, z.v, w.n_q)
    for c in range(w.n_c):
        w.grounded[c] = 0
        z.gap_to[c] = fine_gap(m, plan, w, z, tau, c)
    measure(m, w, now + tau)
    if not on_surface(plan, w) and (w.closed_now > 0 or penetrates(plan, w)):
        if not renew_mobility(m, plan, w, now + tau):
            return NOT_FINITE
        put_on_surface(m, plan, w, now + tau, w.q)
        w.off = distance(w.q, z.q, w.n_q)
        slide(m, w, within(w, now + tau))
        measure(m, w, now + tau)
    for c in range(w.n_c):
        if z.gap_to[c] > plan.slack:
            w.gap[c] = z.gap_to[c]
    return DONE


def fine_gap(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float, c: int) -> float:
    """A low gap at tau after the base of the piece, finer than positions tell; 0 where they tell enough.

    A landing that follows in another piece would be late by their rounding over its speed, which grows in chattering.
    """
    if w.status[c] == CLOSED or not is_low(plan, w, tau, c):
        return 0.0
    mean, _ = hop_at(m, plan, w, z, tau, c)
    return tau * mean if tau * mean <= LOW * plan.slack else 0.0


def slide(m: Model, w: Work, t: float) -> None:
    """Velocities of closed contacts along the surface, against the drift of the integration."""
    gap_rates(m, t, w.q, w.v, w.G, w.gap_t)
    for c in range(w.n_c):
        w.gap_try[c] = velocity_of(w, c) if w.status[c] == CLOSED else 0.0
    newton_step(w, w.v)


def land(m: Model, plan: Plan, w: Work, t: float, c: int) -> int:
    """Contact c lands at w.sigma: an impact, or a touch without one."""
    if c != CORNER:
        again = w.sigma - w.last[c] <= SLOW * plan.h
        slow = SLOW * plan.h * acceleration_terms(m, w, c) if again else 0.0
        if take_touch(m, plan, w, c, t, slow):
            w.last[c] = w.sigma
            return DONE
    if not acceleration(m, plan, w, t, w.q, w.v, w.a):
        return NOT_FINITE
    gap_rates(m, t, w.q, w.v, w.G, w.gap_t)
    gap_bias(m, w, t, w.q, w.v)
    if not renew_mobility(m, plan, w, t):
        return NOT_FINITE
    for d in range(w.n_c):  # by which `is_over` judges the next hop
        w.half[d] = 0.5 * (product(w.G, w.a, d, w.n_q) + w.bias[d])
    n_s = strike(m, plan, w, c, t)
    if n_s <= 0:
        idle(w)
        return LCP_FAILED if n_s < 0 else DONE
    straighten_struck(m, w, t, n_s)  # rounding of the velocity must not be larger than that of small hops
    keep_event(w, t)
    return DONE
