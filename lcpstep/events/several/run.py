"""Runs of systems with several contacts or joints."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled, jit_disabled
from lcpstep.events import dop853, run
from lcpstep.events.bookkeeping import EVENTS, FINISHED, TOO_MANY_EVENTS
from lcpstep.events.clock import T0, clock
from lcpstep.events.plan import plan
from lcpstep.events.several import state as at
from lcpstep.events.several.chatter import later
from lcpstep.events.several.equations import measure_again
from lcpstep.events.several.keep import keep
from lcpstep.events.several.loop import run as loop
from lcpstep.events.several.modes import obey
from lcpstep.events.several.motion import lift
from lcpstep.events.several.parabolas import fly, polish, synchronise
from lcpstep.events.several.step import complete, step
from lcpstep.gaps import no_way_out
from lcpstep.lcp.kernel import room, solver
from lcpstep.model import ABSENT, Model, models
from lcpstep.recording import Kept, Recorder, States
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
MOST_ROWS = 2**22  # numbers in a buffer of kept states
QUADRATURE = 8  # nodes per step of the impulses of contact forces and joints
# Kernels that one kind of smooth motion leaves aside
NEVER_CONSTANT = (step, complete, later, obey, lift, measure_again, dop853.interpolate)
NEVER_RUNGE_KUTTA = (fly, polish, synchronise)


STATUS = {
    **run.STATUS,
    at.NO_IMPULSES: Status.LCP_FAILED,
    at.NO_FORCES: Status.LCP_FAILED,
    at.JOINTS_DISAGREE: Status.JOINTS_FAILED,
}


def is_constant(m: Model, joints: Model) -> bool:
    """Whether the acceleration is constant between events, and gaps are linear in q."""
    still = all(x == ABSENT for x in (m.force, m.frame, m.motion, joints.motion))
    forced = np.any(m.C) or np.any(m.K) or (m.omega != 0.0 and (np.any(m.cosine) or np.any(m.sine)))
    return bool(m.linear and m.flat and joints.flat and still and not forced)


def start(scene: Scene, m: Model, joints: Model, method: Any, fast: bool) -> at.Several:
    """The state at the start of the span, and work space."""
    n_q, n_c, n_j = scene.n_q, scene.n_c, scene.n_j
    n_r, constant = n_c + n_j, is_constant(m, joints)
    p = plan(scene, m, method, QUADRATURE)
    x = clock(scene, at.N_NUMBERS)
    x[at.NEXT_STEP] = 0.1 * p.scan
    state = np.zeros((at.N_STATE, n_q))
    state[[at.Q0, at.Q]], state[[at.V0, at.V]] = scene.q0, scene.v0
    contact = np.zeros((at.N_CONTACT, n_c))
    contact[[at.STRUCK, at.HELD, at.CHATTERS]] = -math.inf
    rows, squares = np.zeros((2, n_r, n_q)), np.zeros((2, n_r, n_r))
    return at.Several(
        model=m, joints=joints, plan=p, constant=constant,
        corners=np.zeros(0) if constant else np.array(scene.corners), x=x, state=state, contact=contact,
        joint=np.zeros((at.N_JOINT, n_j)), mode=np.zeros((at.N_MODE, n_c), np.int64),
        number=np.zeros(at.N_NUMBER, np.int64), y=np.zeros(2 * n_q), M=np.zeros((n_q, n_q)),
        G=np.zeros((n_c, n_q)), J=np.zeros((n_j, n_q)), R=rows[0], MR=rows[1], D=squares[0], L=squares[1],
        row=np.zeros(n_r, np.int64), held=np.zeros(n_r), change=np.zeros(n_r), kept=np.zeros(n_r, np.int64),
        doubt=np.zeros(n_r), member=np.zeros(n_c, np.int64), W=np.zeros(n_c * n_c), lcp=room(n_c, fast),
        solver=solver(fast), w=dop853.work(2 * n_q),
        dy=np.zeros(2 * n_q), seen=np.zeros((5, max(n_c, 2))),
    )  # fmt: skip


class Several(run.Run):
    """A run with any number of contacts and joints."""

    status_of = STATUS

    def __init__(self, method: Any, scene: Scene, kept: Kept) -> None:
        (m, joints, _), fast = models(scene)
        fast = fast and not jit_disabled()
        self.system = start(scene, m, joints, method, fast)
        never = NEVER_CONSTANT if self.system.constant else NEVER_RUNGE_KUTTA
        self.run = compiled(loop, never) if fast else loop
        width = (1, scene.n_q) if self.system.constant else (7, 2 * scene.n_q)
        rows = max(16, min(run.PORTION, MOST_ROWS // (width[0] * width[1]))) + len(kept.times) + 8
        columns = scene.n_c + scene.n_j
        recorder = Recorder(scene.n_q, columns, kept, rows, dense=kept.all, dense_shape=width)
        super().__init__(method, scene, kept, recorder)

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.system.x[T0])

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        return min(self.system.plan.t_end, self.now + self.system.plan.scan)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.system.state[at.Q0], self.system.state[at.V0]

    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""
        return int(self.run(self.system, self.recorder.buffers, self.count, goal))

    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""
        self.system.state[at.Q], self.system.state[at.V] = self.state
        keep(self.system, self.recorder.buffers, self.count, self.now)

    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the motion from each to the next."""
        F = self.recorder.dense()
        return Moved(run.without_impulses(s), self.kept.all, self.system.constant, F)

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        s, where = self.system, self.where
        closed = np.flatnonzero(s.mode[at.CLOSED]).tolist()
        members = sorted(s.member[: s.number[at.MEMBERS]].tolist())
        if code == at.NO_IMPULSES:
            words = f"no impulses of the contacts {members} end their approach"
            return f"{no_way_out(self.scene, self.now, self.state[0], members) or words} {where}"
        if code == at.NO_FORCES:
            return f"no forces of the closed contacts {members} keep them from passing {where}"
        if code == at.JOINTS_DISAGREE:
            return f"joint {int(s.number[at.CULPRIT])} contradicts the joints before it {where}"
        if code == TOO_MANY_EVENTS:
            struck = s.contact[at.STRUCK]
            latest = np.flatnonzero(struck >= np.max(struck, initial=-math.inf)).tolist()
            bound = f"more than max_events = {self.method.max_events} events"
            if self.count[EVENTS] <= self.method.max_events:
                bound = "events without end at one time"
            return f"{bound}; the last at contacts {latest}, closed are {closed}, {where}"
        words = super().message(code)
        return words if code == FINISHED else f"{words}; closed contacts {closed}"


@dataclass(eq=False)
class Moved(run.Between):
    """States between kept ones, under constant accelerations or by the dense output of the steps."""

    constant: bool
    F: Array  # after each kept state

    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""
        if np.all(times == self.s.t[row]):
            return self.s.q[row], self.s.v[row]
        moved = moved_constant if self.constant else moved_by_step
        return moved(self.s, self.F, times, row)


def moved_constant(s: States, F: Array, times: Array, row: Any) -> tuple[Array, Array]:
    """States at times after the kept rows, under the acceleration kept with each."""
    tau, a = (times - s.t[row])[:, None], F[row, 0]
    a[times >= s.t[-1]] = 0.0  # no motion has been kept beyond the last state
    return s.q[row] + tau * (s.v[row] + 0.5 * tau * a), s.v[row] + tau * a


def moved_by_step(s: States, F: Array, times: Array, row: Any) -> tuple[Array, Array]:
    """The same by the dense output of the step after each row; see `dop853.interpolate`."""
    tau = (times - s.t[row])[:, None]
    share = tau / np.where(s.length[row] > 0.0, s.length[row], 1.0)[:, None]
    moved = np.zeros((len(times), F.shape[2]))
    for k in range(F.shape[1]):
        moved = (moved + F[row, F.shape[1] - 1 - k]) * (share if k % 2 == 0 else 1.0 - share)
    moved[tau[:, 0] == 0.0] = 0.0
    n = s.q.shape[1]
    return s.q[row] + moved[:, :n], s.v[row] + moved[:, n:]
