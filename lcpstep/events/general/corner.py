"""Corners of a scene, as kernels: beyond one accelerations, and velocities of obstacles, are those of the far side.

Where the velocity of an obstacle jumps under a contact that is closed, u- = 0 is taken before the jump and u+ >= 0
after it: the obstacle takes the body along or, dropping, leaves it. Bodies in flight see its new velocity.
"""

from __future__ import annotations

import cython

from lcpstep.events.general.ends import NO_IMPULSES
from lcpstep.kernels.status import BUFFER_FULL, DONE

if not cython.compiled:
    from lcpstep.events.general.equations import speed_tolerance
    from lcpstep.events.general.impact import strike
    from lcpstep.events.general.modes import tell_impacts
    from lcpstep.events.general.state import JUMP, SETTLE, Mechanism
    from lcpstep.events.rows.equations import JUMPS, measure_rates, respond, size_of
    from lcpstep.events.rows.jumps import drive_joints, go_beyond
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import abs, max


def pass_corner(s: Mechanism, record: Record, tally: Tally) -> int:
    """Enter the next smooth interval; an impact where an obstacle's velocity jumps under a closed contact."""
    if record.event + 4 * s.n_c + 4 > record.event_capacity:
        return BUFFER_FULL
    s.next = SETTLE
    if not throws(s):
        return DONE
    s.next = JUMP
    solved = strike(s)
    for c in range(s.n_c):
        s.contact.thrown[c] = 0.0
    if not solved:
        return NO_IMPULSES
    tell_impacts(s, record, tally, s.t0)
    return DONE


def throws(s: Mechanism) -> bool:
    """Whether a closed contact is struck or left by its obstacle; gap velocities of open ones are the new ones.

    A joint that is driven, and jumps, makes contacts of the bodies that it moves jump as their obstacles would.
    """
    before, along = s.left.curve, s.left.multiplier
    measure_rates(s, s.t0, s.q, s.v)  # as they are here, and not where gaps were last looked at
    copy(before, s.contact.rate, s.n_c)
    for c in range(s.n_c):
        along[c] = product(s.R, s.v, s.n_j + c, s.n_q)
    s.find_corners(s.t0)
    found = go_beyond(s, s.q, s.v)
    measure_rates(s, s.t0, s.q, s.v)
    if found:
        respond(s)
    for c in range(s.n_c):
        along[c] = product(s.R, s.v, s.n_j + c, s.n_q) - along[c]
    copy(s.dy, s.v, s.n_q)
    some = driven = drive_joints(s, s.v)
    if driven:
        for m in range(s.n_held):
            s.joint.impulse[s.row[m]] = s.joint.impulse[s.row[m]] + s.held[m]
        for j in range(s.n_q):
            s.dy[j] = s.v[j] - s.dy[j]
    for c in range(s.n_c):
        jump = s.contact.rate[c] - before[c] + along[c]
        if driven:
            jump += product(s.R, s.dy, s.n_j + c, s.n_q)
        size = size_of(s, s.n_j + c, abs(s.contact.rate[c]) + abs(before[c]), s.v)
        s.contact.terms[c], s.contact.parting[c], s.contact.thrown[c] = size, 0, 0.0
        if abs(jump) <= max(JUMPS * size, speed_tolerance(s, c)):
            jump = 0.0
        if s.contact.closed[c] == 1:
            s.contact.thrown[c], some = jump, some or jump != 0.0
        else:
            s.contact.speed[c] = s.contact.speed[c] + jump
        s.left.speed[c] = s.contact.speed[c]
    return some
