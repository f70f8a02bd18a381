"""The loop under constant accelerations, without friction, as kernels: exact from contact to contact.

Any number of contacts and joints, whose gaps are linear in q. Between events the closed contacts and the joints are
held on acceleration level; an event is a contact that closes (an impact, of all contacts closed at that time), after
which the contact forces are sought anew. See `held` for the equations, `flight` for the motion, `modes` for the
events.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.status import DONE, NOT_FINITE

if not cython.compiled:
    from lcpstep.events.parabolas.equations import measure
    from lcpstep.events.parabolas.flight import fly
    from lcpstep.events.parabolas.keep import keep
    from lcpstep.events.parabolas.modes import jump, settle
    from lcpstep.events.parabolas.motion import rounding_of_gap
    from lcpstep.events.parabolas.state import BEGIN, JUMP, MOVE, SETTLE, Mechanism
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
        """A flight, or what precedes it; a status."""
        if self.record.row == 0 and self.record.n_times == 0:
            keep(self.s, self.record, self.s.t0)
        else:
            fly(self.s, self.record, self.tally)
        return DONE

    def keep_now(self) -> None:
        """Keep the state at the base time, called from Python."""
        copy(self.s.q, self.s.q0, 2 * self.s.n_q)
        keep(self.s, self.record, self.s.t0)


def occur(s: Mechanism, record: Record, tally: Tally) -> int:
    """What comes next, at one time; a status."""
    if s.next == BEGIN:
        s.next = JUMP
        return DONE if begin(s) else NOT_FINITE
    if s.next == JUMP:
        s.next = SETTLE
        return jump(s, record, tally)
    s.next = MOVE
    return settle(s, record, tally)


def begin(s: Mechanism) -> bool:
    """The state at the start of the span, where gaps that are zero are closed; False where not finite."""
    s.find_corners(s.t0)
    if not measure(s, s.t0):
        return False
    for c in range(s.n_c):
        if s.contact.gap[c] <= rounding_of_gap(s, c):
            s.contact.gap[c] = 0.0
    return True
