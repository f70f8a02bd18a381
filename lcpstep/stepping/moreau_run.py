"""A run of `Moreau` in steps of one size, from a scene to a trajectory.

The loop over steps is a kernel (`theta_method.theta_loop`); this file prepares what it works in, feeds it in
portions, hands complementarity problems to an outside solver where one is named, and says in words how a run ended.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.faults import cause
from lcpstep.gaps import no_way_out
from lcpstep.kernels.coulomb import ContactProblem
from lcpstep.kernels.model import Model
from lcpstep.lcp import solve_lcp
from lcpstep.model import culprit, models
from lcpstep.pace import Pace
from lcpstep.recording import Kept, Recorder
from lcpstep.stepping import interpolation
from lcpstep.stepping.start import start_side
from lcpstep.stepping.steps import RESTING, divided, unresolved
from lcpstep.stepping.theta_method import theta_loop as loop
from lcpstep.stepping.theta_method.codes import FINISHED, LOG_FULL, MAX_ITERATIONS, NEED_LCP
from lcpstep.stepping.theta_method.moving import Rows, State
from lcpstep.stepping.theta_method.plan import Plan
from lcpstep.trajectory import Counts, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
PORTION = 65536  # steps between two looks at the outside world, at most
STATES = 8192  # kept in these, at most: what a processor has at hand while it is written and read


class Run:
    """One run: what the kernels work in, and the portions that they are fed in."""

    def __init__(self, method: Moreau, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        self.model, joints, tangents = models(scene)
        self.rows = rows(scene, joints, tangents, method.projected)
        self.constant = all(m.flat for m in (self.model, joints, tangents)) and self.model.linear
        self.constant = self.constant and not method.projected
        self.state = State(scene.q0, scene.v0, scene.n_c, self.rows.n)
        self.stretches = list(divided(scene.t_span, method.h))
        portion = min(PORTION, STATES * kept.every) if kept.every > 0 else PORTION
        # A portion keeps at most its steps, the given times, and the first and last state.
        room = STATES if kept.every > 0 else PORTION
        expected = 1 + self.stretches[-1][3] // kept.every if kept.every > 0 else len(kept.times)
        self.recorder = Recorder(scene.n_q, self.rows.n, kept, room + len(kept.times) + 2, expected=expected)
        sizes = scene.q0, self.model.arrays["offset"], method.h * np.asarray(scene.v0)
        size = max(float(np.max(np.abs(x), initial=0.0)) for x in sizes)
        self.slack = RESTING * (size or 1.0)
        self.events = 0
        self.pace = Pace(portion, scene.n_q + self.rows.n)
        self.t0, self.first = scene.t_span[0], 0
        self.plan = self.plan_for(self.stretches[0][0])

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        t_start, error = self.scene.t_span[0], None
        try:
            side = start_side(self.scene, t_start)
            loop.begin_at(self.model, self.state, self.rows, self.recorder.record, t_start, side)
            status = self.advance(progress)
            if status == Status.NOT_FINITE:
                error = cause()
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED)) from None
        result = self.trajectory(status)
        if status == Status.NOT_FINITE:
            raise SimulationError(result.message, result) from error
        return result

    def advance(self, progress: Callable[[float], None]) -> Status:
        """The whole run in steps of one size, and a last one where that does not divide the span."""
        status = Status.DONE
        for h, t0, first, last in self.stretches:
            if status == Status.DONE:
                if first > 0:
                    self.plan = self.plan_for(h)
                self.t0, self.first = t0, first
                status = self.portions(last, progress)
        return status

    def plan_for(self, h: float) -> Plan:
        """What steps of size h multiply with."""
        made = plan(self.model, self.rows, h, self.method.theta, self.slack, self.constant)
        if self.constant and self.rows.n > self.rows.n_c:
            loop.prepare(self.model, made, self.state, self.rows, self.scene.t_span[0])
        return made

    def portions(self, last: int, progress: Callable[[float], None]) -> Status:
        """Steps up to the one before `last`, all of one size."""
        s, external, solved, code = self.state, self.method.lcp != "lemke", False, FINISHED
        while s.steps < last:
            goal = min(last, self.pace.goal(s.steps))
            while s.steps < goal:
                record = self.recorder.record
                code = loop.go(
                    self.model, self.plan, s, self.rows, record, self.t0, self.first, goal, external, solved
                )
                solved = code == NEED_LCP and self.solve_outside()
                if code == NEED_LCP and not solved:
                    code = int(Status.LCP_FAILED)
                if code == LOG_FULL:
                    self.empty()
                elif code not in (FINISHED, NEED_LCP):
                    break
            self.empty()
            progress(self.now)
            if code not in (FINISHED, LOG_FULL, NEED_LCP):  # be it in the last step of the portion
                return Status(code)
        return Status.DONE

    def solve_outside(self) -> bool:
        """Hand the problem at hand to the named solver; whether it was solved."""
        arrays, n = self.rows.problem.arrays, len(self.active)
        W, b = arrays["mobility"][: n * n].reshape(n, n), arrays["rate"][:n]
        solution = solve_lcp(W, b, method=self.method.lcp)
        arrays["impulse"][:n] = solution.z
        return bool(solution.solved)

    @property
    def active(self) -> list[int]:
        """Contacts that are active in the step at hand."""
        x = self.state.arrays
        return np.flatnonzero(x["g"] + 0.5 * self.plan.h * x["u"] <= self.plan.slack).tolist()

    @property
    def now(self) -> float:
        """Time of the current state [s]."""
        return self.t0 + self.plan.h * (self.state.steps - self.first)

    def empty(self) -> None:
        """Move what the kernels have written to the recorder's keeping."""
        self.events += self.recorder.take()

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        self.empty()
        kept, s = self.recorder.states(), self.state
        t, q, v, impulses = kept.t, kept.q, kept.v, kept.impulse
        if len(self.kept.times) == 0 and self.now > t[-1]:
            now = s.arrays
            t, q, v = np.append(t, self.now), np.vstack([q, now["q"]]), np.vstack([v, now["v"]])
            impulses = np.vstack([impulses, now["impulse"]])
        if len(t) > 0 and abs(t[-1] - self.scene.t_span[1]) <= unresolved(self.scene.t_span, self.method.h):
            t[-1] = self.scene.t_span[1]
        impulse, friction, joint = np.split(
            impulses, [self.rows.n_c, impulses.shape[1] - self.rows.n_j], axis=1
        )
        return Trajectory(
            scene=self.scene, method=self.method, t=t, q=q, v=v, impulse=impulse,
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=self.message(status),
            counts=Counts(steps=s.steps, lcp_calls=s.problems, force_evaluations=s.forces, events=self.events),
            dense=self.between(t, q, v), joint_impulse=joint, friction_impulse=friction,
        )  # fmt: skip

    def between(self, t: Array, q: Array, v: Array) -> interpolation.Between:
        """How states between kept ones follow from them."""
        return interpolation.Linear(t, q, v, self.kept.all)

    def message(self, status: Status) -> str:
        """How the run ended, in words."""
        if status == Status.DONE:
            return "reached the end of the span"
        s, now = self.state, self.now
        q, v = s.arrays["q"], s.arrays["v"]
        where = f"at t = {now:.9g} s, q = {q.tolist()}, v = {v.tolist()}"
        if status == Status.INTERRUPTED:
            return f"interrupted {where}"
        if status == Status.LCP_FAILED:
            words = f"{self.method.lcp} found no solution for the contacts {self.active}"
            return f"{no_way_out(self.scene, now + self.plan.h, q, self.active) or words} {where}"
        if status == Status.JOINTS_FAILED:
            joints = np.flatnonzero(self.rows.arrays["failed"]).tolist()
            return f"joints {joints} contradict each other in step {s.steps} {where}"
        if status == Status.PROJECTION_FAILED:
            return (
                f"no position near satisfies all joints and contacts in step {s.steps} {where}; "
                "try a smaller h"
            )
        if status == Status.NEWTON_FAILED:
            return (
                f"Newton's iteration did not converge within {MAX_ITERATIONS} steps {where}; try a smaller h"
            )
        return f"{culprit(self.scene, (now, now + self.plan.h), q, v)} {where}"


def rows(scene: Scene, joints: Model, tangents: Model, projected: bool) -> Rows:
    """Joints and tangents of a scene, with the rows of a step."""
    n_c, contacts = scene.n_c, scene.contacts
    friction = None if contacts is None else contacts.friction
    mu, r_T = np.zeros(n_c), np.zeros(n_c)
    if contacts is not None and friction is not None:
        mu = np.array(friction.mu)
        r_T = np.array(contacts.restitution if friction.restitution is None else friction.restitution)
    n = n_c + tangents.n_c + joints.n_c
    warm = n == n_c and not projected
    problem = ContactProblem(mu, friction is not None, n, warm)
    return Rows(joints, tangents, n_c, tangents.n_c, r_T, projected, problem)


def plan(m: Model, c: Rows, h: float, theta: float, slack: float, constant: bool) -> Plan:
    """What steps of size h multiply with: A = M + h theta C + h^2 theta^2 K, inverted once.

    X and W are those of the contacts; with tangents or joints, or where they change, there is but room for them.
    """
    M, C, K, G = (m.arrays[name] for name in ("M", "C", "K", "G"))
    A = M + h * theta * C + (h * theta) ** 2 * K
    inverse: Any = np.linalg.inv(A) if m.linear else np.zeros(A.shape)
    X, W = np.zeros((c.n, m.n_q)), np.zeros((c.n, c.n))
    if c.n == m.n_c:
        A_g = inverse @ G.T
        X, W = A_g.T, G @ A_g
    matrices = {
        "A_q": h * inverse @ K, "A_v": inverse @ (h * C + h * h * theta * K), "A_f": h * inverse, "X": X, "W": W,
    }  # fmt: skip
    return Plan(h, theta, slack, constant, matrices)
