"""The event-driven loop for systems with modes, as kernels: a smooth step, the first guard within it, the switch.

A guard acts where it has been below its band, the accuracy to which it is known, and rises through it. Entered within
the band, a mode is left at once if the guard rises there; else the guard has to leave the band first. A guard that
touches the band and turns back is not transversal: tolerances decide whether it acts, and the run stops and says so.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import call_first_order
from lcpstep.dense import assign
from lcpstep.events.dop853 import interpolate
from lcpstep.events.hybrid.field import (
    ARRIVE,
    EXIT_ABOVE,
    EXIT_BELOW,
    NOT_SLIDING,
    RESOLUTION,
    approaches,
    band_and_rate,
    guard,
    project,
)
from lcpstep.events.hybrid.locate import UNKNOWN, find, locate
from lcpstep.events.hybrid.state import (
    BEGUN,
    BUFFER_FULL,
    CULPRIT,
    ENDLESS,
    EVENTS,
    FINISHED,
    LAST_SWITCH,
    LEAD,
    LENGTH,
    MODE,
    NEXT,
    NOT_FINITE,
    NOT_TRANSVERSAL,
    NOW,
    ROW,
    ROW_MODE,
    STALLED,
    STEP,
    SWITCH,
    SWITCH_LEAD,
    TIME,
    TOO_MANY_EVENTS,
    WAS_ARMED,
)
from lcpstep.events.hybrid.step import complete, take_step

MAX_STALLED = 100  # switches at one instant
NEVER_LEFT = 10  # how many of them a switch counts for by a guard whose band was not left


def run(s: Any, goal: int) -> int:
    """Go on from x[NOW] with the state w.y to the end of the span, or to step number `goal`; says why it returned."""
    x, count, memory, flow = s.x, s.count, s.memory, s.flow
    if count[BEGUN] == 0:
        count[BEGUN] = 1
        count[CULPRIT] = enter(s, -1)
    while x[NOW] < flow.t_end and count[STEP] < goal:
        if count[CULPRIT] >= 0:  # a switch is due
            code = settle(s, count[CULPRIT])
            if code != FINISHED:
                return code
        if count[EVENTS] >= flow.max_events:
            return TOO_MANY_EVENTS
        if len(memory.rows) > 0 and count[ROW] + 1 >= len(memory.rows):
            return BUFFER_FULL
        code = advance(s)
        if code != FINISHED:
            return code
    if x[NOW] >= flow.t_end and count[CULPRIT] >= 0:
        return settle(s, count[CULPRIT])
    return FINISHED


def advance(s: Any) -> int:
    """One step, or the part of it up to the first guard that acts."""
    w, x, count, memory = s.w, s.x, s.count, s.memory
    t, mode, t_end = x[NOW], count[MODE], s.flow.t_end
    h = take_step(s, min(min(x[NEXT], s.flow.longest), t_end - t))
    if h < 0.0:
        return int(-h)
    k, at, slope, curvature = find(s, h)
    if k == UNKNOWN:
        return NOT_FINITE
    tau = h
    if k >= 0:
        memory.armed[k] = x[WAS_ARMED] > 0.0
        if memory.armed[k] and slope * slope <= -4.0 * memory.band[k] * curvature:
            keep(s, h)
            interpolate(w.F, w.y, at, w.y_new)
            assign(w.y, w.y_new)
            count[CULPRIT], x[NOW] = k, t + at * h
            return NOT_TRANSVERSAL
        tau = locate(s, k, h, at, slope)
        complete(s, tau)
        count[CULPRIT] = k
    keep(s, tau)
    assign(w.y, w.y_new)
    x[NOW] = t_end if tau >= t_end - t else t + tau
    if s.m.below[mode] != NOT_SLIDING:
        project(s.m, mode, x[NOW], w.y)
    count[STEP] += 1
    return FINISHED


def keep(s: Any, h: float) -> None:
    """One row: the state, the step that follows and its dense output."""
    memory, count = s.memory, s.count
    if len(memory.rows) == 0 or h == 0.0:
        return
    row = memory.rows[count[ROW]]
    row[TIME], row[LENGTH], row[ROW_MODE] = s.x[NOW], h, count[MODE]
    for i in range(len(s.w.y)):
        row[LEAD + i] = s.w.y[i]
    if h > 0.0:
        assign(memory.dense[count[ROW]], s.w.F)
    count[ROW] += 1


def settle(s: Any, k: int) -> int:
    """Guard k acts, and after it whatever acts at the same instant."""
    count = s.count
    while k >= 0:
        if count[SWITCH] >= len(s.memory.log):
            count[CULPRIT] = k
            return BUFFER_FULL
        k = switch(s, k)
        if count[STALLED] > MAX_STALLED:
            return ENDLESS
        if count[EVENTS] >= s.flow.max_events and k >= 0:
            return TOO_MANY_EVENTS
    count[CULPRIT] = -1
    return FINISHED


def switch(s: Any, k: int) -> int:
    """Guard k acts at w.y: log, reset, new mode. Returns the guard that acts at once in that mode, or -1."""
    m, y, moved, count, x = s.m, s.w.y, s.m.work.moved, s.count, s.x
    t, mode, n = x[NOW], count[MODE], len(y)
    if t - x[LAST_SWITCH] <= 4.0 * RESOLUTION * abs(t):
        count[STALLED] += 1
    elif not s.memory.armed[k] and count[EVENTS] > 0:
        count[STALLED] += NEVER_LEFT
    else:
        count[STALLED] = 0
    assign(moved, y)
    if m.has_reset[k]:
        call_first_order(m.resets[k], t, y, m.p, moved)
    target, left = target_of(s, k)
    if m.below[target] != NOT_SLIDING:
        project(m, target, t, moved)
    line = s.memory.log[count[SWITCH]]
    line[0], line[1], line[2], line[3] = t, mode, target, k
    for i in range(n):
        line[SWITCH_LEAD + i], line[SWITCH_LEAD + n + i] = y[i], moved[i]
    assign(y, moved)
    count[SWITCH] += 1
    count[EVENTS] += 1
    count[MODE], x[LAST_SWITCH] = target, t
    return enter(s, left)


def target_of(s: Any, k: int) -> tuple[int, int]:
    """The mode that guard k leads to from w.y, and the sliding mode that it ends, or -1."""
    m, mode = s.m, s.count[MODE]
    target, left = m.target[k], -1
    if m.kind[k] == ARRIVE:
        L1, L2 = approaches(m, target, s.x[NOW], s.w.y)
        if mode == m.below[target] and L2 > 0.0:
            target = m.above[target]
        elif mode == m.above[target] and L1 < 0.0:
            target = m.below[target]
    elif m.kind[k] == EXIT_BELOW:
        target, left = m.below[mode], mode
    elif m.kind[k] == EXIT_ABOVE:
        target, left = m.above[mode], mode
    return target, left


def enter(s: Any, left: int) -> int:
    """Begin a mode at w.y; the guard that leaves it at once, or -1. left: the sliding mode just ended, or -1."""
    m, memory, mode, t, y = s.m, s.memory, s.count[MODE], s.x[NOW], s.w.y
    leaves = -1
    for k in range(m.first[mode], m.first[mode + 1]):
        band, rate, noise = band_and_rate(m, mode, k, t, y, s.flow)
        g = guard(m, mode, k, t, y)
        memory.band[k], memory.armed[k] = band, g < -band
        passed = g > band or (g >= -band and rate > noise)
        if m.kind[k] == ARRIVE and m.target[k] == left:
            passed = g > band
        if passed and m.at_once[k] and leaves < 0:
            leaves = k
    return leaves
