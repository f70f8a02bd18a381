"""Chattering that is over, as kernels: contacts whose further impacts stay below the tolerance are closed.

Hops under a pressing acceleration alpha accumulate after T = 2 u / (|alpha| (1 - r)); they are left out when no
higher than the tolerance, and when nothing else happens before T to what the contact is connected with: closed, it
answers another impact in another way than in flight, its own may throw a contact off that rests, and one that slides
may stop between them. Closing takes the speed u, with the friction that belongs to it, by an impulse that the contact
force up to T pays for. Hops as slow as the tolerance are left out too, elastic ones as well, and impacts of contacts
that nothing presses (inelastic collapse) when they have both a speed and a way below it, together with those of the
contacts that they alternate with: one that struck another at rest would leave it, and nothing would bring it back
before the next blow.
Source: A. Nordmark, P. Piiroinen, Simulation and stability analysis of impacting systems with complete chattering,
Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

import cython

from lcpstep.events.contacts.codes import ACCUMULATION, OPEN, SLIDES

if not cython.compiled:
    from math import sqrt

    from lcpstep.events.contacts.closing import close, mode_closed
    from lcpstep.events.contacts.equations import (
        gap_tolerance,
        measure,
        rounding_of_gap,
        rubs,
        sliding,
        speed_tolerance,
    )
    from lcpstep.events.contacts.held import accelerate_as_held, hold_modes, know_rows
    from lcpstep.events.contacts.impact import find_free, still
    from lcpstep.events.contacts.state import Rubbing
    from lcpstep.events.rows.equations import least_effect
    from lcpstep.events.rows.held import constrain, solve_held
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.quadratic import accumulation, first_zero
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import clear, copy, largest, product
    from lcpstep.pointers import abs, after, max, min, nan

CHECKED = 1e-10  # of the largest force: a pull that is no rounding


def close_small(s: Rubbing, record: Record, tally: Tally, t: float) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there were any.

    Modes must be obeyed, everything measured at the base.
    """
    copy(s.a, s.a_free, s.n_q)
    constrain(s.rows, s.a, s.bias)
    some = False
    for c in range(s.n_c):
        i = s.n_j + c
        s.curve[c], s.left[c] = product(s.R, s.a, i, s.n_q) + s.bias[i], -1.0
    for c in range(s.n_c):
        if s.mode[c] == OPEN and s.touches[c] == 1:
            s.left[c] = time_left(s, c, t)
            some = some or s.left[c] >= 0.0
    if not some:
        return False
    take_along(s)
    if disturbs(s):
        return False
    for c in range(s.n_c):
        i = s.n_j + c
        if s.left[c] >= 0.0:
            u, alpha = s.velocity[i], s.curve[c]
            p = max(-alpha * s.left[c] - u, 0.0) / s.W[i * s.n_r + i]
            s.chatter_end[c] = t + s.left[c]
            if abs(u) > s.terms[c]:
                s.clock.log(record, tally, s.chatter_end[c], c, ACCUMULATION, -abs(u), 0.0, p)
            close(s, c, rests(s, c))
    join(s)
    return True


def rests(s: Rubbing, c: int) -> bool:
    """Whether contact c slides by no more than forces make within hops that are left out: that goes with these.

    It matters where what slides has less friction than what sticks, and would go on. Not where others hop on.
    """
    i = s.n_j + s.n_c + c
    if not (rubs(s, c) and s.mu_s[c] > s.mu[c]):
        return False
    pull = abs(product(s.R, s.a, i, s.n_q) + s.bias[i])
    most = sqrt(2.0 * pull * least_effect(s.rows, i, s.q))
    if abs(sliding(s, c)) > max(most, still(s, i)):
        return False
    return pull == 0.0 or not interrupted(s, c, most / pull)


def join(s: Rubbing) -> None:
    """The forces decide about those too that touch and that the others, closed, have left without speed."""
    for c in range(s.n_c):
        if s.mode[c] == OPEN and s.touches[c] == 1 and abs(s.velocity[s.n_j + c]) <= s.terms[c]:
            s.mode[c] = SLIDES
    find_free(s)


def time_left(s: Rubbing, c: int, t: float) -> float:
    """How long the impacts of contact c that are left out would last, or -1 if they may not be.

    Pressed by alpha < 0 they accumulate after 2 u / (|alpha| (1 - r)), no hop being higher than u^2 / (2 |alpha|).
    """
    i = s.n_j + c
    u, alpha, r = s.velocity[i], s.curve[c], s.model.restitution[c]
    if abs(u) <= s.terms[c]:  # opened by the forces
        return -1.0
    tolerance, slow = gap_tolerance(s, c), abs(u) <= speed_tolerance(s, i)
    low = alpha < 0.0 and u * u <= -2.0 * alpha * tolerance
    if slow and low:
        return 0.0
    if r == 1.0 or u < 0.0:
        return -1.0
    if abs(alpha) * s.since[c] <= s.terms[c]:  # an inelastic collapse
        return 0.0 if slow and u * s.since[c] <= tolerance and not awaits(s, c) else -1.0
    if not low:
        return -1.0
    T = accumulation(u, alpha, r)
    if t + T > min(s.clock.high, s.t_end):
        return -1.0
    if interrupted(s, c, T) or stops_others(s, c, T):
        # of hops lower than the rounding of what others are lifted by none is left to be told
        return 0.0 if u * u <= -2.0 * alpha * rounding_of_gap(s, c) else -1.0
    change = abs(later(s, c, t, T) - alpha)
    # the end is then off by T change / |alpha|, in which the gap's terms move by no more than the tolerance
    speed = max(s.terms[c] / NOISE, -alpha * s.scan_length)
    return T if change * T * speed <= -alpha * tolerance else -1.0


def later(s: Rubbing, c: int, t: float, T: float) -> float:
    """Gap acceleration of contact c at the time T from now, along the tangent of the motion."""
    n, i, curve = s.n_q, s.n_j + c, nan
    q, v = s.seen, after(s.seen, n)
    for j in range(n):
        q[j] = s.q[j] + T * s.v[j]
        v[j] = s.v[j] + T * s.a[j]
    if know_rows(s, t + T, s.seen, s.dy):
        curve = product(s.R, after(s.dy, n), i, n) + s.bias[i]
    measure(s, t, s.y)
    hold_modes(s)
    return curve


def interrupted(s: Rubbing, c: int, T: float) -> bool:
    """Whether a contact that impacts connect with contact c closes within the time T."""
    passed_on = passes_on(s, c)
    for d in range(s.n_c):
        if d != c and s.mode[d] == OPEN and (passed_on or meets(s, c, s.n_j + d)):
            g, u = gap_of(s, d), s.velocity[s.n_j + d]
            if (g > 0.0 or u > s.terms[d]) and first_zero(g, u, 0.5 * s.curve[d]) < T:
                return True
    return False


def stops_others(s: Rubbing, c: int, T: float) -> bool:
    """Whether a contact that impacts connect with contact c, and that slides, comes to rest within the time T.

    Each impact may set it in motion again: it has less friction than one that slides on. Not where the next one would
    leave it with sliding that cannot be told from none: stopped by that, it would feed the hops.
    """
    passed_on = passes_on(s, c)
    for d in range(s.n_c):
        k, slip = s.n_j + s.n_c + d, sliding(s, d)
        if d != c and s.mode[d] == SLIDES and rubs(s, d) and (passed_on or meets(s, c, k)):
            stops = slip * (slip + T * (product(s.R, s.a, k, s.n_q) + s.bias[k])) < 0.0
            if stops and s.model.restitution[c] * abs(slip) > still(s, k):
                return True
    return False


def gap_of(s: Rubbing, d: int) -> float:
    """The gap of open contact d: zero where it touches."""
    return 0.0 if s.touches[d] == 1 else s.gap[s.n_j + d]


def meets(s: Rubbing, c: int, k: int) -> bool:
    """Whether impulses of contact c, with their friction, change the velocity of row k."""
    i = s.n_j + c
    rubbed = rubs(s, c) and s.W[(i + s.n_c) * s.n_r + k] != 0.0
    return rubbed or s.W[i * s.n_r + k] != 0.0


def passes_on(s: Rubbing, c: int) -> bool:
    """Whether joints or closed contacts pass impulses of contact c on."""
    found = False
    for m in range(s.rows.n_held):
        found = found or meets(s, c, s.rows.row[m])
    return found


def take_along(s: Rubbing) -> None:
    """Of a collapse that is over those contacts too that are on their way to their next impact in it.

    So are contacts that the forces have just opened: they meet other forces now.
    """
    for c in range(s.n_c):
        if s.left[c] == 0.0 and s.touches[c] == 1:
            for d in range(s.n_c):
                if s.left[d] < 0.0 and alternates(s, c, d) and not is_told(s, d):
                    s.left[d] = 0.0
    for c in range(s.n_c):
        if s.mode[c] == OPEN and s.touches[c] == 1 and abs(s.velocity[s.n_j + c]) <= s.terms[c]:
            s.left[c] = 0.0


def awaits(s: Rubbing, c: int) -> bool:
    """Whether a contact that alternates with contact c in its collapse is still too fast to be closed with it."""
    fast = False
    for d in range(s.n_c):
        fast = fast or (alternates(s, c, d) and is_told(s, d))
    return fast


def is_told(s: Rubbing, d: int) -> bool:
    """Whether contact d, on its way to an impact, has a speed or a way above the tolerance."""
    return -s.velocity[s.n_j + d] > speed_tolerance(s, s.n_j + d) or gap_of(s, d) > gap_tolerance(s, d)


def alternates(s: Rubbing, c: int, d: int) -> bool:
    """Whether contact d, which nothing presses, strikes before contact c, which has just struck, does so again."""
    g, u, since = gap_of(s, d), s.velocity[s.n_j + d], max(s.since[c], s.clock.untold(0.0))
    if d == c or s.mode[d] != OPEN or not (g > 0.0 and u < 0.0 and g <= -u * since):
        return False
    return abs(s.curve[d]) * since <= s.terms[d] and (passes_on(s, c) or meets(s, c, s.n_j + d))


def disturbs(s: Rubbing) -> bool:
    """Whether the impacts left out would throw a closed contact off, or drive an open one onto its surface.

    The modes are as before.
    """
    for c in range(s.n_c):
        s.tried[c] = s.mode[c]
        s.mode[c] = mode_closed(s, c) if s.left[c] >= 0.0 else s.mode[c]
    found = let_go_pulling(s) and (throws_off(s) or drives_others(s))
    for c in range(s.n_c):
        s.mode[c] = s.tried[c]
    hold_modes(s)
    return found


def let_go_pulling(s: Rubbing) -> bool:
    """Hold the closed contacts; of those just opened by the forces only what those of the others now press.

    One that would have to pull leaves while the others hop, and bears none of the impulses that stop them.
    """
    held, pulls = True, True
    while pulls and held:
        pulls, held = False, hold_modes(s)
        accelerate_as_held(s)
        rounding = CHECKED * largest(s.rows.held, 0.0, s.rows.n_held)
        for c in range(s.n_c):
            opened = s.left[c] == 0.0 and abs(s.velocity[s.n_j + c]) <= s.terms[c]
            if opened and s.multiplier[s.n_j + c] < -rounding and not pulls:
                s.mode[c], s.left[c], pulls = OPEN, -1.0, True
    return held


def throws_off(s: Rubbing) -> bool:
    """Whether the impacts left out would throw a closed contact off, of the rows held; their impulses into `held`.

    By hops that the tolerance does not leave out. Held, it would have to pull with the impulse x that, as the stop
    turns the impacts' effect round, it pushes with. Let go, it leaves at w = x / d, d its entry of the inverse of the
    rows' matrix, and the force that presses it brings it back with lambda / d: no higher than w^2 d / (2 lambda).
    """
    copy(s.dv, s.v, s.n_q)
    constrain(s.rows, s.dv, s.rate)
    for m in range(s.rows.n_held):
        c = s.rows.row[m] - s.n_j
        x = s.rows.held[m]
        if 0 <= c < s.n_c and s.left[c] < 0.0 and x > 0.0:
            clear(s.change, s.rows.n_held)
            s.change[m] = 1.0
            solve_held(s.rows, s.change)
            force = max(s.multiplier[s.n_j + c], 0.0)
            low = x * x <= 2.0 * force * s.change[m] * gap_tolerance(s, c)
            if not low and x > s.terms[c] * s.change[m]:
                return True
    return False


def drives_others(s: Rubbing) -> bool:
    """Whether the same impulses would drive an open contact that touches onto its surface; velocities are in `dv`."""
    for c in range(s.n_c):
        i = s.n_j + c
        if s.mode[c] == OPEN and s.touches[c] == 1:
            u = product(s.R, s.dv, i, s.n_q) + s.rate[i]
            if u < -speed_tolerance(s, i):
                return True
    return False
