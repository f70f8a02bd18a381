"""What all loops over events share, as kernels: why they return, what they count, and what is due to be kept.

`record` is a `recording.Record`, the buffers of kept states and events; `count` is the array of counters.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address
from lcpstep.recording import TIME

# Why a loop returned
FINISHED, BUFFER_FULL, NOT_FINITE, TOO_MANY_EVENTS, STEP_TOO_SMALL, NEVER_LEFT = range(6)
# Places in the array of counters
STEP, ROW, EVENT, FORCES, NEXT_TIME, EVENTS, STALLED, MAX_EVENTS = range(8)
N_COUNTERS = 8
# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)
SLACK = 4  # rows and events that one round of a loop may need
MAX_STALLED = 100_000  # events at one time


@by_address
class Wanted(NamedTuple):
    """Times asked for, and the states found there."""

    t: Any  # (m,)
    row: Any  # (m,) the kept state at or before each
    q: Any  # (m, n_q)
    v: Any  # (m, n_q)


def too_many(count: Any) -> bool:
    """Whether there were more events than allowed, or events without end at one time."""
    return bool(count[EVENTS] > count[MAX_EVENTS] or count[STALLED] > MAX_STALLED)


def count_event(count: Any, stalled: bool) -> None:
    """One event more; those that pass without the time going on are counted."""
    count[STALLED] = count[STALLED] + 1 if stalled else 0
    count[EVENT] += 1
    count[EVENTS] += 1


def is_wanted(record: Any, count: Any, stop: float, last: bool) -> bool:
    """Whether a state is asked for before the time `stop` (or at it, at the end of the span)."""
    if count[NEXT_TIME] >= len(record.times) or count[ROW] >= len(record.rows):
        return False
    t = record.times[count[NEXT_TIME]]
    return bool(t < stop or (t == stop and last))


def is_due(record: Any, count: Any) -> bool:
    """Whether the state after this step is to be kept."""
    return bool(record.every > 0 and count[STEP] % record.every == 0)


def keeps_events(record: Any) -> bool:
    """Whether the states after events are to be kept."""
    return bool(record.on_events or record.every == 1)


def take_back(record: Any, count: Any, t: float) -> bool:
    """Take back the last kept state if it is of time t: events at one time share a row. Whether it was."""
    same = count[ROW] > 0 and record.rows[count[ROW] - 1, TIME] == t
    if same:
        count[ROW] -= 1
    return bool(same)
