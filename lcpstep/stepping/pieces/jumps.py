"""Where the velocity of what contacts rest on jumps at a time that no corner names, as kernels.

The accelerations of a piece of motion know nothing of it. Put back onto obstacles at its end the motion would
be dragged along, whatever the law of impact says. The time is found along the piece, as by the event-driven
method (`kernels.sudden`), and is a corner from then on, up to which the piece is made again.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.model import Model
from lcpstep.kernels.sudden import JUMP, coarseness
from lcpstep.kernels.vectors import add, product
from lcpstep.pointers import abs, max, min
from lcpstep.stepping.pieces.codes import CLOSED
from lcpstep.stepping.pieces.loop import Steps
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within

BRIEF = 2.0**-10  # of a piece: what turns within so short a time, its sides included, jumps there
SIDES = 16.0  # of half of such a turn: how far from its middle nothing is left of it


def find_jump(way: Steps, w: Work, t: float, length: float) -> bool:
    """End the smooth interval where a velocity jumps within the piece that begins at t; whether one does."""
    if w.closed_now == 0 and not way.told:
        return False
    i = farthest_off(way, w, t, length)
    way.doubtful = not way.told
    if i < 0:
        return False
    w.sudden.begin(length, w.before[i], velocity(w, i))
    while w.sudden.seek(t):
        way.measure_at(t, w.sudden.x)
        w.sudden.take(velocity(w, i))
    coarse = hidden_by_rounding(way, w, t, i)
    place, margin = place_of(way.m, w, t, coarse), max(way.plan.margin, coarse)
    if w.sudden.is_turn():
        place, margin = t + 0.5 * (w.sudden.low + w.sudden.high), SIDES * (w.sudden.high - w.sudden.low)
    if w.sudden.is_jump() and margin <= BRIEF * length and lies_apart(w, place, margin):
        w.jump = w.high = place
        w.margin = max(margin, way.plan.margin)
        return True
    w.sudden.excuse(w.sudden.whole)
    return False


def hidden_by_rounding(way: Steps, w: Work, t: float, i: int) -> float:
    """By how much rounding of places hides the time of the jump just found, if row i jumps by the place; else 0."""
    if way.m.flat:
        return 0.0
    way.measure_at(t, w.sudden.low)
    coarse = coarseness(w.q_try, w.v_try, w.n_q)
    add(w.q_try, 4.0 * coarse, w.v_try, w.n_q)
    gap_rates(way.m, within(w, t + w.sudden.low), w.q_try, w.v_try, w.G_try, w.gap_t_try)
    beyond = (velocity(w, i) - w.sudden.middle) * (w.sudden.later - w.sudden.middle) > 0.0
    return coarse if beyond else 0.0


def place_of(m: Model, w: Work, t: float, coarse: float) -> float:
    """The time of the jump that was sought from t on: just after it, as times within the interval are before it.

    Where rows may jump by the place it is just before it.
    """
    if m.flat:
        return t + w.sudden.high
    place = w.sudden.just_before(t, coarse)
    if w.high == w.jump:  # a piece that has ended beyond it
        place = min(place, w.high - 2.0 * w.sudden.untold(t))
    return place


def farthest_off(way: Steps, w: Work, t: float, length: float) -> int:
    """The contact whose velocity changes most within the piece, beyond errors and rounding, where none should; or -1.

    Where not all are told the closed ones count, which have none where the piece begins.
    """
    found, most, largest = -1, 1.0, 0.0
    if way.told:
        way.measure_at(t, 0.0)
    for i in range(w.n_c):
        w.before[i] = velocity(w, i) if way.told else 0.0
    way.measure_at(t, length)
    for i in range(w.n_c):
        if w.status[i] == CLOSED or way.told:
            change = abs(velocity(w, i) - w.before[i])
            off = change / max(JUMP * size_of(way.plan, w, i), w.sudden.drift) if change > 0.0 else 0.0
            largest = max(largest, change)
            if off > most:
                found, most = i, off
    if found < 0:
        w.sudden.excuse(largest)
    return found


def velocity(w: Work, i: int) -> float:
    """The velocity of gap i."""
    return product(w.G_try, w.v_try, i, w.n_q) + w.gap_t_try[i]


def size_of(plan: Plan, w: Work, i: int) -> float:
    """Sum of the sizes of the terms of the velocity of gap i within a step."""
    size = abs(w.gap_t_try[i])
    for j in range(w.n_q):
        size += abs(w.G_try[i * w.n_q + j]) * (abs(w.v_try[j]) + plan.h * abs(w.a_free[j]))
    return size


def lies_apart(w: Work, t: float, margin: float) -> bool:
    """Whether a time can be told from the ends of the smooth interval; it may be the base of the piece.

    The end may be where this jump was looked for before, on a polynomial that knew of it.
    """
    return w.low + 2.0 * margin < t < (w.high if w.high == w.jump else w.high - 2.0 * margin)
