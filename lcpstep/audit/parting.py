"""Certificates of flights by how fast they part from their events and how high they are then, as kernels.

They ask for no motion between the ends of a piece: most flights above what moves need no other.
"""

from __future__ import annotations

import cython

from lcpstep.audit.clear import rise
from lcpstep.audit.limits import ROUNDED, SLACK
from lcpstep.audit.swing import Swing
from lcpstep.events.flight.motion import Flight
from lcpstep.pointers import abs, inf, max, min

DEEP = 4  # halvings in a row of windows that are above the obstacle


def swung(g: Swing, o: Flight, least: float) -> float:
    """Bound of the acceleration of `place` under a spring alone, which is least at one of the ends, or between them.

    x'' <= w2 (x_0 - m) + D above its smallest value m, and m >= least - h^2/8 x''; x_0 : where it rests
    """
    if not g.swings or g.forced > 0.0:
        return inf
    share = 0.125 * o.w2 * g.length * g.length
    if not share < 0.9:
        return inf
    rest, damped = o.offset + o.G * g.height, g.damped
    m = least
    if least < rest or damped > 0.0:
        m = (least - share * max(rest, least) - 0.125 * g.length * g.length * damped) / (1.0 - share)
    return o.w2 * (rest - m) + damped + SLACK * (g.bound + o.w2 * (abs(rest) + abs(least)))


def rises(g: Swing, low: float, kick: float) -> bool:
    """Whether a gap stays open by how fast it opens where a piece begins, under accelerations of at least `low`."""
    opened = rise(g, 0, g.length, low, kick)
    if g.first:
        return opened > 0.0  # so is the rate
    return g.begin_gap + min(opened, 0.0) > g.error + g.met


def parts_at_ends(g: Swing, begin: float, end: float, rate: float, low: float, high: float) -> bool:
    """Whether the gap parts from zero at its events; for how long, into g.left and g.right, and `place` then.

    It is at least u tau - D tau^2 / 2 up to tau = 2 u / D, where what moves has no corner.

    begin, end, rate : of `place` at both ends, its velocity at the start;  low, high : bounds of its acceleration
    """
    h = g.length
    fast = (1.0 + SLACK) * g.cells.whole_fast[0] + SLACK * abs(rate)
    if g.first and not rate > fast:
        return False
    back, g.left, g.right = g.cells.whole_high[0] - low, 0.0, 0.0
    fall = (begin - end - g.error) / h - 0.5 * high * h  # the velocity at the end, at least
    if g.first:
        g.left = min(2.0 * (rate - fast) / back if back > 0.0 else h, h)
        begin += g.left * (rate + 0.5 * low * g.left)
    if g.last:
        if not fall > fast:
            return False
        g.right = min(2.0 * (fall - fast) / back if back > 0.0 else h, h)
        end += g.right * (fall + 0.5 * low * g.right)
    g.begin_above, g.end_above = begin, end
    return True


def above(g: Swing, t: float, high: float, most: int) -> bool:
    """Whether `place` is above all that the obstacle reaches meanwhile, from g.left to g.right before the end.

    It is above its chord less A x (l - x) / 2, which is more than the chord if A is negative. Where that does not
    suffice, windows are halved.

    t : of the start;  high : bound of the place's acceleration;  most : halvings in a row
    """
    length = g.length - g.left - g.right
    if length <= 0.0:
        return True
    slope, bent = (g.end_above - g.begin_above) / length, 0.5 * high
    least = min(g.begin_above, g.end_above) - g.error - ROUNDED * g.cells.whole_size[0]
    if least - 0.25 * max(bent, 0.0) * length * length > g.cells.whole_top[0]:
        return True
    if most == 0:
        return False
    x, n = 0.0, 1
    g.times[0] = length
    while n > 0:
        y = g.times[n - 1]
        lowest = g.begin_above - g.error - ROUNDED * g.cells.whole_size[0] + min(slope * x, slope * y)
        at_x, at_y = x * (length - x), y * (length - y)
        if bent < 0.0:
            lowest -= bent * min(at_x, at_y)
        elif x < 0.5 * length < y:
            lowest -= 0.25 * bent * length * length
        else:
            lowest -= bent * max(at_x, at_y)
        g.cells.find(0, t + g.left + x, t + g.left + y)
        if lowest > g.cells.top:
            x = y
            n -= 1
        elif n > most:
            return False
        else:
            g.times[n] = 0.5 * (x + y)
            n += 1
    return True


def above_at_ends(g: Swing, o: Flight, t: float, y: float, y_b: float, w: float) -> bool:
    """The same of a piece from t on, without corners where the gap parts from zero.

    y, y_b, w : absolute places at both ends, and the velocity at the start
    """
    low, high = g.middle - g.bound, g.middle + g.bound
    begin, end = o.offset + o.G * y, o.offset + o.G * y_b
    high = min(high, swung(g, o, min(begin, end)))
    if not parts_at_ends(g, begin, end, o.G * w, low, high):
        return False
    if g.left > 0.0 and not smooth(g, t, t + g.left):
        return False
    if g.right > 0.0 and not smooth(g, t + g.length - g.right, t + g.length):
        return False
    return above(g, t, high, DEEP)


def smooth(g: Swing, a: float, b: float) -> bool:
    """Whether what moves is smooth between two times."""
    g.cells.find(0, a, b)
    return g.cells.kick == 0.0
