"""Where the velocity of an obstacle, a belt or a joint jumps at a time that no corner of the scene names, as kernels.

The accelerations by which a step holds its rows know nothing of a jump: beyond one the velocity of a row is off by
all of it, at the end of however short a step, and to put the motion back onto the row would drag it along. Halving
finds the time, which is a corner from then on.
"""

from __future__ import annotations

import cython

from lcpstep.events.rows.equations import (
    least_gap,
    least_speed,
    list_gaps,
    measure_rates,
    size_of,
    velocity_of,
)
from lcpstep.events.rows.state import Rows
from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.sudden import JUMP, MORE, SUDDEN, coarseness
from lcpstep.kernels.vectors import add
from lcpstep.pointers import Doubles, abs, after, max

TOLERANCES = 8.0  # of a velocity: what a step leaves of a row held


def breaks(s: Rows, motion: RungeKutta, h: float, measured: bool) -> bool:
    """Whether the velocity of a row that `rests` jumps within the step of size h just made, which is left as it is.

    The time is a corner then, and the step is to be made again.
    measured : rows are those at the end of the step, which costs so little that gaps are not asked for either
    """
    if s.n_held == 0 or (s.fixed and not s.moving):
        return False
    if not measured:
        measure_rates(s, s.t0 + h, motion.y_new)
    i = farthest_off(s, motion)
    if i < 0:
        i = -1 if measured else open_at(s, s.t0 + h, motion)
        return i >= 0 and find_way(s, motion, i, h)
    if find_jump(s, motion, i, h):
        return True
    begins = velocity(s, i, s.t0, motion.y)
    s.sudden.excuse(velocity(s, i, s.t0 + h, motion.y_new) - begins)
    return False


def farthest_off(s: Rows, motion: RungeKutta) -> int:
    """The row at rest whose velocity is farthest off from zero at the end of the step, beyond errors of it; or -1."""
    v, found, most = after(motion.y_new, s.n_q), -1, 1.0
    for i in range(s.n_r):
        u = abs(velocity_of(s, i, v)) if s.rests[i] == 1 else 0.0
        if u > most * s.sudden.drift:
            off = u / unseen(s, i, v)
            if off > most:
                found, most = i, off
    return found


def joints_jump(s: Rows, v: Doubles) -> bool:
    """Whether a joint has jumped at a corner: the velocity v is off it by more than errors."""
    jumped = False
    for i in range(s.n_j):
        jumped = jumped or abs(velocity_of(s, i, v)) > error(s, i, v)
    return jumped


def open_at(s: Rows, t: float, motion: RungeKutta) -> int:
    """The first row at rest whose gap is open, or the other way, by more than errors of the step just made; or -1."""
    list_gaps(s, t, motion.y_new, s.near)
    for i in range(s.n_j + s.n_c):
        if s.rests[i] == 1 and abs(s.near[i]) > max(TOLERANCES * least_gap(s, i, motion.y_new), s.gap_drift):
            return i
    return -1


def find_way(s: Rows, motion: RungeKutta, i: int, h: float) -> bool:
    """Whether gap i, open at the end of the step though its velocity is zero, has opened by two jumps within it.

    Halving by the gap finds a time between the two.
    """
    low, high, way = 0.0, h, abs(s.near[i])
    while high - low > SUDDEN * SUDDEN * h:
        tau = 0.5 * (low + high)
        if not motion.step(s.t0, tau):
            break
        t, v = s.t0 + tau, after(motion.y_new, s.n_q)
        if abs(velocity(s, i, t, motion.y_new)) > unseen(s, i, v) and find_jump(s, motion, i, tau):
            return True
        list_gaps(s, t, motion.y_new, s.near)
        if abs(s.near[i]) > 0.5 * way:
            high = tau
        else:
            low = tau
    s.gap_drift = max(s.gap_drift, MORE * way)
    motion.step(s.t0, h)
    motion.complete(s.t0, h)
    return False


def go_beyond(s: Rows, y: Doubles) -> bool:
    """At a corner that was found, move coordinates to its far side, as rows may jump by the place; whether it was.

    They go what they go in the time to which the time of a jump is known.
    """
    if s.low != s.jump:
        return False
    v = after(y, s.n_q)
    add(y, 2.0 * max(s.margin(s.t0), coarseness(y, v, s.n_q)), v, s.n_q)
    return True


def unseen(s: Rows, i: int, v: Doubles) -> float:
    """What steps may leave of the velocity of row i, which is no jump."""
    return max(error(s, i, v), s.sudden.drift)


def error(s: Rows, i: int, v: Doubles) -> float:
    """Of the velocity of row i: its rounding, and some of the tolerance."""
    return max(JUMP * size_of(s, i, s.rate[i], v), TOLERANCES * least_speed(s, i, v))


def velocity(s: Rows, i: int, t: float, y: Doubles) -> float:
    """The velocity of row i at a state."""
    measure_rates(s, t, y)
    return velocity_of(s, i, after(y, s.n_q))


def hidden_by_rounding(s: Rows, motion: RungeKutta, i: int) -> float:
    """By how much rounding of places hides the time of the jump just found, if row i jumps by the place; else 0."""
    t = s.t0 + s.sudden.low
    if s.fixed or not motion.step(s.t0, s.sudden.low):
        return 0.0
    v, coarse = after(motion.y_new, s.n_q), coarseness(motion.y_new, after(motion.y_new, s.n_q), s.n_q)
    add(motion.y_new, 4.0 * coarse, v, s.n_q)
    beyond = (velocity(s, i, t, motion.y_new) - s.sudden.middle) * (s.sudden.later - s.sudden.middle) > 0.0
    return coarse if beyond else 0.0


def find_jump(s: Rows, motion: RungeKutta, i: int, h: float) -> bool:
    """Whether what the velocity of row i changes by within the step of size h comes by a jump; at a corner then.

    What sticks may begin the step with a velocity, next to none, that the end of it no longer has.
    """
    t0, before, later = s.t0, velocity(s, i, s.t0, motion.y), velocity(s, i, s.t0 + h, motion.y_new)
    if abs(later - before) <= unseen(s, i, after(motion.y_new, s.n_q)):
        return False
    s.sudden.begin(h, before, later)
    while s.sudden.seek(t0):
        if not motion.step(t0, s.sudden.x):
            break
        s.sudden.take(velocity(s, i, t0 + s.sudden.x, motion.y_new))
    t = s.sudden.just_before(t0, hidden_by_rounding(s, motion, i))
    if s.sudden.is_jump() and s.lies_apart(t):
        s.break_at(t)
        return True
    motion.step(t0, h)
    motion.complete(t0, h)
    return False
