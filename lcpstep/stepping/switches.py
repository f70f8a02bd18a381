"""How contacts of `Located` close and open without an impact, as kernels, and whether that ever ends.

Each turn of a contact is counted. A contact that goes on turning at one instant, at speeds next to nothing, is left
to `settle`; so is one that hops on beside closed contacts which feel it. Such a sequence grows ever shorter in truth,
but not below the rounding of its gaps: a particle that comes to rest on three nearly parallel planes.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.recording import write_event
from lcpstep.stepping.located_work import (
    CLOSED,
    CLOSED_NOW,
    EVENT,
    EVENTS,
    FORCE_NOW,
    GAP,
    GROUND,
    GROUNDED,
    HOPS,
    IDLE,
    OLDER,
    OLDER_TIME,
    OPEN,
    RATE,
    RELEASE,
    SIGMA,
    STALLED,
    STATUS,
    STICK,
    TURNED,
    TURNS,
)
from lcpstep.stepping.magnitudes import acceleration_terms, faint

COLLAPSE = 1e-9  # of a step: what happens as close in time as this happens at one instant
FIRST = 1e-7  # of a step: the stretch over which that is settled first; hops that no step can follow
SHORT_TOGETHER = 1e-5  # of a step: hops of coupled contacts below it are taken as one
AT_ONCE = 16  # events of one contact at one instant after which faint ones are settled,
AT_ONCE_FAST = 1000  # all but strikes of elastic contacts,
AT_ONCE_ELASTIC = 100_000  # and all


@inline
def log(record: Any, count: Any, t: float, c: int, before: float, after: float, p: float, kind: int) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, c, before, after, p, kind)
    count[EVENT] += 1


@inline
def idle(x: Any, count: Any) -> None:
    """Count a round of the loop in which nothing was noted: these have an end too."""
    x[EVENTS] += 1.0
    count[IDLE] += 1


def turn(m: Any, plan: Any, w: Any, x: Any, c: int, u: float, struck: bool) -> None:
    """Note that contact c strikes, closes or opens at speed u; where that goes on for ever, the motion is settled.

    What goes on at one instant has no end if its speeds are faint. An elastic contact may be struck as often as
    masses are unlike: it is counted at one and the same time only, or where its hops are too short to be followed
    though nothing but the acceleration brings it back.
    """
    elastic = struck and m.restitution[c] == 1.0
    since = x[SIGMA] - w.num[TURNED, c]
    if since > (0.0 if elastic else COLLAPSE * plan.h):
        w.num[TURNS, c] = 0.0
    short = (FIRST if elastic else SHORT_TOGETHER) * plan.h
    hops = since <= short and (elastic or coupled(w, c)) and abs(u) <= short * acceleration_terms(m, w, c)
    w.num[TURNED, c] = x[SIGMA]
    w.num[TURNS, c] += 1.0
    w.num[HOPS, c] = w.num[HOPS, c] + 1.0 if hops else 0.0
    if w.num[HOPS, c] >= (AT_ONCE_FAST if elastic else AT_ONCE):
        x[STALLED] = max(x[STALLED], short)
    if w.num[TURNS, c] < AT_ONCE:
        return
    if elastic:
        most = AT_ONCE_ELASTIC
    else:
        most = AT_ONCE if faint(plan, w, c, u) else AT_ONCE_FAST
    if w.num[TURNS, c] >= most:
        x[STALLED] = max(x[STALLED], FIRST * plan.h)


def coupled(w: Any, c: int) -> bool:
    """Whether contact c stands beside a closed one that feels it."""
    found = False
    for d in range(w.num.shape[1]):
        found = found or (d != c and w.mark[STATUS, d] == CLOSED and w.W[c, d] != 0.0)
    return found


def stick(w: Any, record: Any, count: Any, x: Any, c: int, t: float) -> None:
    """A contact stays closed from here on."""
    w.num[RATE, c], w.mark[STATUS, c] = 0.0, CLOSED
    x[CLOSED_NOW] += 1
    w.num[OLDER, c] = w.num[FORCE_NOW, c] = 0.0
    log(record, count, t, c, 0.0, 0.0, 0.0, STICK)


def release(
    m: Any, plan: Any, w: Any, record: Any, count: Any, x: Any, c: int, t: float, after: float
) -> None:
    """A closed contact opens."""
    w.mark[STATUS, c], w.mark[GROUNDED, c] = OPEN, GROUND
    x[CLOSED_NOW] -= 1
    w.num[FORCE_NOW, c] = w.num[OLDER, c] = 0.0
    w.num[GAP, c], w.num[RATE, c] = 0.0, after
    log(record, count, t, c, 0.0, after, 0.0, RELEASE)
    turn(m, plan, w, x, c, after, False)
    x[EVENTS] += 1


@inline
def release_time(w: Any, c: int, t: float, rest: float, deficit: float) -> float:
    """When the contact force vanished, between its last positive mean and the first that would be negative."""
    if not w.num[OLDER, c] > 0.0:
        return t
    middle = t + 0.5 * rest
    found = w.num[OLDER_TIME, c] + (middle - w.num[OLDER_TIME, c]) * w.num[OLDER, c] / (
        w.num[OLDER, c] + deficit
    )
    return min(max(found, w.num[OLDER_TIME, c]), t + rest)
