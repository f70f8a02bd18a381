"""Chattering that is over, as kernels: contacts whose further impacts stay below the tolerance are closed.

Hops under a pressing acceleration alpha accumulate after T = 2 u / (|alpha| (1 - r)); they are left out when no
higher than the tolerance, and when nothing else happens before T to what the contact is connected with: closed, it
answers another impact in another way than in flight, and its own may throw a contact off that rests. Closing takes
the speed u, by an impulse that the contact force up to T pays for, and that contacts bear which stay closed. Hops as
slow as the tolerance are left out too, elastic ones as well, and impacts of contacts that nothing presses (inelastic
collapse) when they have both a speed and a way below it, together with those of the contacts that they alternate
with: one that struck another at rest would leave it, and nothing would bring it back before the next blow.
Source: A. Nordmark, P. Piiroinen, Simulation and stability analysis of impacting systems with complete chattering,
Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

import cython

from lcpstep.events.ends import ACCUMULATION

if not cython.compiled:
    from lcpstep.events.parabolas.equations import gap_tolerance, speed_tolerance
    from lcpstep.events.parabolas.held import hold_contacts
    from lcpstep.events.parabolas.impact import apply, speed_noise
    from lcpstep.events.parabolas.problem import CHECKED
    from lcpstep.events.parabolas.state import Mechanism
    from lcpstep.events.rows.held import constrain, is_held, solve_held
    from lcpstep.kernels.quadratic import accumulation, first_zero
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import clear, copy, largest
    from lcpstep.pointers import abs, max


def close_chatter(s: Mechanism, record: Record, tally: Tally) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there was one."""
    n_c, t, some = s.n_c, s.t0, False
    for c in range(n_c):
        moved = s.contact.struck[c] == t or s.contact.was_closed[c] == 1  # struck, or driven off by another
        s.contact.rest[c] = -1.0
        if s.contact.closed[c] == 0 and s.contact.gap[c] == 0.0 and moved:
            s.contact.rest[c] = chatter_left(s, c)
            some = some or s.contact.rest[c] >= 0.0
    if not some:
        return False
    take_along(s)
    for c in range(n_c):
        touches = s.contact.closed[c] == 0 and s.contact.gap[c] == 0.0
        if touches and s.contact.speed[c] == 0.0:  # those just opened by the forces meet other forces now
            s.contact.rest[c] = 0.0
        if s.contact.rest[c] >= 0.0:
            s.contact.closed[c] = 1
    let_go_pulling(s)
    if throws_off(s) or drives_others(s):
        for c in range(n_c):
            if s.contact.rest[c] >= 0.0:
                s.contact.closed[c] = 0
        hold_contacts(s)
        copy(s.trial, s.a_free, s.n_q)
        constrain(s, s.trial, s.bias)
        return False
    for c in range(n_c):
        T, u, alpha = s.contact.rest[c], s.contact.speed[c], s.contact.curve[c]
        if T >= 0.0:
            s.contact.gap[c] = 0.0
        if T >= 0.0 and u != 0.0:
            p = max(-alpha * T - u, 0.0) / s.D[(s.n_j + c) * s.n_r + s.n_j + c]
            s.log(record, tally, t + T, c, ACCUMULATION, -abs(u), 0.0, p)
            s.contact.chatter_end[c] = t + T
    stop(s)
    owe(s)
    return True


def find_stop(s: Mechanism) -> None:
    """The impulses that take their speeds from the closed contacts, into `change`."""
    n_j = s.n_j
    hold_contacts(s)
    for m in range(s.n_held):
        i = s.row[m]
        s.change[m] = 0.0 if i < n_j else -s.contact.speed[i - n_j]
    solve_held(s, s.change)


def stop(s: Mechanism) -> None:
    """Take their speeds from the closed contacts."""
    find_stop(s)
    apply(s)
    for c in range(s.n_c):
        if s.contact.closed[c] == 1:
            s.contact.speed[c] = 0.0


def let_go_pulling(s: Mechanism) -> None:
    """Hold the closed contacts; of those just opened by the forces only what those of the others now press.

    One that would have to pull leaves while the others hop, and bears none of the impulses that stop them.
    """
    pulls = True
    while pulls:
        pulls = False
        hold_contacts(s)
        copy(s.trial, s.a_free, s.n_q)
        constrain(s, s.trial, s.bias)
        rounding = CHECKED * largest(s.held, 0.0, s.n_held)
        for m in range(s.n_held):
            c = s.row[m] - s.n_j
            opened = c >= 0 and s.contact.rest[c] >= 0.0 and s.contact.speed[c] == 0.0
            if opened and s.held[m] < -rounding and not pulls:
                s.contact.closed[c], s.contact.rest[c], pulls = 0, -1.0, True


def throws_off(s: Mechanism) -> bool:
    """Whether the impacts left out would throw a closed contact off, by hops that the tolerance does not leave out.

    Held, it would have to pull with the impulse x that `find_stop`, which turns the impacts' effect round, has it
    push with. Let go, it leaves at w = x / d, d its entry of D^-1, and the force that presses it brings it back with
    lambda / d: no higher than w^2 d / (2 lambda).
    """
    n_j = s.n_j
    find_stop(s)
    for m in range(s.n_held):
        c = s.row[m] - n_j
        if c >= 0 and s.contact.rest[c] < 0.0 and s.change[m] > 0.0:
            x, force, unit = s.change[m], max(s.held[m], 0.0), s.trial
            clear(unit, s.n_held)
            unit[m] = 1.0
            solve_held(s, unit)
            low = x * x <= 2.0 * force * unit[m] * gap_tolerance(s, c)
            if not low and x > speed_noise(s, c) * unit[m]:
                return True
    return False


def drives_others(s: Mechanism) -> bool:
    """Whether the impulses of `find_stop` would drive an open contact that touches onto its surface."""
    for c in range(s.n_c):
        if s.contact.closed[c] == 0 and s.contact.gap[c] == 0.0:
            u = s.contact.speed[c]
            for m in range(s.n_held):
                u += s.D[(s.n_j + c) * s.n_r + s.row[m]] * s.change[m]
            if u < -speed_tolerance(s, c):
                return True
    return False


def owe(s: Mechanism) -> None:
    """What a stop has left of negative impulses is to be paid by later ones of the same contacts."""
    for c in range(s.n_c):
        if s.contact.closed[c] == 1 and s.contact.impulse[c] < 0.0:
            s.contact.owed[c] = s.contact.owed[c] + s.contact.impulse[c]
            s.contact.impulse[c] = 0.0


def hand_on(s: Mechanism) -> None:
    """What a closed contact still owes goes to the rows held, if it is none: R_c = sum y_m R_m, they bear its force.

    Where y_m < 0 row m has a claim instead, at once. The rows held must be those of the forces just found.
    """
    n_j = s.n_j
    for c in range(s.n_c):
        p = s.contact.impulse[c] + s.contact.owed[c]
        if s.contact.owed[c] < 0.0 and p < 0.0 and s.contact.closed[c] == 1 and not is_held(s, n_j + c):
            for m in range(s.n_held):
                s.change[m] = s.D[s.row[m] * s.n_r + n_j + c]
            solve_held(s, s.change)
            for m in range(s.n_held):
                share, i = p * s.change[m], s.row[m]
                d = i - n_j
                if i < n_j:
                    s.joint.impulse[i] = s.joint.impulse[i] + share
                elif share > 0.0:
                    s.contact.impulse[d] = s.contact.impulse[d] + share
                else:
                    s.contact.owed[d] = s.contact.owed[d] + share
            s.contact.impulse[c] = s.contact.owed[c] = 0.0


def chatter_left(s: Mechanism, c: int) -> float:
    """How long the impacts of contact c that are left out would last, or -1 if they may not be.

    Pressed by alpha < 0 they accumulate after 2 u / (|alpha| (1 - r)), no hop being higher than u^2 / (2 |alpha|).
    """
    u, alpha, r = s.contact.speed[c], s.contact.curve[c], s.model.restitution[c]
    if u == 0.0:  # opened by the forces
        return -1.0
    tolerance, slow = gap_tolerance(s, c), abs(u) <= speed_tolerance(s, c)
    low = alpha < 0.0 and u * u <= -2.0 * alpha * tolerance
    if slow and low:
        return 0.0
    if r == 1.0 or u < 0.0:
        return -1.0
    if abs(alpha) * s.contact.since[c] <= speed_noise(s, c):  # an inelastic collapse
        return 0.0 if slow and u * s.contact.since[c] <= tolerance and not awaits(s, c) else -1.0
    if not low:
        return -1.0
    T = accumulation(u, alpha, r)
    return -1.0 if s.t0 + T > s.t_end or interrupted(s, c, T) else T


def take_along(s: Mechanism) -> None:
    """Of a collapse that is over those contacts too that are on their way to their next impact in it."""
    for c in range(s.n_c):
        if s.contact.rest[c] == 0.0 and s.contact.gap[c] == 0.0:
            for d in range(s.n_c):
                if s.contact.rest[d] < 0.0 and alternates(s, c, d) and not is_told(s, d):
                    s.contact.rest[d] = 0.0


def awaits(s: Mechanism, c: int) -> bool:
    """Whether a contact that alternates with contact c in its collapse is still too fast to be closed with it."""
    fast = False
    for d in range(s.n_c):
        fast = fast or (alternates(s, c, d) and is_told(s, d))
    return fast


def is_told(s: Mechanism, d: int) -> bool:
    """Whether contact d, on its way to an impact, has a speed or a way above the tolerance."""
    return -s.contact.speed[d] > speed_tolerance(s, d) or s.contact.gap[d] > gap_tolerance(s, d)


def alternates(s: Mechanism, c: int, d: int) -> bool:
    """Whether contact d, which nothing presses, strikes before contact c, which has just struck, does so again."""
    g, u, since = s.contact.gap[d], s.contact.speed[d], max(s.contact.since[c], s.untold(0.0))
    if d == c or s.contact.closed[d] == 1 or not (g > 0.0 and u < 0.0 and g <= -u * since):
        return False
    free = abs(s.contact.curve[d]) * since <= speed_noise(s, d)
    return free and (passes_on(s, c) or s.D[(s.n_j + c) * s.n_r + s.n_j + d] != 0.0)


def passes_on(s: Mechanism, c: int) -> bool:
    """Whether joints or closed contacts pass impulses of contact c on."""
    for i in range(s.n_j + s.n_c):
        held = i < s.n_j or s.contact.closed[i - s.n_j] == 1
        if held and s.D[(s.n_j + c) * s.n_r + i] != 0.0:
            return True
    return False


def interrupted(s: Mechanism, c: int, T: float) -> bool:
    """Whether a contact that impacts connect with contact c closes within the time T."""
    n_j, passed_on = s.n_j, passes_on(s, c)
    for d in range(s.n_c):
        if d != c and s.contact.closed[d] == 0 and (passed_on or s.D[(n_j + c) * s.n_r + n_j + d] != 0.0):
            g, u, alpha = s.contact.gap[d], s.contact.speed[d], s.contact.curve[d]
            if (g > 0.0 or u > 0.0) and first_zero(g, u, 0.5 * alpha) < T:
                return True
    return False
