"""Events and states that are kept, as kernels; see `recording`."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.general.held import project
    from lcpstep.events.general.motion import state_at
    from lcpstep.events.general.state import Mechanism
    from lcpstep.kernels.clock import RESOLUTION
    from lcpstep.kernels.record import LEAD, LENGTH, Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import abs, after


def log(
    s: Mechanism,
    record: Record,
    tally: Tally,
    t: float,
    c: int,
    kind: int,
    before: float,
    after_: float,
    p: float,
) -> None:
    """Note an event; those that pass without the time going on are counted."""
    record.note(t, c, before, after_, p, kind)
    tally.add_event(abs(s.t0 - s.last_event) <= 4.0 * RESOLUTION * abs(s.t0))
    s.last_event = s.t0


def keep_wanted(s: Mechanism, record: Record) -> None:
    """Keep the state that is asked for next: on the rows held, which dense output leaves by its own error."""
    t = record.times[record.next_time]
    state_at(s, t - s.t0)
    if s.n_held > 0 and not s.constant and t > s.t0:
        project(s, t)
    keep(s, record, t)
    record.next_time += 1


def keep_event(s: Mechanism, record: Record, t: float) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if not record.keeps_events():
        return
    if record.take_back(t):
        kept = after(record.rows, record.row * record.row_size + LEAD + 2 * s.n_q)
        for i in range(s.n_r):
            s.impulse[i] += kept[i]
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


def store_dense(s: Mechanism, record: Record) -> None:
    """Keep the motion from the last kept state on: the dense output of the step, or the acceleration."""
    if record.dense_size > 0:
        moved = s.a if s.constant else s.smooth.F
        copy(record.dense_row(record.row - 1), moved, record.dense_size)
        record.last_row()[LENGTH] = s.length
