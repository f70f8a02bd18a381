"""A run of `Located`: it prepares the kernels' arrays, feeds the loop in portions, and says in words how it ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.faults import cause
from lcpstep.gaps import no_way_out
from lcpstep.model import culprit, joint_model, model
from lcpstep.pace import Pace
from lcpstep.recording import Kept, Recorder
from lcpstep.stepping.interpolation import Bent
from lcpstep.stepping.pieces import codes
from lcpstep.stepping.pieces.joints import Joints
from lcpstep.stepping.pieces.polynomial_steps import PolynomialSteps
from lcpstep.stepping.pieces.prepare import at_rest, displaced, plan, start
from lcpstep.stepping.pieces.quadratic_steps import QuadraticSteps
from lcpstep.stepping.steps import divided, unresolved
from lcpstep.trajectory import Counts, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.stepping.located import Located

Array = NDArray[np.float64]
PORTION = 16384  # steps between two looks at the outside world, at most
TRIALS = 17  # of the callbacks within a step that failed
STATUS = {
    codes.FINISHED: Status.DONE,
    codes.BUFFER_FULL: Status.DONE,
    codes.NOT_FINITE: Status.NOT_FINITE,
    codes.LCP_FAILED: Status.LCP_FAILED,
    codes.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    codes.JOINTS_FAILED: Status.JOINTS_FAILED,
    codes.NO_POSITION: Status.PROJECTION_FAILED,
}


class Run:
    """One run: the loop with its state, and the portions that it is fed in."""

    def __init__(self, method: Located, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        self.model = at_rest(model(scene), method.order == 2 and scene.n_j == 0)
        joints = Joints(self.model, joint_model(scene)) if scene.n_j > 0 else None
        p = plan(scene, self.model, method, method.h)
        self.work = start(scene, self.model, p, joints)
        self.recorder = Recorder(scene.n_q, scene.n_c + scene.n_j, kept, PORTION + len(kept.times) + 8)
        steps = QuadraticSteps if method.order == 2 else PolynomialSteps
        self.steps = steps(self.model, p, self.work, self.recorder.record)
        self.events = 0  # taken out of the buffers
        self.pace = Pace(PORTION, scene.n_q + scene.n_c + scene.n_j)
        self.t0, self.first = scene.t_span[0], 0

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        try:
            status = STATUS[self.steps.begin(self.scene.t_span[0])]
            if status == Status.DONE:
                status = self.even(progress)
            error = cause() if status == Status.NOT_FINITE else None
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED)) from None
        result = self.trajectory(status)
        if status == Status.NOT_FINITE:
            raise SimulationError(result.message, result) from error
        return result

    def even(self, progress: Callable[[float], None]) -> Status:
        """The whole run in steps of one size, and a last one where that does not divide the span."""
        status = Status.DONE
        for h, t0, first, last in divided(self.scene.t_span, self.method.h):
            if status == Status.DONE:
                if h != self.steps.plan.h:
                    self.steps.plan = plan(self.scene, self.model, self.method, h)
                status = self.portions(t0, first, last, progress)
        return status

    def portions(self, t0: float, first: int, last: int, progress: Callable[[float], None]) -> Status:
        """Steps first .. last - 1 of the run, all of one size."""
        self.t0, self.first = t0, first
        code = codes.FINISHED
        while self.work.steps < last and code in (codes.FINISHED, codes.BUFFER_FULL):
            goal = min(last, self.pace.goal(self.work.steps))
            self.work.events_left = self.method.max_events - self.events
            code = self.steps.run(t0, first, goal)
            self.empty()
            progress(self.now)
        return STATUS[code]

    @property
    def now(self) -> float:
        """Time of the current state [s]."""
        t = self.t0 + self.steps.plan.h * (self.work.steps - self.first)
        return float(t + self.work.sigma * self.work.under_way)

    def empty(self) -> None:
        """Move what the kernel's buffers hold to the recorder's keeping."""
        if self.model.carried:
            self.steps.put_back()
        self.events += self.recorder.take()

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        self.empty()
        kept, w = self.recorder.states(), self.work
        c, c_t = displaced(self.scene, self.model, self.now)
        q_now, v_now, impulse_now = w.view("q") - c, w.view("v") - c_t, w.view("impulse").copy()
        t, q, v, impulse, jumps = kept.t, kept.q, kept.v, kept.impulse, kept.mode > 0.0
        if len(self.kept.times) == 0 and self.now > t[-1]:
            t, q, v = np.append(t, self.now), np.vstack([q, q_now]), np.vstack([v, v_now])
            impulse, jumps = np.vstack([impulse, impulse_now]), np.append(jumps, True)
        finite = np.isfinite(q).all() and np.isfinite(v).all()
        bad: Any = (
            [] if finite else np.flatnonzero(~(np.isfinite(q).all(axis=1) & np.isfinite(v).all(axis=1)))
        )
        if len(bad):  # the step that failed has left its numbers behind
            t, q, v, impulse = t[: bad[0]], q[: bad[0]], v[: bad[0]], impulse[: bad[0]]
        last = (float(t[-1]), q[-1], v[-1]) if len(bad) and len(t) else (self.now, q_now, v_now)
        if len(t) and abs(t[-1] - self.scene.t_span[1]) <= unresolved(self.scene.t_span, self.method.h):
            t[-1] = self.scene.t_span[1]
        impulse, joint = np.split(impulse, [self.scene.n_c], axis=1)
        return Trajectory(
            scene=self.scene, method=self.method, t=t, q=q, v=v, impulse=impulse,
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=self.message(status, *last),
            counts=Counts(
                steps=w.steps, lcp_calls=w.lcp_calls, force_evaluations=w.force_evaluations, events=self.events,
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
        if self.method.order == 2 and (self.method.tolerance is None or self.steps.plan.plain):
            return Bent(t, q, v, self.kept.all, jumps)
        return Again(self.method, self.scene, q_end, v_end)

    def message(self, status: Status, t: float, q: Array, v: Array) -> str:
        """How the run ended with its last finite state, in words."""
        cut = self.work.cut
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
        if status == Status.JOINTS_FAILED:
            return f"joint {self.work.joints.culprit} contradicts others {where}"
        if status == Status.PROJECTION_FAILED:
            joint = self.work.joints.culprit
            return f"no position near satisfies joint {joint} {where}; try a smaller h"
        if status == Status.LCP_FAILED:
            n = self.work.members
            contacts = sorted(self.work.view("chosen")[:n].tolist())
            words = f"no impulses or forces satisfy contact{'s' * (n > 1)} {contacts} together"
            return f"{no_way_out(self.scene, t, q, contacts) or words} {where}"
        return f"{culprit(self.scene, np.linspace(t, self.now + self.steps.plan.h, TRIALS), q, v)} {where}"


@dataclass(frozen=True, eq=False)
class Again:
    """States at any time, by another run that keeps them; one that ends early, ends in the state q_end, v_end."""

    method: Located
    scene: Scene
    q_end: Array
    v_end: Array

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times, each (m, n_q)."""
        unique, place = np.unique(times, return_inverse=True)
        try:
            m = self.method.run(self.scene, Kept.parse(unique, self.scene.t_span), lambda _: None)
        except SimulationError as stopped:
            m = stopped.trajectory
        n = len(unique) - len(m.t)  # times as late as the end to rounding, which the run no longer passes
        q = np.vstack([m.q, np.tile(self.q_end, (n, 1))])
        v = np.vstack([m.v, np.tile(self.v_end, (n, 1))])
        return q[place], v[place]
