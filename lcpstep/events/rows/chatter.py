"""Chattering that is over, as kernels: contacts whose further impacts stay below the tolerance may be closed.

Hops under a pressing acceleration alpha accumulate after T = 2 u / (|alpha| (1 - r)); they are left out when no
higher than the tolerance, and when nothing else happens before T to what the contact is connected with: closed, it
answers another impact in another way than in flight, its own may throw a contact off that rests, and one that slides
may stop between them. Closing takes the speed u, with the friction that belongs to it, by an impulse that the contact
force up to T pays for, and that contacts bear which stay closed. Hops as slow as the tolerance are left out too,
elastic ones as well, also a little faster ones that no run could follow to the end of the span, and impacts of
contacts that nothing presses (inelastic collapse) when they have both a speed and a way below it, together with those
of the contacts that they alternate with: one that struck another at rest would leave it, and nothing would bring it
back before the next blow. Source: A. Nordmark, P. Piiroinen, Simulation and stability analysis of impacting systems
with complete chattering, Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import ACCUMULATION, OPEN
from lcpstep.events.rows.contacts import (
    Contacts,
    gap_of,
    gap_tolerance,
    hold_modes,
    is_met,
    rubs,
    speed_tolerance,
)
from lcpstep.events.rows.equations import other
from lcpstep.events.rows.held import constrain, solve_held
from lcpstep.kernels.quadratic import accumulation, first_zero
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import clear, copy, copy_indices, largest
from lcpstep.pointers import abs, max

LEFT_OVER = 1e3  # times the tolerance of a velocity, as masses and restitutions of a collapse take them apart
FADED = 1e-6  # of the speed of a hop: what those have lost that others still take something of
CHECKED = 1e-10  # of the largest force: a pull that is no rounding


def find_over(s: Contacts) -> bool:
    """How long the impacts that are left out would last, by contact, into `left`; whether there are any.

    Modes must be held, and `curve` be known.
    """
    some = False
    for c in range(s.n_c):
        s.left[c] = time_left(s, c) if is_met(s, c) else -1.0
        some = some or s.left[c] >= 0.0
    return some


def time_left(s: Contacts, c: int) -> float:
    """How long the impacts of contact c that are left out would last, or -1 if they may not be.

    Pressed by alpha < 0 they accumulate after 2 u / (|alpha| (1 - r)), no hop being higher than u^2 / (2 |alpha|).
    """
    i = s.n_j + c
    u, alpha, r, noise = s.velocity[i], s.curve[c], s.model.restitution[c], s.noise(c)
    if abs(u) <= noise:  # opened by the forces
        return -1.0
    tolerance, slow = gap_tolerance(s, c), abs(u) <= speed_tolerance(s, i)
    low = alpha < 0.0 and u * u <= -2.0 * alpha * tolerance
    if slow and low:
        return 0.0
    if r == 1.0 and low and is_left_over(s, c, u, alpha):
        return 0.0
    if r == 1.0 or u < 0.0:
        return -1.0
    if abs(alpha) * s.since[c] <= noise:  # an inelastic collapse
        return 0.0 if slow and u * s.since[c] <= tolerance and not awaits(s, c) else -1.0
    T = accumulation(u, alpha, r) if low else -1.0
    return -1.0 if not low or s.t0 + T > s.border() or interrupted(s, c, T) else T


def is_left_over(s: Contacts, c: int, u: float, alpha: float) -> bool:
    """Whether contact c, elastic, hops at u, hardly faster than the tolerance, and for longer than a run can follow.

    A collapse that others end leaves it so, where those come to rest first; nothing takes speed from it any more, and
    the hop behind it took as long as the next one will. On those that rest any low hop is as slow as their own last
    ones, which have been left out.
    """
    T = -2.0 * abs(u) / alpha
    alike = abs(s.since[c] - T) <= FADED * T + 4.0 * RESOLUTION * abs(s.t0)
    slow = abs(u) <= LEFT_OVER * speed_tolerance(s, s.n_j + c) or passes_on(s, c)
    return slow and alike and s.t_end - s.t0 > s.tally.max_events * T and not hops_beside(s, c, False)


def hops_beside(s: Contacts, c: int, on: bool) -> bool:
    """Whether a contact that impacts connect with contact c hops as well, no higher than the tolerance.

    on : only one whose impacts are not left out now (`left`)
    """
    passed_on = passes_on(s, c)
    for d in range(s.n_c):
        hops = s.mode[d] == OPEN and gap_of(s, d) <= gap_tolerance(s, d) and not (on and s.left[d] >= 0.0)
        if d != c and hops and (passed_on or meets(s, c, s.n_j + d)):
            return True
    return False


def interrupted(s: Contacts, c: int, T: float) -> bool:
    """Whether a contact that impacts connect with contact c closes within the time T."""
    passed_on = passes_on(s, c)
    for d in range(s.n_c):
        if d != c and s.mode[d] == OPEN and (passed_on or meets(s, c, s.n_j + d)):
            g, u = gap_of(s, d), s.velocity[s.n_j + d]
            if (g > 0.0 or u > s.noise(d)) and first_zero(g, u, 0.5 * s.curve[d]) < T:
                return True
    return False


def meets(s: Contacts, c: int, k: int) -> bool:
    """Whether impulses of contact c, with their friction, change the velocity of row k."""
    i = s.n_j + c
    rubbed = rubs(s, c) and s.D[(i + s.n_c) * s.n_r + k] != 0.0
    return rubbed or s.D[i * s.n_r + k] != 0.0


def moves(s: Contacts, c: int, d: int) -> bool:
    """Whether a force of contact c, on the joints, accelerates contact d, along either of them or not."""
    i, k, n = s.n_j + c, s.n_j + d, s.n_c if s.n_t > 0 else 0
    normal = s.D_on[i * s.n_r + k] != 0.0 or s.D_on[i * s.n_r + k + n] != 0.0
    return normal or s.D_on[(i + n) * s.n_r + k] != 0.0 or s.D_on[(i + n) * s.n_r + k + n] != 0.0


def passes_on(s: Contacts, c: int) -> bool:
    """Whether joints or closed contacts pass impulses of contact c on."""
    found = False
    for m in range(s.n_held):
        found = found or meets(s, c, s.row[m])
    return found


def awaits(s: Contacts, c: int) -> bool:
    """Whether a contact that alternates with contact c in its collapse is still too fast to be closed with it."""
    fast = False
    for d in range(s.n_c):
        fast = fast or (alternates(s, c, d) and is_told(s, d))
    return fast


def is_told(s: Contacts, d: int) -> bool:
    """Whether contact d, on its way to an impact, has a speed or a way above the tolerance."""
    return -s.velocity[s.n_j + d] > speed_tolerance(s, s.n_j + d) or gap_of(s, d) > gap_tolerance(s, d)


def alternates(s: Contacts, c: int, d: int) -> bool:
    """Whether contact d, which nothing presses, strikes before contact c, which has just struck, does so again."""
    g, u, since = gap_of(s, d), s.velocity[s.n_j + d], max(s.since[c], s.untold(0.0))
    if d == c or s.mode[d] != OPEN or not (g > 0.0 and u < 0.0 and g <= -u * since):
        return False
    return abs(s.curve[d]) * since <= s.noise(d) and (passes_on(s, c) or meets(s, c, s.n_j + d))


def take_along(s: Contacts) -> None:
    """Of a collapse that is over those contacts too that are on their way to their next impact in it.

    So are contacts that the forces have just opened: they meet other forces now.
    """
    for c in range(s.n_c):
        if s.left[c] == 0.0 and gap_of(s, c) == 0.0:
            for d in range(s.n_c):
                if s.left[d] < 0.0 and alternates(s, c, d) and not is_told(s, d):
                    s.left[d] = 0.0
    for c in range(s.n_c):
        if just_opened(s, c):
            s.left[c] = 0.0


def just_opened(s: Contacts, c: int) -> bool:
    """Whether contact c is open, and has no speed: by the forces."""
    return is_met(s, c) and abs(s.velocity[s.n_j + c]) <= s.noise(c)


def disturbs(s: Contacts) -> bool:
    """Whether the impacts left out would throw a closed contact off, or drive an open one onto its surface.

    The modes are as before.
    """
    for c in range(s.n_c):
        s.tried[c] = s.mode[c]
        s.mode[c] = s.mode_closed(c) if s.left[c] >= 0.0 else s.mode[c]
    found = let_go_pulling(s) and (throws_off(s) or drives_others(s))
    copy_indices(s.mode, s.tried, s.n_c)
    hold_modes(s)
    return found


def let_go_pulling(s: Contacts) -> bool:
    """Hold the closed contacts; of those just opened by the forces only what those of the others now press.

    One that would have to pull leaves while the others hop, and bears none of the impulses that stop them.
    """
    held, pulls = True, True
    while pulls and held:
        pulls, held = False, hold_modes(s)
        copy(s.dv, s.a_free, s.n_q)
        constrain(s, s.dv, s.bias)
        rounding = CHECKED * largest(s.held, 0.0, s.n_held)
        for m in range(s.n_held):
            c = s.row[m] - s.n_j
            pulled = s.held[m] < -rounding and 0 <= c < s.n_c and s.left[c] == 0.0 and not pulls
            if pulled and abs(s.velocity[s.n_j + c]) <= s.noise(c):
                s.mode[c], s.left[c], pulls = OPEN, -1.0, True
    return held


def find_stop(s: Contacts) -> None:
    """The impulses on the rows held that take their velocities from the contacts, into `change`."""
    for m in range(s.n_held):
        s.change[m] = -s.velocity[s.row[m]] if s.row[m] >= s.n_j else 0.0
    solve_held(s, s.change)


def throws_off(s: Contacts) -> bool:
    """Whether the impacts left out would throw a closed contact off, by hops that the tolerance does not leave out.

    Held, it would have to pull with the impulse x that, as `find_stop` turns the impacts' effect round, it pushes
    with. Let go, it leaves at w = x / d, d its entry of the inverse of the rows' matrix, and the force that presses
    it brings it back with lambda / d: no higher than w^2 d / (2 lambda).
    """
    find_stop(s)
    for m in range(s.n_held):
        c, x = s.row[m] - s.n_j, s.change[m]
        if 0 <= c < s.n_c and s.left[c] < 0.0 and x > 0.0:
            clear(s.further, s.n_held)
            s.further[m] = 1.0
            solve_held(s, s.further)
            low = x * x <= 2.0 * max(s.held[m], 0.0) * s.further[m] * gap_tolerance(s, c)
            if not low and x > s.noise(c) * s.further[m]:
                return True
    return False


def drives_others(s: Contacts) -> bool:
    """Whether the impulses of `find_stop` would drive an open contact that touches onto its surface."""
    for c in range(s.n_c):
        i = s.n_j + c
        u = s.velocity[i]
        for m in range(s.n_held if is_met(s, c) else 0):
            k = s.row[m]
            u += s.D[i * s.n_r + k] * s.change[m]
            if s.share[k] != 0.0:
                u += s.share[k] * s.D[i * s.n_r + other(s, k)] * s.change[m]
        if is_met(s, c) and u < -speed_tolerance(s, i):
            return True
    return False


def tell_over(s: Contacts, c: int) -> None:
    """Log the end of the chattering of contact c, as its impacts lead up to."""
    u, alpha, T, i = s.velocity[s.n_j + c], s.curve[c], s.left[c], s.n_j + c
    s.chatter_end[c] = s.t0 + T
    if abs(u) > s.noise(c):
        p = max(-alpha * T - u, 0.0) / s.D[i * s.n_r + i]
        s.log(s.chatter_end[c], c, -abs(u), 0.0, p, ACCUMULATION)
