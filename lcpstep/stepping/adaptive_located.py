"""Steps of `Located` chosen by a tolerance: what one step and its two halves do.

Velocities count where both runs had the same events: an impact that one of them sees just after the end of the step
is no error. The kernel of the fixed steps takes each part; what stands between is plain Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.compiled import compiled
from lcpstep.recording import Record
from lcpstep.stepping.adaptive import (
    ACCEPTED,
    AGAIN,
    GIVEN_UP,
    LEVEL,
    LOOK,
    PAUSED,
    SIZE_Q,
    SIZE_V,
    TOO_SMALL,
    Control,
    distance,
    judge,
    largest,
    now,
    over,
    step_size,
)
from lcpstep.stepping.located_work import (
    BUFFER_FULL,
    EVENT,
    FINISHED,
    FORCES,
    LCP_CALLS,
    NEXT_TIME,
    ROW,
    UNCHANGED,
    Plan,
    Q,
    V,
    Work,
)

STATE = slice(Q, V + 1)  # rows of Work.vec
Prepared = tuple[Plan, Work]
Step = Callable[[Plan, Work, float], int]  # one step from a time; the code of the loop


def weigh(control: Any, failed: bool, one: Any, vec: Any, same: bool, happened: bool) -> int:
    """Kernel: the verdict on a step that led to the rows of `one`, and in two halves to those of vec."""
    apart_v = distance(one[V], vec[V]) if same else 0.0
    return judge(control, failed, distance(one[Q], vec[Q]), apart_v, vec[Q], vec[V], happened)


class Attempts:
    """A run of `Located` as `adaptive.advance` wants it.

    `make(h)` gives what steps of size h need, `step` takes one of them.
    """

    def __init__(
        self, make: Callable[[float], Prepared], step: Step, w: Work, x: NDArray[np.float64], record: Record,
        count: NDArray[np.int64], control: Control, constant: bool, fast: bool,
    ) -> None:  # fmt: skip
        self.make, self.step, self.w, self.x = make, step, w, x
        self.record, self.count, self.control = record, count, control
        self.prepared: dict[int, Prepared] = {}
        self.weigh = compiled(weigh) if fast else weigh
        self.arrays = [w.vec, w.num, w.mark, x, count] + ([] if constant else [w.G, w.MG, w.W, w.M])
        self.saved = [a.copy() for a in self.arrays]
        self.row, self.under_way = record.rows[0].copy(), False
        control.real[SIZE_Q], control.real[SIZE_V] = largest(w.vec[Q]), largest(w.vec[V])

    def attempts(self) -> int:
        """Take steps until the end of the span, full buffers, or a step that cannot be taken."""
        for _ in range(LOOK):
            if over(self.control):
                return FINISHED
            left = len(self.record.rows) - self.count[ROW]
            if left < len(self.record.times) - self.count[NEXT_TIME] + 8:
                return PAUSED
            self.store()
            code, verdict = self.attempt()
            full = code == BUFFER_FULL and self.saved[4][EVENT] + self.saved[4][ROW] > 0
            if verdict != ACCEPTED:
                self.undo()
            self.under_way = False
            if full:
                return PAUSED
            if verdict == GIVEN_UP:
                return TOO_SMALL if code == FINISHED else code
        return PAUSED

    def attempt(self) -> tuple[int, int]:
        """One step, then two halves of it: the last code of the loop, and the verdict."""
        level, t, one, events = int(self.control.whole[LEVEL]), now(self.control), self.w.vec[STATE], []
        code = self.part(level, t)
        if code == FINISHED:
            one, events = one.copy(), self.events()
            self.undo()
            code = self.part(level + 1, t)
        if code == FINISHED:
            code = self.part(level + 1, t + step_size(self.control, level + 1))
        if code == BUFFER_FULL and self.saved[4][EVENT] + self.saved[4][ROW] > 0:
            return code, AGAIN
        both = self.events()
        happened = bool(events or both)
        return code, self.weigh(
            self.control, code != FINISHED, one, self.w.vec[STATE], events == both, happened
        )

    def part(self, level: int, t: float) -> int:
        """One step of a level."""
        if level not in self.prepared:
            self.prepared[level] = self.make(step_size(self.control, level))
        self.x[UNCHANGED] = 0.0
        return self.step(*self.prepared[level], t)

    def events(self) -> list[tuple[float, float]]:
        """Contact and kind of each event since the start of the step."""
        first, last = int(self.saved[4][EVENT]), int(self.count[EVENT])
        return [(e[1], e[5]) for e in self.record.events[first:last].tolist()] if last > first else []

    def store(self) -> None:
        """Keep the state at the start of a step, and the last row, which an event at its time changes."""
        for saved, a in zip(self.saved, self.arrays, strict=True):
            np.copyto(saved, a)
        if self.count[ROW] > 0:
            np.copyto(self.row, self.record.rows[self.count[ROW] - 1])
        self.under_way = True

    def undo(self) -> None:
        """Back to the start of the step, if one is under way; work that was done stays counted."""
        if not self.under_way:
            return
        done = self.saved[4]
        done[LCP_CALLS], done[FORCES] = self.count[LCP_CALLS], self.count[FORCES]
        for saved, a in zip(self.saved, self.arrays, strict=True):
            np.copyto(a, saved)
        if self.count[ROW] > 0:
            np.copyto(self.record.rows[self.count[ROW] - 1], self.row)
