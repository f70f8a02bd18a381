"""Impacts of many bodies within a step, one after another, each at the price of the contacts that it concerns.

Where accelerations are constant, gaps flat and no contact is closed (gases, columns in free fall), an impact changes
but the velocities of the bodies it strikes and the gaps they share. So every coordinate and every gap keeps the time
up to which it has been moved on, and the time of its next zero; the least of these is the next impact. All are
brought to one time at the end, or where an impact needs the general treatment: several at one time and place, the
end of chattering, a touch. Source: B. Lubachevsky, How to simulate billiards and similar systems, J. Comput. Phys. 94
(1991).
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import IMPACT
from lcpstep.kernels.model import Model
from lcpstep.kernels.quadratic import first_zero, may_reach_zero
from lcpstep.kernels.roundings import NOISE
from lcpstep.pointers import abs, inf, max
from lcpstep.stepping.pieces.codes import GROUND
from lcpstep.stepping.pieces.impulses import SMALL
from lcpstep.stepping.pieces.keep import keep
from lcpstep.stepping.pieces.sequences import SHORT
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import COLLAPSE
from lcpstep.stepping.pieces.times import look_one, move_gap, move_one, untold


def race(m: Model, plan: Plan, w: Work, most: int) -> int:
    """Impacts in the rest of the smooth interval, at most so many; how many there were.

    All stand at the time of the last of them, the new w.sigma.
    """
    t, n_c, done, struck, now = w.t_step, w.n_c, 0, -1, w.sigma
    for i in range(w.n_q):
        w.q_time[i] = w.sigma
    for c in range(n_c):
        w.since[c] = w.sigma
        w.next_zero[c] = next_zero(w, c)
    while done < most:
        c = 0
        for d in range(1, n_c):
            if w.next_zero[d] < w.next_zero[c]:
                c = d
        tau = w.next_zero[c]
        if not tau <= w.end or not ordinary(m, plan, w, c, tau):
            break
        keep_before(plan, w, now, tau)
        hit(m, w, c, tau)
        w.record.note(t + tau, c, w.before[c], w.velocity[c], w.p[c], IMPACT)
        w.lcp_calls += 1
        done, struck, now = done + 1, c, tau
        if w.record.keeps_event(t + tau):
            look_at(w, tau)
            keep(w, t + tau, 1.0, w.q_try, w.v_try)
    if done > 0:
        bring_together(w, now, struck)
        w.sigma = now
        w.events += done
    return done


def look_at(w: Work, tau: float) -> None:
    """All coordinates at tau, each moved on from its own time."""
    for i in range(w.n_q):
        look_one(w, i, tau - w.q_time[i])


def keep_before(plan: Plan, w: Work, now: float, tau: float) -> None:
    """Keep the states asked for from now on before the impact at tau; to rounding, those there come after it."""
    t = w.t_step
    before = t + tau - untold(t + tau, plan.h)
    while w.record.awaited() < before:
        look_at(w, max(now, w.record.awaited() - t))
        w.record.keep_awaited(w.q_try, w.v_try, w.impulse)


def next_zero(w: Work, c: int) -> float:
    """When gap c closes, if that is before the end of the smooth interval."""
    g, u, half = w.gap[c], w.velocity[c], w.half[c]
    if not may_reach_zero(g, u, half, w.end - w.since[c]):
        return inf
    return w.since[c] + first_zero(g, u, half)


def ordinary(m: Model, plan: Plan, w: Work, c: int, tau: float) -> bool:
    """Whether contact c strikes at tau, alone among its neighbours, and rebounds for longer than a moment.

    A neighbour that touches and parts strikes next where its own neighbours do now, if it has not struck yet; or the
    blow leaves it at rest, and closed.
    """
    h, r, s = plan.h, m.restitution[c], tau - w.since[c]
    u = w.velocity[c] + 2.0 * s * w.half[c]
    if not u < 0.0 or r == 0.0 or (w.last[c] >= 0.0 and tau - w.last[c] <= COLLAPSE * h):
        return False
    if r < 1.0 and w.half[c] < 0.0 and (r * u / w.half[c] < SHORT * h or w.hits[c] >= plan.many):
        return False
    for d in range(w.first_contact[c], w.last_contact[c] + 1):
        if d != c and w.W[d * w.n_c + c] != 0.0:
            s = tau - w.since[d]
            g, v = w.gap[d] + s * (w.velocity[d] + s * w.half[d]), w.velocity[d] + 2.0 * s * w.half[d]
            change = -(1.0 + r) * u * w.W[d * w.n_c + c] / w.W[c * w.n_c + c]
            if g <= plan.slack and (v < 0.0 or w.last[d] < 0.0 or abs(v + change) <= SMALL * abs(change)):
                return False
    return True


def hit(m: Model, w: Work, c: int, tau: float) -> None:
    """The impact of contact c at tau; position and velocity of its bodies agree with its gap to the last digit."""
    n, n_c, G, MG, W, r = w.n_q, w.n_c, w.G, w.MG, w.W, m.restitution[c]
    first, last, k = w.first_coordinate[c], w.last_coordinate[c] + 1, c * n
    u = -w.fall[c] if w.fall[c] > 0.0 else w.velocity[c] + 2.0 * (tau - w.since[c]) * w.half[c]
    p = -(1.0 + r) * u / W[c * n_c + c]
    g, leaves = m.offset[c], r * u
    for i in range(first, last):
        move_one(w, i, tau - w.q_time[i])
        v = w.v[i]
        w.v[i] = v + MG[k + i] * p
        if abs(w.v[i]) <= NOISE * (abs(v) + abs(MG[k + i] * p)):
            w.v[i] = 0.0
        w.q_time[i] = tau
        g += G[k + i] * w.q[i]
        leaves += G[k + i] * w.v[i]
    for i in range(first, last):  # rounding of the state must not add up over many impacts
        w.q[i] -= MG[k + i] * g / W[c * n_c + c]
        w.v[i] -= MG[k + i] * leaves / W[c * n_c + c]
    w.hits[c] = w.hits[c] + 1 if w.last[c] >= 0.0 else 1
    w.close_hits[c] = 0
    w.last[c] = w.since[c] = tau
    w.before[c], w.p[c] = u, p
    w.impulse[c] += p
    w.gap[c], w.velocity[c], w.fall[c] = 0.0, -r * u, -r * u
    w.next_zero[c] = next_zero(w, c)
    for d in range(w.first_contact[c], w.last_contact[c] + 1):
        if d != c and W[d * n_c + c] != 0.0:
            s = tau - w.since[d]
            w.gap[d] += s * (w.velocity[d] + s * w.half[d])
            w.velocity[d] += 2.0 * s * w.half[d] + W[d * n_c + c] * p
            change = -W[d * n_c + c] * leaves / W[c * n_c + c]
            if abs(change) <= NOISE * abs(w.velocity[d]):
                w.velocity[d] += change
            w.since[d], w.fall[d] = tau, 0.0
            w.next_zero[d] = next_zero(w, d)


def bring_together(w: Work, now: float, struck: int) -> None:
    """Bring all coordinates and gaps to one time."""
    for i in range(w.n_q):
        move_one(w, i, now - w.q_time[i])
    for c in range(w.n_c):
        move_gap(w, c, now - w.since[c])
        w.grounded[c] = GROUND if c == struck else 0
