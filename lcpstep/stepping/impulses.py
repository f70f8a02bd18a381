"""The complementarity problems of `Located`, as kernels: impacts, contact forces, the end of chattering.

    impact      0 <= u+ + r u-   complementary to  p >= 0        the contacts that fire, and the closed ones that
                                                                 a chain of contacts connects with them
    contact     0 <= alpha       complementary to  lambda >= 0   all closed contacts

A contact whose next hop would be shorter than a small fraction of the step is closed: under the acceleration of the
piece, which is constant, the remaining impacts of a single contact end at T = 2 u+ / (|alpha| (1 - r)), and up to
there they have the effect of a closed contact. Sources: J. J. Moreau, Unilateral contact and dry friction in finite
freedom dynamics (1988); G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.15 and 4.2.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import product
from lcpstep.recording import write_event
from lcpstep.stepping.corners import choose_jumping
from lcpstep.stepping.joint_tasks import IMPULSE as JOINT_IMPULSE
from lcpstep.stepping.joint_tasks import PIECE
from lcpstep.stepping.located_joints import pass_on
from lcpstep.stepping.located_work import (
    A_TRY,
    ACCUMULATION,
    ALPHA,
    BEFORE,
    CHOSEN,
    CLOSE_HITS,
    CLOSED,
    CLOSED_NOW,
    CORNER,
    END,
    EVENT,
    EVENTS,
    FORCE_NOW,
    FREE,
    GAP,
    GAP_T,
    GROUNDED,
    HALF,
    HITS,
    IMPACT,
    IMPULSE,
    INERTIA,
    LAST,
    MADE_WITH,
    OLDER,
    OLDER_TIME,
    OPEN,
    PLASTIC,
    RATE,
    RELEASE,
    ROUNDING,
    SIGMA,
    STATUS,
    STICK,
    V_TRY,
    A,
    B,
    P,
    V,
    Z,
)
from lcpstep.stepping.refine import keep_closed, solve_chosen

SHORT = 1e-7  # of a step: hops of a single contact below it are taken as one
SHORT_TOGETHER = 1e-4  # the same where other closed contacts take part
COLLAPSE = 1e-9  # of a step: impacts as close as this,
SAME_SPEED = 1e-6  # relative: contacts that close at one time, and are as alike in speed, land together
IN_A_ROW = 8  # so many of them in a row, are an inelastic collapse


@inline
def log(record: Any, count: Any, t: float, c: int, before: float, after: float, p: float, kind: int) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, c, before, after, p, kind)
    count[EVENT] += 1


# --- contact forces -------------------------------------------------------------------------------------------


def hold(m: Any, plan: Any, w: Any, x: Any, record: Any, place: int, t: float, count: Any) -> bool:
    """Forces of the closed contacts from w.num[ALPHA], and the acceleration with them; who needs none opens."""
    n, n_c, n_k = w.vec.shape[1], w.num.shape[1], 0
    assign(w.vec[A], w.vec[FREE])
    for c in range(n_c):
        if w.mark[STATUS, c] == CLOSED:
            w.mark[CHOSEN, n_k] = c
            w.num[Z, n_k] = w.num[FORCE_NOW, c]
            w.num[B, n_k] = w.num[ALPHA, c]
            n_k += 1
    if n_k == 0:
        return True
    rest = x[END] - x[SIGMA]
    W = w.WA[place] if plan.constant else w.W
    MG = w.AG[place] if plan.constant else w.MG
    if not solve_chosen(m, plan, w, W, place if plan.constant else INERTIA, n_k, count):
        return False
    for i in range(n):
        w.vec[A_TRY, i] = abs(w.vec[FREE, i])
    for k in range(n_k):
        c, force = w.mark[CHOSEN, k], w.num[Z, k]
        if force > 0.0:
            for i in range(n):
                w.vec[A, i] += MG[c, i] * force
                w.vec[A_TRY, i] += abs(MG[c, i] * force)
    zero_rounding(plan, w)
    if plan.plain and n_k > 1 and keep_closed(w, W, MG, n_k):
        zero_rounding(plan, w)
    for k in range(n_k):
        c, force = w.mark[CHOSEN, k], w.num[Z, k]
        if force == 0.0:
            alpha, size = w.num[B, k], abs(w.num[B, k])
            for j in range(n_k):
                alpha += W[c, w.mark[CHOSEN, j]] * w.num[Z, j]
                size += abs(W[c, w.mark[CHOSEN, j]] * w.num[Z, j])
            if alpha > ROUNDING * size:
                release(w, record, count, x, c, release_time(w, c, t, rest, alpha / W[c, c]), 0.0)
                continue
        w.num[OLDER, c], w.num[OLDER_TIME, c] = force, t + 0.5 * rest
        w.num[FORCE_NOW, c] = force
    return True


def zero_rounding(plan: Any, w: Any) -> None:
    """What is but rounding of the sums in w.vec[A_TRY] is zero: accelerations, and velocities that they made."""
    for i in range(w.vec.shape[1]):
        if abs(w.vec[A, i]) <= ROUNDING * w.vec[A_TRY, i]:
            w.vec[A, i] = 0.0
            if plan.plain and abs(w.vec[V, i]) <= ROUNDING * w.vec[A_TRY, i] * plan.h:
                w.vec[V, i] = 0.0


def stick(w: Any, record: Any, count: Any, x: Any, c: int, t: float) -> None:
    """A contact stays closed from here on."""
    w.num[RATE, c], w.mark[STATUS, c] = 0.0, CLOSED
    x[CLOSED_NOW] += 1
    w.num[OLDER, c] = w.num[FORCE_NOW, c] = 0.0
    log(record, count, t, c, 0.0, 0.0, 0.0, STICK)


@inline
def release_time(w: Any, c: int, t: float, rest: float, deficit: float) -> float:
    """When the contact force vanished, between its last positive mean and the first that would be negative."""
    if not w.num[OLDER, c] > 0.0:
        return t
    middle = t + 0.5 * rest
    found = w.num[OLDER_TIME, c] + (middle - w.num[OLDER_TIME, c]) * w.num[OLDER, c] / (
        w.num[OLDER, c] + deficit
    )
    return min(max(found, w.num[OLDER_TIME, c]), t + rest)


def release(w: Any, record: Any, count: Any, x: Any, c: int, t: float, after: float) -> None:
    """A closed contact opens."""
    w.mark[STATUS, c], w.mark[GROUNDED, c] = OPEN, 1
    x[CLOSED_NOW] -= 1
    w.num[FORCE_NOW, c] = w.num[OLDER, c] = 0.0
    w.num[GAP, c], w.num[RATE, c] = 0.0, after
    log(record, count, t, c, 0.0, after, 0.0, RELEASE)
    x[EVENTS] += 1


def land(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, tau: float, count: Any) -> bool:
    """Gap velocities of closed contacts back to zero, with the normals at the end of the piece.

    A contact that would have to be pulled for that opens. Where the motion is the trapezoidal rule's, impulses act as
    forces over the piece do: damping answers them.
    """
    place, n_k = (int(x[MADE_WITH]) if plan.constant else INERTIA), 0
    W, MG = (w.WA[place], w.AG[place]) if plan.constant else (w.W, w.MG)
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == CLOSED:
            w.mark[CHOSEN, n_k] = c
            w.num[Z, n_k] = 0.5 * tau * w.num[FORCE_NOW, c]
            w.num[B, n_k] = product(w.G, w.vec[V], c) + w.num[GAP_T, c]
            n_k += 1
    if n_k == 0:
        return True
    if not solve_chosen(m, plan, w, W, place, n_k, count):
        return False
    for k in range(n_k):
        c, p = w.mark[CHOSEN, k], w.num[Z, k]
        w.num[P, c] = p
        w.num[IMPULSE, c] += p
        pass_on(w, c, p, PIECE)
        for i in range(w.vec.shape[1]):
            w.vec[V, i] += MG[c, i] * p
    for k in range(n_k):
        c = w.mark[CHOSEN, k]
        if w.num[P, c] == 0.0 and tau > 0.0:
            u, size = product(w.G, w.vec[V], c) + w.num[GAP_T, c], abs(w.num[GAP_T, c])
            for i in range(w.vec.shape[1]):
                size += abs(w.G[c, i] * w.vec[V, i])
            if u > ROUNDING * size:
                lost = 2.0 * u / (tau * W[c, c])
                force = w.num[FORCE_NOW, c]
                share = force / (force + lost) if force > 0.0 else 0.0
                release(w, record, count, x, c, t - tau + tau * share, u)
    return True


# --- impacts --------------------------------------------------------------------------------------------------


def strike(m: Any, plan: Any, w: Any, x: Any, record: Any, first: int, t: float, count: Any) -> int:
    """The impact of contact `first`, and of those that fire with it, or (CORNER) of those whose velocity jumps.

    Returns how many took part, -1 where the impact was not solved.
    """
    n_s = choose_jumping(m, plan, w, x, t) if first == CORNER else choose_struck(plan, w, first)
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
    jump(w, n_s)
    still = 0.0
    for k in range(n_s):
        still = max(still, ROUNDING * abs(w.num[BEFORE, w.mark[CHOSEN, k]]))
    for k in range(n_s):
        after_impact(m, w, x, record, w.mark[CHOSEN, k], w.num[Z, k], t, still, count)
    x[EVENTS] += 1
    return n_s


def choose_struck(plan: Any, w: Any, first: int) -> int:
    """Contacts that fire now; their number.

    Those that close with one speed land together, those that touched before are pushed together. Others whose gaps
    happen to be zero at the same time are struck one after another, as they would be a little apart.
    """
    w.mark[CHOSEN, 0] = first
    u, n_s = w.num[RATE, first], 1
    touched = w.mark[GROUNDED, first] == 1 and w.num[LAST, first] < 0.0
    w.num[GAP, first], w.mark[GROUNDED, first] = 0.0, 1
    for c in range(w.num.shape[1]):
        w.num[BEFORE, c] = w.num[RATE, c]
        if c != first and w.mark[STATUS, c] == OPEN and w.num[RATE, c] < 0.0 and w.num[GAP, c] <= plan.slack:
            pushed = touched and w.mark[GROUNDED, c] == 1 and w.num[LAST, c] < 0.0
            if pushed or abs(w.num[RATE, c] - u) <= SAME_SPEED * abs(u):
                w.mark[CHOSEN, n_s] = c
                w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, 1
                n_s += 1
    return n_s


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
    if w.mark[CLOSE_HITS, c] >= IN_A_ROW:
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


def jump(w: Any, n_s: int) -> None:
    """Velocities after the impulses z of the chosen contacts; what rounding leaves of zero is zero."""
    n, n_c = w.vec.shape[1], w.num.shape[1]
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
        if abs(w.vec[V, i]) <= ROUNDING * w.vec[V_TRY, i]:
            w.vec[V, i] = 0.0
    for k in range(n_s):
        d, p = w.mark[CHOSEN, k], w.num[Z, k]
        if p > 0.0:
            for c in range(n_c):
                w.num[RATE, c] += w.W[c, d] * p


def after_impact(
    m: Any, w: Any, x: Any, record: Any, c: int, p: float, t: float, still: float, count: Any
) -> None:
    """Note the impact of a contact; the velocity it leaves with, to the last digit."""
    r, before = m.restitution[c], min(w.num[BEFORE, c], 0.0)
    w.num[IMPULSE, c] += p
    if w.mark[STATUS, c] == CLOSED:
        if p > 0.0:
            w.num[RATE, c] = 0.0
            log(record, count, t, c, 0.0, 0.0, p, IMPACT)
        elif w.num[RATE, c] > still:
            release(w, record, count, x, c, t, w.num[RATE, c])
        else:
            w.num[RATE, c] = 0.0
        return
    if p == 0.0:
        return
    if w.mark[PLASTIC, c] == 1:
        T = 0.0
        if w.num[HALF, c] < 0.0 and w.mark[CLOSE_HITS, c] < IN_A_ROW:
            T = r * before / w.num[HALF, c] / (1.0 - r)
            p += -2.0 * w.num[HALF, c] * T / w.W[c, c]
        log(record, count, t + T, c, before, 0.0, p, ACCUMULATION)
        stick(w, record, count, x, c, t + T)
        return
    w.num[RATE, c] = -r * before if r > 0.0 else 0.0
    log(record, count, t, c, before, w.num[RATE, c], p, IMPACT)
    if r == 0.0:
        stick(w, record, count, x, c, t)


def settle_rest(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, count: Any) -> bool:
    """After too many events in one step: one problem for the rest of it, plastic and without penetration.

    0 <= g + rest (u+ + rest half)  complementary to  p >= 0.
    """
    n_c, rest = w.num.shape[1], x[END] - x[SIGMA]
    for c in range(n_c):
        w.mark[CHOSEN, c], w.num[Z, c] = c, 0.0
        w.num[B, c] = w.num[GAP, c] / rest + w.num[RATE, c] + rest * w.num[HALF, c]
        w.num[BEFORE, c] = w.num[RATE, c]
    if not solve_chosen(m, plan, w, w.W, INERTIA, n_c, count):
        return False
    jump(w, n_c)
    for c in range(n_c):
        w.num[IMPULSE, c] += w.num[Z, c]
        if w.num[Z, c] > 0.0:
            log(record, count, t, c, w.num[BEFORE, c], w.num[RATE, c], w.num[Z, c], IMPACT)
        elif w.mark[STATUS, c] == CLOSED and w.num[RATE, c] > 0.0:
            release(w, record, count, x, c, t, w.num[RATE, c])
    return True
