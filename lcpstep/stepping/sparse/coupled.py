"""Steps of large sparse systems that have joints or friction: the law of `theta_method.theta_step`, on whole vectors.

    x = v+ - v_free,    v_free = v + A^-1 r,    and the problem of `coulomb` with the rates at v_free

The rows of joints that turn are taken at the end of the step, which is iterated for; their force acts along the mean
of its two ends. Rates that are nothing but rounding, restitution on the tangent, and velocities that are rounding are
treated as there (`theta_method.row_impulses`), so that both kinds of steps give the same motion.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Joints, Scene
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.recording import Kept
from lcpstep.stepping.sparse.blows import Blows
from lcpstep.stepping.sparse.coulomb import STICK, Coupled, Point, Problem
from lcpstep.stepping.sparse.equations import Equations, JointRows, Step
from lcpstep.stepping.sparse.steps import SparseRun
from lcpstep.stepping.sparse.stiction import Stiction
from lcpstep.stepping.steps import CANCELLED, CONTRADICTION, CONVERGED, NO_APPROACH, ROUNDING
from lcpstep.stepping.theta_method.codes import MAX_ITERATIONS
from lcpstep.trajectory import Status

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
FEW = 200  # as of `steps`


class Before(NamedTuple):
    """Before a blow: the velocity, with all that forces do in the step; gap velocities; sliding velocities."""

    v: Array
    u: Array
    sliding: Array


class CoupledStep(Step):
    """Steps of one size h: A, and its matrix with those of the joints and contacts."""

    def __init__(self, equations: Equations, h: float, theta: float, T: Any, J: Any) -> None:
        super().__init__(equations, h, theta)
        self.coupled = Coupled(self.saddle.A, equations.G, T, J)


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
        self.T, self.frictional = T, friction is not None
        self.joints, self.modes = JointRows(scene), np.zeros(n_c, dtype=np.int64)
        self.rows_p, self.of_joints = np.zeros(scene.n_j + 2 * n_c), np.zeros(n_c, dtype=bool)
        super().__init__(method, scene, kept)

    def plan_for(self, h: float) -> CoupledStep:
        """What steps of size h multiply with."""
        data, _ = self.joints.at(self.now, self.q, self.v)
        return CoupledStep(self.equations, h, self.method.theta, self.T, self.joints.matrix(data))

    def velocity(
        self, step: Any, r: Array, active: Any, s_t: Array, t: float, t_next: float
    ) -> tuple[Array, Status]:
        """Velocity at the end of the step, the impulses found and added up; and how that went."""
        J_start, _ = self.joints.at(t, self.q, self.v)
        closed, active = active, self.bearing(step, active, J_start)
        free = step.saddle.free(r)  # change of the velocity without contact
        v_free = self.v + free
        rough, sliding = active & self.stiction.rough, self.T @ self.v + self.stiction.slip(t)
        if rough.any() and not self.stiction.measure(t, self.q, sliding):
            return self.v, Status.NOT_FINITE
        slip = self.stiction.slip(t_next)
        slow = self.slow(step, free, active, s_t)
        modes, p = np.where(active & ~self.active, STICK, self.modes), self.rows_p
        v, speed, restitution = self.v, np.max(np.abs(v_free)), self.equations.restitution
        for _ in range(MAX_ITERATIONS):
            q = self.q + step.h * (step.theta * v + (1.0 - step.theta) * self.v)
            data, J_t = self.joints.at(t_next, q, v)
            if self.joints.turning:
                step.coupled.turn(data, step.theta * data + (1.0 - step.theta) * J_start)
            before = v
            known = Before(v_free, self.u, sliding), (J_t, s_t, slip)
            point, status = self.strike(step, Blows(active, slow, restitution), *known, modes, p)
            if status != Status.DONE:
                return v, status
            modes, p = point.modes, point.p
            terms = np.abs(v_free) + point.size_x / step.coupled.diagonal
            v = v_free + point.x
            v[np.abs(v) <= np.maximum(ROUNDING * terms, RESOLUTION * speed)] = 0.0
            scale = max(np.max(np.abs(v)), np.max(np.abs(self.v)), CANCELLED * np.max(terms))
            if not self.joints.turning or np.max(np.abs(v - before)) <= CONVERGED * scale:
                break
        else:
            return v, Status.NEWTON_FAILED
        most = max(np.max(np.abs(v)), speed, np.max(np.abs(self.v)))
        granted = (np.abs(data - J_start).max(initial=0.0) * most) ** 2  # what joints turn by
        idle, left = closed & self.of_joints, self.missed(step.coupled, v, J_t, s_t, most)
        if np.any(left[: self.joints.n] > granted):
            return v, Status.JOINTS_FAILED
        if np.any(left[self.joints.n :][idle] > granted):
            return v, Status.LCP_FAILED
        problem, strikes = self.problem(step, active, *known, Blows(active, slow, restitution))
        rebound = np.any(strikes) * self.tangent_restitution * sliding
        self.stiction.note(step.coupled, problem, point, self.T @ v + slip, rebound)
        self.modes, self.active = modes, active
        p_J, p_N, p_T = np.split(p, (self.joints.n, self.joints.n + len(s_t)))
        self.rows_p, self.p = p, np.maximum(p_N, 0.0)
        self.impulse += np.concatenate([self.p, *([p_T] if self.frictional else []), p_J])
        return v, Status.DONE

    def missed(self, coupled: Coupled, v: Array, J_t: Array, s_t: Array, speed: float) -> Array:
        """By how much joints move, and contacts enter, more than contradictions let rows do at up to this speed."""
        rates = (coupled.R @ v)[: self.joints.n + len(s_t)] + np.append(J_t, -s_t)
        rates = np.append(np.abs(rates[: self.joints.n]), -rates[self.joints.n :])
        terms = (coupled.abs_R @ np.ones(len(v)))[: len(rates)]
        return rates - CONTRADICTION * (np.append(np.abs(J_t), np.abs(s_t)) + speed * terms)

    def bearing(self, step: Any, active: Any, J: Array) -> Any:
        """The active contacts but those whose normals the joints hold: these bear nothing, and have no friction.

        Joints that turn seldom come to hold a contact's normal: looked for at the start, and while they do.
        """
        known = self.steps > 0 and not (self.joints.turning and self.of_joints.any())
        if self.joints.n > 0 and not known:
            step.coupled.turn(J, J)
            self.of_joints = step.coupled.of_joints()
        return active & ~self.of_joints

    def strike(
        self, step: Any, blows: Blows, before: Before, rest: tuple[Array, Array, Array], modes: Any, p: Array
    ) -> tuple[Point, Status]:
        """Impulses of all blows of the step together, and the change of the velocity that they make."""
        whole: Any = None
        while blows.follows(before.u):
            problem, strikes = self.problem(step, blows.chosen, before, rest, blows)
            if not np.all(np.isfinite(problem.b)):
                return whole, Status.NOT_FINITE
            self.problems += bool(blows.chosen.any())
            point = self.stiction.solve(step.coupled, problem, modes, p, before.sliding, strikes)
            if not point.solved:
                return point, Status.JOINTS_FAILED if point.joints > CONTRADICTION else Status.LCP_FAILED
            modes, p, v = point.modes, point.p, before.v + point.x
            before = Before(v, self.equations.G_rows.times(v) - rest[1], self.T @ v + rest[2])
            if whole is not None:
                x, p_all, size_x = whole.x + point.x, whole.p + point.p, whole.size_x + point.size_x
                point = point._replace(x=x, p=p_all, size_x=size_x)
            whole = point
        return whole, Status.DONE

    def problem(
        self, step: Any, active: Any, before: Before, rest: tuple[Array, Array, Array], blows: Blows
    ) -> tuple[Problem, Any]:
        """The problem of a blow; which contacts strike. `rest`: rates of joints, normals and tangents at v = 0."""
        J_t, s_t, slip = rest
        speeds, known = np.abs(before.v), np.concatenate([J_t, -s_t, slip])
        b, size = step.coupled.R @ before.v + known, step.coupled.abs_R @ speeds + np.abs(known)
        strikes = self.add_rebounds(step, before, active, b[self.joints.n :], size[self.joints.n :], blows)
        rough = active & self.stiction.rough
        return Problem(b, size, active, rough, self.stiction.mu, np.max(speeds)), strikes

    def add_rebounds(
        self, step: Any, before: Before, active: Any, b: Array, sizes: Array, blows: Blows
    ) -> Any:
        """Add what restitution does to the rates b (2 n_c,) of normals and tangents, and to the sizes of their terms.

        Which contacts strike: that is asked where there is friction; without it no law depends on it.
        """
        u, rough = before.u, active & self.stiction.rough
        if rough.any():
            b[~(np.abs(b) > NO_APPROACH * sizes)] = 0.0
        slow = np.abs(b[: len(u)] - u) + ROUNDING * step.steepest * np.max(np.abs(self.v))
        strikes = active & (u < -slow) & rough.any()
        bounces = np.any(strikes) and not blows.last
        tangents = bounces * self.tangent_restitution * before.sliding
        added = np.concatenate([blows.rebound(u, self.equations.restitution), tangents])
        b += added
        sizes += np.abs(added)
        return strikes

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
