"""A run of the event-driven method with several contacts or joints: from a scene to a trajectory.

The loop over events is a kernel (`several.run`); this file prepares its arrays, empties its buffers, and says in
words how a run ended.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled, jit_disabled, solver_address
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.events import dop853
from lcpstep.events import equations as eq
from lcpstep.events import run as common
from lcpstep.events import several as loop
from lcpstep.events.flow import SCALE, T0
from lcpstep.lcp.kernel import solve_small, workspace
from lcpstep.model import ABSENT, Model, culprit, joint_model, model
from lcpstep.recording import TIME, Kept, Recorder
from lcpstep.trajectory import Counts, Status, Trajectory

Array = NDArray[np.float64]
PORTION = 4096  # steps between two looks at the outside world
MOST_ROWS = 2**22  # numbers in a buffer of kept states
TRIALS = 17  # of the callbacks within an interval that failed
QUADRATURE = 8  # nodes per step of the impulses of contact forces and joints


def plan(scene: Scene, m: Model, joints: Model, rtol: float, atol: float, max_events: int) -> loop.Plan:
    """How the smooth motion of the scene is computed."""
    still = all(x == ABSENT for x in (m.force, m.frame, m.motion, joints.motion))
    forced = np.any(m.C) or np.any(m.K) or (m.omega != 0.0 and (np.any(m.cosine) or np.any(m.sine)))
    constant = bool(m.linear and m.flat and joints.flat and still and not forced)
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE)
    return loop.Plan(
        constant=constant,
        scan=common.scan_interval(scene, m, 0.0),
        nodes=0.5 * (1.0 + nodes),
        weights=0.5 * weights,
        rtol=rtol,
        atol=atol,
        corners=np.zeros(0) if constant else np.array(scene.corners),
        period=scene.period,
        t_end=scene.t_span[1],
        max_events=max_events,
    )


def start(scene: Scene) -> eq.Several:
    """The state at the start of the span, and work space."""
    n_q, n_c, n_j = scene.n_q, scene.n_c, scene.n_j
    n_r = n_c + n_j
    state = np.zeros((eq.N_STATE, n_q))
    state[[eq.Q0, eq.Q]], state[[eq.V0, eq.V]] = scene.q0, scene.v0
    contact = np.zeros((eq.N_CONTACT, n_c))
    contact[[eq.STRUCK, eq.HELD, eq.CHATTERS]] = -math.inf
    x = np.zeros(loop.N_NUMBERS)
    x[T0], x[loop.LAST_EVENT] = scene.t_span[0], -math.inf
    x[SCALE] = scene.period if math.isfinite(scene.period) else scene.t_span[1] - scene.t_span[0]
    rows = np.zeros((2, n_r, n_q))
    squares = np.zeros((2, n_r, n_r))
    return eq.Several(
        x=x, state=state, contact=contact, joint=np.zeros((eq.SHIFTED + 1, n_j)), y=np.zeros(2 * n_q),
        M=np.zeros((n_q, n_q)), G=np.zeros((n_c, n_q)), J=np.zeros((n_j, n_q)), R=rows[0], MR=rows[1],
        D=squares[0], L=squares[1], row=np.zeros(n_r, np.int64), held=np.zeros(n_r), change=np.zeros(n_r),
        mode=np.zeros((eq.N_MODE, n_c), np.int64), number=np.zeros(eq.N_NUMBER, np.int64),
        W=np.zeros(n_c * n_c), member=np.zeros(n_c, np.int64), kept=np.zeros(n_r, np.int64),
        doubt=np.zeros(n_r),
    )  # fmt: skip


def run(
    method: Any,
    scene: Scene,
    kept: Kept,
    progress: Callable[[float], None],
) -> Trajectory:
    """The motion of a scene with any number of contacts and joints; `method` has rtol, atol, max_events."""
    return _Run(method, scene, kept).finish(progress)


class _Run:
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: Any, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        self.model, fast = model(scene)
        self.joints, fast_joints = joint_model(scene)
        self.fast = fast and fast_joints and not jit_disabled()
        self.plan = plan(scene, self.model, self.joints, method.rtol, method.atol, method.max_events)
        self.state = start(scene)
        self.state.x[loop.NEXT_STEP] = 0.1 * self.plan.scan
        n_q, lcp = scene.n_q, workspace(max(scene.n_c, 1))
        self.tools = loop.Tools(
            tab=dop853.tableau(), w=dop853.work(2 * n_q), dy=np.zeros(2 * n_q),
            seen=np.zeros((5, max(scene.n_c, 2))), lcp=lcp,
            solver=solver_address(solve_small, lcp) if self.fast else solve_small,
        )  # fmt: skip
        width = (1, n_q) if self.plan.constant else (7, 2 * n_q)
        portion = max(16, min(PORTION, MOST_ROWS // (width[0] * width[1])))
        self.recorder = Recorder(
            n_q, scene.n_c + scene.n_j, kept, portion + len(kept.times) + 8, dense=kept.all, dense_shape=width
        )
        self.count = np.zeros(common.N_COUNTERS, dtype=np.int64)

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        never = NEVER_CONSTANT if self.plan.constant else NEVER_RUNGE_KUTTA
        kernel = compiled(loop.run, never) if self.fast else loop.run
        x, count = self.state.x, self.count
        try:
            code = common.FINISHED
            while code in (common.FINISHED, common.BUFFER_FULL) and x[T0] < self.plan.t_end:
                try:
                    code = kernel(
                        self.model, self.joints, self.plan, self.state, self.tools, self.recorder.buffers,
                        count, int(count[common.STEP]) + PORTION,
                    )  # fmt: skip
                except Exception as error:  # a callback in plain Python; compiled code raises nothing
                    message = f"a callback failed after t = {float(x[T0]):.9g} s: {error}"
                    raise SimulationError(message, self.trajectory(Status.NOT_FINITE, message)) from error
                self.empty()
                progress(float(x[T0]))
        except KeyboardInterrupt:
            raise SimulationInterrupted(
                self.trajectory(Status.INTERRUPTED, f"interrupted {self.where}")
            ) from None
        result = self.trajectory(STATUS[code], self.message(code))
        if result.status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    def empty(self) -> None:
        """Move the buffers' contents to the recorder, but for the last row, whose step is still to come."""
        rows = int(self.count[common.ROW])
        self.recorder.empty(max(rows - 1, 0), int(self.count[common.EVENT]))
        if rows > 0:
            self.recorder.buffers.rows[0] = self.recorder.buffers.rows[rows - 1]
        self.count[common.ROW], self.count[common.EVENT] = min(rows, 1), 0

    def trajectory(self, status: Status, message: str) -> Trajectory:
        """Everything computed so far."""
        x, buffers, count = self.state.x, self.recorder.buffers, self.count
        rows = int(count[common.ROW])
        if len(self.kept.times) == 0 and (rows == 0 or x[T0] > buffers.rows[rows - 1, TIME]):
            self.state.state[eq.Q], self.state.state[eq.V] = self.state.state[[eq.Q0, eq.V0]]
            loop.keep(self.state, buffers, count, float(x[T0]))
        self.recorder.empty(int(count[common.ROW]), int(count[common.EVENT]))
        s, n_c = self.recorder.states(), self.scene.n_c
        return Trajectory(
            scene=self.scene, method=self.method, t=s.t, q=s.q, v=s.v,
            impulse=np.ascontiguousarray(s.impulse[:, :n_c]), impacts=self.recorder.events(), status=status,
            message=message,
            counts=Counts(
                steps=int(count[common.STEP]), force_evaluations=int(count[common.FORCES]),
                events=int(count[common.EVENTS]),
            ),
            dense=_dense(s.t, s.q, s.v, s.length, self.recorder.dense(), self.kept.all, self.plan.constant),
            joint_impulse=np.ascontiguousarray(s.impulse[:, n_c:]),
        )  # fmt: skip

    @property
    def where(self) -> str:
        """Time and state reached, in words."""
        s = self.state
        q, v = (s.state[row].tolist() for row in (eq.Q0, eq.V0))
        return f"at t = {float(s.x[T0]):.9g} s, q = {q}, v = {v}"

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        s = self.state
        closed = np.flatnonzero(s.mode[eq.CLOSED]).tolist()
        members = sorted(s.member[: s.number[eq.MEMBERS]].tolist())
        if code == common.FINISHED:
            return "reached the end of the span"
        if code == common.TOO_MANY_EVENTS:
            latest = np.flatnonzero(s.contact[eq.STRUCK] >= np.max(s.contact[eq.STRUCK], initial=-math.inf))
            bound = f"more than max_events = {self.method.max_events} events"
            if self.count[common.EVENTS] <= self.method.max_events:
                bound = "events without end at one time"
            return f"{bound}; the last at contacts {latest.tolist()}, closed are {closed}, {self.where}"
        if code == common.STEP_TOO_SMALL:
            tolerances = f"rtol = {self.method.rtol:g}, atol = {self.method.atol:g}"
            return f"the tolerances {tolerances} cannot be met; closed contacts {closed}, {self.where}"
        if code == loop.NO_IMPULSES:
            return f"no impulses of the contacts {members} end their approach {self.where}"
        if code == loop.NO_FORCES:
            return f"no forces of the closed contacts {members} keep them from passing {self.where}"
        if code == loop.JOINTS_DISAGREE:
            return f"joint {int(s.number[eq.CULPRIT])} contradicts the joints before it {self.where}"
        now = float(s.x[T0])
        times = np.linspace(now, min(self.plan.t_end, now + self.plan.scan), TRIALS)
        reason = culprit(self.scene, times, s.state[eq.Q0].copy(), s.state[eq.V0].copy())
        return f"{reason} {self.where}; closed contacts {closed}"


def _dense(
    t: Array, q: Array, v: Array, length: Array, F: Array, every_step: bool, constant: bool
) -> Callable[[Array], tuple[Array, Array]]:
    """States at any time, from the kept ones and the motion from each to the next."""

    def at(times: Array) -> tuple[Array, Array]:
        if not every_step and not np.all(np.isin(times, t)):
            raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
        row = np.maximum(np.searchsorted(t, times, side="right") - 1, 0)
        tau = (times - t[row])[:, None]
        if not every_step or np.all(tau == 0.0):
            return q[row], v[row]
        if constant:
            a = F[row, 0]
            a[times >= t[-1]] = 0.0  # no motion has been kept beyond the last state
            return q[row] + tau * (v[row] + 0.5 * tau * a), v[row] + tau * a
        share = tau / np.where(length[row] > 0.0, length[row], 1.0)[:, None]
        moved = np.zeros((len(times), F.shape[2]))
        for k in range(F.shape[1]):
            moved = (moved + F[row, F.shape[1] - 1 - k]) * (share if k % 2 == 0 else 1.0 - share)
        moved[tau[:, 0] == 0.0] = 0.0
        n = q.shape[1]
        return q[row] + moved[:, :n], v[row] + moved[:, n:]

    return at


# Kernels that one kind of smooth motion leaves aside
NEVER_CONSTANT = (
    loop.step,
    loop.complete,
    loop.later,
    loop.obey,
    loop.lift,
    loop.measure_again,
    loop.interpolate,
)
NEVER_RUNGE_KUTTA = (loop.fly, loop.polish, loop.synchronise)
STATUS = {
    common.FINISHED: Status.DONE,
    common.NOT_FINITE: Status.NOT_FINITE,
    common.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    common.STEP_TOO_SMALL: Status.STEP_TOO_SMALL,
    loop.NO_IMPULSES: Status.LCP_FAILED,
    loop.NO_FORCES: Status.LCP_FAILED,
    loop.JOINTS_DISAGREE: Status.JOINTS_FAILED,
}
