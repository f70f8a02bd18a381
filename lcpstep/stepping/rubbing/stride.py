"""A step with friction, up to the first event within it, as kernels; the counterpart of `events.contacts.step`."""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN
from lcpstep.events.contacts.arrival import arrive, find_standing, of_force, tells
from lcpstep.events.contacts.balance import lets_go
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.leaning import gives
from lcpstep.events.contacts.loose import first_stray
from lcpstep.events.contacts.modes import decide, keep_mode, mark_undecided
from lcpstep.events.contacts.moments import of_sliding
from lcpstep.events.contacts.state import GUARDS
from lcpstep.events.contacts.step import mark_resting
from lcpstep.events.contacts.surfaces import FREE
from lcpstep.events.hybrid.roots import NONE
from lcpstep.events.rows.chatter import moves
from lcpstep.events.rows.contacts import add_impulse, hold_modes, still_below
from lcpstep.events.rows.equations import list_gaps, respond_to
from lcpstep.events.rows.jumps import breaks
from lcpstep.events.rows.keep import keep, keep_awaited, keep_event
from lcpstep.events.rows.loads import list_by_row
from lcpstep.events.rows.projection import project
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.status import DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, PROJECTION_FAILED
from lcpstep.kernels.vectors import add, copy, product
from lcpstep.pointers import abs, after, max, min
from lcpstep.stepping.rubbing.found import (
    arm,
    first_event,
    hides,
    interrupt,
    locate,
    look_after,
    note_arrival,
    note_base,
)
from lcpstep.stepping.rubbing.paced import pace
from lcpstep.stepping.rubbing.strides import Strides, go_on_with, push_end_back

# Of a step: where the forces after a release, or a slip, are looked at, and how much further each time that nothing
# is seen of it there
LOOK_AHEAD, FURTHER = 1e-4, 10.0
LANDINGS = 3  # of a state between, by Newton's method
TORN = -2  # in place of a guard


def stride(s: Strides) -> int:
    """What is left of the step, up to the first event within it; what comes next into `next`. A status."""
    t0, goal = s.rows.t0, s.goal(s.rows.tally.steps)
    if goal <= t0:
        end_step(s)
        return DONE
    s.rows.culprit = -1
    border = min(goal, s.rows.high)
    h = border - t0
    if not s.going and not note_base(s, t0):
        return failed(s)
    s.going = False
    code = search(s, t0, h)
    if code != DONE or s.guard == TORN:
        return code
    if s.length < h:
        h = s.length
        border = s.rows.after(h)
        goal = border if s.tolerance > 0.0 else goal
    g, tau = s.guard, s.tau
    if g < 0:
        take_over(s, border, h)
        arm(s)
        arrive_with(s, border)
        if border >= goal:
            end_step(s)
        elif border < s.rows.high:
            keep_event(s.rows, border)
        return DONE
    if tau == NONE:
        return pass_by(s, s.found * h)
    if of_force(s, g):
        code = look_ahead(s, g // GUARDS, h, tau)
        if code != DONE:
            return code
        if tau > 0.0 and not s.step(t0, tau):
            return failed(s)
    take_over(s, border if tau >= h else min(s.rows.after(tau), border), tau)
    return arrive(s, g)


def search(s: Strides, t: float, h: float) -> int:
    """A step from t of size h, or shorter, and the first event within it: `guard`, and `tau` from t; a status.

    A polynomial that tells of an event which the motion does not have is wrong by a power of the step, beside what a
    gap that opens by a force which begins at zero is there: half the step tells better, of what an edge hides, too.
    Where a velocity jumps within the step the guard is TORN: that is a corner, up to which the step is to be made
    again.
    """
    while True:
        code = attempt(s, t, h)
        if code != DONE:
            return code
        h = s.length
        mark_resting(s)
        if h == 0.0 or breaks(s.rows, s, h, True):
            s.guard = TORN
            return DONE
        s.tau = locate(s, s.guard, h) if first_event(s, h) >= 0 else NONE
        if s.loose > 0 and first_stray(s, h, 0.0, 1.0 if s.tau == NONE else s.tau / h):
            s.tau = s.found * h
            if s.tau > 0.0:
                look_after(s, s.tau)
        if s.tau != NONE and turns_at_once(s, s.guard):
            s.rows.break_at(t + s.tau)
            s.guard = TORN
            return DONE
        seen = s.tau != NONE or (s.guard >= 0 and s.found >= 0.5) or (s.guard < 0 and not hides(s, t, h))
        if seen or h <= s.no_time():
            return DONE
        h *= 0.5


def turns_at_once(s: Strides, g: int) -> bool:
    """Whether guard g, located within the step, is a sliding velocity that is not zero there: its belt has jumped."""
    if not of_sliding(s, g):
        return False
    none = still_below(s.rows, s.n_j + s.n_c + g // GUARDS)
    rounding = NOISE * (abs(s.rows.t0) + s.tau) * abs(s.begin_slope[g])
    return s.begin_value[g] >= -none and abs(s.value[g]) > max(none, rounding)


def attempt(s: Strides, t: float, h: float) -> int:
    """A step from t of size h, or shorter where a tolerance asks for it, and guards where it ends; a status."""
    if s.tolerance > 0.0:
        return pace(s, t, h)
    s.length = h
    return DONE if s.step(t, h) and note_arrival(s, t, h) else failed(s)


def failed(s: Strides) -> int:
    """Why there was no step."""
    if s.astray >= 0:
        return PROJECTION_FAILED
    return PAINLEVE_INCONSISTENT if s.rows.culprit >= 0 else NOT_FINITE


def pass_by(s: Strides, tau: float) -> int:
    """Go on to where an event was expected that there is none of, and look again from there."""
    if not s.step(s.rows.t0, tau):
        return failed(s)
    take_over(s, s.rows.after(tau), tau)
    keep_event(s.rows, s.rows.t0)
    return DONE


def look_ahead(s: Strides, c: int, h: float, tau: float) -> int:
    """The modes just after the force of contact c has left its cone, or turned to pulling; a status."""
    t0, ahead = s.rows.t0, LOOK_AHEAD * h
    while True:
        if not s.step(t0, tau + ahead) or not measure(s, t0 + tau + ahead, s.y_new):
            return failed(s)
        find_standing(s)
        code = decide(s)
        if ahead > LOOK_AHEAD * h:
            leave_to_guards(s, c)
        waits = code == DONE and mark_undecided(s)
        # Another mode, or its load left to others that hold it too
        changes = (s.new_mode[c] != s.mode[c] and tells(s)) or s.new_loaded[c] != s.loaded[c]
        hold_modes(s.rows)  # the old ones, for what is stepped further, and the rest of the step
        if code != DONE or ahead >= h or (changes and not waits):
            break
        ahead *= FURTHER
    s.decided = t0 + tau + ahead
    return code


def leave_to_guards(s: Strides, c: int) -> None:
    """Keep the modes of pressed contacts that forces of contact c do not move, and that open or slip further ahead.

    They do so later than contact c, as their own guards will say.
    """
    for d in range(s.n_c):
        if d != c and lets_go(s, d) and not moves(s.rows, c, d):
            keep_mode(s, d)


def take_over(s: Strides, t: float, tau: float) -> None:
    """The motion over the first `tau` of the step is final: its impulses, the states asked for, the next base."""
    interrupt(s, t, tau)
    if tau > 0.0:
        if s.rows.n_held > 0:
            put_end_back(s)
            s.based = True
        pressed = keep_between(s, t, tau)
        press(s, pressed, 1.0)
        copy(s.y, s.y_new, s.n)
    s.rows.start_at(t)
    while s.rows.record.wants(t, t >= s.rows.t_end):  # the end of the span
        keep_awaited(s.rows, s.y)


def put_end_back(s: Strides) -> None:
    """Put the velocity at the end of the step onto the rows held, so that states between lead up to there.

    The position is there already: what is found of gaps is of the motion that goes on.
    """
    push_end_back(s, after(s.y_new, s.n_q))
    list_by_row(s.rows, s.change, s.rows.near)
    add(s.push, 1.0, s.rows.near, s.n_r)


def keep_between(s: Strides, t: float, tau: float) -> float:
    """Keep the states asked for before the end t of the step, on the rows held, and its dense output.

    Returned: up to which fraction of the step impulses have been kept.
    """
    pressed = 0.0
    s.length = tau
    if s.rows.record.dense_size > 0 or s.rows.record.wants(t, False):
        s.complete(s.rows.t0, tau)
    while s.rows.record.wants(t, False):
        place = (s.rows.record.awaited() - s.rows.t0) / tau
        copy(s.seen, s.y, s.n)
        if place > 0.0:
            press(s, pressed, place)
            s.at(place, s.seen)
            if s.rows.n_held > 0:
                put_between(s, s.rows.record.awaited())
                s.based = False
            pressed = place
        keep_awaited(s.rows, s.seen)
    s.rows.record.store(s.F, s.length)
    return pressed


def put_between(s: Strides, t: float) -> None:
    """Put the state `seen` onto the rows held, and out of obstacles: what has just been let go rises slowly."""
    for _ in range(LANDINGS):
        project(s.rows, t, s.seen)
        if not leaves_obstacles(s, t):
            break


def leaves_obstacles(s: Strides, t: float) -> bool:
    """Put open contacts that are inside of their obstacles at `seen` onto these, rows held as they are; if any."""
    some = False
    list_gaps(s.rows, t, s.seen, s.gap)
    for c in range(s.n_c):
        i = s.n_j + c
        if s.mode[c] == OPEN and s.gap[i] < -s.band[GUARDS * c]:
            respond_to(s.rows, i)
            way = gives(s, i)
            if way > FREE * product(s.R, after(s.MR, i * s.n_q), i, s.n_q):
                add(s.seen, -s.gap[i] / way, s.dv, s.n_q)
                some = True
    return some


def press(s: Strides, a: float, b: float) -> None:
    """Add the impulses of the forces between two places in the step."""
    if s.rows.n_held == 0:
        return
    for i in range(s.n_r):
        change = s.push[i] if b >= 1.0 else s.pressed(i, b)
        add_impulse(s.rows, i, change - s.pressed(i, a) if a > 0.0 else change)


def arrive_with(s: Strides, t: float) -> None:
    """What is known where a step has ended is known where the next one begins, unless it begins at a corner.

    Forces are those of before `put_end_back`, the velocity is that of after it.
    """
    s.going = t < s.rows.high
    if s.going:
        go_on_with(s)
        copy(s.begin_value, s.end_value, GUARDS * s.n_c)
        copy(s.begin_slope, s.end_slope, GUARDS * s.n_c)
        copy(s.begin_bend, s.end_bend, s.n_c)


def end_step(s: Strides) -> None:
    """A step has ended; its state is kept where it is asked for."""
    s.rows.tally.steps += 1
    if s.rows.record.is_due(s.rows.tally.steps):
        if s.rows.record.keeps_events():
            keep_event(s.rows, s.rows.t0)
        else:
            keep(s.rows, s.rows.t0, s.y)
