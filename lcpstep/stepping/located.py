"""Time-stepping with every impulse at its own time within the step: its parameters, and a run.

The loop over steps is a kernel (`located_loop.run`); this file prepares its arrays, feeds it in portions, and says in
words how a run ended.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.compiled import compiled, jit_disabled, solver_address
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.lcp.kernel import solve_small, workspace
from lcpstep.model import ABSENT, Model, culprit, model, require
from lcpstep.recording import Kept, Recorder
from lcpstep.stepping import located_loop as loop
from lcpstep.stepping import located_work as work
from lcpstep.stepping.theta import solve_single
from lcpstep.trajectory import Counts, Status, Trajectory

Array = NDArray[np.float64]
PORTION = 16384  # steps between two looks at the outside world
WHOLE = 1e-9  # a span this close to a whole number of steps is taken as one
SMALL = 8  # coordinates up to which matrices are made anew for the rest of a step
MARGIN = 2.0**-49  # relative; by which times are moved off a corner


@dataclass(frozen=True)
class Located:
    """Time-stepping that places every impact at its own time within the step.

    Parameters
    ----------
    h : step [s]; the last step is shortened where h does not divide the span
    max_events : bound on the impacts within one step; beyond it one plastic impact of all contacts ends the step

    Raises
    ------
    ValueError   h or the bound is not positive

    Notes
    -----
    Smooth motion is of order two, with one force evaluation a step; so is the whole motion, through impacts,
    chattering, sticking and release. Contacts that fire together obey Moreau's law for simultaneous impacts, all
    others are struck one after another. Linear systems take the trapezoidal rule and are stable for every h, others
    velocity Verlet, which needs h below 2 / (highest frequency). Sources: J. J. Moreau (1988), V. Acary and
    B. Brogliato (2008)
    for the impact law; N. Newmark (1959) and H. Andersen (1983) for the motion between impacts.
    """

    h: float = 1e-3
    max_events: int = 1_000_000

    def __post_init__(self) -> None:
        object.__setattr__(self, "h", checks.positive("h", self.h))
        object.__setattr__(self, "max_events", checks.count("max_events", self.max_events))

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of a scene; see `lcpstep.simulate`."""
        require(scene, "Located", joints=False, friction=False)
        return _Run(self, scene, kept).finish(progress)


def plan(scene: Scene, m: Model, h: float, max_events: int) -> work.Plan:
    """Constants of steps of size h."""
    n_q = scene.n_q
    stiff = bool(m.linear and (np.any(m.C) or np.any(m.K)))
    steady = bool(m.linear and not stiff and m.force == ABSENT and m.frame == ABSENT and m.omega == 0.0)
    A_inverse = np.zeros((2, n_q, n_q))
    if m.linear:
        A_inverse[:] = np.linalg.inv(m.M + 0.5 * h * m.C + 0.25 * h * h * m.K)
    size = max(np.max(np.abs(x), initial=0.0) for x in (scene.q0, m.offset, h * np.asarray(scene.v0)))
    t_scale = max(abs(scene.t_span[0]), abs(scene.t_span[1]))
    return work.Plan(
        h=h, stiff=stiff, steady=steady,
        plain=bool(m.linear and m.flat and m.motion == ABSENT), constant=bool(m.linear and m.flat),
        small=n_q <= SMALL, slack=work.ROUNDING * float(size or 1.0), max_events=max_events,
        corners=np.array(scene.corners), period=scene.period,
        margin=MARGIN * t_scale if len(np.asarray(scene.corners)) else 0.0,
        A_inverse=A_inverse, A=np.zeros((n_q, n_q)), unit=np.zeros(n_q), pivots=np.zeros(n_q, dtype=np.int64),
    )  # fmt: skip


def start(scene: Scene, m: Model, p: work.Plan, fast: bool) -> work.Work:
    """State at the start of the scene's span, with the work space of a step."""
    n_q, n_c = scene.n_q, scene.n_c
    vectors = ("free", "a", "force", "next_force", "q_try", "v_try", "a_try")
    numbers = (
        "g", "u", "half", "alpha", "bend", "bias", "g_try", "g_t", "g_t_try", "end_s", "last", "multiplier", "older",
        "older_time", "impulse", "p", "b", "z",
    )  # fmt: skip
    integers = ("status", "grounded", "hits", "close_hits", "plastic", "chosen", "pivots")
    lcp = workspace(max(n_c, 1))
    solver = solve_single if n_c <= 1 else solve_small
    return work.Work(
        q=np.array(scene.q0), v=np.array(scene.v0),
        **{name: np.zeros(n_q) for name in vectors},
        **{name: np.zeros(n_c) for name in numbers},
        **{name: np.zeros(n_c, dtype=np.int64) for name in integers},
        G=np.zeros((n_c, n_q)), G_try=np.zeros((n_c, n_q)), MG=np.zeros((n_c, n_q)), W=np.zeros((n_c, n_c)),
        AG=np.zeros((2, n_c, n_q)), WA=np.zeros((2, n_c, n_c)),
        M=np.zeros((n_q, n_q)), problem=np.zeros(n_c * n_c),
        solver=solver_address(solver, lcp) if fast else solver, lcp=lcp,
    )  # fmt: skip


def respond(m: Model, p: work.Plan, w: work.Work) -> None:
    """Response of accelerations to contact forces over a whole step, where it is constant."""
    if p.constant:
        w.AG[:] = (p.A_inverse[work.WHOLE] @ m.G.T).T
        w.WA[:] = m.G @ w.AG[work.WHOLE].T


class _Run:
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: Located, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        self.model, fast = model(scene)
        self.fast = fast and not jit_disabled()
        self.plan = plan(scene, self.model, method.h, method.max_events)
        self.work = start(scene, self.model, self.plan, self.fast)
        self.x = np.zeros(work.N_NUMBERS)
        self.recorder = Recorder(scene.n_q, scene.n_c, kept, PORTION + len(kept.times) + 8)
        self.count = np.zeros(work.N_COUNTERS, dtype=np.int64)
        self.totals = {"events": 0}
        self.t0, self.first = scene.t_span[0], 0

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        (t_start, t_end), h = self.scene.t_span, self.method.h
        steps = (t_end - t_start) / h
        whole = round(steps) if abs(steps - round(steps)) <= WHOLE else int(steps)
        status = Status.DONE
        try:
            begin = compiled(loop.begin) if self.fast else loop.begin
            self.prepare((t_end - t_start) / whole if whole and abs(steps - whole) <= WHOLE else h)
            code = begin(self.model, self.plan, self.work, self.x, self.recorder.buffers, self.count, t_start)
            status = STATUS[code]
            if status == Status.DONE and whole > 0:
                status = self.portions(t_start, 0, whole, progress)
            if status == Status.DONE and abs(steps - whole) > WHOLE:
                t_last = t_start + whole * h
                self.prepare(t_end - t_last)
                status = self.portions(t_last, whole, whole + 1, progress)
        except KeyboardInterrupt:
            raise SimulationInterrupted(self.trajectory(Status.INTERRUPTED)) from None
        result = self.trajectory(status)
        if status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    def prepare(self, h: float) -> None:
        """Constants for steps of size h."""
        self.plan = plan(self.scene, self.model, h, self.method.max_events)
        respond(self.model, self.plan, self.work)

    def portions(self, t0: float, first: int, last: int, progress: Callable[[float], None]) -> Status:
        """Steps first .. last - 1 of the run, all of one size."""
        count, b = self.count, self.recorder.buffers
        self.t0, self.first = t0, first
        run = compiled(loop.run) if self.fast else loop.run
        code = work.FINISHED
        while count[work.STEP] < last and code in (work.FINISHED, work.BUFFER_FULL):
            goal = min(last, int(count[work.STEP]) + PORTION)
            try:
                code = run(self.model, self.plan, self.work, self.x, b, count, t0, first, goal)
            except Exception as error:  # a callback in plain Python; compiled code raises nothing
                message = f"a callback failed in the step from t = {self.now:.9g} s: {error}"
                raise SimulationError(message, self.trajectory(Status.NOT_FINITE)) from error
            self.empty()
            progress(self.now)
        return STATUS[code]

    @property
    def now(self) -> float:
        """Time of the current state [s]."""
        t = self.t0 + self.plan.h * (int(self.count[work.STEP]) - self.first)
        return t + float(self.x[work.SIGMA]) * float(self.x[work.UNDER_WAY])

    def empty(self) -> None:
        """Move what the kernel's buffers hold to the recorder's keeping."""
        rows, events = int(self.count[work.ROW]), int(self.count[work.EVENT])
        self.recorder.empty(rows, events)
        self.totals["events"] += events
        self.count[work.ROW] = self.count[work.EVENT] = 0

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        self.empty()
        kept, w = self.recorder.states(), self.work
        t, q, v, impulse = kept.t, kept.q, kept.v, kept.impulse
        if len(self.kept.times) == 0 and self.now > t[-1]:
            t, q, v = np.append(t, self.now), np.vstack([q, w.q]), np.vstack([v, w.v])
            impulse = np.vstack([impulse, w.impulse])
        if len(t) and abs(t[-1] - self.scene.t_span[1]) <= WHOLE * self.method.h:
            t[-1] = self.scene.t_span[1]
        count = self.count
        return Trajectory(
            scene=self.scene, method=self.method, t=t, q=q, v=v, impulse=impulse,
            impacts=self.recorder.events(), status=status, message=self.message(status),
            counts=Counts(
                steps=int(count[work.STEP]), lcp_calls=int(count[work.LCP_CALLS]),
                force_evaluations=int(count[work.FORCES]), events=self.totals["events"],
            ),
            dense=_interpolation(t, q, v, self.kept.all),
        )  # fmt: skip

    def message(self, status: Status) -> str:
        """How the run ended, in words."""
        w = self.work
        if status == Status.DONE:
            return "reached the end of the span"
        where = f"at t = {self.now:.9g} s, q = {w.q.tolist()}, v = {w.v.tolist()}"
        if status == Status.INTERRUPTED:
            return f"interrupted {where}"
        if status == Status.LCP_FAILED:
            return f"no solution was found for the contacts {np.flatnonzero(w.status).tolist()} {where}"
        return f"{culprit(self.scene, (self.now, self.now + self.plan.h), w.q, w.v)} {where}"


STATUS = {
    work.FINISHED: Status.DONE,
    work.BUFFER_FULL: Status.DONE,
    work.NOT_FINITE: Status.NOT_FINITE,
    work.LCP_FAILED: Status.LCP_FAILED,
}


def _interpolation(t: Array, q: Array, v: Array, every_step: bool) -> Callable[[Array], tuple[Array, Array]]:
    """States between kept ones: the parabola through both positions that leaves with the first velocity."""

    def at(times: Array) -> tuple[Array, Array]:
        i = np.clip(np.searchsorted(t, times, side="right") - 1, 0, max(len(t) - 2, 0))
        if len(t) == 1:
            return q[i], v[i]
        last, length = times == t[-1], (t[i + 1] - t[i])[:, None]
        tau = (times - t[i])[:, None]
        if not every_step and np.any((tau != 0.0) & ~last[:, None]):
            raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
        half = (q[i + 1] - q[i] - length * v[i]) / length**2
        q_at, v_at = q[i] + tau * (v[i] + tau * half), v[i] + 2.0 * tau * half
        q_at[last], v_at[last] = q[-1], v[-1]
        return q_at, v_at

    return at
