"""Times on a machine that does other things too: contestants take turns, and medians count.

The contestants use one thread each; what is measured is the time that the processor gave to it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from typing import Any


@dataclass(frozen=True)
class Timing:
    """Times of the same work, done several times [s]."""

    seconds: tuple[float, ...]

    @property
    def median(self) -> float:
        """The middle one [s]."""
        return median(self.seconds)

    @property
    def spread(self) -> tuple[float, float]:
        """Shortest and longest [s]."""
        return min(self.seconds), max(self.seconds)

    def per(self, count: float) -> dict[str, float]:
        """Median, shortest and longest time of one of `count` equal parts [s]."""
        low, high = self.spread
        return {"median": self.median / count, "low": low / count, "high": high / count}


def clocked(work: Callable[[], Any]) -> Callable[[], float]:
    """A function that does the work and returns the processor seconds it took."""

    def run() -> float:
        begin = time.process_time()
        work()
        return time.process_time() - begin

    return run


def take_turns(contestants: dict[str, Callable[[], float]], rounds: int) -> dict[str, Timing]:
    """Each contestant once a round, after one round that does not count."""
    for run in contestants.values():
        run()
    seconds: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(rounds):
        for name, run in contestants.items():
            seconds[name].append(run())
    return {name: Timing(tuple(times)) for name, times in seconds.items()}


def ratio(above: Timing, below: Timing) -> float:
    """Median over the rounds of the ratio within a round, so that a slow minute slows both."""
    return median(a / b for a, b in zip(above.seconds, below.seconds, strict=True))
