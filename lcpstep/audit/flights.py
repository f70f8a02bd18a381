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
    from lcpstep.audit.clear import DEEPEST, MOST, Cells, Gap, beside, between_corners, late, open_between
    from lcpstep.events.flight.motion import Flight, absolute, leave_from
    from lcpstep.pointers import Doubles, abs, after, max, min

SLACK = 1e-13  # of the numbers that a bound is made of
PRESSING = 1e-14  # of the accelerations
ROUNDING = 1.1e-13  # of the positions: what a gap may be off by


class Swing(Gap):
    """The gap of a flight in closed form.

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

    def at(self, tau: float) -> None:
        """Ask for the motion."""
        absolute(self.s, tau)
        self.place, self.bend = self.s.offset + self.s.G * self.s.y_tau, self.s.G * self.s.a_tau

    def size(self, z: float, w: float) -> float:
        """How large an oscillation is that has this place and velocity."""
        rate = (w + self.s.delta * z) / sqrt(self.s.w2 - self.s.delta * self.s.delta)
        return sqrt(z * z + rate * rate)


def clear_flights(
    g: Swing, t: Any, q: Any, y: Any, w: Any, obstacle: Any, touched: Any, kind: Any, cuts: Any, found: Any
) -> None:
    """Which pieces are certified, (m,), into `found`; called from Python.

    Parameters
    ----------
    t, q : (m + 1,)   states;  y, w : (m + 1,)   absolute ones;  obstacle : (m + 1, 3)   s, s' and s'' there
    touched : (m + 1,) uint8   whether an event of the run lies there
    kind : (m,) uint8   of the pieces: 0, or PRESSED for a closed contact, or UNKNOWN, which are left out
    cuts : (k,)   times at which the obstacle may have a corner
    """
    n, n_cuts = len(found), len(cuts)
    times, places, position, speed = doubles(t), doubles(q), doubles(y), doubles(w)
    s, corner = doubles(obstacle), doubles(cuts)
    touch, left, out = small_numbers(touched), small_numbers(kind), small_numbers(found)
    with cython.nogil:
        i = 0
        for k in range(n):
            if left[k] == UNKNOWN or not times[k + 1] > times[k]:
                continue
            while i < n_cuts and corner[i] <= times[k]:
                i += 1
            whole = i == n_cuts or corner[i] >= times[k + 1]
            g.first, g.last, g.length = touch[k] != 0, touch[k + 1] != 0, times[k + 1] - times[k]
            if left[k] == PRESSED:
                out[k] = 1 if pressed_between_corners(g, g.s, times[k], corner, i, n_cuts) else 0
                continue
            good = at_once(
                g, g.s, times[k], after(places, k), after(position, k), after(speed, k),
                s[3 * k], s[3 * k + 3], whole,
            )  # fmt: skip
            if not good:
                leave(g, g.s, times[k], position[k], speed[k])
                good = between_corners(g, 0, times[k], corner, i, n_cuts)
            out[k] = 1 if good else 0


def at_once(
    g: Swing, o: Flight, t: float, q: Doubles, x: Doubles, w: Doubles, s: float, s_b: float, whole: bool
) -> bool:
    """Whether a piece from t on is certified by the states at its ends and the equation of motion.

    q, x : relative and absolute places;  w : velocities, after an event;  s, s_b : of the obstacle
    whole : whether no corner lies within
    """
    y, y_b, h, amplitude = x[0], x[1], g.length, 0.0
    if g.swings:
        size = amplitude = g.size(abs(y - g.height) + g.forced, abs(w[0]) + abs(o.Omega) * g.forced)
        bend, middle = o.w2 * size, 0.0
    else:
        size, bend, middle = abs(y) + abs(w[0]) * h + 0.5 * abs(o.f0) * h * h, 0.0, o.G * o.f0
    bend = (1.0 + SLACK) * abs(o.G) * (bend + o.Omega * o.Omega * g.forced)
    low, high = middle - bend, middle + bend
    size += g.forced + abs(g.height) + abs(q[0])
    g.error = ROUNDING * (abs(o.G) * size + abs(o.offset) + max(abs(s), abs(s_b)))
    g.error += late(max(abs(t), abs(t + h)), g.cells.whole_fast[0] + abs(o.G * o.Omega) * g.forced)
    g.own, g.small = g.error, min(g.error, g.negligible)
    place = o.offset + (o.G * y if o.G * y < o.G * y_b else o.G * y_b)
    if place - 0.125 * max(high, 0.0) * h * h - g.cells.whole_top[0] > g.error:
        return True
    g.cells.find(0, t, t + h)
    if place - 0.125 * max(high, 0.0) * h * h - g.cells.top > g.error:
        return True
    g_a, g_b = o.offset + o.G * q[0] - s, o.offset + o.G * q[1] - s_b
    g.first, g.last = g.first or abs(g_a) <= g.small, g.last or abs(g_b) <= g.small
    if g.cells.rough or not whole:
        return False
    bent = open_between(g_a, g_b, h, low - g.cells.high, high - g.cells.low, g.first, g.last, g.error)
    if bent or not g.swings or (g.last and o.delta != 0.0):
        return bent
    a, b = equation(o, t, y, w[0]), equation(o, t + h, y_b, w[1])
    Omega2 = o.Omega * o.Omega
    fourth = abs(o.G) * (amplitude * o.w2 * o.w2 + g.forced * Omega2 * Omega2)
    margin = (1.0 + SLACK) * 0.125 * fourth * h * h + SLACK * bend
    low, high = min(a, b) - margin, max(a, b) + margin
    return open_between(g_a, g_b, h, low - g.cells.high, high - g.cells.low, g.first, g.last, g.error)


def equation(o: Flight, t: float, y: float, w: float) -> float:
    """G y'' of a state."""
    return o.G * (o.f0 - 2.0 * o.delta * w - o.w2 * y) + driven(o, t)


def leave(g: Swing, s: Flight, t: float, y: float, w: float) -> None:
    """The motion from this absolute state on, and how large its fourth derivative can be."""
    leave_from(s, t, y, w)
    size, Omega2 = 0.0, s.Omega * s.Omega
    if g.swings:
        size = g.size(s.z0 - g.height, s.dz0)
    g.fourth = (1.0 + SLACK) * abs(s.G) * (size * s.w2 * s.w2 + g.forced * Omega2 * Omega2)


def pressed_between_corners(g: Swing, s: Flight, t0: float, cuts: Doubles, i: int, n_cuts: int) -> bool:
    """Whether a closed contact is pressed in a piece that begins at t0, between one corner and the next.

    i : the first of the cuts after t0
    """
    a = 0.0
    while a < g.length:
        b = g.length
        if i < n_cuts and cuts[i] - t0 < b:
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
    tau, n, looked = a, 1, 0
    force, g.times[0], g.bends[0] = driven(s, t0 + a), b, driven(s, t0 + b)
    while n > 0:
        looked += 1
        k = n - 1
        h = g.times[k] - tau
        g.cells.find(0, t0 + tau, t0 + g.times[k])
        alpha = constant + max(force, g.bends[k]) + 0.125 * s.Omega * s.Omega * forced * h * h
        alpha -= s.w2 * g.cells.bottom + 2.0 * s.delta * g.cells.slow + g.cells.low
        error = PRESSING * (abs(constant) + forced + abs(s.w2 * g.cells.top) + abs(g.cells.low))
        small = min(error, g.negligible)
        good = alpha <= error or (alpha < ERRORS * small and beside(g, tau, g.times[k], g.near))
        if (good and not g.cells.rough) or beside(g, tau, g.times[k], g.moment):
            tau, force = g.times[k], g.bends[k]
            n = k
        elif n > DEEPEST or looked > MOST:
            return False
        else:
            g.times[n] = 0.5 * (tau + g.times[k])
            g.bends[n] = driven(s, t0 + g.times[n])
            n += 1
    return True


def driven(s: Flight, t: float) -> float:
    """G F(t)."""
    return s.G * (s.fc * cos(s.Omega * t) + s.fs * sin(s.Omega * t)) if s.Omega != 0.0 else 0.0
