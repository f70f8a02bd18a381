"""The event-driven loop for any number of contacts and joints, as kernels.

Between events the closed contacts and the joints are held on acceleration level; an event is a contact that closes
(an impact, of all contacts closed at that time) or a multiplier that turns negative (a release, after which the
contact forces are sought anew). The motion is a DOP853 step, or exact where the acceleration is constant. See `held`
for the equations, `step` and `parabolas` for the motion, `modes` for the events, and `switching` for systems with
modes of their own.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.status import DONE, NOT_FINITE

if not cython.compiled:
    from lcpstep.events.general.corner import pass_corner
    from lcpstep.events.general.equations import measure
    from lcpstep.events.general.keep import keep
    from lcpstep.events.general.modes import jump, obey, settle
    from lcpstep.events.general.motion import closed_from, come_to_rest
    from lcpstep.events.general.parabolas import fly
    from lcpstep.events.general.state import (
        BEGIN,
        ENTERED,
        JUMP,
        JUMPED,
        LOOKED,
        MOVE,
        OBEY,
        SETTLE,
        Mechanism,
    )
    from lcpstep.events.general.step import step
    from lcpstep.events.general.switching import look_at_guards, switch
    from lcpstep.kernels.course import AHEAD, ARRIVED, DUE, Events
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy


class Course(Events):
    """A motion with contacts and joints; s : Mechanism."""

    def __init__(self, s: Mechanism, record: Record, tally: Tally) -> None:
        super().__init__(record, tally, record.event_capacity - record.event_capacity // 2)
        self.s = s

    def stage(self, goal: int) -> int:
        """Whether there is an event, or the motion goes on."""
        if self.s.next != MOVE:
            return DUE
        return AHEAD if self.s.t0 < self.s.t_end and self.tally.steps < goal else ARRIVED

    def happen(self) -> int:
        """The event, or what follows from it; a status."""
        return occur(self.s, self.record, self.tally)

    def move(self) -> int:
        """A step of the motion, or what precedes it; a status."""
        return go_further(self.s, self.record, self.tally)

    def keep_now(self) -> None:
        """Keep the state at the base time, called from Python."""
        copy(self.s.q, self.s.q0, 2 * self.s.n_q)
        keep(self.s, self.record, self.s.t0)


def occur(s: Mechanism, record: Record, tally: Tally) -> int:
    """What comes next, at one time; a status."""
    code = DONE
    if s.next == BEGIN:
        s.next = JUMP
        code = DONE if begin(s) else NOT_FINITE
    elif s.next == JUMP:
        s.next = SETTLE
        code = jump(s, record, tally) if s.constant or come_to_rest(s) else NOT_FINITE
        s.guards = ENTERED if s.guards == ENTERED else JUMPED
    elif s.next == SETTLE:
        s.next = MOVE
        code = settle(s, record, tally)
    elif s.next == OBEY:
        s.next = MOVE
        obey(s, record, tally)
    else:
        s.next = JUMP
        code = switch(s, tally)
    return code


def go_further(s: Mechanism, record: Record, tally: Tally) -> int:
    """A step of the motion, or what precedes it; a status."""
    if s.watched and s.guards != LOOKED:
        look_at_guards(s)
    elif record.row == 0 and record.n_times == 0:
        keep(s, record, s.t0)
    elif s.t0 >= s.high:
        return pass_corner(s, record, tally)
    elif s.constant:
        fly(s, record, tally)
    else:
        return step(s, record, tally)
    return DONE


def begin(s: Mechanism) -> bool:
    """The state at the start of the span, where gaps that are zero are closed; False where not finite."""
    s.find_corners(s.t0)
    if not measure(s, s.t0):
        return False
    for c in range(s.n_c):
        if s.contact.gap[c] <= closed_from(s, c):
            s.contact.gap[c] = 0.0
    return True
