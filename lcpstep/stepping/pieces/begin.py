"""The state of `Located` where a span begins, as a kernel: its forces and gaps, and which contacts are closed."""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import external_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import product
from lcpstep.pointers import abs
from lcpstep.stepping.pieces.codes import CLOSED, EPS, FINISHED, GROUND, NOT_FINITE
from lcpstep.stepping.pieces.corners import find_corners
from lcpstep.stepping.pieces.keep import keep, keep_now
from lcpstep.stepping.pieces.magnitudes import acceleration_terms
from lcpstep.stepping.pieces.smooth import free_acceleration, gap_bias, measure, respond
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within


def begin_motion(m: Model, plan: Plan, w: Work, t: float) -> int:
    """Forces, gaps and status of the initial state, which is kept where states are."""
    w.low, w.high = find_corners(plan, w, t)
    w.margin = plan.margin
    w.fresh = True
    if plan.trapezoidal:
        external_force(m, within(w, t), w.q, w.v, w.force)
    elif not free_acceleration(m, w, within(w, t), w.q, w.v, w.free):
        return NOT_FINITE
    w.force_evaluations += 1
    if plan.steady:
        for i in range(w.n_q):
            w.free[i] = product(plan.A_inverse, w.force, i, w.n_q)
    measure(m, w, t)
    if plan.constant:
        respond(m, w)
        for c in range(w.n_c):
            w.alpha[c] = product(m.G, w.free, c, w.n_q)
    if not plan.plain:
        gap_bias(m, w, within(w, t), w.q, w.v)
    for c in range(w.n_c):
        if w.gap[c] <= plan.slack:
            w.gap[c], w.grounded[c] = 0.0, GROUND
            size = abs(w.gap_t[c]) + plan.h * acceleration_terms(m, w, c)
            for i in range(w.n_q):
                size += abs(w.G[c * w.n_q + i] * w.v[i])
            # What its obstacle changes its velocity by in what time is rounded by, and moved off a corner
            rounded = (plan.margin + 4.0 * EPS * abs(t)) * abs(w.bias[c])
            if abs(w.rate[c]) <= 64 * EPS * size + rounded:
                w.rate[c], w.status[c] = 0.0, CLOSED
                w.closed_now += 1
    if w.record.n_times == 0:
        keep(w, t, 0.0)
    keep_now(w, t)
    return FINISHED
