"""A Runge-Kutta step of a system with contacts, up to the first event within it, as kernels.

What that event leads to (`arrive`) is the same of other steps (`stepping.rubbing`).
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import (
    EDGE,
    JUMP,
    LEANS,
    NO_FORCES,
    NO_SURFACE,
    OBEY,
    OPEN,
    SETTLE,
    SLIDES,
    STICKS,
    SWITCH,
)
from lcpstep.events.contacts.corners import land_on_corner
from lcpstep.events.contacts.equations import measure, share_left
from lcpstep.events.contacts.guards import UNKNOWN, first_event, look
from lcpstep.events.contacts.hops import carry, find_landings, interrupt, shortest_hop
from lcpstep.events.contacts.impact import forget_terms
from lcpstep.events.contacts.leaning import gives, wavers
from lcpstep.events.contacts.loose import first_stray
from lcpstep.events.contacts.modes import decide, undecided
from lcpstep.events.contacts.moments import jumps, locate, of_sliding, turns_at_once
from lcpstep.events.contacts.parting import part_before
from lcpstep.events.contacts.passing import take_over
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.contacts.surfaces import find_coming, find_touching, lift
from lcpstep.events.contacts.switching import reach_guard, watch
from lcpstep.events.rows.contacts import gap_tolerance, hold_modes, rubs, sliding, still
from lcpstep.events.rows.jumps import breaks
from lcpstep.events.rows.keep import keep
from lcpstep.kernels.status import DONE, NOT_FINITE, PAINLEVE_INCONSISTENT
from lcpstep.kernels.vectors import product
from lcpstep.pointers import abs, max, min

# Of a step: where the forces after a release, or a slip, are looked at, how much further while they are zero, and how
# far at most
LOOK_AHEAD, FURTHER, FARTHEST = 1e-6, 10.0, 1e-2
LONGEST = 4.0  # times as long as the shortest hop, were its acceleration constant


def step(s: Rubbing) -> int:
    """One step, which ends at the first event within it; what comes next into `next`. A status.

    Where no forces hold the rows any more, sliding friction takes them away, or surfaces have become parallel.
    """
    s.rows.culprit = -1
    code = stride(s)
    if code != NOT_FINITE or s.rows.culprit < 0:
        return code
    return PAINLEVE_INCONSISTENT if rubs(s.rows, s.rows.culprit) else NO_FORCES


def stride(s: Rubbing) -> int:
    """The same; NOT_FINITE where no forces hold the row of `culprit`."""
    t0, border = s.clock.t0, min(s.clock.t_end, s.clock.high)
    if s.rows.n_held != s.paced:
        change_pace(s)
    code = s.take_step(t0, min(min(border - t0, s.scan_length), LONGEST * shortest_hop(s)), s.scan_length)
    if code != DONE:
        return code
    mark_resting(s)
    if breaks(s.rows, s, s.length, False):
        return DONE
    code = find(s, s.length)
    if code != DONE:
        return code
    if s.watched and s.watch.culprit >= 0:
        return complete_to_guard(s, s.length)
    if s.guard >= 0:
        return complete_to_event(s, s.length)
    return complete(s, s.length)


def find(s: Rubbing, h: float) -> int:
    """The first event within the step of size h just made: `guard`, or `watch.culprit`, if any; a status.

    When, as a fraction of h, into `found`.
    """
    find_landings(s, h)
    if first_event(s, h) == UNKNOWN:
        return NOT_FINITE
    if s.shown <= 1.0:
        first_stray(s, h, s.kept_to, min(s.shown, s.found))
    return watch(s, h, 1.0 if s.guard < 0 else s.found) if s.watched else DONE


def complete(s: Rubbing, h: float) -> int:
    """Take over the step of size h, in which nothing happens; a status."""
    border = min(s.clock.t_end, s.clock.high)
    interrupt(s, -1, h)
    take_over(s, border if h >= border - s.clock.t0 else s.clock.after(h), h)
    if s.hopping:
        if not look(s, s.clock.t0, s.y):
            return NOT_FINITE
        carry(s)
    if s.clock.record.is_due(s.clock.tally.steps):
        keep(s.rows, s.clock.t0, s.y)
    return DONE


def complete_to_event(s: Rubbing, h: float) -> int:
    """The step up to the guard found within it, and what comes next; a status."""
    g, border, code = s.guard, min(s.clock.t_end, s.clock.high), DONE
    if of_force(s, g):
        code = look_ahead(s, h)
        if code != DONE and not (s.yields and code == PAINLEVE_INCONSISTENT):
            return code
    longest = border - s.clock.t0
    lands = g % GUARDS == 0 and s.lands[g // GUARDS] >= 0.0  # a hop that its acceleration has told of
    tau = land(s, g, longest) if lands else locate(s, g, h, longest)
    if tau == UNKNOWN:
        return NOT_FINITE
    if of_sliding(s, g) and turns_at_once(s, g, tau, h):
        return DONE
    interrupt(s, g // GUARDS, tau)
    take_over(s, min(s.clock.after(tau), border), tau)
    if code != DONE or (tau > 0.0 and of_sliding(s, g) and jumps(s, g, tau)):
        return code  # a jump whose polynomial has been there, not the velocity
    return arrive(s, g)


def complete_to_guard(s: Rubbing, h: float) -> int:
    """The step up to the guard of modes that acts; a status."""
    tau = reach_guard(s, h)
    interrupt(s, -1, tau)
    take_over(s, min(s.clock.after(tau), min(s.clock.t_end, s.clock.high)), tau)
    s.rows.next = SWITCH
    return DONE


def land(s: Rubbing, g: int, longest: float) -> float:
    """Time from now at which that hop ends; a step of this length is left, complete."""
    tau = min(s.lands[g // GUARDS], longest)
    return tau if s.step(s.clock.t0, tau) and s.complete(s.clock.t0, tau) else UNKNOWN


def mark_resting(s: Rubbing) -> None:
    """Which gaps, and which sliding velocities, the modes at hand keep at zero."""
    for c in range(s.n_c):
        i, mode = s.n_j + c, s.mode[c]
        s.rows.rests[i] = 1 if mode != OPEN else 0
        if s.n_t > 0:
            s.rows.rests[i + s.n_c] = 1 if mode in (STICKS, LEANS) else 0


def change_pace(s: Rubbing) -> None:
    """Go on with the step that was next when as many rows were held: what sticks allows others than what slides."""
    s.paces[s.paced] = s.next_step
    if s.paces[s.rows.n_held] > 0.0:
        s.next_step = s.paces[s.rows.n_held]
    s.paced = s.rows.n_held


def of_force(s: Rubbing, g: int) -> bool:
    """Whether guard g tells of a force, that pulls or leaves its cone; the others tell of a gap or of sliding."""
    mode = s.mode[g // GUARDS]
    return mode != OPEN and (g % GUARDS == 0 or mode == STICKS)


def arrive(s: Rubbing, g: int) -> int:
    """The motion has come to the event of guard g: what comes next into `next`. A status."""
    c = g // GUARDS
    if not measure(s, s.clock.t0, s.y):
        return NOT_FINITE
    if of_force(s, g):
        s.rows.next = OBEY if changes(s) else SETTLE
    elif s.mode[c] == OPEN:
        return meet(s, c)
    else:
        stop(s, c)
    return DONE


def changes(s: Rubbing) -> bool:
    """Whether the modes that `look_ahead` has found are others than those at hand; else the state itself decides.

    A force that jumps may do so later than its guard's polynomial has seen it.
    """
    some = differ(s)
    for c in range(s.n_c):  # as where the load goes over to the other wall of a slit
        some = some or s.new_loaded[c] != s.loaded[c]
    if not some:
        find_standing(s)
    return some


def differ(s: Rubbing) -> bool:
    """Whether the modes just decided are others than those at hand."""
    some = False
    for c in range(s.n_c):
        some = some or is_other(s, c)
    return some


def is_other(s: Rubbing, c: int) -> bool:
    """Whether the mode just decided of contact c is another than that at hand."""
    return s.new_mode[c] != s.mode[c] or s.new_direction[c] != s.direction[c]


def look_ahead(s: Rubbing, h: float) -> int:
    """The modes just after a force has left its cone, or turned to pulling; a status.

    Rounding of larger forces may hide it for a while: where no mode changes one looks further.
    """
    ahead = LOOK_AHEAD + s.delay
    while True:
        s.at(s.found + ahead, s.seen)
        if not measure(s, s.clock.t0 + (s.found + ahead) * h, s.seen):
            return NOT_FINITE
        find_standing(s)
        code = decide(s)
        if code != DONE or ahead >= FARTHEST or (not undecided(s) and tells(s)):
            break
        ahead *= FURTHER
    hold_modes(s.rows)  # the old ones, for the rest of the step
    return code


def tells(s: Rubbing) -> bool:
    """Whether the same are others of which more is known than that a contact is at the edge of its cone."""
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
    forget_terms(s)
    if s.clock.leaves_to_corner(s.clock.t0):
        s.clock.start_at(s.clock.high)
        return land_on_corner(s)
    if not s.in_turn:
        part_before(s)
    s.rows.next = JUMP
    return DONE


def stop(s: Rubbing, c: int) -> None:
    """The sliding velocity of contact c is zero."""
    land_with(s)
    find_standing(s)
    s.free[c] = 1
    stop_with(s, c)
    s.rows.next = SETTLE


def land_with(s: Rubbing) -> None:
    """Close the contacts that a stop has left with no gap above the tolerance, and no speed, along it or not.

    On its way down in a hop that rounding hides, one would fall on until the gap tells, and strike that much faster.
    At rest, in a gap that hops left out have made, one would miss the next blow to what it is connected with.
    """
    share = share_left(s)
    for d in range(s.n_c):
        i = s.n_j + d
        least = max(s.rows.rounding_of_gap(d), share * gap_tolerance(s.rows, d))
        lies = s.mode[d] == OPEN and s.gap[i] <= least
        if lies and abs(s.velocity[i]) <= s.terms[d] and abs(sliding(s.rows, d)) <= still(s.rows, i + s.n_c):
            s.mode[d] = SLIDES


def stop_with(s: Rubbing, c: int) -> None:
    """Contacts that stop with contact c are those whose sliding velocity goes with what the step has left of its own.

    Feet of one body stop together, and the ends of a rod: a step is only as exact as its order, and what of one
    velocity it has left, it has of the others.
    """
    i = s.n_j + s.n_c + c
    own = gives(s, i)
    if not own > EDGE * s.W[i * s.n_r + i]:
        return
    for d in range(s.n_c):
        k = s.n_j + s.n_c + d
        with_it = s.velocity[i] * product(s.R, s.dv, k, s.n_q) / own
        if abs(s.velocity[k] - with_it) <= still(s.rows, k) + EDGE * abs(with_it):
            s.free[d] = 1


def find_standing(s: Rubbing) -> None:
    """Which contacts do not slide: those that stick, and those of whose sliding velocity that cannot be told.

    Feet of one body that share a direction are among these: one of them is held, the others have a share of the load.
    """
    for c in range(s.n_c):
        rests = s.n_t == 0 or s.mode[c] == STICKS or s.mode[c] == LEANS
        s.free[c] = 1 if rests or abs(sliding(s.rows, c)) <= still(s.rows, s.n_j + s.n_c + c) else 0
