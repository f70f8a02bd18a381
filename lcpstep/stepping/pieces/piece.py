"""A piece of motion of `Located`, as kernels: its accelerations and gap quadratics, where it ends, and the way there.

Over the piece q(tau) = q + v tau + a tau^2 / 2; the gap of an open contact is g + u tau + half tau^2, whose first
zero ends it (`quadratic`). Where gaps are no quadratics the zero is put right by Newton's method.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gaps, moves, obstacle
from lcpstep.kernels.model import Model
from lcpstep.kernels.quadratic import first_zero, may_reach_zero
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import DONE, LCP_FAILED, NOT_FINITE
from lcpstep.kernels.together import gap_rounding
from lcpstep.kernels.vectors import copy, distance, product
from lcpstep.pointers import abs, after, max, min
from lcpstep.stepping.pieces.codes import CLOSED, LEFT, NOBODY, OPEN
from lcpstep.stepping.pieces.contact_forces import hold, stop_closed
from lcpstep.stepping.pieces.keep import keep_between, keep_times, remember
from lcpstep.stepping.pieces.smooth import (
    ON_THE_SURFACE,
    accelerate,
    advance,
    gap_accelerations,
    gap_bias,
    look_along,
    measure,
    put_on_surface,
    renew_mobility,
)
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.switches import stick
from lcpstep.stepping.pieces.times import driven_by, untold, within

POLISHING = 8  # Newton iterations onto a gap that is no quadratic
BRIEF = 1.0 / 8.0  # of a piece: hops that last no longer obey the acceleration at their beginning


def begin_piece(m: Model, plan: Plan, w: Work, t: float) -> bool:
    """Accelerations and gap quadratics of the piece that begins at t."""
    n_c = w.n_c
    accelerate(m, plan, w)
    if n_c == 0:
        copy(w.a, w.a_free, w.n_q)
        return True
    closed = w.closed_now > 0 or w.touching
    if w.unchanged and not closed:
        return True
    w.unchanged = plan.steady and plan.plain and not closed
    if m.flat:
        flat_accelerations(m, plan, w, t)
    elif needs_bias(plan, w):
        gap_bias(m, w, t, w.q, w.v)
        gap_accelerations(w, w.a_free)
    if closed and not plan.constant and not renew_mobility(m, plan, w, t):
        return False
    if not hold(m, plan, w, t):
        return False
    if plan.constant:
        for c in range(n_c):
            w.half[c] = 0.5 * (w.alpha[c] + w.bend[c])
        if closed:
            pressed(plan, w)
    else:
        fit_gaps(m, plan, w, t)
    for c in range(n_c):
        if w.status[c] == CLOSED:
            w.gap[c] = w.velocity[c] = w.half[c] = 0.0
        elif w.grounded[c] == LEFT:
            w.half[c] = max(w.half[c], 0.0)
    return True


def flat_accelerations(m: Model, plan: Plan, w: Work, t: float) -> None:
    """Mean accelerations of the gaps of flat contacts over the piece without contact forces.

    In w.alpha so that the velocity is right at the end; w.bend is what must be added for the position. A hop that is
    soon over obeys the obstacle's acceleration at its beginning: by the mean it would land with another speed than it
    has begun with, always higher or always lower, thousands of times in a piece.
    """
    if not plan.steady or moves(m):
        for c in range(w.n_c):
            w.alpha[c] = product(m.G, w.a_free, c, w.n_q)
    if moves(m):
        obstacle(m, within(w, t), w.q, w.v)
        for c in range(w.n_c):
            s, s_end = m.motion_now[c * 3 + 2], w.end_s[c]
            w.alpha[c] -= 0.5 * (s + s_end)
            w.bend[c] = (s_end - s) / 6.0
            if (
                from_ground(plan, w, c)
                and 0.0 < 2.0 * w.velocity[c] < -BRIEF * (w.end - w.sigma) * w.alpha[c]
            ):
                w.bend[c] = 0.5 * (s_end - s)
            w.bias[c] = -0.5 * (s + s_end)


def pressed(plan: Plan, w: Work) -> None:
    """Add to the gap quadratics what contact forces do."""
    WA = after(plan.WA, w.made_with * w.n_c * w.n_c)
    for d in range(w.n_c):
        force = w.force_now[d]
        if w.status[d] == CLOSED and force > 0.0:
            for c in range(w.n_c):
                w.half[c] += 0.5 * WA[c * w.n_c + d] * force


def fit_gaps(m: Model, plan: Plan, w: Work, t: float) -> None:
    """Gap quadratics that fit the gap at the end of the piece; from accelerations where gaps tell less than these."""
    rest = w.end - w.sigma
    look_along(w, rest)
    gaps(m, t + rest, w.q_try, w.v, w.gap_try)
    for c in range(w.n_c):
        grounded = from_ground(plan, w, c)
        if grounded:
            w.half[c] = 0.5 * (product(w.G, w.a, c, w.n_q) + w.bias[c])
        if not grounded or comes_back(plan, w, c, rest):
            w.half[c] = (w.gap_try[c] - w.gap[c] - rest * w.velocity[c]) / (rest * rest)


def comes_back(plan: Plan, w: Work, c: int, rest: float) -> bool:
    """Whether a gap that has just been left is closed at the end, where its acceleration at the base says it is open.

    As where a body crosses a round obstacle from side to side. A low hop is left to the end of the piece.
    """
    end, rise = w.gap_try[c], rest * w.velocity[c]
    return end < -plan.slack and rise > -end and rise + rest * rest * w.half[c] > 0.0


def needs_bias(plan: Plan, w: Work) -> bool:
    """Whether some contact is closed or has just been left."""
    some = False
    for c in range(w.n_c):
        some = some or w.status[c] == CLOSED or from_ground(plan, w, c)
    return some


def from_ground(plan: Plan, w: Work, c: int) -> bool:
    """Whether gap c has just been left, or is still no more than rounding of the positions that it is made of."""
    return w.grounded[c] != 0 or w.gap[c] <= plan.slack


def first_contact(plan: Plan, w: Work, rest: float, t_end: float, past: float, but: int) -> tuple[int, float]:
    """Which gap closes first, and when; NOBODY and the end of the piece if none does.

    What closes before `past` is left out, and at `past` contacts up to number `but`.
    """
    found, tau = NOBODY, rest + untold(t_end, plan.h)
    for c in range(w.n_c):
        if w.status[c] == OPEN and may_reach_zero(w.gap[c], w.velocity[c], w.half[c], tau):
            zero = first_zero(w.gap[c], w.velocity[c], w.half[c])
            told = min(zero, rest)  # as it was told of before
            if told < past or (told == past and c <= but):
                continue
            if zero < tau or (zero == 0.0 and tau == 0.0 and w.velocity[c] < w.velocity[found]):
                found, tau = c, zero
    return found, min(tau, rest)


def polish(m: Model, plan: Plan, w: Work, c: int, t: float, tau: float, rest: float) -> tuple[int, float]:
    """The zero of a gap that is a quadratic but approximately; NOBODY where the quadratic was wrong."""
    if tau == 0.0:
        return c, 0.0
    low, high = 0.0, -1.0
    for _ in range(POLISHING):
        look(m, w, t, tau)
        u = w.velocity[c] + 2.0 * tau * w.half[c]
        if abs(w.gap_try[c]) <= max(0.125 * plan.slack, driven_by(w, c, t)):
            return c, tau
        if w.gap_try[c] > 0.0:
            low = tau
        else:
            high = tau
        if u >= 0.0:
            break
        change = -w.gap_try[c] / u
        if tau + change > rest:
            look(m, w, t, rest)  # a bump narrower than the piece may rise at its end
            if w.gap_try[c] >= -ON_THE_SURFACE * plan.slack:
                return NOBODY, rest
            return c, between(m, w, c, t, tau, rest)
        if tau + change <= 0.0:
            break
        tau += change
        if abs(change) <= RESOLUTION * tau:
            return c, tau
    look(m, w, t, tau)
    if w.gap_try[c] > 0.0:
        if high > tau:  # time may be too coarse for the step back from where the gap was closed
            return c, between(m, w, c, t, tau, high)
        # on a steep side the state has no place that is nearer to zero
        falls = w.velocity[c] + 2.0 * tau * w.half[c] < 0.0
        near = falls and w.gap_try[c] <= gap_rounding(m, w.G, w.q, c, 0.0)
        return (c if near else NOBODY), tau
    if low > tau or not (low > 0.0 or w.gap[c] > plan.slack):
        return c, tau
    return c, between(m, w, c, t, low, tau)


def look(m: Model, w: Work, t: float, tau: float) -> None:
    """The gaps at tau after the base of the piece, which is at t, into w.gap_try."""
    look_along(w, tau)
    gaps(m, t + tau, w.q_try, w.v, w.gap_try)


def between(m: Model, w: Work, c: int, t: float, low: float, high: float) -> float:
    """Where a gap that is open at `low` and negative at `high` closes between them: by bisection."""
    w.bracket.begin(low, high, True, 0.5 * (low + high))
    while w.bracket.seek(RESOLUTION * w.bracket.b):
        look(m, w, t, w.bracket.x)
        w.bracket.halve(w.gap_try[c] > 0.0)  # the first zero, where rounding makes many
    return w.bracket.b


def move(m: Model, plan: Plan, w: Work, tau: float, to_end: bool) -> int:
    """Go on to w.sigma + tau; contacts that were closed all the way stay on the surface."""
    now = w.t_step + w.sigma
    end = now + tau - untold(now + tau, plan.h)  # to rounding: states there come after the impact
    wanted = w.record.awaited() < end
    if wanted and plan.plain:
        keep_times(w, now, end)
    elif wanted:
        remember(w)
    taken = False
    if tau > 0.0:
        if not advance(m, plan, w, within(w, now), tau):
            return NOT_FINITE
        if not m.linear:
            taken = take_back(plan, w, now + tau)
        for c in range(w.n_c):
            w.grounded[c] = 0
    w.sigma = w.end if to_end else w.sigma + tau
    if to_end and m.linear and not plan.steady:
        copy(w.force, w.next_force, w.n_q)
    if tau > 0.0 and (w.closed_now > 0 or penetrates(plan, w)):
        if plan.plain:
            if to_end:
                put_on_surface(m, plan, w, now + tau, w.q)
        else:
            if not renew_mobility(m, plan, w, now + tau):
                return NOT_FINITE
            if not stop_closed(m, plan, w, now, tau):
                return LCP_FAILED
            if taken or penetrates(plan, w):
                copy(w.q_try, w.q, w.n_q)
                put_on_surface(m, plan, w, now + tau, w.q)
                w.off = distance(w.q, w.q_try, w.n_q)
            measure(m, w, now + tau)
    if wanted and not plan.plain:
        keep_between(m, plan, w, now, tau, end)
    return DONE


def take_back(plan: Plan, w: Work, t: float) -> bool:
    """Contacts let go at the base, that have not risen when their velocity points back, have never left: if any.

    The acceleration of the base lets them go; of what it grows to within the piece it tells nothing.
    """
    taken = False
    for c in range(w.n_c):
        if w.grounded[c] == LEFT and w.status[c] == OPEN and w.gap[c] <= plan.slack and w.velocity[c] < 0.0:
            stick(w, c, t)
            taken = True
    return taken


def penetrates(plan: Plan, w: Work) -> bool:
    """Whether an open contact has been closed by what its quadratic neglects."""
    lowest = 0.0
    for c in range(w.n_c):
        if w.status[c] == OPEN:
            lowest = min(lowest, w.gap[c])
    return not plan.plain and lowest < -ON_THE_SURFACE * plan.slack
