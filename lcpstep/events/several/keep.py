"""Events and states that are kept, as kernels; see `recording`."""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign
from lcpstep.events.bookkeeping import EVENT, NEXT_TIME, ROW, count_event, keeps_events, take_back
from lcpstep.events.clock import LAST_EVENT, RESOLUTION, T0
from lcpstep.events.several.motion import state_at
from lcpstep.events.several.state import (
    ACCELERATION,
    CLOSED,
    IMPULSE,
    LENGTH,
    OWED,
    OWED_UNTIL,
    Q,
    V,
)
from lcpstep.recording import LEAD, write_event
from lcpstep.recording import LENGTH as STEP_LENGTH
from lcpstep.recording import TIME as ROW_TIME


def log(
    s: Any, record: Any, count: Any, t: float, c: int, kind: float, before: float, after_: float, p: float
) -> None:
    """Note an event; those that pass without the time going on are counted."""
    write_event(record.events[count[EVENT]], t, c, before, after_, p, int(kind))
    stalled = abs(s.x[T0] - s.x[LAST_EVENT]) <= 4.0 * RESOLUTION * abs(s.x[T0])
    count_event(count, stalled)
    s.x[LAST_EVENT] = s.x[T0]


def keep_wanted(s: Any, record: Any, count: Any) -> None:
    """Keep the state that is asked for next."""
    t = record.times[count[NEXT_TIME]]
    state_at(s, t - s.x[T0])
    keep(s, record, count, t)
    count[NEXT_TIME] += 1


def keep_event(s: Any, record: Any, count: Any, t: float) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if not keeps_events(record):
        return
    if take_back(record, count, t):
        row, n = record.rows[count[ROW]], LEAD + 2 * s.state.shape[1]
        for c in range(len(s.G)):
            s.contact[IMPULSE, c] += row[n + c]
        for i in range(len(s.J)):
            s.joint[IMPULSE, i] += row[n + len(s.G) + i]
    keep(s, record, count, t)


def keep(s: Any, record: Any, count: Any, t: float) -> None:
    """Keep the state Q, V at time t, and the impulses of contacts and joints since the one before."""
    row, n = record.rows[count[ROW]], s.state.shape[1]
    row[ROW_TIME] = t
    for j in range(n):
        row[LEAD + j], row[LEAD + n + j] = s.state[Q, j], s.state[V, j]
    for c in range(len(s.G)):
        if s.contact[OWED, c] < 0.0:
            pay(s, c, t)
        row[LEAD + 2 * n + c], s.contact[IMPULSE, c] = s.contact[IMPULSE, c], 0.0
    for i in range(len(s.J)):
        row[LEAD + 2 * n + len(s.G) + i], s.joint[IMPULSE, i] = s.joint[IMPULSE, i], 0.0
    count[ROW] += 1


def pay(s: Any, c: int, t: float) -> None:
    """Pay what the end of a chattering sequence has taken on account; t: the time of the row to be kept."""
    p = s.contact[IMPULSE, c] + s.contact[OWED, c]
    due = p >= 0.0 or s.mode[CLOSED, c] == 0 or t >= s.contact[OWED_UNTIL, c]
    s.contact[IMPULSE, c], s.contact[OWED, c] = (p, 0.0) if due else (0.0, p)


def store_dense(s: Any, record: Any, count: Any) -> None:
    """Keep the motion from the last kept state on: the dense output of the step, or the acceleration."""
    if len(record.dense) > 0:
        if s.constant:
            assign(record.dense[count[ROW] - 1], s.state[ACCELERATION])
        else:
            assign(record.dense[count[ROW] - 1], s.w.F)
        record.rows[count[ROW] - 1, STEP_LENGTH] = s.x[LENGTH]
