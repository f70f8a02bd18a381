"""What a run keeps: states chosen by the caller, and every event, in arrays that a kernel fills.

These are of fixed size, and kernels return when they are full: the recorder then makes room for as many states again,
and empties the log.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.kernels.layout import COLUMNS
from lcpstep.trajectory import IMPACT_DTYPE, Kind

Array = NDArray[np.float64]
Keep = int | str | ArrayLike
LOGGED = np.dtype((np.record, IMPACT_DTYPE))
KIND = list(LOGGED.names or ()).index("kind")  # its place in a line
EVENT_CAPACITY = 4096
LONGEST = 1 << 18  # of a buffer that stays for the next run: its numbers
BUFFERS = threading.local()  # .lines: those of the last run of this thread
NO_EVENTS = np.empty(0, dtype=LOGGED).view(np.recarray)
NOTHING: Array = np.zeros(0)
NOTHING.flags.writeable = False
EXPECTED = 1 << 26  # numbers of states that room is made for at once, at most, where theirs is known
UNKNOWN = 1 << 20  # the same where it is not
FIRST = 512  # states that room is made for where their number is not known
SPARE = 16  # rows that there is room for, at least, when kernels go on, besides states at given times


@dataclass(frozen=True)
class Kept:
    """Which states to keep: every k-th step, those at events, or those at given times."""

    every: int
    on_events: bool
    times: Array

    @classmethod
    def parse(cls, keep: Keep, t_span: tuple[float, float]) -> Kept:
        """From the argument `keep` of `simulate`; ValueError where it is none of the three forms."""
        if isinstance(keep, str):
            if keep != "impacts":
                raise ValueError(f'keep: expected a whole number, times, or "impacts", got {keep!r}')
            return cls(0, True, NOTHING)
        if isinstance(keep, (int, np.integer)):
            if isinstance(keep, bool) or keep < 1:
                raise ValueError(f"keep: expected to keep every 1st, 2nd, ... step, got {keep!r}")
            return cls(checks.count("keep", int(keep)), False, NOTHING)
        try:
            times = checks.vector("keep", keep)
        except ValueError:
            raise ValueError(f"keep: expected increasing times, got {keep!r}") from None
        n_dim = getattr(keep, "ndim", 1 if hasattr(keep, "__len__") else 0)
        if n_dim != 1 or len(times) == 0 or not (times[1:] > times[:-1]).all():
            got = checks.shown(np.asarray(keep))
            raise ValueError(f"keep: expected increasing times, one at least, in one dimension, got {got}")
        if not (t_span[0] <= times[0] and times[-1] <= t_span[1]):
            raise ValueError(f"keep: expected times within the span {t_span}, got {times[0]} .. {times[-1]}")
        return cls(0, False, times)

    @property
    def all(self) -> bool:
        """Whether every step is kept."""
        return self.every == 1

    @property
    def given(self) -> bool:
        """Whether nothing but states at given times is kept."""
        return self.every == 0 and not self.on_events

    def of_steps(self, n: int) -> int | None:
        """How many of n steps are kept for their number, and the start; None where states are kept otherwise."""
        return 1 + n // self.every if self.every > 0 else None


def in_order(events: Array, end: float) -> Array:
    """Events in the order of time, within the span; those of one time in the order in which they were noted.

    The end of a chattering sequence is noted, with the time at which it comes, where the rest of the sequence is
    summed up: before events of other contacts that come earlier. What the contact itself does next ends the sequence.
    """
    ordered = events.copy()
    time = ordered[:, 0]
    np.minimum(time, end, out=time)
    if (time[1:] >= time[:-1]).all():
        return ordered
    time = time.copy()
    contact = events[:, 1]
    for c in np.unique(contact):
        own = contact == c
        ordered[own, 0] = np.minimum.accumulate(time[own][::-1])[::-1]
    return ordered[np.argsort(ordered[:, 0], kind="stable")]


def buffer(rows: int, columns: int) -> Array:
    """Room for rows of numbers, whatever they are: that of the last run of this thread where no array is left of it.

    New memory comes cleared from the system, page by page, which takes longer than a short run.
    """
    n = rows * columns
    if n > LONGEST:
        return np.empty((rows, columns))
    room = getattr(BUFFERS, "lines", None)
    if room is None or len(room) < 8 * n or in_use(room):
        room = bytearray(8 * n)
        BUFFERS.lines = room
    return np.asarray(memoryview(room)[: 8 * n].cast("d")).reshape(rows, columns)


def in_use(room: bytearray) -> bool:
    """Whether there are arrays in this room: Python does not let it change its length, then."""
    try:
        room.append(0)
    except BufferError:
        return True
    room.pop()
    return False


class States(NamedTuple):
    """Kept states: times t (n,), q and v (n, n_q), impulses (n, n_c), modes and durations (n,)."""

    t: Array
    q: Array
    v: Array
    impulse: Array
    mode: Array
    length: Array

    def and_then(self, t: float, q: Array, v: Array, impulse: Array, mode: float = 0.0) -> States:
        """These, and one more."""
        more = np.array([t]), q[None], v[None], impulse[None], np.array([mode]), np.zeros(1)
        return States(*(np.concatenate(pair) for pair in zip(self, more, strict=True)))


class Recorder:
    """What kernels write to: states where they stay, and a buffer for the log.

    record    what kernels write through
    lines     of the log, the last ones
    taken     events taken out of that buffer

    Parameters
    ----------
    n_q, n_c : coordinates, and impulses in a row;  kept : Kept
    dense_shape : of the dense output after each state; None: no such
    expected : states kept in all, where that is known; they are not moved, then
    """

    def __init__(
        self,
        n_q: int,
        n_c: int,
        kept: Kept,
        dense_shape: tuple[int, ...] | None = None,
        expected: int | None = None,
    ) -> None:
        from lcpstep.kernels.record import Record

        self.lines = buffer(EVENT_CAPACITY + 4 * n_c, COLUMNS)  # what is read has been written
        self.record = Record(n_q, n_c, kept.every, kept.on_events, kept.times, self.lines)
        self.taken = 0
        self._dense_shape = dense_shape
        self._events: list[Array] = []
        most = (UNKNOWN if expected is None else EXPECTED) // (2 * n_q + n_c + 1)
        if expected is None:
            expected = 0 if kept.given else FIRST
        self._columns = self._rows(len(kept.times) + min(expected, most) + 2 * SPARE)
        self.record.write_to(self._columns)

    def _rows(self, n: int) -> tuple[Array, ...]:
        """Arrays for so many rows; of what is zero in most of them the system has memory ready, untouched."""
        n_q, n_c, shape = self.record.n_q, self.record.n_c, self._dense_shape
        dense = np.empty(0 if shape is None else (n, *shape))
        return (
            np.empty(n), np.zeros(n), np.zeros(n), np.empty((n, n_q)), np.empty((n, n_q)), np.zeros((n, n_c)), dense
        )  # fmt: skip

    def take(self) -> None:
        """Take over the events that kernels have written, and see to it that they can go on."""
        record = self.record
        if record.event > 0:
            self._events.append(self.lines[: record.event].copy())
            self.taken += record.event
            record.event = 0
        if record.row_capacity - record.row < record.n_times - record.next_time + SPARE:
            more = self._rows(2 * record.row_capacity)
            for old, new in zip(self._columns, more, strict=True):
                new[: record.row] = old[: record.row]
            self._columns = more
            record.write_to(more)

    def keep(self, t: float, q: Array, v: Array, impulse: Array) -> None:
        """Keep a state from Python."""
        k = self.record.row
        numbers: tuple[Any, ...] = t, 0.0, 0.0, q, v, impulse
        for column, x in zip(self._columns, numbers, strict=False):
            column[k] = x
        self.record.row = k + 1
        self.take()

    def _written(self, columns: Iterable[Array]) -> list[Array]:
        """What has been written of arrays; of those that are mostly empty copies."""
        n = self.record.row
        written = [x[:n] for x in columns]
        return written if 2 * n + 4 * SPARE > self.record.row_capacity else [x.copy() for x in written]

    def states(self) -> States:
        """All states kept so far."""
        t, mode, length, q, v, impulse = self._written(self._columns[:-1])
        return States(t, q, v, impulse, mode, length)

    def dense(self) -> Array:
        """Dense output of the steps after the kept states, zero where none has followed."""
        (dense,), length = self._written(self._columns[-1:]), self._columns[2]
        dense[length[: len(dense)] == 0.0] = 0.0
        return dense

    def count_impacts(self, since: float) -> int:
        """How many were taken with a time from `since` on."""
        found = 0
        for lines in reversed(self._events):
            late = lines[lines[:, 0] >= since]
            found += int(np.count_nonzero(late[:, KIND] == Kind.IMPACT))
            if len(late) < len(lines):
                break
        return found

    def log(self, end: float) -> Any:
        """The impact log of a span that ends at `end`, a record array of `trajectory.IMPACT_DTYPE`."""
        if self.taken == 0:
            return NO_EVENTS
        events = in_order(np.concatenate(self._events), end)
        log = np.empty(len(events), dtype=LOGGED)
        for k, name in enumerate(IMPACT_DTYPE.names or ()):
            log[name] = events[:, k]
        return log.view(np.recarray)
