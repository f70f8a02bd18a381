"""What ends the modes of contacts, and when, as kernels.

A guard acts where it falls through zero: the gap of an open contact; the normal force of a closed one; the sliding
velocity of one that slides, times its sign; mu_s lambda_N -+ lambda_T of one that sticks. Along the dense output each
is a polynomial on parts short enough, whose first root is found from its Bernstein coefficients
(`events.hybrid.roots`): none that comes in a pair within a step is missed.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import LEANS, OPEN, SLIDES, STICKS
from lcpstep.events.contacts.equations import force_noise, measure_friction, most_friction, share_left
from lcpstep.events.contacts.held import right_hand_side
from lcpstep.events.contacts.hops import begin_hops, first_landing
from lcpstep.events.contacts.loose import forget, notice
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.hybrid.locate import UNKNOWN
from lcpstep.events.hybrid.roots import DEGREE, NONE, SAMPLES, convert, first_rise, taylor
from lcpstep.events.rows.contacts import gap_tolerance, rubs, speed_tolerance
from lcpstep.events.rows.equations import list_gaps, measure_rates, size_of, velocity_of
from lcpstep.events.rows.held import is_held
from lcpstep.events.rows.on_joints import is_led
from lcpstep.kernels.dop853 import STAGES
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import copy, largest
from lcpstep.pointers import Doubles, abs, after, max, min

PARTS = 64  # of a step, at most, in which guards are polynomials
MOST_PARTS, UNSEEN = 4096, 1e-6  # the same where a gap turns faster than the motion: by so much of it
RESOLVED = 1e-8  # difference of guard and polynomial, relative to its largest value
FOOT = 1e-2  # of a hop's height
OFF = 1.0  # value of a guard that a contact does not have


def look(s: Rubbing, t: float, y: Doubles) -> bool:
    """All guards at a state, into `value`; False where one is not finite."""
    return right_hand_side(s, t, y, s.dy) and read_with_rates(s, t, y)


def look_at_stage(s: Rubbing, stage: int, t: float, y: Doubles) -> bool:
    """The same at a stage of the step at hand, where the forces are known."""
    measure_rates(s.rows, t, y)
    copy(s.multiplier, after(s.loads, stage * s.n_r), s.n_r)
    return measure_friction(s, t, y) and read(s, t, y)


def read_with_rates(s: Rubbing, t: float, y: Doubles) -> bool:
    """The same where the forces of the state are known, and with them the rates, if any row is held."""
    if s.rows.n_held == 0:
        measure_rates(s.rows, t, y)
    return read(s, t, y)


def read(s: Rubbing, t: float, y: Doubles) -> bool:
    """The same where rows and multipliers are known."""
    v, total, opened = after(y, s.n_q), 0.0, False
    for c in range(s.n_c):
        opened = opened or s.mode[c] == OPEN
    if opened:
        list_gaps(s.rows, t, y, s.gap)
    for c in range(s.n_c):
        i, k = s.n_j + c, GUARDS * c
        s.value[k] = s.value[k + 1] = s.value[k + 2] = OFF
        if s.mode[c] == OPEN:
            s.value[k] = s.gap[i]
            total += s.gap[i]
            continue
        if is_held(s.rows, i) or (s.mode[c] == LEANS and is_held(s.rows, i + s.n_c)):
            s.value[k] = s.multiplier[i]
        if s.mode[c] == SLIDES and rubs(s.rows, c):
            slip = velocity_of(s.rows, i + s.n_c, v)
            s.value[k + 1] = s.direction[c] * slip
        elif s.mode[c] == STICKS:
            most = most_friction(s, c)
            s.value[k + 1] = most - s.multiplier[i + s.n_c]
            s.value[k + 2] = most + s.multiplier[i + s.n_c]
        total += s.value[k] + s.value[k + 1] + s.value[k + 2]
    return total - total == 0.0


def begin_guards(s: Rubbing) -> bool:
    """Bands of the guards, and which of them are beyond theirs, as modes begin; False where one is not finite."""
    if not look(s, s.rows.t0, s.y):
        return False
    begin_hops(s)
    s.flying, forces, share = True, force_noise(s), share_left(s)
    for c in range(s.n_c):
        k, i = GUARDS * c, s.n_j + c
        s.flying = s.flying and s.mode[c] == OPEN
        if s.mode[c] == OPEN:
            noise = s.rows.rounding_of_gap(c) + share * no_gap_below(s, c, s.rise[c], s.bend[c])
            s.band[k] = max(noise + depth(s, c), -2.0 * s.value[k])  # deeper than it is now
        else:
            own = s.W[i * s.n_r + i]  # none in the middle of a bowl
            none = NOISE * share * speed_tolerance(s.rows, i) / own if own > 0.0 else 0.0
            s.band[k] = forces + none
            s.band[k + 1] = s.band[k + 2] = forces * (1.0 + s.mu_s[c]) + none
            if s.mode[c] == SLIDES and rubs(s.rows, c):
                T = i + s.n_c
                s.band[k + 1] = NOISE * (size_of(s.rows, T, s.rate[T], s.v) + speed_tolerance(s.rows, T))
        for g in range(k, k + GUARDS):
            s.armed[g] = 1 if s.value[g] > s.band[g] else 0
    return True


def no_gap_below(s: Rubbing, c: int, u: float, alpha: float) -> float:
    """The gap of contact c that counts as none even where all its terms vanish: a small share of the tolerance.

    Of a hop that begins, with velocity u and acceleration alpha, it is small beside the height u^2 / (2 |alpha|).
    """
    least = NOISE * gap_tolerance(s.rows, c)
    return min(least, FOOT * u * u / -alpha) if u > 0.0 and alpha < 0.0 else least


def depth(s: Rubbing, c: int) -> float:
    """Twice how deep contact c goes where joints lead it past a surface that it touches; see `parting.pass_by`."""
    u, alpha = s.rise[c], s.bend[c]
    if not (u < 0.0 and alpha > 0.0 and -u <= s.terms[c] and is_led(s.rows, c)):
        return 0.0
    return min(u * u / alpha, 2.0 * gap_tolerance(s.rows, c))


def first_event(s: Rubbing, h: float) -> int:
    """The first guard that acts within the step of size h, -1 or UNKNOWN; when, into `found`, as a fraction of h."""
    part, parts, lands = 0, 1, first_landing(s)
    forget(s)
    if lands < 0 and s.plain and stays_clear(s, h):
        return -1
    while part < parts:
        a, b = part * 1.0 / parts, (part + 1) * 1.0 / parts
        if not sample(s, h, a, b):
            return UNKNOWN
        if not search_part(s, h, a, b, parts):  # the same place again, more finely
            part, parts = 2 * part, 2 * parts
            forget(s)
            continue
        if lands >= 0 and s.lands[lands] <= b * h and (s.guard < 0 or s.lands[lands] <= s.found * h):
            s.guard, s.found, s.risen = GUARDS * lands, s.lands[lands] / h, True
        if s.guard >= 0:
            return s.guard
        arm(s)
        part += 1
    return -1


def search_part(s: Rubbing, h: float, a: float, b: float, parts: int) -> bool:
    """Find the first guard that acts from a to b, the part of the step sampled; False where that part is too long."""
    for g in range(GUARDS * s.n_c):
        if not has(s, g):
            continue
        if not fits(s, h, g, parts):
            return False
        place = first_fall(s, g)
        when, risen = a + (b - a) * place, place != NONE and rises(s, g, place)
        if place != NONE and when < s.found:
            s.guard, s.found, s.risen = g, when, risen
            _, slope, _ = taylor(s.scan.c, place, s.scan.half)
            s.slope = slope * parts / h
    return True


def fits(s: Rubbing, h: float, g: int, parts: int) -> bool:
    """Whether guard g is close to the polynomial of its samples, or the parts are as many as there may be.

    There the samples of a gap stand for its coefficients: beside an edge of the obstacle the polynomial may swing
    below zero where the samples do not.
    """
    copy(s.scan.sample, after(s.samples, g * SAMPLES), SAMPLES)
    error, most = convert(s.scan), largest(s.scan.sample, 0.0, SAMPLES)
    if error <= RESOLVED * most + s.band[g]:
        return True
    hidden = parts * NOISE * (abs(s.rows.t0) + h) / h  # of a gap that a shorter part changes by all of it
    turns = s.mode[g // GUARDS] == OPEN and error > (UNSEEN + hidden) * most
    if parts < (MOST_PARTS if turns else PARTS):
        return False
    if turns:
        copy(s.scan.c, s.scan.sample, DEGREE + 1)
    return True


def has(s: Rubbing, g: int) -> bool:
    """Whether the contact of guard g has that guard in its mode; the value of others is OFF."""
    c, which = g // GUARDS, g % GUARDS
    seen = which == 0 and s.lands[c] == NONE
    return seen or s.mode[c] == STICKS or (which == 1 and s.mode[c] == SLIDES and rubs(s.rows, c))


def stays_clear(s: Rubbing, h: float) -> bool:
    """Whether no guard can act within the step: none comes to zero between its values at the ends.

    Of a linear system without functions of the user's, whose guards are linear in the state.
    """
    if not look_at_stage(s, 0, s.rows.t0, s.y):
        return False
    copy(s.samples, s.value, GUARDS * s.n_c)
    if not look_at_stage(s, STAGES, s.rows.t0 + h, s.y_new):
        return False
    find_bows(s, h)
    for g in range(GUARDS * s.n_c):
        if has(s, g) and (s.armed[g] == 0 or min(s.samples[g], s.value[g]) - bow(s, g) <= s.band[g]):
            return False
    return True


def find_bows(s: Rubbing, h: float) -> None:
    """How far the step leads off the line between its ends, at most: states into `seen`, forces into `dv`."""
    n, turn = s.n_q, 0.125 * (s.model.omega * h) * (s.model.omega * h)
    for i in range(2 * n):
        s.seen[i] = 0.0
        for k in range(1, 7):
            s.seen[i] += 0.25 * abs(s.F[2 * n * k + i])
    for i in range(n):
        s.dv[i] = turn * (abs(s.model.cosine[i]) + abs(s.model.sine[i]))
        for j in range(n):
            s.dv[i] += abs(s.model.K[i * n + j]) * s.seen[j] + abs(s.model.C[i * n + j]) * s.seen[n + j]


def bow(s: Rubbing, g: int) -> float:
    """How far guard g may lead off the line between its values at the ends of the step, by `find_bows`."""
    c, n, m = g // GUARDS, s.n_q, s.n_q + s.n_r
    i, most = s.n_j + c, 0.0
    if s.mode[c] == OPEN or (s.mode[c] == SLIDES and g % GUARDS == 1):
        row, bows = (i, s.seen) if s.mode[c] == OPEN else (i + s.n_c, after(s.seen, n))
        for j in range(n):
            most += abs(s.R[row * n + j]) * bows[j]
        return most
    for d in range(s.n_c):
        if d == c or (s.sharing and s.leader[d] == c):
            share = 1.0 if g % GUARDS == 0 else s.mu_s[d]
            for j in range(n):
                most += share * abs(s.effects[j * m + n + s.n_j + d]) * s.dv[j]
    for j in range(n if g % GUARDS > 0 else 0):
        most += abs(s.effects[j * m + n + i + s.n_c]) * s.dv[j]
    return most


def sample(s: Rubbing, h: float, a: float, b: float) -> bool:
    """All guards at the points of the part a .. b of a step; False where one is not finite."""
    for j in range(SAMPLES):
        place = a + (b - a) * s.scan.points[j]
        if not look_between(s, place, s.rows.t0 + place * h):
            return False
        for g in range(GUARDS * s.n_c):
            s.samples[g * SAMPLES + j] = s.value[g]
        if j <= DEGREE:
            notice(s, place, s.rows.t0 + place * h)
    return True


def look_between(s: Rubbing, place: float, t: float) -> bool:
    """All guards at the fraction `place` of the step at hand, into `value`; False where one is not finite."""
    if s.flying:
        s.at(place, s.seen)
        return read(s, t, s.seen)
    if place == 0.0:
        return look_at_stage(s, 0, t, s.y)
    if place == 1.0:
        return look_at_stage(s, STAGES, t, s.y_new)
    s.at(place, s.seen)
    return look(s, t, s.seen)


def first_fall(s: Rubbing, g: int) -> float:
    """Where guard g, whose polynomial is at hand, acts within the part, or NONE.

    One that begins at the bottom of its band, as at zero where nothing says yet what rounding is, acts once it has
    fallen further by more than the rounding of its own values, which may be more than that of a body just set out.
    """
    if s.armed[g] == 1:
        return 0.0 if s.scan.c[0] <= 0.0 else first_rise(s.scan, -1.0, 0.0, 0.0)
    rounding = NOISE * largest(s.scan.c, 0.0, DEGREE + 1)
    band, start = max(s.band[g], rounding), s.scan.c[0]
    if start <= -s.band[g]:
        band = max(-2.0 * start, rounding)
    up = first_rise(s.scan, 1.0, band, 0.0)
    down = first_rise(s.scan, -1.0, band, 0.0)
    if down != NONE and (up == NONE or down < up):
        return down
    return NONE if up == NONE else first_rise(s.scan, -1.0, 0.0, up)


def rises(s: Rubbing, g: int, place: float) -> bool:
    """Whether guard g, which acts at this place of the part, is or was above its band before: it falls to zero there.

    A body that rocks closes a gap within the step in which that gap has opened.
    """
    return s.armed[g] == 1 or 0.0 <= first_rise(s.scan, 1.0, s.band[g], 0.0) < place


def arm(s: Rubbing) -> None:
    """Note the guards that have come out of their band within the part just sampled."""
    for g in range(GUARDS * s.n_c):
        for j in range(SAMPLES):
            if s.samples[g * SAMPLES + j] > s.band[g]:
                s.armed[g] = 1
