"""Where what a function changes by within a step comes by a jump, by halving, for whoever can evaluate it.

    sudden.begin(h, before, later)     the function where the step begins, and h after that
    while sudden.seek(t):              t: the time at which it begins
        sudden.take(f)                 of the function at sudden.x, counted from there
    sudden.low, sudden.high            if `is_jump`, it jumps between these

Of what is no jump, but too fast for the step, that is where it begins, or a part of it. What a step leaves of a
velocity that is to be zero is no jump: steps so far have shown how much that is.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import largest
from lcpstep.pointers import Doubles, abs, max

JUMP = 1e-9  # of the velocities at hand: one that changes by less at a corner does so by rounding
MORE = 4.0  # times what steps have left of a velocity so far
PLACES = 8.0  # roundings of a place: those of the stages of a step, and of where it leads
SHARE = 0.5  # of the whole: what is left of a jump between two ends as near as can be, and not of drift
# Of a step: what changes within less than this is none, but a jump, or turns too fast to be seen
SUDDEN = 1.0 / 64.0


class Sudden:
    """Two places between which a function jumps, and the place to look at.

    h, whole        the step, and what the function changes by in it
    low, high       the places;  before, later   the function there
    middle          between what it has been and what it becomes
    x               the place to look at
    narrow          whether rounding tells nothing between the places any more
    drift           what steps so far have left of a velocity, and more
    """

    def __init__(self) -> None:
        self.drift = self.x = 0.0
        self.begin(0.0, 0.0, 0.0)

    def begin(self, h: float, before: float, later: float) -> None:
        """Seek in a step of size h, from whose begin to whose end the function changes so."""
        self.h, self.low, self.high, self.narrow = h, 0.0, h, False
        self.before, self.later = before, later
        self.middle, self.whole = 0.5 * (before + later), abs(later - before)

    def seek(self, t: float) -> bool:
        """Move x to the next place to look at; False where it is found, or none can be told from its neighbours."""
        narrow = self.high - self.low <= 2.0 * RESOLUTION * (abs(t) + self.high)
        self.narrow = narrow or self.high <= RESOLUTION * self.h  # at time zero nothing else ends it
        if self.narrow or self.is_turn():
            return False
        self.x = 0.5 * (self.low + self.high)
        return True

    def take(self, f: float) -> None:
        """The function at x."""
        if (f - self.middle) * (self.later - self.middle) > 0.0:
            self.high, self.later = self.x, f
        else:
            self.low, self.before = self.x, f

    def untold(self, t: float) -> float:
        """What rounding may make of the time of the lower place, from the begin t on."""
        return 2.0 * RESOLUTION * (abs(t) + self.low)

    def just_before(self, t: float, coarse: float) -> float:
        """The time just before the jump, however the sum with the begin t is rounded; coarse: see `coarseness`.

        Where rows jump they are still the old ones there, onto which the motion is put.
        """
        return t + self.low - max(self.untold(t), coarse)

    def is_turn(self) -> bool:
        """Whether the places still have something of the change between them that halving takes apart."""
        return abs(self.later - self.before) < SHARE * self.whole

    def is_jump(self) -> bool:
        """Whether what changes does so at once, as the step sees it, which may be as short as time is told."""
        return self.high - self.low < SUDDEN * self.h or (self.narrow and not self.is_turn())

    def excuse(self, u: float) -> None:
        """What a step has left of a velocity is no jump, but its error."""
        self.drift = max(self.drift, MORE * abs(u))


def coarseness(q: Doubles, v: Doubles, n: int) -> float:
    """Time in which a motion goes some roundings of its places: what jumps at one is not told more finely."""
    speed = largest(v, 0.0, n)
    return PLACES * RESOLUTION * largest(q, 0.0, n) / speed if speed > 0.0 else 0.0
