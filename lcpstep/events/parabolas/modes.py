"""What happens at an event, as kernels: impacts, and which contacts stay closed or open.

After an impact the contact forces are sought (`settle`). See `impact`, `forces` and `chatter`.
"""

from __future__ import annotations

import cython

from lcpstep.events.ends import IMPACT, NO_FORCES, NO_IMPULSES, RELEASE, STICK
from lcpstep.kernels.status import BUFFER_FULL, DONE, TOO_MANY_EVENTS

if not cython.compiled:
    from lcpstep.events.parabolas.chatter import close_chatter, hand_on
    from lcpstep.events.parabolas.cycle import fades, look_back, recurrence, sum_up
    from lcpstep.events.parabolas.flight import polish, synchronise
    from lcpstep.events.parabolas.forces import contact_forces, stands
    from lcpstep.events.parabolas.impact import speed_noise, strike
    from lcpstep.events.parabolas.keep import keep_event
    from lcpstep.events.parabolas.motion import rebase, rounding_of_gap
    from lcpstep.events.parabolas.state import JUMP, Mechanism
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.recurrence import FOR_EVER, looks_back
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.together import order_matters
    from lcpstep.pointers import abs, max

ROUNDS = 100_000  # problems of impacts at one instant


def jump(s: Mechanism, record: Record, tally: Tally) -> int:
    """Impacts at the state q, v until no contact that is closed approaches."""
    before = tally.stalled
    for c in range(s.n_c):
        s.contact.terms[c], s.contact.parting[c] = 0.0, 1 if just_opened(s, c) else 0
    for turn in range(ROUNDS):
        if not approaches(s):
            rejoin(s)
            if tally.stalled > before + 1:  # the impacts of one instant count as one
                tally.stalled = before + 1
            return DONE
        if record.event + 4 * s.n_c + 4 > record.event_capacity:
            s.next = JUMP
            return BUFFER_FULL
        if tally.events > tally.max_events:
            return TOO_MANY_EVENTS
        ratio = recurrence(s) if turn > 0 else 0.0
        if ratio >= FOR_EVER:
            if not fades(s):
                return TOO_MANY_EVENTS
        elif ratio > 0.0:
            sum_up(s, record, tally, ratio)
        else:
            if looks_back(turn):
                look_back(s)
            if turn > 0:
                let_go(s)
            if not strike(s):
                return NO_IMPULSES
            tell_impacts(s, record, tally, s.t0)
            synchronise(s)
    return TOO_MANY_EVENTS


def just_opened(s: Mechanism, c: int) -> bool:
    """Whether contact c has struck at this instant, as far as can be told, and the forces have opened it."""
    rises = s.contact.closed[c] == 0 and s.contact.curve[c] > 0.0
    return rises and s.t0 - s.contact.struck[c] <= s.untold(0.0)


def let_go(s: Mechanism) -> None:
    """Between two impacts of one instant: contacts that have landed in the first, and that the forces open, part.

    Time goes on between the two, if by less than can be told; what has parted passes no impulse on until it strikes
    again. So a light body between a wall and a heavy one stops that by ever closer impacts.
    """
    landed = False
    for c in range(s.n_c):
        new = s.contact.closed[c] == 1 and s.contact.was_closed[c] == 0
        landed = landed or (new and s.contact.struck[c] == s.t0)
    if not landed:
        return
    for c in range(s.n_c):
        if s.contact.closed[c] == 1:
            s.contact.parting[c] = 1
    contact_forces(s)
    for c in range(s.n_c):
        if s.contact.closed[c] == 1:
            s.contact.parting[c] = 0


def rejoin(s: Mechanism) -> None:
    """After the last impact of an instant the forces decide anew about the contacts that parted and still touch."""
    for c in range(s.n_c):
        touches = s.contact.gap[c] <= rounding_of_gap(s, c)
        if s.contact.parting[c] == 1 and touches and abs(s.contact.speed[c]) <= speed_noise(s, c):
            s.contact.closed[c], s.contact.speed[c] = 1, 0.0
        s.contact.parting[c] = 0


def approaches(s: Mechanism) -> bool:
    """Whether a contact on the surface approaches it; one there without speed to rounding is closed."""
    hit = False
    for c in range(s.n_c):
        u = s.contact.speed[c]
        if s.contact.closed[c] == 0 and (s.contact.gap[c] == 0.0 or has_come(s, c)):
            noise = speed_noise(s, c)
            if u <= noise:
                s.contact.gap[c] = 0.0
                if u < -noise:
                    s.contact.parting[c] = 0
                elif s.contact.parting[c] == 0:
                    s.contact.closed[c], s.contact.speed[c] = 1, 0.0
                hit = hit or u < -noise
        s.contact.before[c] = s.contact.speed[c]
    return hit


def has_come(s: Mechanism, c: int) -> bool:
    """Whether a gap that is not exactly zero counts as closed: if rounding may be why, and if the order of impacts
    matters: beads that meet by threes are followed one after another, which is exact.
    """
    u, i = s.contact.speed[c], s.n_j + c
    if not u < 0.0 or s.contact.gap[c] > rounding_of_gap(s, c):
        return s.contact.gap[c] < 0.0
    for d in range(s.n_c):
        k, u_d = s.n_j + d, s.contact.speed[d]
        r_c, r_d = s.model.restitution[c], s.model.restitution[d]
        strikes = s.contact.closed[d] == 0 and s.contact.gap[d] == 0.0 and u_d < -speed_noise(s, d)
        if strikes and order_matters(
            s.D[i * s.n_r + i], s.D[k * s.n_r + k], s.D[i * s.n_r + k], r_c, r_d, u, u_d
        ):
            return True
    return False


def tell_impacts(s: Mechanism, record: Record, tally: Tally, t: float) -> None:
    """Log the impacts of the problem just solved; contacts that it leaves without speed are closed."""
    for m in range(s.n_members):
        c, p = s.contact.member[m], s.contact.z[m]
        before, noise = s.contact.before[c], speed_noise(s, c)
        if p > 0.0:
            u = -s.model.restitution[c] * before
            s.log(record, tally, t, c, IMPACT, before, u, p)
            s.contact.since[c], s.contact.struck[c] = t - s.contact.struck[c], t
        else:
            u = s.contact.speed[c]
        s.contact.closed[c] = 0 if u > noise else 1
        s.contact.speed[c] = u if u > noise else 0.0
        s.contact.gap[c] = 0.0


def settle(s: Mechanism, record: Record, tally: Tally) -> int:
    """After a jump: contact forces, contacts that open, chattering that is over."""
    n_c, t = s.n_c, s.t0
    for turn in range(n_c + 1):
        code = forces(s)
        if code != DONE:
            return code
        if turn == n_c or not close_chatter(s, record, tally):
            break
    if tell_modes(s, record, tally, t):
        polish(s)
    rebase(s, t)
    hand_on(s)
    keep_event(s, record, t)
    return DONE


def forces(s: Mechanism) -> int:
    """Accelerations and multipliers; nothing to do where no contact is or was closed."""
    closed = 0
    for c in range(s.n_c):
        closed += s.contact.closed[c]
    if closed == 0 and s.bare:
        return DONE
    code = contact_forces(s)
    if code == DONE:
        s.bare = closed == 0
        code = DONE if stands(s) else NO_FORCES
    return code


def tell_modes(s: Mechanism, record: Record, tally: Tally, t: float) -> bool:
    """Log the contacts that have opened, and those that have closed for good; whether there is one of these."""
    some = False
    for c in range(s.n_c):
        if s.contact.closed[c] != s.contact.was_closed[c]:
            kind = STICK if s.contact.closed[c] == 1 else RELEASE
            some = some or kind == STICK
            when = max(t, s.contact.chatter_end[c]) if kind == STICK else t
            s.log(record, tally, when, c, kind, 0.0, s.contact.speed[c], 0.0)
            s.contact.was_closed[c] = s.contact.closed[c]
    return some
