"""A run of `Moreau` by a tolerance: prepares the arrays of its loop, feeds it, and says in words how it ended."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled, jit_disabled
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.gaps import no_way_out
from lcpstep.lcp.kernel import room, solver
from lcpstep.model import Model, culprit, model, models
from lcpstep.recording import Kept, Recorder
from lcpstep.stepping import adaptive, adaptive_moreau, constrained, interpolation
from lcpstep.stepping import theta as loop
from lcpstep.stepping.constrained import Constraints
from lcpstep.stepping.features import constraints, enlarged
from lcpstep.stepping.newton import Newton
from lcpstep.stepping.start import start_side
from lcpstep.stepping.steps import RESTING, unresolved
from lcpstep.trajectory import Counts, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
PORTION = 65536  # steps between two looks at the outside world, at most


def plan(m: Model, h: float, theta: float, slack: float) -> loop.Plan:
    """What steps of size h multiply with: A = M + h theta C + h^2 theta^2 K, inverted once."""
    n_q, n_c = m.G.shape[1], m.G.shape[0]
    A = m.M + h * theta * m.C + (h * theta) ** 2 * m.K
    inverse = np.asarray(np.linalg.inv(A) if m.linear else np.zeros((n_q, n_q)), dtype=np.float64)
    A_g = inverse @ m.G.T
    return loop.Plan(
        h=h,
        theta=theta,
        A_q=h * inverse @ m.K,
        A_v=inverse @ (h * m.C + h * h * theta * m.K),
        A_f=h * inverse,
        A_g=np.ascontiguousarray(A_g).reshape(n_q, n_c),
        W=m.G @ A_g,
        slack=slack,
    )


def start(scene: Scene, fast: bool, features: Constraints | None = None) -> loop.State:
    """State at the start of the scene's span, with the work space of a step."""
    n_q, n_c = scene.n_q, scene.n_c
    vectors = {
        name: np.zeros(n_q)
        for name in (
            "force",
            "next_force",
            "next_q",
            "next_v",
            "v_free",
            "q_between",
            "v_between",
        )
    }
    contacts = {name: np.zeros(n_c) for name in ("g", "u", "impulse", "p", "g_t", "b", "z")}
    newton = Newton(
        **{name: np.zeros(n_q) for name in ("R", "v", "q", "f")},
        **{name: np.zeros((n_q, n_q)) for name in ("M", "M_start", "A", "J")},
        pivots=np.zeros(n_q, dtype=np.int64),
    )
    state = loop.State(
        q=np.array(scene.q0),
        v=np.array(scene.v0),
        closed=np.zeros(n_c, dtype=np.int64),
        G=np.zeros((n_c, n_q)),
        active=np.zeros(n_c, dtype=np.int64),
        W=np.zeros(n_c * n_c),
        solver=solver(fast),
        lcp=room(n_c, fast),
        newton=newton,
        **vectors,
        **contacts,
    )
    if features is not None:
        return enlarged(state, features)
    return state


class AdaptedRun:
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: Moreau, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        self.extra: tuple[Constraints, ...] = ()  # of the kernel: constraints, where there are any
        if method.beyond_contacts(scene):
            (self.model, joints, tangents), fast = models(scene)
            fast = fast and not jit_disabled()
            self.extra = (constraints(scene, self.model, joints, tangents, method.projected, fast),)
        else:
            self.model, fast = model(scene)
            fast = fast and not jit_disabled()
        self.fast = fast
        self.begin = compiled(loop.begin) if fast else loop.begin
        self.state = start(scene, fast, *self.extra)
        # A portion keeps at most its steps, the given times, and the first and last state.
        self.recorder = Recorder(scene.n_q, len(self.state.impulse), kept, PORTION + len(kept.times) + 2)
        self.count = np.zeros(loop.N_COUNTERS, dtype=np.int64)
        size = max(
            np.max(np.abs(x), initial=0.0) for x in (self.state.q, self.model.offset, method.h * self.state.v)
        )
        self.slack = RESTING * float(size or 1.0)
        self.totals = {"steps": 0, "events": 0}

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        t_start, tolerance = self.scene.t_span[0], self.method.tolerance
        if tolerance is None:
            raise TypeError("tolerance: expected a number")
        try:
            side = start_side(self.scene, t_start)
            self.begin(self.model, self.state, self.recorder.buffers, self.count, t_start, side)
            status = self.adapted(tolerance, progress)
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED)) from None
        result = self.trajectory(status)
        if status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    def plan_for(self, h: float) -> loop.Plan:
        """What steps of size h multiply with."""
        return plan(self.model, h, self.method.theta, self.slack)

    def adapted(self, tolerance: float, progress: Callable[[float], None]) -> Status:
        """The whole run in steps that meet the tolerance."""
        method, span = self.method, self.scene.t_span
        control = adaptive.control(span, method.h, tolerance, 2 if method.theta == 0.5 else 1)
        self.plan = self.plan_for(adaptive.step_size(control, 0))
        constraints = self.extra[0] if self.extra else None
        steps = adaptive_moreau.Attempts(
            self.plan_for,
            self.model,
            self.state,
            self.recorder.buffers,
            self.count,
            control,
            constraints,
            self.fast,
        )

        def arrive() -> None:
            self.t0, self.first = float(adaptive.now(control)), int(self.count[loop.STEP])
            self.plan = self.plan._replace(h=adaptive.step_size(control, int(control.whole[adaptive.LEVEL])))
            self.empty()

        try:
            return STATUS[adaptive.advance(steps, control, arrive, progress)]
        except Exception as error:  # a callback in plain Python; compiled code raises nothing
            raise self.failed() from error

    def failed(self) -> SimulationError:
        """What an exception in plain Python makes of a run."""
        result = self.trajectory(Status.NOT_FINITE)
        return SimulationError(result.message, result)

    @property
    def active(self) -> list[int]:
        """Contacts that are active in the step at hand."""
        s = self.state
        return np.flatnonzero(s.g + 0.5 * self.plan.h * s.u <= self.plan.slack).tolist()

    @property
    def now(self) -> float:
        """Time of the current state [s]."""
        return self.t0 + self.plan.h * (int(self.count[loop.STEP]) - self.first)

    def empty(self) -> None:
        """Move what the kernel's buffers hold to the recorder's keeping."""
        rows, events = int(self.count[loop.ROW]), int(self.count[loop.EVENT])
        self.recorder.empty(rows, events)
        self.totals["events"] += events
        self.count[loop.ROW] = self.count[loop.EVENT] = 0

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        self.empty()
        kept = self.recorder.states()
        t, q, v, impulses = kept.t, kept.q, kept.v, kept.impulse
        if len(self.kept.times) == 0 and self.now > t[-1]:
            t, q, v = np.append(t, self.now), np.vstack([q, self.state.q]), np.vstack([v, self.state.v])
            impulses = np.vstack([impulses, self.state.impulse])
        if len(t) > 0 and abs(t[-1] - self.scene.t_span[1]) <= unresolved(self.scene.t_span, self.method.h):
            t[-1] = self.scene.t_span[1]
        n_c, count = self.scene.n_c, self.count
        impulse, friction, joint = np.split(impulses, [n_c, impulses.shape[1] - self.scene.n_j], axis=1)
        return Trajectory(
            scene=self.scene, method=self.method, t=t, q=q, v=v, impulse=impulse,
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=self.message(status),
            counts=Counts(
                steps=int(count[loop.STEP]), lcp_calls=int(count[loop.LCP_CALLS]),
                force_evaluations=int(count[loop.FORCES]), events=self.totals["events"],
            ),
            dense=self.between()(t, q, v, self.kept.all),
            joint_impulse=joint, friction_impulse=friction,
        )  # fmt: skip

    def between(self) -> Callable[..., interpolation.Between]:
        """How states between kept ones follow from them: long steps are parabolas."""
        adapted = self.method.tolerance is not None and adaptive_moreau.bending(self.method.theta) == 1.0
        return interpolation.Parabolic if adapted else interpolation.Linear

    def message(self, status: Status) -> str:
        """How the run ended, in words."""
        s = self.state
        if status == Status.DONE:
            return "reached the end of the span"
        where = f"at t = {self.now:.9g} s, q = {s.q.tolist()}, v = {s.v.tolist()}"
        step = f"in step {self.count[loop.STEP]}"
        if status == Status.INTERRUPTED:
            return f"interrupted {where}"
        if status == Status.LCP_FAILED:
            words = f"{self.method.lcp} found no solution for the contacts {self.active}"
            return f"{no_way_out(self.scene, self.now + self.plan.h, s.q, self.active) or words} {where}"
        if status == Status.JOINTS_FAILED:
            joints = np.flatnonzero(self.extra[0].failed).tolist()
            return f"joints {joints} contradict each other {step} {where}"
        if status == Status.PROJECTION_FAILED:
            return f"no position near satisfies all joints and contacts {step} {where}; try a smaller h"
        if status == Status.STEP_TOO_SMALL:
            return adaptive.too_small(self.method, self.scene, self.now, s.q, s.v, where)
        if status == Status.NEWTON_FAILED:
            return f"Newton's iteration did not converge within {loop.MAX_ITERATIONS} steps {where}; try a smaller h"
        return f"{culprit(self.scene, (self.now, self.now + self.plan.h), s.q, s.v)} {where}"


STATUS = {
    loop.FINISHED: Status.DONE,
    adaptive.TOO_SMALL: Status.STEP_TOO_SMALL,
    loop.NOT_FINITE: Status.NOT_FINITE,
    loop.LCP_FAILED: Status.LCP_FAILED,
    loop.NEWTON_FAILED: Status.NEWTON_FAILED,
    constrained.JOINTS_FAILED: Status.JOINTS_FAILED,
    constrained.PROJECTION_FAILED: Status.PROJECTION_FAILED,
}
