"""What happens at an event of several contacts, as kernels: impacts, and which contacts stay closed or open.

After an impact, or a corner, the contact forces are sought (`settle`); after a release those that `step.look_ahead`
has found are taken over (`obey`). See `impact`, `forces` and `chatter`.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign
from lcpstep.dynamics import order_matters
from lcpstep.events.bookkeeping import (
    BUFFER_FULL,
    EVENT,
    EVENTS,
    FINISHED,
    IMPACT,
    MAX_EVENTS,
    NOT_FINITE,
    RELEASE,
    STALLED,
    STICK,
    TOO_MANY_EVENTS,
)
from lcpstep.events.clock import T0
from lcpstep.events.several.chatter import close_chatter
from lcpstep.events.several.cycle import FOR_EVER, look_back, recurrence, sum_up
from lcpstep.events.several.equations import measure_again
from lcpstep.events.several.forces import CONTRADICTION, DONE, contact_forces
from lcpstep.events.several.held import constrain, hold_contacts, note
from lcpstep.events.several.impact import speed_noise, strike
from lcpstep.events.several.keep import keep_event, log
from lcpstep.events.several.motion import lift, rebase, touching
from lcpstep.events.several.parabolas import polish, synchronise
from lcpstep.events.several.state import (
    ACCELERATION,
    BARE,
    CHATTERS,
    CLOSED,
    CURVE,
    FREE_ACCELERATION,
    GAP,
    JOINTS_DISAGREE,
    JUMP,
    LCP_Z,
    LEFT_SPEED,
    MEMBERS,
    NEXT,
    NO_FORCES,
    NO_IMPULSES,
    SINCE,
    SPEED,
    STRUCK,
    TERMS,
    WAS_CLOSED,
)

ROUNDS = 100_000  # problems of impacts at one instant


def jump(s: Any, record: Any, count: Any) -> int:
    """Impacts at the state Q, V until no contact that is closed approaches."""
    before = count[STALLED]
    for c in range(len(s.G)):
        s.contact[TERMS, c] = 0.0
    for turn in range(ROUNDS):
        if not approaches(s):
            count[STALLED] = min(count[STALLED], before + 1)  # the impacts of one instant count as one
            return FINISHED
        if count[EVENT] + 4 * len(s.G) + 4 > len(record.events):
            s.number[NEXT] = JUMP
            return BUFFER_FULL
        if count[EVENTS] > count[MAX_EVENTS]:
            return TOO_MANY_EVENTS
        ratio = recurrence(s) if turn > 0 else 0.0
        if ratio >= FOR_EVER:
            return TOO_MANY_EVENTS
        if ratio > 0.0:
            sum_up(s, record, count, ratio)
        else:
            if turn & (turn - 1) == 0:  # Brent's search for a cycle looks back to powers of two
                look_back(s)
            if not strike(s):
                return NO_IMPULSES
            tell_impacts(s, record, count, s.x[T0])
            if s.constant:
                synchronise(s)
    return TOO_MANY_EVENTS


def approaches(s: Any) -> bool:
    """Whether a contact on the surface approaches it; one there without speed to rounding is closed."""
    hit = False
    for c in range(len(s.G)):
        u = s.contact[SPEED, c]
        if s.mode[CLOSED, c] == 0 and (s.contact[GAP, c] == 0.0 or has_come(s, c)):
            noise = speed_noise(s, c)
            if u <= noise:
                if (
                    not s.constant and s.contact[GAP, c] < 0.0
                ):  # lowering one would lift others, and feed their hops
                    lift(s, c)
                s.contact[GAP, c] = 0.0
                if u >= -noise:
                    s.mode[CLOSED, c], s.contact[SPEED, c] = 1, 0.0
                hit = hit or u < -noise
        s.contact[LEFT_SPEED, c] = s.contact[SPEED, c]
    return hit


def has_come(s: Any, c: int) -> bool:
    """Whether a gap that is not exactly zero counts as closed; under constant forces only if rounding may be why.

    And if the order of impacts matters: beads that meet by threes are followed one after another, which is exact.
    """
    if not s.constant:
        return bool(s.contact[GAP, c] <= touching(s, c))
    u, i = s.contact[SPEED, c], len(s.J) + c
    if not u < 0.0 or s.contact[GAP, c] > touching(s, c):
        return bool(s.contact[GAP, c] < 0.0)
    for d in range(len(s.G)):
        k, u_d = len(s.J) + d, s.contact[SPEED, d]
        r_c, r_d = s.model.restitution[c], s.model.restitution[d]
        strikes = s.mode[CLOSED, d] == 0 and s.contact[GAP, d] == 0.0 and u_d < -speed_noise(s, d)
        if strikes and order_matters(s.D[i, i], s.D[k, k], s.D[i, k], r_c, r_d, u, u_d):
            return True
    return False


def tell_impacts(s: Any, record: Any, count: Any, t: float) -> None:
    """Log the impacts of the problem just solved; contacts that it leaves without speed are closed."""
    for m in range(s.number[MEMBERS]):
        c, p = s.member[m], s.contact[LCP_Z, m]
        before, noise = s.contact[LEFT_SPEED, c], speed_noise(s, c)
        if p > 0.0:
            u = -s.model.restitution[c] * before
            log(s, record, count, t, c, float(IMPACT), before, u, p)
            s.contact[SINCE, c], s.contact[STRUCK, c] = t - s.contact[STRUCK, c], t
        else:
            u = s.contact[SPEED, c]
        s.mode[CLOSED, c] = 0 if u > noise else 1
        s.contact[SPEED, c] = u if u > noise else 0.0
        s.contact[GAP, c] = 0.0


def settle(s: Any, record: Any, count: Any) -> int:
    """After a jump: contact forces, contacts that open, chattering that is over."""
    n_c, t = len(s.G), s.x[T0]
    for turn in range(n_c + 1):
        if not s.constant and not measure_again(s, t):
            return NOT_FINITE
        code = forces(s, t)
        if code != FINISHED:
            return code
        if turn == n_c or not close_chatter(s, record, count):
            break
    if tell_modes(s, record, count, t) and s.constant:
        polish(s)
    rebase(s, t)
    keep_event(s, record, count, t)
    return FINISHED


def forces(s: Any, t: float) -> int:
    """Accelerations and multipliers; nothing to do where no contact is or was closed under constant acceleration."""
    closed = 0
    for c in range(len(s.G)):
        closed += s.mode[CLOSED, c]
    if s.constant and closed == 0 and s.x[BARE] == 1.0:
        return FINISHED
    code = contact_forces(s, t)
    if code != DONE:
        return JOINTS_DISAGREE if code == CONTRADICTION else NO_FORCES
    s.x[BARE] = 1.0 if closed == 0 else 0.0
    return FINISHED


def obey(s: Any, record: Any, count: Any) -> None:
    """After a release: the contacts closed and loaded are those that `look_ahead` has found."""
    a, t = s.state[ACCELERATION], s.x[T0]
    assign(a, s.state[FREE_ACCELERATION])
    hold_contacts(s)
    constrain(s, a)
    note(s, a)
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 0 and s.mode[WAS_CLOSED, c] == 1:
            s.contact[GAP, c] = s.contact[SPEED, c] = 0.0
            s.contact[CURVE, c] = max(s.contact[CURVE, c], 0.0)
    tell_modes(s, record, count, t)
    keep_event(s, record, count, t)


def tell_modes(s: Any, record: Any, count: Any, t: float) -> bool:
    """Log the contacts that have opened, and those that have closed for good; whether there is one of these."""
    some = False
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] != s.mode[WAS_CLOSED, c]:
            kind = STICK if s.mode[CLOSED, c] == 1 else RELEASE
            some = some or kind == STICK
            when = max(t, s.contact[CHATTERS, c]) if kind == STICK else t
            log(s, record, count, when, c, float(kind), 0.0, s.contact[SPEED, c], 0.0)
            s.mode[WAS_CLOSED, c] = s.mode[CLOSED, c]
    return some
