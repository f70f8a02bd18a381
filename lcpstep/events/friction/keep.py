"""Events and states that are kept, as kernels; see `recording`."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.friction.state import NOISE, Rubbing
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
    for c in range(s.n_c):
        if s.owed[c] != 0.0 or s.owed[s.n_c + c] != 0.0:
            pay(s, c)
    record.keep(t, 0.0, y, after(y, s.n_q), s.impulse)


def pay(s: Rubbing, c: int) -> None:
    """Pay what the end of chattering has taken on account, once the impulses of a row lie in the cone with it."""
    i = s.n_c + c
    normal, friction = s.impulse[c] + s.owed[c], s.impulse[i] + s.owed[s.n_c + c]
    noise = NOISE * (abs(s.impulse[i]) + abs(s.owed[i]))
    if normal >= 0.0 and abs(friction) <= s.mu_s[c] * normal + noise:
        s.impulse[c], s.impulse[i] = normal, friction
        s.owed[c] = s.owed[s.n_c + c] = 0.0


def put_on_account(s: Rubbing) -> None:
    """Impulses since those in `account` belong to contacts that are closed from here on, not to this instant."""
    for i in range(2 * s.n_c):  # normals and tangents
        s.owed[i] = s.owed[i] + s.impulse[i] - s.account[i]
        s.impulse[i] = s.account[i]


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
