"""Events and states that are kept, as kernels; see `recording`."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.parabolas.motion import state_at
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.kernels.record import Record


def keep_wanted(s: Mechanism, record: Record) -> None:
    """Keep the state that is asked for next."""
    t = record.awaited()
    state_at(s, t - s.t0)
    keep(s, record, t)
    record.next_time += 1


def keep_event(s: Mechanism, record: Record, t: float) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if record.keeps_events():
        record.take_back(t, s.impulse)
        keep(s, record, t)


def keep(s: Mechanism, record: Record, t: float) -> None:
    """Keep the state q, v at time t, and the impulses of contacts and joints since the one before."""
    for c in range(s.n_c):
        if s.contact.owed[c] < 0.0:
            pay(s, c)
    record.keep(t, 0.0, s.q, s.v, s.impulse)


def pay(s: Mechanism, c: int) -> None:
    """Pay what the end of a chattering sequence has taken on account, once contact c has been pressed by as much."""
    p = s.contact.impulse[c] + s.contact.owed[c]
    due = p >= 0.0
    s.contact.impulse[c] = p if due else 0.0
    s.contact.owed[c] = 0.0 if due else p
