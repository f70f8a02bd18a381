"""Forces of the closed contacts of `Located`, as kernels, and how contacts close and open without an impact.

    0 <= alpha       complementary to  lambda >= 0       on all closed contacts, alpha the gap accelerations

at the start of a piece (`hold`), and the same of gap velocities and impulses at its end (`land`), where normals turn
or obstacles move. A contact that would have to be pulled opens. Source: G. Osorio, Complex Behavior in Impacting
Systems, eq. 3.15.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import product
from lcpstep.model import ABSENT
from lcpstep.recording import write_event
from lcpstep.stepping.joint_tasks import PIECE
from lcpstep.stepping.located_joints import pass_on
from lcpstep.stepping.located_work import (
    A_TRY,
    ALPHA,
    BIAS,
    CHOSEN,
    CLOSED,
    CLOSED_NOW,
    END,
    EVENT,
    EVENTS,
    FIRST_COORDINATE,
    FORCE,
    FORCE_NOW,
    FREE,
    GAP,
    GAP_T,
    GROUND,
    GROUNDED,
    IDLE,
    IMPULSE,
    INERTIA,
    JOLT,
    LAST_COORDINATE,
    LEFT,
    MADE_WITH,
    OLDER,
    OLDER_TIME,
    OPEN,
    RATE,
    RELEASE,
    ROUNDING,
    SIGMA,
    STALLED,
    STATUS,
    STICK,
    SWING,
    TOUCHING,
    TURNED,
    TURNS,
    A,
    B,
    P,
    Q,
    V,
    Z,
)
from lcpstep.stepping.refine import keep_closed, solve_chosen

COLLAPSE = 1e-9  # of a step: what happens as close in time as this happens at one instant
FAINT = 1e-10  # of the velocities that have acted in a step: the end of a sequence of events at one instant
AT_ONCE = 16  # events of one contact at one instant after which faint ones are settled,
AT_ONCE_FAST = 1000  # all but strikes of elastic contacts,
AT_ONCE_ELASTIC = 100_000  # and all


@inline
def log(record: Any, count: Any, t: float, c: int, before: float, after: float, p: float, kind: int) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, c, before, after, p, kind)
    count[EVENT] += 1


def hold(m: Any, plan: Any, w: Any, x: Any, record: Any, place: int, t: float, count: Any) -> bool:
    """Forces of the contacts that rest from w.num[ALPHA], and the acceleration with them; who needs none opens.

    All that touch at rest are decided in one problem: to add them one by one could go on for ever.
    """
    n = w.vec.shape[1]
    assign(w.vec[A], w.vec[FREE])
    n_k = choose_resting(w, x)
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
            alpha = leaving(m, w, W, k, n_k)
            if alpha > 0.0:
                if w.mark[STATUS, c] == CLOSED:
                    at = release_time(w, c, t, rest, alpha / W[c, c])
                    release(m, plan, w, record, count, x, c, at, 0.0)
                w.mark[GROUNDED, c] = LEFT
                continue
        if w.mark[STATUS, c] == OPEN:
            stick(w, record, count, x, c, t)
            turn(m, plan, w, x, c, 0.0, False)
        w.num[OLDER, c], w.num[OLDER_TIME, c] = force, t + 0.5 * rest
        w.num[FORCE_NOW, c] = force
    return True


def choose_resting(w: Any, x: Any) -> int:
    """Contacts that rest on their obstacles, closed or just touching; their number."""
    n_k = 0
    for c in range(w.num.shape[1]):
        closed = w.mark[STATUS, c] == CLOSED
        if closed or (x[TOUCHING] > 0.0 and w.mark[GROUNDED, c] == GROUND and w.num[RATE, c] == 0.0):
            w.mark[CHOSEN, n_k] = c
            w.num[Z, n_k] = w.num[FORCE_NOW, c] if closed else 0.0
            w.num[B, n_k] = w.num[ALPHA, c]
            n_k += 1
    x[TOUCHING] = 0.0
    return n_k


def leaving(m: Any, w: Any, W: Any, k: int, n_k: int) -> float:
    """Acceleration with which the k-th chosen contact, which carries no force, opens; 0 if it is but rounding."""
    c = w.mark[CHOSEN, k]
    alpha, size = w.num[B, k], 0.0
    for j in range(n_k):
        d = w.mark[CHOSEN, j]
        alpha += W[c, d] * w.num[Z, j]
        size += abs(W[c, d] * w.num[Z, j])
    if alpha <= ROUNDING * (size + abs(w.num[B, k])):
        return 0.0
    return alpha if alpha > ROUNDING * (size + acceleration_terms(m, w, c)) else 0.0


def pulls(m: Any, w: Any, c: int) -> bool:
    """Whether the negative force in w.num[P] of closed contact c is more than rounding of what it balances."""
    size = 0.0
    for d in range(w.num.shape[1]):
        if w.mark[STATUS, d] == CLOSED:
            size += abs(w.W[c, d] * w.num[P, d])
    return -w.W[c, c] * w.num[P, c] > ROUNDING * (size + acceleration_terms(m, w, c))


def acceleration_terms(m: Any, w: Any, c: int) -> float:
    """What the acceleration of a gap without contact forces is made of, signs left aside."""
    acting(m, w)
    size = abs(w.num[BIAS, c])
    for i in range(w.vec.shape[1]):
        size += abs(w.G[c, i]) * w.vec[A_TRY, i]
    return size


def acting(m: Any, w: Any) -> None:
    """What the terms of the accelerations without contact add up to, their signs left aside, into w.vec[A_TRY].

    Their sum may be zero where a spring carries a weight; what rounds is each of them. Of a force that the scene
    gives as a whole nothing finer is known.
    """
    n = w.vec.shape[1]
    for i in range(n):
        w.vec[JOLT, i] = 0.0 if m.mass != ABSENT else abs(w.vec[FORCE, i])
        if m.linear:
            if m.force == ABSENT:
                w.vec[JOLT, i] += abs(m.constant[i]) + abs(m.cosine[i]) + abs(m.sine[i])
            for j in range(n):
                w.vec[JOLT, i] += abs(m.C[i, j] * w.vec[V, j]) + abs(m.K[i, j] * w.vec[Q, j])
    for i in range(n):
        w.vec[A_TRY, i] = abs(w.vec[FREE, i])
        if m.mass == ABSENT:
            for j in range(n):
                w.vec[A_TRY, i] += abs(m.M_inverse[i, j]) * w.vec[JOLT, j]


def zero_rounding(plan: Any, w: Any) -> None:
    """What is but rounding of the sums in w.vec[A_TRY] is zero: accelerations, and velocities that they made."""
    for i in range(w.vec.shape[1]):
        if abs(w.vec[A, i]) <= ROUNDING * w.vec[A_TRY, i]:
            w.vec[A, i] = 0.0
            if plan.plain and abs(w.vec[V, i]) <= ROUNDING * w.vec[A_TRY, i] * plan.h:
                w.vec[V, i] = 0.0


@inline
def idle(x: Any, count: Any) -> None:
    """Count a round of the loop in which nothing was noted: these have an end too."""
    x[EVENTS] += 1.0
    count[IDLE] += 1


def turn(m: Any, plan: Any, w: Any, x: Any, c: int, u: float, struck: bool) -> None:
    """Note that contact c strikes, closes or opens at speed u; where that goes on for ever, the motion is settled.

    What goes on at one instant has no end if its speeds are faint. An elastic contact may be struck as often as
    masses are unlike, and is counted at one and the same time only.
    """
    elastic = struck and m.restitution[c] == 1.0
    if x[SIGMA] - w.num[TURNED, c] > (0.0 if elastic else COLLAPSE * plan.h):
        w.num[TURNS, c] = 0.0
    w.num[TURNED, c] = x[SIGMA]
    w.num[TURNS, c] += 1.0
    if w.num[TURNS, c] < AT_ONCE:
        return
    if elastic:
        most = AT_ONCE_ELASTIC
    else:
        most = AT_ONCE if faint(plan, w, c, u) else AT_ONCE_FAST
    if w.num[TURNS, c] >= most:
        x[STALLED] = 1.0


@inline
def faint(plan: Any, w: Any, c: int, u: float) -> bool:
    """Whether a gap velocity is next to nothing beside what has acted in this step."""
    return abs(u) <= FAINT * speed_terms(plan, w, c)


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


def release(
    m: Any, plan: Any, w: Any, record: Any, count: Any, x: Any, c: int, t: float, after: float
) -> None:
    """A closed contact opens."""
    w.mark[STATUS, c], w.mark[GROUNDED, c] = OPEN, GROUND
    x[CLOSED_NOW] -= 1
    w.num[FORCE_NOW, c] = w.num[OLDER, c] = 0.0
    w.num[GAP, c], w.num[RATE, c] = 0.0, after
    log(record, count, t, c, 0.0, after, 0.0, RELEASE)
    turn(m, plan, w, x, c, after, False)
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
            u = product(w.G, w.vec[V], c) + w.num[GAP_T, c]
            if u > ROUNDING * speed_terms(plan, w, c):
                lost = 2.0 * u / (tau * W[c, c])
                force = w.num[FORCE_NOW, c]
                share = force / (force + lost) if force > 0.0 else 0.0
                release(m, plan, w, record, count, x, c, t - tau + tau * share, u)
    return True


@inline
def speed_terms(plan: Any, w: Any, c: int) -> float:
    """What a gap velocity is made of in this step, signs left aside: velocities, impulses, accelerations.

    Its rounding is measured against that: a speed that falls from impact to impact would never be found small
    beside itself.
    """
    size = abs(w.num[GAP_T, c])
    for i in range(w.mark[FIRST_COORDINATE, c], w.mark[LAST_COORDINATE, c] + 1):
        size += abs(w.G[c, i]) * (w.vec[SWING, i] + abs(w.vec[V, i]) + plan.h * abs(w.vec[FREE, i]))
    return size
