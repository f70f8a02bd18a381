"""The event-driven loop of one linear degree of freedom above a flat obstacle, in closed form, as kernels.

A round is a flight up to the next contact, or rest up to the release, or neither within an interval of the scan; what
happens at contact and release is said in `modes`, and what the modes are in `contact`.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline
from lcpstep.events.bookkeeping import (
    BUFFER_FULL,
    EVENT,
    FINISHED,
    NOT_FINITE,
    ROW,
    SLACK,
    STEP,
    TOO_MANY_EVENTS,
    is_due,
    too_many,
)
from lcpstep.events.clock import HIGH, NUDGE, SCALE, T0, after, find_corners
from lcpstep.events.contact import (
    CLOSED,
    EDGE_ALPHA,
    EDGE_G,
    EDGE_U,
    HOLD,
    IMPULSE,
    JUST_RELEASED,
    MODE,
    NONE,
    NOW,
    ON_THE_SURFACE,
    UNSEEN,
    finite,
    keep,
)
from lcpstep.events.flight.clear import WORTH, clear_until, suspect
from lcpstep.events.flight.keep import keep_event, keep_times
from lcpstep.events.flight.modes import go_on, impact, release, settle, settle_again, turn_corner
from lcpstep.events.flight.motion import (
    CLEAR,
    CONTACT,
    GAP0,
    PEAK,
    Q0,
    SCAN,
    T_END,
    V0,
    G,
    free,
    on_obstacle,
    rebase,
)
from lcpstep.events.flight.near import SHORT, along, hop_end, is_low, low_end, stretch
from lcpstep.events.flight.rest import contact_impulse, first_release
from lcpstep.events.flight.roots import first_contact, polish

STRIDE = 3.0  # scan intervals in one stride, where the obstacle is far


def run(s: Any, record: Any, count: Any, goal: int) -> int:
    """Go on from x[NOW] to the end of the span, or to step number `goal`; says why it returned."""
    x = s.x
    if count[ROW] == 0 and count[STEP] == 0 and not begin(s, record, count):
        return NOT_FINITE
    while x[NOW] < x[T_END] and count[STEP] < goal:
        if count[EVENT] + SLACK > len(record.events) or count[ROW] + SLACK > len(record.rows):
            return BUFFER_FULL
        if too_many(count):
            return TOO_MANY_EVENTS
        if x[NOW] >= x[HIGH]:
            turn_corner(s, record, count)
        if x[MODE] == CLOSED and x[EDGE_ALPHA] > 0.0:
            release(s, record, count, x[EDGE_ALPHA])
        count[STEP] += 1
        fine = rest(s, record, count) if x[MODE] == CLOSED else fly(s, record, count)
        if not fine:
            return NOT_FINITE
    return FINISHED


def begin(s: Any, record: Any, count: Any) -> bool:
    """The state at the start of the span, which may lie on the obstacle or strike it at once."""
    x = s.x
    t = x[NOW]
    find_corners(s, t)
    rebase(s, t)
    g, u, alpha = free(s, 0.0)
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = g, u, alpha
    s.q[0], s.v[0] = x[Q0], x[V0]
    if not finite(g, u, alpha):
        return False
    # What rounding of the state may make of rest, and rounding of the time
    small = ON_THE_SURFACE * max(1.0, abs(x[G] * x[V0])) + abs(alpha) * NUDGE * max(abs(t), x[SCALE])
    if x[CONTACT] == 1.0 and g <= ON_THE_SURFACE * max(1.0, abs(x[G] * x[Q0])):
        if u < -small:
            impact(s, record, count, u)
        else:
            settle(s, record, count, u if u > small else 0.0)
        s.q[0], s.v[0] = x[Q0], x[V0]
    if count[ROW] == 0 and len(record.times) == 0:
        keep(s, record, count, t)
    return True


@inline
def fly(s: Any, record: Any, count: Any) -> bool:
    """Up to the next contact, or to the end of the interval; False where the motion is not finite.

    The interval is a long stride where the contact stays clear of it, and one of the scan elsewhere.
    """
    x = s.x
    short_end = min(x[T_END], x[HIGH], x[NOW] + x[SCAN])
    end = min(x[T_END], x[HIGH], x[NOW] + STRIDE * x[SCAN])
    a, b = x[NOW] - x[T0], end - x[T0]
    tau, u = hop_end(s, a, b)
    is_hop = tau != NONE
    if not is_hop and is_low(x, a):
        return skim(s, record, count)
    if not is_hop:
        if x[CLEAR] < math.inf and leap(s, record, count):
            return True
        g, u, alpha = free(s, b)
        is_near = suspect(x, b - a, g, u, alpha)
        if is_near and end > short_end:
            end, b = short_end, short_end - x[T0]
            g, u, alpha = free(s, b)
            is_near = suspect(x, b - a, g, u, alpha)
        if not finite(g, u, alpha):
            free(s, a)
            return False
        if is_near and x[CONTACT] == 1.0:
            tau = first_contact(s, a, b, g, u, alpha)
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
        tau, u, alpha = polish(s, tau)
        if not finite(0.0, u, alpha):
            free(s, a)
            return False
    t = min(after(x, tau), end)
    keep_times(s, record, count, t, False)
    x[NOW] = t
    if is_hop or -u > ON_THE_SURFACE * max(1.0, abs(s.v[0])):
        impact(s, record, count, min(u, 0.0))
    elif tau <= a:  # a touch at the very time of the last event
        x[HOLD] = end
        settle_again(s, record, count)
    else:  # a touch without impact
        settle(s, record, count, 0.0)
        keep_event(s, record, count)
    return True


def skim(s: Any, record: Any, count: Any) -> bool:
    """A stretch of a flight hardly above the obstacle, or up to its end; False where the motion is not finite."""
    x = s.x
    border = min(x[T_END], x[HIGH])
    h = stretch(x)
    tau, u = low_end(s, h)
    g, rise, alpha = along(x, 0, h, 1.0), along(x, 1, h, 1.0), along(x, 2, h, 1.0)
    if not finite(g, rise, alpha):
        return False
    if tau == NONE:
        t = border if h < SHORT * x[SCAN] else after(x, h)
        keep_times(s, record, count, t, t >= x[T_END])
        x[NOW] = t
        go_on(s, t, g, rise)
        if is_due(record, count):
            keep(s, record, count, t)
        return True
    t = min(after(x, tau), border)
    keep_times(s, record, count, t, False)
    x[NOW] = t
    if tau <= UNSEEN * abs(t) and x[GAP0] == 0.0:
        x[HOLD] = t + h
        settle_again(s, record, count)
    else:
        impact(s, record, count, min(u, 0.0))
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


def pass_end(s: Any, record: Any, count: Any, end: float) -> None:
    """Go on beyond the end of a scan interval; s.q, s.v hold the state there."""
    x = s.x
    keep_times(s, record, count, end, end >= x[T_END])
    x[NOW] = end
    kept = is_due(record, count)
    if kept or end >= x[T_END]:
        free(s, end - x[T0])
    if kept:
        keep(s, record, count, end)


def rest(s: Any, record: Any, count: Any) -> bool:
    """Up to the release, or to the end of the scan interval; False where alpha is not finite."""
    x = s.x
    start, end = x[NOW], min(x[T_END], x[HIGH], x[NOW] + x[SCAN])
    t = NONE
    if start < x[HOLD]:
        end = min(end, x[HOLD])
    else:
        t = first_release(s, start, min(x[EDGE_ALPHA], 0.0), end)
    stop = end if t == NONE else t
    if record.every > 0 or record.on_events or len(record.times) > 0:  # or nobody asks for it
        x[IMPULSE] += contact_impulse(s, start, stop)
    keep_times(s, record, count, stop, t == NONE and stop >= x[T_END])
    _, _, alpha = on_obstacle(s, stop, 0.0)
    if not finite(0.0, x[IMPULSE], alpha):
        on_obstacle(s, start, 0.0)
        return False
    x[NOW] = stop
    if t != NONE:
        release(s, record, count, JUST_RELEASED)
        return True
    x[EDGE_ALPHA] = min(alpha, 0.0)
    if is_due(record, count):
        keep(s, record, count, stop)
    return True
