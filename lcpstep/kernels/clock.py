"""The clock of a motion: the base time of its pieces, and the smooth interval around it.

A motion is a chain of pieces, each known at the time tau after its base time. Corners are the times at which an
acceleration, or an obstacle's velocity, may jump; between two of them lies a smooth interval.
"""

from __future__ import annotations

from math import floor
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.roundings import MARGIN, RESOLUTION
from lcpstep.pointers import abs, inf, max, min

LEAST = 2.0**-960  # numbers that have their digits in products, too


class Clock:
    """Times of a motion; a class of motions may inherit it.

    t0, t0_rest, rest    base time, what rounding has taken from it and will take from the next
    low, high            the smooth interval around it; high < low: not known yet
    t_end, scale         end of the span; a typical time
    period               of the corners
    last_event           time of it
    jump                 the corner found last that the scene does not name
    record, tally        what is kept of the motion, and counted; None of one that is only asked

    Parameters
    ----------
    t_span : (start, end);  corners : (m,) in [0, period);  period : float, infinite where nothing is periodic
    """

    def __init__(self, t_span: tuple[float, float], corners: Any, period: float) -> None:
        self.corner_array = np.array(corners, dtype=np.float64)
        self.corners, self.n_corners = doubles(self.corner_array), len(self.corner_array)
        self.t0, self.t0_rest, self.rest = t_span[0], 0.0, 0.0
        self.period, self.last_event, self.t_end = period, -inf, t_span[1]
        self.scale = period if period < inf else t_span[1] - t_span[0]
        self.low, self.high, self.jump = inf, -inf, -inf
        self.record: Any = None
        self.tally: Any = None

    def after(self, tau: float) -> float:
        """The time tau after the base; what rounding takes from it is kept for the next base.

        Without it, 10^5 equal flights would drift by 10^5 roundings of the time, all of one sign.
        """
        step = self.t0_rest + tau
        t = self.t0 + step
        moved = t - self.t0
        self.rest = (self.t0 - (t - moved)) + (step - moved)
        return t

    def start_at(self, t: float) -> None:
        """The next piece begins at time t."""
        self.t0 = t
        self.t0_rest, self.rest = self.rest, 0.0

    def log(self, t: float, c: int, before: float, later: float, p: float, kind: int) -> None:
        """Note an event of contact c; those that pass without the time going on are counted."""
        self.record.note(t, c, before, later, p, kind)
        self.tally.add_event(abs(self.t0 - self.last_event) <= 4.0 * RESOLUTION * abs(self.t0))
        self.last_event = self.t0

    def untold(self, length: float) -> float:
        """What cannot be told of a time at most `length` after the base: some roundings."""
        return 4.0 * RESOLUTION * (abs(self.t0) + length)

    def border(self) -> float:
        """Where the smooth interval around the base ends, or the span."""
        return min(self.t_end, self.high)

    def margin(self, t: float) -> float:
        """By how much a time is moved to be on its own side of a corner."""
        return MARGIN * max(abs(t), self.scale)

    def inside(self, t: float) -> float:
        """A time moved off the ends of its smooth interval, where accelerations may jump."""
        margin = self.margin(t)
        return min(max(t, self.low + margin), self.high - margin)

    def lies_apart(self, t: float) -> bool:
        """Whether a time can be told from the ends of its smooth interval: see `inside`; it may be the base.

        The end may be where a jump was found on a motion that was less exact: it is just before that, then.
        """
        margin = self.margin(t)
        return self.low + margin < t < (self.high if self.high == self.jump else self.high - margin)

    def break_at(self, t: float) -> None:
        """The smooth interval at hand ends at t, as has been found; at the base where that cannot be told from it."""
        if t <= self.t0 + self.margin(t):
            t = self.t0
        self.high = self.jump = t

    def moment(self, t: float) -> float:
        """What an impact near time t must be off a corner to be told from it."""
        return 2.0 * self.margin(t)

    def leaves_to_corner(self, t: float) -> bool:
        """Whether a time cannot be told from the corner that ends its smooth interval, which is not the last."""
        return t + self.moment(t) >= self.high and self.high < self.t_end

    def find_corners(self, t: float) -> None:
        """The smooth interval that begins at t or contains it."""
        near = t + 0.5 * self.margin(t)
        if self.low <= near < self.high:
            return
        self.find_named(near)
        if self.low < self.jump <= near:
            self.low = self.jump
        elif near < self.jump < self.high:
            self.high = self.jump

    def find_named(self, near: float) -> None:
        """The same, of the corners that the scene names."""
        self.low, self.high = -inf, inf
        n, period, start = self.n_corners, self.period, 0.0
        if n == 0:
            return
        if period < inf:
            turn = floor(near / period)
            start = turn * period
            self.low = (turn - 1.0) * period + self.corners[n - 1]
            self.high = (turn + 1.0) * period + self.corners[0]
            if near >= self.high:  # the quotient was rounded down
                self.low, start = self.high, (turn + 1.0) * period
                self.high = (turn + 2.0) * period + self.corners[0]
        for k in range(n):
            if start + self.corners[k] > near:
                self.high = start + self.corners[k]
                break
            self.low = start + self.corners[k]
