"""What has been let go, by steps with friction: open gaps and sliding that begin with no speed, as kernels.

What a force lets go that comes to zero, or to the edge of its cone, begins with no acceleration: there the force is
what rounding leaves, or the error of a step of order two. Its modes are those of a little later (`look_ahead`), and
until then a gap or sliding velocity may fall: nothing is met, and nothing stops.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.contacts.state import GUARDS
from lcpstep.events.rows.contacts import rubs
from lcpstep.events.rows.equations import velocity_of
from lcpstep.pointers import abs, after
from lcpstep.stepping.rubbing.strides import Strides


def is_motion(s: Strides, g: int) -> bool:
    """Whether guard g is a gap or a sliding velocity, rather than one of forces."""
    c = g // GUARDS
    if g % GUARDS == 0:
        return s.mode[c] == OPEN
    return s.mode[c] == SLIDES and g % GUARDS == 1 and rubs(s.rows, c)


def hops(s: Strides, c: int) -> bool:
    """Whether a hop of contact c begins at the base, or a low one goes on there."""
    g = GUARDS * c
    return s.mode[c] == OPEN and s.armed[g] == 0 and (s.begin_slope[g] > s.terms[c] or s.carried[c] == 1)


def rises(s: Strides, g: int) -> bool:
    """Whether guard g is a gap let go that rises at the end of the step just made, whose rates are known.

    A step of order two, off by the cube of its size, may lead it below its surface all the same. What has no speed
    but that of rounding rises by its acceleration, at first or, where that is zero but for rounding, further on.
    """
    c = g // GUARDS
    if s.armed[g] == 1 or g % GUARDS > 0 or s.mode[c] != OPEN:
        return False
    i, none = s.n_j + c, s.terms[c]
    u = velocity_of(s.rows, i, after(s.y_new, s.n_q))
    later = s.end_bend[c] > 0.0 and abs(s.begin_bend[c]) * s.length <= none
    return u > (-none if later or s.begin_bend[c] > 0.0 else none)


def widen_until_decided(s: Strides, g: int, h: float) -> None:
    """Widen the band of guard g by how far it falls in the step of size h, if only until its mode was decided."""
    c = g // GUARDS
    if s.armed[g] == 1 or not is_motion(s, g):
        return
    first, last, reach = s.begin_slope[g], s.end_slope[g], h
    if g % GUARDS == 0:
        if abs(first) > s.terms[c]:
            return
        first, last, reach = s.begin_bend[c], s.end_bend[c], h * h
    if first < 0.0 < last and -first * h <= (last - first) * (s.decided - s.rows.t0):
        s.band[g] = max(s.band[g], -first * reach)
