"""A run of `Moreau`, from a scene to a trajectory.

The loop over steps is a kernel (`theta_method.theta_loop`); this file prepares what it works in, hands
complementarity problems to an outside solver where one is named, and says in words why a run ended early.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.gaps import no_way_out
from lcpstep.kernels.clock import Clock
from lcpstep.kernels.coulomb import ContactProblem
from lcpstep.kernels.model import Model
from lcpstep.model import coefficients, models
from lcpstep.recording import Kept, Recorder, States
from lcpstep.stepping import interpolation
from lcpstep.stepping.by_tolerance.moreau import Attempts
from lcpstep.stepping.extent import is_stiff, own_places, places, ways
from lcpstep.stepping.step_run import StepRun
from lcpstep.stepping.steps import RESTING, implicit_mass, inverse, number, start_side
from lcpstep.stepping.theta_method import theta_loop as loop
from lcpstep.stepping.theta_method.codes import MAX_ITERATIONS, NEED_LCP
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.responses import constant_rows
from lcpstep.trajectory import Counts, Status
from lcpstep.turns import turns

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
PORTION = 65536  # steps between two looks at the outside world, at most


class MoreauRun(StepRun):
    """One run: what the kernels work in."""

    def __init__(self, method: Moreau, scene: Scene, kept: Kept) -> None:
        self.model, joints, tangents = models(scene)
        self.rows = rows(scene, joints, tangents, method.projected, method.lcp != "lemke")
        flat = self.model.flat and joints.flat and tangents.flat
        self.constant = flat and self.model.linear and not method.projected
        self.motion = State(scene.q0, scene.v0, scene.n_c, self.rows.n)
        expected = kept.of_steps(number(scene.t_span, method.h)) if method.tolerance is None else None
        recorder = Recorder(scene.n_q, self.rows.n, kept, expected=expected)
        super().__init__(method, scene, kept, recorder, PORTION)
        self.impulse = self.motion.arrays["impulse"]
        self.slack = RESTING * (places(self.model, scene.q0, scene.v0, method.h) or 1.0)
        own = self.motion.arrays["slack"]
        own_places(self.model.arrays["offset"], ways(self.model, scene.q0, scene.v0, method.h), own)
        own *= RESTING
        made = self.plan_for(self.stretches[0][0])
        self.motion.record = recorder.record
        self.loop = loop.Steps(self.model, made, self.motion, self.rows)

    def begin(self) -> int:
        """The initial state; a code."""
        t = self.scene.t_span[0]
        self.loop.begin(t, start_side(self.scene, t), self.method.tolerance is None)
        if self.method.tolerance is not None:
            order, tolerance = 2 if self.method.theta == 0.5 else 1, self.method.tolerance
            span, h = self.scene.t_span, self.method.h
            clock = Clock(span, turns(self.scene, with_belts=True).stops, self.scene.period)
            self.controlled_by(
                Attempts(self.loop, lambda h: self.plan_for(h).matrices, clock, span, h, tolerance, order)
            )
        return Status.DONE

    def take(self, last: int) -> int:
        """Steps up to the one before `last`; why the kernel returned."""
        code = NEED_LCP
        while code == NEED_LCP:
            code = self.loop.run(self.t0, self.first, last)
            self.rows.solved = code == NEED_LCP and self.solve_outside()
            if code == NEED_LCP and not self.rows.solved:
                return Status.LCP_FAILED
        return int(code)

    def plan_for(self, h: float) -> Plan:
        """What steps of size h multiply with."""
        made = plan(self.model, self.rows, h, self.method.theta, self.slack, self.constant)
        if self.constant and self.rows.n > self.rows.n_c:
            constant_rows(self.model, made, self.motion, self.rows, self.scene.t_span[0])
        return made

    def solve_outside(self) -> bool:
        """Hand the problem at hand to the named solver; whether it was solved."""
        from lcpstep.lcp import solve_lcp

        arrays, n = self.rows.problem.arrays, len(self.active)
        W, b = arrays["mobility"][: n * n].reshape(n, n), arrays["rate"][:n]
        solution = solve_lcp(W, b, method=self.method.lcp)
        arrays["impulse"][:n] = solution.z
        return bool(solution.solved)

    @property
    def active(self) -> list[int]:
        """Contacts that are active in the step at hand."""
        return [int(c) for c in self.rows.problem.lists[0][: self.motion.active]]

    @property
    def now(self) -> float:
        """Time of the current state [s]."""
        return self.t0 + self.plan.h * (self.steps - self.first)

    @property
    def steps(self) -> int:
        """Steps taken."""
        return int(self.motion.steps)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.motion.arrays["q"], self.motion.arrays["v"]

    @property
    def counts(self) -> Counts:
        """Work done."""
        s = self.motion
        return Counts(s.steps, s.problems, s.forces, self.recorder.taken)

    def dense(self, s: States) -> interpolation.Between:
        """How states between kept ones follow from them."""
        if self.control is not None and self.method.theta == 0.5:  # long steps are parabolas
            return interpolation.Parabolic(s.t, s.q, s.v, self.kept.all)
        return interpolation.Linear(s.t, s.q, s.v, self.kept.all)

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == Status.LCP_FAILED:
            words = f"{self.method.lcp} found no solution for the contacts {self.active}"
            q = self.state[0]
            return f"{no_way_out(self.scene, self.now + self.plan.h, q, self.active) or words} {self.where}"
        if code == Status.JOINTS_FAILED:
            joints = np.flatnonzero(self.rows.arrays["failed"]).tolist()
            return f"joints {joints} contradict each other in step {self.steps} {self.where}"
        if code == Status.PROJECTION_FAILED:
            words = f"no position near satisfies all joints and contacts in step {self.steps}"
            return f"{words} {self.where}; try a smaller h"
        if code == Status.NEWTON_FAILED:
            words = f"Newton's iteration did not converge within {MAX_ITERATIONS} steps"
            return f"{words} {self.where}; try a smaller h"
        if code == Status.NOT_FINITE and self.rows.coefficients.fault():
            return f"{self.rows.coefficients.fault()} {self.where}"
        return super().why(code)


def rows(scene: Scene, joints: Model, tangents: Model, projected: bool, external: bool) -> Rows:
    """Joints and tangents of a scene, with the rows of a step."""
    n_c, contacts, r_T = scene.n_c, scene.contacts, np.zeros(scene.n_c)
    in_turn = False
    friction = None if contacts is None else contacts.friction
    if contacts is not None and friction is not None:
        r_T, in_turn = friction.tangential(contacts.restitution), friction.law == "stronge"
    n = n_c + tangents.n_c + joints.n_c
    warm = n == n_c and not projected
    problem = ContactProblem(np.zeros(n_c), friction is not None, n, warm)
    bodies = joints, tangents, n_c, tangents.n_c
    return Rows(*bodies, coefficients(scene), r_T, in_turn, projected, external, problem)


def plan(m: Model, c: Rows, h: float, theta: float, slack: float, constant: bool) -> Plan:
    """What steps of size h multiply with: A = M + h theta C + h^2 theta^2 K, inverted once.

    X and W are those of the contacts; with tangents or joints, or where they change, there is but room for them.
    """
    M, C, K, G = m.arrays["M"], m.arrays["C"], m.arrays["K"], m.arrays["G"]
    if stiff := is_stiff(m):
        A_inverse: Any = inverse(implicit_mass(M, C, K, h * theta))
        A_f = h * A_inverse
        A_q, A_v = A_f.dot(K), A_inverse.dot(h * C + h * h * theta * K)
    else:
        A_inverse = m.arrays["M_inverse"] if m.linear else np.zeros(M.shape)
        A_f = h * A_inverse
        A_q = A_v = np.zeros(M.shape)
    if c.n == m.n_c:
        A_g = A_inverse.dot(G.T)  # of small matrices a third of the time of `@`
        X, W = A_g.T, G.dot(A_g)
    else:
        X, W = np.zeros((c.n, m.n_q)), np.zeros((c.n, c.n))
    return Plan(h, theta, slack, constant, stiff, {"A_q": A_q, "A_v": A_v, "A_f": A_f, "X": X, "W": W})
