"""A run of the event-driven method, from kernel calls to a trajectory: portions, buffers, and how it ended."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.faults import cause
from lcpstep.kernels.status import BUFFER_FULL, DONE
from lcpstep.kernels.tally import Tally
from lcpstep.model import culprit, unrepeatable
from lcpstep.pace import Pace
from lcpstep.recording import TIME, Kept, Recorder, States
from lcpstep.trajectory import Counts, Status, Trajectory

Array = NDArray[np.float64]
PORTION = 4096  # steps between two looks at the outside world, at most
TRIALS = 17  # of the callbacks within an interval that failed


class Run(ABC):
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, recorder: Recorder) -> None:
        self.method, self.scene, self.kept, self.recorder = method, scene, kept, recorder
        self.tally, self.closed = Tally(method.max_events), False  # closed: the last state has been kept
        self.pace = Pace(PORTION, scene.n_q + scene.n_c + scene.n_j)

    @property
    @abstractmethod
    def now(self) -> float:
        """Time reached [s]."""

    @property
    @abstractmethod
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""

    @property
    @abstractmethod
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""

    @property
    @abstractmethod
    def evaluations(self) -> int:
        """How often forces were evaluated."""

    @abstractmethod
    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""

    @abstractmethod
    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""

    @abstractmethod
    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones."""

    def status(self, code: int) -> Status:
        """How the run ended, by what the kernel returned."""
        return Status(code)

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        code, raised = DONE, None
        try:
            while code in (DONE, BUFFER_FULL) and self.now < self.scene.t_span[1]:
                code = self.advance(self.pace.goal(self.tally.steps))
                raised = cause()
                self.empty()
                progress(self.now)
            result = self.trajectory(self.status(code), self.message(code))
        except KeyboardInterrupt:
            message = f"interrupted {self.where}"
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED, message)) from None
        if result.status == Status.NOT_FINITE:
            raise SimulationError(result.message, result) from raised
        return result

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

    def trajectory(self, status: Status, message: str) -> Trajectory:
        """Everything computed so far."""
        record, n_c = self.recorder.record, self.scene.n_c
        nothing = record.row == 0 or self.now > self.recorder.rows[record.row - 1, TIME]
        if len(self.kept.times) == 0 and nothing and not self.closed:
            self.keep_now()
        self.closed = True
        self.recorder.take()
        s = self.recorder.states()
        return Trajectory(
            scene=self.scene, method=self.method, t=s.t, q=s.q, v=s.v,
            impulse=np.ascontiguousarray(s.impulse[:, :n_c]),
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=message,
            counts=Counts(
                steps=self.tally.steps, force_evaluations=self.evaluations, events=self.tally.events
            ),
            dense=self.dense_output(s), joint_impulse=np.ascontiguousarray(s.impulse[:, n_c:]),
        )  # fmt: skip

    @property
    def where(self) -> str:
        """Time and state reached, in words."""
        q, v = self.state
        return f"at t = {self.now:.9g} s, q = {q.tolist()}, v = {v.tolist()}"

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        q, v = self.state
        if code == Status.DONE:
            return "reached the end of the span"
        if code == Status.TOO_MANY_EVENTS:
            return f"more than max_events = {self.method.max_events} events {self.where}"
        if code == Status.STEP_TOO_SMALL:
            tolerances = f"rtol = {self.method.rtol:g}, atol = {self.method.atol:g}"
            words = f"the tolerances {tolerances} cannot be met {self.where}"
            names = " and ".join(unrepeatable(self.scene, self.now, q.copy(), v.copy()))
            return f"{words}: {names} must be functions of time and state, and are not" if names else words
        times = np.linspace(self.now, self.interval_end, TRIALS)
        return f"{culprit(self.scene, times, q.copy(), v.copy())} {self.where}"


@dataclass(eq=False)
class Between(ABC):
    """States at any time, from the kept state before each; a function of times (m,) that can be pickled."""

    s: States
    complete: bool  # whether no state was left out; else only the kept ones are known

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times, each (m, n_q); ValueError where the state before one was not kept."""
        if not self.complete and not np.all(np.isin(times, self.s.t)):
            raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
        return self.evaluate(times, np.maximum(np.searchsorted(self.s.t, times, side="right") - 1, 0))

    @abstractmethod
    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""


def without_impulses(s: States) -> States:
    """The states alone: their impulses are the trajectory's."""
    return s._replace(impulse=np.zeros((0, 0)))
