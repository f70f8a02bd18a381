"""The event-driven loop of a general system with one contact or none, as kernels.

A round is one Runge-Kutta step, cut short by the first contact or release within it; what happens there is said in
`modes`, and what the modes are in `contact`.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import assign, largest
from lcpstep.events.bookkeeping import (
    BUFFER_FULL,
    EVENT,
    FINISHED,
    NEVER_LEFT,
    NOT_FINITE,
    ROW,
    SLACK,
    STEP,
    TOO_MANY_EVENTS,
    is_due,
    too_many,
)
from lcpstep.events.clock import HIGH, T0, after, find_corners
from lcpstep.events.contact import (
    CLOSED,
    EDGE_ALPHA,
    EDGE_G,
    EDGE_U,
    FREE,
    HOLD,
    IMPULSE,
    JUST_RELEASED,
    MODE,
    NONE,
    NOW,
    ON_SURFACE,
    ON_THE_SURFACE,
    finite,
    keep,
)
from lcpstep.events.single.corner import fall, is_low, low_hop, reach_end, turn_corner
from lcpstep.events.single.equations import GAP0, N_PIECE, NEXT_STEP, project
from lcpstep.events.single.keep import keep_event, keep_times, store_dense
from lcpstep.events.single.locate import first_contact, first_release, short_hop
from lcpstep.events.single.modes import impact, release, settle, settle_again
from lcpstep.events.single.motion import (
    contact_at,
    contact_impulse,
    near_surface,
    rebase,
    state_at,
    velocity_noise,
)
from lcpstep.events.single.step import refine_contact, shorten, take_step

# Places in Piece.x after those of the piece. The step at hand: its duration, the time of its end, an event within it,
# whether that is the end of a short hop; the longest step on which the gap has been found smooth, free to grow again
TO, END, FOUND, HOP, RESOLVED = range(N_PIECE, N_PIECE + 5)
N_NUMBERS = N_PIECE + 5
TOO_LONG = -1  # an interval that is to be repeated with a shorter step
GROWTH = 1.25  # of the longest step from one step to the next
PARTS = 4  # scan intervals of a Runge-Kutta step
LONGER = 3.0  # how much longer than its guess a short hop may last
ROUGH = 0.1  # share of its change by which the gap velocity may differ from the trapezoidal rule's
SMALLEST = 2.0**-20  # of the scan interval: what is still rough then is a jump that nobody has named


def run(s: Any, record: Any, count: Any, goal: int) -> int:
    """Go on from s.x[NOW] to the end of the span, or to step number `goal`; says why it returned."""
    if count[ROW] == 0 and count[STEP] == 0 and not begin(s, record, count):
        return NOT_FINITE
    while s.x[NOW] < s.plan.t_end and count[STEP] < goal:
        if count[EVENT] + SLACK > len(record.events) or count[ROW] + SLACK > len(record.rows):
            return BUFFER_FULL
        if too_many(count):
            return TOO_MANY_EVENTS
        if s.x[NOW] >= s.x[HIGH]:
            turn_corner(s)
        if s.x[MODE] == CLOSED and s.x[EDGE_ALPHA] > 0.0:
            release(s, record, count, s.x[EDGE_ALPHA])
            keep_event(s, record, count)
        code = advance(s, count)
        if code == FINISHED:
            code = finish(s, record, count)
        elif code == TOO_LONG:
            code = FINISHED
        elif code == NEVER_LEFT:
            settle_again(s, record, count)
            code = FINISHED
        if code != FINISHED:
            return code
    return FINISHED


def begin(s: Any, record: Any, count: Any) -> bool:
    """The state at the start of the span, which may lie on the surface or strike it at once."""
    x, t = s.x, s.x[NOW]
    find_corners(s, t)
    rebase(s, t)
    if s.contact:
        g, u, alpha = contact_at(s, 0.0)
        if not finite(g, u, alpha):
            return False
        x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = g, u, alpha
        small = velocity_noise(s)
        if g <= ON_THE_SURFACE * largest(s.q, 1.0):
            if u < -small:
                impact(s, record, count, u)
            else:
                settle(s, record, count, u if u > small else 0.0)
    if count[ROW] == 0 and len(record.times) == 0:
        assign(s.q, s.q0)
        assign(s.v, s.v0)
        keep(s, record, count, t)
    return True


def advance(s: Any, count: Any) -> int:
    """One DOP853 step, and the first event within it; `finish` takes it over."""
    x = s.x
    border = min(s.plan.t_end, x[HIGH])
    if x[HOLD] > x[NOW]:
        border = min(border, x[HOLD])
    longest = border - x[NOW]
    x[END] = min(border, x[NOW] + x[NEXT_STEP])
    guess = hop_time(s)
    h = take_step(s, count, min(longest, x[RESOLVED], 4.0 * guess))
    if h < 0.0:
        return int(-h)
    x[RESOLVED] = min(s.plan.scan, GROWTH * max(x[RESOLVED], h))
    end = after(x, h) if h < longest else border
    x[TO], x[FOUND], x[HOP] = h, NONE, 0.0
    code = seek_contact(s, h, guess) if s.contact and x[MODE] == FREE else FINISHED
    if code == FINISHED:
        x[END] = end
    return code


def seek_contact(s: Any, h: float, guess: float) -> int:
    """The first contact within a step of size h in free flight, into FOUND."""
    x, tau = s.x, NONE
    low = is_low(s, h)
    if guess < h or low:
        longest = min(LONGER * guess, h)
        tau = low_hop(s, guess, longest) if x[GAP0] > 0.0 else short_hop(s, guess, longest)
        x[HOP] = 1.0 if tau != NONE else 0.0
    a, at_a = 0.0, (x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA])
    for part in range(1, PARTS + 1):
        if tau == NONE and not low:
            b = h * part / PARTS
            at_b = contact_at(s, b)
            if at_b[0] - at_b[0] != 0.0:
                return NOT_FINITE
            if rough(s, b - a, at_a, at_b) and h > SMALLEST * s.plan.scan:
                x[RESOLVED] = 0.5 * h
                return TOO_LONG
            tau = first_contact(s, a, at_a, b, at_b)
            if tau == NONE and at_a[0] <= 0.0 and at_b[0] < 0.0:
                x[HOLD] = x[NOW] + b
                return NEVER_LEFT
            a, at_a = b, at_b
    if tau == NONE:
        x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = at_a
    elif x[HOP] == 0.0:
        tau = refine_contact(s, tau)
    x[FOUND] = tau
    return FINISHED


def rough(s: Any, length: float, at_a: tuple[float, float, float], at_b: tuple[float, float, float]) -> bool:
    """Whether the gap may do more within an interval than is seen at its ends: gap, velocity, acceleration there.

    The system's own motion bounds the step by the tolerance; a gap can turn faster: a shaken obstacle, a washboard.
    """
    change = at_b[1] - at_a[1] - 0.5 * length * (at_a[2] + at_b[2])
    if change - change != 0.0:
        return False  # what is not finite is another's to find
    unseen = length * abs(change)
    smooth = abs(change) <= ROUGH * 0.5 * length * (abs(at_a[2]) + abs(at_b[2]))
    return not (smooth or unseen <= s.plan.atol or unseen <= ROUGH * min(at_a[0], at_b[0]))


def hop_time(s: Any) -> float:
    """Duration of the hop that has just begun, were its acceleration constant; infinite if none has."""
    x = s.x
    if not (x[ON_SURFACE] == 1.0 and x[NOW] == x[T0] and x[EDGE_ALPHA] < 0.0):
        return math.inf
    return fall(x[GAP0], x[EDGE_U], x[EDGE_ALPHA]) if x[EDGE_U] > 0.0 or x[GAP0] > 0.0 else math.inf


def finish(s: Any, record: Any, count: Any) -> int:
    """Take over the step, which ends early if an event was found in it."""
    x = s.x
    b, end, tau, is_hop = x[TO], x[END], x[FOUND], x[HOP] == 1.0
    count[STEP] += 1
    closed = s.contact and x[MODE] == CLOSED
    if closed and x[NOW] >= x[HOLD]:
        tau = first_release(s, 0.0, min(x[EDGE_ALPHA], 0.0), b)
    stop = b if tau == NONE else tau
    t_stop = end if tau == NONE else min(after(x, tau), end)
    if tau != NONE and (closed or is_hop):
        shorten(s, tau)
    if closed:
        x[IMPULSE] += contact_impulse(s, 0.0, stop)
    keep_times(s, record, count, t_stop, tau == NONE and t_stop >= s.plan.t_end)
    store_dense(s, record, count)
    x[NOW] = t_stop
    if tau == NONE:
        return pass_end(s, record, count, stop, closed)
    return arrive(s, record, count, stop)


def arrive(s: Any, record: Any, count: Any, stop: float) -> int:
    """At the event, `stop` after the base: a release, an impact, or a touch."""
    x = s.x
    is_hop = x[HOP] == 1.0
    _, u, alpha = contact_at(s, stop)
    if not finite(0.0, u, alpha):
        return NOT_FINITE
    if is_hop:
        _, u, _ = near_surface(s, stop)
    state_at(s, stop)
    if x[MODE] == CLOSED:
        release(s, record, count, JUST_RELEASED)
        keep_event(s, record, count)
    elif is_hop or -u > velocity_noise(s):
        impact(s, record, count, min(u, 0.0))
    elif stop <= 0.0:  # a touch at the very time of the last event
        x[HOLD] = x[END]
        settle_again(s, record, count)
    else:  # a touch without impact
        rebase(s, x[NOW])
        settle(s, record, count, 0.0)
        keep_event(s, record, count)
    return FINISHED


def pass_end(s: Any, record: Any, count: Any, stop: float, closed: bool) -> int:
    """Go on beyond the end of an interval without an event."""
    if closed:
        _, u, alpha = contact_at(s, stop)
        if not finite(0.0, u, alpha):
            return NOT_FINITE
        s.x[EDGE_ALPHA] = min(alpha, 0.0)
    if closed:
        state_at(s, stop)
        project(s, s.x[NOW])
        rebase(s, s.x[NOW])
    else:
        reach_end(s, stop)
    if is_due(record, count):
        keep(s, record, count, s.x[NOW])
    return FINISHED
