"""The event-driven loop for several contacts and joints, as kernels.

Between events the closed contacts and the joints are held on acceleration level; an event is a contact that closes
(an impact, of all contacts closed at that time) or a multiplier that turns negative (a release, after which the
contact forces are sought anew). The motion is a DOP853 step, or exact where the acceleration is constant. See `held`
for the equations, `step` and `parabolas` for the motion, and `modes` for the events.
"""

from __future__ import annotations

from typing import Any

from lcpstep.events.bookkeeping import (
    BUFFER_FULL,
    EVENT,
    FINISHED,
    NOT_FINITE,
    ROW,
    SLACK,
    STEP,
    TOO_MANY_EVENTS,
    too_many,
)
from lcpstep.events.clock import HIGH, T0, find_corners
from lcpstep.events.several.equations import measure
from lcpstep.events.several.keep import keep
from lcpstep.events.several.modes import jump, obey, settle
from lcpstep.events.several.motion import touching
from lcpstep.events.several.parabolas import fly
from lcpstep.events.several.state import GAP, JUMP, MOVE, NEXT, OBEY, SETTLE
from lcpstep.events.several.step import complete, step


def run(s: Any, record: Any, count: Any, goal: int) -> int:
    """Go on from x[T0] to the end of the span, or to step number `goal`; says why it returned."""
    code = FINISHED
    if count[ROW] == 0 and count[STEP] == 0 and s.number[NEXT] == MOVE:
        s.number[NEXT] = JUMP
        if not begin(s):
            return NOT_FINITE
    while code == FINISHED and (s.number[NEXT] != MOVE or (s.x[T0] < s.plan.t_end and count[STEP] < goal)):
        if s.number[NEXT] == JUMP:
            s.number[NEXT] = SETTLE
            code = jump(s, record, count)
        elif s.number[NEXT] == SETTLE:
            s.number[NEXT] = MOVE
            code = settle(s, record, count)
        elif s.number[NEXT] == OBEY:
            s.number[NEXT] = MOVE
            obey(s, record, count)
        elif count[ROW] == 0 and len(record.times) == 0:
            keep(s, record, count, s.x[T0])
        elif 2 * count[EVENT] > len(record.events) or count[ROW] + SLACK > len(record.rows):
            code = BUFFER_FULL
        elif too_many(count):
            code = TOO_MANY_EVENTS
        elif s.x[T0] >= s.x[HIGH]:
            find_corners(s, s.x[T0])
            s.number[NEXT] = SETTLE
        elif s.constant:
            fly(s, record, count)
        else:
            code = step(s, count)
            if code == FINISHED:
                code = complete(s, record, count)
    return code


def begin(s: Any) -> bool:
    """The state at the start of the span, where gaps that are zero to rounding are closed; False where not finite."""
    find_corners(s, s.x[T0])
    if not measure(s, s.x[T0]):
        return False
    for c in range(len(s.G)):
        if s.contact[GAP, c] <= touching(s, c):
            s.contact[GAP, c] = 0.0
    return True
