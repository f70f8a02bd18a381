"""Pace: compiled loops go on in portions of about a fifth of a second, so that whoever waits can interrupt.

Machine code hears no signal. So a loop is given a number up to which it may go, returns there, and is called again:
Python then looks at the outside world (Ctrl-C, a progress bar, a sweep that has been given up). How long a step
takes is known only when some have been taken; the next portion is the one that would take `SECONDS` at the rate of
the last. No result depends on where a portion ends.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TypeVar

T = TypeVar("T")
SECONDS = 0.2  # of a portion
GROWTH = 16  # of a portion over the one before, at most
FIRST = 8192  # steps of a single number before anything is known of their time
_thread = threading.local()  # `given_up`: the event that ends what this thread does


class Pace:
    """How far a loop may go next.

    Parameters
    ----------
    most : of a portion, whatever its time: what fits into the loop's buffers
    numbers : that a step computes with; where there are many, the first portion is short
    """

    def __init__(self, most: int, numbers: int = 1) -> None:
        self.most, self.size = most, max(1, min(most, FIRST // max(1, numbers)))
        self.done, self.since = 0, 0.0

    def goal(self, done: int) -> int:
        """The number up to which the next portion goes, `done` being reached; KeyboardInterrupt where given up."""
        if given_up():
            raise KeyboardInterrupt
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
