"""Time-stepping with every impulse at its own time within the step: its parameters, and a run.

The loop over steps is a kernel (`located_loop.run`); this file prepares its arrays, feeds it in portions, and says in
words how a run ended.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled, jit_disabled
from lcpstep.dynamics import moves
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.gaps import no_way_out
from lcpstep.lcp.kernel import room, solver
from lcpstep.model import ABSENT, Model, culprit, model, models
from lcpstep.pace import Pace
from lcpstep.recording import Kept, Recorder
from lcpstep.stepping import (
    adaptive,
    adaptive_located,
    carried,
    polynomial_loop,
    refine,
    smooth,
)
from lcpstep.stepping import located_loop as loop
from lcpstep.stepping import located_work as work
from lcpstep.stepping.interpolation import Bent
from lcpstep.stepping.joint_tasks import CULPRIT
from lcpstep.stepping.joint_tasks import IMPULSE as JOINT_IMPULSE
from lcpstep.stepping.located_event import straighten
from lcpstep.stepping.located_glide import glide
from lcpstep.stepping.located_joints import HOOKS, Joined, joined
from lcpstep.stepping.located_piece import pressed
from lcpstep.stepping.pieces.run import Again
from lcpstep.stepping.race import race
from lcpstep.stepping.steps import divided, unresolved
from lcpstep.trajectory import Counts, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.stepping.located import Located

Array = NDArray[np.float64]
PORTION = 16384  # steps between two looks at the outside world, at most
TRIALS = 17  # of the callbacks within a step that failed
SMALL = 8  # coordinates up to which matrices are made anew for the rest of a step
# Impacts in one step after which the rest of a chattering sequence, if it ends within the step, is taken as one: the
# frozen acceleration of order two makes no error by that
MANY, MANY_EXACTLY = 200, 20_000
PER_PERIOD = 16  # pieces of exact motion per period of a moving frame or obstacle
MARGIN = 2.0**-49  # relative; by which times are moved off a corner

# What steps with joints never reach: the ways of the trapezoidal rule
UNJOINED = (
    glide, race, pressed, straighten, smooth.invert_rest, smooth.shift,
    refine.solve_several, refine.keep_closed,
)  # fmt: skip


def plan(scene: Scene, m: Model, method: Located, h: float) -> work.Plan:
    """Constants of steps of size h."""
    n_q = scene.n_q
    trapezoidal = m.linear and scene.n_j == 0
    stiff = bool(trapezoidal and (np.any(m.C) or np.any(m.K)))
    unforced = m.force == ABSENT and m.omega == 0.0 and (m.frame == ABSENT or m.carried)
    steady = bool(trapezoidal and not stiff and unforced)
    A_inverse = np.zeros((2, n_q, n_q))
    if trapezoidal:
        implicit = h if method.order == 2 else 0.0
        A_inverse[:] = np.linalg.inv(m.M + 0.5 * implicit * m.C + 0.25 * implicit**2 * m.K)
    size = max(np.max(np.abs(x), initial=0.0) for x in (scene.q0, m.offset, h * np.asarray(scene.v0)))
    t_scale = max(abs(scene.t_span[0]), abs(scene.t_span[1]))
    if math.isfinite(scene.period):  # a callback may know the time no better than its phase
        t_scale = max(t_scale, scene.period)
    return work.Plan(
        h=h, made_for=h, trapezoidal=trapezoidal, joined=scene.n_j > 0, stiff=stiff, steady=steady,
        plain=bool(trapezoidal and m.flat and not moves(m)), constant=bool(trapezoidal and m.flat),
        small=n_q <= SMALL, slack=work.ROUNDING * float(size or 1.0), per_step=method.max_per_step,
        many=MANY if method.order == 2 else MANY_EXACTLY,
        exact=method.order == "exact", longest=longest(scene, m, method),
        corners=np.array(scene.corners), period=scene.period,
        margin=MARGIN * t_scale if len(np.asarray(scene.corners)) else 0.0,
        A_inverse=A_inverse, A=np.zeros((n_q, n_q)), unit=np.zeros(n_q), pivots=np.zeros(n_q, dtype=np.int64),
    )  # fmt: skip


def longest(scene: Scene, m: Model, method: Located) -> float:
    """Longest piece on which a Taylor polynomial is exact and gap velocities turn but once in a quarter of it."""
    if method.order != "exact":
        return np.inf
    stiffness = np.max(np.abs(np.linalg.eigvals(m.M_inverse @ m.K)))
    damping = np.max(np.abs(np.linalg.eigvals(m.M_inverse @ m.C)))
    rate = max(np.sqrt(stiffness), damping, abs(m.omega), 2.0 * np.pi / PER_PERIOD / scene.period)
    return float(1.0 / rate) if rate > 0.0 else np.inf


def polynomial(n_q: int, n_c: int) -> work.Polynomial:
    """Work space of a polynomial piece."""
    return work.Polynomial(
        T=np.zeros((work.DEGREE + 1, n_q)), scale=np.ones(1), a=np.zeros((5, n_q)),
        vec=np.zeros((work.N_PIECE_VEC, n_q)), num=np.zeros((work.N_PIECE_NUM, n_c)),
    )  # fmt: skip


def start(scene: Scene, m: Model, p: work.Plan, fast: bool, joints: Joined | None) -> work.Work:
    """State at the start of the scene's span, with the work space of a step."""
    n_q, n_c = scene.n_q, scene.n_c
    vec = np.zeros((work.N_VEC, n_q))
    c, c_t = carried.displaced(scene, m, scene.t_span[0])
    vec[work.Q], vec[work.V] = np.asarray(scene.q0) + c, np.asarray(scene.v0) + c_t
    mark = np.zeros((work.N_MARK, n_c), dtype=np.int64)
    mark[work.LAST_COORDINATE], mark[work.LAST_CONTACT] = n_q - 1, n_c - 1
    if p.plain and n_c > 0:
        mark[work.FIRST_COORDINATE :] = ranges(m)
    return work.Work(
        vec=vec, num=np.zeros((work.N_NUM, n_c)), mark=mark,
        G=np.zeros((n_c, n_q)), G_try=np.zeros((n_c, n_q)), MG=np.zeros((n_c, n_q)), W=np.zeros((n_c, n_c)),
        AG=np.zeros((2, n_c, n_q)), WA=np.zeros((2, n_c, n_c)),
        pivots=np.zeros(n_c + 1, dtype=np.int64), M=np.zeros((n_q, n_q)), problem=np.zeros(n_c * n_c),
        solver=solver(fast), lcp=room(n_c, fast), joints=joints,
    )  # fmt: skip


def ranges(m: Model) -> NDArray[np.int64]:
    """First and last coordinate that an impulse of each contact changes, first and last contact that feels it."""
    G = np.abs(m.G)
    MG = G @ np.abs(m.M_inverse)
    patterns = [np.asarray(x > 0.0) for x in (MG + G, MG @ G.T)]
    first_last = [[x.argmax(axis=1), x.shape[1] - 1 - x[:, ::-1].argmax(axis=1)] for x in patterns]
    return np.array(first_last, dtype=np.int64).reshape(4, len(G))


def respond(m: Model, p: work.Plan, w: work.Work) -> None:
    """Response of accelerations to contact forces over a whole step, where it is constant."""
    if p.constant:
        w.AG[:] = (p.A_inverse[work.WHOLE] @ m.G.T).T
        w.WA[:] = m.G @ w.AG[work.WHOLE].T


class Run:
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: Located, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        joints = None
        if scene.n_j > 0:
            (self.model, rows, _), fast = models(scene)
            joints = joined(scene, self.model, rows, fast and not jit_disabled())
        else:
            self.model, fast = model(scene)
            self.model = carried.at_rest(self.model, self.model.linear and method.order == 2)
        self.fast = fast and not jit_disabled()
        self.never = HOOKS if joints is None else UNJOINED
        self.plan = plan(scene, self.model, method, method.h)
        self.work = start(scene, self.model, self.plan, self.fast, joints)
        respond(self.model, self.plan, self.work)
        run: Callable[..., int] = loop.run if method.order == 2 else polynomial_loop.run
        self.run = compiled(run, self.never) if self.fast else run
        self.put_back = compiled(carried.put_back) if self.fast else carried.put_back
        self.x = np.zeros(work.N_NUMBERS)
        self.piece = polynomial(scene.n_q, scene.n_c)
        self.recorder = Recorder(scene.n_q, scene.n_c + scene.n_j, kept, PORTION + len(kept.times) + 8)
        self.count = np.zeros(work.N_COUNTERS, dtype=np.int64)
        self.totals = {"events": 0}
        self.pace = Pace(PORTION, scene.n_q + scene.n_c + scene.n_j)
        self.t0, self.first, self.half_done = scene.t_span[0], 0, False

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        t_start, tolerance = self.scene.t_span[0], self.method.tolerance
        try:
            begin = compiled(loop.begin, self.never) if self.fast else loop.begin
            code = begin(self.model, self.plan, self.work, self.x, self.recorder.buffers, self.count, t_start)
            status = STATUS[code]
            if status == Status.DONE:
                exact = self.plan.plain and self.plan.steady
                if tolerance is None or (exact and tolerance >= adaptive.NOISE):
                    status = self.even(progress)
                else:
                    status = self.adapted(tolerance, progress)
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED)) from None
        result = self.trajectory(status)
        if status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    def even(self, progress: Callable[[float], None]) -> Status:
        """The whole run in steps of one size, and a last one where that does not divide the span."""
        status = Status.DONE
        for h, t0, first, last in divided(self.scene.t_span, self.method.h):
            if status == Status.DONE:
                self.prepare(h)
                status = self.portions(t0, first, last, progress)
        return status

    def prepare(self, h: float) -> None:
        """Take steps of size h from now on."""
        if h != self.plan.h:
            self.plan = plan(self.scene, self.model, self.method, h)
            respond(self.model, self.plan, self.work)

    def adapted(self, tolerance: float, progress: Callable[[float], None]) -> Status:
        """The whole run in steps that meet the tolerance."""
        control = adaptive.control(self.scene.t_span, self.method.h, tolerance, int(self.method.order))
        steps = adaptive_located.Attempts(
            self.made, self.one, self.plan, self.work, self.x, self.recorder.buffers, self.count, control,
            self.method.order == 2, self.fast,
        )  # fmt: skip

        def arrive() -> None:
            self.t0, self.first = float(adaptive.now(control)), int(self.count[work.STEP])
            self.plan = self.plan._replace(h=adaptive.step_size(control, int(control.whole[adaptive.LEVEL])))
            self.empty()
            self.count[work.EVENTS_LEFT] = self.method.max_events - self.totals["events"]

        try:
            self.count[work.EVENTS_LEFT] = self.method.max_events
            return STATUS[adaptive.advance(steps, control, arrive, progress)]
        except Exception as error:  # a callback in plain Python; compiled code raises nothing
            raise self.failed() from error

    def made(self, h: float) -> tuple[work.Plan, work.Work]:
        """Constants of steps of size h, and the work space with the responses of these."""
        w = self.work._replace(AG=self.work.AG.copy(), WA=self.work.WA.copy())
        p = plan(self.scene, self.model, self.method, h)._replace(slack=self.plan.slack, many=MANY_EXACTLY)
        respond(self.model, p, w)
        return p, w

    def one(self, p: work.Plan, w: work.Work, t: float) -> int:
        """One step from time t."""
        first = int(self.count[work.STEP])
        return self.steps(p, w, t, first, first + 1)

    def failed(self) -> SimulationError:
        """What an exception in plain Python makes of a run; it may have left a step half done."""
        self.half_done = True
        result = self.trajectory(Status.NOT_FINITE)
        return SimulationError(result.message, result)

    def portions(self, t0: float, first: int, last: int, progress: Callable[[float], None]) -> Status:
        """Steps first .. last - 1 of the run, all of one size."""
        count = self.count
        self.t0, self.first = t0, first
        code = work.FINISHED
        while count[work.STEP] < last and code in (work.FINISHED, work.BUFFER_FULL):
            goal = min(last, self.pace.goal(int(count[work.STEP])))
            try:
                count[work.EVENTS_LEFT] = self.method.max_events - self.totals["events"]
                code = self.steps(self.plan, self.work, t0, first, goal)
            except Exception as error:  # a callback in plain Python; compiled code raises nothing
                raise self.failed() from error
            self.empty()
            progress(self.now)
        return STATUS[code]

    def steps(self, p: work.Plan, w: work.Work, t0: float, first: int, goal: int) -> int:
        """Steps up to `goal`, by the kernel of the method's order."""
        m, x, b, count = self.model, self.x, self.recorder.buffers, self.count
        if self.method.order == 2:
            return int(self.run(m, p, w, x, b, count, t0, first, goal))
        return int(self.run(m, p, w, x, self.piece, b, count, t0, first, goal))

    @property
    def now(self) -> float:
        """Time of the current state [s]."""
        t = self.t0 + self.plan.h * (int(self.count[work.STEP]) - self.first)
        return t + float(self.x[work.SIGMA]) * float(self.x[work.UNDER_WAY])

    def empty(self) -> None:
        """Move what the kernel's buffers hold to the recorder's keeping."""
        rows, events = int(self.count[work.ROW]), int(self.count[work.EVENT])
        if self.model.carried:
            self.put_back(self.model, self.recorder.buffers.rows, rows)
        self.recorder.empty(rows, events)
        self.totals["events"] += events
        self.count[work.ROW] = self.count[work.EVENT] = 0

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        self.empty()
        kept, w = self.recorder.states(), self.work
        c, c_t = carried.displaced(self.scene, self.model, self.now)
        q_now, v_now, impulse_now = w.vec[work.Q] - c, w.vec[work.V] - c_t, self.impulse()
        t, q, v, impulse, jumps = kept.t, kept.q, kept.v, kept.impulse, kept.mode > 0.0
        if len(self.kept.times) == 0 and self.now > t[-1] and not self.half_done:
            t, q, v = np.append(t, self.now), np.vstack([q, q_now]), np.vstack([v, v_now])
            impulse, jumps = np.vstack([impulse, impulse_now]), np.append(jumps, True)
        bad = np.flatnonzero(~(np.isfinite(q).all(axis=1) & np.isfinite(v).all(axis=1)))
        if len(bad):  # the step that failed has left its numbers behind
            t, q, v, impulse = t[: bad[0]], q[: bad[0]], v[: bad[0]], impulse[: bad[0]]
        cut = len(bad) or self.half_done
        last = (float(t[-1]), q[-1], v[-1]) if cut and len(t) else (self.now, q_now, v_now)
        if len(t) and abs(t[-1] - self.scene.t_span[1]) <= unresolved(self.scene.t_span, self.method.h):
            t[-1] = self.scene.t_span[1]
        count = self.count
        impulse, joint = np.split(impulse, [self.scene.n_c], axis=1)
        return Trajectory(
            scene=self.scene, method=self.method, t=t, q=q, v=v, impulse=impulse,
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=self.message(status, *last),
            counts=Counts(
                steps=int(count[work.STEP]), lcp_calls=int(count[work.LCP_CALLS]),
                force_evaluations=int(count[work.FORCES]), events=self.totals["events"],
            ),
            dense=self.between(t, q, v, jumps[: len(t)], *last[1:]),
            joint_impulse=joint,
        )  # fmt: skip

    def between(
        self, t: Array, q: Array, v: Array, jumps: NDArray[np.bool_], q_end: Array, v_end: Array
    ) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time: from the kept ones where these tell, by another run where they do not.

        Steps by a tolerance are as long as what moves allows at their ends: in between an obstacle goes its own way.
        """
        if self.method.order == 2 and (self.method.tolerance is None or self.plan.plain):
            return Bent(t, q, v, self.kept.all, jumps)
        return Again(self.method, self.scene, q_end, v_end)

    def impulse(self) -> Array:
        """Impulses of contacts and joints since the last kept state."""
        joints = self.work.joints
        of_joints = np.zeros(0) if joints is None else joints.own.num[JOINT_IMPULSE]
        return np.concatenate([self.work.num[work.IMPULSE], of_joints])

    def message(self, status: Status, t: float, q: Array, v: Array) -> str:
        """How the run ended with its last finite state, in words."""
        cut = int(self.count[work.CUT])
        if status == Status.DONE and cut == 0:
            return "reached the end of the span"
        if status == Status.DONE:
            events = f"events without end, or more than max_per_step = {self.method.max_per_step} in a step"
            return f"reached the end of the span; {cut} times one plastic impact stood for {events}"
        where = f"at t = {t:.9g} s, q = {q.tolist()}, v = {v.tolist()}"
        if status == Status.INTERRUPTED:
            return f"interrupted {where}"
        if status == Status.TOO_MANY_EVENTS:
            return f"more than max_events = {self.method.max_events} events {where}"
        if status == Status.STEP_TOO_SMALL:
            return adaptive.too_small(self.method, self.scene, t, q, v, where)
        if status == Status.JOINTS_FAILED:
            return f"joint {self.work.joints.own.order[CULPRIT]} contradicts others {where}"
        if status == Status.PROJECTION_FAILED:
            joint = self.work.joints.own.order[CULPRIT]
            return f"no position near satisfies joint {joint} {where}; try a smaller h"
        if status == Status.LCP_FAILED:
            n = int(self.count[work.MEMBERS])
            contacts = sorted(self.work.mark[work.CHOSEN, :n].tolist())
            words = f"no impulses or forces satisfy contact{'s' * (n > 1)} {contacts} together"
            return f"{no_way_out(self.scene, t, q, contacts) or words} {where}"
        return f"{culprit(self.scene, np.linspace(t, self.now + self.plan.h, TRIALS), q, v)} {where}"


STATUS = {
    adaptive.TOO_SMALL: Status.STEP_TOO_SMALL,
    work.FINISHED: Status.DONE,
    work.BUFFER_FULL: Status.DONE,
    work.NOT_FINITE: Status.NOT_FINITE,
    work.LCP_FAILED: Status.LCP_FAILED,
    work.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    work.JOINTS_FAILED: Status.JOINTS_FAILED,
    work.NO_POSITION: Status.PROJECTION_FAILED,
}
