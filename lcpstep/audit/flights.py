"""Certificates of flights in closed form, as kernels: one linear degree of freedom, flat obstacles; see `swing`."""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.audit.limits import ERRORS, PRESSED, SLACK, UNKNOWN
from lcpstep.audit.limits import ROUNDED as ROUNDING

if not cython.compiled:
    from math import sqrt

    from lcpstep.arrays import doubles, small_numbers
    from lcpstep.audit.clear import DEEPEST, MOST, beside, between_corners, late, open_between, same_time
    from lcpstep.audit.parting import above, above_at_ends, parts_at_ends, swung
    from lcpstep.audit.swing import Swing, driven
    from lcpstep.events.flight.motion import Flight, leave_from
    from lcpstep.pointers import Doubles, abs, after, inf, max, min

PRESSING = 1e-14  # of the accelerations
BEFORE = 0.5  # of how long an event lasts: windows of closed contacts end so long before it
HALF_TURN = 3.0  # rad, and less than that


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


def at_once(g: Swing, o: Flight, t: float, q: Doubles, x: Doubles, w: Doubles, whole: bool) -> bool:
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
    even = whole and not g.cells.whole_rough
    if even and parts_at_ends(g, begin, end, o.G * w[0], low, high) and above(g, t, high, 0):
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
