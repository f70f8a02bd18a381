"""The loop under constant accelerations, without friction, as kernels: exact from contact to contact.

Any number of contacts and joints, whose gaps are linear in q. Between events the closed contacts and the joints are
held on acceleration level; an event is a contact that closes (an impact, of all contacts closed at that time), after
which the contact forces are sought anew. See `held` for the equations, `flight` for the motion, `modes` for the
events.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import BEGIN, JUMP, MOVE, SETTLE
from lcpstep.events.parabolas.flight import fly
from lcpstep.events.parabolas.modes import jump, settle
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.rows.equations import free_motion, measure_rates, respond
from lcpstep.events.rows.keep import keep
from lcpstep.kernels.course import DUE, Events
from lcpstep.kernels.dynamics import gaps
from lcpstep.kernels.status import DONE, NOT_FINITE
from lcpstep.kernels.vectors import copy, product
from lcpstep.pointers import after


class Course(Events):
    """A motion with contacts and joints; s : Mechanism."""

    def __init__(self, s: Mechanism) -> None:
        super().__init__(s, s.record.event_capacity - s.record.event_capacity // 2)
        self.s = s

    def stage(self, goal: int) -> int:
        """Whether there is an event, or the motion goes on."""
        return self.ahead(self.s.t0, self.s.tally.steps, goal) if self.s.next == MOVE else DUE

    def happen(self) -> int:
        """The event, or what follows from it; a status."""
        return occur(self.s)

    def move(self) -> int:
        """A flight, or what precedes it; a status."""
        if self.s.record.row == 0 and self.s.record.n_times == 0:
            keep(self.s, self.s.t0, self.s.q)
        else:
            fly(self.s)
        return DONE

    @cython.ccall
    def keep_now(self) -> None:
        """Keep the state at the base time, called from Python."""
        copy(self.s.q, self.s.q0, 2 * self.s.n_q)
        keep(self.s, self.s.t0, self.s.q)


def occur(s: Mechanism) -> int:
    """What comes next, at one time; a status."""
    if s.next == BEGIN:
        s.next = JUMP
        return DONE if begin(s) else NOT_FINITE
    if s.next == JUMP:
        s.next = SETTLE
        return jump(s)
    s.next = MOVE
    return settle(s)


def begin(s: Mechanism) -> bool:
    """The state at the start of the span, where gaps that are zero are closed; False where not finite.

    Rows and free acceleration are known for good: gaps are linear, and neither obstacles nor joints move.
    """
    s.find_corners(s.t0)
    if not free_motion(s, s.t0, s.q, s.a_free):
        return False
    if s.n_c > 0:
        gaps(s.model, s.t0, s.q, s.v, after(s.gap, s.n_j))
    measure_rates(s, s.t0, s.q)
    respond(s)
    for i in range(s.n_j, s.n_r):
        s.velocity[i] = product(s.R, s.v, i, s.n_q)
        size = s.velocity[i] + s.gap[i]
        if size - size != 0.0:
            return False
        if s.gap[i] <= s.rounding_of_gap(i - s.n_j):
            s.gap[i] = 0.0
    return True
