"""A Runge-Kutta step of a system with contacts, up to the first event within it, as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.codes import LEANS, NO_FORCES, OPEN, STICKS, SWITCH
from lcpstep.events.contacts.arrival import arrive, find_standing, of_force, tells
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.guards import first_event, look
from lcpstep.events.contacts.hops import carry, interrupt, landing, shortest_hop
from lcpstep.events.contacts.loose import first_stray
from lcpstep.events.contacts.modes import decide, mark_undecided
from lcpstep.events.contacts.moments import jumps, locate, of_sliding
from lcpstep.events.contacts.passing import take_over
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.contacts.switching import reach_guard, watch
from lcpstep.events.hybrid.locate import UNKNOWN
from lcpstep.events.rows.contacts import hold_modes, rubs
from lcpstep.events.rows.jumps import breaks
from lcpstep.events.rows.keep import keep
from lcpstep.kernels.status import DONE, NOT_FINITE, PAINLEVE_INCONSISTENT
from lcpstep.pointers import min

# Of a step, or of the interval looked at: where the forces after a release, or a slip, or that begin at zero are
# looked at, how much further while they are zero, and how far at most
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
    t0, border = s.rows.t0, s.rows.border()
    if s.rows.n_held != s.paced:
        change_pace(s)
    code = s.take_step(t0, min(min(border - t0, s.scan_length), LONGEST * shortest_hop(s)), s.scan_length)
    if code != DONE:
        return code
    mark_resting(s)
    if breaks(s.rows, s, s.length, False):
        return DONE
    code = find(s)
    if code != DONE:
        return code
    if s.watch is not None and s.watch.due >= 0:
        return complete_to_guard(s)
    return complete_to_event(s) if s.guard >= 0 else complete(s)


def find(s: Rubbing) -> int:
    """The first event within the step just made: `guard`, or `watch.due`, if any; a status.

    When, as a fraction of the step, into `found`; when hops land, into `lands`.
    """
    h = s.length
    for c in range(s.n_c if s.hopping else 0):
        s.lands[c] = landing(s, c, h)
    if first_event(s, h) == UNKNOWN:
        return NOT_FINITE
    if s.shown <= 1.0:
        first_stray(s, h, s.kept_to, min(s.shown, s.found))
    return watch(s, h, 1.0 if s.guard < 0 else s.found) if s.watch is not None else DONE


def complete(s: Rubbing) -> int:
    """Take over the step, in which nothing happens; a status."""
    h, border = s.length, s.rows.border()
    interrupt(s, -1, h)
    take_over(s, border if h >= border - s.rows.t0 else s.rows.after(h), h)
    if s.hopping:
        if not look(s, s.rows.t0, s.y):
            return NOT_FINITE
        carry(s)
    if s.rows.record.is_due(s.rows.tally.steps):
        keep(s.rows, s.rows.t0, s.y)
    return DONE


def complete_to_event(s: Rubbing) -> int:
    """The step up to the guard found within it, and what comes next; a status."""
    g, h, border, code = s.guard, s.length, s.rows.border(), DONE
    if of_force(s, g):
        code = look_ahead(s, h)
        if code != DONE and not (s.yields and code == PAINLEVE_INCONSISTENT):
            return code
    longest = border - s.rows.t0
    if g % GUARDS == 0 and s.lands[g // GUARDS] >= 0.0:  # a hop that its acceleration has told of
        tau = min(s.lands[g // GUARDS], longest)
        tau = tau if s.step(s.rows.t0, tau) and s.complete(s.rows.t0, tau) else UNKNOWN
    else:
        tau = locate(s, g, h, longest)
    if tau == UNKNOWN:
        return NOT_FINITE
    interrupt(s, g // GUARDS, tau)
    take_over(s, min(s.rows.after(tau), border), tau)
    if code != DONE or (tau > 0.0 and of_sliding(s, g) and jumps(s, g, tau)):
        return code  # a jump whose polynomial has been there, not the velocity
    return arrive(s, g)


def complete_to_guard(s: Rubbing) -> int:
    """The step up to the guard of modes that acts; a status."""
    tau = reach_guard(s, s.length)
    interrupt(s, -1, tau)
    take_over(s, min(s.rows.after(tau), s.rows.border()), tau)
    s.rows.next = SWITCH
    return DONE


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


def look_ahead(s: Rubbing, h: float) -> int:
    """The modes just after a force has left its cone, or turned to pulling; a status.

    Rounding of larger forces may hide it for a while: where no mode changes one looks further.
    """
    ahead = LOOK_AHEAD + s.delay
    while True:
        s.at(s.found + ahead, s.seen)
        if not measure(s, s.rows.t0 + (s.found + ahead) * h, s.seen):
            return NOT_FINITE
        find_standing(s)
        code = decide(s)
        if code != DONE or ahead >= FARTHEST or (not mark_undecided(s) and tells(s)):
            break
        ahead *= FURTHER
    hold_modes(s.rows)  # the old ones, for the rest of the step
    return code
