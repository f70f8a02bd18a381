"""An impact of `Located`, as kernels: the impulses (`impulses`), and state and gaps made to agree after it."""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dynamics import external_force, product
from lcpstep.stepping.impulses import strike
from lcpstep.stepping.located_keep import keep
from lcpstep.stepping.located_work import (
    CHOSEN,
    CORNER,
    FINISHED,
    FORCE,
    FORCES,
    FREE,
    GAP,
    GROUND,
    GROUNDED,
    LCP_FAILED,
    NOT_FINITE,
    OPEN,
    RATE,
    ROUNDING,
    SIGMA,
    STATUS,
    Q,
    V,
)
from lcpstep.stepping.magnitudes import speed_terms
from lcpstep.stepping.smooth import (
    free_acceleration,
    lift,
    refactor,
    respond,
    within,
)
from lcpstep.stepping.switches import idle, stick, turn


def event(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, c: int, count: Any) -> int:
    """The impact of contact c at x[SIGMA], or that of a corner, and what it changes."""
    now = t + x[SIGMA]
    if c != CORNER and w.num[RATE, c] >= -ROUNDING * speed_terms(plan, w, c):  # a touch: it does not strike
        w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, GROUND
        if w.num[RATE, c] <= ROUNDING * speed_terms(plan, w, c):
            stick(w, record, count, x, c, now)
            turn(m, plan, w, x, c, 0.0, False)
        idle(x, count)
        return FINISHED
    if not plan.constant:
        if not refactor(m, w, now):
            return NOT_FINITE
        respond(m, w)
    n_s = strike(m, plan, w, x, record, c, now, count)
    if n_s <= 0:
        idle(x, count)
        return LCP_FAILED if n_s < 0 else FINISHED
    if plan.plain:  # rounding of the state must not add up over many impacts
        for k in range(n_s):
            d = w.mark[CHOSEN, k]
            lift(m, plan, w, w.vec[Q], d, -height(m, w, d))
            straighten(m, plan, w, d)
    if plan.trapezoidal and not plan.steady:
        external_force(m, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FORCE])
        count[FORCES] += 1
    elif not plan.trapezoidal:
        if not free_acceleration(m, w, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FREE]):
            return NOT_FINITE
        count[FORCES] += 1
    if record.on_events or record.every == 1:
        keep(w, record, count, now, 1.0)
    return FINISHED


def straighten(m: Any, plan: Any, w: Any, d: int) -> None:
    """The velocities that gap d has left with, and the gap velocities of the contacts in flight that go with them.

    Without the latter the rounding of the Delassus matrix acts the same way at every impact: at a mass ratio of 1e12
    it turns the motion by a ten-thousandth. Gap velocities finer than the velocities resolve stay as they are.
    """
    error = w.num[RATE, d] - product(m.G, w.vec[V], d)
    if error == 0.0 or not w.W[d, d] > 0.0:
        return
    lift(m, plan, w, w.vec[V], d, error)
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == OPEN and w.mark[GROUNDED, c] == 0:
            change = w.W[c, d] * error / w.W[d, d]
            if abs(change) <= ROUNDING * abs(w.num[RATE, c]):
                w.num[RATE, c] += change


@inline
def height(m: Any, w: Any, c: int) -> float:
    """The gap c of a flat contact at rest, from the coordinates."""
    return product(m.G, w.vec[Q], c) + m.offset[c]
