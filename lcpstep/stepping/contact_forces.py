"""Forces of the closed contacts of `Located`, as kernels: who needs none opens.

    0 <= alpha       complementary to  lambda >= 0       on all closed contacts, alpha the gap accelerations

at the start of a piece (`hold`), and the same of gap velocities and impulses at its end (`land`), where normals turn
or obstacles move. A contact that would have to be pulled opens. Source: G. Osorio, Complex Behavior in Impacting
Systems, eq. 3.15.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign
from lcpstep.dynamics import product
from lcpstep.stepping.joint_tasks import PIECE
from lcpstep.stepping.located_joints import pass_on
from lcpstep.stepping.located_work import (
    A_TRY,
    ALPHA,
    CHOSEN,
    CLOSED,
    END,
    FALL,
    FORCE_NOW,
    FREE,
    GAP_T,
    GROUND,
    GROUNDED,
    IMPULSE,
    INERTIA,
    LEFT,
    MADE_WITH,
    OLDER,
    OLDER_TIME,
    OPEN,
    RATE,
    ROUNDING,
    SIGMA,
    STATUS,
    TOUCHING,
    A,
    B,
    P,
    V,
    Z,
)
from lcpstep.stepping.magnitudes import acceleration_terms, speed_terms
from lcpstep.stepping.refine import keep_closed, solve_chosen
from lcpstep.stepping.switches import release, release_time, stick, turn


def hold(m: Any, plan: Any, w: Any, x: Any, record: Any, place: int, t: float, count: Any) -> bool:
    """Forces of the contacts that rest from w.num[ALPHA], and the acceleration with them; who needs none opens.

    All that touch at rest are decided in one problem: to add them one by one could go on for ever.
    """
    n = w.vec.shape[1]
    assign(w.vec[A], w.vec[FREE])
    n_k = choose_resting(w, x)
    if n_k == 0:
        return True
    for c in range(w.num.shape[1]):
        w.num[FALL, c] = 0.0
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


def zero_rounding(plan: Any, w: Any) -> None:
    """What is but rounding of the sums in w.vec[A_TRY] is zero: accelerations, and velocities that they made."""
    for i in range(w.vec.shape[1]):
        if abs(w.vec[A, i]) <= ROUNDING * w.vec[A_TRY, i]:
            w.vec[A, i] = 0.0
            if plan.plain and abs(w.vec[V, i]) <= ROUNDING * w.vec[A_TRY, i] * plan.h:
                w.vec[V, i] = 0.0


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
