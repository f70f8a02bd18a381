"""The first guard that acts within a step, and when, as kernels.

Guards are looked at as polynomials in the fraction of the step (`roots`), of which the step is cut into as many parts
as these need to fit. The time of the first is found by secants on steps of that length.
"""

from __future__ import annotations

import cython

from lcpstep.events.hybrid.field import guard
from lcpstep.events.hybrid.roots import DEGREE, NONE, SAMPLES, convert, first_rise, taylor
from lcpstep.events.hybrid.state import Motion
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import finite, largest
from lcpstep.pointers import abs, after, max, min, nan

UNKNOWN = -2  # in place of a guard
SEARCHED, TOO_LONG = 0, 1  # a part of a step
PARTS = 64  # of a step, at most, in which guards are polynomials
FINEST = 2**14  # the same where one that is none, by a kink, seems to act
RESOLVED = 1e-10  # difference of guard and polynomial, relative to its largest value
REFINEMENTS = 8  # of an event's time by repeated steps
FAR = 0.01  # of a step: the secants have lost the guard
JUMP = 1e-4  # of a guard at its root, relative to its slope over the step


def find(s: Motion, h: float, share: float) -> int:
    """The first guard that acts within this share of the step, -1 or UNKNOWN; where and how, into `acting` and so on.

    Parts too long for the guards are halved, and put together again once these are past.
    """
    part, parts = 0, 1
    s.acting, s.place = -1, 2.0
    while part < parts and s.m.first[s.mode] < s.m.first[s.mode + 1]:
        a, b = share * part / parts, share * (part + 1) / parts
        for j in range(SAMPLES):
            s.at(a + (b - a) * s.scan.points[j], after(s.states, j * s.n))
        code = search_part(s, h, a, b, parts, share)
        if code == UNKNOWN:
            return UNKNOWN
        if code == TOO_LONG:  # the same place again, more finely
            part, parts = 2 * part, 2 * parts
            s.acting, s.place = -1, 2.0
            continue
        if s.acting >= 0:
            return s.acting
        arm(s, h, a, b)
        part += 1
        while part % 2 == 0 and part < parts:
            part, parts = part // 2, parts // 2
    return -1


def search_part(s: Motion, h: float, a: float, b: float, parts: int, share: float) -> int:
    """Find the first guard that acts in the part from a to b, one of so many of this share of the step.

    SEARCHED, TOO_LONG where a guard needs shorter parts, or UNKNOWN.
    """
    for k in range(s.m.first[s.mode], s.m.first[s.mode + 1]):
        sample(s, k, h, a, b)
        error, known = convert(s.scan), finite(s.scan.sample, SAMPLES)
        fits = known and error <= RESOLVED * largest(s.scan.sample, 0.0, SAMPLES) + s.band[k]
        if not fits and parts < PARTS:
            return TOO_LONG
        if not known:
            return UNKNOWN
        place, armed = first_action(s, k)
        if place != NONE and not fits:
            if parts < FINEST:
                return TOO_LONG
            if not is_sampled(s, k, place):
                continue
        if place != NONE and a + (b - a) * place < s.place:
            s.acting, s.place = k, a + (b - a) * place
            _, slope, curvature = taylor(s.scan.c, place, s.scan.half)
            # A jump is as steep as the parts are fine
            per_step = (parts if fits else min(parts, PARTS)) / share
            s.slope, s.curvature = slope * per_step, curvature * per_step * per_step
            s.event_at, s.was_armed = 0.0 if armed else s.band[k], armed
    return SEARCHED


def turns_back(s: Motion) -> bool:
    """Whether the guard found, by its slope and curvature, may turn back within its band past zero."""
    return s.was_armed and s.slope * s.slope <= -4.0 * s.band[s.acting] * s.curvature


def is_sampled(s: Motion, k: int, place: float) -> bool:
    """Whether the sample after a root is above the band of guard k, too, where its polynomial is not the guard."""
    for j in range(DEGREE):
        if s.scan.points[j] >= place:
            return s.scan.sample[j] >= -s.band[k]
    return s.scan.sample[DEGREE] >= -s.band[k]


def arm(s: Motion, h: float, a: float, b: float) -> None:
    """Note the guards that fall below their band within the part a .. b of a step."""
    for k in range(s.m.first[s.mode], s.m.first[s.mode + 1]):
        if s.armed[k] == 0:
            sample(s, k, h, a, b)
            convert(s.scan)
            s.armed[k] = first_rise(s.scan, -1.0, s.band[k], 0.0) != NONE


def sample(s: Motion, k: int, h: float, a: float, b: float) -> None:
    """Values of guard k at the points of the part a .. b of a step."""
    for j in range(SAMPLES):
        place = a + (b - a) * s.scan.points[j]
        s.scan.sample[j] = guard(s.m, s.mode, k, s.now + place * h, after(s.states, j * s.n))


def first_action(s: Motion, k: int) -> tuple[float, bool]:
    """Where guard k acts within the part at hand, or NONE; whether it was below its band before."""
    start, band = 0.0, s.band[k]
    if s.armed[k] == 0:
        down = first_rise(s.scan, -1.0, band, 0.0)
        up = first_rise(s.scan, 1.0, band, 0.0) if s.m.at_once[k] != 0 else NONE
        if up != NONE and (down == NONE or up < down):
            return up, False
        if down == NONE:
            return NONE, False
        start = down
    elif s.scan.c[0] >= -band:  # it came into its band at the end of the part before
        return 0.0, True
    return first_rise(s.scan, 1.0, -band, start), True


def locate(s: Motion, h: float) -> float:
    """Time from now at which the guard found acts: secants on steps of that length, of which the last one is left."""
    t, most = s.now, s.t_end - s.now
    s.due, s.secant, s.missed = s.acting, s.slope / h, nan
    tau = s.meet(t, min(s.place * h, most), most, FAR * h, REFINEMENTS)
    if abs(guard(s.m, s.mode, s.acting, t + tau, s.y_new) - s.event_at) > JUMP * s.slope:
        tau = min(bisect(s, h), most)
        s.step(t, tau)
    return tau


def bisect(s: Motion, h: float) -> float:
    """The same for a guard that jumps, which secants cannot follow: bisection on the dense output."""
    low, high = max(s.place - 1.0 / PARTS, 0.0), min(s.place + 1.0 / PARTS, 1.0)
    s.scan.bracket.begin(low, high, False, 0.5 * (low + high))
    while s.scan.bracket.seek(RESOLUTION):
        s.at(s.scan.bracket.x, s.y_new)
        g = guard(s.m, s.mode, s.acting, s.now + s.scan.bracket.x * h, s.y_new)
        s.scan.bracket.take(-1.0 if g < s.event_at else 1.0, 0.0)
    return s.scan.bracket.b * h
