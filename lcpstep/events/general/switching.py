"""Systems with modes that have contacts, as kernels: x' = f_mode(t, x), x = (q, v), with impacts and contact forces.

    M v' = M a_mode(t, q, v) + G^T lambda,      0 <= g  complementary to  lambda >= 0,      u+ = -r u-

Contacts are those of the loop for any system; here its acceleration changes at guards. They are found and located by
what does so for systems without contacts (`events.hybrid`), along the motion that the contacts leave: `Watched` is
its `Motion`, whose field has the contact forces in it. The other way round, modes of contacts made from guards and
resets, would have said impacts of several contacts, chattering and release a second time, in 2^n modes.

A guard acts before an impact at the same time. Between an impact and what moves on, guards are looked at: one that
the jump has carried through zero acts. After a switch all contacts are decided anew, for forces jump and states may.
"""

from __future__ import annotations

import cython

from lcpstep.events.general.ends import INSIDE
from lcpstep.kernels.status import (
    BUFFER_FULL,
    DONE,
    ENDLESS_SWITCHING,
    NOT_FINITE,
    NOT_TRANSVERSAL,
    TOO_MANY_EVENTS,
)

if not cython.compiled:
    from lcpstep.events.general.earliest import NONE
    from lcpstep.events.general.equations import measure
    from lcpstep.events.general.motion import closed_from, touching
    from lcpstep.events.general.state import ENTERED, JUMPED, LOOKED, SWITCH, Mechanism
    from lcpstep.events.hybrid.locate import UNKNOWN, find, locate
    from lcpstep.events.hybrid.loop import MAX_STALLED, enter, leave
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import min

SWITCHES = 4  # what a guard does, beside what contacts do (`earliest`)


def watch(s: Mechanism) -> int:
    """The first guard that acts within the step, before the event found in it, takes its place."""
    h = s.length
    end = h if s.found == NONE else s.found
    if not end > 0.0:
        return DONE
    s.watch.now, s.watch.t_end = s.t0, min(s.t_end, s.high)
    k, at, slope, curvature = find(s.watch, h, end / h)
    if k == UNKNOWN:
        return NOT_FINITE
    if k < 0:
        return DONE
    s.watch.culprit, s.watch.armed[k] = k, s.watch.was_armed
    if s.watch.was_armed and slope * slope <= -4.0 * s.watch.band[k] * curvature:
        s.watch.now = s.t0 + at * h
        return NOT_TRANSVERSAL
    s.found, s.event_kind, s.slope = at * h, SWITCHES, slope
    return DONE


def reach_guard(s: Mechanism) -> float:
    """The time from the base at which the guard found acts; the step is repeated up to it."""
    return locate(s.watch, s.watch.culprit, s.length, s.found / s.length, s.slope)


def look_at_guards(s: Mechanism) -> None:
    """After the start of a mode, or a jump of velocities: a guard that is passed acts."""
    s.watch.now = s.t0
    s.watch.culprit = enter(s.watch, -1, s.guards == JUMPED)
    s.guards = LOOKED
    if s.watch.culprit >= 0:
        s.next = SWITCH


def switch(s: Mechanism, tally: Tally) -> int:
    """The guard acts at the state q0, v0: log, reset, new mode; contacts closed that stay so are found by `jump`."""
    k = s.watch.culprit
    if s.watch.switches >= s.watch.log_capacity:
        s.next = SWITCH
        return BUFFER_FULL
    s.watch.now, s.guards = s.t0, ENTERED
    leave(s.watch, k)
    s.model.mode = s.watch.mode
    tally.events += 1
    if s.watch.stalled > MAX_STALLED:
        return ENDLESS_SWITCHING
    if tally.events > tally.max_events:
        return TOO_MANY_EVENTS
    return place(s) if s.watch.m.has_reset[k] != 0 else DONE


def place(s: Mechanism) -> int:
    """Gaps and speeds of the contacts where a reset has put the state."""
    copy(s.q, s.q0, 2 * s.n_q)
    if not measure(s, s.t0):
        return NOT_FINITE
    for c in range(s.n_c):
        s.contact.closed[c] = s.contact.carried[c] = 0
        if s.contact.gap[c] < -touching(s, c):
            s.culprit = c
            return INSIDE
        if s.contact.gap[c] <= closed_from(s, c):
            s.contact.gap[c] = 0.0
    return DONE
