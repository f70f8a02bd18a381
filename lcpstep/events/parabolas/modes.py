"""What happens at an event, as kernels: impacts, and which contacts stay closed or open.

After an impact the contact forces are sought (`settle`). See `impact` and `forces`; of hops
that no longer matter `events.rows.chatter`.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import IMPACT, JUMP, NO_FORCES, NO_IMPULSES, OPEN, SLIDES
from lcpstep.events.parabolas.flight import polish, rebase, synchronise
from lcpstep.events.parabolas.forces import contact_forces, stands
from lcpstep.events.parabolas.impact import strike
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.rows.chatter import disturbs, find_over, take_along, tell_over
from lcpstep.events.rows.cycle import ROUNDS, close_if_faded, look_back, recurs, sum_up
from lcpstep.events.rows.held import hold_joints, is_held, solve_held
from lcpstep.events.rows.keep import keep_event, put_on_account, tell
from lcpstep.kernels.recurrence import FOR_EVER, looks_back
from lcpstep.kernels.status import BUFFER_FULL, DONE, TOO_MANY_EVENTS
from lcpstep.kernels.together import CROSSED, moment_untold, order_matters
from lcpstep.kernels.vectors import clear
from lcpstep.pointers import abs, max


def jump(s: Mechanism) -> int:
    """Impacts at the state q, v until no closed contact approaches; a full record leaves `rounds` as it is."""
    if s.rounds == 0:
        begin_instant(s)
    while s.rounds < ROUNDS:
        if not close_or_find_approach(s):
            rejoin(s)
            s.rounds = 0
            if s.tally.stalled > s.stalled + 1:  # the impacts of one instant count as one
                s.tally.stalled = s.stalled + 1
            return DONE
        if s.record.event + 4 * s.n_c + 4 > s.record.event_capacity:
            s.next = JUMP
            return BUFFER_FULL
        if s.tally.events > s.tally.max_events:
            return TOO_MANY_EVENTS
        ratio = recurs(s) if s.rounds > 0 else 0.0
        if ratio >= FOR_EVER:
            if not close_if_faded(s):
                return TOO_MANY_EVENTS
        elif ratio > 0.0:
            sum_up(s, ratio)
        else:
            if looks_back(s.rounds):
                look_back(s)
            if s.rounds > 0:
                let_go(s)
            if not strike(s):
                return NO_IMPULSES
            tell_impacts(s)
            synchronise(s)
        s.rounds += 1
    return TOO_MANY_EVENTS


def begin_instant(s: Mechanism) -> None:
    """No impact at this instant yet, but for what has struck a moment ago that cannot be told from it.

    Of that the contacts part that the forces have opened since.
    """
    s.stalled = s.tally.stalled
    for c in range(s.n_c):
        rises = s.mode[c] == OPEN and s.curve[c] > 0.0
        s.terms[c], s.parting[c] = 0.0, 1 if rises and s.t0 - s.struck[c] <= s.untold(0.0) else 0


def let_go(s: Mechanism) -> None:
    """Between two impacts of one instant: contacts that have landed in the first, and that the forces open, part.

    Time goes on between the two, if by less than can be told; what has parted passes no impulse on until it strikes
    again. So a light body between a wall and a heavy one stops that by ever closer impacts.
    """
    landed = False
    for c in range(s.n_c):
        new = s.mode[c] != OPEN and s.was_mode[c] == OPEN
        landed = landed or (new and s.struck[c] == s.t0)
    if not landed:
        return
    for c in range(s.n_c):
        if s.mode[c] != OPEN:
            s.parting[c] = 1
    contact_forces(s)
    for c in range(s.n_c):
        if s.mode[c] != OPEN:
            s.parting[c] = 0


def rejoin(s: Mechanism) -> None:
    """After the last impact of an instant the forces decide anew about the contacts that parted and still touch."""
    for c in range(s.n_c):
        touches = s.parting[c] == 1 and s.gap[s.n_j + c] <= s.rounding_of_gap(c)
        if touches and abs(s.velocity[s.n_j + c]) <= s.noise(c):
            s.mode[c], s.velocity[s.n_j + c] = SLIDES, 0.0
        s.parting[c] = 0


def close_or_find_approach(s: Mechanism) -> bool:
    """Whether a contact on the surface approaches it; one there without speed to rounding is closed."""
    hit = False
    find_come(s)
    for c in range(s.n_c):
        u = s.velocity[s.n_j + c]
        if s.mode[c] == OPEN and s.gap[s.n_j + c] == 0.0:
            noise = s.noise(c)
            if u <= noise:
                if u < -noise:
                    s.parting[c] = 0
                elif s.parting[c] == 0:
                    s.mode[c], s.velocity[s.n_j + c] = SLIDES, 0.0
                hit = hit or u < -noise
        s.before[c] = s.velocity[s.n_j + c]
    return hit


def find_come(s: Mechanism) -> None:
    """Gaps that count as closed are zero; of two that matter to each other by a third one, both."""
    more = True
    while more:
        more = False
        for c in range(s.n_c):
            i = s.n_j + c
            comes = s.velocity[i] < 0.0 or s.gap[i] < 0.0
            if (
                s.mode[c] == OPEN
                and s.gap[i] != 0.0
                and comes
                and s.velocity[i] <= s.noise(c)
                and has_come(s, c)
            ):
                s.gap[i], more = 0.0, True


def has_come(s: Mechanism, c: int) -> bool:
    """Whether a gap that is not exactly zero counts as closed: if rounding may be why, and if the order of impacts
    matters: beads that meet by threes are followed one after another, which is exact.
    """
    u, i = s.velocity[s.n_j + c], s.n_j + c
    if not u < 0.0:
        return s.gap[i] < 0.0
    rounding = s.rounding_of_gap(c)
    if s.gap[i] > CROSSED * rounding:
        return False
    for d in range(s.n_c):
        k, u_d = s.n_j + d, s.velocity[s.n_j + d]
        r_c, r_d = s.model.restitution[c], s.model.restitution[d]
        strikes = s.mode[d] == OPEN and s.gap[s.n_j + d] == 0.0 and u_d < -s.noise(d)
        moment = moment_untold(s.rounding_of_gap(d), u_d, s.t0 - s.struck[d]) if strikes else 0.0
        if strikes and s.gap[i] <= max(rounding, moment * -u):
            W_c, W_d, W_cd = s.D[i * s.n_r + i], s.D[k * s.n_r + k], s.D[i * s.n_r + k]
            if order_matters(W_c, W_d, W_cd, r_c, r_d, u, u_d):
                return True
    return False


def tell_impacts(s: Mechanism) -> None:
    """Log the impacts of the problem just solved; contacts that it leaves without speed are closed."""
    for m in range(s.n_members):
        c, p = s.problem.ids[m], s.problem.impulse[m]
        before, noise = s.before[c], s.noise(c)
        if p > 0.0:
            u = -s.model.restitution[c] * before
            s.log(s.t0, c, before, u, p, IMPACT)
            s.since[c], s.struck[c] = s.t0 - s.struck[c], s.t0
        else:
            u = s.velocity[s.n_j + c]
        s.mode[c] = OPEN if u > noise else SLIDES
        s.velocity[s.n_j + c] = u if u > noise else 0.0
        s.gap[s.n_j + c] = 0.0


def settle(s: Mechanism) -> int:
    """After a jump: contact forces, contacts that open, chattering that is over."""
    n_c, t = s.n_c, s.t0
    for turn in range(n_c + 1):
        code = forces(s)
        if code != DONE:
            return code
        if turn == n_c or not close_chatter(s):
            break
    if tell(s):
        polish(s)
    rebase(s, t)
    hand_on(s)
    keep_event(s, t)
    return DONE


def forces(s: Mechanism) -> int:
    """Accelerations and multipliers; nothing to do where no contact is or was closed."""
    closed = 0
    for c in range(s.n_c):
        closed += s.mode[c]
    if closed == 0 and s.bare:
        hold_joints(s)
        return DONE
    code = contact_forces(s)
    if code == DONE:
        s.bare = closed == 0
        code = DONE if stands(s) else NO_FORCES
    return code


def close_chatter(s: Mechanism) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there was one."""
    if not find_over(s):
        return False
    take_along(s)
    if disturbs(s):
        return False
    for c in range(s.n_c):
        if s.left[c] >= 0.0:
            tell_over(s, c)
            s.mode[c], s.gap[s.n_j + c] = SLIDES, 0.0
    s.halt()
    clear(s.multiplier, s.n_r)
    for m in range(s.n_held):
        s.multiplier[s.row[m]] = s.change[m]
    put_on_account(s)
    return True


def hand_on(s: Mechanism) -> None:
    """What a closed contact still owes goes to the rows held, if it is none: R_c = sum y_m R_m, they bear its force.

    Where y_m < 0 row m has a claim instead, at once. The rows held must be those of the forces just found.
    """
    n_j = s.n_j
    for c in range(s.n_c):
        p = s.impulse[c] + s.owed[c]
        if s.owed[c] < 0.0 and p < 0.0 and s.mode[c] != OPEN and not is_held(s, n_j + c):
            for m in range(s.n_held):
                s.change[m] = s.D[s.row[m] * s.n_r + n_j + c]
            solve_held(s, s.change)
            for m in range(s.n_held):
                share, i = p * s.change[m], s.row[m]
                d = i - n_j
                if i < n_j:
                    s.impulse[s.n_c + i] = s.impulse[s.n_c + i] + share
                elif share > 0.0:
                    s.impulse[d] = s.impulse[d] + share
                else:
                    s.owed[d] = s.owed[d] + share
            s.impulse[c] = s.owed[c] = 0.0
