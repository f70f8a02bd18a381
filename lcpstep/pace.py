"""Pace: compiled loops go on in portions of about a tenth of a second, so that whoever waits can interrupt.

Machine code hears no signal. So a loop is given a number up to which it may go, returns there, and is called again:
Python then looks at the outside world (Ctrl-C, a progress bar, a sweep that has been given up). How long a step
takes is known only when some have been taken; the next portion is the one that would take `SECONDS` at the rate of
the last. No result depends on where a portion ends.

Loops also tell whoever listens in their thread how far they are, of how much (`telling`): of loops within loops the
share of all, so that it grows steadily.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

T = TypeVar("T")
Told = Callable[[float, float], None]
SECONDS = 0.1  # of a portion
GROWTH = 16  # of a portion over the one before, at most
FIRST = 8192  # steps of a single number before anything is known of their time
_thread = (
    threading.local()
)  # `given_up`: the event that ends what this thread does; `told`: who listens to it


class Pace:
    """How far a loop may go next.

    Parameters
    ----------
    most : of a portion, whatever its time: what fits into the loop's buffers
    numbers : that a step computes with; where there are many, the first portion is short
    total : number at which the loop ends, where that is known and to be told
    """

    def __init__(self, most: int, numbers: int = 1, total: int = 0) -> None:
        self.most, self.size = most, max(1, min(most, FIRST // max(1, numbers)))
        self.total = total
        self.done, self.since = 0, 0.0

    def goal(self, done: int) -> int:
        """The number up to which the next portion goes, `done` being reached; KeyboardInterrupt where given up."""
        if given_up():
            raise KeyboardInterrupt
        if self.total:
            tell(done, self.total)
        now = time.perf_counter()
        if self.since > 0.0:
            rate = max(1, done - self.done) / max(now - self.since, 1e-9)
            self.size = max(1, min(int(SECONDS * rate), GROWTH * self.size, self.most))
        self.done, self.since = done, now
        return done + self.size


def given_up() -> bool:
    """Whether nobody waits any more for what this thread does."""
    event = getattr(_thread, "given_up", None)
    return event is not None and event.is_set()


def until_given_up(event: threading.Event, work: Callable[..., T], *arguments: object) -> T:
    """Do work that ends with a KeyboardInterrupt, at the end of a portion, once the event is set."""
    _thread.given_up = event
    try:
        return work(*arguments)
    finally:
        _thread.given_up = None


@contextmanager
def telling(told: Told) -> Generator[None, None, None]:
    """Call `told(done, total)` as the loops of this thread go on."""
    before = getattr(_thread, "told", None)
    _thread.told = told
    try:
        yield
    finally:
        _thread.told = before


def tell(done: float, total: float) -> None:
    """A loop is so far, of so much; nothing where nobody listens."""
    told = getattr(_thread, "told", None)
    if told is not None:
        told(done, total)


def counted(items: Sequence[T], weights: Sequence[float] | None = None) -> Iterator[T]:
    """The items, told as they are done; loops within tell how far one is. `weights`: their shares of the whole."""
    told = getattr(_thread, "told", None)
    if told is None:
        yield from items
        return
    share = [1.0] * len(items) if weights is None else list(weights)
    total, done = sum(share), 0.0
    try:
        for item, weight in zip(items, share, strict=True):
            told(done, total)
            _thread.told = _part(told, done, weight, total)
            yield item
            done += weight
    finally:
        _thread.told = told


def _part(told: Told, begin: float, weight: float, total: float) -> Told:
    """What loops within one item tell: never less than before, as several follow one another."""
    latest = begin

    def within(done: float, of: float) -> None:
        nonlocal latest
        latest = max(latest, begin + weight * min(done / of, 1.0))
        told(latest, total)

    return within
