"""The end of chattering with friction, as kernels.

A contact that hops no higher than the tolerance is closed: the rest of its impacts, summed up, is the impulse that
takes its velocity, with the friction that belongs to it, and the forces of the closed contact make up for the rest.
"""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import ACCUMULATION, OPEN, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.friction.equations import (
        gap_tolerance,
        measure_velocities,
        rounding_of_gap,
        rubs,
        speed_tolerance,
    )
    from lcpstep.events.friction.held import hold_modes, stop_rows
    from lcpstep.events.friction.impact import find_free, still
    from lcpstep.events.friction.keep import put_on_account
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.events.rows.held import constrain
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import abs


def close_small(s: Rubbing, record: Record, tally: Tally, t: float) -> bool:
    """Close a contact whose hops no longer matter; whether there was one. Modes must be obeyed, `v` measured."""
    copy(s.a, s.a_free, s.n_q)
    constrain(s.rows, s.a, s.bias)
    for c in range(s.n_c):
        i = s.n_j + c
        u, alpha = s.velocity[i], product(s.R, s.a, i, s.n_q) + s.bias[i]
        if s.mode[c] == OPEN and s.touches[c] == 1 and alpha < 0.0 and is_over(s, c, u, -0.5 * u * u / alpha):
            close(s, c)
            s.clock.log(record, tally, t, c, ACCUMULATION, u, 0.0, 0.0)
            return True
    return False


def is_over(s: Rubbing, c: int, u: float, height: float) -> bool:
    """Whether hops of contact c that begin with the speed u, and rise to this height, no longer matter.

    What other contacts make of the impacts that are left out is of the size of the speed, not of the height; so is
    what elastic ones would go on with for ever.
    """
    slow = u <= speed_tolerance(s, s.n_j + c)
    if s.model.restitution[c] < 1.0:
        slow = slow or s.n_c == 1 or height <= rounding_of_gap(s, c)
    return slow and height <= gap_tolerance(s, c)


def close(s: Rubbing, c: int) -> None:
    """Take the velocity of contact c, which slides on as before, unless that stops it."""
    i = s.n_j + s.n_c + c
    slip, rough = s.velocity[i], rubs(s, c)
    s.loaded[c], s.direction[c] = 1, 1.0 if slip >= 0.0 else -1.0
    s.mode[c] = SLIDES if not rough or abs(slip) > still(s, i) else STICKS
    if s.mode[c] == SLIDES and rough and not slides_on(s, i, slip):
        s.mode[c] = STICKS
    if not hold_modes(s):  # sliding on would take the others' forces away: in a wedge all come to rest
        for d in range(s.n_c):
            s.mode[d] = STICKS if s.mode[d] != OPEN and rubs(s, d) else s.mode[d]
        hold_modes(s)
    copy(s.account, s.impulse, s.n_r)
    copy(s.seen, s.v, s.n_q)
    stop_rows(s)
    if leaves_cone(s, c):
        take_back(s, c)
    put_on_account(s)
    measure_velocities(s, s.v)
    find_free(s)


def slides_on(s: Rubbing, i: int, slip: float) -> bool:
    """Whether what the modes hold can be stopped, and leaves row i its direction of sliding."""
    if not hold_modes(s):
        return False
    copy(s.dv, s.v, s.n_q)
    constrain(s.rows, s.dv, s.rate)
    return (product(s.R, s.dv, i, s.n_q) + s.rate[i]) * slip > 0.0


def leaves_cone(s: Rubbing, c: int) -> bool:
    """Whether contact c, just stopped, has more friction at this instant than belongs to what its normal has had."""
    normal, friction = s.impulse[c] - s.instant[c], s.impulse[s.n_c + c] - s.instant[s.n_c + c]
    return normal < 0.0 or abs(friction) > (1.0 + NOISE) * s.mu_s[c] * normal


def take_back(s: Rubbing, c: int) -> None:
    """Stop contact c from before in another way: of its impact so much that none is left, in its own proportion.

    An impact whose restitution turns the sliding has other friction than the sliding that it leaves; Moreau's law is
    plastic then. A friction beyond the cone would do work.
    """
    normal, friction = s.account[c] - s.instant[c], s.account[s.n_c + c] - s.instant[s.n_c + c]
    if normal <= 0.0:
        return
    mode, direction, s.mode[c] = s.mode[c], s.direction[c], SLIDES
    s.direction[c] = -friction / (s.mu[c] * normal) if s.mu[c] > 0.0 else direction
    if hold_modes(s):
        copy(s.v, s.seen, s.n_q)
        copy(s.impulse, s.account, s.n_r)
        stop_rows(s)
    s.mode[c], s.direction[c] = mode, direction
