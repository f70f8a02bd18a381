"""Certificates of flights in closed form, as kernels: one linear degree of freedom above a flat obstacle.

    y = rest + C exp(-delta tau) cos(w tau - phi) + S cos(Omega t - psi),   |y^(n)| <= C w0^n + S Omega^n,  w0^2 = w2

for delta >= 0, so that the state at the start of a flight bounds its acceleration. Of a body without a spring and a
damper the first term is a parabola. Other motions are left to `motion.Oscillation`.
"""

from __future__ import annotations

from typing import Any

import cython

if not cython.compiled:
    from math import hypot, sqrt

    from lcpstep.arrays import doubles, small_numbers
    from lcpstep.audit.clear import Cells, Gap, clear, open_between
    from lcpstep.events.flight.motion import Flight, absolute, leave_from
    from lcpstep.pointers import Doubles, abs, after, max

SLACK = 1e-13  # of the numbers that a bound is made of
ROUNDING = 1.1e-13  # of the positions: what a gap may be off by


class Swing(Gap):
    """The gap of a flight in closed form.

    Parameters
    ----------
    cells, motion, frame, state : see `Gap`;  s : Flight
    """

    def __init__(self, cells: Cells, motion: Any, frame: Any, state: Any, s: Flight) -> None:
        Gap.__init__(self, cells, motion, frame, [s.G], state)
        self.s = s
        self.swings = s.w2 > s.delta * s.delta and s.delta >= 0.0
        self.known = self.swings or (s.w2 == 0.0 and s.delta == 0.0)
        self.forced = hypot(s.X, s.Y)
        self.height = s.f0 / s.w2 if self.swings else 0.0

    def at(self, tau: float) -> None:
        """Ask for the motion."""
        absolute(self.s, tau)
        self.place, self.bend = self.s.offset + self.s.G * self.s.y_tau, self.s.G * self.s.a_tau

    def size(self, z: float, w: float) -> float:
        """How large an oscillation is that has this place and velocity."""
        rate = (w + self.s.delta * z) / sqrt(self.s.w2 - self.s.delta * self.s.delta)
        return sqrt(z * z + rate * rate)


def clear_flights(
    g: Swing, t: Any, q: Any, y: Any, w: Any, obstacle: Any, touched: Any, skipped: Any, cuts: Any, found: Any
) -> None:
    """Which pieces are certified, (m,), into `found`; called from Python.

    Parameters
    ----------
    t, q : (m + 1,)   states;  y, w : (m + 1,)   absolute ones;  obstacle : (m + 1, 3)   s, s' and s'' there
    touched : (m + 1,) uint8   whether an event of the run lies there;  skipped : (m,) uint8
    cuts : (k,)   times at which the obstacle may have a corner
    """
    n, n_cuts = len(found), len(cuts)
    times, places, position, speed = doubles(t), doubles(q), doubles(y), doubles(w)
    s, corner = doubles(obstacle), doubles(cuts)
    touch, left, out = small_numbers(touched), small_numbers(skipped), small_numbers(found)
    with cython.nogil:
        i = 0
        for k in range(n):
            if left[k] != 0 or not times[k + 1] > times[k]:
                continue
            while i < n_cuts and corner[i] <= times[k]:
                i += 1
            whole = i == n_cuts or corner[i] >= times[k + 1]
            first, last = touch[k] != 0, touch[k + 1] != 0
            good = at_once(
                g, g.s, times[k + 1] - times[k], after(places, k), after(position, k), speed[k], s[3 * k], s[3 * k + 3],
                first, last, whole,
            )  # fmt: skip
            if not good:
                good = closely(
                    g, g.s, times[k], times[k + 1], position[k], speed[k], first, last, corner, i, n_cuts
                )
            out[k] = 1 if good else 0


def at_once(
    g: Swing, o: Flight, h: float, q: Doubles, x: Doubles, w: float, s: float, s_b: float,
    first: bool, last: bool, whole: bool,
) -> bool:  # fmt: skip
    """Whether a piece of length h is certified by the state at its start and the place at its end alone."""
    y, y_b = x[0], x[1]
    if g.swings:
        size = g.size(abs(y - g.height) + g.forced, abs(w) + abs(o.Omega) * g.forced)
        bend, middle = o.w2 * size, 0.0
    else:
        size, bend, middle = abs(y) + abs(w) * h + 0.5 * abs(o.f0) * h * h, 0.0, o.G * o.f0
    bend = (1.0 + SLACK) * abs(o.G) * (bend + o.Omega * o.Omega * g.forced)
    low, high = middle - bend, middle + bend
    g.error = ROUNDING * (
        abs(o.G) * (size + g.forced + abs(g.height)) + abs(o.offset) + max(abs(s), abs(s_b)) + abs(o.G * q[0])
    )
    place = o.offset + o.G * (y if o.G * y < o.G * y_b else y_b)
    if place - 0.125 * max(high, 0.0) * h * h - g.cells.whole_top[0] > g.error:
        return True
    if g.cells.whole_rough or not whole:
        return False
    g_a, g_b = o.offset + o.G * q[0] - s, o.offset + o.G * q[1] - s_b
    return open_between(
        g_a, g_b, h, low - g.cells.whole_high[0], high - g.cells.whole_low[0], first, last, g.error
    )


def closely(
    g: Swing,
    s: Flight,
    t: float,
    t_b: float,
    y: float,
    w: float,
    first: bool,
    last: bool,
    cuts: Any,
    i: int,
    n_cuts: int,
) -> bool:
    """Whether a piece from t to t_b is certified by its motion, from one corner of the obstacle to the next."""
    leave_from(s, t, y, w)
    size, w4, Omega2 = 0.0, s.w2 * s.w2, s.Omega * s.Omega
    if g.swings:
        size = g.size(s.z0 - g.height, s.dz0)
    g.fourth = (1.0 + SLACK) * abs(s.G) * (size * w4 + g.forced * Omega2 * Omega2)
    a, end = 0.0, t_b - t
    while a < end:
        b = end
        if i < n_cuts and cuts[i] < t_b:
            b = cuts[i] - t
            i += 1
        if not clear(g, 0, t, a, b, first and a == 0.0, last and b == end):
            return False
        a = b
    return True
