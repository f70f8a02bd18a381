"""The motion over a step that is final, as kernels: the states asked for within it, its impulses, the next base."""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.events.contacts.held import right_hand_side
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import add_impulse
from lcpstep.events.rows.keep import keep_awaited
from lcpstep.events.rows.projection import project
from lcpstep.kernels.dop853 import ALL, STAGES
from lcpstep.kernels.quadrature import NODES_8, WEIGHTS_8
from lcpstep.kernels.vectors import clear, copy
from lcpstep.pointers import abs


def take_over(s: Rubbing, t: float, tau: float) -> None:
    """The motion over the first `tau` of the step is final: its impulses, the states asked for, the next base."""
    s.rows.tally.steps += 1
    pressed = 0.0
    clear(s.counted, s.n_r)
    while s.rows.record.wants(t, t >= s.rows.t_end):
        wanted = s.rows.record.awaited() - s.rows.t0
        press_between(s, pressed, wanted)
        pressed = wanted
        keep_wanted(s, wanted)
    if tau > 0.0:
        press_rest(s, pressed, tau)
        s.rows.record.store(s.F, s.length)
        copy(s.y, s.y_new, 2 * s.n_q)
    s.rows.start_at(t)
    if tau > 0.0 and s.rows.n_held > 0:
        project(s.rows, t, s.y)


def keep_wanted(s: Rubbing, tau: float) -> None:
    """Keep the state asked for next, tau from now: on the rows held, which dense output leaves by its own error."""
    copy(s.seen, s.y, 2 * s.n_q)
    if tau > 0.0:
        s.at(tau / s.length, s.seen)
        if s.rows.n_held > 0:
            project(s.rows, s.rows.record.awaited(), s.seen)
    keep_awaited(s.rows, s.seen)


def press_between(s: Rubbing, a: float, b: float) -> None:
    """Add the impulses of the forces between a and b after the base."""
    if s.rows.n_held == 0 or b <= a:
        return
    for k in range(8):
        tau = a + NODES_8[k] * (b - a)
        s.at(tau / s.length, s.seen)
        right_hand_side(s, s.rows.t0 + tau, s.seen, s.dy)
        share = WEIGHTS_8[k] * (b - a)
        for i in range(s.n_r):
            add_impulse(s.rows, i, share * s.multiplier[i])
            s.counted[i] = s.counted[i] + share * s.multiplier[i]


def press_rest(s: Rubbing, a: float, b: float) -> None:
    """Add the impulses of the rest of the step, which ends b after the base; up to a they have been counted."""
    if s.rows.n_held == 0:
        return
    if not sum_up(s):
        press_between(s, a, b)
        return
    late = b - s.length
    for i in range(s.n_r):
        add_impulse(s.rows, i, s.total[i] + late * s.loads[STAGES * s.n_r + i] - s.counted[i])


def sum_up(s: Rubbing) -> bool:
    """The impulses of the whole step by its own weights; False where an estimated error is above the tolerance."""
    for i in range(s.n_r):
        total, e5, e3 = 0.0, 0.0, 0.0
        for j in range(STAGES + 1):
            load = s.loads[j * s.n_r + i]
            total += s.A[STAGES * ALL + j] * load
            e5 += s.E5[j] * load
            e3 += s.E3[j] * load
        s.total[i] = s.length * total
        tolerance, error = s.atol + s.rtol * abs(s.total[i]), e5 * e5 + 0.01 * e3 * e3
        if s.length * e5 * e5 > tolerance * sqrt(error):
            return False
    return True
