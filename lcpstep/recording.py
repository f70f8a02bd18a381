"""What a run keeps: states chosen by the caller, and every event, in buffers that a kernel fills.

Kernels write into arrays of fixed size and return when these are full; the recorder empties them.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.kernels.layout import COLUMNS, LEAD, LENGTH
from lcpstep.trajectory import IMPACT_DTYPE

if TYPE_CHECKING:
    from lcpstep.kernels.record import Columns

Array = NDArray[np.float64]
Keep = int | str | ArrayLike
LOGGED = np.dtype((np.record, IMPACT_DTYPE))
EVENT_CAPACITY = 4096
LONGEST = 1 << 18  # of a buffer that stays for the next run: its numbers
BUFFERS = threading.local()  # .rows, .lines, .curves: those of the last run of this thread
NOTHING: Array = np.zeros(0)
NOTHING.flags.writeable = False
EXPECTED = 1 << 22  # states that room is made for at once, at most


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
            times = np.array(checks.vector("keep", keep))
        except ValueError:
            raise ValueError(f"keep: expected increasing times, got {keep!r}") from None
        if np.ndim(keep) != 1 or len(times) == 0 or not (times[1:] > times[:-1]).all():
            raise ValueError("keep: expected increasing times in an array of one dimension")
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

    def of_steps(self, n: int) -> int:
        """How many of n steps are kept for their number."""
        return n // self.every if self.every > 0 else 0


def in_order(events: Array, end: float) -> Array:
    """Events in the order of time, within the span; those of one time in the order in which they were noted.

    The end of a chattering sequence is noted, with the time at which it comes, where the rest of the sequence is
    summed up: before events of other contacts that come earlier. What the contact itself does next ends the sequence.
    """
    if len(events) == 0:
        return events
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


def buffer(name: str, rows: int, columns: int) -> Array:
    """Room for rows of numbers, whatever they are: that of the last run of this thread where no array is left of it.

    New memory comes cleared from the system, page by page, which takes longer than a short run.
    """
    n = rows * columns
    if n > LONGEST:
        return np.empty((rows, columns))
    room = getattr(BUFFERS, name, None)
    if room is None or len(room) < 8 * n or in_use(room):
        room = bytearray(8 * n)
        setattr(BUFFERS, name, room)
    return np.asarray(memoryview(room)[: 8 * n].cast("d")).reshape(rows, columns)


def in_use(room: bytearray) -> bool:
    """Whether there are arrays in this room: Python does not let it change its length, then."""
    try:
        room.append(0)
    except BufferError:
        return True
    room.pop()
    return False


def joined(parts: Sequence[Array]) -> Array:
    """Arrays one after another; a single one as it is."""
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


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
    """Buffers of one run, and what they held when they were emptied.

    record    what kernels write into `rows`, `lines` of the log and `curves` (dense output) through
    taken     events taken out of the buffers
    expected : states of the whole run, where that is known; they are not moved again, then
    """

    def __init__(
        self,
        n_q: int,
        n_c: int,
        kept: Kept,
        rows: int,
        dense: bool = False,
        dense_shape: tuple[int, int] | None = None,
        expected: int = 0,
    ) -> None:
        from lcpstep.kernels.record import Record

        self.rows = buffer("rows", rows, LEAD + 2 * n_q + n_c)  # what is read has been written
        self.lines = buffer("lines", EVENT_CAPACITY + 4 * n_c, COLUMNS)
        shape = dense_shape or (7, 2 * n_q)
        self.curves = np.zeros((0, *shape))
        if dense:
            self.curves = buffer("curves", rows, math.prod(shape)).reshape(-1, *shape)
        self.record = Record(
            n_q, n_c, kept.every, kept.on_events, kept.times, self.rows, self.lines, self.curves
        )
        self.taken = 0
        self._states: list[Columns] = []
        self._expected = min(expected, EXPECTED)
        self._free = 0  # rows of the last of them that are not filled
        self._parts = {"events": [self.lines[:0]], "dense": [self.curves[:0]]}

    def empty(self, rows: int, events: int) -> None:
        """Take over the first rows and events of the buffers."""
        if rows > self._free:
            self._close(max(rows, self._expected))
        if rows > 0:
            if len(self.curves):
                curves = self.curves[:rows].copy()
                curves[self.rows[:rows, LENGTH] == 0.0] = 0.0  # no step has followed
                self._parts["dense"].append(curves)
            self.record.row = rows
            self.record.move(self._states[-1], len(self._states[-1][0]) - self._free)
            self._free -= rows
        if events > 0:
            self._parts["events"].append(self.lines[:events].copy())
        self.taken += events
        self.record.event = 0

    def _close(self, rows: int) -> None:
        """Leave the arrays at hand as they are, and go on with others for so many rows."""
        if self._free > 0:
            t, mode, length, q, v, impulse = self._states.pop()
            n = len(t) - self._free
            self._states.append((t[:n], mode[:n], length[:n], q[:n], v[:n], impulse[:n]))
        if rows > 0 or not self._states:
            self._states.append(self.record.room_for(rows))
        self._free = rows

    def take(self) -> None:
        """Take over what kernels have written."""
        self.empty(self.record.row, int(self.record.event))

    def states(self) -> States:
        """All states kept so far."""
        if self._free > 0 or not self._states:
            self._close(0)
        first, *more = self._states
        t, mode, length, q, v, impulse = map(joined, zip(first, *more, strict=True)) if more else first
        return States(t, q, v, impulse, mode, length)

    def dense(self) -> Array:
        """Dense output of the steps after the kept states."""
        return joined(self._parts["dense"])

    def events(self, end: float) -> Any:
        """The impact log of a span that ends at `end`, a record array of `trajectory.IMPACT_DTYPE`."""
        events = in_order(joined(self._parts["events"]), end)
        log = np.empty(len(events), dtype=LOGGED)
        for k, name in enumerate(IMPACT_DTYPE.names or () if len(events) else ()):
            log[name] = events[:, k]
        return log.view(np.recarray)
