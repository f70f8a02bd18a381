"""Steps chosen by an error estimate: one step of h is compared with two of h/2, which are kept.

A step is accepted where its error, relative to 1 + the size of the motion, takes no more of the tolerance than its
share of the span: h / span, and of a step that an event has cut the part that it covers, for there may be thousands
of those in an h. So errors of the whole motion are proportional to the tolerance, up to what the motion itself
magnifies. Steps with events, and those that hold a jump of the forces, are few, and their errors fall no faster than
h: they may take a share of their own. A jump shows as an error that halving the step hardly makes smaller, in the
first half or, where that was accepted, in the second.

Steps are h_max / 2^k at multiples of themselves: few sizes, whose matrices are made once, an end of the span that is
met exactly, and a bisection for whatever asks for short steps. A method that stops at an event goes on from there to
the next multiple. The first step is short and steps grow by doubling, so that no oscillation of the forces is stepped
over whole: both runs would sample it at equal phases, and agree. The loop and its decisions are here; a method's own
class (`by_tolerance.moreau`, `by_tolerance.located`) takes the steps and measures their errors. Source: E. Hairer,
S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I (1993), section II.4.
"""

from __future__ import annotations

from collections.abc import Callable
from math import ldexp
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import indices
from lcpstep.kernels.course import AHEAD, ARRIVED, Course
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.record import Record
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import BUFFER_FULL, DONE, STEP_TOO_SMALL
from lcpstep.pointers import abs, inf, max, min
from lcpstep.stepping.by_tolerance.sizes import LEAST_SHARE, LEVELS, PLENTY, ROUNDED, WANTED, sizes

ACCEPTED, AGAIN, GIVEN_UP = range(3)  # verdicts
ROWS = 8  # that a step may keep besides the times asked for
TICK = 2.0 * RESOLUTION  # of a time: no shorter step shows less than what that makes of a motion
FLAT = 3.0  # an error that half the step makes smaller by less than this comes from a jump
JUMPS = 16  # steps in a row that may hold one each: more of them have errors that no step is short enough for


class Control(Course):
    """Where the run is, and what it allows.

    record, n_times      what is kept, and how many states are asked for
    matrices, made       by name, those of every level that a method has; levels of which there are any
    position, level      start of the step, in finest steps; level of the step
    end, finest          of the span, in finest steps; finest level
    tried                attempts so far
    start, stop, span    of time [s]
    h_max, tolerance     longest step [s]; error allowed over the span
    enough               share of the error allowed, below which twice the step is tried
    size_q, size_v       of the motion so far
    last, until          error of the last attempt that failed, and its end in finest steps
    jumped               steps up to here that held a jump, in a row
    into                 how far beyond `position` an event has cut the step [s]
    row, event, asked    rows and events written, and states asked for that were kept, where the step begins

    What an attempt has found:

    apart_q, apart_v     errors of positions and velocities
    far_q, far_v         sizes of those that it led to
    acceleration         by which velocities have changed over it [m/s^2], where that is known
    happened             whether there was an event, or what counts as one
    failed               whether a run could not be taken
    hopeless             nor could a shorter one go further
    full                 there was no room for its events, though there may be when the buffers are empty
    cut                  the time since its base at which it stopped, infinite where it went to the next multiple

    Parameters
    ----------
    record : Record;  make : the matrices of steps of a size, by name
    span : (start, end);  h : longest step;  tolerance : float;  order : of the method
    """

    def __init__(
        self, record: Record, make: Callable[[float], dict[str, Any]], span: tuple[float, float], h: float,
        tolerance: float, order: int,
    ) -> None:  # fmt: skip
        start, end = span
        self.record, self.n_times, self.make = record, record.n_times, make
        self.matrices: dict[str, Any] = {}
        self.own_made = np.zeros(LEVELS + 2, dtype=np.intp)
        self.made = indices(self.own_made)
        self.position, self.until, self.tried, self.jumped = 0, 0, 0, 0
        self.h_max, self.end, self.finest, self.level = sizes(span, h)
        self.start, self.stop, self.span = start, end, end - start
        self.tolerance, self.enough = tolerance, PLENTY * 0.5**order
        self.size_q = self.size_v = self.into = 0.0
        self.last = inf
        self.row = self.event = self.asked = 0
        self.begin_attempt()

    def store(self) -> None:
        """Of a method: keep the state at the start of a step."""

    def restore(self) -> None:
        """Of a method: go back there; work that was done stays counted."""

    def mark(self) -> None:
        """Note how far the record has come."""
        self.row, self.event, self.asked = self.record.row, self.record.event, self.record.next_time

    def wind_back(self) -> None:
        """Back to there in the record."""
        self.record.back_to(self.row)
        self.record.event, self.record.next_time = self.event, self.asked

    def accept(self) -> None:
        """Of a method: the step that has been taken stands."""

    def attempt(self) -> int:
        """Of a method: one step, and two halves of it; what was found into the fields, 0 or why it failed."""
        return DONE

    def stage(self, goal: int) -> int:
        """Whether a step is to be attempted."""
        return AHEAD if self.tried < goal and not self.over() else ARRIVED

    def refusal(self) -> int:
        """Whether there is room for the states of a step, and whether its matrices are made."""
        if self.record.row_capacity - self.record.row < self.n_times - self.record.next_time + ROWS:
            return BUFFER_FULL
        return DONE if self.made[self.level] and self.made[self.level + 1] else WANTED

    def move(self) -> int:
        """An attempt; DONE where the run goes on, which it also does not where a callback has failed.

        An interrupt that a callback heard is to be passed on.
        """
        self.tried += 1
        self.store()
        self.begin_attempt()
        code = self.attempt()
        if self.full:
            self.restore()
            return BUFFER_FULL
        verdict = self.judge()
        if verdict == ACCEPTED:
            self.accept()
        else:
            self.restore()
        if verdict == GIVEN_UP:
            return code if code > DONE else STEP_TOO_SMALL  # or its events never fit into the buffers
        return WANTED if self.failed else DONE

    def begin_attempt(self) -> None:
        """Nothing is known of it yet."""
        self.apart_q = self.apart_v = self.far_q = self.far_v = self.acceleration = 0.0
        self.happened = self.failed = self.hopeless = self.full = False
        self.cut = inf

    def step_size(self, level: int) -> float:
        """Step of a level [s]."""
        return ldexp(self.h_max, -level)

    def length(self, level: int) -> int:
        """The same, in finest steps."""
        one = 1
        return one << (self.finest - level)

    def base(self) -> float:
        """The multiple of the step from which times are counted until the next one is reached [s]."""
        return self.time_of(self.position)

    def now(self) -> float:
        """Time at which the step begins [s]."""
        return self.base() + self.into

    def goal(self) -> float:
        """Time at which it ends unless an event cuts it [s]."""
        return self.time_of(self.position + self.length(self.level))

    def time_of(self, position: int) -> float:
        """Time of a number of finest steps; the end of the span to the bit [s]."""
        if position >= self.end:
            return self.stop
        return min(self.stop, self.start + self.h_max * ldexp(position, -self.finest))

    def over(self) -> bool:
        """Whether the end of the span is reached."""
        return self.position >= self.end

    def resolved(self, size: float) -> float:
        """Error that a step with events may make, of positions (size_q) or velocities (size_v)."""
        return LEAST_SHARE * self.tolerance * (1.0 + size)

    def judge(self) -> int:
        """Whether the step attempted is accepted; sets the next one's place and level."""
        level, h = self.level, self.step_size(self.level)
        size_q, size_v = max(self.size_q, self.far_q), max(self.size_v, self.far_v)
        late = TICK * abs(self.now())
        wrong_q, wrong_v = self.apart_q - late * self.far_v, self.apart_v - late * self.acceleration
        error = relative_error(wrong_q, wrong_v, size_q, size_v, self.tolerance)
        share = (min(self.cut, h) - self.into) / self.span
        jumps = self.position < self.until and FLAT * error > self.last and self.jumped < JUMPS
        allowed = self.tolerance * (max(share, LEAST_SHARE) if self.happened or jumps else share)
        if self.tolerance < ROUNDED or self.hopeless:  # no step is that good
            return GIVEN_UP
        if self.failed or not error <= allowed:
            self.last = inf if self.failed else error
            self.until = self.position + self.length(level)
            if level >= self.finest:
                return GIVEN_UP
            self.level = level + 1
            self.pass_by(0.0)
            return AGAIN
        self.size_q, self.size_v = size_q, size_v
        self.jumped = self.jumped + 1 if jumps and error > self.tolerance * share else 0
        if self.pass_by(self.cut):
            return ACCEPTED
        if level > 0 and self.position % self.length(level - 1) == 0 and error <= self.enough * allowed:
            self.level = level - 1
        return ACCEPTED

    def pass_by(self, time: float) -> bool:
        """Go on to a time since the base, at most to the next multiple of the step; whether it lies still ahead."""
        h = self.step_size(self.level)
        rounding = ROUNDED * (abs(self.now()) + h)
        self.into = max(self.into, min(time, h))
        if self.into < h - rounding:
            return True
        self.position += self.length(self.level)
        self.into = self.into - h if self.into - h > rounding else 0.0
        return False

    @cython.ccall
    def prepare(self) -> None:
        """Make the matrices of the level at hand and of its halves, which `refusal` has found wanting."""
        for level in (self.level, self.level + 1):
            if not self.made[level]:
                made = self.make(self.step_size(level))
                for name in self.matrices:
                    self.matrices[name][level] = made[name]
                self.made[level] = 1

    @property
    def time(self) -> float:
        """Time at which the step begins [s]."""
        return self.now()

    @property
    def arrived(self) -> bool:
        """Whether the end of the span is reached."""
        return self.over()

    @property
    def step(self) -> float:
        """Its size [s]."""
        return self.step_size(self.level)


def relative_error(wrong_q: float, wrong_v: float, size_q: float, size_v: float, tolerance: float) -> float:
    """The larger error of positions and velocities, relative to 1 + the size of the motion, beyond rounding."""
    return max(wrong_q / (1.0 + size_q), wrong_v / (1.0 + size_v)) - min(ROUNDED, LEAST_SHARE * tolerance)


def stamp(r: Record, row: int, event: int, late: float, t: float) -> None:
    """What a step has kept and noted at `late` or after, from a row and an event on, belongs to its end t."""
    for k in range(row, r.row):
        if r.t[k] >= late:
            r.t[k] = t
    for k in range(event, r.event):
        if r.events[k * COLUMNS] >= late:
            r.events[k * COLUMNS] = t
