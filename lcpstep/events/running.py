"""What event-driven runs share: how far they have come, what is still to be kept, and states between kept ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.answer import require_kept
from lcpstep.events.codes import NO_FORCES, NO_IMPULSES, STATUS
from lcpstep.gaps import no_way_out
from lcpstep.kernels.between import accelerated, by_dense_output, last_rows
from lcpstep.kernels.tally import Tally
from lcpstep.recording import Kept, Recorder, States
from lcpstep.running import Run
from lcpstep.trajectory import Counts, Status

Array = NDArray[np.float64]
PORTION = 4096  # steps between two looks at the outside world, at most
TRIALS = 17  # of the callbacks within an interval that failed
FIRST_STEP = 0.1  # of the scan interval


class EventRun(Run):
    """One run from event to event."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, recorder: Recorder) -> None:
        super().__init__(method, scene, kept, recorder, PORTION)
        self.tally, self.closed = Tally(method.max_events), False  # closed: the last state has been kept

    @property
    def evaluations(self) -> int:
        """How often forces were evaluated; never where their motion is known."""
        return 0

    @property
    def done(self) -> int:
        """Steps, and parts of steps, taken."""
        return int(self.tally.steps + self.tally.parts)

    @property
    def ahead(self) -> Array:
        """Times at which a callback may be what has failed [s]."""
        return np.linspace(self.last[0], self.horizon, TRIALS)

    @property
    def counts(self) -> Counts:
        """Work done."""
        return Counts(self.tally.steps, force_evaluations=self.evaluations, events=self.tally.events)

    def states(self) -> States:
        """All states kept, and the last one where states are kept by steps or events, or asked for there."""
        s = super().states()
        if not self.closed and self.owes(s.t):
            self.course.keep_now()
            s = super().states()
        self.closed = True
        return s

    def owes(self, t: Array) -> bool:
        """Whether the state reached is still to be kept; of given times only where an event fell on the last one."""
        if self.kept.given:
            return len(t) < len(self.kept.times) and bool(self.kept.times[len(t)] <= self.now)
        return not (len(t) > 0 and self.now <= t[-1])

    def status(self, code: int) -> Status:
        """How the run ended, by what the kernel returned."""
        return STATUS.get(code) or Status(code)

    @property
    def bound(self) -> str:
        """Of events, that the run has gone beyond, in words."""
        if self.tally.events <= self.method.max_events:
            return "events without end at one time"
        return f"more than max_events = {self.method.max_events} events"

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        return f"{self.bound} {self.where}" if code == Status.TOO_MANY_EVENTS else super().why(code)


class Integrated(EventRun):
    """One run whose motion between events is a chain of steps, or of constant accelerations.

    clock           times of the motion
    scan            longest interval between two looks for events
    constant        accelerations are constant between events, and gaps linear in q
    system          what moves, which has the state reached; made before what is shared is
    """

    system: Any

    def __init__(
        self, method: Any, scene: Scene, kept: Kept, clock: Any, scan: float, constant: bool
    ) -> None:
        shape = (1, scene.n_q) if constant else (7, 2 * scene.n_q)  # an acceleration, or dense output
        dense = shape if kept.all and self.is_dense(method, scene) else None
        super().__init__(method, scene, kept, Recorder(scene.n_q, self.system.n_r, kept, dense))
        self.clock, self.scan, self.constant = clock, scan, constant
        clock.record, clock.tally = self.recorder.record, self.tally

    def is_dense(self, method: Any, scene: Scene) -> bool:
        """Whether the motion after each kept state is kept along with it."""
        return True

    @property
    def closed_ones(self) -> list[int]:
        """The contacts that are closed."""
        return list(self.clock.closed_ones())

    @property
    def latest(self) -> list[int]:
        """The contacts of the last events at one time."""
        log = self.recorder.log(self.scene.t_span[1])
        return sorted({int(c) for c in log.contact[log.time == log.time.max(initial=-np.inf)]})

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.clock.t0)

    @property
    def horizon(self) -> float:
        """End of the interval at hand [s]."""
        return min(self.scene.t_span[1], self.now + self.scan)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        q, v = np.split(self.system.state, 2)
        return q, v

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the motion from each to the next."""
        return Moved(without_impulses(s), self.kept.all, self.constant, self.recorder.dense())

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == NO_IMPULSES:
            closed = self.closed_ones
            words = f"no impulses of the contacts {closed} end their approach"
            return f"{no_way_out(self.scene, self.now, self.state[0], closed) or words} {self.where}"
        if code == NO_FORCES:
            return f"no forces of the closed contacts {self.closed_ones} keep them from passing {self.where}"
        if code == Status.TOO_MANY_EVENTS:
            return f"{self.bound}; the last at contacts {self.latest}, closed are {self.closed_ones}, {self.where}"
        if code == Status.JOINTS_FAILED:
            return f"joint {self.clock.culprit} contradicts the joints before it {self.where}"
        return f"{super().why(code)}; closed contacts {self.closed_ones}"


@dataclass(eq=False)
class Between(ABC):
    """States at any time, from the kept state before each; a function of times (m,) that can be pickled."""

    s: States
    complete: bool  # whether no state was left out; else only the kept ones are known

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times, each (m, n_q); ValueError where the state before one was not kept."""
        if not self.complete:
            require_kept(times, self.s.t)
        times = np.ascontiguousarray(times)
        return self.evaluate(times, last_rows(self.s.t, times, 0, len(self.s.t) - 1))

    @abstractmethod
    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""


def without_impulses(s: States) -> States:
    """The states alone: their impulses are the trajectory's."""
    return s._replace(impulse=np.zeros((0, 0)))


@dataclass(eq=False)
class Moved(Between):
    """States between kept ones, under constant accelerations or by the dense output of the steps."""

    constant: bool
    F: Array  # after each kept state

    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""
        if not self.complete:  # there is nothing beside the states
            return self.s.q[row], self.s.v[row]
        kept = self.s.t, self.s.q, self.s.v
        if self.constant:
            return accelerated(*kept, self.F, times, row)
        return by_dense_output(*kept, self.s.length, self.F, times, row)
