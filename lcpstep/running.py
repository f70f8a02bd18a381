"""A run of any method: fed to its kernels in portions, its buffers emptied between them, and how it ended in words.

A method gives a class that inherits `Run`, with `advance` (its kernel), `done`, `now`, `state`, `ahead` and `horizon`
(how far it has come, where it is, and goes next), `dense` (states between the kept ones), `why` (what its own
statuses mean) and `counts`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import checks
from lcpstep.callbacks.culprits import culprit
from lcpstep.callbacks.faults import cause
from lcpstep.doubts.depth import mass
from lcpstep.doubts.hindrance import hindrance
from lcpstep.doubts.kinks import valley
from lcpstep.doubts.standstill import Standstill
from lcpstep.doubts.sticking import held
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.kernels.looks import all_finite
from lcpstep.kernels.status import BUFFER_FULL
from lcpstep.model import unrepeatable
from lcpstep.pace import Pace, tell
from lcpstep.recording import Kept, Recorder, States
from lcpstep.trajectory import Counts, Status, Trajectory

Array = NDArray[np.float64]


class Portions(ABC):
    """Whatever is fed to a kernel in portions, until it is over.

    course : that kernel, see `kernels.course`; of steps, which override `advance`, it is `loop` of `StepRun`
    """

    course: Any

    def __init__(self, method: Any, scene: Any, kept: Kept, pace: Pace) -> None:
        self.method, self.scene, self.kept, self.pace = method, scene, kept, pace

    def advance(self, goal: int) -> int:
        """Call the kernel, for `done` to become `goal` at most; why it returned: a `Status`, or a code of its own."""
        return int(self.course.advance(goal))

    @property
    @abstractmethod
    def done(self) -> int:
        """Steps taken, or attempted."""

    @property
    @abstractmethod
    def now(self) -> float:
        """Time reached [s]."""

    @abstractmethod
    def empty(self) -> None:
        """Take over what the kernel has written."""

    @abstractmethod
    def trajectory(self, code: int) -> Any:
        """Everything computed so far; `code`: why the kernel returned, or INTERRUPTED."""

    def begin(self) -> int:
        """The initial state; a code as of `advance`."""
        return Status.DONE

    def stands_still(self) -> bool:
        """Whether it goes on without end."""
        return False

    @property
    def over(self) -> bool:
        """Whether the end of the span is reached."""
        return bool(self.now >= self.scene.t_span[1])

    def finish(self, progress: Callable[[float], None]) -> Any:
        """Run to the end of the span, or to where it cannot go on."""
        begin, end = self.scene.t_span
        try:
            code = self.begin()
            while code == BUFFER_FULL or (code == Status.DONE and not self.over):
                code = self.advance(self.pace.goal(self.done))
                cause()  # an interrupt that a callback heard goes on its way
                self.empty()
                progress(self.now)
                tell(self.now - begin, end - begin)
                if code in (BUFFER_FULL, Status.DONE) and not self.over and self.stands_still():
                    code = Status.STEP_TOO_SMALL
            raised, result = cause(), self.trajectory(code)
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED)) from None
        if result.status == Status.NOT_FINITE:
            raise SimulationError(result.message, result) from raised
        return result


class Run(Portions):
    """One run of a scene in coordinates.

    Parameters
    ----------
    method, scene, kept : the question
    recorder : its buffers;  most : steps between two looks at the outside world

    finite   time and state kept last before one that is not finite, where a step that failed has left such behind
    asked    whether its functions have been asked for the same twice
    stuck    why the run does not go on though its steps do, in words
    """

    def __init__(self, method: Any, scene: Any, kept: Kept, recorder: Recorder, most: int) -> None:
        super().__init__(method, scene, kept, Pace(most, scene.n_q + recorder.record.n_c))
        self.recorder, self.asked, self.stuck = recorder, False, ""
        self.finite: tuple[float, Array, Array] | None = None
        self.standstill = Standstill(scene.t_span, getattr(method, "h", inf))

    @property
    @abstractmethod
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""

    @property
    @abstractmethod
    def ahead(self) -> Iterable[float]:
        """Times at which a callback may be what has failed [s]."""

    @property
    @abstractmethod
    def horizon(self) -> float:
        """How far ahead the run looks [s]."""

    @property
    @abstractmethod
    def counts(self) -> Counts:
        """Work done."""

    @abstractmethod
    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones."""

    @property
    def tolerances(self) -> str:
        """What the method was given to choose its steps by, in words."""
        m = self.method
        if hasattr(m, "rtol"):
            return f"the tolerances rtol = {m.rtol:g}, atol = {m.atol:g}"
        tolerance = getattr(m, "tolerance", None)
        return f"steps of {m.h:g} s" if tolerance is None else f"the tolerance {tolerance:g}"

    def stands_still(self) -> bool:
        """Whether steps and events go on that take the time on by next to nothing, or without sense."""
        look = self.standstill
        taken = self.done + self.recorder.taken
        stands = look.reached(taken, self.now, self.recorder.count_impacts, self.kinetic_energy)
        if look.crawls and not stands:
            q, v = (x.copy() for x in self.state)
            stands = not self.asked and bool(unrepeatable(self.scene, self.now, q, v))
            stands, self.asked = stands or bool(valley(self.scene, self.now, q, v)), True
        self.stuck = look.words if stands else ""
        return stands

    def kinetic_energy(self) -> float:
        """That of the last known state."""
        q, v = (x.copy() for x in self.state)
        return 0.5 * float(v @ (mass(self.scene, self.now, q, v) @ v))

    def empty(self) -> None:
        """Move what the kernels have written to the recorder's keeping."""
        self.recorder.take()

    def states(self) -> States:
        """All states kept, and the last one where states are kept by steps or events."""
        self.empty()
        return self.known(self.recorder.states())

    def known(self, s: States) -> States:
        """The states kept before the first that is not finite, or whose impulses are not."""
        if all(map(all_finite, (s.q, s.v, s.impulse, *self.state))):
            return s
        fine = np.asarray(np.isfinite(np.hstack([s.q, s.v, s.impulse])).all(axis=1))
        s = States(*(x[: len(fine) if fine.all() else int(np.argmin(fine))] for x in s))
        if len(s.t):
            self.finite = float(s.t[-1]), s.q[-1], s.v[-1]
        return s

    @property
    def last(self) -> tuple[float, Array, Array]:
        """The last finite time and state that are known."""
        return self.finite or (self.now, *self.state)

    def status(self, code: int) -> Status:
        """How the run ended, by what the kernel returned."""
        return Status(code)

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == Status.TOO_MANY_EVENTS:
            return f"more than max_events = {self.method.max_events} events {self.where}"
        if code == Status.STEP_TOO_SMALL:
            words = (
                f"with {self.tolerances} {self.stuck}"
                if self.stuck
                else f"{self.tolerances} cannot be met by any step"
            )
            return f"{words} {self.where}"
        _, q, v = self.last
        return f"{culprit(self.scene, self.ahead, q.copy(), v.copy())} {self.where}"

    def shares(self, s: States) -> tuple[Array, Array, Array]:
        """Impulses of contacts, of their friction and of joints, each in a piece of its own."""
        n_c, first = self.scene.n_c, self.recorder.record.n_c - self.scene.n_j
        x, one = s.impulse, np.ascontiguousarray
        return one(x[:, :n_c]), one(x[:, n_c:first]), one(x[:, first:])

    def trajectory(self, code: int) -> Any:
        """Everything computed so far."""
        s = self.states()
        if self.finite is not None and code == Status.DONE:
            code = Status.NOT_FINITE  # what the last step leaves is asked for by none after it
        impulse, friction, joint = self.shares(s)
        return Trajectory(
            scene=self.scene, method=self.method, t=s.t, q=s.q, v=s.v, impulse=impulse,
            impacts=self.recorder.log(self.scene.t_span[1]), status=self.status(code), message=self.message(code),
            counts=self.counts, dense=self.dense(s), joint_impulse=joint,
            friction_impulse=friction,
        )  # fmt: skip

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        if code == Status.DONE:
            return "reached the end of the span"
        if code == Status.INTERRUPTED:
            return f"interrupted {self.where}"
        text = self.why(code)
        if code not in (Status.STEP_TOO_SMALL, Status.TOO_MANY_EVENTS, Status.NEWTON_FAILED):
            return text
        q, v = self.state
        found = hindrance(self.scene, self.now, self.horizon, q.copy(), v.copy())
        if (
            not found and code == Status.NEWTON_FAILED
        ):  # within a step, whose velocities are not those of its start
            found = held(self.scene, self.now, q.copy(), v.copy(), self.horizon - self.now)
        if not found and code == Status.STEP_TOO_SMALL and not self.stuck:
            found = "a larger tolerance may do"
        return f"{text}: {found}" if found else text

    @property
    def where(self) -> str:
        """Time and state reached, in words."""
        t, q, v = self.last
        return f"at t = {t:.9g} s, q = {checks.shown(q)}, v = {checks.shown(v)}"
