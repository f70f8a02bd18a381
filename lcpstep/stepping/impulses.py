"""Impacts of `Located`, as kernels: their impulses, and the end of chattering.

    0 <= u+ + r u-   complementary to  p >= 0        the contacts that fire, and the closed ones that a chain of
                                                     contacts connects with them

A contact whose next hop would be shorter than a small fraction of the step is closed: under the acceleration of the
piece, which is constant, the remaining impacts of a single contact end at T = 2 u+ / (|alpha| (1 - r)), and up to
there they have the effect of a closed contact. Sources: J. J. Moreau, Unilateral contact and dry friction in finite
freedom dynamics (1988); G. Osorio, Complex Behavior in Impacting Systems, eq. 4.2.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dynamics import gap_rounding, order_matters
from lcpstep.stepping.corners import choose_jumping
from lcpstep.stepping.joint_tasks import IMPULSE as JOINT_IMPULSE
from lcpstep.stepping.located_joints import pass_on
from lcpstep.stepping.located_work import (
    ACCUMULATION,
    BEFORE,
    CHOSEN,
    CLOSE_HITS,
    CLOSED,
    CLOSED_NOW,
    CORNER,
    END,
    EVENTS,
    FALL,
    GAP,
    GROUND,
    GROUNDED,
    HALF,
    HITS,
    IMPACT,
    IMPULSE,
    INERTIA,
    LAST,
    LEFT,
    OPEN,
    PLASTIC,
    RATE,
    ROUNDING,
    SIGMA,
    STATUS,
    SWING,
    TOUCHING,
    V_TRY,
    B,
    P,
    Q,
    V,
    Z,
)
from lcpstep.stepping.magnitudes import faint, speed_terms
from lcpstep.stepping.refine import solve_chosen
from lcpstep.stepping.switches import AT_ONCE_FAST, COLLAPSE, SHORT_TOGETHER, log, release, stick, turn

SHORT = 1e-7  # of a step: hops of a single contact below it are taken as one
SAME_SPEED = 1e-6  # relative: contacts that close at one time, and are as alike in speed, land together
SMALL = 1e-3  # beside its change: a gap velocity that may be but rounding
IN_A_ROW = (
    8  # so many impacts, each at the instant of the one before, are an inelastic collapse once they are faint
)


def strike(m: Any, plan: Any, w: Any, x: Any, record: Any, first: int, t: float, count: Any) -> int:
    """The impact of contact `first`, and of those that fire with it, or (CORNER) of those whose velocity jumps.

    Returns how many took part, -1 where the impact was not solved.
    """
    n_s = choose_jumping(m, plan, w, x, t) if first == CORNER else choose_struck(m, plan, w, x, first)
    if n_s == 0:
        return 0
    if x[CLOSED_NOW] > 0:
        n_s = choose_connected(w, n_s)
    alone = n_s == 1
    for k in range(n_s):
        c = w.mark[CHOSEN, k]
        w.num[Z, k] = w.num[B, k] = w.num[P, c] = 0.0
        w.mark[PLASTIC, c] = 0
        if w.mark[STATUS, c] == OPEN:
            w.mark[PLASTIC, c] = 1 if first != CORNER and closes(m, plan, w, x, c, alone) else 0
            r = 0.0 if w.mark[PLASTIC, c] == 1 else m.restitution[c]
            w.num[B, k] = w.num[RATE, c] + r * min(w.num[BEFORE, c], 0.0)
        elif first == CORNER:
            w.num[B, k] = w.num[RATE, c]
    if not solve_chosen(m, plan, w, w.W, INERTIA, n_s, count):
        return -1
    jump(plan, w, x, n_s)
    for k in range(n_s):
        after_impact(m, plan, w, x, record, w.mark[CHOSEN, k], w.num[Z, k], t, count)
    x[EVENTS] += 1
    return n_s


def choose_struck(m: Any, plan: Any, w: Any, x: Any, first: int) -> int:
    """Contacts that fire now; their number.

    Those that close with one speed land together, those that touched before are pushed together, and so are those
    of which rounding hides which came first, where that matters. Others whose gaps happen to be zero at the same time
    are struck one after another, as they would be a little apart.
    """
    for c in range(w.num.shape[1]):
        # A gap within the slack may still be open: its speed is not yet the one that it will close with
        closing = c == first or (
            w.num[GAP, c] <= plan.slack
            and abs(w.num[RATE, c] + w.num[FALL, c]) <= SAME_SPEED * w.num[FALL, c]
        )
        if w.num[FALL, c] > 0.0 and w.num[RATE, c] < 0.0 and closing:
            w.num[RATE, c] = -w.num[FALL, c]
    w.mark[CHOSEN, 0] = first
    u, n_s = w.num[RATE, first], 1
    touched = w.mark[GROUNDED, first] >= GROUND and w.num[LAST, first] < 0.0
    w.num[GAP, first], w.mark[GROUNDED, first] = 0.0, GROUND
    for c in range(w.num.shape[1]):
        w.num[BEFORE, c] = w.num[RATE, c]
        if c != first and w.mark[STATUS, c] == OPEN and w.num[RATE, c] < 0.0 and w.num[GAP, c] <= plan.slack:
            pushed = touched and w.mark[GROUNDED, c] >= GROUND and w.num[LAST, c] < 0.0
            if pushed or abs(w.num[RATE, c] - u) <= SAME_SPEED * abs(u) or tied(m, plan, w, x, first, c):
                w.mark[CHOSEN, n_s] = c
                w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, GROUND
                n_s += 1
    return n_s


def tied(m: Any, plan: Any, w: Any, x: Any, first: int, c: int) -> bool:
    """Whether contact c has come with the first one, up to rounding, and the order of their impacts matters.

    Contacts that have struck at this instant already are in the midst of a sequence, which has an order.
    """
    for d in (first, c):
        if w.num[LAST, d] >= 0.0 and x[SIGMA] - w.num[LAST, d] <= COLLAPSE * plan.h:
            return False
    if w.num[GAP, c] > gap_rounding(m, w.G, w.vec[Q], c, plan.h * speed_terms(plan, w, c)):
        return False
    r, W = m.restitution, w.W
    return order_matters(
        W[first, first], W[c, c], W[first, c], r[first], r[c], w.num[RATE, first], w.num[RATE, c]
    )


def choose_connected(w: Any, n_s: int) -> int:
    """Add the closed contacts that a chain of closed contacts connects with the chosen ones."""
    n_c = w.num.shape[1]
    for c in range(n_c):
        w.num[P, c] = 1.0 if w.mark[STATUS, c] == CLOSED else 0.0  # still to be looked at
    for k in range(n_s):
        w.num[P, w.mark[CHOSEN, k]] = 0.0
    k = 0
    while k < n_s:
        for c in range(n_c):
            if w.num[P, c] == 1.0 and w.W[w.mark[CHOSEN, k], c] != 0.0:
                w.mark[CHOSEN, n_s] = c
                w.num[P, c] = 0.0
                n_s += 1
        k += 1
    return n_s


def closes(m: Any, plan: Any, w: Any, x: Any, c: int, alone: bool) -> bool:
    """Whether the contact that fires is closed: its next hops are too short to be followed."""
    r = m.restitution[c]
    since = x[SIGMA] - w.num[LAST, c]
    w.mark[HITS, c] = w.mark[HITS, c] + 1 if w.num[LAST, c] >= 0.0 else 1
    if since > COLLAPSE * plan.h or w.num[LAST, c] < 0.0:
        w.mark[CLOSE_HITS, c] = 0
    else:
        w.mark[CLOSE_HITS, c] += 1
    w.num[LAST, c] = x[SIGMA]
    if r == 1.0 or r == 0.0:
        return False
    hits = w.mark[CLOSE_HITS, c]
    if hits >= IN_A_ROW and (hits >= AT_ONCE_FAST or faint(plan, w, c, w.num[RATE, c])):
        return True
    if w.num[HALF, c] >= 0.0:
        return False
    hop = -r * w.num[RATE, c] / -w.num[HALF, c]
    if not alone:
        return hop < SHORT_TOGETHER * plan.h
    ends_in_time = hop / (1.0 - r) <= x[END] - x[SIGMA]
    return (
        ends_in_time and (hop < SHORT * plan.h or w.mark[HITS, c] > plan.many)
    ) or hop < COLLAPSE * SHORT * plan.h


def jump(plan: Any, w: Any, x: Any, n_s: int) -> None:
    """Velocities after the impulses z of the chosen contacts; what rounding leaves of zero is zero."""
    n = w.vec.shape[1]
    for i in range(n):
        w.vec[V_TRY, i] = abs(w.vec[V, i])
    for k in range(n_s):
        c, p = w.mark[CHOSEN, k], w.num[Z, k]
        if p > 0.0:
            pass_on(w, c, p, JOINT_IMPULSE)
            for i in range(n):
                w.vec[V, i] += w.MG[c, i] * p
                w.vec[V_TRY, i] += abs(w.MG[c, i] * p)
    for i in range(n):
        w.vec[SWING, i] = max(w.vec[SWING, i], w.vec[V_TRY, i])
        if abs(w.vec[V, i]) <= ROUNDING * w.vec[V_TRY, i]:
            w.vec[V, i] = 0.0
    for k in range(n_s):
        if w.num[Z, k] > 0.0:
            push(plan, w, x, w.mark[CHOSEN, k], w.num[Z, k])


def push(plan: Any, w: Any, x: Any, d: int, p: float) -> None:
    """Gap velocities after the impulse of contact d; a contact that touches may be left at rest by it."""
    for c in range(w.num.shape[1]):
        change = w.W[c, d] * p
        if change != 0.0:
            w.num[RATE, c] += change
            w.num[FALL, c] = 0.0
            u = abs(w.num[RATE, c])
            touches = u <= SMALL * abs(change) and w.num[GAP, c] <= plan.slack
            if touches and u <= ROUNDING * speed_terms(plan, w, c):
                w.num[GAP, c] = w.num[RATE, c] = 0.0
                w.mark[GROUNDED, c], x[TOUCHING] = GROUND, 1.0
            elif w.mark[GROUNDED, c] == LEFT:
                w.mark[GROUNDED, c], x[TOUCHING] = GROUND, 1.0


def after_impact(
    m: Any, plan: Any, w: Any, x: Any, record: Any, c: int, p: float, t: float, count: Any
) -> None:
    """Note the impact of a contact; the velocity it leaves with, to the last digit."""
    r, before = m.restitution[c], min(w.num[BEFORE, c], 0.0)
    w.num[IMPULSE, c] += p
    if w.mark[STATUS, c] == CLOSED:
        if p > 0.0:
            w.num[RATE, c] = 0.0
            log(record, count, t, c, 0.0, 0.0, p, IMPACT)
        elif w.num[RATE, c] > ROUNDING * speed_terms(plan, w, c):
            release(m, plan, w, record, count, x, c, t, w.num[RATE, c])
        else:
            w.num[RATE, c] = 0.0
        return
    if p == 0.0:
        return
    turn(m, plan, w, x, c, before, True)
    if w.mark[PLASTIC, c] == 1:
        T = 0.0
        if w.num[HALF, c] < 0.0 and w.mark[CLOSE_HITS, c] < IN_A_ROW:
            T = r * before / w.num[HALF, c] / (1.0 - r)
            p += -2.0 * w.num[HALF, c] * T / w.W[c, c]
        log(record, count, t + T, c, before, 0.0, p, ACCUMULATION)
        stick(w, record, count, x, c, t + T)
        return
    w.num[RATE, c] = -r * before if r > 0.0 else 0.0
    w.num[FALL, c] = w.num[RATE, c] if plan.plain and plan.steady else 0.0
    log(record, count, t, c, before, w.num[RATE, c], p, IMPACT)
    if r == 0.0:
        stick(w, record, count, x, c, t)
    elif before == 0.0:
        x[TOUCHING] = 1.0
