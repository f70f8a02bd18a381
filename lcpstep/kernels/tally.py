"""What a loop counts: steps and events; and whether there are too many of these."""

from __future__ import annotations

import cython

MAX_STALLED = 100_000  # events at one time


@cython.final
class Tally:
    """Counters of a run.

    steps, events    so far
    parts            of steps, each up to an event within the step
    stalled          events since the time last went on
    max_events       events allowed
    """

    def __init__(self, max_events: int) -> None:
        self.steps = self.parts = self.events = self.stalled = 0
        self.max_events = max_events

    def add_event(self, stalled: bool) -> None:
        """One event more; those that pass without the time going on are counted."""
        self.stalled = self.stalled + 1 if stalled else 0
        self.events += 1

    def clear(self) -> None:
        """Nothing has happened yet."""
        self.steps = self.parts = self.events = self.stalled = 0

    def too_many(self) -> bool:
        """Whether there were more events than allowed, or events without end at one time."""
        return self.events > self.max_events or self.stalled > MAX_STALLED
