"""Where kernels write what a run keeps: states that the caller has chosen, and every event; room is bounded.

States are written where they stay: each quantity in an array of its own, which the trajectory hands out.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.arrays import doubles
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.vectors import add, clear, copy
from lcpstep.pointers import Doubles, after, inf, whole

ROOM = 4  # rows that a step may write, besides states at given times


class Record:
    """Rows and events; how many there are, and which time is to be kept next, is counted here.

    every        keep every so many steps; 0: none
    on_events    keep the states at events
    times        keep the states at these times
    events : (event_capacity, COLUMNS)
    row, event, next_time    rows and events written, times kept

    Of each row:

    t        its time
    mode     whether the contact is closed (of `Located` without friction and joints: whether velocities may have
             jumped here; of arcs: the direction of sliding)
    length   duration of the step that follows, 0 where none has
    q, v     the state
    impulse  since the row before
    dense : (row_capacity, dense_size)   dense output of the step that follows; nothing where dense_size is 0

    Modes, durations and impulses are zero where nothing has been written: most of them are, and stay untouched.

    Parameters
    ----------
    n_q, n_c : int   coordinates, and impulses in a row
    every, on_events, times   as above
    events : array   to write to; states: see `write_to`
    """

    def __init__(self, n_q: int, n_c: int, every: int, on_events: bool, times: Any, events: Any) -> None:
        self.given, self.columns = (times, events), None
        self.n_q, self.n_c, self.n_times, self.event_capacity = n_q, n_c, len(times), len(events)
        self.every, self.on_events, self.row_size = every, on_events, 3 + 2 * n_q + n_c
        self.row = self.event = self.next_time = self.row_capacity = self.dense_size = 0
        self.times, self.events = doubles(times), doubles(events)

    def write_to(self, columns: Any) -> None:
        """Write to other arrays (t, mode, length, q, v, impulse, dense), which hold the rows so far."""
        t, mode, length, q, v, impulse, dense = columns
        self.columns, self.row_capacity = columns, len(t)
        self.dense_size = dense[0].size if len(dense) > 0 else 0
        self.t, self.mode, self.length, self.q = doubles(t), doubles(mode), doubles(length), doubles(q)
        self.v, self.impulse, self.dense = doubles(v), doubles(impulse), doubles(dense)

    def last_time(self) -> float:
        """The time of the row written last."""
        return self.t[self.row - 1] if self.row > 0 else -inf

    def keep(self, t: float, mode: float, q: Doubles, v: Doubles, impulse: Doubles) -> None:
        """One kept state; the impulses summed up to it start anew."""
        k, n, n_c = self.row, self.n_q, self.n_c
        self.t[k] = t
        if mode != 0.0:
            self.mode[k] = mode
        copy(after(self.q, k * n), q, n)
        copy(after(self.v, k * n), v, n)
        for c in range(n_c):
            if impulse[c] != 0.0:
                self.impulse[k * n_c + c] = impulse[c]
                impulse[c] = 0.0
        self.row += 1

    def keep_awaited(self, q: Doubles, v: Doubles, impulse: Doubles) -> None:
        """Keep the state that is asked for next."""
        self.keep(self.awaited(), 0.0, q, v, impulse)
        self.next_time += 1

    def store(self, motion: Doubles, length: float) -> None:
        """Keep the motion from the last kept state on, if motions are kept, and how long it goes on so."""
        if self.dense_size > 0:
            copy(after(self.dense, (self.row - 1) * self.dense_size), motion, self.dense_size)
            self.length[self.row - 1] = length

    def note(self, t: float, contact: int, before: float, after_: float, p: float, kind: int) -> None:
        """One line of the impact log."""
        event = after(self.events, self.event * COLUMNS)
        event[0], event[1], event[5] = t, contact, kind
        event[2], event[3], event[4] = before, after_, p
        self.event += 1

    def full(self, more: int) -> bool:
        """Whether there is no room for so many events more, or for the rows of a step."""
        return self.event + more > self.event_capacity or self.row + ROOM > self.row_capacity

    def wants(self, stop: float, last: bool) -> bool:
        """Whether a state is asked for before the time `stop` (or at it, at the span's end), and there is room."""
        t = self.awaited()
        return self.row < self.row_capacity and (t < stop or (t == stop and last))

    def awaited(self) -> float:
        """The time at which a state is asked for next; infinite where none is."""
        return self.times[self.next_time] if self.next_time < self.n_times else inf

    def is_due(self, step: int) -> bool:
        """Whether the state after so many steps is to be kept."""
        return self.every > 0 and step % self.every == 0

    def keeps_events(self) -> bool:
        """Whether the states after events are to be kept."""
        return self.on_events or self.every == 1

    def keeps_event(self, t: float) -> bool:
        """Whether the state after an event at time t is to be kept: also where one of that time is kept already."""
        return self.keeps_events() or self.last_time() == t

    def take_back(self, t: float, impulse: Doubles) -> bool:
        """Take back the last kept state if it is of time t: events at one time share a row. Whether it was.

        Its impulses count to those of the row that takes its place.
        """
        if self.last_time() != t:
            return False
        add(impulse, 1.0, after(self.impulse, (self.row - 1) * self.n_c), self.n_c)
        self.back_to(self.row - 1)
        return True

    def back_to(self, row: int) -> None:
        """Take back the rows from this one on."""
        n = self.row - row
        clear(after(self.mode, row), n)
        clear(after(self.length, row), n)
        clear(after(self.impulse, row * self.n_c), n * self.n_c)
        self.row = row

    def read_last(self, row: Doubles) -> None:
        """The numbers of the last row, if there is one, into an array of `row_size`."""
        k, n = self.row - 1, self.n_q
        if k >= 0:
            row[0], row[1], row[2] = self.t[k], self.mode[k], self.length[k]
            copy(after(row, 3), after(self.q, k * n), n)
            copy(after(row, 3 + n), after(self.v, k * n), n)
            copy(after(row, 3 + 2 * n), after(self.impulse, k * self.n_c), self.n_c)

    def write_last(self, row: Doubles) -> None:
        """Make the last row, if there is one, what it was when it was read."""
        k, n = self.row - 1, self.n_q
        if k >= 0:
            self.t[k], self.mode[k], self.length[k] = row[0], row[1], row[2]
            copy(after(self.q, k * n), after(row, 3), n)
            copy(after(self.v, k * n), after(row, 3 + n), n)
            copy(after(self.impulse, k * self.n_c), after(row, 3 + 2 * n), self.n_c)

    def room_until(self, step: int, last: int) -> int:
        """The step, at most `last`, up to which there is room for the states of steps, step `step` being reached."""
        if self.every > 0:
            end = step + self.every * (self.row_capacity - self.row - ROOM)
            return end if end < last else last
        return last

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
