"""The event-driven loop of one linear degree of freedom above a flat obstacle, in closed form, as kernels.

    free      g > 0, or g = 0 and u > 0, or g = u = 0 and alpha > 0
    impact    g = 0, u < 0                     -> u+ = -r u-
    closed    g = u = 0, alpha <= 0            -> the contact force keeps g = 0 until alpha turns positive

A chattering sequence is carried to its accumulation point 2 u+ / (|alpha| (1 - r)) after the impact once the error
of doing so is below the tolerance. Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.16 and 4.2;
A. Nordmark, P. Piiroinen, Simulation and stability analysis of impacting systems with complete chattering,
Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address, inline
from lcpstep.events.flight import (
    ALPHA0,
    ATOL,
    CLEAR,
    CLOSED,
    CONTACT,
    EDGE_ALPHA,
    EDGE_G,
    EDGE_U,
    FREE,
    HIGH,
    HOLD,
    IMPULSE,
    LAST_EVENT,
    MAX_ITERATIONS,
    MODE,
    NONE,
    NOW,
    NUDGE,
    ON_SURFACE,
    PEAK,
    Q0,
    RESOLUTION,
    RESPONSE,
    RTOL,
    SCALE,
    SCAN,
    SHORT,
    SPEED0,
    T0,
    T_END,
    V0,
    WORTH,
    G,
    R,
    after,
    clear_until,
    find_corners,
    free,
    gap_root,
    leave_from,
    on_obstacle,
    rebase,
    root,
    short_hop,
)
from lcpstep.events.run import (
    BUFFER_FULL,
    EVENT,
    EVENTS,
    FINISHED,
    MAX_EVENTS,
    NEXT_TIME,
    NOT_FINITE,
    ROW,
    SLACK,
    STALLED,
    STEP,
    TOO_MANY_EVENTS,
)
from lcpstep.recording import LEAD, write_event, write_row
from lcpstep.recording import TIME as ROW_TIME

# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)

JUST_RELEASED = 1e-300  # a gap acceleration that is zero, on its way up
ON_THE_SURFACE = 64 * RESOLUTION  # a gap this small, relative to the state, is closed
MAX_STALLED = 1000  # events at one time
JUMP = 1e-9  # of the velocities at hand: an obstacle's velocity that jumps by less does so by rounding
STRIDE = 3.0  # scan intervals in one stride, where the obstacle is far
# How large a gap acceleration may be within a stride: relative to both ends, and to the largest of the flight so far
BULGE, LEAST_BULGE = 2.0, 0.5
HALVINGS = 40  # of an interval, in search of a positive gap
# Steps of Newton's at the end of a flight: how many, the largest, relative to flight and velocity, and the last
POLISHES, POLISH, POLISHED = 3, 1e-3, 1e-8
PROBES = 4  # samples of alpha per interval while the contact is closed
QUADRATURE = (  # nodes and weights of Gauss on [0, 1], for the impulse of the contact force
    (0.019855071751231912, 0.05061426814518813),
    (0.10166676129318664, 0.11119051722668724),
    (0.2372337950418355, 0.15685332293894363),
    (0.4082826787521751, 0.18134189168918100),
    (0.5917173212478249, 0.18134189168918100),
    (0.7627662049581645, 0.15685332293894363),
    (0.8983332387068134, 0.11119051722668724),
    (0.9801449282487681, 0.05061426814518813),
)


def run(s: Any, record: Any, count: Any, goal: int) -> int:
    """Go on from x[NOW] to the end of the span, or to step number `goal`; says why it returned."""
    x = s.x
    if count[ROW] == 0 and count[STEP] == 0 and not begin(s, record, count):
        return NOT_FINITE
    while x[NOW] < x[T_END] and count[STEP] < goal:
        if count[EVENT] + SLACK > len(record.events) or count[ROW] + SLACK > len(record.rows):
            return BUFFER_FULL
        if count[EVENTS] > count[MAX_EVENTS] or count[STALLED] > MAX_STALLED:
            return TOO_MANY_EVENTS
        if x[NOW] >= x[HIGH]:
            turn_corner(s, record, count)
        if x[MODE] == CLOSED and x[EDGE_ALPHA] > 0.0:
            release(s, record, count, x[EDGE_ALPHA])
        count[STEP] += 1
        finite = rest(s, record, count) if x[MODE] == CLOSED else fly(s, record, count)
        if not finite:
            return NOT_FINITE
    return FINISHED


def begin(s: Any, record: Any, count: Any) -> bool:
    """The state at the start of the span, which may lie on the obstacle or strike it at once."""
    x = s.x
    t = x[NOW]
    find_corners(s, t)
    rebase(s, t)
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = free(s, 0.0)
    s.q[0], s.v[0] = x[Q0], x[V0]
    if x[EDGE_G] - x[EDGE_G] + x[EDGE_U] - x[EDGE_U] + x[EDGE_ALPHA] - x[EDGE_ALPHA] != 0.0:
        return False
    u = x[EDGE_U]
    small = ON_THE_SURFACE * max(1.0, abs(x[V0]))
    if x[CONTACT] == 1.0 and x[EDGE_G] <= ON_THE_SURFACE * max(1.0, abs(x[Q0])):
        if u < -small:
            impact(s, record, count, u)
        else:
            settle(s, record, count, u if u > small else 0.0)
        s.q[0], s.v[0] = x[Q0], x[V0]
    if count[ROW] == 0 and len(record.times) == 0:
        keep(s, record, count, t)
    return True


# --- free flight ----------------------------------------------------------------------------------------------


@inline
def fly(s: Any, record: Any, count: Any) -> bool:
    """Up to the next contact, or to the end of the interval; False where the motion is not finite.

    The interval is a long stride where the contact stays clear of it, and one of the scan elsewhere.
    """
    x = s.x
    short_end = min(x[T_END], x[HIGH], x[NOW] + x[SCAN])
    end = min(x[T_END], x[HIGH], x[NOW] + STRIDE * x[SCAN])
    a, b = x[NOW] - x[T0], end - x[T0]
    tau, u = NONE, 0.0
    hop = False
    if a == 0.0 and x[ON_SURFACE] == 1.0 and x[EDGE_ALPHA] < 0.0 and x[EDGE_U] > 0.0:
        guess = 2.0 * x[EDGE_U] / -x[EDGE_ALPHA]
        if guess < SHORT * x[SCAN]:
            tau, u = short_hop(s, guess, b)
            hop = tau != NONE
    if not hop and x[CLEAR] < math.inf and leap(s, record, count):
        return True
    if not hop:
        g, u, alpha = free(s, b)
        is_near = suspect(x, b - a, g, u, alpha)
        if is_near and end > short_end:
            end, b = short_end, short_end - x[T0]
            g, u, alpha = free(s, b)
            is_near = suspect(x, b - a, g, u, alpha)
        if g - g + u - u + alpha - alpha != 0.0:
            free(s, a)
            return False
        if is_near and x[CONTACT] == 1.0:
            # After a release alpha is zero to rounding, and its sign there says nothing
            if x[EDGE_ALPHA] != JUST_RELEASED:
                tau = first_contact(s, a, b, g, u, alpha)
            if tau == NONE and x[EDGE_G] <= 0.0 and g < 0.0:
                tau = small_hop(s, a, b, g)
            if tau == NONE and x[EDGE_G] <= 0.0 and g < 0.0:
                # It seemed to open, by less than rounding: it is closed, for this interval at least
                x[HOLD] = end
                settle_again(s, record, count)
                return True
        if tau == NONE:
            x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = g, u, alpha
            x[PEAK] = max(x[PEAK], abs(alpha))
            pass_end(s, record, count, end)
            return True
    if not hop:
        for _ in range(POLISHES):
            g, u, alpha = free(s, tau)
            if not (abs(g) < -u * POLISH * tau and abs(alpha * g) < POLISH * u * u):
                break
            past = g / u
            tau -= past * (1.0 + 0.5 * alpha * past / u)
            u -= alpha * past
            if abs(past) <= POLISHED * tau:
                break
        if u - u + alpha - alpha != 0.0:
            free(s, a)
            return False
    t = min(after(x, tau), end)
    keep_times(s, record, count, t, False)
    x[NOW] = t
    if hop or -u > ON_THE_SURFACE * max(1.0, abs(s.v[0])):
        impact(s, record, count, min(u, 0.0))
    elif tau <= a:  # a touch at the very time of the last event
        x[HOLD] = end
        settle_again(s, record, count)
    else:  # a touch without impact
        settle(s, record, count, 0.0)
        keep_event(s, record, count)
    return True


@inline
def leap(s: Any, record: Any, count: Any) -> bool:
    """On to where the gap is no longer certain to be open, across corners; False where that is no longer stride."""
    x = s.x
    tau = clear_until(s, x[T_END] - x[T0])
    end = min(x[T0] + tau, x[T_END])
    if end - x[NOW] <= WORTH * x[SCAN] or tau - tau != 0.0:
        return False
    keep_times(s, record, count, end, False)
    # A corner at the very end is still to be turned
    find_corners(s, end - 4.0 * NUDGE * max(abs(end), x[SCALE]))
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = free(s, end - x[T0])
    x[PEAK] = max(x[PEAK], abs(x[EDGE_ALPHA]))
    pass_end(s, record, count, end)
    return True


def suspect(x: Any, length: float, g: float, u: float, alpha: float) -> bool:
    """Whether the gap may close in an interval, by what is known at its start (EDGE) and at its end.

    Under accelerations of at most A the gap stays above both g0 - |u0| tau - A tau^2/2 and the like from the end.
    Also true where the motion is not finite.
    """
    if g - g + u - u + alpha - alpha != 0.0:
        return True
    if x[CONTACT] == 0.0:
        return False
    most = max(BULGE * max(abs(x[EDGE_ALPHA]), abs(alpha)), LEAST_BULGE * x[PEAK])
    half = 0.5 * length
    fall = 0.5 * most * half * half
    g0, u0 = x[EDGE_G], x[EDGE_U]
    opens = g0 >= 0.0 and u0 > 0.5 * most * half  # g0 + tau (u0 - A tau/2)
    clear = (opens or min(g0, g0 + u0 * half) > fall) and min(g, g - u * half) > fall
    return bool(not clear)


def first_contact(s: Any, a: float, b: float, g_b: float, u_b: float, alpha_b: float) -> float:
    """First time in (a, b] at which the gap falls to zero, or NONE.

    The interval is short enough for the gap acceleration to change its sign at most once. That sign change splits
    the gap velocity into monotone parts, whose sign changes split the gap into monotone parts. So the first root is
    found even where the gap dips below zero and returns within the interval (grazing).
    """
    x = s.x
    g_a, u_a, alpha_a = x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA]
    falling = u_a < 0.0 and u_b < 0.0 and not (alpha_a > 0.0 and alpha_b < 0.0)
    if alpha_a * alpha_b < 0.0 and not falling:
        m = root(s, 2, a, alpha_a, b, alpha_b, NONE)
        g_m, u_m, _ = free(s, m)
        found = first_in_half(s, a, g_a, u_a, m, g_m, u_m)
        return found if found != NONE else first_in_half(s, m, g_m, u_m, b, g_b, u_b)
    return first_in_half(s, a, g_a, u_a, b, g_b, u_b)


def first_in_half(s: Any, a: float, g_a: float, u_a: float, b: float, g_b: float, u_b: float) -> float:
    """The same where the gap velocity is monotone, or does not change its sign."""
    if u_a > 0.0 and u_b < 0.0 and g_a <= 0.0 and g_b <= 0.0:  # up from the obstacle and down to it again
        m = a + (b - a) * u_a / (u_a - u_b)
        g_m, u_m, _ = free(s, m)
        if g_m <= 0.0:
            m = root(s, 1, a, u_a, b, u_b, NONE)
            g_m, u_m, _ = free(s, m)
        return m if g_m <= 0.0 else gap_root(s, m, g_m, u_m, b, g_b, u_b)
    if u_a < 0.0 and u_b > 0.0 and g_a > 0.0 and g_b > 0.0:  # a dip
        m = root(s, 1, a, u_a, b, u_b, NONE)
        g_m, u_m, _ = free(s, m)
        return gap_root(s, a, g_a, u_a, m, g_m, u_m) if g_m <= 0.0 else NONE
    if g_a > 0.0 and g_b <= 0.0:
        return gap_root(s, a, g_a, u_a, b, g_b, u_b)
    return NONE


def small_hop(s: Any, a: float, b: float, g_b: float) -> float:
    """End of a hop within (a, b) that begins so gently that only a gap well inside it is positive, or NONE."""
    m = b
    for _ in range(HALVINGS):
        m, end, g_end = a + 0.5 * (m - a), m, g_b
        g_b, _, _ = free(s, m)
        if g_b > ON_THE_SURFACE * max(1.0, abs(s.q[0])):
            return root(s, 0, m, g_b, end, g_end, NONE)
    return NONE


def pass_end(s: Any, record: Any, count: Any, end: float) -> None:
    """Go on beyond the end of a scan interval; s.q, s.v hold the state there."""
    x = s.x
    keep_times(s, record, count, end, end >= x[T_END])
    x[NOW] = end
    kept = record.every > 0 and count[STEP] % record.every == 0
    if kept or end >= x[T_END]:
        free(s, end - x[T0])
    if kept:
        keep(s, record, count, end)


# --- rest on the obstacle -------------------------------------------------------------------------------------


def rest(s: Any, record: Any, count: Any) -> bool:
    """Up to the release, or to the end of the scan interval; False where alpha is not finite."""
    x = s.x
    start, end = x[NOW], min(x[T_END], x[HIGH], x[NOW] + x[SCAN])
    t = NONE
    if start >= x[HOLD]:
        t = first_release(s, start, min(x[EDGE_ALPHA], 0.0), end)
    stop = end if t == NONE else t
    if record.every > 0 or record.on_events or len(record.times) > 0:  # or nobody asks for it
        x[IMPULSE] += contact_impulse(s, start, stop)
    keep_times(s, record, count, stop, t == NONE and stop >= x[T_END])
    _, _, alpha = on_obstacle(s, stop, 0.0)
    if alpha - alpha + x[IMPULSE] - x[IMPULSE] != 0.0:
        on_obstacle(s, start, 0.0)
        return False
    x[NOW] = stop
    if t != NONE:
        release(s, record, count, JUST_RELEASED)
        return True
    x[EDGE_ALPHA] = min(alpha, 0.0)
    if record.every > 0 and count[STEP] % record.every == 0:
        keep(s, record, count, stop)
    return True


@inline
def alpha_at(s: Any, t: float) -> float:
    """Gap acceleration of the free motion, at rest on the obstacle."""
    _, _, alpha = on_obstacle(s, t, 0.0)
    return float(alpha)


def contact_impulse(s: Any, a: float, b: float) -> float:
    """Impulse of the contact force lambda = -alpha / (G M^-1 G^T) over (a, b) [N s]."""
    total = 0.0
    for node, weight in QUADRATURE:
        total -= weight * alpha_at(s, a + node * (b - a))
    return float(total * (b - a) / s.x[RESPONSE])


def first_release(s: Any, a: float, alpha_a: float, b: float) -> float:
    """First time in (a, b] at which alpha turns positive, or NONE."""
    h = (b - a) / PROBES
    t_0, f_0, t_1, f_1 = a - h, 2.0 * alpha_a, a, alpha_a
    for k in range(1, PROBES + 1):
        t_2 = b if k == PROBES else a + k * h
        f_2 = alpha_at(s, t_2)
        if k > 1 and f_0 < f_1 and f_2 <= f_1 and f_1 <= 0.0:
            top, f_top = summit(s, t_1, h, f_0, f_1, f_2)
            if f_top > 0.0:
                return alpha_root(s, t_0, f_0, top, f_top)
        if f_2 > 0.0:
            return t_1 if f_1 >= 0.0 else alpha_root(s, t_1, f_1, t_2, f_2)
        t_0, f_0, t_1, f_1 = t_1, f_1, t_2, f_2
    return NONE


def alpha_root(s: Any, a: float, f_a: float, b: float, f_b: float) -> float:
    """Where alpha turns positive between a and b; the secant method safeguarded by bisection."""
    t, f, old, f_old = b, f_b, a, f_a
    before = b - a
    for _ in range(MAX_ITERATIONS):
        new = t - f * (t - old) / (f - f_old) if f != f_old else a
        if not a < new < b or abs(new - t) > 0.5 * abs(before):
            new = 0.5 * (a + b)
        before = new - t
        old, f_old, t = t, f, new
        f = alpha_at(s, t)
        if f > 0.0:
            b = t
        else:
            a = t
        if f == 0.0 or abs(before) <= RESOLUTION * abs(t) or b - a <= RESOLUTION * abs(t):
            break
    return t


def summit(s: Any, t_1: float, h: float, f_0: float, f_1: float, f_2: float) -> tuple[float, float]:
    """Highest alpha near the middle one of three equidistant samples, by parabolas."""
    best, f_best = t_1, f_1
    for _ in range(4):
        curvature = f_0 - 2.0 * f_1 + f_2
        if curvature >= 0.0:
            break
        t_1 += 0.5 * h * (f_0 - f_2) / curvature
        f_1 = alpha_at(s, t_1)
        if f_1 > f_best:
            best, f_best = t_1, f_1
        h *= 0.25
        f_0 = alpha_at(s, t_1 - h)
        f_2 = alpha_at(s, t_1 + h)
    return best, f_best


# --- events ---------------------------------------------------------------------------------------------------


@inline
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
    if u == 0.0 or 2.0 * u <= -alpha * 4.0 * RESOLUTION * abs(t):
        stick(s, record, count, t)
    elif r < 1.0:
        T = 2.0 * u / (-alpha * (1.0 - r))
        if chatter_is_over(s, u, alpha, T, y, w):
            log(s, record, count, t + T, ACCUMULATION, -u, 0.0, (-alpha * T - u) / x[RESPONSE])
            x[IMPULSE] -= (
                u / x[RESPONSE]
            )  # the contact force up to t + T, which counts as closed, gives the rest
            stick(s, record, count, t + T)


def chatter_is_over(s: Any, u: float, alpha: float, T: float, y: float, w: float) -> bool:
    """Whether taking the remaining impacts as one is within the tolerance.

    They accumulate at T = 2 u / (|alpha| (1-r)) but for T |change of alpha| / |alpha|, and the hops that are
    left out rise no higher than u^2 / (2 |alpha|).
    """
    x = s.x
    tolerance = x[ATOL] + x[RTOL] * abs(x[Q0])
    if x[NOW] + T > min(x[HIGH], x[T_END]) or u * u > -2.0 * alpha * tolerance:
        return False
    later = alpha_at(s, x[NOW] + T)
    return bool(later < 0.0 and abs(later - alpha) * T * max(1.0, abs(x[V0])) <= -alpha * tolerance)


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
    x[MODE], x[ON_SURFACE] = FREE, 1.0
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
        _, w, _ = on_obstacle(s, t, 0.0)
        find_corners(s, t)
        y, w_new, x[EDGE_ALPHA] = on_obstacle(s, t, 0.0)
        u = x[G] * (w - w_new)
        if abs(u) <= JUMP * (abs(w) + abs(w_new) + abs(x[EDGE_ALPHA]) * x[SCALE] + abs(y) / x[SCALE]):
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
    if x[CONTACT] == 1.0 and u < 0.0 and x[EDGE_G] <= -2.0 * u * NUDGE * max(abs(t), x[SCALE]):
        # within rounding of the corner
        free(s, t - x[T0])
        if u < -ON_THE_SURFACE * max(1.0, abs(s.v[0])):
            impact(s, record, count, u)
            return
    find_corners(s, t)
    _, x[EDGE_U], x[EDGE_ALPHA] = free(s, t - x[T0])
    x[PEAK] = max(x[PEAK], abs(x[EDGE_ALPHA]))


# --- what is kept ---------------------------------------------------------------------------------------------


@inline
def log(s: Any, record: Any, count: Any, t: float, kind: int, before: float, after: float, p: float) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, 0, before, after, p, kind)
    count[STALLED] = count[STALLED] + 1 if t == s.x[LAST_EVENT] else 0
    s.x[LAST_EVENT] = t
    count[EVENT] += 1
    count[EVENTS] += 1


def state_at(s: Any, t: float) -> None:
    """The state at time t of the flight or rest at hand, into s.q, s.v."""
    if t > s.x[HIGH]:
        find_corners(s, t)
    if s.x[MODE] == CLOSED:
        on_obstacle(s, t, 0.0)
    else:
        free(s, t - s.x[T0])


def keep_times(s: Any, record: Any, count: Any, stop: float, last: bool) -> None:
    """Keep the states asked for before the time `stop` (and at it, at the end of the span)."""
    while count[NEXT_TIME] < len(record.times) and count[ROW] < len(record.rows):
        t = record.times[count[NEXT_TIME]]
        if t > stop or (t == stop and not last):
            return
        state_at(s, t)
        keep(s, record, count, t)
        count[NEXT_TIME] += 1


def keep_event(s: Any, record: Any, count: Any) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if not record.on_events and record.every != 1:
        return
    x = s.x
    s.q[0], s.v[0] = x[Q0], x[V0]
    if count[ROW] > 0 and record.rows[count[ROW] - 1, ROW_TIME] == x[NOW]:
        count[ROW] -= 1
        if x[CONTACT] == 1.0:
            x[IMPULSE] += record.rows[count[ROW], LEAD + 2]
    keep(s, record, count, x[NOW])


def keep(s: Any, record: Any, count: Any, t: float) -> None:
    """Keep the state s.q, s.v at time t, and the impulse since the one before."""
    impulse = s.x[IMPULSE : IMPULSE + int(s.x[CONTACT])]
    write_row(record.rows[count[ROW]], t, s.x[MODE], s.q, s.v, impulse)
    count[ROW] += 1


@by_address
class Wanted(NamedTuple):
    """Times asked for, and the states found there."""

    t: Any  # (m,)
    row: Any  # (m,) the kept state at or before each
    q: Any  # (m, 1)
    v: Any  # (m, 1)


def evaluate(s: Any, kept: Any, wanted: Any) -> None:
    """States at the times wanted, from the kept states before them and the flights that start there."""
    for k in range(len(wanted.t)):
        row = wanted.row[k]
        s.q[0], s.v[0] = kept.q[row, 0], kept.v[row, 0]
        s.x[MODE] = kept.mode[row]
        if wanted.t[k] > kept.t[row]:
            find_corners(s, kept.t[row])
            rebase(s, kept.t[row])
            state_at(s, wanted.t[k])
        wanted.q[k, 0], wanted.v[k, 0] = s.q[0], s.v[0]
