"""What happens on the obstacle, as kernels: impact, chattering, rest, release, and corners of the obstacle's motion.

    u+ = -r u-                      an impact (Newton's law), with the impulse -(1 + r) u- / (G M^-1 G^T)
    T = 2 u+ / (|alpha| (1 - r))    after which the impacts of a chattering sequence accumulate

Source: see `contact`.
"""

from __future__ import annotations

from typing import Any

from lcpstep.events.bookkeeping import ACCUMULATION, IMPACT, RELEASE, STICK
from lcpstep.events.clock import HIGH, NUDGE, SCALE, T0, find_corners
from lcpstep.events.contact import (
    ALPHA0,
    CLOSED,
    EDGE_ALPHA,
    EDGE_G,
    EDGE_U,
    FREE,
    IMPULSE,
    MODE,
    NONE,
    NOW,
    ON_SURFACE,
    ON_THE_SURFACE,
    SPEED0,
    accumulation,
    log,
    sticks,
)
from lcpstep.events.flight.keep import keep_event
from lcpstep.events.flight.motion import (
    ATOL,
    CONTACT,
    DELTA,
    GAP0,
    PEAK,
    Q0,
    RATE,
    RESPONSE,
    RTOL,
    SIZE,
    T_END,
    V0,
    G,
    R,
    free,
    leave_from,
    on_obstacle,
)
from lcpstep.events.flight.rest import alpha_at

JUMP = 1e-9  # of the velocities at hand: an obstacle's velocity that jumps by less does so by rounding


def impact(s: Any, record: Any, count: Any, u: float) -> None:
    """Newton's law u+ = -r u- now; then free flight, chattering or lasting contact."""
    x = s.x
    p = -(1.0 + x[R]) * u / x[RESPONSE]
    x[IMPULSE] += p
    log(s, record, count, x[NOW], IMPACT, u, -x[R] * u, p)
    settle(s, record, count, -x[R] * u)
    keep_event(s, record, count)


def settle(s: Any, record: Any, count: Any, u: float) -> None:
    """On the obstacle now, leaving it with gap velocity u >= 0: which mode comes next."""
    x = s.x
    t, r = x[NOW], x[R]
    find_corners(s, t)
    y, w, alpha = on_obstacle(s, t, u)
    leave_from(s, t, y, w)
    x[Q0], x[V0] = s.q[0], s.v[0]
    x[SPEED0], x[ON_SURFACE], x[MODE], x[ALPHA0], x[PEAK] = u, 1.0, FREE, alpha, abs(alpha)
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = 0.0, u, alpha
    if alpha > 0.0 or (alpha == 0.0 and u > 0.0):
        return
    if sticks(u, alpha, t):
        stick(s, record, count, t)
    elif r < 1.0:
        T = chatter_left(s, u, alpha)
        if T != NONE:
            log(s, record, count, t + T, ACCUMULATION, -u, 0.0, (-alpha * T - u) / x[RESPONSE])
            # the contact force up to t + T, which counts as closed, gives the rest
            x[IMPULSE] -= u / x[RESPONSE]
            stick(s, record, count, t + T)


def chatter_left(s: Any, u: float, alpha: float) -> float:
    """How long the remaining impacts last, or NONE where taking them as one is not within the tolerance.

    The hops that are left out rise no higher than u^2 / (2 |alpha|). Pressed by -(A - j t) - 2 delta u they end after

        T = T0 (1 + j T0 / (3 A) - delta T0 / 3),    T0 = 2 u / (A (1 - r)),

    to second order in the change of the acceleration, which itself must be so small that T0 alone would do.
    """
    x = s.x
    tolerance = x[ATOL] + x[RTOL] * x[SIZE]
    if u * u > -2.0 * alpha * tolerance:
        return NONE
    A = -alpha if x[DELTA] == 0.0 else -alpha_at(s, x[NOW])
    T = accumulation(u, -A, x[R])
    if A <= 0.0 or x[NOW] + T > min(x[HIGH], x[T_END]):
        return NONE
    later = alpha_at(s, x[NOW] + T)
    change = abs(later + A) + abs(alpha + A)
    if not (later < 0.0 and change * T * x[RATE] <= A * tolerance):
        return NONE
    return float(T * (1.0 + (later + A) / (3.0 * A) - x[DELTA] * T / 3.0))


def go_on(s: Any, t: float, g: float, u: float) -> None:
    """A flight goes on at time t from a gap and a gap velocity that are better known than their differences."""
    x = s.x
    y, w, _ = on_obstacle(s, t, u)
    s.q[0] += g / x[G]
    leave_from(s, t, y + g / x[G], w)
    x[Q0], x[V0] = s.q[0], s.v[0]
    _, _, alpha = free(s, 0.0)
    x[GAP0], x[SPEED0], x[ALPHA0], x[ON_SURFACE] = g, u, alpha, 1.0
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = g, u, alpha
    x[PEAK] = max(x[PEAK], abs(alpha))
    s.q[0], s.v[0] = x[Q0], x[V0]


def stick(s: Any, record: Any, count: Any, t_log: float) -> None:
    """From now on the contact is closed; t_log: when the log says so (the end of a chattering sequence)."""
    x = s.x
    y, w, alpha = on_obstacle(s, x[NOW], 0.0)
    x[Q0], x[V0] = s.q[0], s.v[0]
    leave_from(s, x[NOW], y, w)
    x[MODE], x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = CLOSED, 0.0, 0.0, min(alpha, 0.0)
    log(s, record, count, t_log, STICK, 0.0, 0.0, 0.0)


def settle_again(s: Any, record: Any, count: Any) -> None:
    """The contact that seemed to open did so by less than rounding."""
    stick(s, record, count, s.x[NOW])
    keep_event(s, record, count)


def release(s: Any, record: Any, count: Any, alpha: float) -> None:
    """The closed contact opens now, with the gap acceleration alpha."""
    x = s.x
    y, w, _ = on_obstacle(s, x[NOW], 0.0)
    x[Q0], x[V0] = s.q[0], s.v[0]
    leave_from(s, x[NOW], y, w)
    log(s, record, count, x[NOW], RELEASE, 0.0, 0.0, 0.0)
    x[MODE], x[ON_SURFACE], x[ALPHA0] = FREE, 1.0, alpha
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = 0.0, 0.0, alpha
    keep_event(s, record, count)


def turn_corner(s: Any, record: Any, count: Any) -> None:
    """Enter the next smooth interval, with the accelerations of its side.

    Where the obstacle's velocity jumps, u- is taken before the jump and u+ after it: the obstacle takes a closed
    contact along or, dropping, leaves it.
    """
    x = s.x
    t = x[NOW]
    if x[MODE] == CLOSED:
        u = pass_corner(s, t)
        _, _, x[EDGE_ALPHA] = on_obstacle(s, t, 0.0)
        if u == 0.0:
            return
        if u > 0.0:
            log(s, record, count, t, RELEASE, 0.0, u, 0.0)
            settle(s, record, count, u)
        else:
            log(s, record, count, t, IMPACT, 0.0, 0.0, -u / x[RESPONSE])
            x[IMPULSE] -= u / x[RESPONSE]
            x[Q0], x[V0] = s.q[0], s.v[0]
        keep_event(s, record, count)
        return
    u = x[EDGE_U]
    # An impact within rounding of the corner belongs to it
    strikes = x[CONTACT] == 1.0 and u < 0.0 and x[EDGE_G] <= -2.0 * u * NUDGE * max(abs(t), x[SCALE])
    if x[ON_SURFACE] == 1.0 and x[T0] == t:
        jump = pass_corner(s, t)
        if strikes and jump != 0.0:
            impact(s, record, count, u)
        else:
            go_on(s, t, x[GAP0], u + jump)
        return
    if strikes:
        free(s, t - x[T0])
        if u < -ON_THE_SURFACE * max(1.0, abs(s.v[0])):
            impact(s, record, count, u)
            return
    find_corners(s, t)
    _, x[EDGE_U], x[EDGE_ALPHA] = free(s, t - x[T0])
    x[PEAK] = max(x[PEAK], abs(x[EDGE_ALPHA]))


def pass_corner(s: Any, t: float) -> float:
    """Enter the next smooth interval; by how much the obstacle's velocity jumps away from the body, if it does."""
    x = s.x
    _, w, _ = on_obstacle(s, t, 0.0)
    find_corners(s, t)
    y, w_new, alpha = on_obstacle(s, t, 0.0)
    u = x[G] * (w - w_new)
    size = abs(w) + abs(w_new) + abs(alpha) * x[SCALE] + abs(y) / x[SCALE]
    return u if abs(u) > JUMP * size else 0.0
