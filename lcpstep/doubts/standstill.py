"""Whether a run has come to a standstill: steps that go on, and hardly take the time on with them.

A step may be short, and impacts as many as they like. But where so many steps, or events that are no impacts,
take the time on by next to nothing of the span, the rest of it would take days. So it may where all of them are
impacts: of elastic bodies between obstacles that close in, whose energy grows and grows. Light balls
between heavy ones meet them a million times, too, at one energy. Where a body is to rest that one contact force
cannot hold, or a force is no function of time and state, each step meets the tolerance, and none is long.
"""

from __future__ import annotations

import math
from collections.abc import Callable

STEPS = 20_000  # in a row
# Steps and events of any kind: from so many on it is looked at, each time they have doubled
IMPACTS = 1_000_000
GROWTH, TOO_MANY = 1.25, 3e8  # of the kinetic energy meanwhile; how many more there would be
PER_IMPACT = 100  # steps that the search for one may take
# Of the span, or of what so many of the longest steps do: what they take the time on by at least, or crawl
LEAST, CRAWL = 1e-6, 0.1


class Standstill:
    """Looks at a run now and then.

    crawls   whether this look has shown steps so short that it is worth asking why
    words    how short they are

    Parameters
    ----------
    span : (start, end);  h : the longest step that the method may take [s]
    """

    def __init__(self, span: tuple[float, float], h: float) -> None:
        self.way, self.end, self.h = min(span[1] - span[0], h * STEPS), span[1], h
        self.steps, self.since, self.words, self.crawls = 0, -math.inf, "", False
        self.first, self.begin, self.energy = 0, -math.inf, 0.0  # of those of any kind

    def reached(
        self, steps: int, now: float, impacts: Callable[[float], int], energy: Callable[[], float]
    ) -> bool:
        """Whether a run that has come to this time by so many steps and events stands still.

        impacts : how many there were from a time on;  energy : the kinetic energy now
        """
        if steps >= max(2 * self.first, IMPACTS) and self.ever_faster(steps, now, impacts, energy()):
            return True
        onward, taken = now - self.since, steps - self.steps
        if taken < STEPS and onward < CRAWL * self.way:
            self.crawls = False  # nothing new: what asks why is slow, and was asked
            return False
        self.crawls = onward < CRAWL * self.way and taken - PER_IMPACT * impacts(self.since) >= STEPS
        self.words = told(taken, onward)
        self.steps, self.since = steps, now
        return self.crawls and onward < LEAST * self.way

    def ever_faster(self, steps: int, now: float, impacts: Callable[[float], int], energy: float) -> bool:
        """Whether bodies go to and fro ever faster, and hardly take the time on: not where steps are short anyhow."""
        onward, taken, fed = now - self.begin, steps - self.first, energy >= GROWTH * self.energy
        many = taken * (self.end - now) > TOO_MANY * onward and onward < CRAWL * taken * self.h
        self.crawls = fed and many and PER_IMPACT * impacts(self.begin) >= taken
        self.first, self.begin, self.energy = steps, now, energy
        self.words = f"{told(taken, onward)}, as where bodies go to and fro between obstacles that close in,"
        return self.crawls


def told(taken: int, onward: float) -> str:
    """How little so many steps have done, in words."""
    return f"{taken} steps or events have taken the time on by {onward:.3g} s only"
