"""What the event that ends a step leads to, of Runge-Kutta steps and of others (`stepping.rubbing`), as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.codes import EDGE, JUMP, LEANS, NO_SURFACE, OBEY, OPEN, SETTLE, SLIDES, STICKS
from lcpstep.events.contacts.corners import land_on_corner
from lcpstep.events.contacts.equations import measure, share_left
from lcpstep.events.contacts.impact import begin_instant
from lcpstep.events.contacts.leaning import wavers
from lcpstep.events.contacts.parting import part_before
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.contacts.surfaces import find_coming, find_touching, lift
from lcpstep.events.rows.contacts import gap_tolerance, has_stopped, still_below
from lcpstep.events.rows.equations import acceleration_of
from lcpstep.events.rows.problem import accelerate_as_held
from lcpstep.kernels.status import DONE, NOT_FINITE
from lcpstep.pointers import abs, max


def arrive(s: Rubbing, g: int) -> int:
    """The motion has come to the event of guard g: what comes next into `next`. A status."""
    c = g // GUARDS
    if not measure(s, s.rows.t0, s.y):
        return NOT_FINITE
    if of_force(s, g):
        s.rows.next = OBEY if changes(s) else SETTLE
    elif s.mode[c] == OPEN:
        return meet(s, c)
    else:
        stop(s, c)
    return DONE


def of_force(s: Rubbing, g: int) -> bool:
    """Whether guard g tells of a force, that pulls or leaves its cone; the others tell of a gap or of sliding."""
    mode = s.mode[g // GUARDS]
    return mode != OPEN and (g % GUARDS == 0 or mode == STICKS)


def changes(s: Rubbing) -> bool:
    """Whether the modes that `look_ahead` has found are others than those at hand; else the state itself decides.

    A force that jumps may do so later than its guard's polynomial has seen it.
    """
    some = False
    for c in range(s.n_c):  # the load alone changes where it goes over to the other wall of a slit
        some = some or is_other(s, c) or s.new_loaded[c] != s.loaded[c]
    if not some:
        find_standing(s)
    return some


def is_other(s: Rubbing, c: int) -> bool:
    """Whether the mode just decided of contact c is another than that at hand."""
    return s.new_mode[c] != s.mode[c] or s.new_direction[c] != s.direction[c]


def tells(s: Rubbing) -> bool:
    """Whether a mode just decided differs, other than sticking to leaning at the edge of the cone."""
    some = False
    for c in range(s.n_c):
        some = some or (is_other(s, c) and not wavers(s, c))
    return some


def meet(s: Rubbing, c: int) -> int:
    """Contact c has come to its surface; a status, for that may be there no more."""
    find_touching(s)
    find_coming(s, c)
    if not lift(s, c):
        s.rows.culprit = c
        return NO_SURFACE
    s.touches[c] = 1
    begin_instant(s)
    if s.rows.leaves_to_corner(s.rows.t0):
        s.rows.start_at(s.rows.high)
        return land_on_corner(s)
    if not s.in_turn:
        part_before(s)
    s.rows.next = JUMP
    return DONE


def stop(s: Rubbing, c: int) -> None:
    """The sliding velocity of contact c is zero."""
    land_with(s)
    find_standing(s)
    s.may_stick[c] = 1
    stop_with(s, c)
    s.rows.next = SETTLE


def land_with(s: Rubbing) -> None:
    """Close the contacts that a stop has left without a gap above the tolerance, and without speed in any direction.

    One that comes down from a hop that rounding hides would else fall on until its gap can be told, and strike that
    much faster. One at rest, in a gap that hops left out have made, would miss the next blow to what it is connected
    with.
    """
    share = share_left(s)
    for d in range(s.n_c):
        i = s.n_j + d
        least = max(s.rows.rounding_of_gap(d), share * gap_tolerance(s.rows, d))
        lies = s.mode[d] == OPEN and s.gap[i] <= least
        if lies and abs(s.velocity[i]) <= s.terms[d] and has_stopped(s.rows, d):
            s.mode[d] = SLIDES


def stop_with(s: Rubbing, c: int) -> None:
    """Contacts that stop with contact c are those whose sliding velocity comes to zero when its own does.

    Feet of one body stop together, and the ends of a rod. What the error of a step has left of one velocity it has
    left of the others in proportion.
    """
    i = s.n_j + s.n_c + c
    accelerate_as_held(s.rows)
    own = acceleration_of(s.rows, i, s.a)
    if own == 0.0:
        return
    for d in range(s.n_c):
        k = s.n_j + s.n_c + d
        with_it = s.velocity[i] * acceleration_of(s.rows, k, s.a) / own
        if abs(s.velocity[k] - with_it) <= still_below(s.rows, k) + EDGE * abs(with_it):
            s.may_stick[d] = 1


def find_standing(s: Rubbing) -> None:
    """Which contacts do not slide: those that stick, and those of whose sliding velocity that cannot be told.

    Feet of one body that share a direction are among these: one of them is held, the others have a share of the load.
    """
    for c in range(s.n_c):
        s.may_stick[c] = 1 if s.mode[c] in (STICKS, LEANS) or has_stopped(s.rows, c) else 0
