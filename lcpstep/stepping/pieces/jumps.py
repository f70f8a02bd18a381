"""Where the velocity of what contacts rest on, or of a joint, jumps at a time that no corner names, as kernels.

The accelerations of a piece of motion know nothing of it. Put back onto obstacles and joints at its end the motion
would be dragged along, whatever the law of impact says. The time is found along the piece, as by the event-driven
method (`kernels.sudden`), and is a corner from then on, up to which the piece is made again.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.dynamics import gap_rates
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.sudden import coarseness
    from lcpstep.kernels.vectors import product
    from lcpstep.pointers import Doubles, abs, after, max, min
    from lcpstep.stepping.pieces.codes import CLOSED
    from lcpstep.stepping.pieces.corners import JUMP
    from lcpstep.stepping.pieces.loop import Steps
    from lcpstep.stepping.pieces.state import Plan, Work
    from lcpstep.stepping.pieces.times import within

BRIEF = 2.0**-10  # of a piece: what turns within so short a time, its sides included, jumps there
SIDES = 16.0  # of half of such a turn: how far from its middle nothing is left of it


def breaks(way: Steps, w: Work, t: float, length: float) -> bool:
    """Whether a velocity jumps within the piece at hand, which begins at t: the smooth interval ends there then."""
    if w.closed_now == 0 and not way.told and way.n_rows == w.n_c:
        return False
    i = farthest_off(way, w, t, length)
    w.doubtful = not way.told
    if i < 0:
        return False
    w.sudden.begin(length, w.begins[i], velocity(w, i))
    while w.sudden.seek(t):
        measure_rows(way, w, t, w.sudden.x)
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
    if way.m.flat or i >= w.n_c:
        return 0.0
    measure_rows(way, w, t, w.sudden.low)
    coarse = coarseness(w.q_try, w.v_try, w.n_q)
    for j in range(w.n_q):
        w.q_try[j] += 4.0 * coarse * w.v_try[j]
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
    """The row whose velocity changes most within the piece, beyond errors and rounding, where none should; or -1.

    Rows are the contacts, of which the closed ones count where not all are told, and joints that are driven.
    """
    found, most, largest = -1, 1.0, 0.0
    moving = way.told or way.n_rows > w.n_c  # else what counts is closed, and has none where the piece begins
    if moving:
        measure_rows(way, w, t, 0.0)
    for i in range(way.n_rows):
        w.begins[i] = velocity(w, i) if moving else 0.0
    measure_rows(way, w, t, length)
    for i in range(way.n_rows):
        if i >= w.n_c or w.status[i] == CLOSED or way.told:
            change = abs(velocity(w, i) - w.begins[i])
            off = change / max(JUMP * size_of(way.plan, w, i), w.sudden.drift) if change > 0.0 else 0.0
            largest = max(largest, change)
            if off > most:
                found, most = i, off
    if found < 0:
        w.sudden.excuse(largest)
    return found


def measure_rows(way: Steps, w: Work, t: float, tau: float) -> None:
    """State, Jacobians and rates of contacts and joints at tau after the base t of the piece at hand."""
    at = within(w, t + tau)
    way.measure_at(at, tau)
    if way.n_rows > w.n_c:
        gap_rates(w.joints.rows, at, w.q_try, w.v_try, w.joints.J_try, w.joints.stretch)


def row(w: Work, i: int) -> Doubles:
    """Row i of the Jacobians."""
    return after(w.G_try, i * w.n_q) if i < w.n_c else after(w.joints.J_try, (i - w.n_c) * w.n_q)


def rate(w: Work, i: int) -> float:
    """Its rate."""
    return w.gap_t_try[i] if i < w.n_c else w.joints.stretch[i - w.n_c]


def velocity(w: Work, i: int) -> float:
    """Its velocity."""
    return product(row(w, i), w.v_try, 0, w.n_q) + rate(w, i)


def size_of(plan: Plan, w: Work, i: int) -> float:
    """What its velocity is made of in a step, signs left aside."""
    size = abs(rate(w, i))
    for j in range(w.n_q):
        size += abs(row(w, i)[j]) * (abs(w.v_try[j]) + plan.h * abs(w.free[j]))
    return size


def lies_apart(w: Work, t: float, margin: float) -> bool:
    """Whether a time can be told from the ends of the smooth interval; it may be the base of the piece.

    The end may be where this jump was looked for before, on a polynomial that knew of it.
    """
    return w.low + 2.0 * margin < t < (w.high if w.high == w.jump else w.high - 2.0 * margin)
