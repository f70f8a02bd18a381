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
from lcpstep.events.contacts.modes import adopt_modes, decide, keep_mode, obey, undecided
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.contacts.step import FURTHER, LOOK_AHEAD
from lcpstep.events.contacts.surfaces import come_apart, come_to_rest, contradict, find_closed
from lcpstep.events.contacts.switching import look_at_guards, switch
from lcpstep.events.rows.keep import keep, keep_event
from lcpstep.kernels.course import DUE, Events
from lcpstep.kernels.status import BUFFER_FULL, DONE, JOINTS_FAILED, NOT_FINITE, PAINLEVE_INCONSISTENT
from lcpstep.kernels.vectors import clear, copy, copy_indices
from lcpstep.pointers import Doubles, after, min


class Course(Events):
    """The loop over steps and events of s, a `Rubbing`: what `rows.next` asks for, or else a step of the motion."""

    def __init__(self, s: Rubbing) -> None:
        super().__init__(s.clock, s.clock.record.event_capacity - s.clock.record.event_capacity // 2)
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
        keep(self.s.rows, self.s.clock.t0, self.s.y)


def occur(s: Rubbing) -> int:
    """Do what comes next (`rows.next`), which takes no time, and say what does after it; a status."""
    if s.rows.next == BEGIN:
        return begin(s)
    if s.rows.next == JUMP:
        code = jump(s, s.clock.t0) if come_to_rest(s) else NOT_FINITE
        if code == DONE:
            s.rows.next = SETTLE
        s.guards = ENTERED if s.guards == ENTERED else JUMPED
        return code
    if s.rows.next == SWITCH:
        s.rows.next = JUMP
        return switch(s)
    settles = s.rows.next == SETTLE
    s.rows.next = MOVE
    return settle(s) if settles else obey_found(s)


def yielding(s: Rubbing, code: int) -> int:
    """The same status, but for contacts that jam where that ends in an impact; nothing jams without friction."""
    if code == PAINLEVE_INCONSISTENT and s.n_t == 0:
        return NO_FORCES
    if code == PAINLEVE_INCONSISTENT and s.yields:
        return jam(s, s.clock.t0)
    return code


def go_further(s: Rubbing) -> int:
    """A step of the motion, or what precedes it: a look at guards, the first state kept, a corner; a status."""
    if s.watched and s.guards != LOOKED:
        look_at_guards(s)
        return DONE
    if s.clock.record.row == 0 and s.clock.record.n_times == 0:
        keep(s.rows, s.clock.t0, s.y)
        return DONE
    return turn_corner(s) if s.clock.t0 >= s.clock.high else progress(s)


def progress(s: Rubbing) -> int:
    """One step of the motion, up to an event; those that take no time are counted, for rounding may ask for them."""
    t, steps = s.clock.t0, s.clock.tally.steps
    code = s.proceed()
    s.clock.tally.parts += s.clock.tally.steps == steps
    if code == DONE and s.rows.n_kept < s.n_j and come_apart(s):
        code = JOINTS_FAILED
    s.clock.tally.stalled = s.clock.tally.stalled + 1 if s.clock.t0 - t <= s.moment() else 0
    return code


def begin(s: Rubbing) -> int:
    """The state at the start of the span, where gaps that are zero to rounding or the tolerance are closed."""
    s.clock.find_corners(s.clock.t0)
    if not measure(s, s.clock.t0, s.y):
        return NOT_FINITE
    begin_instant(s)
    find_closed(s)
    s.rows.next = JUMP
    return DONE


def settle(s: Rubbing) -> int:
    """Forces and modes at the base state, where `may_stick` says which contacts do not slide; hops that end."""
    t = s.clock.t0
    for turn in range(s.n_c + 1):
        if not measure(s, t, s.y):
            return NOT_FINITE
        code = seek_modes(s, t)
        if code == DONE:
            code = obey(s, t)
        if code != DONE:
            return code
        if turn == s.n_c or not close_small(s, t):
            break
    return set_out(s, t)


def seek_modes(s: Rubbing, t: float) -> int:
    """New modes at the base state just measured, or a little later where it leaves them open; a status.

    What velocities are known to is that of this instant, and not of states that are looked at further on.
    """
    longest = min(s.scan_length, s.clock.border() - t)
    copy(s.samples, s.terms, 2 * s.n_c)
    code = decide(s)
    if s.rows.n_kept < s.n_j and contradict(s):
        return JOINTS_FAILED
    if code == DONE and opens_any(s):
        code = reconsider(s, t, longest)
    if code == DONE and undecided(s):
        copy_indices(s.tried, s.new_mode, s.n_c)
        copy(after(s.samples, 2 * s.n_c), s.new_direction, s.n_c)
        code = look_on(s, t, longest)
        if code == DONE:
            slide_as_now(s, after(s.samples, 2 * s.n_c))
            tell_left(s, t)
    clear(s.doubt, s.n_r)
    copy(s.terms, s.samples, 2 * s.n_c)
    return code


def look_on(s: Rubbing, t: float, longest: float) -> int:
    """The modes just after the base time, at which the forces leave some of them open; a status.

    A contact whose force begins at zero is decided by the first force that can be told from zero, unless another that
    is pressed now is no longer there, or slips: it does so later, as its own guard says, and decides about all anew.
    """
    ahead = LOOK_AHEAD * longest
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
        open_question = undecided(s)
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


def slide_as_now(s: Rubbing, direction: Doubles) -> None:
    """What begins to slide by the forces of the base state does so in their direction, whenever its load begins."""
    for c in range(s.n_c):
        if s.tried[c] == SLIDES and s.new_mode[c] == SLIDES:
            s.new_direction[c] = direction[c]


def tell_left(s: Rubbing, t: float) -> None:
    """Log as closed what has just come to its surface, is closed there (`tried`), and leaves by a force that begins.

    That it leaves is logged by `obey`.
    """
    for c in range(s.n_c):
        if s.was_mode[c] == OPEN and s.tried[c] != OPEN and s.new_mode[c] == OPEN:
            s.clock.log(t, c, 0.0, s.velocity[s.n_j + c], 0.0, STAYS_CLOSED)
            s.was_mode[c] = SLIDES


def obey_found(s: Rubbing) -> int:
    """Obey the modes that `look_ahead` has found."""
    code = obey(s, s.clock.t0)
    return set_out(s, s.clock.t0) if code == DONE else code


def set_out(s: Rubbing, t: float) -> int:
    """The motion goes on with the modes at hand."""
    find_loose(s)
    if not begin_guards(s, t):
        return NOT_FINITE
    for c in range(s.n_c):
        s.touches[c] = 1 if s.mode[c] != OPEN else 0
    keep_event(s.rows, t)
    return DONE
