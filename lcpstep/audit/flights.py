"""Certificates of flights in closed form, as kernels: one linear degree of freedom, flat obstacles; see `swing`."""

from __future__ import annotations

from math import sqrt
from typing import Any

import cython

from lcpstep.arrays import doubles, small_numbers
from lcpstep.audit.clear import (
    DEEPEST,
    MOST,
    beside,
    between_corners,
    late,
    open_between,
    rise,
    same_time,
)
from lcpstep.audit.limits import ERRORS, PRESSED, ROUNDED, SLACK, UNKNOWN
from lcpstep.audit.parting import above, above_at_ends, parts_at_ends, rises, swung
from lcpstep.audit.swing import Swing, driven
from lcpstep.events.flight.motion import Flight, leave_from
from lcpstep.pointers import Doubles, abs, after, inf, max, min, nan

PRESSING = 1e-14  # of the accelerations
BEFORE = 0.5  # of how long an event lasts: windows of closed contacts end so long before it
HALF_TURN = 3.0  # rad, and less than that


@cython.ccall
def clear_flights(g: Swing, t: Any, q: Any, v: Any, touched: Any, kind: Any, cuts: Any, found: Any) -> None:
    """Which pieces are certified, (m,), into `found`; called from Python.

    Parameters
    ----------
    t, q, v : (m + 1,)   states
    touched : (m + 1,) uint8   whether an event of the run lies there
    kind : (m,) uint8   of the pieces: 0, or PRESSED for a closed contact, or UNKNOWN, which are left out
    cuts : (k,)   times at which the obstacle may have a corner
    """
    n, n_cuts = len(found), len(cuts)
    times, places, speeds, corner = doubles(t), doubles(q), doubles(v), doubles(cuts)
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
                g.begin(times[k], places[k], speeds[k])
                begins = False
            x, w = after(places, k), after(speeds, k)
            good = at_once(g, g.s, times[k], times[k + 1], x, w, whole)
            if not good:
                good = by_states(g, g.s, times[k], times[k + 1], x, w, whole)
            if not good:
                g.stand(times[k], places[k], speeds[k])
                leave(g, g.s, times[k], g.y, g.w)
                good = between_corners(g, 0, times[k], corner, i, n_cuts)
            out[k] = 1 if good else 0


def at_once(g: Swing, o: Flight, t: float, t_b: float, q: Doubles, v: Doubles, whole: bool) -> bool:
    """Whether a piece is certified by its states as they are kept, relative to the frame, and by bounds.

    t, t_b, q, v : of both ends, the velocities those after events;  whole : whether no corner lies within
    """
    begin, end, g.rate = o.offset + o.G * q[0], o.offset + o.G * q[1], o.G * v[0]
    note_error(g, o, t, t_b, q[0], v[0])
    g.low, g.high, g.met = g.middle - g.bound, g.middle + g.bound, ROUNDED * g.cells.whole_size[0]
    g.begin_gap, g.end_gap = begin, end
    low, high, kick = g.cells.whole_low[0], g.cells.whole_high[0], g.cells.whole_kick[0]
    even = whole and not g.cells.whole_rough
    if g.alone and g.length <= g.cells.length and stays(g, low, high, kick, even):
        return True
    lowest = lowest_place(g, o, min(begin, end))
    if lowest - g.met > g.cells.whole_top[0]:
        return True
    plain = even and not (g.alone or g.frame.given)
    if plain and parts_at_ends(g, begin, end, g.rate, g.low, g.high) and above(g, t, g.high, 0):
        return True
    g.cells.find(0, t, t_b)
    g.met = ROUNDED * max(abs(g.cells.bottom), abs(g.cells.top))
    if lowest - g.met > g.cells.top:
        return True
    if not g.alone:
        look(g, t, t_b)
    return stays(g, g.cells.low, g.cells.high, g.cells.kick, whole and not g.cells.rough)


def look(g: Swing, t: float, t_b: float) -> None:
    """Ask where the obstacle is at both ends of a piece, and how fast at its start, unless nobody wants to know."""
    if g.first and g.last:
        g.rate = nan
        return
    g.begin_gap -= g.own_motion(0, t)
    g.rate -= g.moving[1]
    if not g.last:
        g.end_gap -= g.own_motion(0, t_b)


def note_error(g: Swing, o: Flight, t: float, t_b: float, q: float, v: float) -> None:
    """What a piece may be off by in which the motion is as large as this state says, and the flight."""
    size = g.most
    if not g.swings:
        g.stand(t, q, v)
        size = abs(g.y) + abs(g.w) * g.length + 0.5 * abs(o.f0) * g.length * g.length + g.forced
    g.error = ROUNDED * (abs(o.G) * (size + abs(q)) + abs(o.offset)) + late(max(abs(t), abs(t_b)), g.fast)


def lowest_place(g: Swing, o: Flight, least: float) -> float:
    """A bound of `place` in a piece, less its error, from the smaller of offset + G q at both ends; see `swung`.

    A frame is not asked where it is: `place` is above offset + G q by no less than the least that it ever adds.
    """
    if g.frame.given:
        least += g.cells.whole_bottom[0] - g.met
    g.high = min(g.high, swung(g, o, least))
    return least - 0.125 * max(g.high, 0.0) * g.length * g.length - g.error


def stays(g: Swing, low: float, high: float, kick: float, even: bool) -> bool:
    """Whether the gap stays open, by its values at both ends and the rate at which it opens.

    low, high, kick : of what moves;  even : whether it has no corner within, but for one at the very start, on the
        other side of which the rate may have been taken
    """
    high, low, error, within = g.high - low, g.low - high, g.error + g.met, 0.0 if even else kick
    if open_between(g.begin_gap, g.end_gap, g.length, low, high, within, g.first, g.last, error):
        return True
    return not g.last and rises(g, low, kick)


def by_states(g: Swing, o: Flight, t: float, t_b: float, q: Doubles, v: Doubles, whole: bool) -> bool:
    """The same of what `at_once` has left, by absolute states at both ends."""
    g.stand(t, q[0], v[0])
    y, w = g.y, g.w
    g.stand(t_b, q[1], v[1])
    begin, end, h = o.offset + o.G * y, o.offset + o.G * g.y, g.length
    g.high = min(g.high, swung(g, o, min(begin, end)))
    g.error += g.met
    if min(begin, end) - 0.125 * max(g.high, 0.0) * h * h - g.error > g.cells.top:
        return True
    g.met, g.own, g.small = 0.0, g.error, min(g.error, g.negligible)
    g.begin_gap, g.end_gap = 0.0 if g.first else g.begin_gap, 0.0 if g.last else g.end_gap
    g.first, g.last = g.first or abs(g.begin_gap) <= g.small, g.last or abs(g.end_gap) <= g.small
    g.begin_known = g.end_known = False
    kick = 0.0 if whole and not g.cells.rough else g.cells.kick
    return by_equation(g, o, t, t_b, y, w, kick) or above_at_ends(g, o, t, y, g.y, w)


def by_equation(g: Swing, o: Flight, t: float, t_b: float, y: float, w: float, kick: float) -> bool:
    """By the acceleration at both ends; y, w : absolute state at the start, that at the end being g.y, g.w."""
    h, first, last = g.length, g.first, g.last
    a = equation(g, o, t, y, w)
    if last and o.delta != 0.0:  # its velocity at the end is not that after the event
        margin = h * (1.0 + SLACK) * abs(o.G) * (g.amplitude * o.w2 * sqrt(o.w2) + g.turning * abs(o.Omega))
        margin = margin + SLACK * g.bound + PRESSING * abs(o.G * o.f0) if g.swings else inf
        low, high = a - margin - g.cells.high, a + margin - g.cells.low
        if open_between(g.begin_gap, g.end_gap, h, low, high, kick, first, last, g.error):
            return True
    b = equation(g, o, t_b, g.y, g.w)
    g.note_ends(o.offset + o.G * y, o.offset + o.G * g.y, g.begin_gap, g.end_gap, a, b)
    g.end_known = not last or o.delta == 0.0
    if not (g.swings and g.end_known):
        return False
    fourth = abs(o.G) * (g.amplitude * o.w2 * o.w2 + g.turning * o.Omega * o.Omega)
    bulge, loose = (1.0 + SLACK) * 0.125 * fourth * h * h, SLACK * g.bound
    low, high = min(a, b) - bulge - loose - g.cells.high, max(a, b) + bulge + loose - g.cells.low
    if open_between(g.begin_gap, g.end_gap, h, low, high, kick, first, last, g.error):
        return True
    if last:
        return False
    if b - a > 4.0 * bulge + 2.0 * loose:  # it is least at the start: a + (b - a) s - 4 bulge s (1 - s)
        low = a - loose - g.cells.high
    kick = g.cells.kick  # see `stays`
    shallow = g.first and beside(g, 0.0, h, g.near) and rise(g, 0, h, low, kick) - g.own > -ERRORS * g.small
    return shallow or rises(g, low, kick)


def equation(g: Swing, o: Flight, t: float, y: float, w: float) -> float:
    """G y'' of a state."""
    force, _ = driven(g, t)
    return o.G * (o.f0 - 2.0 * o.delta * w - o.w2 * y) + force


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
    force, turn = driven(g, t0 + a)
    g.times[0] = b
    g.bends[0], g.gaps[0] = driven(g, t0 + b)
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
            g.bends[n], g.gaps[n] = driven(g, t0 + g.times[n])
            n += 1
    return True
