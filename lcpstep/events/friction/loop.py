"""The event-driven loop for contacts with friction, as kernels.

Between events every contact is open, sticks or slides in one direction, and the motion is smooth (`held`); a guard
that falls through zero ends that (`guards`). Contacts that meet strike (`impact`), then the forces decide about the
modes that follow (`modes`). Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley
1996).
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.events.friction.codes import BEGIN, DECIDE, JUMP, MOVE, OBEY, OPEN
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, TOO_MANY_EVENTS

if not cython.compiled:
    from lcpstep.events.friction.equations import measure
    from lcpstep.events.friction.guards import begin_guards
    from lcpstep.events.friction.impact import close_small, forget_terms, jam, jump, still, touching
    from lcpstep.events.friction.keep import keep, keep_event
    from lcpstep.events.friction.modes import decide, obey, take_over, undecided
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.pointers import abs, min

SLACK = 4  # rows that one round may need
# Of the interval looked at: where forces that begin at zero are looked at, and how much further while they are zero
LOOK_AHEAD, FURTHER = 1e-6, 10.0
NO_TIME = 2.0**-50  # of the interval looked at: stretches of motion this short take no time


def run(s: Any, record: Any, tally: Any, goal: Any) -> int:
    """`go_on`, called from Python."""
    return released(s, record, tally, goal)


def released(s: Rubbing, record: Record, tally: Tally, goal: int) -> int:
    """`go_on`, without the interpreter's lock."""
    with cython.nogil:
        return go_on(s, record, tally, goal)


def keep_state(s: Any, record: Any) -> None:
    """Keep the state at the base time, called from Python."""
    put_back(s, record)


def put_back(s: Rubbing, record: Record) -> None:
    """Keep the state at the base time."""
    keep(s, record, s.clock.t0, s.y)


def go_on(s: Rubbing, record: Record, tally: Tally, goal: int) -> int:
    """Go on from the base time to the end of the span, or to step number `goal`; says why it returned."""
    code = DONE
    while code == DONE and (s.next != MOVE or (s.clock.t0 < s.t_end and tally.steps < goal)):
        if s.next == BEGIN:
            code = begin(s)
        elif s.next == JUMP:
            code = jump(s, record, tally, s.clock.t0)
            if code == DONE:
                s.next = DECIDE
        elif s.next == DECIDE:
            s.next = MOVE
            code = settle(s, record, tally)
        elif s.next == OBEY:
            s.next = MOVE
            code = follow(s, record, tally)
        elif record.row == 0 and record.n_times == 0:
            keep(s, record, s.clock.t0, s.y)
        elif 2 * record.event > record.event_capacity or record.row + SLACK > record.row_capacity:
            code = BUFFER_FULL
        elif tally.too_many():
            code = TOO_MANY_EVENTS
        elif s.clock.t0 >= s.clock.high:
            code = turn_corner(s)
        else:
            code = progress(s, record, tally)
        if code == PAINLEVE_INCONSISTENT and s.yields and s.culprit >= 0:
            code = jam(s, record, tally, s.clock.t0)
    return code


def progress(s: Rubbing, record: Record, tally: Tally) -> int:
    """One step of the motion, up to an event; those that take no time are counted, for rounding may ask for them."""
    t = s.clock.t0
    code = s.proceed(record, tally)
    tally.stalled = tally.stalled + 1 if s.clock.t0 - t <= NO_TIME * s.scan_length else 0
    return code


def begin(s: Rubbing) -> int:
    """The state at the start of the span, where gaps that are zero to rounding or the tolerance are closed."""
    s.clock.find_corners(s.clock.t0)
    if not measure(s, s.clock.t0, s.y):
        return NOT_FINITE
    for c in range(s.n_c):
        s.touches[c] = 1 if s.gap[s.n_j + c] <= touching(s, c) else 0
    forget_terms(s)
    s.next = JUMP
    return DONE


def turn_corner(s: Rubbing) -> int:
    """Beyond a corner, where obstacles and belts may have jumped in speed, contacts strike and modes are sought."""
    s.clock.find_corners(s.clock.t0)
    if not measure(s, s.clock.t0, s.y):
        return NOT_FINITE
    for c in range(s.n_c):
        i = s.n_j + c
        s.touches[c] = 1 if s.mode[c] != OPEN else 0
        if s.mode[c] != OPEN and abs(s.velocity[i]) > still(s, i):
            s.mode[c] = OPEN
    forget_terms(s)
    s.next = JUMP
    return DONE


def settle(s: Rubbing, record: Record, tally: Tally) -> int:
    """Forces and modes at the base state, where `free` says which contacts do not slide; hops that end."""
    t = s.clock.t0
    for turn in range(s.n_c + 1):
        if not measure(s, t, s.y):
            return NOT_FINITE
        code = decide(s)
        if code == DONE and undecided(s):
            code = look_on(s, t)
        if code == DONE:
            code = obey(s, record, tally, t)
        if code != DONE:
            return code
        if turn == s.n_c or not close_small(s, record, tally, t):
            break
    return set_out(s, record, t)


def look_on(s: Rubbing, t: float) -> int:
    """The modes just after the base time, at which the forces leave some of them open; a status.

    A contact whose force begins at zero is decided by the first force that can be told from zero.
    """
    longest = min(s.scan_length, min(s.t_end, s.clock.high) - t)
    ahead = LOOK_AHEAD * longest
    while 0.0 < ahead <= longest:
        s.culprit = -1
        code = take_over(s)
        if code != DONE:
            return code
        if not (s.rates(t, s.y, s.K) and s.step(t, ahead) and measure(s, t + ahead, s.y_new)):
            return PAINLEVE_INCONSISTENT if s.culprit >= 0 else NOT_FINITE
        code = decide(s)
        if code != DONE:
            return code
        if not undecided(s):
            break
        ahead *= FURTHER
    code = take_over(s)
    for c in range(s.n_c):
        s.new_mode[c] = s.mode[c]
    if code != DONE:
        return code
    return DONE if measure(s, t, s.y) else NOT_FINITE


def follow(s: Rubbing, record: Record, tally: Tally) -> int:
    """Obey the modes that `look_ahead` has found."""
    code = obey(s, record, tally, s.clock.t0)
    return set_out(s, record, s.clock.t0) if code == DONE else code


def set_out(s: Rubbing, record: Record, t: float) -> int:
    """The motion goes on with the modes at hand."""
    for c in range(s.n_c):
        s.touches[c] = 1 if s.mode[c] != OPEN else 0
    if not begin_guards(s, t):
        return NOT_FINITE
    keep_event(s, record, t)
    return DONE
