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
from lcpstep.recording import write_event
from lcpstep.stepping.joint_tasks import PIECE
from lcpstep.stepping.located_joints import pass_on
from lcpstep.stepping.located_work import (
    A_TRY,
    ALPHA,
    CHOSEN,
    CLOSED,
    CLOSED_NOW,
    END,
    EVENT,
    EVENTS,
    FORCE_NOW,
    FREE,
    GAP,
    GAP_T,
    GROUNDED,
    IMPULSE,
    INERTIA,
    MADE_WITH,
    OLDER,
    OLDER_TIME,
    OPEN,
    RATE,
    RELEASE,
    ROUNDING,
    SIGMA,
    STATUS,
    STICK,
    A,
    B,
    P,
    V,
    Z,
)
from lcpstep.stepping.refine import keep_closed, solve_chosen


@inline
def log(record: Any, count: Any, t: float, c: int, before: float, after: float, p: float, kind: int) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, c, before, after, p, kind)
    count[EVENT] += 1


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
