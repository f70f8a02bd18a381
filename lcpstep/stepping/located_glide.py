"""Steps of `Located` without events, in registers, as a kernel: one linear degree of freedom and its contact.

The step is that of `smooth`: A a = (F(t) + F(t + h)) / 2 - C v - K (q + v h / 2).
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline
from lcpstep.dynamics import external_force, moves, obstacle
from lcpstep.stepping.located_work import (
    FORCE,
    FORCES,
    GAP,
    HIGH,
    NEXT_FORCE,
    RATE,
    SAME_TIME,
    STEP,
    TURNED,
    WHOLE,
    Q,
    V,
)
from lcpstep.stepping.quadratic import first_zero, may_reach_zero
from lcpstep.stepping.smooth import (
    within,
)


@inline
def glide(model: Any, plan: Any, w: Any, x: Any, count: Any, t0: float, first: int, last: int) -> None:
    """Steps of one linear degree of freedom without events, up to the first that may have one.

    The arithmetic is that of `step` to the last bit; only the state stays in registers, which halves the time.
    """
    h = plan.h
    A_inverse, C, K = plan.A_inverse[WHOLE, 0, 0], model.C[0, 0], model.K[0, 0]
    q, v, f = w.vec[Q, 0], w.vec[V, 0], w.vec[FORCE, 0]
    g, u, G, offset, s = math.inf, 0.0, 0.0, 0.0, 0.0
    contact, moving = w.num.shape[1] > 0, moves(model)
    if contact:
        g, u, G, offset = w.num[GAP, 0], w.num[RATE, 0], model.G[0, 0], model.offset[0]
        if moving:
            obstacle(model, within(plan, x, t0 + h * (count[STEP] - first)), w.vec[Q], w.vec[V])
            s = model.motion_now[0, 2]
    k = start = count[STEP]
    while k < last:
        t = t0 + h * (k - first) + h
        if t > x[HIGH]:
            break
        inner = within(plan, x, t)
        external_force(model, inner, w.vec[Q], w.vec[V], w.vec[NEXT_FORCE])
        f_next = w.vec[NEXT_FORCE, 0]
        a = A_inverse * (0.5 * (f + f_next) - (C * v + K * (q + 0.5 * h * v)))
        if a - a != 0.0:
            break
        if contact:
            half, s_next = 0.5 * (G * a), 0.0
            if moving:
                obstacle(model, inner, w.vec[Q], w.vec[V])
                s_next = model.motion_now[0, 2]
                half = 0.5 * ((G * a - 0.5 * (s + s_next)) + (s_next - s) / 6.0)
            if half - half != 0.0:
                break
            latest = h + SAME_TIME * (abs(t) + h)
            if may_reach_zero(g, u, half, latest) and first_zero(g, u, half) <= latest:
                break
            if moving:
                if inner != t:
                    obstacle(model, t, w.vec[Q], w.vec[V])
                q_next, v_next = q + h * (v + 0.5 * h * a), v + h * a
                g_next = offset - model.motion_now[0, 0] + G * q_next
                if not g_next > 0.0:
                    break
                g, u, s = g_next, G * v_next - model.motion_now[0, 1], s_next
            else:
                g, u = g + h * (u + h * half), u + 2.0 * h * half
        q, v, f = q + h * (v + 0.5 * h * a), v + h * a, f_next
        k += 1
    w.vec[Q, 0], w.vec[V, 0], w.vec[FORCE, 0] = q, v, f
    if contact:
        w.num[GAP, 0], w.num[RATE, 0] = g, u
        if k > start:
            w.num[TURNED, 0] = -h
    count[STEP] = k
    count[FORCES] += k - start
