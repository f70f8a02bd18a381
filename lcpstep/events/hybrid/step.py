"""Steps of the Runge-Kutta method DOP853 in the mode at hand, as kernels; see `dop853`."""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign
from lcpstep.events.dop853 import (
    EXTRA_STAGES,
    LEAST,
    STAGES,
    combine,
    error_norm,
    factor,
    interpolant,
    refuse,
    repeats,
)
from lcpstep.events.hybrid.field import RESOLUTION, field
from lcpstep.events.hybrid.state import FORCES, MODE, NEXT, NOT_FINITE, NOW, STEP_TOO_SMALL


def take_step(s: Any, h: float) -> float:
    """Step of size h, or less, that meets the tolerance; its size, or minus the reason of failure."""
    w, flow, t, again = s.w, s.flow, s.x[NOW], False
    while True:
        if not h > 4.0 * RESOLUTION * abs(t) and h < flow.t_end - t:
            return -float(STEP_TOO_SMALL)
        good = step(s, h)
        s.count[FORCES] += STAGES
        if good and again and not repeats(w, h, flow.rtol, flow.atol):
            return -float(STEP_TOO_SMALL)
        error = error_norm(w, h, flow.rtol, flow.atol) if good else 1e30
        if error < 1.0:
            break
        if not good and h < 1e-12 * (flow.t_end - t):
            return -float(NOT_FINITE)
        again = good
        if not refuse(w, t, flow.longest):
            return -float(STEP_TOO_SMALL)
        h *= max(LEAST, min(1.0, factor(error)))
    s.x[NEXT] = h * factor(error)
    complete(s, h)
    return h


def step(s: Any, h: float) -> bool:
    """DOP853 step from w.y to w.y_new; False where the field is not finite."""
    m, w, mode, t = s.m, s.w, s.count[MODE], s.x[NOW]
    field(m, mode, t, w.y, w.K[0])
    for stage in range(1, STAGES):
        combine(w, h, stage)
        field(m, mode, t + w.tab.C[stage] * h, w.y_stage, w.K[stage])
    combine(w, h, STAGES)
    assign(w.y_new, w.y_stage)
    field(m, mode, t + h, w.y_new, w.K[STAGES])
    total = 0.0
    for i in range(len(w.y)):
        total += w.y_new[i] + w.K[STAGES, i]
    return total - total == 0.0


def complete(s: Any, h: float) -> None:
    """Dense output of a step."""
    m, w, mode, t = s.m, s.w, s.count[MODE], s.x[NOW]
    for stage in range(STAGES + 1, STAGES + 1 + EXTRA_STAGES):
        combine(w, h, stage)
        field(m, mode, t + w.tab.C[stage] * h, w.y_stage, w.K[stage])
    interpolant(w, h)
