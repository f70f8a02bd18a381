"""Which contact closes, or opens, first, as kernels.

Gaps are looked at on the dense output of a Runge-Kutta step: on an interval short enough for a gap acceleration to
change its sign at most once (`turns_unseen` says which is not), that change splits the gap velocity into monotone
parts, whose changes of sign split the gap into monotone parts; so a gap that dips below zero and returns is found. A
closed contact opens where its multiplier turns negative, be it for a moment between two places looked at: one that
changes by several times its least value may turn there. One whose row depends on those held is looked at anew where
these keep it closed no longer: it opens, or bears what they have borne.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.general.equations import gap_tolerance
    from lcpstep.events.general.held import note, right_hand_side
    from lcpstep.events.general.impact import speed_noise
    from lcpstep.events.general.state import Mechanism
    from lcpstep.events.rows.equations import renew_biases, renew_rates
    from lcpstep.kernels.clock import NOISE, RESOLUTION
    from lcpstep.kernels.dynamics import gaps
    from lcpstep.kernels.together import gap_rounding
    from lcpstep.kernels.vectors import copy, largest, product
    from lcpstep.pointers import abs, max, min

MEETS, LANDS, OPENS, NEVER_LEFT = range(4)  # what a contact does
GAP, SPEED, CURVE, MULTIPLIER = range(4)  # of what a root is looked for
NONE, NEVER = -1.0, -2.0  # in place of a root's time: not known; there is none
UNSEEN = 0.02  # of a gap: what its turns may hide
FALLS = 3.0  # of a multiplier: by how much it is larger beside a turn; a parabola five times


def first_event(s: Mechanism, a: float, b: float) -> float:
    """First contact that closes or opens in (a, b], or NONE.

    The left end is in `left`; the right end has just been observed and goes into `right`. Which contact, and what it
    does (MEETS, LANDS, OPENS, NEVER_LEFT), into `event_contact` and `event_kind`.
    """
    found, noise = NONE, multiplier_noise(s)
    copy(s.right.gap, s.contact.gap, 4 * s.n_c)  # what is observed now will be overwritten
    for c in range(s.n_c):
        tau, kind = NONE, MEETS
        if s.contact.closed[c] == 1:
            left, right, end = s.left.multiplier[c], s.right.multiplier[c], b
            if right >= -noise and falls(s, c, left, right, noise):
                end, right = lowest(s, c, a, b, left, right, noise)
            if right < -noise and s.contact.held_until[c] < s.t0 + end:
                tau, kind = opening(s, c, a, end, left, right), OPENS
            elif s.right.curve[c] != 0.0 and s.contact.held_until[c] < s.t0 + b:
                tau, kind = max(a, s.contact.held_until[c] - s.t0), OPENS
        elif s.contact.lands[c] != NONE:
            if a < s.contact.lands[c] <= b:
                tau, kind = s.contact.lands[c], LANDS
        else:
            left_end = (s.left.gap[c], s.left.speed[c], s.left.curve[c])
            right_end = (s.right.gap[c], s.right.speed[c], s.right.curve[c])
            if left_end[0] <= 0.0 and left_end[1] < -speed_noise(s, c):  # met just where the last event was
                tau = a
            else:
                tau = first_contact(s, c, a, b, left_end, right_end)
            if (
                tau == NONE
                and left_end[0] <= 0.0
                and right_end[0] < -max(gap_noise(s, c), gap_tolerance(s, c))
            ):
                tau, kind = a, NEVER_LEFT
        if tau != NONE and (found == NONE or tau < found):
            found, s.event_contact, s.event_kind = tau, c, kind
    return found


def falls(s: Mechanism, c: int, left: float, right: float, noise: float) -> bool:
    """Whether the multiplier of contact c is so much larger at an end of an interval, or before, that it may turn."""
    most = max(s.before.multiplier[c], max(left, right))
    return most > noise and most > FALLS * min(left, right)


def lowest(
    s: Mechanism, c: int, a: float, b: float, left: float, right: float, noise: float
) -> tuple[float, float]:
    """Where in (a, b) the multiplier of closed contact c is lowest, or negative, and what it is there."""
    observe(s, 0.5 * (a + b))
    s.turn.begin(0.5 * (a + b), 0.5 * (b - a), left, s.contact.multiplier[c], right)
    while s.turn.least >= -noise and s.turn.seek():
        observe(s, s.turn.x)
        s.turn.take(s.contact.multiplier[c])
    return s.turn.lowest, s.turn.least


def opening(s: Mechanism, c: int, a: float, b: float, left: float, right: float) -> float:
    """When the multiplier of closed contact c, negative at b, turns so: after the time up to which it is held."""
    start = max(a, s.contact.held_until[c] - s.t0)
    if start > a:
        observe(s, start)
        left = s.contact.multiplier[c]
    return start if left <= 0.0 else root(s, MULTIPLIER, c, start, left, b, right)


def first_contact(
    s: Mechanism,
    c: int,
    a: float,
    b: float,
    left: tuple[float, float, float],
    right: tuple[float, float, float],
) -> float:
    """First time in (a, b] at which the gap of contact c falls to zero, or NONE.

    left, right : gap, velocity and acceleration at a and b.
    """
    middle, at_middle = b, right
    if left[2] * right[2] < 0.0 and (left[1] < 0.0 or right[1] > 0.0 or right[0] <= 0.0):
        middle = root(s, CURVE, c, a, left[2], b, right[2])
        observe(s, middle)
        at_middle = (s.contact.gap[c], s.contact.speed[c], s.contact.curve[c])
    found = first_in_half(s, c, a, middle, left, at_middle)
    if found == NONE and middle < b:
        found = first_in_half(s, c, middle, b, at_middle, right)
    return found


def first_in_half(
    s: Mechanism,
    c: int,
    a: float,
    b: float,
    left: tuple[float, float, float],
    right: tuple[float, float, float],
) -> float:
    """The same where the gap velocity is monotone."""
    if left[1] * right[1] < 0.0:
        if left[1] > 0.0 and right[0] > 0.0:
            return NONE
        middle = root(s, SPEED, c, a, left[1], b, right[1])
        observe(s, middle)
        g = s.contact.gap[c]
        if left[1] < 0.0 and left[0] > 0.0 and g <= 0.0:
            return root(s, GAP, c, a, left[0], middle, g)
        if left[1] > 0.0:
            return middle if g <= 0.0 else root(s, GAP, c, middle, g, b, right[0])
        return NONE
    if left[0] > 0.0 and right[0] <= 0.0:
        return root(s, GAP, c, a, left[0], b, right[0])
    return NONE


def turns_unseen(s: Mechanism, d: float) -> bool:
    """Whether a gap has turned more often in an interval of length d than its ends in `left` and `contact` show.

    Gaps, speeds and accelerations at the ends of one that is short enough agree,
    g_b = g_a + d (u_a + u_b) / 2 - d^2 (alpha_b - alpha_a) / 12, but for what is little beside the gap.
    """
    for c in range(s.n_c):
        if s.contact.closed[c] == 0 and s.contact.lands[c] == NONE:
            g_a, g_b, rises = (
                s.left.gap[c],
                s.contact.gap[c],
                0.5 * d * (s.left.speed[c] + s.contact.speed[c]),
            )
            bends = d * d * (s.contact.curve[c] - s.left.curve[c]) / 12.0
            unseen = abs(g_b - g_a - rises + bends)
            rounding = gap_noise(s, c) + NOISE * (abs(rises) + abs(bends))
            if unseen > max(UNSEEN * max(abs(g_a), abs(g_b)), rounding):
                return True
    return False


def root(s: Mechanism, level: int, c: int, a: float, f_a: float, b: float, f_b: float) -> float:
    """Root between a and b of the gap of contact c, or of what `level` says; f_a f_b <= 0."""
    s.bracket.span(a, f_a, b, f_b)
    while s.bracket.seek(2.0 * RESOLUTION * abs(s.bracket.x)):
        observe(s, s.bracket.x)
        f = s.contact.gap[level * s.n_c + c]  # all in one piece
        if level < CURVE:
            s.bracket.newton(f, s.contact.gap[(level + 1) * s.n_c + c])
        else:
            s.bracket.chord(f)
    return s.bracket.x


def observe(s: Mechanism, tau: float) -> bool:
    """Gaps, speeds, gap accelerations and multipliers at tau after the base, from the dense output."""
    t = s.t0 + tau
    s.smooth.at(tau / s.length, s.q)
    if not right_hand_side(s, t, s.q, s.dy):
        return False
    if s.n_c > 0:
        gaps(s.model, t, s.q, s.v, s.contact.gap)
        if s.n_held == 0:
            renew_biases(s, t, s.q, s.v)
        renew_rates(s, t, s.q, s.v)
    note(s, s.a)
    known = True
    for c in range(s.n_c):
        u = product(s.contact.G, s.v, c, s.n_q) + s.contact.rate[c]
        s.contact.speed[c] = u
        size = s.contact.gap[c] + u + s.contact.curve[c]
        known = known and size - size == 0.0
    return known


def gap_noise(s: Mechanism, c: int) -> float:
    """Rounding of a gap, at the state last observed: of its terms, and of the time at which an obstacle is there."""
    strayed = s.untold(s.length) * abs(s.contact.rate[c])
    return gap_rounding(s.model, s.contact.G, s.q, c, 0.0) + strayed


def multiplier_noise(s: Mechanism) -> float:
    """Rounding of a multiplier."""
    return NOISE * largest(s.force, largest(s.held, 0.0, s.n_held), s.n_q)
