"""A run of the event-driven method, from kernel calls to a trajectory: portions, buffers, and how it ended."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import call, compiled
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.events.bookkeeping import (
    BUFFER_FULL,
    EVENT,
    EVENTS,
    FINISHED,
    FORCES,
    MAX_EVENTS,
    N_COUNTERS,
    NOT_FINITE,
    ROW,
    SLACK,
    STEP,
    STEP_TOO_SMALL,
    TOO_MANY_EVENTS,
)
from lcpstep.faults import forget
from lcpstep.model import ABSENT, Model, culprit, model, unrepeatable
from lcpstep.pace import Pace
from lcpstep.recording import TIME, Kept, Recorder, States
from lcpstep.trajectory import Counts, Status, Trajectory

Array = NDArray[np.float64]
PORTION = 4096  # steps between two looks at the outside world, at most
# The scan for events must see every turn of the motion: intervals per period of each of its oscillations
PER_PERIOD, PER_FORCING, PER_SPAN = 10, 16, 50
SAMPLES, WINDOWS, GOLDEN = 512, 16, 0.6180339887498949  # of the motion of obstacles, to see how fast it turns
SLOPE = 1e-7  # of the time looked at: step of a difference
TRIALS = 17  # of the callbacks within an interval that failed

STATUS = {
    FINISHED: Status.DONE,
    NOT_FINITE: Status.NOT_FINITE,
    TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    STEP_TOO_SMALL: Status.STEP_TOO_SMALL,
}


class Run(ABC):
    """One run: the kernel's arrays, and the portions that it is fed in."""

    status_of: Mapping[int, Status] = STATUS  # by why the loop returned

    def __init__(self, method: Any, scene: Scene, kept: Kept, recorder: Recorder) -> None:
        self.method, self.scene, self.kept, self.recorder = method, scene, kept, recorder
        self.count = np.zeros(N_COUNTERS, dtype=np.int64)
        self.count[MAX_EVENTS] = method.max_events
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

    @abstractmethod
    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""

    @abstractmethod
    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""

    @abstractmethod
    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones."""

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        code = FINISHED
        try:
            while code in (FINISHED, BUFFER_FULL) and self.now < self.scene.t_span[1]:
                try:
                    code = self.advance(self.pace.goal(int(self.count[STEP])))
                except Exception as error:  # a callback in plain Python; compiled code raises nothing
                    message = self.message(NOT_FINITE)
                    raise SimulationError(message, self.trajectory(Status.NOT_FINITE, message)) from error
                self.empty()
                progress(self.now)
        except KeyboardInterrupt:
            message = f"interrupted {self.where}"
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED, message)) from None
        result = self.trajectory(self.status_of[code], self.message(code))
        if result.status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    def empty(self) -> None:
        """Move the buffers' contents to the recorder, but for the last row, whose step may still be to come."""
        rows, buffers = int(self.count[ROW]), self.recorder.buffers
        last = max(rows - 1, 0)
        self.recorder.empty(last, int(self.count[EVENT]))
        for kept in (buffers.rows, buffers.dense):  # or has been made, where the run ends at an event
            kept[:1] = kept[last : last + 1]
        self.count[ROW], self.count[EVENT] = min(rows, 1), 0

    def trajectory(self, status: Status, message: str) -> Trajectory:
        """Everything computed so far."""
        rows, count, n_c = int(self.count[ROW]), self.count, self.scene.n_c
        nothing = rows == 0 or self.now > self.recorder.buffers.rows[rows - 1, TIME]
        if len(self.kept.times) == 0 and nothing:
            self.keep_now()
        self.recorder.empty(int(count[ROW]), int(count[EVENT]))
        s = self.recorder.states()
        return Trajectory(
            scene=self.scene, method=self.method, t=s.t, q=s.q, v=s.v,
            impulse=np.ascontiguousarray(s.impulse[:, :n_c]),
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=message,
            counts=Counts(
                steps=int(count[STEP]), force_evaluations=int(count[FORCES]), events=int(count[EVENTS])
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
        if code == FINISHED:
            return "reached the end of the span"
        if code == TOO_MANY_EVENTS:
            return f"more than max_events = {self.method.max_events} events {self.where}"
        if code == STEP_TOO_SMALL:
            tolerances = f"rtol = {self.method.rtol:g}, atol = {self.method.atol:g}"
            words = f"the tolerances {tolerances} cannot be met {self.where}"
            names = " and ".join(unrepeatable(self.scene, self.now, q.copy(), v.copy()))
            return f"{words}: {names} must be functions of time and state, and are not" if names else words
        times = np.linspace(self.now, self.interval_end, TRIALS)
        return f"{culprit(self.scene, times, q.copy(), v.copy())} {self.where}"


def one_contact_recorder(scene: Scene, kept: Kept, dense: bool) -> Recorder:
    """The recorder of a run with one contact or none."""
    return Recorder(scene.n_q, scene.n_c, kept, PORTION + len(kept.times) + 2 * SLACK, dense=dense)


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


@dataclass(eq=False)
class BetweenByModel(Between):
    """The same for motions that are evaluated by the scene's equations."""

    scene: Scene
    made: (
        tuple[Model, bool] | None
    )  # the scene's model, and whether it is compiled: good in this process only

    @property
    def model(self) -> tuple[Model, bool]:
        """The scene's model, made when it is needed."""
        if self.made is None:
            self.made = model(self.scene)
        return self.made

    def __getstate__(self) -> dict[str, Any]:
        """What is good in any process."""
        return vars(self) | {"made": None}


def without_impulses(s: States) -> States:
    """The states alone: their impulses are the trajectory's."""
    return s._replace(impulse=np.zeros((0, 0)))


def scan_interval(scene: Scene, m: Model, rate: float) -> float:
    """Longest interval on which the gap acceleration may be taken to change its sign only once.

    rate : fastest rate of the free motion [rad/s], 0 where it is not known
    """
    scan = min((scene.t_span[1] - scene.t_span[0]) / PER_SPAN, scene.period / PER_FORCING)
    if rate > 0.0:
        scan = min(scan, 2.0 * math.pi / PER_PERIOD / rate)
    turn = fastest_turn(scene, m)
    # A period that is given says how finely to look, unless what moves is much faster.
    if turn < (2.0 * scan if math.isfinite(scene.period) else math.inf):
        scan = min(scan, turn / PER_FORCING)
    return scan


def fastest_turn(scene: Scene, m: Model) -> float:
    """Time of the fastest turn of what moves by itself, obstacle or frame [s]; infinite where nothing does.

    2 pi max |s'| / max |s''| of samples, which need not be dense for that; what has no period may speed up, and is
    looked at in windows of time.
    """
    windows = 1 if math.isfinite(scene.period) else WINDOWS
    fastest = 0.0
    for rates in _rates(scene, m, sample_times(scene), SLOPE * sampled_length(scene)):
        largest = np.abs(rates).reshape(windows, -1, rates.shape[1], 2).max(axis=1)
        speed, acceleration = largest[..., 0], largest[..., 1]
        turning = (speed > 0.0) & np.isfinite(acceleration / np.where(speed > 0.0, speed, 1.0))
        fastest = max(fastest, np.max(acceleration[turning] / speed[turning], initial=0.0))
    return 2.0 * math.pi / fastest if fastest > 0.0 else math.inf


def sampled_length(scene: Scene) -> float:
    """How much of the motion of what moves by itself is looked at: a period, or the whole span [s]."""
    return min(scene.period, scene.t_span[1] - scene.t_span[0])


def sample_times(scene: Scene) -> Array:
    """Times at which it is looked at, (SAMPLES,); irregular, so that no oscillation hides between them."""
    k = np.arange(SAMPLES)
    return np.asarray(scene.t_span[0] + sampled_length(scene) * (k + k * GOLDEN % 1.0) / SAMPLES)


def _rates(scene: Scene, m: Model, times: Array, step: float) -> Iterator[Array]:
    """Speeds and accelerations of each frame and obstacle that moves by itself, at these times, (times, n, 2)."""
    state = np.array(scene.q0), np.array(scene.v0), m.p
    for f, n in ((m.motion, scene.n_c), (m.frame, scene.n_q)):
        if f != ABSENT:
            rates = np.zeros((len(times), n, 3))
            sampled(f, times, *state, rates)
            yield rates[:, :, 1:]
    if m.gap_t != ABSENT:
        now, then = np.zeros((2, len(times), scene.n_c))
        for out, t in ((now, times), (then, times + step)):
            sampled(m.gap_t, t, *state, out)
        yield np.stack([now, (then - now) / step], axis=2)


def sampled(f: Any, times: Array, q: Array, v: Array, p: Array, out: Array) -> None:
    """A callback at many times of one state. The motion may never come there: what it raises does not count."""
    out.fill(math.nan)
    if callable(f):
        with suppress(Exception):
            sample(f, times, q, v, p, out)
    else:
        compiled(sample)(f, times, q, v, p, out)
    forget()


def sample(f: Any, times: Array, q: Array, v: Array, p: Array, out: Array) -> None:
    """Kernel: a callback at many times of one state."""
    for k in range(len(times)):
        call(f, times[k], q, v, p, out[k])
