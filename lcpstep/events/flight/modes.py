"""What happens on the obstacle, as kernels: impact, chattering, rest, release, and corners of the obstacle's motion.

    u+ = -r u-                      an impact (Newton's law), with the impulse -(1 + r) u- / (G M^-1 G^T)
    T = 2 u+ / (|alpha| (1 - r))    after which the impacts of a chattering sequence accumulate

Source: see `contact`.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import ACCUMULATION, IMPACT, RELEASE, STAYS_CLOSED
from lcpstep.events.flight.contact import CLOSED, FREE, NONE, ON_THE_SURFACE, UNSEEN
from lcpstep.events.flight.keep import keep_event, keep_turned
from lcpstep.events.flight.motion import Flight, free, leave_from, on_obstacle
from lcpstep.events.flight.rest import alpha_at
from lcpstep.kernels.sudden import JUMP
from lcpstep.pointers import abs, max, min


def log(s: Flight, t: float, kind: int, before: float, after: float, p: float) -> None:
    """Note an event."""
    s.record.note(t, 0, before, after, p, kind)
    s.tally.add_event(t == s.last_event)
    s.last_event = t


def impact(s: Flight, u: float, jump: float = 0.0) -> None:
    """Newton's law u+ = -r u- now; then free flight, chattering or lasting contact.

    jump : of the obstacle's velocity, away from the body, at that very time
    """
    p = -((1.0 + s.r) * u + jump) / s.response
    s.impulse[0] += p
    log(s, s.now, IMPACT, u, -s.r * u, p)
    settle(s, -s.r * u)
    keep_event(s)


def settle(s: Flight, u: float) -> None:
    """On the obstacle now, leaving it with gap velocity u >= 0: which mode comes next."""
    t, r = s.now, s.r
    s.find_corners(t)
    alpha = start_on_obstacle(s, u)
    s.u0, s.on_surface, s.mode, s.alpha0, s.peak = u, True, FREE, alpha, abs(alpha)
    s.g, s.u, s.alpha = 0.0, u, alpha
    if alpha > 0.0 or (alpha == 0.0 and u > 0.0):
        return
    if u == 0.0 or 2.0 * u <= -alpha * UNSEEN * abs(t):  # a hop shorter than what the time resolves
        stick(s, t)
    elif r < 1.0:
        T = chatter_left(s, u, alpha)
        if T != NONE:
            log(s, t + T, ACCUMULATION, -u, 0.0, (-alpha * T - u) / s.response)
            # the contact force up to t + T, which counts as closed, gives the rest
            s.impulse[0] -= u / s.response
            stick(s, t + T)


def start_on_obstacle(s: Flight, u: float) -> float:
    """A flight, or rest, begins on the obstacle now with the gap velocity u; the gap acceleration."""
    y, w, alpha = on_obstacle(s, s.now, u)
    s.q0, s.v0 = s.q[0], s.v[0]
    leave_from(s, s.now, y, w)
    return alpha


def chatter_left(s: Flight, u: float, alpha: float) -> float:
    """How long the remaining impacts last, or NONE where taking them as one is not within the tolerance.

    The hops that are left out rise no higher than u^2 / (2 |alpha|). Pressed by -(A - j t) - 2 delta u they end after

        T = T0 (1 + j T0 / (3 A) - delta T0 / 3),    T0 = 2 u / (A (1 - r)),

    to second order in the change of the acceleration, which itself must be so small that T0 alone would do.
    """
    tolerance = s.atol + s.rtol * s.size
    if u * u > -2.0 * alpha * tolerance:
        return NONE
    A = -alpha if s.delta == 0.0 else -alpha_at(s, s.now)
    T = 2.0 * u / (A * (1.0 - s.r))
    if A <= 0.0 or s.now + T > s.border():
        return NONE
    later = alpha_at(s, s.now + T)
    change = abs(later + A) + abs(alpha + A)
    if not (later < 0.0 and change * T * s.speed <= A * tolerance):
        return NONE
    return T * (1.0 + (later + A) / (3.0 * A) - s.delta * T / 3.0)


def go_on(s: Flight, t: float, g: float, u: float) -> None:
    """A flight goes on at time t from a gap and a gap velocity that are better known than their differences."""
    y, w, _ = on_obstacle(s, t, u)
    s.q[0] += g / s.G
    leave_from(s, t, y + g / s.G, w)
    s.q0, s.v0 = s.q[0], s.v[0]
    _, _, alpha = free(s, 0.0)
    s.g0, s.u0, s.alpha0, s.on_surface = g, u, alpha, True
    s.g, s.u, s.alpha = g, u, alpha
    s.peak = max(s.peak, abs(alpha))
    s.q[0], s.v[0] = s.q0, s.v0


def stick(s: Flight, t_log: float) -> None:
    """From now on the contact is closed; t_log: when the log says so (the end of a chattering sequence)."""
    alpha = start_on_obstacle(s, 0.0)
    s.mode, s.g, s.u, s.alpha = CLOSED, 0.0, 0.0, min(alpha, 0.0)
    log(s, t_log, STAYS_CLOSED, 0.0, 0.0, 0.0)


def settle_again(s: Flight) -> None:
    """The contact that seemed to open did so by less than rounding."""
    stick(s, s.now)
    keep_event(s)


def release(s: Flight, alpha: float) -> None:
    """The closed contact opens now, with the gap acceleration alpha."""
    start_on_obstacle(s, 0.0)
    log(s, s.now, RELEASE, 0.0, 0.0, 0.0)
    s.mode, s.on_surface, s.alpha0 = FREE, True, alpha
    s.g, s.u, s.alpha = 0.0, 0.0, alpha
    keep_event(s)


def turn_corner(s: Flight) -> None:
    """Enter the next smooth interval, with the accelerations of its side.

    Where the obstacle's velocity jumps, u- is taken before the jump and u+ after it: the obstacle takes a closed
    contact along or, dropping, leaves it.
    """
    t = s.now
    if s.mode == CLOSED:
        u = pass_corner(s, t)
        _, _, s.alpha = on_obstacle(s, t, 0.0)
        if u == 0.0:
            return
        if u > 0.0:
            log(s, t, RELEASE, 0.0, u, 0.0)
            settle(s, u)
        else:
            log(s, t, IMPACT, 0.0, 0.0, -u / s.response)
            s.impulse[0] -= u / s.response
            s.q0, s.v0 = s.q[0], s.v[0]
        keep_event(s)
        return
    u = s.u
    # An impact within rounding of the corner belongs to it
    strikes = s.contact and u < 0.0 and s.g <= -u * s.moment(t)
    if s.on_surface and s.t0 == t:
        jump = pass_corner(s, t)
        if strikes and jump != 0.0:
            land(s, t, u, jump)
        else:
            go_on(s, t, s.g0, u + jump)
            keep_turned(s)
        return
    if strikes:
        free(s, t - s.t0)
        if u < -ON_THE_SURFACE * max(1.0, abs(s.v[0])):
            land(s, t, u, pass_corner(s, t))
            return
    s.find_corners(t)
    _, s.u, s.alpha = free(s, t - s.t0)
    s.peak = max(s.peak, abs(s.alpha))
    keep_turned(s)


def land(s: Flight, t: float, u: float, jump: float) -> None:
    """Come to the obstacle with the gap velocity u as its own jumps: strike, unless it moves away faster."""
    if u + jump < -s.r * u:
        impact(s, u, jump)
    else:
        go_on(s, t, 0.0, u + jump)


def pass_corner(s: Flight, t: float) -> float:
    """Enter the next smooth interval; by how much the obstacle's velocity jumps away from the body, if it does."""
    _, w, _ = on_obstacle(s, t, 0.0)
    s.find_corners(t)
    y, w_new, alpha = on_obstacle(s, t, 0.0)
    u = s.G * (w - w_new)
    size = abs(w) + abs(w_new) + abs(alpha) * s.scale + abs(y) / s.scale
    return u if abs(u) > JUMP * size else 0.0
