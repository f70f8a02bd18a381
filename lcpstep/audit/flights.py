"""Certificates of flights in closed form, as kernels: one linear degree of freedom above a flat obstacle.

    y = rest + C exp(-delta tau) cos(w tau - phi) + S cos(Omega t - psi),   |y^(n)| <= C w0^n + S Omega^n,  w0^2 = w2

for delta >= 0, so that the state at the start of a flight bounds its acceleration. Of a body without a spring and a
damper the first term is a parabola. Other motions are left to `motion.Oscillation`.
"""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.audit.limits import ERRORS, PRESSED, UNKNOWN

if not cython.compiled:
    from math import cos, hypot, sin, sqrt

    from lcpstep.arrays import doubles, small_numbers
    from lcpstep.audit.cells import Cells
    from lcpstep.audit.clear import DEEPEST, MOST, Gap, beside, between_corners, late, open_between, same_time
    from lcpstep.events.flight.motion import Flight, absolute, leave_from, steady
    from lcpstep.pointers import Doubles, abs, after, inf, max, min, nan

SLACK = 1e-13  # of the numbers that a bound is made of
PRESSING = 1e-14  # of the accelerations
BEFORE = 0.5  # of how long an event lasts: windows of closed contacts end so long before it
DEEP = 4  # halvings in a row of windows that are above the obstacle
HALF_TURN = 3.0  # rad, and less than that
ROUNDING = 1.1e-13  # of the positions: what a gap may be off by


class Swing(Gap):
    """The gap of a flight in closed form.

    amplitude   of the oscillation that is left of a flight, a bound from its start on; with `most`, how large the
        numbers are that its positions are made of, `bound` and `middle`, between which and beyond G y'' does not go
    fast        the largest velocity of what moves by itself
    left, right    how long the gap is known to part from zero at both ends;  begin_above, end_above : `place` then
    force_at, force    a time, and the force over the mass then, times G, as it was last asked for

    Parameters
    ----------
    cells, motion, frame, state, limits : see `Gap`;  s : Flight
    """

    def __init__(self, cells: Cells, motion: Any, frame: Any, state: Any, limits: Any, s: Flight) -> None:
        Gap.__init__(self, cells, motion, frame, [s.G], state, limits)
        self.s = s
        self.swings = s.w2 > s.delta * s.delta and s.delta >= 0.0
        self.known = self.swings or (s.w2 == 0.0 and s.delta == 0.0)
        self.forced = hypot(s.X, s.Y)
        self.height = s.f0 / s.w2 if self.swings else 0.0
        self.per_root = 1.0 / sqrt(s.w2 - s.delta * s.delta) if self.swings else 0.0
        self.amplitude, self.force, self.force_at = 0.0, 0.0, nan
        self.left = self.right = self.begin_above = self.end_above = 0.0
        self.middle, self.turning = 0.0 if self.swings else s.G * s.f0, s.Omega * s.Omega * self.forced
        self.most, self.bound = 0.0, (1.0 + SLACK) * abs(s.G) * self.turning
        self.fast = self.cells.whole_fast[0] + abs(s.G * s.Omega) * self.forced

    def at(self, tau: float) -> None:
        """Ask for the motion."""
        absolute(self.s, tau)
        self.place, self.bend = self.s.offset + self.s.G * self.s.y_tau, self.s.G * self.s.a_tau

    def size(self, z: float, w: float) -> float:
        """How large an oscillation is that has this place and velocity."""
        rate = (w + self.s.delta * z) * self.per_root
        return sqrt(z * z + rate * rate)

    def begin(self, t: float, y: float, w: float) -> None:
        """A flight begins at time t with this absolute state."""
        if self.swings:
            rest, rate = steady(self.s, t)
            self.amplitude = (1.0 + SLACK) * self.size(y - rest - self.height, w - rate)
            self.most = self.amplitude + self.forced + abs(self.height)
            self.bound = (1.0 + SLACK) * abs(self.s.G) * (self.s.w2 * self.amplitude + self.turning)


def clear_flights(
    g: Swing, t: Any, q: Any, y: Any, w: Any, touched: Any, kind: Any, cuts: Any, found: Any
) -> None:
    """Which pieces are certified, (m,), into `found`; called from Python.

    Parameters
    ----------
    t, q : (m + 1,)   states;  y, w : (m + 1,)   absolute ones
    touched : (m + 1,) uint8   whether an event of the run lies there
    kind : (m,) uint8   of the pieces: 0, or PRESSED for a closed contact, or UNKNOWN, which are left out
    cuts : (k,)   times at which the obstacle may have a corner
    """
    n, n_cuts = len(found), len(cuts)
    times, places, position, speed = doubles(t), doubles(q), doubles(y), doubles(w)
    corner = doubles(cuts)
    touch, left, out = small_numbers(touched), small_numbers(kind), small_numbers(found)
    with cython.nogil:
        i, begins = 0, True
        for k in range(n):
            if touch[k] != 0 or left[k] != 0:
                begins = True
            if not times[k + 1] > times[k]:
                out[k] = 1
                continue
            if left[k] == UNKNOWN:
                continue
            while i < n_cuts and corner[i] <= same_time(times[k]):
                i += 1
            whole = i == n_cuts or same_time(corner[i]) >= times[k + 1]
            g.first, g.last, g.length = touch[k] != 0, touch[k + 1] != 0, times[k + 1] - times[k]
            if left[k] == PRESSED:
                out[k] = 1 if pressed_between_corners(g, g.s, times[k], corner, i, n_cuts) else 0
                continue
            if begins:
                g.begin(times[k], position[k], speed[k])
                begins = False
            good = at_once(g, g.s, times[k], after(places, k), after(position, k), after(speed, k), whole)
            if not good:
                good = above_at_ends(
                    g, g.s, times[k], position[k], position[k + 1], speed[k], corner, i, n_cuts
                )
            if not good:
                leave(g, g.s, times[k], position[k], speed[k])
                good = between_corners(g, 0, times[k], corner, i, n_cuts)
            out[k] = 1 if good else 0


def at_once(
    g: Swing, o: Flight, t: float, q: Doubles, x: Doubles, w: Doubles, whole: bool
) -> bool:
    """Whether a piece from t on is certified by the states at its ends and the equation of motion.

    q, x : relative and absolute places;  w : velocities, after an event
    whole : whether no corner lies within
    """
    y, y_b, h, size = x[0], x[1], g.length, g.most
    if not g.swings:
        size = abs(y) + abs(w[0]) * h + 0.5 * abs(o.f0) * h * h + g.forced
    g.error = ROUNDING * (abs(o.G) * (size + abs(q[0])) + abs(o.offset))
    g.error += late(max(abs(t), abs(t + h)), g.fast)
    begin, end, low, high = o.offset + o.G * y, o.offset + o.G * y_b, g.middle - g.bound, g.middle + g.bound
    high = min(high, swung(g, o, min(begin, end)))
    lowest = min(begin, end) - 0.125 * max(high, 0.0) * h * h - g.error
    if lowest - ROUNDING * g.cells.whole_size[0] > g.cells.whole_top[0]:
        return True
    if whole and not g.cells.whole_rough and parts_at_ends(g, begin, end, o.G * w[0], low, high):
        if g.left + g.right >= h or above(g, t, high, 0):
            return True
    g.cells.find(0, t, t + h)
    met = ROUNDING * max(abs(g.cells.bottom), abs(g.cells.top))
    if lowest - met > g.cells.top:
        return True
    g.error += met
    g.own, g.small = g.error, min(g.error, g.negligible)
    g.begin_known = g.end_known = False
    g_a = 0.0 if g.first else o.offset + o.G * q[0] - g.own_motion(0, t)
    g_b = 0.0 if g.last else o.offset + o.G * q[1] - g.own_motion(0, t + h)
    g.first, g.last = g.first or abs(g_a) <= g.small, g.last or abs(g_b) <= g.small
    good = not g.cells.rough and whole
    if good and open_between(g_a, g_b, h, low - g.cells.high, high - g.cells.low, g.first, g.last, g.error):
        return True
    if not good:
        return False
    a = equation(g, o, t, y, w[0])
    if g.last and o.delta != 0.0:  # its velocity at the end is not that after the event
        margin = h * (1.0 + SLACK) * abs(o.G) * (g.amplitude * o.w2 * sqrt(o.w2) + g.turning * abs(o.Omega))
        margin = margin + SLACK * g.bound + PRESSING * abs(o.G * o.f0) if g.swings else inf
        low, high = a - margin - g.cells.high, a + margin - g.cells.low
        if open_between(g_a, g_b, h, low, high, g.first, g.last, g.error):
            return True
    b = equation(g, o, t + h, y_b, w[1])
    g.note_ends(begin, end, g_a, g_b, a, b)
    g.end_known = not g.last or o.delta == 0.0
    if not (g.swings and g.end_known):
        return False
    fourth = abs(o.G) * (g.amplitude * o.w2 * o.w2 + g.turning * o.Omega * o.Omega)
    margin = (1.0 + SLACK) * 0.125 * fourth * h * h + SLACK * g.bound
    low, high = min(a, b) - margin, max(a, b) + margin
    return open_between(g_a, g_b, h, low - g.cells.high, high - g.cells.low, g.first, g.last, g.error)


def swung(g: Swing, o: Flight, least: float) -> float:
    """Bound of the acceleration of `place` under a spring alone, which is least at one of the ends, or between them.

    x'' <= w2 (x_0 - m) + D above its smallest value m, and m >= least - h^2/8 x''; x_0 : where it rests
    """
    share = 0.125 * o.w2 * g.length * g.length
    if not (g.swings and g.forced == 0.0 and share < 0.9):
        return inf
    rest, damped = o.offset + o.G * g.height, 2.0 * o.delta * sqrt(o.w2) * abs(o.G) * g.amplitude
    m = least
    if least < rest or damped > 0.0:
        m = (least - share * max(rest, least) - share / o.w2 * damped) / (1.0 - share)
    return o.w2 * (rest - m) + damped + SLACK * (g.bound + o.w2 * (abs(rest) + abs(least)))


def parts_at_ends(g: Swing, begin: float, end: float, rate: float, low: float, high: float) -> bool:
    """Whether the gap parts from zero at its events; for how long, into g.left and g.right, and `place` then.

    It is at least u tau - D tau^2 / 2 up to tau = 2 u / D, where what moves has no corner.

    begin, end, rate : of `place` at both ends, its velocity at the start;  low, high : bounds of its acceleration
    """
    h = g.length
    fast = (1.0 + SLACK) * g.cells.whole_fast[0] + SLACK * abs(rate)
    back, g.left, g.right = g.cells.whole_high[0] - low, 0.0, 0.0
    fall = (begin - end - g.error) / h - 0.5 * high * h  # the velocity at the end, at least
    if g.first:
        if not rate > fast:
            return False
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

    It is above its chord less A x (l - x) / 2. Where that does not suffice, windows are halved.

    t : of the start;  high : bound of the place's acceleration;  most : halvings in a row
    """
    length = g.length - g.left - g.right
    slope, bent = (g.end_above - g.begin_above) / length, 0.5 * max(high, 0.0)
    least = min(g.begin_above, g.end_above) - g.error - ROUNDING * g.cells.whole_size[0]
    if least - 0.25 * bent * length * length > g.cells.whole_top[0]:
        return True
    if most == 0:
        return False
    x, n = 0.0, 1
    g.times[0] = length
    while n > 0:
        y = g.times[n - 1]
        lowest = g.begin_above - g.error - ROUNDING * g.cells.whole_size[0] + min(slope * x, slope * y)
        if x < 0.5 * length < y:
            lowest -= 0.25 * bent * length * length
        else:
            lowest -= bent * max(x * (length - x), y * (length - y))
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


def above_at_ends(
    g: Swing, o: Flight, t: float, y: float, y_b: float, w: float, cuts: Doubles, i: int, n_cuts: int
) -> bool:
    """The same of a piece from t on, without corners where the gap parts from zero; i : the first of the cuts after t."""
    low, high = g.middle - g.bound, g.middle + g.bound
    begin, end = o.offset + o.G * y, o.offset + o.G * y_b
    high = min(high, swung(g, o, min(begin, end)))
    if not parts_at_ends(g, begin, end, o.G * w, low, high):
        return False
    if g.left > 0.0 and not smooth(g, t, t + g.left, cuts, i, n_cuts):
        return False
    if g.right > 0.0 and not smooth(g, t + g.length - g.right, t + g.length, cuts, i, n_cuts):
        return False
    return g.left + g.right >= g.length or above(g, t, high, DEEP)


def smooth(g: Swing, a: float, b: float, cuts: Doubles, i: int, n_cuts: int) -> bool:
    """Whether what moves is smooth between two times; i : the first of the cuts that may lie there."""
    while i < n_cuts and cuts[i] <= same_time(a):
        i += 1
    if i < n_cuts and same_time(cuts[i]) < b:
        return False
    g.cells.find(0, a, b)
    return not g.cells.rough


def equation(g: Swing, o: Flight, t: float, y: float, w: float) -> float:
    """G y'' of a state; the force is known where the piece before has ended."""
    if t != g.force_at:
        g.force_at = t
        g.force, _ = driven(o, t)
    return o.G * (o.f0 - 2.0 * o.delta * w - o.w2 * y) + g.force


def leave(g: Swing, s: Flight, t: float, y: float, w: float) -> None:
    """The motion from this absolute state on, and how large its fourth derivative can be."""
    leave_from(s, t, y, w)
    fourth = g.amplitude * s.w2 * s.w2 + g.turning * s.Omega * s.Omega
    g.fourth, g.loose = (1.0 + SLACK) * abs(s.G) * fourth, SLACK * g.bound
    if g.swings:
        g.loose += PRESSING * abs(s.G * s.f0)


def pressed_between_corners(g: Swing, s: Flight, t0: float, cuts: Doubles, i: int, n_cuts: int) -> bool:
    """Whether a closed contact is pressed in a piece that begins at t0, between one corner and the next.

    i : the first of the cuts after t0
    """
    a = 0.0
    while a < g.length:
        b = g.length
        if i < n_cuts and same_time(cuts[i]) < t0 + b:
            b = cuts[i] - t0
            i += 1
        if not pressed(g, s, t0, a, b):
            return False
        a = b
    return True


def pressed(g: Swing, s: Flight, t0: float, a: float, b: float) -> bool:
    """Whether a closed contact is pressed from a to b: without force the gap would accelerate by rounding at most.

    alpha = G (f0 + F(t)) + w2 (offset - sigma) - 2 delta sigma' - sigma''
    """
    constant = s.G * s.f0 + s.w2 * s.offset
    forced = abs(s.G) * (abs(s.fc) + abs(s.fs))
    if g.first and a < g.moment:  # what is so near to an event is part of it
        a = min(max(a, BEFORE * g.moment), b)
    if g.last and g.length - b < g.moment:
        b = max(min(b, g.length - BEFORE * g.moment), a)
    tau, n, looked = a, 1, 0
    force, turn = driven(s, t0 + a)
    g.times[0] = b
    g.bends[0], g.gaps[0] = driven(s, t0 + b)
    while n > 0:
        looked += 1
        k = n - 1
        h = g.times[k] - tau
        g.cells.find(0, t0 + tau, t0 + g.times[k])
        alpha = constant + max(force, g.bends[k])
        if turn * g.gaps[k] < 0.0 or s.Omega * h > HALF_TURN:  # it need not be largest at an end
            alpha += 0.125 * s.Omega * s.Omega * forced * h * h
        alpha -= s.w2 * g.cells.bottom + 2.0 * s.delta * g.cells.slow + g.cells.low
        error = PRESSING * (abs(constant) + forced + abs(s.w2 * g.cells.top) + abs(g.cells.low))
        small = min(error, g.negligible)
        good = alpha <= error or (alpha < ERRORS * small and beside(g, tau, g.times[k], g.near))
        if (good and not g.cells.rough) or beside(g, tau, g.times[k], g.moment):
            tau, force, turn = g.times[k], g.bends[k], g.gaps[k]
            n = k
        elif n > DEEPEST or looked > MOST:
            return False
        else:
            g.times[n] = 0.5 * (tau + g.times[k])
            g.bends[n], g.gaps[n] = driven(s, t0 + g.times[n])
            n += 1
    return True


def driven(s: Flight, t: float) -> tuple[float, float]:
    """G F(t), and its rate over Omega."""
    if s.Omega == 0.0:
        return 0.0, 0.0
    c, q = cos(s.Omega * t), sin(s.Omega * t)
    return s.G * (s.fc * c + s.fs * q), s.G * (s.fs * c - s.fc * q)
