"""Corners, at which obstacles and belts may jump in speed, as kernels; `stepping.pieces.corners` has the same law.

    0 <= u + W p + r min(u-, 0)   complementary to   p >= 0

u- is the gap velocity with which a contact comes to its surface before the jump, u that beyond it: where the contact
was closed, u- = 0, and its obstacle takes the body along.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import JUMP, OPEN
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.impact import begin_instant
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import still_below, stop_joints
from lcpstep.events.rows.jumps import go_beyond, joints_jump
from lcpstep.kernels.status import DONE, NOT_FINITE
from lcpstep.pointers import abs


def turn_corner(s: Rubbing) -> int:
    """Beyond a corner contacts strike, those as well that land on it to rounding, and modes are sought; a status."""
    if s.n_c > 0 and not measure(s, s.rows.t0, s.y):
        return NOT_FINITE
    moment = s.rows.moment(s.rows.t0)
    for c in range(s.n_c):
        u = s.velocity[s.n_j + c]
        falls = s.mode[c] == OPEN and s.hops[c] == 0 and u < 0.0  # low hops go on
        s.before[c] = u if falls and s.gap[s.n_j + c] <= -u * moment else 0.0
    return strike_beyond(s)


def land_on_corner(s: Rubbing) -> int:
    """The same where those that `touches` marks have been found to land there, at the base state, just measured."""
    for c in range(s.n_c):
        u = s.velocity[s.n_j + c]
        s.before[c] = u if s.mode[c] == OPEN and s.touches[c] == 1 and u < 0.0 else 0.0
    return strike_beyond(s)


def strike_beyond(s: Rubbing) -> int:
    """Enter the next interval, where the contacts strike that are closed or have come with the velocity `before`."""
    s.rows.find_corners(s.rows.t0)
    go_beyond(s.rows, s.y)
    if not measure(s, s.rows.t0, s.y):
        return NOT_FINITE
    begin_instant(s)
    if joints_jump(s.rows, s.v):
        stop_joints(s.rows)
    for c in range(s.n_c):
        i, closed = s.n_j + c, s.mode[c] != OPEN
        s.touches[c] = 1 if closed or s.before[c] < 0.0 else 0
        if s.before[c] < 0.0 or (closed and abs(s.velocity[i]) > still_below(s.rows, i)):
            s.mode[c], s.jumped[c] = OPEN, s.velocity[i] - s.before[c]
    s.rows.next = JUMP
    return DONE
