"""States of flights that are kept: at times asked for, after events, and between kept ones, as kernels."""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles, indices
from lcpstep.events.flight.motion import Flight, rebase, state_at
from lcpstep.pointers import max, min


def keep(s: Flight, t: float) -> None:
    """Keep the state s.q, s.v at time t, and the impulse since the one before.

    What the end of a chattering sequence has left of a negative one is to be paid by the contact force that follows.
    """
    owed = min(s.impulse[0], 0.0)
    s.impulse[0] = max(s.impulse[0], 0.0)
    s.record.keep(t, s.mode, s.q, s.v, s.impulse)
    s.impulse[0] = owed


def keep_times(s: Flight, stop: float, last: bool) -> None:
    """Keep the states asked for before the time `stop` (and at it, at the end of the span)."""
    while s.record.wants(stop, last):
        t = s.record.awaited()
        state_at(s, t)
        keep(s, t)
        s.record.next_time += 1


def keep_event(s: Flight) -> None:
    """Keep the state after an event, if these are kept."""
    if s.record.keeps_events():
        s.q[0], s.v[0] = s.q0, s.v0
        s.record.take_back(s.now, s.impulse)
        keep(s, s.now)


def keep_turned(s: Flight) -> None:
    """Keep the state s.q, s.v after a corner in the place of that before it, if this is kept: see `evaluate`."""
    if s.record.take_back(s.now, s.impulse):
        keep(s, s.now)


@cython.ccall
def evaluate(s: Flight, kept: Any, times: Any, row: Any, q: Any, v: Any) -> None:
    """States at times, from the kept states before them, each that of its row; called from Python."""
    t, at, found_q, found_v = doubles(times), indices(row), doubles(q), doubles(v)
    kept_t, kept_q, kept_v, mode = doubles(kept.t), doubles(kept.q), doubles(kept.v), doubles(kept.mode)
    n = len(times)
    with cython.nogil:
        for k in range(n):
            # What is known of the flight from a row on holds for what comes next in it, up to the next corner
            if k > 0 and at[k] == at[k - 1] and kept_t[at[k]] < t[k - 1] <= t[k] and t[k] < s.high:
                state_at(s, t[k])
            else:
                s.q[0], s.v[0], s.mode = kept_q[at[k]], kept_v[at[k]], mode[at[k]]
                if t[k] > kept_t[at[k]]:
                    s.find_corners(kept_t[at[k]])
                    rebase(s, kept_t[at[k]])
                    state_at(s, t[k])
            found_q[k], found_v[k] = s.q[0], s.v[0]
