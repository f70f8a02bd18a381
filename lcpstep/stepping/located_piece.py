"""A piece of motion of `Located`, as kernels: its accelerations and gap quadratics, where it ends, and the way there.

Over the piece q(tau) = q + v tau + a tau^2 / 2; the gap of an open contact is g + u tau + half tau^2, whose first
zero ends it (`quadratic`). Where gaps are no quadratics the zero is put right by Newton's method.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import gaps, moves, obstacle, product
from lcpstep.stepping.contact_forces import hold, land
from lcpstep.stepping.located_joints import (
    load_joints,
    put_on_joints,
    share_out,
)
from lcpstep.stepping.located_keep import keep_between, keep_times, remember
from lcpstep.stepping.located_work import (
    ALPHA,
    BEND,
    BIAS,
    CLOSED,
    CLOSED_NOW,
    END,
    END_S,
    EPS,
    FINISHED,
    FORCE,
    FORCE_NOW,
    FREE,
    GAP,
    GAP_TRY,
    GROUNDED,
    HALF,
    LCP_FAILED,
    LEFT,
    MADE_WITH,
    NEXT_FORCE,
    NEXT_TIME,
    NOBODY,
    NOT_FINITE,
    OPEN,
    Q_TRY,
    RATE,
    ROW,
    SAME_TIME,
    SIGMA,
    STATUS,
    TOUCHING,
    UNCHANGED,
    A,
    Q,
    V,
)
from lcpstep.stepping.quadratic import first_zero, may_reach_zero
from lcpstep.stepping.smooth import (
    ON_THE_SURFACE,
    accelerate,
    advance,
    gap_bias,
    measure,
    put_on_surface,
    refactor,
    respond,
    within,
)

POLISHING = 8  # Newton iterations onto a gap that is no quadratic


@inline
def begin_piece(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, count: Any) -> bool:
    """Accelerations and gap quadratics of the piece that begins at t."""
    n_c = w.num.shape[1]
    place = accelerate(m, plan, w, x, t)
    x[MADE_WITH] = place
    if n_c == 0:
        assign(w.vec[A], w.vec[FREE])
        return True
    closed = x[CLOSED_NOW] > 0 or x[TOUCHING] > 0.0
    if x[UNCHANGED] == 1.0 and not closed:
        return True
    x[UNCHANGED] = 1.0 if plan.steady and plan.plain and not closed else 0.0
    if m.flat:
        flat_accelerations(m, plan, w, t, x)
    elif needs_bias(w):
        gap_bias(m, w, within(plan, x, t), w.vec[Q], w.vec[V])
        for c in range(n_c):
            w.num[ALPHA, c] = product(w.G, w.vec[FREE], c) + w.num[BIAS, c]
    if closed and not plan.constant:
        if not refactor(m, w, t):
            return False
        respond(m, w)
    if not hold(m, plan, w, x, record, place, t, count):
        return False
    if plan.constant:
        for c in range(n_c):
            w.num[HALF, c] = 0.5 * (w.num[ALPHA, c] + w.num[BEND, c])
        if closed:
            pressed(w, place)
    else:
        fitted(m, w, t, x[END] - x[SIGMA])
    for c in range(n_c):
        if w.mark[STATUS, c] == CLOSED:
            w.num[GAP, c] = w.num[RATE, c] = w.num[HALF, c] = 0.0
        elif w.mark[GROUNDED, c] == LEFT:
            w.num[HALF, c] = max(w.num[HALF, c], 0.0)
    return True


def flat_accelerations(m: Any, plan: Any, w: Any, t: float, x: Any) -> None:
    """Mean accelerations of the gaps of flat contacts over the piece without contact forces.

    In w.num[ALPHA] so that the velocity is right at the end; w.num[BEND] is what must be added for the position.
    """
    if not plan.steady or moves(m):
        for c in range(w.num.shape[1]):
            w.num[ALPHA, c] = product(m.G, w.vec[FREE], c)
    if moves(m):
        obstacle(m, within(plan, x, t), w.vec[Q], w.vec[V])
        for c in range(w.num.shape[1]):
            s, s_end = m.motion_now[c, 2], w.num[END_S, c]
            w.num[ALPHA, c] -= 0.5 * (s + s_end)
            w.num[BEND, c] = (s_end - s) / 6.0
            w.num[BIAS, c] = -0.5 * (s + s_end)


@inline
def pressed(w: Any, place: int) -> None:
    """Add to the gap quadratics what contact forces do."""
    for d in range(w.num.shape[1]):
        force = w.num[FORCE_NOW, d]
        if w.mark[STATUS, d] == CLOSED and force > 0.0:
            for c in range(w.num.shape[1]):
                w.num[HALF, c] += 0.5 * w.WA[place, c, d] * force


def fitted(m: Any, w: Any, t: float, rest: float) -> None:
    """Gap quadratics that fit the gap at the end of the piece; from accelerations for contacts just left."""
    for i in range(w.vec.shape[1]):
        w.vec[Q_TRY, i] = w.vec[Q, i] + rest * (w.vec[V, i] + 0.5 * rest * w.vec[A, i])
    gaps(m, t + rest, w.vec[Q_TRY], w.vec[V], w.num[GAP_TRY])
    for c in range(w.num.shape[1]):
        if w.mark[GROUNDED, c] != 0:
            w.num[HALF, c] = 0.5 * (product(w.G, w.vec[A], c) + w.num[BIAS, c])
        else:
            w.num[HALF, c] = (w.num[GAP_TRY, c] - w.num[GAP, c] - rest * w.num[RATE, c]) / (rest * rest)


@inline
def needs_bias(w: Any) -> bool:
    """Whether some contact is closed or has just been left."""
    some = False
    for c in range(w.num.shape[1]):
        some = some or w.mark[STATUS, c] == CLOSED or w.mark[GROUNDED, c] != 0
    return some


@inline
def first_contact(plan: Any, w: Any, rest: float, t_end: float) -> tuple[int, float]:
    """Which gap closes first, and when; NOBODY and the end of the piece if none does."""
    found, tau = NOBODY, rest + SAME_TIME * (abs(t_end) + plan.h)
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == OPEN and may_reach_zero(w.num[GAP, c], w.num[RATE, c], w.num[HALF, c], tau):
            zero = first_zero(w.num[GAP, c], w.num[RATE, c], w.num[HALF, c])
            if zero < tau or (zero == 0.0 and tau == 0.0 and w.num[RATE, c] < w.num[RATE, found]):
                found, tau = c, zero
    return found, min(tau, rest)


@inline
def polish(m: Any, plan: Any, w: Any, c: int, t: float, tau: float, rest: float) -> tuple[int, float]:
    """The zero of a gap that is a quadratic but approximately; NOBODY where the quadratic was wrong."""
    if tau == 0.0:
        return c, 0.0
    for _ in range(POLISHING):
        for i in range(w.vec.shape[1]):
            w.vec[Q_TRY, i] = w.vec[Q, i] + tau * (w.vec[V, i] + 0.5 * tau * w.vec[A, i])
        put_on_joints(w, t + tau, plan.slack, w.vec[Q_TRY])
        gaps(m, t + tau, w.vec[Q_TRY], w.vec[V], w.num[GAP_TRY])
        u = w.num[RATE, c] + 2.0 * tau * w.num[HALF, c]
        if abs(w.num[GAP_TRY, c]) <= 0.125 * plan.slack:
            return c, tau
        if u >= 0.0:
            break
        change = -w.num[GAP_TRY, c] / u
        if tau + change > rest:
            return NOBODY, rest
        if tau + change <= 0.0:
            break
        tau += change
        if abs(change) <= EPS * tau:
            return c, tau
    if w.num[GAP_TRY, c] > 0.0:
        return NOBODY, tau
    return c, tau


@inline
def move(
    m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, tau: float, to_end: bool, count: Any
) -> int:
    """Go on to x[SIGMA] + tau; contacts that were closed all the way stay on the surface."""
    now, first_row = t + x[SIGMA], count[ROW]
    load_joints(w)
    end = now + tau - SAME_TIME * (abs(now + tau) + plan.h)  # to rounding: states there come after the impact
    wanted = count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] < end
    if wanted and plan.plain:
        keep_times(m, plan, w, x, record, count, now, end)
    elif wanted:
        remember(w)
    if tau > 0.0:
        for c in range(w.num.shape[1]):
            w.mark[GROUNDED, c] = 0
        if not advance(m, plan, w, x, within(plan, x, now), tau, count):
            return NOT_FINITE
    x[SIGMA] = x[END] if to_end else x[SIGMA] + tau
    if to_end and plan.trapezoidal and not plan.steady:
        assign(w.vec[FORCE], w.vec[NEXT_FORCE])
    if tau > 0.0 and (x[CLOSED_NOW] > 0 or penetrates(plan, w)):
        if plan.plain:
            if to_end:
                put_on_surface(m, plan, w, now + tau)
        else:
            if not plan.constant:
                if not refactor(m, w, now + tau):
                    return NOT_FINITE
                respond(m, w)
            if not land(m, plan, w, x, record, now + tau, tau, count):
                return LCP_FAILED
            if penetrates(plan, w):
                put_on_surface(m, plan, w, now + tau)
            measure(m, plan, w, x, now + tau)
    if wanted and not plan.plain:
        keep_between(m, plan, w, x, record, count, now, tau, end)
    share_out(w, record, count, first_row, now, tau)
    return FINISHED


@inline
def penetrates(plan: Any, w: Any) -> bool:
    """Whether an open contact has been closed by what its quadratic neglects."""
    lowest = 0.0
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == OPEN:
            lowest = min(lowest, w.num[GAP, c])
    return not plan.plain and lowest < -ON_THE_SURFACE * plan.slack
