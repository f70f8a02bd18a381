"""States of flights that are kept: at times asked for, after events, and between kept ones, as kernels."""

from __future__ import annotations

from typing import Any

from lcpstep.events.bookkeeping import NEXT_TIME, is_wanted, keeps_events
from lcpstep.events.clock import find_corners
from lcpstep.events.contact import MODE, keep, keep_instead
from lcpstep.events.flight.motion import Q0, V0, rebase, state_at


def keep_times(s: Any, record: Any, count: Any, stop: float, last: bool) -> None:
    """Keep the states asked for before the time `stop` (and at it, at the end of the span)."""
    while is_wanted(record, count, stop, last):
        t = record.times[count[NEXT_TIME]]
        state_at(s, t)
        keep(s, record, count, t)
        count[NEXT_TIME] += 1


def keep_event(s: Any, record: Any, count: Any) -> None:
    """Keep the state after an event, if these are kept."""
    if keeps_events(record):
        s.q[0], s.v[0] = s.x[Q0], s.x[V0]
        keep_instead(s, record, count)


def evaluate(s: Any, kept: Any, wanted: Any) -> None:
    """States at the times wanted, from the kept states before them and the flights that start there."""
    for k in range(len(wanted.t)):
        row = wanted.row[k]
        s.q[0], s.v[0] = kept.q[row, 0], kept.v[row, 0]
        s.x[MODE] = kept.mode[row]
        if wanted.t[k] > kept.t[row]:
            find_corners(s, kept.t[row])
            rebase(s, kept.t[row])
            state_at(s, wanted.t[k])
        wanted.q[k, 0], wanted.v[k, 0] = s.q[0], s.v[0]
