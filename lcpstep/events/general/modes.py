"""What happens at an event, as kernels: impacts, and which contacts stay closed or open.

After an impact, or a corner, the contact forces are sought (`settle`); after a release those that `step.look_ahead`
has found are taken over (`obey`). See `impact`, `forces` and `chatter`.
"""

from __future__ import annotations

import cython

from lcpstep.events.general.ends import IMPACT, NO_FORCES, NO_IMPULSES, RELEASE, STICK
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE, TOO_MANY_EVENTS

if not cython.compiled:
    from lcpstep.events.general.balance import balanced_forces
    from lcpstep.events.general.chatter import close_chatter, hand_on
    from lcpstep.events.general.cycle import fades, look_back, recurrence, sum_up
    from lcpstep.events.general.equations import measure_again
    from lcpstep.events.general.forces import contact_forces, stands
    from lcpstep.events.general.held import accelerate
    from lcpstep.events.general.impact import speed_noise, strike
    from lcpstep.events.general.keep import keep_event
    from lcpstep.events.general.motion import lift, rebase, rounding_of_gap
    from lcpstep.events.general.parabolas import polish, synchronise
    from lcpstep.events.general.state import JUMP, Mechanism
    from lcpstep.kernels.clock import RESOLUTION
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
            if turn > 0 and not let_go(s):
                return NOT_FINITE
            if not strike(s):
                return NO_IMPULSES
            tell_impacts(s, record, tally, s.t0)
            if s.constant:
                synchronise(s)
    return TOO_MANY_EVENTS


def just_opened(s: Mechanism, c: int) -> bool:
    """Whether contact c has struck at this instant, as far as can be told, and the forces have opened it.

    It may have struck before in time, but so shortly that it has gained no speed beyond rounding since then.
    """
    if s.contact.closed[c] == 1 or not s.contact.curve[c] > 0.0:
        return False
    since = s.t0 - s.contact.struck[c]
    if since <= 4.0 * RESOLUTION * abs(s.t0):
        return True
    if s.constant or s.contact.gap[c] > rounding_of_gap(s, c):
        return False
    return s.contact.curve[c] * since <= speed_noise(s, c)


def let_go(s: Mechanism) -> bool:
    """Between two impacts of one instant: contacts that have landed in the first, and that the forces open, part.

    Time goes on between the two, if by less than can be told; what has parted passes no impulse on until it strikes
    again. So a light body between a wall and a heavy one stops that by ever closer impacts. False where not finite.
    """
    landed = False
    for c in range(s.n_c):
        new = s.contact.closed[c] == 1 and s.contact.was_closed[c] == 0
        landed = landed or (new and s.contact.struck[c] == s.t0)
    if not landed:
        return True
    if not s.constant and not measure_again(s, s.t0):
        return False
    for c in range(s.n_c):
        if s.contact.closed[c] == 1:
            s.contact.parting[c] = 1
    contact_forces(s, s.t0)
    for c in range(s.n_c):
        if s.contact.closed[c] == 1:
            s.contact.parting[c] = 0
    return True


def rejoin(s: Mechanism) -> None:
    """After the last impact of an instant the forces decide anew about the contacts that parted and still touch."""
    for c in range(s.n_c):
        touches = s.contact.gap[c] <= rounding_of_gap(s, c)  # a reset may have put it elsewhere
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
                if (
                    not s.constant and s.contact.gap[c] < 0.0
                ):  # lowering would lift others, and feed their hops
                    lift(s, c)
                s.contact.gap[c] = 0.0
                if u < -noise:
                    s.contact.parting[c] = 0
                elif s.contact.parting[c] == 0:
                    s.contact.closed[c], s.contact.speed[c] = 1, 0.0
                hit = hit or u < -noise
        s.left.speed[c] = s.contact.speed[c]
    return hit


def has_come(s: Mechanism, c: int) -> bool:
    """Whether a gap that is not exactly zero counts as closed: if rounding may be why, and, under constant forces, if
    the order of impacts matters: beads that meet by threes are followed one after another, which is exact.
    """
    if not s.constant:
        return s.contact.gap[c] <= rounding_of_gap(s, c)
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
        before, noise = s.left.speed[c], speed_noise(s, c)
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
        if not s.constant and not measure_again(s, t):
            return NOT_FINITE
        code = forces(s, t)
        if code != DONE:
            return code
        if turn == n_c or not close_chatter(s, record, tally):
            break
    if tell_modes(s, record, tally, t) and s.constant:
        polish(s)
    rebase(s, t)
    hand_on(s)
    keep_event(s, record, t)
    return DONE


def forces(s: Mechanism, t: float) -> int:
    """Accelerations and multipliers; nothing to do where no contact is or was closed under constant acceleration."""
    closed = 0
    for c in range(s.n_c):
        closed += s.contact.closed[c]
    if s.constant and closed == 0 and s.bare:
        return DONE
    code = contact_forces(s, t) if s.constant else balanced_forces(s, t)
    if code == DONE:
        s.bare = closed == 0
        code = NO_FORCES if s.constant and not stands(s) else DONE
    return code


def obey(s: Mechanism, record: Record, tally: Tally) -> None:
    """After a release: the contacts closed and loaded are those that `look_ahead` has found."""
    t = s.t0
    accelerate(s)
    for c in range(s.n_c):
        if s.contact.closed[c] == 0 and s.contact.was_closed[c] == 1:
            s.contact.gap[c] = s.contact.speed[c] = 0.0
            s.contact.curve[c] = max(s.contact.curve[c], 0.0)
    tell_modes(s, record, tally, t)
    hand_on(s)
    keep_event(s, record, t)


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
