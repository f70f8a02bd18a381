"""States that are kept: at times asked for, after events, and between kept ones, as kernels."""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign
from lcpstep.events.bookkeeping import NEXT_TIME, ROW, is_wanted, keeps_events
from lcpstep.events.clock import T0
from lcpstep.events.contact import MODE, keep, keep_instead
from lcpstep.events.single.equations import LENGTH
from lcpstep.events.single.motion import rebase, state_at
from lcpstep.recording import LENGTH as STEP_LENGTH


def keep_times(s: Any, record: Any, count: Any, stop: float, last: bool) -> None:
    """Keep the states asked for before the time `stop` (and at it, at the end of the span)."""
    while is_wanted(record, count, stop, last):
        t = record.times[count[NEXT_TIME]]
        state_at(s, t - s.x[T0])
        keep(s, record, count, t)
        count[NEXT_TIME] += 1


def keep_event(s: Any, record: Any, count: Any) -> None:
    """Keep the state after an event, if these are kept."""
    if keeps_events(record):
        assign(s.q, s.q0)
        assign(s.v, s.v0)
        keep_instead(s, record, count)


def store_dense(s: Any, record: Any, count: Any) -> None:
    """Keep the dense output of the step that began at the last kept state."""
    if len(record.dense) > 0:
        assign(record.dense[count[ROW] - 1], s.w.F)
        record.rows[count[ROW] - 1, STEP_LENGTH] = s.x[LENGTH]


def evaluate(s: Any, kept: Any, dense: Any, wanted: Any) -> None:
    """States at the times wanted, from the kept states before them and the pieces that start there."""
    for k in range(len(wanted.t)):
        row = wanted.row[k]
        assign(s.q, kept.q[row])
        assign(s.v, kept.v[row])
        tau = wanted.t[k] - kept.t[row]
        rebase(s, kept.t[row])
        s.x[MODE] = kept.mode[row]
        if tau > 0.0:
            assign(s.w.F, dense[row])
            s.x[LENGTH] = kept.length[row]
            state_at(s, tau)
        assign(wanted.q[k], s.q)
        assign(wanted.v[k], s.v)
