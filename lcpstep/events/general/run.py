"""Runs of systems with contacts and joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.events import running
from lcpstep.events.general.ends import NO_FORCES, NO_IMPULSES, NO_SURFACE
from lcpstep.events.general.loop import Course
from lcpstep.events.general.smooth import Smooth, Watched
from lcpstep.events.general.state import Mechanism
from lcpstep.events.scan import scan_interval
from lcpstep.gaps import no_way_out
from lcpstep.gauss import gauss
from lcpstep.kernels.between import accelerated, by_dense_output
from lcpstep.kernels.model import Model
from lcpstep.model import joint_model, model
from lcpstep.recording import Kept, Recorder, States
from lcpstep.trajectory import Status
from lcpstep.turns import turns

Array = NDArray[np.float64]
MOST_ROWS = 2**22  # numbers in a buffer of kept states
QUADRATURE = 8  # nodes per step of the impulses of contact forces and joints
FIRST_STEP = 0.1  # of the scan interval


def is_constant(m: Model, joints: Model) -> bool:
    """Whether the acceleration is constant between events, and gaps are linear in q."""
    still = not any(f.given for f in (m.force, m.frame, m.motion, joints.motion))
    turns = m.omega != 0.0 and (np.any(m.arrays["cosine"]) or np.any(m.arrays["sine"]))
    forced = np.any(m.arrays["C"]) or np.any(m.arrays["K"]) or turns
    return bool(m.linear and m.flat and joints.flat and still and not forced)


def start(scene: Scene, method: Any) -> Mechanism:
    """The state at the start of the span; `method` has rtol and atol."""
    return mechanism(scene, model(scene), Smooth(2 * scene.n_q, scene.n_q, method.rtol, method.atol))


def mechanism(scene: Scene, m: Model, smooth: Smooth | Watched) -> Mechanism:
    """The same by the motion that goes from event to event."""
    joints = joint_model(scene) if scene.n_j > 0 else m
    constant, scan = is_constant(m, joints), scan_interval(scene, m, 0.0)
    smooth.state[: scene.n_q], smooth.state[scene.n_q :] = scene.q0, scene.v0
    smooth.next_step = FIRST_STEP * scan
    corners = () if constant else turns(scene).stops
    smooth.mechanism = Mechanism(
        m, joints, scene.n_j, constant, smooth, scan, scene.t_span, corners, scene.period, *gauss(QUADRATURE)
    )
    return smooth.mechanism


def recorder_for(scene: Scene, kept: Kept, columns: int, constant: bool) -> Recorder:
    """What is kept, with so many impulses, and the motion after each state: its acceleration, or dense output."""
    width = (1, scene.n_q) if constant else (7, 2 * scene.n_q)
    rows = max(16, min(running.PORTION, MOST_ROWS // (width[0] * width[1]))) + len(kept.times) + 8
    return Recorder(scene.n_q, columns, kept, rows, dense=kept.all, dense_shape=width)


class General(running.EventRun):
    """A run with any number of contacts and joints; `system`: its state at the start, if made elsewhere."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, system: Mechanism | None = None) -> None:
        self.system = system or start(scene, method)
        recorder = recorder_for(scene, kept, scene.n_c + scene.n_j, self.system.constant)
        super().__init__(method, scene, kept, recorder)
        self.course = Course(self.system, recorder.record, self.tally)

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.system.t0)

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        return min(self.system.t_end, self.now + self.system.scan)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        q, v = np.split(self.system.smooth.state, 2)
        return q, v

    @property
    def evaluations(self) -> int:
        """How often forces were evaluated."""
        return int(self.system.smooth.evaluations)

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the motion from each to the next."""
        F = self.recorder.dense()
        return Moved(running.without_impulses(s), self.kept.all, self.system.constant, F)

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        s, where = self.system, self.where
        closed, members = s.contact.closed_ones(), s.contact.members(s.n_members)
        if code == NO_IMPULSES:
            words = f"no impulses of the contacts {members} end their approach"
            return f"{no_way_out(self.scene, self.now, self.state[0], members) or words} {where}"
        if code == NO_FORCES:
            return f"no forces of the closed contacts {members} keep them from passing {where}"
        if code == NO_SURFACE:
            return f"the obstacle of contact {s.event_contact} closes in, and leaves no room {where}"
        if code == Status.JOINTS_FAILED:
            return f"joint {s.culprit} contradicts the joints before it {where}"
        if code == Status.TOO_MANY_EVENTS:
            bound = f"more than max_events = {self.method.max_events} events"
            if self.tally.events <= self.method.max_events:
                bound = "events without end at one time"
            return f"{bound}; the last at contacts {s.contact.latest()}, closed are {closed}, {where}"
        return f"{super().why(code)}; closed contacts {closed}"


@dataclass(eq=False)
class Moved(running.Between):
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
