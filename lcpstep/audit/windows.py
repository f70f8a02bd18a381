"""What is known of a gap over windows of time, and whether that leaves room for a zero."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Windows(NamedTuple):
    """Windows [a, b] of contacts c, in the pieces k of the motion.

    first, last    whether the gap is zero at a, or at b, by an event of the run
    closed         whether the contact is closed all the way
    """

    k: NDArray[np.intp]
    c: NDArray[np.intp]
    a: Array
    b: Array
    first: Mask
    last: Mask
    closed: Mask

    def chosen(self, which: Any) -> Windows:
        """Some of them."""
        return Windows(*[x[which] for x in self])

    def halved(self) -> Windows:
        """Twice as many, of half the length."""
        middle, no = 0.5 * (self.a + self.b), np.zeros(len(self.a), dtype=bool)
        left = self._replace(b=middle, last=no)
        right = self._replace(a=middle, first=no)
        both: list[Any] = [np.concatenate([x, y]) for x, y in zip(left, right, strict=True)]
        return Windows(*both)


def joined(parts: list[Windows]) -> Windows:
    """All windows of several sets."""
    return Windows(*[np.concatenate(x) for x in zip(*parts, strict=True)])


class Seen(NamedTuple):
    """Bounds over windows: of a gap, its speed and its acceleration, (n,) each; its values at both ends.

    error    of the gap;  slow: of its speed
    own      of the gap as it was computed: without what steps have added up (`drift`)
    smooth   whether the acceleration is one
    """

    gap: Array
    slowest: Array
    fastest: Array
    least: Array
    most: Array
    at_a: Array
    at_b: Array
    error: Array
    slow: Array
    smooth: Mask
    own: Array


def judged(w: Windows, s: Seen) -> tuple[Mask, Array]:
    """Which windows hold no zero but those at their ends, and the smallest gap that can be shown in each.

    The gap lies above its bound; above what its ends and the slowest and fastest speed allow; and, under
    accelerations of at most A, above its chord less A tau (h - tau) / 2.
    """
    h = w.b - w.a
    g_a, g_b = np.where(w.first, 0.0, s.at_a), np.where(w.last, 0.0, s.at_b)
    open_a, open_b = w.first | (g_a > s.error), w.last | (g_b > s.error)
    sides = open_a & open_b
    ends = np.minimum(g_a, g_b)
    event = w.first | w.last

    rises, falls = s.slowest > s.slow, s.fastest < -s.slow
    with np.errstate(all="ignore"):
        meet = (g_b - g_a - s.fastest * h) / (s.slowest - s.fastest)
        steep = np.where(s.slowest >= 0.0, g_a, np.where(s.fastest <= 0.0, g_b, g_a + s.slowest * meet))
    steep = np.where(np.isfinite(steep), np.minimum(steep, ends), -np.inf)
    A = np.where(s.smooth, np.maximum(s.most, 0.0), np.inf)
    with np.errstate(all="ignore"):
        slope = (g_b - g_a) / h
        lowest = 0.5 * h - slope / A
        inner = (lowest > 0.0) & (lowest < h)
        bent = np.where(inner, g_a + slope * lowest - 0.5 * A * lowest * (h - lowest), ends)
    bent = np.where(np.isfinite(A), bent, -np.inf)
    lower = np.maximum(np.maximum(s.gap, steep), bent) - s.error

    clear = (lower > 0.0) & ~event
    one_way = sides & ((rises & (open_a)) | (falls & open_b))
    leaves = w.first & ~w.last & open_b & np.isfinite(A) & (slope - 0.5 * A * h > s.slow)
    arrives = w.last & ~w.first & open_a & np.isfinite(A) & (slope + 0.5 * A * h < -s.slow)
    hop = w.first & w.last & s.smooth & (s.most <= 0.0) & (s.least < 0.0)
    return clear | one_way | leaves | arrives | hop, lower
