"""A run of `Located` by a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from lcpstep.stepping import adaptive
from lcpstep.stepping.located_by_tolerance import Attempts
from lcpstep.stepping.pieces.prepare import MANY_EXACTLY, plan
from lcpstep.stepping.pieces.run import STATUS, Array, Run
from lcpstep.stepping.pieces.state import Plan
from lcpstep.trajectory import Status


class AdaptedRun(Run):
    """One run; steps are those that its control chooses."""

    def even(self, progress: Callable[[float], None]) -> Status:
        """The whole run in steps that meet the tolerance; of one size where these make no error."""
        method, tolerance, p = self.method, cast(float, self.method.tolerance), self.steps.plan
        if p.plain and p.steady and tolerance >= adaptive.NOISE:
            return super().even(progress)
        self.steps.plan = Plan(p.fields | {"many": MANY_EXACTLY})
        span, order = self.scene.t_span, int(method.order)
        self.control = Attempts(self.steps, self.made, span, method.h, tolerance, order)
        self.work.events_left = method.max_events
        code = adaptive.run(self.control, self.scene.n_q + self.scene.n_c, self.arrive, progress)
        return Status.STEP_TOO_SMALL if code == adaptive.TOO_SMALL else STATUS[code]

    def made(self, h: float) -> Plan:
        """Constants of steps of size h."""
        return plan(self.scene, self.model, self.method, h)

    def arrive(self) -> None:
        """The loop has returned."""
        self.t0, self.first, self.steps.plan.h = self.control.time, self.work.steps, self.control.step
        self.empty()
        self.work.events_left = self.method.max_events - self.events

    def message(self, status: Status, t: float, q: Array, v: Array) -> str:
        """How the run ended with its last finite state, in words."""
        if status != Status.STEP_TOO_SMALL:
            return super().message(status, t, q, v)
        where = f"at t = {t:.9g} s, q = {q.tolist()}, v = {v.tolist()}"
        return adaptive.too_small(self.method, self.scene, t, q, v, where)
