"""Steps of large sparse systems that have joints or friction: the law of `theta_method.theta_step`, on whole vectors.

    x = v+ - v_free,    v_free = v + A^-1 r,    and the problem of `sparse_coulomb` with the rates at v_free

The rows of joints that turn are taken at the end of the step, which is iterated for; their force acts along the mean
of its two ends. Rates that are nothing but rounding, restitution on the tangent, and velocities that are rounding are
treated as there (`theta_method.row_impulses`), so that both kinds of steps give the same motion.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Joints, Scene
from lcpstep.lcp.factor import factoriser
from lcpstep.recording import Kept
from lcpstep.stepping.sparse import SparseRun
from lcpstep.stepping.sparse_coulomb import CONTRADICTION, STICK, Coupled, Problem
from lcpstep.stepping.sparse_equations import Equations, JointRows, Step
from lcpstep.stepping.sparse_stiction import Stiction
from lcpstep.stepping.theta_method.codes import MAX_ITERATIONS
from lcpstep.trajectory import Status

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
FEW = 200  # coordinates up to which dense steps are fast enough, and know more
CONVERGED = 1e-12  # change of the velocity, relative to it; this and the next three: `row_impulses`
CANCELLED = 0.1
ROUNDING = 1e-13
NO_APPROACH = 1e-11
EPSILON = float(np.finfo(float).eps)


class CoupledStep(Step):
    """Steps of one size h: A factorised once, and its matrix with those of the joints and contacts."""

    def __init__(self, equations: Equations, h: float, theta: float, T: Any, J: Any) -> None:
        super().__init__(equations, h, theta)
        A = self.saddle.A
        self.A_solve = factoriser(A).factor(np.ones(A.shape[0], dtype=bool), np.zeros(A.shape[0]))
        self.coupled = Coupled(A, equations.G, T, J)


class CoupledRun(SparseRun):
    """One run of a sparse scene with joints or friction."""

    def __init__(self, method: Moreau, scene: Scene, kept: Kept) -> None:
        from scipy.sparse import csr_array

        n_c, contacts, T = scene.n_c, scene.contacts, csr_array((scene.n_c, scene.n_q))
        friction = None if contacts is None else contacts.friction
        self.stiction, self.tangent_restitution = Stiction(scene, friction), np.zeros(n_c)
        if contacts is not None and friction is not None:
            given: Any = friction.tangent
            T = csr_array(given)
            self.tangent_restitution = friction.tangential(contacts.restitution)
        self.T, self.abs_T, self.frictional = T, abs(T), friction is not None
        self.joints, self.modes = JointRows(scene), np.zeros(n_c, dtype=np.int64)
        self.rows_p = np.zeros(scene.n_j + 2 * n_c)
        super().__init__(method, scene, kept)

    def plan_for(self, h: float) -> CoupledStep:
        """What steps of size h multiply with."""
        data, _ = self.joints.at(self.t, self.q, self.v)
        return CoupledStep(self.equations, h, self.method.theta, self.T, self.joints.matrix(data))

    def velocity(
        self, step: Any, r: Array, active: Any, s_t: Array, t: float, t_next: float
    ) -> tuple[Array, Status]:
        """Velocity at the end of the step, the impulses found and added up; and how that went."""
        v_free = self.v + step.A_solve(r)
        rough, sliding = active & self.stiction.rough, self.T @ self.v + self.stiction.slip(t)
        if rough.any() and not self.stiction.measure(t, self.q, sliding):
            return self.v, Status.NOT_FINITE
        slip = self.stiction.slip(t_next)
        rates, sizes, impact = self.rates(step, v_free, active, s_t, sliding, slip)
        modes, p = np.where(active & ~self.active, STICK, self.modes), self.rows_p
        J_start, _ = self.joints.at(t, self.q, self.v)
        v, speeds = self.v, np.abs(v_free)
        for _ in range(MAX_ITERATIONS):
            q = self.q + step.h * (step.theta * v + (1.0 - step.theta) * self.v)
            data, J_t = self.joints.at(t_next, q, v)
            if self.joints.turning:
                step.coupled.turn(data, step.theta * data + (1.0 - step.theta) * J_start)
            J = step.coupled.R[: self.joints.n]
            b, size = np.append(J @ v_free + J_t, rates), np.append(abs(J) @ speeds + np.abs(J_t), sizes)
            if not np.all(np.isfinite(b)):
                return v, Status.NOT_FINITE
            self.problems += bool(active.any())
            problem = Problem(b, size, active, rough, self.stiction.mu, np.max(speeds))
            point = self.stiction.solve(step.coupled, problem, modes, p, sliding, impact)
            if not point.solved:
                return v, Status.JOINTS_FAILED if point.joints > CONTRADICTION else Status.LCP_FAILED
            modes, p, before = point.modes, point.p, v
            terms = np.abs(v_free) + point.size_x / step.coupled.diagonal
            v = v_free + point.x
            v[np.abs(v) <= np.maximum(ROUNDING * terms, EPSILON * problem.speed)] = 0.0
            scale = max(np.max(np.abs(v)), np.max(np.abs(self.v)), CANCELLED * np.max(terms))
            if not self.joints.turning or np.max(np.abs(v - before)) <= CONVERGED * scale:
                break
        else:
            return v, Status.NEWTON_FAILED
        most = max(np.max(np.abs(v)), problem.speed, np.max(np.abs(self.v)))
        left = np.abs(J @ v + J_t) - CONTRADICTION * (np.abs(J_t) + most * (abs(J) @ np.ones(len(v))))
        if np.any(
            left > (np.abs(data - J_start).max(initial=0.0) * most) ** 2
        ):  # what joints turn by is granted
            return v, Status.JOINTS_FAILED
        rebound = impact * self.tangent_restitution * sliding
        self.stiction.note(step.coupled, problem, point, self.T @ v + slip, rebound)
        self.modes, self.active = modes, active
        p_J, p_N, p_T = np.split(p, (self.joints.n, self.joints.n + len(s_t)))
        self.rows_p, self.p = p, np.maximum(p_N, 0.0)
        self.impulse += np.concatenate([self.p, *([p_T] if self.frictional else []), p_J])
        return v, Status.DONE

    def rates(
        self, step: Any, v_free: Array, active: Any, s_t: Array, sliding: Array, slip: Array
    ) -> tuple[Array, Array, bool]:
        """Rates of normals and tangents at v_free with what restitution adds, sizes of terms; is there an impact?

        sliding, slip : (n_c,)   sliding velocities at the start of the step, and those of v = 0 at its end
        """
        e, speeds, rough = self.equations, np.abs(v_free), active & self.stiction.rough
        b = [e.G @ v_free - s_t, self.T @ v_free + slip]
        sizes = [step.saddle.abs_G @ speeds + np.abs(s_t), self.abs_T @ speeds + np.abs(slip)]
        if rough.any():
            b = [np.where(np.abs(x) > NO_APPROACH * size, x, 0.0) for x, size in zip(b, sizes, strict=True)]
        largest = step.saddle.abs_G.max(axis=1).toarray().ravel() if len(s_t) else s_t
        slow = np.abs(b[0] - self.u) + ROUNDING * largest * np.max(np.abs(self.v))
        impact = bool(rough.any() and np.any(active & (self.u < -slow)))
        added = np.concatenate([e.restitution * self.u, impact * self.tangent_restitution * sliding])
        return np.concatenate(b) + added, np.concatenate(sizes) + np.abs(added), impact

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == Status.JOINTS_FAILED:
            return (
                f"joints contradict each other, or say nearly the same thing twice, {self.where}; "
                f"dense matrices take joints of which some say the same"
            )
        if code == Status.NEWTON_FAILED:
            return f"the joints' rows did not converge within {MAX_ITERATIONS} steps {self.where}; try a smaller h"
        if code == Status.NOT_FINITE and self.stiction.kernel.fault():
            return f"{self.stiction.kernel.fault()} {self.where}"
        return super().why(code)


def unknown(scene: Scene) -> str:
    """What these steps do not know of a sparse scene's joints and friction, as in `lcpstep.refusals`; "" if all."""
    joints, contacts = scene.joints, scene.contacts
    friction = None if contacts is None else contacts.friction
    if friction is not None and friction.law == "stronge":
        return "sparse-stronge"
    if friction is not None and callable(friction.tangent):
        return "sparse-tangents"
    return "sparse-joints" if isinstance(joints, Joints) and joints.pattern is None else ""


def takes(scene: Scene) -> bool:
    """Whether a sparse scene is large, and its joints and its friction are of the kind that these steps know."""
    return scene.n_q > FEW and not unknown(scene)
