"""A run of `Moreau` by a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from lcpstep.stepping import adaptive, interpolation
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
