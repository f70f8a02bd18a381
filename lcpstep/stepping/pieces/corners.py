"""Corners of a scene in `Located`, as kernels: where they are, and what an obstacle does whose velocity jumps at one.

A corner at which the velocity of a gap jumps is an impact of every contact that is closed there, to rounding. u- is
taken before the jump and u+ after it, as the event-driven integrator does: with u the gap velocity of the present v
on the far side,

    0 <= u + W p + r min(u-, 0)   complementary to   p >= 0,       r = 0 for contacts that were closed.

The obstacle takes a closed contact along or, where it drops, leaves it. A contact that closes within rounding of
the corner belongs to it. So the motion does not depend on where the corner falls in a step.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gap_rates, moves
from lcpstep.kernels.model import Model
from lcpstep.kernels.sudden import JUMP
from lcpstep.kernels.vectors import copy, size_of_product
from lcpstep.pointers import abs, max, min
from lcpstep.stepping.pieces.codes import CLOSED, GROUND
from lcpstep.stepping.pieces.magnitudes import velocity_of
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within


def find_corners(plan: Plan, w: Work, t: float) -> tuple[float, float]:
    """The smooth interval that begins at t or holds it; the jump that has been found last is a corner, too."""
    near = t + plan.margin
    plan.clock.find_named(near)
    low, high = plan.clock.low, plan.clock.high
    return (max(low, w.jump), high) if w.jump <= near else (low, min(high, w.jump))


def obstacles_move(m: Model) -> bool:
    """Whether a gap has a velocity of its own, which may jump at a corner."""
    return (m.flat and moves(m)) or (not m.flat and m.gap_t.given)


def go_beyond(m: Model, w: Work, t: float) -> None:
    """At a corner that was found, move coordinates to its far side where rows jump by the place.

    They go what they go in the time to which the time of a jump is known.
    """
    at, some = within(w, t), False
    for i in range(w.n_q):
        w.q_try[i] = w.q[i] + 4.0 * w.margin * w.v[i]
    gap_rates(m, at, w.q, w.v, w.G, w.gap_t)
    gap_rates(m, at, w.q_try, w.v, w.G_try, w.gap_t_try)
    for c in range(w.n_c):
        jump, size = w.gap_t_try[c] - w.gap_t[c], abs(w.gap_t[c]) + size_of_product(w.G, w.v, c, w.n_q)
        for i in range(c * w.n_q, (c + 1) * w.n_q):
            jump += (w.G_try[i] - w.G[i]) * w.v[i - c * w.n_q]
        some = some or abs(jump) > JUMP * size
    if some:
        copy(w.q, w.q_try, w.n_q)
        copy(w.G, w.G_try, w.n_c * w.n_q)
        copy(w.gap_t, w.gap_t_try, w.n_c)


def choose_jumping(m: Model, plan: Plan, w: Work, t: float) -> int:
    """Gap velocities after the corner; which contacts it strikes. Speeds that do not jump keep their digits."""
    gap_rates(m, within(w, t), w.q, w.v, w.G, w.gap_t)
    n_s = 0
    for c in range(w.n_c):
        before, later = w.velocity[c], velocity_of(w, c)
        size = abs(w.gap_t[c]) + size_of_product(w.G, w.v, c, w.n_q)
        w.before[c] = before
        if abs(later - before) > JUMP * (size + abs(before)):
            w.velocity[c] = later
            near = plan.slack + 4.0 * w.margin * (abs(before) + abs(later))
            if w.status[c] == CLOSED or (w.gap[c] <= near and min(before, later) < 0.0):
                w.chosen[n_s] = c
                w.gap[c], w.grounded[c] = 0.0, GROUND
                n_s += 1
    return n_s
