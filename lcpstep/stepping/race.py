"""Impacts of many bodies within a step, one after another, each at the price of the contacts that it concerns.

Where accelerations are constant, gaps flat and no contact is closed (gases, columns in free fall), an impact changes
but the velocities of the bodies it strikes and the gaps they share. So every coordinate and every gap keeps the time
up to which it has been moved on, and the time of its next zero; the least of these is the next impact. All are
brought to one time at the end, or where an impact needs the general treatment: several at one time and place, the
end of chattering, a touch. Source: B. Lubachevsky, How to simulate billiards and similar systems, J. Comput. Phys. 94
(1991).
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.recording import LEAD, write_event, write_row
from lcpstep.recording import TIME as ROW_TIME
from lcpstep.stepping.located_work import (
    BEFORE,
    CLOSE_HITS,
    EVENT,
    FALL,
    FIRST_CONTACT,
    FIRST_COORDINATE,
    GAP,
    GROUND,
    GROUNDED,
    HALF,
    HITS,
    IMPACT,
    IMPULSE,
    LAST,
    LAST_CONTACT,
    LAST_COORDINATE,
    LCP_CALLS,
    NEXT_ZERO,
    Q_TIME,
    Q_TRY,
    RATE,
    ROUNDING,
    ROW,
    SINCE,
    V_TRY,
    A,
    P,
    Q,
    V,
)
from lcpstep.stepping.quadratic import NEVER, first_zero, may_reach_zero

CLOSE = 1e-9  # of a step: impacts of a contact as close as this,
SHORT = 1e-7  # and hops as short as this, are left to the general treatment


def race(
    m: Any, plan: Any, w: Any, record: Any, count: Any, t: float, sigma: float, end: float, most: int
) -> int:
    """Impacts in (sigma, end] of the step that began at t, at most so many; how many there were.

    All stand at the time of the last of them, w.vec[Q_TIME, 0].
    """
    vec, num = w.vec, w.num
    n, n_c, done, struck, now = vec.shape[1], num.shape[1], 0, -1, sigma
    for i in range(n):
        vec[Q_TIME, i] = sigma
    for c in range(n_c):
        num[SINCE, c] = sigma
        num[NEXT_ZERO, c] = next_zero(num, c, end)
    while done < most:
        c = 0
        for d in range(1, n_c):
            if num[NEXT_ZERO, d] < num[NEXT_ZERO, c]:
                c = d
        tau = num[NEXT_ZERO, c]
        if not tau <= end or not ordinary(m, plan, w, c, tau):
            break
        hit(m, w, c, tau, end)
        write_event(record.events[count[EVENT]], t + tau, c, num[BEFORE, c], num[RATE, c], num[P, c], IMPACT)
        count[EVENT] += 1
        count[LCP_CALLS] += 1
        done, struck, now = done + 1, c, tau
        if record.on_events or record.every == 1:
            keep_impact(w, record, count, t, tau)
    if done > 0:
        gather(w, now, struck)
    return done


def keep_impact(w: Any, record: Any, count: Any, t: float, tau: float) -> None:
    """Keep the state at tau; states at one time share a row."""
    vec, num, n = w.vec, w.num, w.vec.shape[1]
    for i in range(n):
        s = tau - vec[Q_TIME, i]
        vec[Q_TRY, i] = vec[Q, i] + s * (vec[V, i] + 0.5 * s * vec[A, i])
        vec[V_TRY, i] = vec[V, i] + s * vec[A, i]
    if count[ROW] > 0 and record.rows[count[ROW] - 1, ROW_TIME] == t + tau:
        count[ROW] -= 1
        for d in range(num.shape[1]):
            num[IMPULSE, d] += record.rows[count[ROW], LEAD + 2 * n + d]
    write_row(record.rows[count[ROW]], t + tau, 1.0, vec[Q_TRY], vec[V_TRY], num[IMPULSE])
    count[ROW] += 1


@inline
def next_zero(num: Any, c: int, end: float) -> float:
    """When gap c closes, if that is before the end."""
    g, u, half = num[GAP, c], num[RATE, c], num[HALF, c]
    if not may_reach_zero(g, u, half, end - num[SINCE, c]):
        return NEVER
    return num[SINCE, c] + first_zero(g, u, half)


def ordinary(m: Any, plan: Any, w: Any, c: int, tau: float) -> bool:
    """Whether contact c strikes at tau, alone among its neighbours, and rebounds for longer than a moment."""
    num, mark, h = w.num, w.mark, plan.h
    r, s = m.restitution[c], tau - num[SINCE, c]
    u = num[RATE, c] + 2.0 * s * num[HALF, c]
    if not u < 0.0 or r == 0.0 or (num[LAST, c] >= 0.0 and tau - num[LAST, c] <= CLOSE * h):
        return False
    if r < 1.0 and num[HALF, c] < 0.0 and (r * u / num[HALF, c] < SHORT * h or mark[HITS, c] >= plan.many):
        return False
    for d in range(mark[FIRST_CONTACT, c], mark[LAST_CONTACT, c] + 1):
        if d != c and w.W[d, c] != 0.0:
            s = tau - num[SINCE, d]
            g, v = num[GAP, d] + s * (num[RATE, d] + s * num[HALF, d]), num[RATE, d] + 2.0 * s * num[HALF, d]
            if g <= plan.slack and v < 0.0:
                return False
    return True


def hit(m: Any, w: Any, c: int, tau: float, end: float) -> None:
    """The impact of contact c at tau; position and velocity of its bodies agree with its gap to the last digit."""
    vec, num, mark, G, MG, W, r = w.vec, w.num, w.mark, w.G, w.MG, w.W, m.restitution[c]
    first, last = mark[FIRST_COORDINATE, c], mark[LAST_COORDINATE, c] + 1
    u = -num[FALL, c] if num[FALL, c] > 0.0 else num[RATE, c] + 2.0 * (tau - num[SINCE, c]) * num[HALF, c]
    p = -(1.0 + r) * u / W[c, c]
    g, leaves = m.offset[c], r * u
    for i in range(first, last):
        s = tau - vec[Q_TIME, i]
        vec[Q, i] += s * (vec[V, i] + 0.5 * s * vec[A, i])
        v = vec[V, i] + s * vec[A, i]
        vec[V, i] = v + MG[c, i] * p
        if abs(vec[V, i]) <= ROUNDING * (abs(v) + abs(MG[c, i] * p)):
            vec[V, i] = 0.0
        vec[Q_TIME, i] = tau
        g += G[c, i] * vec[Q, i]
        leaves += G[c, i] * vec[V, i]
    for i in range(first, last):  # rounding of the state must not add up over many impacts
        vec[Q, i] -= MG[c, i] * g / W[c, c]
        vec[V, i] -= MG[c, i] * leaves / W[c, c]
    mark[HITS, c] = mark[HITS, c] + 1 if num[LAST, c] >= 0.0 else 1
    mark[CLOSE_HITS, c] = 0
    num[LAST, c] = num[SINCE, c] = tau
    num[BEFORE, c], num[P, c] = u, p
    num[IMPULSE, c] += p
    num[GAP, c], num[RATE, c], num[FALL, c] = 0.0, -r * u, -r * u
    num[NEXT_ZERO, c] = next_zero(num, c, end)
    for d in range(mark[FIRST_CONTACT, c], mark[LAST_CONTACT, c] + 1):
        if d != c and W[d, c] != 0.0:
            s = tau - num[SINCE, d]
            num[GAP, d] += s * (num[RATE, d] + s * num[HALF, d])
            num[RATE, d] += 2.0 * s * num[HALF, d] + W[d, c] * p
            change = -W[d, c] * leaves / W[c, c]
            if abs(change) <= ROUNDING * abs(num[RATE, d]):
                num[RATE, d] += change
            num[SINCE, d], num[FALL, d] = tau, 0.0
            num[NEXT_ZERO, d] = next_zero(num, d, end)


def gather(w: Any, now: float, struck: int) -> None:
    """Bring all coordinates and gaps to one time."""
    vec, num, mark = w.vec, w.num, w.mark
    for i in range(vec.shape[1]):
        s = now - vec[Q_TIME, i]
        vec[Q, i] += s * (vec[V, i] + 0.5 * s * vec[A, i])
        vec[V, i] += s * vec[A, i]
        vec[Q_TIME, i] = now
    for c in range(num.shape[1]):
        s = now - num[SINCE, c]
        num[GAP, c] += s * (num[RATE, c] + s * num[HALF, c])
        num[RATE, c] += 2.0 * s * num[HALF, c]
        mark[GROUNDED, c] = GROUND if c == struck else 0
