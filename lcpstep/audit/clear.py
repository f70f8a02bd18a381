"""Whether a gap stays open over a window of time, as kernels: the certificate that most flights need.

    gap = place(t) - sigma(t),   place = offset + G y

Values at the two ends and bounds of the acceleration in between give a bound of the gap: under gap'' <= A it lies
above its chord less A tau (h - tau) / 2. That of `place` is known at both ends, and is between them as far from its
chord as its own second derivative allows (`fourth`); that of sigma is bounded in cells (`cells`). Windows in
which that does not suffice are halved, a few times; what is left is for `windows.judged`.

Bounds are wider than they were computed by SLACK of the numbers that they are made of: a few hundred roundings.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.audit.cells import Cells
from lcpstep.audit.limits import ERRORS, SLACK, TIMES
from lcpstep.kernels.function import Function
from lcpstep.pointers import Doubles, abs, inf, max, min, nan

DEEPEST, MOST = 28, 256  # halvings of a window in a row, and windows that one may become


class Gap:
    """The gap of one contact during one piece of the motion, at the time tau after its start.

    place, bend     of the computed motion at the time last asked for: offset + G y, and G y''
    fourth, loose   bound of |G y''''| in the piece, and what rounding makes of G y''
    length, first, last     of the piece, and whether it begins and ends with an event of the run
    error, own, small    of the gap: all of it; without what steps have added up; below the third it is nothing
    rate        how fast it opens where the piece begins, or no number
    begin_known, end_known    whether place, gap and bend are known where the piece begins and ends: begin_place, ...
    since, until    from the last event of the contact to the start of the piece, from its end to the next; infinite
        where events of other pieces do not matter

    Parameters
    ----------
    cells : Cells
    motion, frame : Function   s, s', s'' of every contact, and c, c', c'' (absent unless y is absolute)
    G : (n_c,)   of the frame
    state : (q, v)   that they are handed
    limits : (moment, near, negligible)
        how long an event lasts, and how long where the gap is as good as zero; an error that is larger does not count
    """

    def __init__(
        self, cells: Cells, motion: Function, frame: Function, G: Any, state: Any, limits: Any
    ) -> None:
        self.cells, self.motion, self.frame = cells, motion, frame
        self.kept = np.array(state[0]), np.array(state[1]), np.zeros(3 * (cells.n_c + 1)), np.array(G)
        self.q, self.v = doubles(self.kept[0]), doubles(self.kept[1])
        self.moving, self.G = doubles(self.kept[2]), doubles(self.kept[3])
        self.stack = np.zeros((4, DEEPEST + 2))
        self.times, self.places = doubles(self.stack[0]), doubles(self.stack[1])
        self.gaps, self.bends = doubles(self.stack[2]), doubles(self.stack[3])
        self.place = self.bend = self.fourth = self.loose = self.error = self.own = self.small = (
            self.length
        ) = 0.0
        self.since, self.until, self.rate = inf, inf, nan
        self.begin_place = self.end_place = self.begin_gap = self.end_gap = 0.0
        self.begin_bend = self.end_bend = 0.0
        self.first = self.last = self.begin_known = self.end_known = False
        self.moment, self.near, self.negligible = limits

    def at(self, tau: float) -> None:
        """Ask for the motion: self.place, self.bend."""

    def note_ends(
        self, begin: float, end: float, begin_gap: float, end_gap: float, begin_bend: float, end_bend: float
    ) -> None:
        """Take note of `place`, the gap and `bend` at both ends of the piece, where these are known."""
        self.begin_place, self.end_place = begin, end
        self.begin_gap, self.end_gap = begin_gap, end_gap
        self.begin_bend, self.end_bend = begin_bend, end_bend
        self.begin_known = self.end_known = True

    def own_motion(self, c: int, t: float) -> float:
        """How far what contact c meets has moved at a time, apart from the frame."""
        if not self.motion.given:
            return 0.0
        self.motion.fill(t, self.q, self.v, self.moving)
        return self.moving[3 * c]

    def sigma(self, c: int, t: float) -> float:
        """What contact c meets at a time."""
        total = self.own_motion(c, t)
        if self.frame.given:
            self.frame.fill(t, self.q, self.v, self.moving)
            total += self.G[c] * self.moving[0]
        return total


def late(t: float, speed: float) -> float:
    """What the rounding of its time makes of something that moves with this speed at most."""
    return TIMES * abs(t) * speed if speed < inf else 0.0


def same_time(t: float) -> float:
    """The latest time that rounding does not tell from this one."""
    return t + TIMES * abs(t)


def open_between(
    g_a: float, g_b: float, h: float, low: float, high: float, kick: float, first: bool, last: bool,
    error: float,
) -> bool:  # fmt: skip
    """Whether a gap stays open in a window of length h, with these values at its ends and bounds of its acceleration.

    kick : how much its speed may jump in all, which bends it by kick tau (h - tau) / h at most
    first, last : whether it is zero there by an event of the run, so that only the open window counts
    """
    if not (high - high == 0.0 and low - low == 0.0 and kick < inf):
        return False
    if first and last:
        return high <= 0.0 and low < 0.0 and kick == 0.0
    bent = (0.5 * max(high, 0.0) * h + kick) * h
    if first:
        return g_b - bent > error
    if last:
        return g_a - bent > error
    least = min(g_a, g_b)
    if not least > error or least - 0.25 * bent > error:
        return least > error
    x = 0.5 - 0.5 * (g_b - g_a) / bent
    return not 0.0 < x < 1.0 or g_a + (g_b - g_a) * x - bent * x * (1.0 - x) > error


def shallow(g: Gap, g_a: float, g_b: float, h: float, high: float, kick: float) -> bool:
    """Whether a gap beside an event is as good as zero where it falls below: by its chord, as in `open_between`."""
    if not (high - high == 0.0 and kick < inf):
        return False
    bent, lowest = (0.5 * max(high, 0.0) * h + kick) * h, min(g_a, g_b)
    if bent > abs(g_b - g_a):
        x = 0.5 - 0.5 * (g_b - g_a) / bent
        lowest = g_a + (g_b - g_a) * x - bent * x * (1.0 - x)
    return lowest - g.own > -ERRORS * g.small


def rise(g: Gap, c: int, h: float, low: float, kick: float) -> float:
    """How much a gap opens within h after the start of a piece, at least; no number where its rate there is unknown.

    Under accelerations of at least `low` it is at least (u - kick) tau + low tau^2 / 2, which is least at an end.
    """
    least = g.rate - kick - SLACK * (abs(g.rate) + g.cells.whole_fast[c])
    return (least + 0.5 * min(low, 0.0) * h) * h


def beside(g: Gap, a: float, b: float, time: float) -> bool:
    """Whether a window is as near as that to an event at an end of the piece."""
    return (g.first and b < time) or (g.last and g.length - a < time)


def near(g: Gap, a: float, b: float) -> bool:
    """Whether a window is beside an event, also one of other pieces."""
    return beside(g, a, b, g.near) or b + g.since < g.near or g.length - a + g.until < g.near


def clear(g: Gap, c: int, t0: float, a: float, b: float) -> bool:
    """Whether the gap of contact c stays open between a and b after t0, which no corner of the obstacle parts."""
    first, last, tau = g.first and a == 0.0, g.last and b == g.length, a
    if g.begin_known and a == 0.0:
        place, bend, gap = g.begin_place, g.begin_bend, g.begin_gap
    else:
        g.at(a)
        place, bend, gap = g.place, g.bend, nan  # what moves is asked where it matters
    g.times[0] = b
    if g.end_known and b == g.length:
        g.places[0], g.bends[0], g.gaps[0] = g.end_place, g.end_bend, g.end_gap
    else:
        g.at(b)
        g.places[0], g.bends[0], g.gaps[0] = g.place, g.bend, nan
    gap, g.gaps[0] = 0.0 if first else gap, 0.0 if last else g.gaps[0]
    n, looked = 1, 0
    while n > 0:
        looked += 1
        k = n - 1
        h = g.times[k] - tau
        margin = 0.125 * g.fourth * h * h + g.loose + SLACK * (abs(bend) + abs(g.bends[k]))
        high, low = max(bend, g.bends[k]) + margin, min(bend, g.bends[k]) - margin
        g.cells.find(c, t0 + tau, t0 + g.times[k])
        good = min(place, g.places[k]) - 0.125 * max(high, 0.0) * h * h - g.cells.top > g.error
        if not good:
            kick = g.cells.kick if g.cells.rough else 0.0
            low -= g.cells.high
            high -= g.cells.low
            if gap != gap:
                gap = place - g.sigma(c, t0 + tau)
            if g.gaps[k] != g.gaps[k]:
                g.gaps[k] = g.places[k] - g.sigma(c, t0 + g.times[k])
            begins, ends = first and tau == a, last and k == 0
            good = open_between(gap, g.gaps[k], h, low, high, kick, begins, ends, g.error)
            if not good and near(g, tau, g.times[k]):
                good = shallow(g, gap, g.gaps[k], h, high, kick) or open_between(
                    gap, g.gaps[k], h, low, high, kick, begins, ends, g.own
                )
                if not good and begins:
                    good = rise(g, c, h, low, g.cells.kick) - g.own > -ERRORS * g.small
        if good or beside(g, tau, g.times[k], g.moment):
            tau, place, gap, bend = g.times[k], g.places[k], g.gaps[k], g.bends[k]
            n = k
        elif n > DEEPEST or looked > MOST:
            return False
        else:
            g.times[n] = 0.5 * (tau + g.times[k])
            g.at(g.times[n])
            g.places[n], g.bends[n], g.gaps[n] = g.place, g.bend, nan
            n += 1
    return True


def between_corners(g: Gap, c: int, t0: float, cuts: Doubles, i: int, n_cuts: int) -> bool:
    """Whether the gap of contact c stays open in a piece that begins at t0, between one corner and the next.

    i : the first of the cuts after t0
    """
    a = 0.0
    while a < g.length:
        b = g.length
        if i < n_cuts and same_time(cuts[i]) < t0 + b:
            b = cuts[i] - t0
            i += 1
        if not clear(g, c, t0, a, b):
            return False
        a = b
    return True
