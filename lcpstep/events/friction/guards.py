"""What ends the modes of contacts with friction, and when, as kernels.

A guard acts where it falls through zero: the gap of an open contact; the normal force of a closed one; the sliding
velocity of one that slides, times its sign; mu lambda_N -+ lambda_T of one that sticks. Along the dense output each
is a polynomial on parts short enough, whose first root is found from its Bernstein coefficients
(`events.hybrid.roots`): none that comes in a pair within a step is missed.
"""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import OPEN, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.friction.equations import gap_size, measure_gaps, measure_rates, size_of
    from lcpstep.events.friction.held import list_multipliers, right_hand_side
    from lcpstep.events.friction.modes import force_noise
    from lcpstep.events.friction.state import GUARDS, NOISE, Rubbing
    from lcpstep.events.hybrid.roots import CHECKS, DEGREE, NONE, convert, first_rise, taylor
    from lcpstep.kernels.clock import RESOLUTION
    from lcpstep.kernels.vectors import copy, finite, largest, product
    from lcpstep.pointers import Doubles, abs, after, max, min

SAMPLES = DEGREE + 1 + CHECKS
PARTS = 64  # of a step, at most, in which guards are polynomials
RESOLVED = 1e-8  # difference of guard and polynomial, relative to its largest value
REFINEMENTS = 6  # of an event's time by repeated steps
UNKNOWN = -2  # in place of a guard: one is not finite
OFF = 1.0  # value of a guard that a contact does not have


def look(s: Rubbing, t: float, y: Doubles) -> bool:
    """All guards at a state, into `value`; False where one is not finite."""
    if not right_hand_side(s, t, y, s.dy):
        return False
    if s.n_held == 0:
        measure_rates(s, t, y)
    list_multipliers(s)
    return read(s, t, y)


def read(s: Rubbing, t: float, y: Doubles) -> bool:
    """The same where rows and multipliers are known."""
    v, total, opened = after(y, s.n_q), 0.0, False
    for c in range(s.n_c):
        opened = opened or s.mode[c] == OPEN
    if opened:
        measure_gaps(s, t, y)
    for c in range(s.n_c):
        i, k = s.n_j + c, GUARDS * c
        s.value[k] = s.value[k + 1] = s.value[k + 2] = OFF
        if s.mode[c] == OPEN:
            s.value[k] = s.gap[i]
            total += s.gap[i]
            continue
        if is_held(s, i):
            s.value[k] = s.multiplier[i]
        slip = product(s.R, v, i + s.n_c, s.n_q) + s.rate[i + s.n_c]
        if s.mode[c] == SLIDES and s.coefficients.rough[c] == 1:
            s.value[k + 1] = s.direction[c] * slip
        elif s.mode[c] == STICKS:
            most = s.mu_s[c] * s.multiplier[i]
            s.value[k + 1] = most - s.multiplier[i + s.n_c]
            s.value[k + 2] = most + s.multiplier[i + s.n_c]
        total += s.value[k] + s.value[k + 1] + s.value[k + 2]
    return total - total == 0.0


def is_held(s: Rubbing, i: int) -> bool:
    """Whether row i is among the rows held."""
    found = False
    for m in range(s.n_held):
        found = found or s.held[m] == i
    return found


def begin_guards(s: Rubbing, t: float) -> bool:
    """Bands of the guards, and which of them are beyond theirs, as modes begin; False where one is not finite."""
    if not look(s, t, s.y):
        return False
    forces, nothing = (
        force_noise(s),
        NOISE * s.atol,
    )  # the second where all terms vanish, as in the tail of a pulse
    for c in range(s.n_c):
        k, i = GUARDS * c, s.n_j + c
        if s.mode[c] == OPEN:
            s.band[k] = max(NOISE * gap_size(s, c) + nothing, -2.0 * s.value[k])  # deeper than it is now
        else:
            s.band[k] = forces + nothing
            s.band[k + 1] = s.band[k + 2] = forces * (1.0 + s.mu_s[c]) + nothing
            if s.mode[c] == SLIDES:
                s.band[k + 1] = NOISE * size_of(s, i + s.n_c, s.v) + nothing
        for g in range(k, k + GUARDS):
            s.armed[g] = 1 if s.value[g] > s.band[g] else 0
    return True


def first_event(s: Rubbing, h: float) -> int:
    """The first guard that acts within the step of size h, -1 or UNKNOWN; when, into `found`, as a fraction of h."""
    n, parts, part = GUARDS * s.n_c, 1, 0
    s.guard, s.found = -1, 2.0
    while part < parts:
        a, b = part * 1.0 / parts, (part + 1) * 1.0 / parts
        if not sample(s, h, a, b):
            return UNKNOWN
        fine = True
        for g in range(n):
            if not has(s, g):
                continue
            copy(s.scan.sample, after(s.samples, g * SAMPLES), SAMPLES)
            error = convert(s.scan)
            if error > RESOLVED * largest(s.scan.sample, 0.0, SAMPLES) + s.band[g] and parts < PARTS:
                fine = False
                break
            place = first_fall(s, g)
            if place != NONE and a + (b - a) * place < s.found:
                s.guard, s.found = g, a + (b - a) * place
                _, slope, _ = taylor(s.scan.c, place, s.scan.half)
                s.slope = slope * parts / h
        if not fine:  # the same place again, more finely
            part, parts = 2 * part, 2 * parts
            s.guard, s.found = -1, 2.0
            continue
        if s.guard >= 0:
            return s.guard
        arm(s)
        part += 1
    return -1


def has(s: Rubbing, g: int) -> bool:
    """Whether the contact of guard g has that guard in its mode; the value of others is OFF."""
    mode, which = s.mode[g // GUARDS], g % GUARDS
    return which == 0 or mode == STICKS or (which == 1 and mode == SLIDES)


def sample(s: Rubbing, h: float, a: float, b: float) -> bool:
    """All guards at the points of the part a .. b of a step; False where one is not finite."""
    for j in range(SAMPLES):
        place = a + (b - a) * s.scan.points[j]
        s.at(place, s.seen)
        if not look(s, s.clock.t0 + place * h, s.seen):
            return False
        for g in range(GUARDS * s.n_c):
            s.samples[g * SAMPLES + j] = s.value[g]
    return True


def first_fall(s: Rubbing, g: int) -> float:
    """Where guard g, whose polynomial is at hand, acts within the part, or NONE.

    One that begins at the bottom of its band, as at zero where nothing says yet what rounding is, acts once it has
    fallen further by more than the rounding of its own values.
    """
    if s.armed[g] == 1:
        return 0.0 if s.scan.c[0] <= 0.0 else first_rise(s.scan, -1.0, 0.0, 0.0)
    band, start = s.band[g], s.scan.c[0]
    if start <= -band:
        band = max(-2.0 * start, NOISE * largest(s.scan.c, 0.0, DEGREE + 1))
    up = first_rise(s.scan, 1.0, band, 0.0)
    down = first_rise(s.scan, -1.0, band, 0.0)
    if down != NONE and (up == NONE or down < up):
        return down
    return NONE if up == NONE else first_rise(s.scan, -1.0, 0.0, up)


def arm(s: Rubbing) -> None:
    """Note the guards that have come out of their band within the part just sampled."""
    for g in range(GUARDS * s.n_c):
        for j in range(SAMPLES):
            if s.samples[g * SAMPLES + j] > s.band[g]:
                s.armed[g] = 1


def locate(s: Rubbing, g: int, h: float, longest: float) -> float:
    """Time from now at which guard g acts: secants on steps of that length, of which the last one is left."""
    t0 = s.clock.t0
    tau = min(s.found * h, longest)
    if tau <= 0.0:
        return 0.0
    s.step(t0, tau)
    for _ in range(REFINEMENTS):
        if not look(s, t0 + tau, s.y_new):
            break
        change = -s.value[g] / s.slope if s.slope < 0.0 and s.armed[g] == 1 else 0.0
        if abs(change) <= 2.0 * RESOLUTION * (abs(t0) + tau) or abs(change) > 1e-3 * h:
            break
        tau = min(max(tau + change, 0.0), longest)
        s.step(t0, tau)
    return tau


def finish_step(s: Rubbing, tau: float) -> bool:
    """Dense output of the step of size tau that has just been made."""
    return s.complete(s.clock.t0, tau) and finite(s.y_new, 2 * s.n_q)
