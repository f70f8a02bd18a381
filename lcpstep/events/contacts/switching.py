"""Systems with modes that have contacts, as kernels: x' = f_mode(t, x), x = (q, v), with impacts and contact forces.

    M v' = M a_mode(t, q, v) + G^T lambda,      0 <= g  complementary to  lambda >= 0,      u+ = -r u-

Contacts are those of `loop`; here the acceleration changes at guards. They are found and located by
what does so for systems without contacts (`events.hybrid`), along the motion that the contacts leave: `Watched` is
its `Motion`, whose field has the contact forces in it. The other way round, modes of contacts made from guards and
resets, would have said impacts of several contacts, chattering and release a second time, in 2^n modes.

A guard acts before an impact at the same time. Between an impact and what moves on, guards are looked at: one that
the jump has carried through zero acts. After a switch all contacts are decided anew, for forces jump and states may.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.events.codes import ENTERED, INSIDE, JUMPED, LOOKED, OPEN, SWITCH
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.impact import begin_instant
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.contacts.surfaces import find_closed
from lcpstep.events.hybrid.locate import UNKNOWN, find, locate, turns_back
from lcpstep.events.hybrid.loop import MAX_STALLED, enter, leave
from lcpstep.events.hybrid.state import Motion
from lcpstep.events.rows.contacts import gap_tolerance
from lcpstep.kernels.status import (
    BUFFER_FULL,
    DONE,
    ENDLESS_SWITCHING,
    NOT_FINITE,
    NOT_TRANSVERSAL,
    TOO_MANY_EVENTS,
)
from lcpstep.pointers import Doubles, max


class Watched(Motion):
    """The motion `rubbing` of a system with modes, as its guards see it: they share one step."""

    rubbing: Any

    @cython.ccall
    def share(self, s: Rubbing) -> None:
        """Look at the guards of modes along that motion, on its numbers: states and stages are those of s."""
        self.rubbing, self.state, s.watch = s, s.state, self
        self.y, self.y_new, self.y_stage, self.first, self.K, self.F = (
            s.y, s.y_new, s.y_stage, s.first, s.K, s.F,
        )  # fmt: skip

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """Dy = (v, v') in the mode at hand, with the rows held."""
        self.rubbing.stage = self.stage
        return self.rubbing.rates(t, y, dy)


def watch(s: Rubbing, h: float, end: float) -> int:
    """The first guard of modes that acts within the share `end` of the step of size h, into `watch`; a status.

    When, as a share of h, into `found`.
    """
    s.watch.due = -1
    if not end > 0.0:
        return DONE
    s.watch.now, s.watch.t_end = s.rows.t0, s.rows.border()
    k = find(s.watch, h, end)
    if k == UNKNOWN:
        return NOT_FINITE
    if k < 0:
        return DONE
    s.watch.due, s.watch.armed[k] = k, s.watch.was_armed
    if turns_back(s.watch):
        s.watch.now = s.rows.t0 + s.watch.place * h
        return NOT_TRANSVERSAL
    s.found = s.watch.place
    return DONE


def reach_guard(s: Rubbing, h: float) -> float:
    """The time from the base at which the guard found acts; the step is repeated up to it."""
    tau = locate(s.watch, h)
    if tau > 0.0:
        s.complete(s.rows.t0, tau)
    return tau


def look_at_guards(s: Rubbing) -> None:
    """After the start of a mode, or a jump of velocities: a guard that is passed acts."""
    s.watch.now = s.rows.t0
    s.watch.due = enter(s.watch, -1, s.since_look == JUMPED)
    s.since_look = LOOKED
    if s.watch.due >= 0:
        s.rows.next = SWITCH


def switch(s: Rubbing) -> int:
    """The guard acts at the base: log, reset, new mode; contacts closed that stay so are found by `jump`."""
    k = s.watch.due
    if s.watch.switches >= s.watch.log_capacity:
        s.rows.next = SWITCH
        return BUFFER_FULL
    s.watch.now, s.since_look = s.rows.t0, ENTERED
    leave(s.watch, k)
    s.model.mode = s.watch.mode
    s.rows.tally.events += 1
    if s.watch.stalled > MAX_STALLED:
        return ENDLESS_SWITCHING
    if s.rows.tally.events > s.rows.tally.max_events:
        return TOO_MANY_EVENTS
    return place(s, s.watch.m.has_reset[k] != 0)


def place(s: Rubbing, moved: bool) -> int:
    """Gaps and velocities of the contacts; those of a state that a reset has moved begin anew."""
    if not measure(s, s.rows.t0, s.y):
        return NOT_FINITE
    for c in range(s.n_c):
        s.touches[c] = 1 if s.mode[c] != OPEN else 0
        if moved:
            s.mode[c], s.carried[c] = OPEN, 0
            if s.gap[s.n_j + c] < -max(s.rows.rounding_of_gap(c), gap_tolerance(s.rows, c)):
                s.rows.culprit = c
                return INSIDE
    begin_instant(s)
    if moved:
        find_closed(s)
    return DONE
