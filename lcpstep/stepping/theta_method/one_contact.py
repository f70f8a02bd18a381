"""Steps of one linear degree of freedom at one flat contact: one row, whose problem is a division.

    p = max(0, -(G v_free + g_t + r u) / W)  where  g + (h/2) u <= 0,        v+ = v_free + A^-1 G^T p

The arithmetic is that of `theta_step` to the last bit. While the contact is far, the state stays in registers.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import IMPACT, RELEASE, STAYS_CLOSED
from lcpstep.kernels.dynamics import external_force, moves, obstacle, varies
from lcpstep.kernels.model import Model
from lcpstep.kernels.one_row import keep_one
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import finite
from lcpstep.pointers import abs, max
from lcpstep.stepping.steps import RESTING, UNTOLD
from lcpstep.stepping.theta_method.codes import NO_EVENT
from lcpstep.stepping.theta_method.moving import Plan, Rows, State

EVENTS = 2  # that a step may note


def in_registers(m: Model, plan: Plan, s: State, c: Rows, t0: float, first: int, last: int) -> None:
    """Steps up to `last`, or to where the log is full; or to the first with a problem to be handed out.

    `theta_step` has that solved by what is no kernel, and says so where a step makes a number infinite.
    """
    before, s.next_force[0] = -1, s.force[0]  # which stays that unless it varies
    while before < s.steps < last and finite(s.g, 1) and finite(s.u, 1):
        before = s.steps
        if s.closed[0] == 0:
            coast(m, plan, s, t0, first, last)
        if not c.external and plan.W[0] > 0.0:
            press(m, plan, s, c, t0, first, last)


def coast(m: Model, plan: Plan, s: State, t0: float, first: int, last: int) -> None:
    """Free steps, up to the first that has to do with the contact."""
    h, theta, half, slack = plan.h, plan.theta, 0.5 * plan.h, s.slack[0]
    A_f, A_q, A_v = plan.A_f[0], plan.A_q[0], plan.A_v[0]
    G, offset = m.G[0], m.offset[0]
    q, v, g, u, f, k = s.q[0], s.v[0], s.g[0], s.u[0], s.force[0], s.steps
    left = s.record.every - k % s.record.every if s.record.every > 0 else 0  # steps to the next state kept
    last = s.record.room_until(k, last)
    driven, moving = varies(m), moves(m)
    while k < last and g + half * u > slack:
        t = t0 + h * (k + 1 - first)
        if driven:
            external_force(m, t, s.q, s.v, s.next_force)
        f_next = s.next_force[0]
        v_next = v + (A_f * (theta * f_next + (1.0 - theta) * f) - A_q * q - A_v * v)
        if v_next - v_next != 0.0:
            break
        q += h * (theta * v_next + (1.0 - theta) * v)
        v, f = v_next, f_next
        if moving:
            obstacle(m, t, s.q, s.v)
        g = offset - m.motion_now[0] + G * q
        u = G * v - m.motion_now[1]
        k += 1
        left -= 1
        if left == 0 and g - g == 0.0 and u - u == 0.0:
            left = s.record.every
            keep_one(s.record, t, 0.0, q, v, s.impulse)
    s.q[0], s.v[0], s.g[0], s.u[0], s.force[0] = q, v, g, u, f
    s.forces += k - s.steps
    s.steps = k


def press(m: Model, plan: Plan, s: State, c: Rows, t0: float, first: int, last: int) -> None:
    """Steps that have to do with the contact, up to the first that has not."""
    h, theta, driven, moving = plan.h, plan.theta, varies(m), moves(m)
    while s.steps < last and not s.record.full(EVENTS):
        q, v, f, k, events = s.q[0], s.v[0], s.force[0], s.steps, s.record.event
        if s.closed[0] == 0 and not s.g[0] + 0.5 * h * s.u[0] <= s.slack[0]:
            break
        t = t0 + h * (k + 1 - first)
        if driven:
            external_force(m, t, s.q, s.v, s.next_force)
        f_next = s.next_force[0]
        v_next = v + (plan.A_f[0] * (theta * f_next + (1.0 - theta) * f) - plan.A_q[0] * q - plan.A_v[0] * v)
        if v_next - v_next != 0.0:
            break
        if moving:
            obstacle(m, t, s.q, s.v)
        v_next = met(m, plan, s, c, t, k, q, s.g[0], s.u[0], v_next)
        s.q[0] = q + h * (theta * v_next + (1.0 - theta) * v)
        s.v[0], s.force[0] = v_next, f_next
        s.g[0] = m.offset[0] - m.motion_now[0] + m.G[0] * s.q[0]
        s.u[0] = m.G[0] * v_next - m.motion_now[1]
        s.steps, s.forces = k + 1, s.forces + 1
        if not (finite(s.g, 1) and finite(s.u, 1)):
            break
        if s.record.is_due(s.steps) or (s.record.on_events and s.record.event > events):
            keep_one(s.record, t, 0.0, s.q[0], s.v[0], s.impulse)


def met(
    m: Model, plan: Plan, s: State, c: Rows, t: float, k: int, q: float, g: float, u: float,
    v: float,
) -> float:  # fmt: skip
    """Velocity after step k, which ends at t and begins with q, g and u; v: the one without contact.

    It is active as by `theta_step.predict_active`, to the last bit.
    """
    G, g_t, closed, p = m.G[0], -m.motion_now[1], s.closed[0], 0.0
    s.v_free[0], c.H[0], c.H_t[0] = v, G, g_t  # what a control by a tolerance looks at
    gap = g + 0.5 * plan.h * u
    s.far[0] = max(s.far[0], abs(G * q)) if closed > 0 else 0.0
    drift = (RESTING + RESOLUTION * k) * (s.far[0] + abs(G) * plan.h * (abs(plan.X[0]) * c.p[0]))
    held = s.opened if closed > 1 else 0.0
    if gap <= s.slack[0] + held or (closed > 0 and gap <= s.slack[0] + drift + UNTOLD * abs(t * g_t)):
        r = m.restitution[0] if abs(u) > c.blows.least else 0.0
        p = max(0.0, -(G * v + g_t + r * u) / plan.W[0])
        v += plan.X[0] * p
        s.problems += 1
    kind = kind_of(p, closed)
    if kind != NO_EVENT:
        s.record.note(t, 0, u, G * v + g_t, p, kind)
    s.closed[0], c.p[0] = closed_since(p, closed), p
    s.impulse[0] += p
    return v


def kind_of(p: float, closed: int) -> int:
    """What a step with the impulse p is to a contact: an impact, the beginning of lasting contact, its end, none."""
    if p > 0.0:
        return IMPACT if closed == 0 else STAYS_CLOSED if closed == 1 else NO_EVENT
    return RELEASE if closed == 2 else NO_EVENT


def closed_since(p: float, closed: int) -> int:
    """For how many steps a contact has been closed after it, up to two."""
    return (closed + 1 if closed < 2 else 2) if p > 0.0 else 0
