"""Steps of the Runge-Kutta method DOP853 with the right-hand side of one contact, as kernels; see `dop853`."""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign
from lcpstep.events.bookkeeping import FORCES, NOT_FINITE, STEP_TOO_SMALL
from lcpstep.events.clock import RESOLUTION, T0
from lcpstep.events.contact import NOW
from lcpstep.events.dop853 import (
    EXTRA_STAGES,
    LEAST,
    STAGES,
    combine,
    dense_error,
    error_norm,
    factor,
    interpolant,
    refuse,
    repeats,
)
from lcpstep.events.single.equations import LENGTH, NEXT_STEP, right_hand_side
from lcpstep.events.single.motion import contact_at

REFINEMENTS = 4  # of an event's time by repeated Runge-Kutta steps


def take_step(s: Any, count: Any, longest: float) -> float:
    """DOP853 step no longer than `longest` that meets the tolerance; its size, or minus the reason of failure."""
    h = min(s.x[NEXT_STEP], longest)
    truncated, first = h < s.x[NEXT_STEP], True
    while True:
        if not rk_step(s, s.x[NOW], h):
            return -float(NOT_FINITE)
        count[FORCES] += STAGES + 1
        if not first and not repeats(s.w, h, s.plan.rtol, s.plan.atol):
            return -float(STEP_TOO_SMALL)
        error = error_norm(s.w, h, s.plan.rtol, s.plan.atol)
        if error - error != 0.0:
            return -float(NOT_FINITE)
        if error <= 1.0:
            if not rk_dense(s, s.x[NOW], h):
                return -float(NOT_FINITE)
            count[FORCES] += EXTRA_STAGES
            error = max(error, dense_error(s.w, h, s.plan.rtol, s.plan.atol))
        if error <= 1.0:
            break
        h *= max(LEAST, factor(error))
        truncated = first = False
        smallest = 4.0 * RESOLUTION * max(abs(s.x[NOW]), s.plan.scan)
        if not refuse(s.w, s.x[NOW], s.plan.scan) or h <= smallest:
            return -float(STEP_TOO_SMALL)
    s.x[NEXT_STEP] = max(h * factor(error), s.x[NEXT_STEP] if truncated else 0.0)
    return h


def rk_step(s: Any, t: float, h: float) -> bool:
    """DOP853 step of size h from s.w.y to s.w.y_new."""
    if not right_hand_side(s, t, s.w.y, s.w.K[0]):
        return False
    if not stages(s, t, h, 1, STAGES):
        return False
    combine(s.w, h, STAGES)
    assign(s.w.y_new, s.w.y_stage)
    return right_hand_side(s, t + h, s.w.y_new, s.w.K[STAGES])


def rk_dense(s: Any, t: float, h: float) -> bool:
    """Dense output of the step that `rk_step` has just made."""
    if not stages(s, t, h, STAGES + 1, STAGES + 1 + EXTRA_STAGES):
        return False
    interpolant(s.w, h)
    s.x[LENGTH] = h
    return True


def stages(s: Any, t: float, h: float, first: int, end: int) -> bool:
    """Stages first .. end - 1 of a step."""
    for stage in range(first, end):
        combine(s.w, h, stage)
        if not right_hand_side(s, t + s.w.tab.C[stage] * h, s.w.y_stage, s.w.K[stage]):
            return False
    return True


def shorten(s: Any, tau: float) -> None:
    """Repeat the step with the size tau, so that its end has the accuracy of a step and not of dense output."""
    rk_step(s, s.x[T0], tau)
    rk_dense(s, s.x[T0], tau)


def refine_contact(s: Any, tau: float) -> float:
    """Time of the contact found on the dense output, corrected on steps that end there."""
    for _ in range(REFINEMENTS):
        shorten(s, tau)
        g, u, _ = contact_at(s, tau)
        correction = -g / u if u < 0.0 else 0.0
        if abs(correction) <= 2.0 * RESOLUTION * (s.x[T0] + tau) or abs(correction) > 1e-3 * tau:
            break
        tau += correction
    return tau
