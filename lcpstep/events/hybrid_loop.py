"""The event-driven loop for systems with modes, as kernels: a smooth step, the first guard within it, the switch.

A guard acts where it has been below its band, the accuracy to which it is known, and rises through it. Entered within
the band, a mode is left at once if the guard rises there; else the guard has to leave the band first. A guard that
touches the band and turns back is not transversal: tolerances decide whether it acts, and the run stops and says so.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call_first_order
from lcpstep.dense import assign
from lcpstep.events.dop853 import (
    EXTRA_STAGES,
    LEAST,
    STAGES,
    combine,
    error_norm,
    factor,
    interpolant,
    interpolate,
)
from lcpstep.events.hybrid_field import (
    ARRIVE,
    EXIT_ABOVE,
    EXIT_BELOW,
    NOT_SLIDING,
    approaches,
    band_and_rate,
    field,
    guard,
    project,
)
from lcpstep.events.hybrid_roots import CHECKS, DEGREE, NONE, convert, first_rise, largest, taylor

# Why a loop returned
UNKNOWN = -2  # in place of a guard
FINISHED, BUFFER_FULL, NOT_FINITE, TOO_MANY_EVENTS, STEP_TOO_SMALL, ENDLESS, NOT_TRANSVERSAL = range(7)
# Places in the arrays of counters and of numbers
STEP, ROW, SWITCH, FORCES, MODE, EVENTS, STALLED, BEGUN, CULPRIT = range(9)
N_COUNTERS = 9
NOW, NEXT, LAST_SWITCH, EVENT_AT, WAS_ARMED = range(5)
N_NUMBERS = 5
TIME, LENGTH, ROW_MODE, LEAD = range(
    4
)  # in a row: time, duration and mode of the step that follows; then the state
# In a line of the switch log: time, modes left and entered, guard; then the states before and after
SWITCH_LEAD = 4

MAX_STALLED = 100  # switches at one instant
NEVER_LEFT = 10  # how many of them a switch counts for by a guard whose band was not left
PARTS = 64  # of a step, at most, in which guards are polynomials
RESOLVED = 1e-10  # difference of guard and polynomial, relative to its largest value
REFINEMENTS = 8  # of an event's time by repeated steps
RESOLUTION = 2.0**-52
JUMP = 1e-4  # of a guard at its root, relative to its slope over the step


@by_address
class Flow(NamedTuple):
    """Span, tolerances and bounds."""

    t_end: float
    rtol: float
    atol: float
    longest: float  # step
    max_events: int


@by_address
class Memory(NamedTuple):
    """What a run knows of its guards, and where it writes."""

    armed: Any  # (guards,) whether each has been below its band since the mode began
    band: Any  # (guards,)
    states: Any  # (DEGREE + 1 + CHECKS, n) samples of a step
    rows: Any  # (rows, LEAD + n)
    dense: Any  # (rows, 7, n); no rows where nothing but switches is kept
    log: Any  # (switches, SWITCH_LEAD + 2 n)


def step(m: Any, sp: Any, tab: Any, w: Any, mode: int, t: float, h: float, dense: bool) -> bool:
    """DOP853 step from w.y to w.y_new, with its dense output or without; False where the field is not finite."""
    field(m, sp, mode, t, w.y, w.K[0])
    for stage in range(1, STAGES):
        combine(tab, w, h, stage)
        field(m, sp, mode, t + tab.C[stage] * h, w.y_stage, w.K[stage])
    combine(tab, w, h, STAGES)
    assign(w.y_new, w.y_stage)
    field(m, sp, mode, t + h, w.y_new, w.K[STAGES])
    if dense:
        complete(m, sp, tab, w, mode, t, h)
    total = 0.0
    for i in range(len(w.y)):
        total += w.y_new[i] + w.K[STAGES, i]
    return total - total == 0.0


def complete(m: Any, sp: Any, tab: Any, w: Any, mode: int, t: float, h: float) -> None:
    """Dense output of a step."""
    for stage in range(STAGES + 1, STAGES + 1 + EXTRA_STAGES):
        combine(tab, w, h, stage)
        field(m, sp, mode, t + tab.C[stage] * h, w.y_stage, w.K[stage])
    interpolant(tab, w, h)


def enter(m: Any, flow: Any, sp: Any, memory: Any, w: Any, mode: int, t: float, left: int) -> int:
    """Begin a mode at w.y; the guard that leaves it at once, or -1. left: the sliding mode just ended, or -1."""
    leaves = -1
    for k in range(m.first[mode], m.first[mode + 1]):
        band, rate, noise = band_and_rate(m, sp, mode, k, t, w.y, flow.rtol, flow.atol)
        g = guard(m, sp, mode, k, t, w.y)
        memory.band[k], memory.armed[k] = band, g < -band
        passed = g > band or (g >= -band and rate > noise)
        if m.kind[k] == ARRIVE and m.target[k] == left:
            passed = g > band
        if passed and m.at_once[k] and leaves < 0:
            leaves = k
    return leaves


def switch(m: Any, flow: Any, sp: Any, memory: Any, w: Any, count: Any, x: Any, k: int) -> int:
    """Guard k acts at w.y: log, reset, new mode. Returns the guard that acts at once in that mode, or -1."""
    t, mode, n = x[NOW], count[MODE], len(w.y)
    target, left = m.target[k], -1
    if t - x[LAST_SWITCH] <= 4.0 * RESOLUTION * abs(t):
        count[STALLED] += 1
    elif not memory.armed[k] and count[EVENTS] > 0:
        count[STALLED] += NEVER_LEFT
    else:
        count[STALLED] = 0
    assign(sp.moved, w.y)
    if m.has_reset[k]:
        call_first_order(m.resets[k], t, w.y, m.p, sp.moved)
    if m.kind[k] == ARRIVE:
        L1, L2 = approaches(m, sp, target, t, w.y)
        if mode == m.below[target] and L2 > 0.0:
            target = m.above[target]
        elif mode == m.above[target] and L1 < 0.0:
            target = m.below[target]
    elif m.kind[k] == EXIT_BELOW:
        target, left = m.below[mode], mode
    elif m.kind[k] == EXIT_ABOVE:
        target, left = m.above[mode], mode
    if m.below[target] != NOT_SLIDING:
        project(m, sp, target, t, sp.moved)
    line = memory.log[count[SWITCH]]
    line[0], line[1], line[2], line[3] = t, mode, target, k
    for i in range(n):
        line[SWITCH_LEAD + i], line[SWITCH_LEAD + n + i] = w.y[i], sp.moved[i]
    assign(w.y, sp.moved)
    count[SWITCH] += 1
    count[EVENTS] += 1
    count[MODE], x[LAST_SWITCH] = target, t
    return enter(m, flow, sp, memory, w, target, t, left)


def settle(m: Any, flow: Any, sp: Any, memory: Any, w: Any, count: Any, x: Any, k: int) -> int:
    """Guard k acts, and after it whatever acts at the same instant."""
    while k >= 0:
        if count[SWITCH] >= len(memory.log):
            count[CULPRIT] = k
            return BUFFER_FULL
        k = switch(m, flow, sp, memory, w, count, x, k)
        if count[STALLED] > MAX_STALLED:
            return ENDLESS
        if count[EVENTS] >= flow.max_events and k >= 0:
            return TOO_MANY_EVENTS
    count[CULPRIT] = -1
    return FINISHED


def sample(
    m: Any, sp: Any, scan: Any, memory: Any, mode: int, k: int, t: float, h: float, a: float, b: float
) -> None:
    """Values of guard k at the points of the part a .. b of a step."""
    for j in range(DEGREE + 1 + CHECKS):
        s = a + (b - a) * scan.s[j]
        scan.sample[j] = guard(m, sp, mode, k, t + s * h, memory.states[j])


def finite(values: Any) -> bool:
    """Whether no entry is nan or infinite."""
    total = 0.0
    for value in values:
        total += value - value
    return total == 0.0


def find(
    m: Any, sp: Any, scan: Any, memory: Any, w: Any, mode: int, t: float, h: float, x: Any
) -> tuple[int, float, float, float]:
    """The first guard that acts within the step: guard, fraction of the step, its slope and curvature there.

    The guard is -1 where none acts, UNKNOWN where one is not finite.
    """
    first, end, parts = m.first[mode], m.first[mode + 1], 1
    found, at, slope, curvature = -1, 2.0, 0.0, 0.0
    part = 0
    while part < parts and first < end:
        a, b = part / parts, (part + 1) / parts
        for j in range(DEGREE + 1 + CHECKS):
            interpolate(w.F, w.y, a + (b - a) * scan.s[j], memory.states[j])
        fine = True
        for k in range(first, end):
            sample(m, sp, scan, memory, mode, k, t, h, a, b)
            error = convert(scan)
            known = finite(scan.sample)
            if not (known and error <= RESOLVED * largest(scan) + memory.band[k]) and parts < PARTS:
                fine = False
                break
            if not known:
                return UNKNOWN, a, 0.0, 0.0
            s, armed = first_action(m, scan, memory, k)
            if s != NONE and a + (b - a) * s < at:
                found, at = k, a + (b - a) * s
                _, slope, curvature = taylor(scan.c, s, scan.half)
                slope, curvature = slope * parts, curvature * parts * parts
                x[EVENT_AT], x[WAS_ARMED] = (0.0, 1.0) if armed else (memory.band[k], 0.0)
        if not fine:  # the same place again, more finely
            part, parts = 2 * part, 2 * parts
            found, at = -1, 2.0
            continue
        if found >= 0:
            return found, at, slope, curvature
        for k in range(first, end):
            sample(m, sp, scan, memory, mode, k, t, h, a, b)
            convert(scan)
            if not memory.armed[k]:
                memory.armed[k] = first_rise(scan, -1.0, memory.band[k], 0.0) != NONE
        part += 1
    return found, at, slope, curvature


def first_action(m: Any, scan: Any, memory: Any, k: int) -> tuple[float, bool]:
    """Where guard k acts within the part at hand, or NONE; whether it was below its band before."""
    start, band = 0.0, memory.band[k]
    if not memory.armed[k]:
        down = first_rise(scan, -1.0, band, 0.0)
        up = first_rise(scan, 1.0, band, 0.0) if m.at_once[k] else NONE
        if up != NONE and (down == NONE or up < down):
            return up, False
        if down == NONE:
            return NONE, False
        start = down
    elif scan.c[0] >= -band:  # it came into its band at the end of the part before
        return 0.0, True
    return first_rise(scan, 1.0, -band, start), True


def locate(
    m: Any,
    sp: Any,
    tab: Any,
    w: Any,
    mode: int,
    k: int,
    t: float,
    h: float,
    at: float,
    slope: float,
    x: Any,
    most: float,
) -> float:
    """Time after t at which guard k acts: secants on steps of that length, whose last one is left in w."""
    tau, rate, change, before = min(at * h, most), slope / h, 0.0, math.nan
    step(m, sp, tab, w, mode, t, tau, False)
    for _ in range(REFINEMENTS):
        g = guard(m, sp, mode, k, t + tau, w.y_new) - x[EVENT_AT]
        if g * before < 0.0 or abs(g) < 0.5 * abs(before):  # the slope that the last change has met
            rate = (g - before) / change
        change, before = (-g / rate if rate > 0.0 else 0.0), g
        new = min(max(tau + change, 0.0), most)
        if abs(new - tau) <= RESOLUTION * tau or abs(change) > 0.01 * h:
            break
        change, tau = new - tau, new
        step(m, sp, tab, w, mode, t, tau, False)
    if abs(guard(m, sp, mode, k, t + tau, w.y_new) - x[EVENT_AT]) > JUMP * slope:
        tau = min(bisect(m, sp, w, mode, k, t, h, at, x[EVENT_AT]), most)
        step(m, sp, tab, w, mode, t, tau, False)
    return tau


def bisect(m: Any, sp: Any, w: Any, mode: int, k: int, t: float, h: float, at: float, level: float) -> float:
    """The same for a guard that jumps, which Newton's method cannot follow: bisection on the dense output."""
    low, high = max(at - 1.0 / PARTS, 0.0), min(at + 1.0 / PARTS, 1.0)
    while high - low > RESOLUTION:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        interpolate(w.F, w.y, middle, w.y_new)
        if guard(m, sp, mode, k, t + middle * h, w.y_new) < level:
            low = middle
        else:
            high = middle
    return high * h


def keep(memory: Any, w: Any, count: Any, t: float, h: float) -> None:
    """One row: the state, the step that follows and its dense output."""
    if len(memory.rows) == 0 or h == 0.0:
        return
    row = memory.rows[count[ROW]]
    row[TIME], row[LENGTH], row[ROW_MODE] = t, h, count[MODE]
    for i in range(len(w.y)):
        row[LEAD + i] = w.y[i]
    if h > 0.0:
        assign(memory.dense[count[ROW]], w.F)
    count[ROW] += 1


def run(
    m: Any, flow: Any, sp: Any, scan: Any, memory: Any, tab: Any, w: Any, count: Any, x: Any, goal: int
) -> int:
    """Go on from x[NOW] with the state w.y to the end of the span, or to step number `goal`; says why it returned."""
    if count[BEGUN] == 0:
        count[BEGUN] = 1
        count[CULPRIT] = enter(m, flow, sp, memory, w, count[MODE], x[NOW], -1)
    while x[NOW] < flow.t_end and count[STEP] < goal:
        if count[CULPRIT] >= 0:  # a switch is due
            code = settle(m, flow, sp, memory, w, count, x, count[CULPRIT])
            if code != FINISHED:
                return code
        if count[EVENTS] >= flow.max_events:
            return TOO_MANY_EVENTS
        if len(memory.rows) > 0 and count[ROW] + 1 >= len(memory.rows):
            return BUFFER_FULL
        code = advance(m, flow, sp, scan, memory, tab, w, count, x)
        if code != FINISHED:
            return code
    if x[NOW] >= flow.t_end and count[CULPRIT] >= 0:
        return settle(m, flow, sp, memory, w, count, x, count[CULPRIT])
    return FINISHED


def advance(m: Any, flow: Any, sp: Any, scan: Any, memory: Any, tab: Any, w: Any, count: Any, x: Any) -> int:
    """One step, or the part of it up to the first guard that acts."""
    t, mode = x[NOW], count[MODE]
    h = min(min(x[NEXT], flow.longest), flow.t_end - t)
    while True:
        if not h > 4.0 * RESOLUTION * abs(t) and h < flow.t_end - t:
            return STEP_TOO_SMALL
        good = step(m, sp, tab, w, mode, t, h, False)
        count[FORCES] += STAGES
        error = error_norm(tab, w, h, flow.rtol, flow.atol) if good else 1e30
        if error < 1.0:
            break
        if not good and h < 1e-12 * (flow.t_end - t):
            return NOT_FINITE
        h *= max(LEAST, min(1.0, factor(error)))
    x[NEXT] = h * factor(error)
    complete(m, sp, tab, w, mode, t, h)
    k, at, slope, curvature = find(m, sp, scan, memory, w, mode, t, h, x)
    if k == UNKNOWN:
        return NOT_FINITE
    tau = h
    if k >= 0:
        memory.armed[k] = x[WAS_ARMED] > 0.0
        if memory.armed[k] and slope * slope <= -4.0 * memory.band[k] * curvature:
            keep(memory, w, count, t, h)
            interpolate(w.F, w.y, at, w.y_new)
            assign(w.y, w.y_new)
            count[CULPRIT], x[NOW] = k, t + at * h
            return NOT_TRANSVERSAL
        tau = locate(m, sp, tab, w, mode, k, t, h, at, slope, x, flow.t_end - t)
        complete(m, sp, tab, w, mode, t, tau)
        count[CULPRIT] = k
    keep(memory, w, count, t, tau)
    assign(w.y, w.y_new)
    x[NOW] = flow.t_end if tau >= flow.t_end - t else t + tau
    if m.below[mode] != NOT_SLIDING:
        project(m, sp, mode, x[NOW], w.y)
    count[STEP] += 1
    return FINISHED
