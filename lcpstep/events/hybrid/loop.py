"""The event-driven loop for systems with modes, as kernels: a smooth step, the first guard within it, the switch.

A guard acts where it has been below its band, the accuracy to which it is known, and rises through it. Entered within
the band, a mode is left at once if the guard rises there; else the guard has to leave the band first. A guard that
touches the band and turns back is not transversal: tolerances decide whether it acts, and the run stops and says so.
"""

from __future__ import annotations

import cython

from lcpstep.events.hybrid.field import approaches, band_and_rate, guard, project
from lcpstep.events.hybrid.kinds import ARRIVE, EXIT_ABOVE, EXIT_BELOW, NOT_SLIDING
from lcpstep.events.hybrid.locate import UNKNOWN, find, locate, turns_back
from lcpstep.events.hybrid.state import Motion
from lcpstep.kernels.course import AHEAD, ARRIVED, DUE, Course
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import (
    BUFFER_FULL,
    DONE,
    ENDLESS_SWITCHING,
    NOT_FINITE,
    NOT_TRANSVERSAL,
    STEP_TOO_SMALL,
    TOO_MANY_EVENTS,
)
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import abs, max, min

MAX_STALLED = 100  # switches at one instant
NEVER_LEFT = 10  # how many of them a switch counts for by a guard whose band was not left
LONGER = 100.0  # than modes that such guards have left lasts one that goes on


class Switching(Course):
    """A motion from mode to mode; s : Motion."""

    def __init__(self, s: Motion) -> None:
        self.s = s

    def stage(self, goal: int) -> int:
        """Whether the motion is to begin, or a switch is due, or it goes on."""
        if not self.s.begun or self.s.due >= 0:
            return DUE
        return AHEAD if self.s.now < self.s.t_end and self.s.steps < goal else ARRIVED

    def happen(self) -> int:
        """Begin, or switch; a status."""
        if self.s.begun:
            return settle(self.s)
        self.s.begun = True
        self.s.due = enter(self.s, -1, False)
        return DONE

    def refusal(self) -> int:
        """Whether there were as many switches as allowed, or buffers are full."""
        if self.s.events >= self.s.max_events:
            return TOO_MANY_EVENTS
        return BUFFER_FULL if 0 < self.s.row_capacity <= self.s.row + 1 else DONE

    def move(self) -> int:
        """A step, up to the first guard that acts; a status."""
        return advance(self.s)


def advance(s: Motion) -> int:
    """One step, or the part of it up to the first guard that acts."""
    t = s.now
    left = s.t_end - t
    s.next_step = min(s.next_step, s.longest)
    if not s.next_step > 4.0 * RESOLUTION * abs(t) and s.next_step < left:
        return STEP_TOO_SMALL
    code = s.take_step(t, left, s.longest)
    if code != DONE:
        return code
    h = s.length
    k = find(s, h, 1.0)
    if k == UNKNOWN:
        return NOT_FINITE
    tau = h
    if k >= 0:
        s.armed[k] = s.was_armed
        if turns_back(s):
            s.keep(h)
            s.at(s.place, s.y_new)
            copy(s.y, s.y_new, s.n)
            s.due, s.now = k, t + s.place * h
            return NOT_TRANSVERSAL
        tau = locate(s, h)
        s.complete(t, tau)
        s.due = k
    s.keep(tau)
    copy(s.y, s.y_new, s.n)
    s.now = s.t_end if tau >= left else t + tau
    if s.m.below[s.mode] != NOT_SLIDING:
        project(s.m, s.mode, s.now, s.y)
    s.steps += 1
    return DONE


def settle(s: Motion) -> int:
    """The guard by which a switch is due acts, and after it whatever acts at the same instant."""
    while s.due >= 0:
        if s.switches >= s.log_capacity:
            return BUFFER_FULL
        s.due = enter(s, leave(s, s.due), False)
        if s.stalled > MAX_STALLED:
            return ENDLESS_SWITCHING
        if s.events >= s.max_events and s.due >= 0:
            return TOO_MANY_EVENTS
    return DONE


def leave(s: Motion, k: int) -> int:
    """Guard k acts at y: log, reset, new mode. Returns the sliding mode that it ends, or -1."""
    t, n = s.now, s.n
    if t - s.last_switch <= 4.0 * RESOLUTION * abs(t):
        s.stalled += 1
    elif s.armed[k] == 0 and s.events > 0:
        s.stalled += NEVER_LEFT
        s.brief = max(s.brief, t - s.last_switch)
    elif t - s.last_switch > LONGER * s.brief:  # no turn among guards the bands of some of which are not left
        s.stalled, s.brief = 0, 0.0
    copy(s.m.moved, s.y, n)
    if s.m.has_reset[k] != 0:
        s.m.resets.fill(k, t, s.y, s.y, s.m.moved)
    target, left = target_of(s, k)
    if s.m.below[target] != NOT_SLIDING:
        project(s.m, target, t, s.m.moved)
    s.note(target, k, s.m.moved)
    copy(s.y, s.m.moved, n)
    s.mode, s.last_switch = target, t
    return left


def target_of(s: Motion, k: int) -> tuple[int, int]:
    """The mode that guard k leads to from y, and the sliding mode that it ends, or -1."""
    mode = s.mode
    target, left = s.m.target[k], -1
    if s.m.kind[k] == ARRIVE:
        L1, L2 = approaches(s.m, target, s.now, s.y)
        if mode == s.m.below[target] and L2 > 0.0:
            target = s.m.above[target]
        elif mode == s.m.above[target] and L1 < 0.0:
            target = s.m.below[target]
    elif s.m.kind[k] == EXIT_BELOW:
        target, left = s.m.below[mode], mode
    elif s.m.kind[k] == EXIT_ABOVE:
        target, left = s.m.above[mode], mode
    return target, left


def enter(s: Motion, left: int, jumped: bool) -> int:
    """Begin a mode at y; the guard that leaves it at once, or -1. left: the sliding mode just ended, or -1.

    jumped: the mode has not just begun, but an impact has moved y; a guard that this has carried through zero acts.
    """
    mode, t, leaves = s.mode, s.now, -1
    s.rates(t, s.y, s.m.F)
    for k in range(s.m.first[mode], s.m.first[mode + 1]):
        band, rate, noise = band_and_rate(s.m, mode, k, t, s.y, s.rtol, s.atol)
        g, may_act = guard(s.m, mode, k, t, s.y), s.m.at_once[k] != 0 or (jumped and s.armed[k] != 0)
        s.band[k], s.armed[k] = band, g < -band
        passed = g > band or (g >= -band and rate > noise)
        if s.m.kind[k] == ARRIVE and s.m.target[k] == left:
            passed = g > band
        if passed and may_act and leaves < 0:
            leaves = k
    return leaves
