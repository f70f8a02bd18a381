"""The event-driven loop for any number of contacts and joints, with friction or without, as kernels.

Between events every contact is open, sticks or slides in one direction, and the motion is smooth (`held`); a guard
that falls through zero ends that (`guards`). Contacts that meet strike (`impact`), then the forces decide about the
modes that follow (`modes`). Without friction there are no tangents, and what is closed slides. Systems that have
modes of their own: `switching`. Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley
1996).
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import (
    BEGIN,
    ENTERED,
    JUMP,
    JUMPED,
    LOOKED,
    MOVE,
    NO_FORCES,
    OPEN,
    SETTLE,
    SLIDES,
    STAYS_CLOSED,
    SWITCH,
)
from lcpstep.events.contacts.balance import changes_any, opens_any, reconsider
from lcpstep.events.contacts.chatter import close_small
from lcpstep.events.contacts.corners import turn_corner
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.guards import begin_guards
from lcpstep.events.contacts.impact import begin_instant, jump
from lcpstep.events.contacts.jamming import jam
from lcpstep.events.contacts.loose import find_loose
from lcpstep.events.contacts.modes import adopt_modes, decide, keep_mode, mark_undecided, obey
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.contacts.step import FURTHER, LOOK_AHEAD
from lcpstep.events.contacts.surfaces import come_to_rest, find_closed
from lcpstep.events.contacts.switching import look_at_guards, switch
from lcpstep.events.rows.held import contradiction, parted
from lcpstep.events.rows.keep import keep, keep_event
from lcpstep.kernels.course import DUE, Events
from lcpstep.kernels.dynamics import gaps
from lcpstep.kernels.status import BUFFER_FULL, DONE, JOINTS_FAILED, NOT_FINITE, PAINLEVE_INCONSISTENT
from lcpstep.kernels.vectors import clear, copy, copy_indices
from lcpstep.pointers import Doubles, after, min


class Course(Events):
    """The loop over steps and events of s, a `Rubbing`: what `rows.next` asks for, or else a step of the motion."""

    def __init__(self, s: Rubbing) -> None:
        super().__init__(s.rows, s.rows.record.event_capacity - s.rows.record.event_capacity // 2)
        self.s = s

    def stage(self, goal: int) -> int:
        """Whether there is an event, or the motion goes on."""
        if self.s.rows.next != MOVE:
            return DUE
        return self.ahead(self.clock.t0, self.clock.tally.steps + self.clock.tally.parts, goal)

    def happen(self) -> int:
        """The event, or what follows from it; a status."""
        code = yielding(self.s, occur(self.s))
        if code == BUFFER_FULL and self.s.rows.next == MOVE:  # for the impact of one that jams
            self.s.rows.next = SETTLE
        return code

    def move(self) -> int:
        """A step of the motion, or what precedes it, and the impact of what jams; a status."""
        return yielding(self.s, go_further(self.s))

    @cython.ccall
    def keep_now(self) -> None:
        """Keep the state at the base time, called from Python."""
        keep(self.s.rows, self.s.rows.t0, self.s.y)


def occur(s: Rubbing) -> int:
    """Do what comes next (`rows.next`), which takes no time, and say what does after it; a status."""
    if s.rows.next == BEGIN:
        return begin(s)
    if s.rows.next == JUMP:
        code = jump(s) if come_to_rest(s) else NOT_FINITE
        if code == DONE:
            s.rows.next = SETTLE
        s.since_look = ENTERED if s.since_look == ENTERED else JUMPED
        return code
    if s.rows.next == SWITCH:
        s.rows.next = JUMP
        return switch(s)
    settles = s.rows.next == SETTLE
    s.rows.next = MOVE
    code = settle(s) if settles else obey(s)
    return set_out(s) if code == DONE else code


def yielding(s: Rubbing, code: int) -> int:
    """The same status, but for contacts that jam where that ends in an impact; nothing jams without friction."""
    if code == PAINLEVE_INCONSISTENT and s.n_t == 0:
        return NO_FORCES
    if code == PAINLEVE_INCONSISTENT and s.yields:
        return jam(s)
    return code


def go_further(s: Rubbing) -> int:
    """A step of the motion, or what precedes it: a look at guards, the first state kept, a corner; a status."""
    if s.watch is not None and s.since_look != LOOKED:
        look_at_guards(s)
        return DONE
    if s.rows.record.row == 0 and s.rows.record.n_times == 0:
        keep(s.rows, s.rows.t0, s.y)
        return DONE
    return turn_corner(s) if s.rows.t0 >= s.rows.high else progress(s)


def progress(s: Rubbing) -> int:
    """One step of the motion, up to an event; those that take no time are counted, for rounding may ask for them."""
    t, steps = s.rows.t0, s.rows.tally.steps
    code = s.proceed()
    s.rows.tally.parts += s.rows.tally.steps == steps
    if code == DONE and s.rows.n_kept < s.n_j:
        gaps(s.rows.joints, s.rows.t0, s.q, s.v, s.gap)
        i = parted(s.rows, s.gap, s.q)
        if i >= 0:
            s.rows.culprit, code = i, JOINTS_FAILED
    s.rows.tally.stalled = s.rows.tally.stalled + 1 if s.rows.t0 - t <= s.no_time() else 0
    return code


def begin(s: Rubbing) -> int:
    """The state at the start of the span, where gaps that are zero to rounding or the tolerance are closed."""
    s.rows.find_corners(s.rows.t0)
    if not measure(s, s.rows.t0, s.y):
        return NOT_FINITE
    begin_instant(s)
    find_closed(s)
    s.rows.next = JUMP
    return DONE


def settle(s: Rubbing) -> int:
    """Forces and modes at the base state, where `may_stick` says which contacts do not slide; hops that end."""
    for turn in range(s.n_c + 1):
        if not measure(s, s.rows.t0, s.y):
            return NOT_FINITE
        code = seek_modes(s)
        if code == DONE:
            code = obey(s)
        if code != DONE:
            return code
        if turn == s.n_c or not close_small(s):
            break
    return DONE


def seek_modes(s: Rubbing) -> int:
    """New modes at the base state just measured, or a little later where it leaves them open; a status.

    What velocities are known to is that of this instant, and not of states that are looked at further on.
    """
    longest = min(s.scan_length, s.rows.border() - s.rows.t0)
    copy(s.samples, s.terms, 2 * s.n_c)
    code = decide(s)
    i = contradiction(s.rows, s.a) if s.rows.n_kept < s.n_j else -1
    if i >= 0:
        s.rows.culprit = i
        return JOINTS_FAILED
    if code == DONE and opens_any(s):
        code = reconsider(s, longest)
    if code == DONE and mark_undecided(s):
        copy_indices(s.tried, s.new_mode, s.n_c)
        copy(after(s.samples, 2 * s.n_c), s.new_direction, s.n_c)
        code = look_on(s, longest)
        if code == DONE:
            add_what_is_now(s, after(s.samples, 2 * s.n_c))
    clear(s.unsure, s.n_r)
    copy(s.terms, s.samples, 2 * s.n_c)
    return code


def look_on(s: Rubbing, longest: float) -> int:
    """The modes just after the base time, at which the forces leave some of them open; a status.

    A contact whose force begins at zero is decided by the first force that can be told from zero, unless another that
    is pressed now is no longer there, or slips: it does so later, as its own guard says, and decides about all anew.
    """
    t, ahead = s.rows.t0, LOOK_AHEAD * longest
    while 0.0 < ahead <= longest:
        s.rows.culprit = -1
        code = adopt_modes(s)
        if code != DONE:
            return code
        if not (s.rates(t, s.y, s.K) and s.step(t, ahead) and measure(s, t + ahead, s.y_new)):
            return PAINLEVE_INCONSISTENT if s.rows.culprit >= 0 else NOT_FINITE
        code = decide(s)
        if code != DONE:
            return code
        open_question = mark_undecided(s)
        if changes_any(s):
            for c in range(s.n_c):
                keep_mode(s, c)
            break
        if not open_question:
            break
        ahead *= FURTHER
    code = adopt_modes(s)
    copy_indices(s.new_mode, s.mode, s.n_c)
    if code != DONE:
        return code
    return DONE if measure(s, t, s.y) else NOT_FINITE


def add_what_is_now(s: Rubbing, direction: Doubles) -> None:
    """Add what the base state says (`tried`, `direction`) to the modes a little later.

    What begins to slide by its forces does so in their direction, whenever the load begins. What has just come to its
    surface, is closed there, and leaves by a force that begins, is logged as closed; that it leaves logs `obey`.
    """
    for c in range(s.n_c):
        if s.tried[c] == SLIDES and s.new_mode[c] == SLIDES:
            s.new_direction[c] = direction[c]
        if s.was_mode[c] == OPEN and s.tried[c] != OPEN and s.new_mode[c] == OPEN:
            s.rows.log(s.rows.t0, c, 0.0, s.velocity[s.n_j + c], 0.0, STAYS_CLOSED)
            s.was_mode[c] = SLIDES


def set_out(s: Rubbing) -> int:
    """The motion goes on with the modes at hand."""
    find_loose(s)
    if not begin_guards(s):
        return NOT_FINITE
    for c in range(s.n_c):
        s.touches[c] = 1 if s.mode[c] != OPEN else 0
    keep_event(s.rows, s.rows.t0)
    return DONE
