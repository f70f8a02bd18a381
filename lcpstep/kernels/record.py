"""Where kernels write what a run keeps: states that the caller has chosen, and every event; room is bounded."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.kernels.layout import COLUMNS, LEAD, LENGTH, MODE, TIME

if not cython.compiled:
    from lcpstep.arrays import doubles
    from lcpstep.kernels.vectors import add, copy
    from lcpstep.pointers import Doubles, after, inf, whole

Columns = tuple[Any, Any, Any, Any, Any, Any]  # times, modes, durations, q, v and impulses of rows


class Record:
    """Rows and events; how many there are, and which time is to be kept next, is counted here.

    every        keep every so many steps; 0: none
    on_events    keep the states at events
    times        keep the states at these times
    rows : (rows, LEAD + 2 n_q + n_c)   time, mode, duration, q, v, impulses since the row before
    events : (event_capacity, COLUMNS)
    dense : (rows, dense_size)          dense output of the step after each row; nothing where dense_size is 0
    row, event, next_time               rows and events written, times kept

    Parameters
    ----------
    n_q, n_c : int   coordinates, and impulses in a row
    every, on_events, times   as above
    rows, events, dense : arrays   to write to
    """

    def __init__(
        self, n_q: int, n_c: int, every: int, on_events: bool, times: Any, rows: Any, events: Any, dense: Any
    ) -> None:
        self.arrays = times, rows, events, dense
        self.n_q, self.n_c, self.n_times = n_q, n_c, len(times)
        self.row_size, self.row_capacity, self.event_capacity = rows.shape[1], len(rows), len(events)
        self.dense_size = dense[0].size if len(dense) > 0 else 0
        self.every, self.on_events = every, on_events
        self.row = self.event = self.next_time = 0
        self.times, self.rows = doubles(times), doubles(rows)
        self.events, self.dense = doubles(events), doubles(dense)

    def last_row(self) -> Doubles:
        """The row written last."""
        return after(self.rows, (self.row - 1) * self.row_size)

    def dense_row(self, row: int) -> Doubles:
        """Where the dense output of the step after a row goes."""
        return after(self.dense, row * self.dense_size)

    def keep(self, t: float, mode: float, q: Doubles, v: Doubles, impulse: Doubles) -> None:
        """One kept state; the impulses summed up to it start anew."""
        n = self.n_q
        row = after(self.rows, self.row * self.row_size)
        row[TIME], row[MODE], row[LENGTH] = t, mode, 0.0
        for i in range(n):
            row[LEAD + i], row[LEAD + n + i] = q[i], v[i]
        for c in range(self.n_c):
            row[LEAD + 2 * n + c] = impulse[c]
            impulse[c] = 0.0
        self.row += 1

    def keep_one(self, t: float, length: float, q: float, v: float, impulse: Doubles) -> None:
        """`keep` where there are one coordinate and one impulse, mode 0."""
        row = after(self.rows, self.row * self.row_size)
        row[TIME], row[MODE], row[LENGTH] = t, 0.0, length
        row[LEAD], row[LEAD + 1], row[LEAD + 2] = q, v, impulse[0]
        impulse[0] = 0.0
        self.row += 1

    def keep_awaited(self, q: Doubles, v: Doubles, impulse: Doubles) -> None:
        """Keep the state that is asked for next."""
        self.keep(self.awaited(), 0.0, q, v, impulse)
        self.next_time += 1

    def store(self, motion: Doubles, length: float) -> None:
        """Keep the motion from the last kept state on, if motions are kept, and how long it goes on so."""
        if self.dense_size > 0:
            copy(self.dense_row(self.row - 1), motion, self.dense_size)
            self.last_row()[LENGTH] = length

    def note(self, t: float, contact: int, before: float, after_: float, p: float, kind: int) -> None:
        """One line of the impact log."""
        event = after(self.events, self.event * COLUMNS)
        event[0], event[1], event[5] = t, contact, kind
        event[2], event[3], event[4] = before, after_, p
        self.event += 1

    def full(self, more: int) -> bool:
        """Whether there is no room for so many events more."""
        return self.event + more > self.event_capacity

    def wants(self, stop: float, last: bool) -> bool:
        """Whether a state is asked for before the time `stop` (or at it, at the span's end), and there is room."""
        t = self.awaited()
        return self.row < self.row_capacity and (t < stop or (t == stop and last))

    def awaited(self) -> float:
        """The time at which a state is asked for next; infinite where none is."""
        return self.times[self.next_time] if self.next_time < self.n_times else inf

    def split(
        self, t: Doubles, mode: Doubles, length: Doubles, q: Doubles, v: Doubles, impulse: Doubles
    ) -> None:
        """The rows, each quantity into an array of its own; where zeros are most of it, the others alone."""
        n, n_c = self.n_q, self.n_c
        if n == 1 and n_c == 1:
            self.split_one(t, mode, length, q, v, impulse)
            return
        for k in range(self.row):
            row = after(self.rows, k * self.row_size)
            t[k] = row[TIME]
            if row[MODE] != 0.0:
                mode[k] = row[MODE]
            if row[LENGTH] != 0.0:
                length[k] = row[LENGTH]
            for i in range(n):
                q[k * n + i], v[k * n + i] = row[LEAD + i], row[LEAD + n + i]
            for i in range(n_c):
                if row[LEAD + 2 * n + i] != 0.0:
                    impulse[k * n_c + i] = row[LEAD + 2 * n + i]

    def split_one(
        self, t: Doubles, mode: Doubles, length: Doubles, q: Doubles, v: Doubles, impulse: Doubles
    ) -> None:
        """`split` where there are one coordinate and one impulse."""
        for k in range(self.row):
            row = after(self.rows, k * (LEAD + 3))
            t[k], q[k], v[k] = row[TIME], row[LEAD], row[LEAD + 1]
            if row[MODE] != 0.0:
                mode[k] = row[MODE]
            if row[LENGTH] != 0.0:
                length[k] = row[LENGTH]
            if row[LEAD + 2] != 0.0:
                impulse[k] = row[LEAD + 2]

    def room_for(self, rows: int) -> Columns:
        """Arrays for times, modes, durations, positions, velocities and impulses of so many rows.

        What is zero in most rows is zero from the start: the system has such memory ready, untouched.
        """
        n, n_c = self.n_q, self.n_c
        t, mode, length = np.empty(rows), np.zeros(rows), np.zeros(rows)
        return t, mode, length, np.empty((rows, n)), np.empty((rows, n)), np.zeros((rows, n_c))

    def move(self, columns: Columns, k: int) -> None:
        """Move the rows to such arrays, from place k on."""
        t, mode, length, q, v, impulse = columns
        n, n_c = self.n_q, self.n_c
        self.split(
            after(doubles(t), k), after(doubles(mode), k), after(doubles(length), k), after(doubles(q), k * n),
            after(doubles(v), k * n), after(doubles(impulse), k * n_c),
        )  # fmt: skip
        self.row = 0

    def is_due(self, step: int) -> bool:
        """Whether the state after so many steps is to be kept."""
        return self.every > 0 and step % self.every == 0

    def keeps_events(self) -> bool:
        """Whether the states after events are to be kept."""
        return self.on_events or self.every == 1

    def take_back(self, t: float, impulse: Doubles) -> bool:
        """Take back the last kept state if it is of time t: events at one time share a row. Whether it was.

        Its impulses count to those of the row that takes its place.
        """
        if self.row == 0 or self.last_row()[TIME] != t:
            return False
        add(impulse, 1.0, after(self.last_row(), LEAD + 2 * self.n_q), self.n_c)
        self.row -= 1
        return True

    def quiet_until(self, step: int, h: float, t0: float, first: int, last: int) -> int:
        """The step, at most `last`, up to which none keeps a state; step `first` begins at t0."""
        end = self.untimed_until(h, t0, first, last)
        if self.every > 0 and step + self.every - 1 - step % self.every < end:
            end = step + self.every - 1 - step % self.every
        return end

    def untimed_until(self, h: float, t0: float, first: int, last: int) -> int:
        """The step, at most `last`, up to which none keeps a state at a given time."""
        if self.next_time < self.n_times:
            before = first + whole((self.times[self.next_time] - t0) / h) - 1
            return before if before < last else last
        return last
