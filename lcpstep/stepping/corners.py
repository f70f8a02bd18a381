"""Corners of a scene in `Located`, as kernels: where they are, and what an obstacle does whose velocity jumps at one.

A corner at which the velocity of a gap jumps is an impact of every contact that is closed there, to rounding. u- is
taken before the jump and u+ after it, as the event-driven integrator does: with u the gap velocity of the present v
on the far side,

    0 <= u + W p + r min(u-, 0)   complementary to   p >= 0,       r = 0 for contacts that were closed.

The obstacle takes a closed contact along or, where it drops, leaves it. A contact that closes within rounding of
the corner belongs to it. So the motion does not depend on where the corner falls in a step.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline
from lcpstep.dynamics import gap_rates, moves, product
from lcpstep.model import ABSENT
from lcpstep.stepping.located_work import (
    BEFORE,
    CHOSEN,
    CLOSED,
    GAP,
    GAP_T,
    GROUND,
    GROUNDED,
    HIGH,
    RATE,
    STATUS,
    Q,
    V,
)
from lcpstep.stepping.smooth import within

JUMP = 1e-9  # of the velocities at hand: a gap velocity that jumps by less does so by rounding


def find_corners(plan: Any, t: float) -> tuple[float, float]:
    """The smooth interval that begins at t or holds it."""
    low, high = -math.inf, math.inf
    if len(plan.corners) == 0:
        return low, high
    turn = 0.0 if plan.period == math.inf else math.floor(t / plan.period) * plan.period
    for k in range(-1, 3):
        if k == 0 or plan.period < math.inf:
            for corner in plan.corners:
                time = corner + (turn + k * plan.period if plan.period < math.inf else 0.0)
                if time <= t + plan.margin:
                    low = max(low, time)
                else:
                    high = min(high, time)
    return low, high


@inline
def at_corner(plan: Any, x: Any, t: float) -> bool:
    """Whether a time is that of the next corner, to rounding; then its impacts are those of the corner."""
    return not plan.plain and t >= x[HIGH] - 2.0 * plan.margin


@inline
def obstacles_move(m: Any) -> bool:
    """Whether a gap has a velocity of its own, which may jump at a corner."""
    return (m.flat and moves(m)) or (not m.flat and m.gap_t != ABSENT)


def choose_jumping(m: Any, plan: Any, w: Any, x: Any, t: float) -> int:
    """Gap velocities after the corner; which contacts it strikes. Speeds that do not jump keep their digits."""
    gap_rates(m, within(plan, x, t), w.vec[Q], w.vec[V], w.G, w.num[GAP_T])
    n_s = 0
    for c in range(w.num.shape[1]):
        before, after, size = (
            w.num[RATE, c],
            product(w.G, w.vec[V], c) + w.num[GAP_T, c],
            abs(w.num[GAP_T, c]),
        )
        w.num[BEFORE, c] = before
        for i in range(w.vec.shape[1]):
            size += abs(w.G[c, i] * w.vec[V, i])
        if abs(after - before) > JUMP * (size + abs(before)):
            w.num[RATE, c] = after
            near = plan.slack + 4.0 * plan.margin * (abs(before) + abs(after))
            if w.mark[STATUS, c] == CLOSED or (w.num[GAP, c] <= near and min(before, after) < 0.0):
                w.mark[CHOSEN, n_s] = c
                w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, GROUND
                n_s += 1
    return n_s
