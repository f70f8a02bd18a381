"""A run of `Moreau` by a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

import numpy as np

from lcpstep.model import Model
from lcpstep.stepping import adaptive, interpolation, theta
from lcpstep.stepping.moreau_by_tolerance import Attempts
from lcpstep.stepping.moreau_run import Array, Run
from lcpstep.trajectory import Status


class AdaptedRun(Run):
    """One run; steps are those that its control chooses."""

    def advance(self, progress: Callable[[float], None]) -> Status:
        """The whole run in steps that meet the tolerance."""
        method, span, order = self.method, self.scene.t_span, 2 if self.method.theta == 0.5 else 1
        self.control = Attempts(
            self.model, self.plan, self.state, self.rows, self.recorder.record, self.plan_for,
            span, method.h, cast(float, method.tolerance), order,
        )  # fmt: skip
        code = adaptive.run(self.control, self.scene.n_q + self.rows.n, self.arrive, progress)
        return Status.STEP_TOO_SMALL if code == adaptive.TOO_SMALL else Status(code)

    def arrive(self) -> None:
        """The loop has returned."""
        self.t0, self.first, self.plan.h = self.control.time, self.state.steps, self.control.step
        self.empty()

    def between(self, t: Array, q: Array, v: Array) -> interpolation.Between:
        """How states between kept ones follow from them: long steps are parabolas."""
        if self.method.theta == 0.5:
            return interpolation.Parabolic(t, q, v, self.kept.all)
        return super().between(t, q, v)

    def message(self, status: Status) -> str:
        """How the run ended, in words."""
        if status != Status.STEP_TOO_SMALL:
            return super().message(status)
        x, now = self.state.arrays, self.now
        where = f"at t = {now:.9g} s, q = {x['q'].tolist()}, v = {x['v'].tolist()}"
        return adaptive.too_small(self.method, self.scene, now, x["q"], x["v"], where)


def plan(m: Model, h: float, theta_: float, slack: float) -> theta.Plan:
    """What steps of size h multiply with, for the kernels of `maps.lockstep`."""
    n_q, n_c = m.G.shape[1], m.G.shape[0]
    A = m.M + h * theta_ * m.C + (h * theta_) ** 2 * m.K
    inverse = np.asarray(np.linalg.inv(A) if m.linear else np.zeros((n_q, n_q)), dtype=np.float64)
    A_g = inverse @ m.G.T
    return theta.Plan(
        h=h, theta=theta_, A_q=h * inverse @ m.K, A_v=inverse @ (h * m.C + h * h * theta_ * m.K), A_f=h * inverse,
        A_g=np.ascontiguousarray(A_g).reshape(n_q, n_c), W=m.G @ A_g, slack=slack,
    )  # fmt: skip
