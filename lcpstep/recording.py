"""What a run keeps: states chosen by the caller, and every event, in buffers that a kernel fills.

Kernels write into arrays of fixed size and return when these are full; the recorder empties them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lcpstep.trajectory import records

Array = NDArray[np.float64]
Keep = int | str | ArrayLike
EVENT_CAPACITY = 4096
STATE_COLUMNS = ("t", "q", "v", "impulse", "mode", "dense", "length")
EVENT_COLUMNS = ("event_time", "event_contact", "event", "event_kind")


@dataclass(frozen=True)
class Kept:
    """Which states to keep: every k-th step, those at events, or those at given times."""

    every: int
    on_events: bool
    times: Array

    @classmethod
    def parse(cls, keep: Keep, t_span: tuple[float, float]) -> Kept:
        """From the argument `keep` of `simulate`; ValueError where it is none of the three forms."""
        nothing = np.zeros(0)
        if isinstance(keep, str):
            if keep != "impacts":
                raise ValueError(f'keep: expected a whole number, times, or "impacts", got {keep!r}')
            return cls(0, True, nothing)
        if isinstance(keep, (int, np.integer)):
            if isinstance(keep, bool) or keep < 1:
                raise ValueError(f"keep: expected to keep every 1st, 2nd, ... step, got {keep!r}")
            return cls(int(keep), False, nothing)
        times = np.array(keep, dtype=float)
        if times.ndim != 1 or len(times) == 0 or np.any(np.diff(times) <= 0.0):
            raise ValueError("keep: expected increasing times in an array of one dimension")
        if not (t_span[0] <= times[0] and times[-1] <= t_span[1]):
            raise ValueError(
                f"keep: expected times within the span {t_span}, got {times[0]:g} .. {times[-1]:g}"
            )
        return cls(0, False, times)

    @property
    def all(self) -> bool:
        """Whether every step is kept."""
        return self.every == 1


class Record(NamedTuple):
    """Where kept states and events go, as kernels see it."""

    every: int  # keep every so many steps; 0: none
    on_events: bool
    times: Any  # keep the states at these times
    t: Any
    q: Any
    v: Any
    impulse: Any
    event_time: Any
    event: Any  # (capacity, 3): before, after, impulse
    event_contact: Any
    event_kind: Any
    mode: Any  # of each kept state: whether its contact is closed
    dense: Any  # (rows, 7, 2 n_q) dense output of the step after each kept state, or no rows
    length: Any  # duration of that step


class Recorder:
    """Buffers of one run, and what they held when they were emptied."""

    def __init__(self, n_q: int, n_c: int, kept: Kept, rows: int, dense: bool = False) -> None:
        events = EVENT_CAPACITY + 2 * n_c
        self.buffers = Record(
            every=kept.every,
            on_events=kept.on_events,
            times=kept.times,
            t=np.zeros(rows),
            q=np.zeros((rows, n_q)),
            v=np.zeros((rows, n_q)),
            impulse=np.zeros((rows, n_c)),
            event_time=np.zeros(events),
            event=np.zeros((events, 3)),
            event_contact=np.zeros(events, dtype=np.int64),
            event_kind=np.zeros(events, dtype=np.int64),
            mode=np.zeros(rows, dtype=np.int64),
            dense=np.zeros((rows if dense else 0, 7, 2 * n_q)),
            length=np.zeros(rows if dense else 0),
        )
        self._states: list[dict[str, Array]] = []
        self._events: list[dict[str, Array]] = []

    def empty(self, rows: int, events: int) -> None:
        """Take over the first rows and events of the buffers."""
        if rows:
            self._states.append({name: getattr(self.buffers, name)[:rows].copy() for name in STATE_COLUMNS})
        if events:
            self._events.append({name: getattr(self.buffers, name)[:events].copy() for name in EVENT_COLUMNS})

    def states(self) -> dict[str, Array]:
        """All kept states, by the names of `STATE_COLUMNS`."""
        return self._joined(self._states, STATE_COLUMNS)

    def events(self) -> Any:
        """The impact log."""
        e = self._joined(self._events, EVENT_COLUMNS)
        before, after, impulse = e["event"].T
        return records(e["event_time"], e["event_contact"], before, after, impulse, e["event_kind"])

    def _joined(self, parts: list[dict[str, Array]], names: tuple[str, ...]) -> dict[str, Array]:
        nothing = {name: getattr(self.buffers, name)[:0] for name in names}
        return {name: np.concatenate([part[name] for part in [nothing, *parts]]) for name in names}
