"""The first event within a step with friction, and its time, as kernels.

Over a step each guard (`events.contacts.guards`) is a polynomial of degree three at most: gaps and sliding velocities
from their values and slopes at the ends, forces from their values there and, with order four, between. Where its
Bernstein coefficients keep one sign it has no zero. A zero that it has is put right by steps of that length, secants
from one to the next, so that the guard is zero in the motion that is taken.

The cubic of a gap that opens by a force which begins at zero, as t^4 and higher powers do, falls first. Of gaps that
begin within their bands, where that cannot be told from a hop, accelerations count too: the polynomial is of degree
five, with order four, and keeps the sign of every power.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.contacts.equations import size_of_loads
from lcpstep.events.contacts.guards import first_fall, read, read_with_rates
from lcpstep.events.contacts.held import know_biases
from lcpstep.events.contacts.hops import FAINT
from lcpstep.events.contacts.state import GUARDS
from lcpstep.events.hybrid.roots import DEGREE, NONE, taylor
from lcpstep.events.rows.contacts import gap_tolerance, rubs, speed_tolerance
from lcpstep.events.rows.equations import acceleration_of, size_of, velocity_of
from lcpstep.kernels.quadratic import first_zero, highest
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.vectors import copy, largest
from lcpstep.pointers import Doubles, abs, after, max, min
from lcpstep.stepping.rubbing.let_go import hops, is_motion, rises, widen_until_decided
from lcpstep.stepping.rubbing.strides import Strides, push_end_back


def note_base(s: Strides, t: float) -> bool:
    """Rates, forces and guards at the base state; False where one is not finite, or rows cannot be held."""
    if not measure_base(s, t):
        return False
    widen_bands(s)
    note_bends(s, t, s.y, s.K, s.begin_bend)
    return True


def measure_base(s: Strides, t: float) -> bool:
    """The same, but that bands of the guards, and accelerations of gaps, stay as they are."""
    if not s.rates(t, s.y, s.K):
        return False
    s.evaluations += 1
    s.based = True
    copy(s.leaving, s.multiplier, s.n_r)
    return note(s, t, s.y, s.v, s.K, s.begin_value, s.begin_slope)


def widen_bands(s: Strides) -> None:
    """Gaps and sliding velocities that rounding of the forces makes within a step have no sign.

    A contact that opens, or begins to slide, does so with none, for its force has come to zero or to the edge of its
    cone. Where all terms vanish, as beside the far tail of a pulse, rounding is that of the tolerance.
    """
    for c in range(s.n_c):
        g, i = GUARDS * c, s.n_j + c
        if s.mode[c] == SLIDES and rubs(s.rows, c):
            g, i = g + 1, i + s.n_c
        elif s.mode[c] != OPEN:
            continue
        size = size_of(s.rows, i, s.bias[i], s.a_free) + size_of_loads(s, i)
        size = size_of(s.rows, i, s.rate[i], s.v) + s.h * size
        if s.mode[c] == OPEN:
            s.height[c] = s.height[c] if s.carried[c] == 1 else 0.0
            s.band[g] = max(s.band[g], NOISE * max(s.h * size, gap_tolerance(s.rows, c)))
        else:
            s.band[g] = NOISE * (size + speed_tolerance(s.rows, i))
        s.armed[g] = 1 if s.begin_value[g] > s.band[g] and s.carried[c] == 0 else 0


def note(s: Strides, t: float, y: Doubles, v: Doubles, dy: Doubles, value: Doubles, slope: Doubles) -> bool:
    """Guards at a state whose rates and forces are known, and slopes of gaps and sliding velocities, all finite.

    v : the velocity on the rows held
    """
    if not read_with_rates(s, t, y):
        return False
    copy(value, s.value, GUARDS * s.n_c)
    a, total = after(dy, s.n_q), 0.0
    for c in range(s.n_c):
        i = s.n_j + c
        if s.mode[c] == OPEN:
            slope[GUARDS * c] = velocity_of(s.rows, i, v)
            total += slope[GUARDS * c]
        elif s.mode[c] == SLIDES and rubs(s.rows, c):
            turn = acceleration_of(s.rows, i + s.n_c, a)
            slope[GUARDS * c + 1] = s.direction[c] * turn
            total += turn
    return total - total == 0.0


def note_bends(s: Strides, t: float, y: Doubles, dy: Doubles, bend: Doubles) -> None:
    """Accelerations of the open gaps that have not left their bands, at a state whose rates are known."""
    known = False
    for c in range(s.n_c):
        if s.mode[c] == OPEN and s.armed[GUARDS * c] == 0:
            if not known:
                know_biases(s, t, y)
                known = True
            bend[c] = acceleration_of(s.rows, s.n_j + c, after(dy, s.n_q))


def note_arrival(s: Strides, t: float, h: float) -> bool:
    """Guards at the end of the step just made, and of the forces between with order four.

    What the velocity is off the rows held, by the error of the step, is no slope of a gap: another one that they hold
    would seem to fall.
    """
    copy(s.dv, after(s.y_new, s.n_q), s.n_q)
    push_end_back(s, s.dv)
    if not note(s, t + h, s.y_new, s.dv, s.arrival, s.end_value, s.end_slope):
        return False
    note_bends(s, t + h, s.y_new, s.arrival, s.end_bend)
    note_middle(s, t, h, s.middle_value)
    return True


def note_middle(s: Strides, t: float, h: float, value: Doubles) -> None:
    """With order four, guards of the forces between the ends of the step just made."""
    if s.order == 4 and s.rows.n_held > 0:
        copy(s.multiplier, s.middle, s.n_r)
        read(s, t + 0.5 * h, s.y_stage)
        copy(value, s.value, GUARDS * s.n_c)


def first_event(s: Strides, h: float) -> int:
    """The first guard that acts within the step of size h, or -1; when, into `found`, as a fraction of h."""
    s.guard, s.found = -1, 2.0
    for g in range(GUARDS * s.n_c):
        widen_until_decided(s, g, h)
        least, low = curve(s, g, h), low_flight(s, g)
        if low > h or (low == 0.0 and least > (0.0 if s.armed[g] == 1 else -s.band[g])):
            continue
        elevate(s, bend(s, g, h))
        place = low / h if low > 0.0 else first_fall(s, g)
        if place != NONE and place < s.found:
            s.guard, s.found = g, place
            _, slope, _ = taylor(s.scan.c, place, s.scan.half)
            s.slope = slope / h
    return s.guard


def hides(s: Strides, t: float, h: float) -> bool:
    """Whether a gap that rises at the end of the step just made has been below its surface, by how the step begins.

    An edge of the obstacle beyond the place where it lands hides that from the polynomial. Gaps that are high for
    their speeds are not asked for their acceleration, which at both ends of so short a fall is the same.
    """
    if s.rows.fixed and not s.rows.moving:
        return False
    for c in range(s.n_c):
        g = GUARDS * c
        gap, u, later = s.begin_value[g], s.begin_slope[g], s.end_slope[g]
        if s.mode[c] == OPEN and later > 0.0 and gap < h * (abs(u) + later) and s.end_value[g] > s.band[g]:
            know_biases(s, t + h, s.y_new)
            if (
                gap + h * (u + 0.5 * h * acceleration_of(s.rows, s.n_j + c, after(s.arrival, s.n_q)))
                < -s.band[g]
            ):
                return True
    return False


def arm(s: Strides) -> None:
    """Note the guards that have come out of their band at the end of the step; of low hops gaps do not tell."""
    for g in range(GUARDS * s.n_c):
        if s.end_value[g] > s.band[g] and s.carried[g // GUARDS] == 0:
            s.armed[g] = 1


def curve(s: Strides, g: int, h: float) -> float:
    """Bernstein coefficients of guard g over the step, of degree three; the least of them."""
    b, moves = s.scan.c, is_motion(s, g)
    b[0], b[3] = s.begin_value[g], s.end_value[g]
    if moves and s.order == 4:
        b[1] = b[0] + h * s.begin_slope[g] / 3.0
        b[2] = b[3] - h * s.end_slope[g] / 3.0
    else:
        between = 0.5 * (b[0] + b[3])
        if moves:
            between = b[0] + 0.5 * h * s.begin_slope[g]
        elif s.order == 4 and s.rows.n_held > 0:
            between = 2.0 * s.middle_value[g] - between
        b[1] = (b[0] + 2.0 * between) / 3.0
        b[2] = (b[3] + 2.0 * between) / 3.0
    return min(min(b[0], b[1]), min(b[2], b[3]))


def bend(s: Strides, g: int, h: float) -> int:
    """Where accelerations count, Bernstein coefficients of degree five in place of those at hand; the degree now."""
    c, b = g // GUARDS, s.scan.c
    if s.order == 2 or g % GUARDS > 0 or s.mode[c] != OPEN or s.armed[g] == 1:
        return 3
    b[5] = b[3]
    b[1] = b[0] + 0.2 * h * s.begin_slope[g]
    b[4] = b[5] - 0.2 * h * s.end_slope[g]
    b[2] = 2.0 * b[1] - b[0] + 0.05 * h * h * s.begin_bend[c]
    b[3] = 2.0 * b[4] - b[5] + 0.05 * h * h * s.end_bend[c]
    return 5


def elevate(s: Strides, least: int) -> None:
    """The polynomial at hand, of degree `least`, in the form that roots are sought in."""
    b = s.scan.c
    for degree in range(least, DEGREE):
        b[degree + 1] = b[degree]
        for j in range(degree, 0, -1):
            share = j / (degree + 1.0)
            b[j] = share * b[j - 1] + (1.0 - share) * b[j]


def low_flight(s: Strides, g: int) -> float:
    """How long a low hop takes whose gap is guard g, from where it begins or goes on; 0 if it is none."""
    c, half = g // GUARDS, 0.5 * s.begin_bend[g // GUARDS]
    if g % GUARDS > 0 or not hops(s, c) or half >= 0.0:
        return 0.0
    tau = first_zero(s.height[c], s.begin_slope[g], half)
    return tau if is_low(s, c, tau) else 0.0


def is_low(s: Strides, c: int, tau: float) -> bool:
    """Whether a hop of contact c is so low up to tau that its acceleration at first tells more of it than its gap."""
    g = GUARDS * c  # which others move by more than rounding where they are put onto their surfaces
    change = abs(s.end_bend[c] - s.begin_bend[c]) * tau / s.length
    most = max(FAINT * largest(s.y, 0.0, s.n_q), s.band[g])
    low = highest(s.height[c], s.begin_slope[g], s.begin_bend[c], tau) <= most
    return low and change * tau * tau <= 6.0 * s.band[g]


def interrupt(s: Strides, t: float, tau: float) -> None:
    """The motion goes on from t, tau after the base: note low hops still under way there, but not across a corner."""
    for c in range(s.n_c):
        g, half = GUARDS * c, 0.5 * s.begin_bend[c]
        rises = hops(s, c) and half >= 0.0 and is_low(s, c, tau)
        goes_on = g != s.guard and t < s.rows.high and (rises or low_flight(s, g) > tau)
        s.height[c] = s.height[c] + tau * (s.begin_slope[g] + tau * half) if goes_on else 0.0
        s.carried[c] = 1 if s.height[c] > 0.0 else 0


def locate(s: Strides, g: int, h: float) -> float:
    """Time from now at which guard g acts, the step of that length being the last one made; NONE: not at all.

    One that begins within its band, and below zero, acts where it is as far again; a force whose modes have been
    decided for longer, by a look ahead, where it is past its band.
    """
    known = s.rows.t0 < s.decided and not is_motion(s, g)
    zero = 0.0 if s.armed[g] == 1 else min(-s.band[g] if known else 0.0, 2.0 * s.begin_value[g])
    tau, slope, crossed = s.found * h, s.slope, s.end_value[g] < zero
    if tau <= 0.0:
        return 0.0
    low = low_flight(s, g)
    if low > 0.0:
        return low if look_after(s, low) else NONE
    s.bracket.begin(0.0, h, True, tau)
    while s.bracket.seek(2.0 * RESOLUTION * (abs(s.rows.t0) + tau)):
        tau = s.bracket.x  # the step of that length is the motion taken
        if not look_after(s, tau):
            return NONE
        value = s.value[g] - zero
        crossed = crossed or value < 0.0 or (value == 0.0 and s.armed[g] == 1)
        if s.bracket.looks > 1 and value != s.bracket.value:
            slope = (value - s.bracket.value) / (tau - s.bracket.seen)
        s.bracket.newton(value, min(slope, 0.0))  # where it rises: bisection
        if not crossed and tau + s.bracket.step >= h:  # what has come so near turns back before the end
            tau = h
            if not look_after(s, tau):
                return NONE
            break
    acts = crossed or (s.value[g] <= s.band[g] and s.armed[g] == 1)
    return tau if acts and not rises(s, g) else NONE


def look_after(s: Strides, tau: float) -> bool:
    """A step of length tau, and all guards where it ends; False where there is none, or one is not finite."""
    return s.step(s.rows.t0, tau) and read_with_rates(s, s.rows.t0 + tau, s.y_new)
