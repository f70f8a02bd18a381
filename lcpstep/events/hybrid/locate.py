"""The first guard that acts within a step, and when, as kernels.

Guards are looked at as polynomials in the fraction of the step (`roots`), of which the step is cut into as many parts
as these need to fit. The time of the first is found by secants on steps of that length.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import largest
from lcpstep.events.clock import RESOLUTION
from lcpstep.events.dop853 import interpolate
from lcpstep.events.hybrid.field import guard
from lcpstep.events.hybrid.roots import CHECKS, DEGREE, NONE, convert, first_rise, taylor
from lcpstep.events.hybrid.state import EVENT_AT, MODE, NOW, WAS_ARMED
from lcpstep.events.hybrid.step import step

UNKNOWN = -2  # in place of a guard
PARTS = 64  # of a step, at most, in which guards are polynomials
RESOLVED = 1e-10  # difference of guard and polynomial, relative to its largest value
REFINEMENTS = 8  # of an event's time by repeated steps
JUMP = 1e-4  # of a guard at its root, relative to its slope over the step


def find(s: Any, h: float) -> tuple[int, float, float, float]:
    """The first guard that acts within the step: guard, fraction of the step, its slope and curvature there.

    The guard is -1 where none acts, UNKNOWN where one is not finite.
    """
    scan, memory, w = s.scan, s.memory, s.w
    first, end, parts = s.m.first[s.count[MODE]], s.m.first[s.count[MODE] + 1], 1
    found, at, slope, curvature = -1, 2.0, 0.0, 0.0
    part = 0
    while part < parts and first < end:
        a, b = part / parts, (part + 1) / parts
        for j in range(DEGREE + 1 + CHECKS):
            interpolate(w.F, w.y, a + (b - a) * scan.s[j], memory.states[j])
        fine = True
        for k in range(first, end):
            sample(s, k, h, a, b)
            error = convert(scan)
            known = finite(scan.sample)
            if (
                not (known and error <= RESOLVED * largest(scan.sample, 0.0) + memory.band[k])
                and parts < PARTS
            ):
                fine = False
                break
            if not known:
                return UNKNOWN, a, 0.0, 0.0
            place, armed = first_action(s, k)
            if place != NONE and a + (b - a) * place < at:
                found, at = k, a + (b - a) * place
                _, slope, curvature = taylor(scan.c, place, scan.half)
                slope, curvature = slope * parts, curvature * parts * parts
                s.x[EVENT_AT], s.x[WAS_ARMED] = (0.0, 1.0) if armed else (memory.band[k], 0.0)
        if not fine:  # the same place again, more finely
            part, parts = 2 * part, 2 * parts
            found, at = -1, 2.0
            continue
        if found >= 0:
            return found, at, slope, curvature
        arm(s, h, a, b)
        part += 1
    return found, at, slope, curvature


def arm(s: Any, h: float, a: float, b: float) -> None:
    """Note the guards that fall below their band within the part a .. b of a step."""
    memory, mode = s.memory, s.count[MODE]
    for k in range(s.m.first[mode], s.m.first[mode + 1]):
        sample(s, k, h, a, b)
        convert(s.scan)
        if not memory.armed[k]:
            memory.armed[k] = first_rise(s.scan, -1.0, memory.band[k], 0.0) != NONE


def sample(s: Any, k: int, h: float, a: float, b: float) -> None:
    """Values of guard k at the points of the part a .. b of a step."""
    for j in range(DEGREE + 1 + CHECKS):
        place = a + (b - a) * s.scan.s[j]
        s.scan.sample[j] = guard(s.m, s.count[MODE], k, s.x[NOW] + place * h, s.memory.states[j])


def finite(values: Any) -> bool:
    """Whether no entry is nan or infinite."""
    total = 0.0
    for value in values:
        total += value - value
    return total == 0.0


def first_action(s: Any, k: int) -> tuple[float, bool]:
    """Where guard k acts within the part at hand, or NONE; whether it was below its band before."""
    scan, memory = s.scan, s.memory
    start, band = 0.0, memory.band[k]
    if not memory.armed[k]:
        down = first_rise(scan, -1.0, band, 0.0)
        up = first_rise(scan, 1.0, band, 0.0) if s.m.at_once[k] else NONE
        if up != NONE and (down == NONE or up < down):
            return up, False
        if down == NONE:
            return NONE, False
        start = down
    elif scan.c[0] >= -band:  # it came into its band at the end of the part before
        return 0.0, True
    return first_rise(scan, 1.0, -band, start), True


def locate(s: Any, k: int, h: float, at: float, slope: float) -> float:
    """Time from now at which guard k acts: secants on steps of that length, whose last one is left in w."""
    mode, t, most = s.count[MODE], s.x[NOW], s.flow.t_end - s.x[NOW]
    tau, rate, change, before = min(at * h, most), slope / h, 0.0, math.nan
    step(s, tau)
    for _ in range(REFINEMENTS):
        g = guard(s.m, mode, k, t + tau, s.w.y_new) - s.x[EVENT_AT]
        if g * before < 0.0 or abs(g) < 0.5 * abs(before):  # the slope that the last change has met
            rate = (g - before) / change
        change, before = (-g / rate if rate > 0.0 else 0.0), g
        new = min(max(tau + change, 0.0), most)
        if abs(new - tau) <= RESOLUTION * tau or abs(change) > 0.01 * h:
            break
        change, tau = new - tau, new
        step(s, tau)
    if abs(guard(s.m, mode, k, t + tau, s.w.y_new) - s.x[EVENT_AT]) > JUMP * slope:
        tau = min(bisect(s, k, h, at), most)
        step(s, tau)
    return tau


def bisect(s: Any, k: int, h: float, at: float) -> float:
    """The same for a guard that jumps, which secants cannot follow: bisection on the dense output."""
    w, low, high = s.w, max(at - 1.0 / PARTS, 0.0), min(at + 1.0 / PARTS, 1.0)
    while high - low > RESOLUTION:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        interpolate(w.F, w.y, middle, w.y_new)
        if guard(s.m, s.count[MODE], k, s.x[NOW] + middle * h, w.y_new) < s.x[EVENT_AT]:
            low = middle
        else:
            high = middle
    return high * h
