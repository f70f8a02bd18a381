"""The event-driven loop for any number of contacts and joints, as kernels.

Between events the closed contacts and the joints are held on acceleration level; an event is a contact that closes
(an impact, of all contacts closed at that time) or a multiplier that turns negative (a release, after which the
contact forces are sought anew). The motion is a DOP853 step, or exact where the acceleration is constant. See `held`
for the equations, `step` and `parabolas` for the motion, `modes` for the events, and `switching` for systems with
modes of their own.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE, TOO_MANY_EVENTS

if not cython.compiled:
    from lcpstep.events.general.equations import measure
    from lcpstep.events.general.keep import keep
    from lcpstep.events.general.modes import jump, obey, settle
    from lcpstep.events.general.motion import closed_from
    from lcpstep.events.general.parabolas import fly
    from lcpstep.events.general.state import (
        ENTERED,
        JUMP,
        JUMPED,
        LOOKED,
        MOVE,
        OBEY,
        SETTLE,
        SWITCH,
        Mechanism,
    )
    from lcpstep.events.general.step import complete, step
    from lcpstep.events.general.switching import look_at_guards, switch
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy

SLACK = 4  # rows that one round may need


def run(s: Any, record: Any, tally: Any, goal: Any) -> int:
    """`go_on`, called from Python."""
    return released(s, record, tally, goal)


def released(s: Mechanism, record: Record, tally: Tally, goal: int) -> int:
    """`go_on`, without the interpreter's lock."""
    with cython.nogil:
        return go_on(s, record, tally, goal)


def keep_state(s: Any, record: Any) -> None:
    """Keep the state at the base time, called from Python."""
    put_back(s, record)


def put_back(s: Mechanism, record: Record) -> None:
    """Keep the state at the base time."""
    copy(s.q, s.q0, 2 * s.n_q)
    keep(s, record, s.t0)


def go_on(s: Mechanism, record: Record, tally: Tally, goal: int) -> int:
    """Go on from t0 to the end of the span, or to step number `goal`; says why it returned."""
    code = DONE
    if record.row == 0 and tally.steps == 0 and s.next == MOVE:
        s.next = JUMP
        if not begin(s):
            return NOT_FINITE
    while code == DONE and (s.next != MOVE or (s.t0 < s.t_end and tally.steps < goal)):
        if s.next == JUMP:
            s.next = SETTLE
            code = jump(s, record, tally)
            s.guards = ENTERED if s.guards == ENTERED else JUMPED
        elif s.next == SETTLE:
            s.next = MOVE
            code = settle(s, record, tally)
        elif s.next == OBEY:
            s.next = MOVE
            obey(s, record, tally)
        elif s.next == SWITCH:
            s.next = JUMP
            code = switch(s, tally)
        elif s.watched and s.guards != LOOKED:
            look_at_guards(s)
        elif record.row == 0 and record.n_times == 0:
            keep(s, record, s.t0)
        elif 2 * record.event > record.event_capacity or record.row + SLACK > record.row_capacity:
            code = BUFFER_FULL
        elif tally.too_many():
            code = TOO_MANY_EVENTS
        elif s.t0 >= s.high:
            s.find_corners(s.t0)
            s.next = SETTLE
        elif s.constant:
            fly(s, record, tally)
        else:
            code = step(s)
            if code == DONE:
                code = complete(s, record, tally)
    return code


def begin(s: Mechanism) -> bool:
    """The state at the start of the span, where gaps that are zero are closed; False where not finite."""
    s.find_corners(s.t0)
    if not measure(s, s.t0):
        return False
    for c in range(s.n_c):
        if s.contact.gap[c] <= closed_from(s, c):
            s.contact.gap[c] = 0.0
    return True
