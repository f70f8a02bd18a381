"""The loop over time that all runs from event to event share, and those by steps: what is due, then a motion."""

from __future__ import annotations

import cython

from lcpstep.kernels.clock import Clock
from lcpstep.kernels.status import BUFFER_FULL, DONE, TOO_MANY_EVENTS

DUE, AHEAD, ARRIVED = range(3)  # stages


class Course:
    """The way of a run through its span; every kind of motion has its own."""

    @cython.ccall
    def advance(self, goal: int) -> int:
        """`go_on`, called from Python."""
        with cython.nogil:
            return self.go_on(goal)

    def go_on(self, goal: int) -> int:
        """Go on to the end of the span, or to step number `goal`; says why it returned.

        DONE hinders nothing: a step, or a portion up to its goal, returns it as well; any other code ends the loop.
        """
        code, stage = DONE, AHEAD
        while code == DONE:
            stage = self.stage(goal)
            if stage == ARRIVED:
                break
            code = self.happen() if stage == DUE else self.refusal()
            if code == DONE and stage == AHEAD:
                code = self.move()
        return code

    def stage(self, goal: int) -> int:
        """DUE where something is to be done at this time, else AHEAD; ARRIVED at the end, or at step `goal`."""
        return ARRIVED

    def happen(self) -> int:
        """Do what is due; a status."""
        return DONE

    def refusal(self) -> int:
        """Why no step may be taken now, or DONE."""
        return DONE

    def move(self) -> int:
        """A step, or a part of one up to an event; a status."""
        return DONE


class Stepwise(Course):
    """The same over steps of one size.

    t0, first, last   time at which a step begins, its number, and that of the step to stop before
    """

    def __init__(self) -> None:
        self.t0, self.first, self.last = 0.0, 0, 0

    @cython.ccall
    def run(self, t0: float, first: int, last: int) -> int:
        """`take`, called from Python."""
        with cython.nogil:
            return self.take(t0, first, last)

    def take(self, t0: float, first: int, last: int) -> int:
        """Steps up to last - 1, step `first` beginning at t0; says why it returned."""
        self.t0, self.first, self.last = t0, first, last
        return self.go_on(last)


class Events(Course):
    """The same from event to event, of what has a record and a tally.

    clock   which has what is kept, and counted
    room    events that one round may note

    Parameters
    ----------
    clock, room : as above
    """

    def __init__(self, clock: Clock, room: int) -> None:
        self.clock, self.room = clock, room

    def ahead(self, now: float, taken: int, goal: int) -> int:
        """Whether the motion goes on from the time reached, after so many steps."""
        return AHEAD if now < self.clock.t_end and taken < goal else ARRIVED

    def refusal(self) -> int:
        """Whether buffers are full, or there were too many events."""
        if self.clock.record.full(self.room):
            return BUFFER_FULL
        return TOO_MANY_EVENTS if self.clock.tally.too_many() else DONE
