"""What event-driven runs share: buffers whose last row may still change, and states between kept ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.events.general.ends import STATUS
from lcpstep.kernels.between import last_rows
from lcpstep.kernels.layout import TIME
from lcpstep.kernels.tally import Tally
from lcpstep.model import unrepeatable
from lcpstep.recording import Kept, Recorder, States
from lcpstep.room import closes_upon
from lcpstep.running import Run
from lcpstep.trajectory import Counts, Status

Array = NDArray[np.float64]
PORTION = 4096  # steps between two looks at the outside world, at most
TRIALS = 17  # of the callbacks within an interval that failed


class EventRun(Run):
    """One run from event to event; `course`: its kernel, see `kernels.course`."""

    course: Any

    def __init__(self, method: Any, scene: Scene, kept: Kept, recorder: Recorder) -> None:
        super().__init__(method, scene, kept, recorder, PORTION)
        self.tally, self.closed = Tally(method.max_events), False  # closed: the last state has been kept

    @property
    @abstractmethod
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""

    @property
    def evaluations(self) -> int:
        """How often forces were evaluated; never where their motion is known."""
        return 0

    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""
        return int(self.course.advance(goal))

    @property
    def done(self) -> int:
        """Steps taken."""
        return int(self.tally.steps)

    @property
    def ahead(self) -> Array:
        """Times at which a callback may be what has failed [s]."""
        return np.linspace(self.now, self.interval_end, TRIALS)

    @property
    def counts(self) -> Counts:
        """Work done."""
        return Counts(self.tally.steps, force_evaluations=self.evaluations, events=self.tally.events)

    def empty(self) -> None:
        """Move the buffers' contents to the recorder, but for the last row, whose step may still be to come."""
        record = self.recorder.record
        left, last = min(record.row, 1), max(record.row - 1, 0)
        self.recorder.empty(last, record.event)
        for kept in (
            self.recorder.rows,
            self.recorder.curves,
        ):  # or has been made, where the run ends at an event
            kept[:1] = kept[last : last + 1]
        record.row, record.event = left, 0

    def states(self) -> States:
        """All states kept, and the last one where states are kept by steps or events."""
        record = self.recorder.record
        nothing = record.row == 0 or self.now > self.recorder.rows[record.row - 1, TIME]
        if len(self.kept.times) == 0 and nothing and not self.closed:
            self.course.keep_now()
        self.closed = True
        self.recorder.take()
        return self.recorder.states()

    def status(self, code: int) -> Status:
        """How the run ended, by what the kernel returned."""
        return STATUS.get(code) or Status(code)

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code != Status.STEP_TOO_SMALL:
            return super().why(code)
        q, v = self.state
        tolerances = f"rtol = {self.method.rtol:g}, atol = {self.method.atol:g}"
        words = f"the tolerances {tolerances} cannot be met {self.where}"
        names = " and ".join(unrepeatable(self.scene, self.now, q.copy(), v.copy()))
        if names:
            return f"{words}: {names} must be functions of time and state, and are not"
        closing = closes_upon(self.scene, self.now, q.copy())
        return f"{closing}: {words}" if closing else words


@dataclass(eq=False)
class Between(ABC):
    """States at any time, from the kept state before each; a function of times (m,) that can be pickled."""

    s: States
    complete: bool  # whether no state was left out; else only the kept ones are known

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times, each (m, n_q); ValueError where the state before one was not kept."""
        if not self.complete and not np.all(np.isin(times, self.s.t)):
            raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
        times = np.ascontiguousarray(times)
        return self.evaluate(times, last_rows(self.s.t, times, 0, len(self.s.t) - 1))

    @abstractmethod
    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""


def without_impulses(s: States) -> States:
    """The states alone: their impulses are the trajectory's."""
    return s._replace(impulse=np.zeros((0, 0)))
