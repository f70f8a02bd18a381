"""Impacts at one instant that repeat in proportion without end, as kernels: their sum. See `kernels.recurrence`.

With rho the ratio of two turns, what a turn changes of any velocity comes rho / (1 - rho) times more.
"""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import ACCUMULATION, OPEN, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.friction.equations import apply, measure_velocities, rubs
    from lcpstep.events.friction.held import hold_modes, stop_rows
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.events.rows.held import hold_joints
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.recurrence import CERTAIN, FOR_EVER, left, proportion
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import abs, after


def look_back(s: Rubbing) -> None:
    """Compare with the velocities of now from now on."""
    copy(s.turn_velocity, s.velocity, s.n_r)
    copy(s.turn_start, s.impulse, s.n_r)


def recurs(s: Rubbing) -> float:
    """The ratio in which the speeds of all contacts struck since have returned, where the rest can be summed."""
    n_j = s.n_j
    for i in range(s.n_r):
        s.turn_impulse[i] = s.impulse[i] - s.turn_start[i]
    ratio = proportion(s.turn_impulse, after(s.turn_velocity, n_j), after(s.velocity, n_j), s.terms, s.n_c)
    if not 0.0 < ratio < FOR_EVER:
        return 0.0
    for c in range(s.n_c):
        i = n_j + c
        if s.turn_impulse[c] > 0.0:
            if rubs(s, c) and not rubs_on(s, i + s.n_c, ratio):
                return 0.0
        elif (
            s.mode[c] == OPEN
            and s.touches[c] == 1
            and left(s.turn_velocity[i], s.velocity[i], ratio) < -s.terms[c]
        ):
            return 0.0  # it will be struck before the others have come to rest
    return ratio


def rubs_on(s: Rubbing, i: int, ratio: float) -> bool:
    """Whether friction on the tangent of row i goes on as in the turn: sliding one way, or to rest in proportion."""
    before, u = s.turn_velocity[i], s.velocity[i]
    return rests(s, i, ratio) or (u * left(before, u, ratio) > 0.0 and u * before > 0.0)


def rests(s: Rubbing, i: int, ratio: float) -> bool:
    """Whether the velocity of row i goes to zero in the same proportion."""
    return abs(left(s.turn_velocity[i], s.velocity[i], ratio)) <= CERTAIN * abs(s.velocity[i])


def sum_up(s: Rubbing, record: Record, tally: Tally, t: float, ratio: float) -> None:
    """Take the impacts that are left as one: the contacts that they strike are closed."""
    rest, pushed = ratio / (1.0 - ratio), 2 * s.n_c
    for c in range(s.n_c):
        p = rest * s.turn_impulse[c]
        if p > 0.0:
            before = s.velocity[s.n_j + c] if s.mode[c] == OPEN else 0.0
            s.clock.log(record, tally, t, c, ACCUMULATION, before, 0.0, p)
            if s.mode[c] == OPEN:
                rough = rubs(s, c)
                s.mode[c] = STICKS if rough and rests(s, s.n_j + s.n_c + c, ratio) else SLIDES
    for i in range(s.n_j):
        apply(s, i, rest * s.turn_impulse[pushed + i])
    for k in range(pushed):
        apply(s, s.n_j + k, rest * s.turn_impulse[k])
    if not hold_modes(s):
        hold_joints(s.rows)
    stop_rows(s)
    measure_velocities(s, s.v)
    look_back(s)
