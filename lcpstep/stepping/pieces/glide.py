"""Steps of `Located` without events, in registers, as a kernel: one linear degree of freedom and its contact.

The step is that of `smooth`: A a = (F(t) + F(t + h)) / 2 - C v - K (q + v h / 2).
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import external_force, moves, obstacle
from lcpstep.kernels.model import Model
from lcpstep.kernels.one_row import keep_one
from lcpstep.kernels.quadratic import first_zero, may_reach_zero
from lcpstep.pointers import inf
from lcpstep.stepping.pieces.carried import PUT_BACK
from lcpstep.stepping.pieces.keep import keep
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import untold, within


def glide(m: Model, plan: Plan, w: Work, t0: float, first: int, last: int) -> None:
    """Steps of one linear degree of freedom without events, up to the first that may have one.

    The arithmetic is that of `step` to the last bit; only the state stays in registers, which halves the time.
    """
    h = plan.h
    A_inverse, C, K = plan.A_inverse[0], m.C[0], m.K[0]
    q, v, f = w.q[0], w.v[0], w.force[0]
    g, u, bent, G, offset, s = inf, 0.0, 0.0, 0.0, 0.0, 0.0
    contact, moving = w.n_c > 0, moves(m)
    if contact:
        g, u, bent, G, offset = w.gap[0], w.velocity[0], w.half[0], m.G[0], m.offset[0]
        if moving:
            obstacle(m, within(w, t0 + h * (w.steps - first)), w.q, w.v)
            s = m.motion_now[2]
    kept = w.record.last_time()
    k = start = w.steps
    last = w.record.room_until(k, last)
    due = k + w.record.every - k % w.record.every if w.record.every > 0 else 0
    while k < last:
        t = t0 + h * (k - first) + h
        if t > w.high:
            break
        inner = within(w, t)
        external_force(m, inner, w.q, w.v, w.next_force)
        f_next = w.next_force[0]
        a = A_inverse * (0.5 * (f + f_next) - (C * v + K * (q + 0.5 * h * v)))
        if a - a != 0.0:
            break
        if contact:
            half, s_next = 0.5 * (G * a), 0.0
            if moving:
                obstacle(m, inner, w.q, w.v)
                s_next = m.motion_now[2]
                half = 0.5 * ((G * a - 0.5 * (s + s_next)) + (s_next - s) / 6.0)
            if half - half != 0.0:
                break
            latest = h + untold(t, h)
            if may_reach_zero(g, u, half, latest) and first_zero(g, u, half) <= latest:
                break
            if moving:
                if inner != t:
                    obstacle(m, t, w.q, w.v)
                q_next, v_next = q + h * (v + 0.5 * h * a), v + h * a
                g_next = offset - m.motion_now[0] + G * q_next
                if not g_next > 0.0:
                    break
                g, u, s = g_next, G * v_next - m.motion_now[1], s_next
            else:
                g, u = g + h * (u + h * half), u + 2.0 * h * half
            bent = half
        q, v, f = q + h * (v + 0.5 * h * a), v + h * a, f_next
        k += 1
        if k == due:
            due += w.record.every
            now = t0 + h * (k - first)
            if not contact or kept >= now:
                w.q[0], w.v[0] = q, v
                keep(w, now, 0.0, w.q, w.v)
            elif m.carried:  # the obstacle has told where the frame is, at `now` up to a rounding of the time
                keep_one(w.record, now, PUT_BACK, q - m.frame_now[0], v - m.frame_now[1], w.impulse)
            else:
                keep_one(w.record, now, 0.0, q, v, w.impulse)
            kept = now
    w.q[0], w.v[0], w.force[0] = q, v, f
    if contact:
        w.gap[0], w.velocity[0], w.half[0] = g, u, bent
        if k > start:
            w.turned[0], w.sigma = -h, 0.0  # no event for a step at least
            w.end_u[0], w.end_s[0] = G * v - u, s
    w.steps = k
    w.force_evaluations += k - start
