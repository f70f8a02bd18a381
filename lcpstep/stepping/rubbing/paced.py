"""Steps with friction chosen by a tolerance, as kernels: one step of h is compared with two of h/2.

A step is taken where its error, relative to 1 + the size of the motion, is no more than its share h / span of the
tolerance, as by `by_tolerance`: errors of the whole motion are proportional to it, up to what the motion itself
magnifies. It ends at its first event, which is located on the motion taken; what comes after is compared anew. Gaps,
sliding velocities and forces that may have come to zero unseen within the step count by how far half the step finds
them from their polynomials. Source: E. Hairer, S. Norsett, G. Wanner, Solving Ordinary Differential Equations I
(Springer 1993), section II.4.
"""

from __future__ import annotations

from math import pow

import cython

from lcpstep.events.contacts.guards import read_with_rates
from lcpstep.events.contacts.state import GUARDS
from lcpstep.events.contacts.step import mark_resting
from lcpstep.events.rows.jumps import farthest_off, find_jump
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, STEP_TOO_SMALL
from lcpstep.kernels.vectors import copy, distance, largest
from lcpstep.pointers import abs, after, inf, max, min
from lcpstep.stepping.by_tolerance.control import relative_error
from lcpstep.stepping.by_tolerance.sizes import LEAST_SHARE, NEAR, ROUNDED
from lcpstep.stepping.rubbing.found import curve, measure_base, note_arrival, note_middle
from lcpstep.stepping.rubbing.let_go import is_motion
from lcpstep.stepping.rubbing.strides import Strides, go_on_with, push_end_back

SAFETY, LEAST, MOST = 0.9, 0.2, 2.0  # of the change of step
STEEP = 1.585  # an error that falls by no more than this power of the step, a third at half of it, comes from a jump


def pace(s: Strides, t: float, longest: float) -> int:
    """Step from t no longer than `longest` that meets the tolerance, of size `length`; a status.

    Rates that the step before has arrived with are as good as it was long: for a shorter one they are made anew.
    No size is left where a velocity has jumped: there is a corner then, and the size is zero. Errors that do not fall
    with the step ask for that: sizes would shrink to none that is told from its neighbours, within which a jump of
    what slides has no place.
    """
    h, before, longer = min(s.next_step, longest), inf, inf
    truncated = h < s.next_step
    while True:
        s.rows.culprit = -1
        error = inf
        exact = (t + h) - t  # the time that the step ends at, far from t = 0, is known to it
        h = exact if 0.0 < exact < longest else h
        if halves(s, t, h) and s.step(t, h) and note_arrival(s, t, h):
            error = weigh(s, h)
        share = h / s.span
        steep = error < inf and error > before * pow(h / longer, STEEP)
        if steep:
            share = max(share, LEAST_SHARE)
        allowed = share * s.tolerance
        if error <= allowed:
            break
        if h <= 4.0 * RESOLUTION * max(abs(t), s.span) or s.tolerance < ROUNDED:
            if not error < inf or s.tolerance < ROUNDED or t + h >= s.rows.high:
                return why(s, error)
            s.rows.break_at(t + h)
            s.length = 0.0
            return DONE
        if steep and leaps(s, h):
            s.length = 0.0
            return DONE
        if longer == inf and not measure_base(s, t):
            return why(s, inf)
        longer = h
        h *= 0.5 if before == inf else change(s, allowed, error)
        before, truncated = error, False
    s.next_step = max(h * max(change(s, allowed, error), 1.0), s.next_step if truncated else 0.0)
    s.size_q = largest(s.y_new, s.size_q, s.n_q)
    s.size_v = largest(after(s.y_new, s.n_q), s.size_v, s.n_q)
    s.length = h
    return DONE


def leaps(s: Strides, h: float) -> bool:
    """Whether the velocity of a row at rest jumps within the step of size h just made; at a corner then."""
    mark_resting(s)
    i = farthest_off(s.rows, s)
    return i >= 0 and find_jump(s.rows, s, i, h)


def why(s: Strides, error: float) -> int:
    """Why no step was short enough."""
    if s.rows.culprit >= 0:
        return PAINLEVE_INCONSISTENT
    return STEP_TOO_SMALL if error < inf else NOT_FINITE


def change(s: Strides, allowed: float, error: float) -> float:
    """By how much to change the step after an error of this size."""
    if error <= 0.0:
        return MOST
    return min(MOST, max(LEAST, SAFETY * pow(allowed / error, 1.0 / s.order)))


def halves(s: Strides, t: float, h: float) -> bool:
    """Two steps of half the size, to `refined`, guards between them into `half_value`; False where they fail.

    They end when the step does, however the time between is rounded: driven joints would be elsewhere else, by more
    than short steps may be wrong.
    """
    n, between = s.n, t + 0.5 * h
    first, second = between - t, (t + h) - between
    if not (s.step(t, first) and read_with_rates(s, between, s.y_new)):
        return False
    copy(s.half_value, s.value, GUARDS * s.n_c)
    note_middle(s, t, first, s.quarter_value)
    copy(s.stored, s.y, n)
    copy(s.stored_rates, s.K, n)
    copy(s.stored_forces, s.leaving, s.n_r)
    push_end_back(s, after(s.y_new, s.n_q))
    copy(s.y, s.y_new, n)
    go_on_with(s)
    good = s.step(between, second)
    if good:
        note_middle(s, between, second, s.late_value)
        push_end_back(s, after(s.y_new, s.n_q))
    copy(s.refined, s.y_new, n)
    copy(s.y, s.stored, n)
    copy(s.K, s.stored_rates, n)
    copy(s.leaving, s.stored_forces, s.n_r)
    return good


def weigh(s: Strides, h: float) -> float:
    """The error of the step, relative to the motion; of what may have happened unseen in it, too."""
    v, n = s.dv, s.n_q  # on the rows held
    wrong_q, wrong_v = distance(s.y_new, s.refined, n), distance(v, after(s.refined, n), n)
    for g in range(GUARDS * s.n_c):
        least, off = curve(s, g, h), strayed(s, g)
        if least > NEAR * off or s.begin_value[g] <= s.band[g]:
            continue
        if not is_motion(s, g):
            i = s.n_j + g // GUARDS
            wrong_v = max(wrong_v, off * h * s.W[i * s.n_r + i])
        elif g % GUARDS == 0:
            wrong_q = max(wrong_q, off)
        else:
            wrong_v = max(wrong_v, off)
    size_q, size_v = largest(s.y_new, s.size_q, n), largest(v, s.size_v, n)
    return relative_error(wrong_q, wrong_v, size_q, size_v, s.tolerance)


def strayed(s: Strides, g: int) -> float:
    """How far guard g, whose polynomial is at hand, is from it where that was not made from it."""
    if s.order == 4 and s.rows.n_held > 0 and not is_motion(s, g):
        early = abs(value_at(s, 0.25) - s.quarter_value[g])
        return max(early, abs(value_at(s, 0.75) - s.late_value[g]))
    return abs(value_at(s, 0.5) - s.half_value[g])


def value_at(s: Strides, x: float) -> float:
    """The polynomial at hand, of degree three, at the fraction x of the step."""
    b, y = s.scan.c, 1.0 - x
    return y * y * (y * b[0] + 3.0 * x * b[1]) + x * x * (3.0 * y * b[2] + x * b[3])
