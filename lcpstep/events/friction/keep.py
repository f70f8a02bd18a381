"""Events and states that are kept, as kernels; see `recording`."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.kernels.clock import RESOLUTION
    from lcpstep.kernels.record import LEAD, LENGTH, Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import Doubles, abs, after


def log(
    s: Rubbing,
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
    tally.add_event(abs(s.clock.t0 - s.clock.last_event) <= 4.0 * RESOLUTION * abs(s.clock.t0))
    s.clock.last_event = s.clock.t0


def keep(s: Rubbing, record: Record, t: float, y: Doubles) -> None:
    """Keep a state, and the impulses since the one before."""
    record.keep(t, 0.0, y, after(y, s.n_q), s.impulse)


def keep_event(s: Rubbing, record: Record, t: float) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if not record.keeps_events():
        return
    if record.take_back(t):
        kept = after(record.rows, record.row * record.row_size + LEAD + 2 * s.n_q)
        for i in range(s.n_r):
            s.impulse[i] = s.impulse[i] + kept[i]
    keep(s, record, t, s.y)


def store_dense(s: Rubbing, record: Record) -> None:
    """Keep the dense output of the step from the last kept state on."""
    if record.dense_size > 0:
        copy(record.dense_row(record.row - 1), s.F, record.dense_size)
        record.last_row()[LENGTH] = s.length
