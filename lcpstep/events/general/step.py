"""A Runge-Kutta step of a system with contacts and joints, up to the first event within it, as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.general.ends import NO_FORCES, NO_SURFACE
from lcpstep.kernels.status import DONE, JOINTS_FAILED, NOT_FINITE

if not cython.compiled:
    from lcpstep.events.general.earliest import (
        LANDS,
        MEETS,
        NEVER_LEFT,
        NONE,
        OPENS,
        first_event,
        observe,
        turns_unseen,
    )
    from lcpstep.events.general.equations import measure, measure_on
    from lcpstep.events.general.forces import contact_forces
    from lcpstep.events.general.held import note
    from lcpstep.events.general.hops import carry, find_landings, interrupt, reach_end, shortest_hop, speed_at
    from lcpstep.events.general.keep import keep, keep_wanted
    from lcpstep.events.general.motion import arrive, press_between, rebase
    from lcpstep.events.general.state import JUMP, OBEY, SETTLE, SWITCH, Mechanism
    from lcpstep.events.general.switching import SWITCHES, reach_guard, watch
    from lcpstep.events.rows.held import constrain, hold_again, is_held, parted, renew_held
    from lcpstep.events.rows.jumps import breaks
    from lcpstep.events.rows.projection import project
    from lcpstep.kernels.clock import RESOLUTION
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import abs, inf, min

PARTS, MOST_PARTS = 4, 4096  # scan intervals of a step, and where gaps turn faster than the motion
REFINEMENTS, FAR = 3, 1e-3  # of an event's time by repeated steps: how many, and of that time how far at most
LOOK_AHEAD = 1e-6  # of a step: where the forces after a release are looked at
BALANCED = 1e-4  # the same where the multiplier has been no more than this share of what it will be
LOOKS, FURTHER = 6, 10.0  # how often, by how much further each time, unless they tell: to a tenth of a step


def step(s: Mechanism, record: Record, tally: Tally) -> int:
    """One DOP853 step up to the first event within it; none where it has found a corner, at which the next one ends.

    Held by surfaces that become parallel, as between walls that close, a motion has no bounds: no forces keep it so.
    """
    code = stride(s)
    for c in range(s.n_c):
        s.rests[s.n_j + c] = s.contact.closed[c]
    if code == DONE and breaks(s, s.smooth, s.length, False):
        tally.stalled += 1
        return DONE
    code = look(s, s.length) if code == DONE else code
    if code == DONE:
        return complete(s, record, tally)
    squeezed = s.parallel and s.n_held > s.n_kept
    return NO_FORCES if code == NOT_FINITE and squeezed else code


def stride(s: Mechanism) -> int:
    """The step, whatever happens within it; a status."""
    copy(s.left.gap, s.contact.gap, 4 * s.n_c)
    copy(s.start.gap, s.contact.gap, 4 * s.n_c)
    longest = min(s.t_end, s.high) - s.t0
    code = s.smooth.take_step(s.t0, min(min(longest, s.scan), 4.0 * shortest_hop(s)), s.scan)
    if code == DONE:
        s.length = s.smooth.length
    return code


def look(s: Mechanism, h: float) -> int:
    """The first event within the step of size h, which `complete` takes over; a status."""
    s.found, s.seen_to = NONE, 0.0
    find_landings(s, h)
    code = scan(s, h) if s.n_c > 0 else DONE
    return watch(s) if s.watched and code == DONE else code


def scan(s: Mechanism, h: float) -> int:
    """The first event within the step of size h, into `found`; parts in which a gap turns unseen are halved."""
    tau, a, part, parts = NONE, 0.0, 0, PARTS
    while tau == NONE and part < parts:
        b = h * (part + 1) / parts
        if not observe(s, b):
            return NOT_FINITE
        if parts < MOST_PARTS and turns_unseen(s, b - a):
            part, parts = 2 * part, 2 * parts
        else:
            tau = first_event(s, a, b)
            if tau == NONE:
                copy(s.before.gap, s.left.gap, 4 * s.n_c)
                copy(s.left.gap, s.right.gap, 4 * s.n_c)
            a, part = b, part + 1
            while parts > PARTS and part % 2 == 0:
                part, parts = part // 2, parts // 2
    s.found, s.seen_to = tau, a
    return DONE


def complete(s: Mechanism, record: Record, tally: Tally) -> int:
    """Take over the step that has just been made, which ends early if an event was found in it."""
    border, h, tau, end = min(s.t_end, s.high), s.length, s.found, s.seen_to
    if tau == NONE:
        reach_end(s, h)
        t_next = border if h >= border - s.t0 else s.after(h)
        take_over(s, record, tally, t_next, h)
        return pass_end(s, record, tally)
    c, kind, u = s.event_contact, s.event_kind, 0.0
    if kind == SWITCHES:
        return complete_to_guard(s, record, tally)
    if kind == OPENS and not look_ahead(s, c, tau, end):
        return NO_FORCES
    if tau > 0.0:
        tau = shorten(s, tau)
    if kind == LANDS:
        u = speed_at(s, c, tau)
    interrupt(s, c, tau)
    take_over(s, record, tally, min(s.after(tau), border), tau)
    if not measure_on(s, s.t0):
        return NOT_FINITE
    if kind == OPENS:
        carry(s)
        s.next = OBEY
        return DONE
    s.next = JUMP
    if not arrive(s, c):
        return NO_SURFACE
    carry(s)
    if kind == LANDS:
        s.contact.speed[c] = min(u, 0.0)
    elif kind == NEVER_LEFT:
        s.contact.speed[c], s.contact.closed[c], s.contact.held_until[c] = 0.0, 1, s.t0 + end
    return DONE


def complete_to_guard(s: Mechanism, record: Record, tally: Tally) -> int:
    """The same up to the guard that acts."""
    tau = reach_guard(s)
    if tau > 0.0:
        make_dense(s, tau)
        reach_end(s, tau)
    take_over(s, record, tally, min(s.after(tau), min(s.t_end, s.high)), tau)
    if not measure_on(s, s.t0):
        return NOT_FINITE
    if tau > 0.0:
        carry(s)
    s.next = SWITCH
    return DONE


def make_dense(s: Mechanism, tau: float) -> None:
    """Dense output of the step of size tau that has just been made."""
    if s.smooth.complete(s.t0, tau):
        s.length = tau


def shorten(s: Mechanism, tau: float) -> float:
    """Repeat the step up to the event, so that its own end, and not the dense output, meets the surface."""
    tau = s.smooth.meet(s.t0, tau, inf, FAR * tau, REFINEMENTS if s.event_kind == MEETS else 0)
    make_dense(s, tau)
    return tau


def missed(s: Mechanism, tau: float) -> float:
    """How much longer the step just made should have been for its own end to lie on the surface that is met."""
    make_dense(s, tau)
    observe(s, tau)
    g, u = s.contact.gap[s.event_contact], s.contact.speed[s.event_contact]
    longer = -g / u if u < 0.0 else 0.0
    return longer if abs(longer) > 2.0 * RESOLUTION * (abs(s.t0) + tau) else 0.0


def look_ahead(s: Mechanism, c: int, tau: float, end: float) -> bool:
    """Which contacts are closed, and carry a force, just after the multiplier of contact c has turned negative.

    Forces that have balanced at the start of the interval need a while to grow beyond rounding; where nothing opens
    c, nor holds it in its place as the other wall of a slit does, one looks further. Where they press it then, it is
    held up to there: later in the interval it may yet open. Once it opens, others are no longer held for what they
    did beside it. A contact that was not held itself, for its row depends on others, is to open or to be held.
    """
    before, solved, found, seen = s.n_held, True, False, tau
    balanced = s.left.multiplier[c] <= -BALANCED * s.right.multiplier[c]
    ahead = (BALANCED if balanced else LOOK_AHEAD) * s.length
    first, owned = ahead, is_held(s, s.n_j + c)
    for m in range(before):  # the rows held are needed for the rest of the interval
        s.kept[m] = s.row[m]
    for d in range(s.n_c):
        s.left.multiplier[d] = s.contact.closed[d]
    for look in range(LOOKS + 1):
        if solved and not found:
            seen = tau + (ahead if look < LOOKS else first)
            solved = forces_at(s, before, seen, owned)
            found = s.contact.closed[c] == 0 or s.relieved
            ahead = min(ahead * FURTHER, 0.5 * (end - tau))
    if solved and found and any_held(s, s.t0 + seen):
        solved = forces_at(s, before, seen, owned)
    if s.contact.closed[c] == 1:
        s.contact.held_until[c] = s.t0 + (tau + first if s.contact.multiplier[c] > 0.0 else end)
    return solved


def any_held(s: Mechanism, t: float) -> bool:
    """Whether any contact was held beyond the time t, up to which all that are closed now are held."""
    some = False
    for d in range(s.n_c):
        if s.contact.closed[d] == 1 and s.contact.held_until[d] > t:
            s.contact.held_until[d], some = t, True
    return some


def forces_at(s: Mechanism, before: int, ahead: float, owned: bool) -> bool:
    """The same at a time after the base, from the motion with the rows in `kept`, which stay held.

    owned : whether that of the contact of the event is among them
    """
    for d in range(s.n_c):
        s.contact.closed[d] = 1 if s.left.multiplier[d] == 1.0 else 0
    observe(s, ahead)
    t = s.t0 + ahead
    solved = measure(s, t) and contact_forces(s, t) == DONE
    s.relieved = is_held(s, s.n_j + s.event_contact) != owned
    for m in range(before):
        s.row[m] = s.kept[m]
    s.n_held = before
    hold_again(s)
    return solved


def take_over(s: Mechanism, record: Record, tally: Tally, t: float, tau: float) -> None:
    """The motion over the first `tau` of the step is final: its impulses, the states asked for, the next base."""
    tally.steps += 1
    pressed = 0.0
    while record.wants(t, t >= s.t_end):
        wanted = record.awaited() - s.t0
        press_between(s, pressed, wanted)
        pressed = wanted
        keep_wanted(s, record)
    if tau > 0.0:
        press_between(s, pressed, tau)
        record.store(s.smooth.F, s.length)
        copy(s.q, s.smooth.y_new, 2 * s.n_q)
        if s.n_held > 0:
            project(s, t, s.q, s.v)
    else:
        copy(s.q, s.q0, 2 * s.n_q)
    rebase(s, t)


def pass_end(s: Mechanism, record: Record, tally: Tally) -> int:
    """Go on beyond the end of a step without an event, with the same rows held."""
    if not measure_on(s, s.t0):
        return NOT_FINITE
    carry(s)
    s.culprit = parted(s, s.joint.gap, s.q) if s.n_kept < s.n_j else -1
    if s.culprit >= 0:
        return JOINTS_FAILED
    a = s.a
    copy(a, s.a_free, s.n_q)
    if s.n_held > 0:
        if not renew_held(s, s.t0, s.q, s.v):
            s.next = SETTLE
            return DONE
        constrain(s, a, s.bias)
    note(s, a)
    if record.is_due(tally.steps):
        keep(s, record, s.t0)
    return DONE
