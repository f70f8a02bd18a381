"""Impacts at one instant that repeat in proportion without end, as kernels: their sum. See `kernels.recurrence`.

With rho the ratio of two turns, what a turn changes of any velocity comes rho / (1 - rho) times more.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import ACCUMULATION, OPEN, SLIDES, STICKS
from lcpstep.events.rows.contacts import Contacts, is_met, rubs
from lcpstep.kernels.recurrence import CERTAIN, FAINT, FOR_EVER, left, proportion
from lcpstep.kernels.vectors import clear, copy
from lcpstep.pointers import abs, after, max

ROUNDS = 100_000  # problems of impacts at one instant
SLIDES_ON = 2.0**-20  # of what friction can do in a turn: so near to it does it slide all along


def look_back(s: Contacts) -> None:
    """Compare with the velocities of now from now on."""
    copy(s.turn_velocity, s.velocity, s.n_r)
    clear(s.turn_impulse, s.n_r)


def recurs(s: Contacts) -> float:
    """The ratio in which the speeds of all contacts struck since have returned, where the rest can be summed.

    `FOR_EVER` or more where they return without loss, the sliding of what rubs included. 0 as well where a contact
    that touches would be struck before the others have come to rest.
    """
    n_j = s.n_j
    for c in range(s.n_c):
        s.noise(c)  # `parabolas.Mechanism` has it made anew, into `terms`
    ratio = proportion(s.turn_impulse, after(s.turn_velocity, n_j), after(s.velocity, n_j), s.terms, s.n_c)
    if ratio >= FOR_EVER:
        return 0.0 if slows(s) else ratio
    for c in range(s.n_c if ratio > 0.0 else 0):
        i = n_j + c
        if s.turn_impulse[c] > 0.0:
            if rubs(s, c) and not rubs_on(s, c, ratio):
                return 0.0
        elif is_met(s, c) and left(s.turn_velocity[i], s.velocity[i], ratio) < -s.terms[c]:
            return 0.0
    return ratio


def slows(s: Contacts) -> bool:
    """Whether friction of what has been struck since has changed its sliding, so that nothing returns for ever."""
    some = False
    for c in range(s.n_c):
        i = s.n_j + s.n_c + c
        if s.turn_impulse[c] > 0.0 and rubs(s, c):
            some = some or abs(s.velocity[i] - s.turn_velocity[i]) > s.terms[s.n_c + c]
    return some


def rubs_on(s: Contacts, c: int, ratio: float) -> bool:
    """Whether friction of contact c goes on as in the turn: sliding one way all along, or to rest in proportion.

    Friction that has not all its force at each impact turns sliding about, and what it does is not in proportion yet;
    nor is it while its coefficient still changes with the sliding velocity.
    """
    i = s.n_j + s.n_c + c
    before, u, most = s.turn_velocity[i], s.velocity[i], s.mu[c] * s.turn_impulse[c]
    one_way = u * left(before, u, ratio) > 0.0 and u * before > 0.0
    slides = one_way and abs(abs(s.turn_impulse[s.n_c + c]) - most) <= SLIDES_ON * most
    return slides or rests(s, i, ratio)


def rests(s: Contacts, i: int, ratio: float) -> bool:
    """Whether the velocity of row i goes to zero in the same proportion."""
    return abs(left(s.turn_velocity[i], s.velocity[i], ratio)) <= CERTAIN * abs(s.velocity[i])


def sum_up(s: Contacts, ratio: float) -> None:
    """Take the impacts that are left as one: the contacts that they strike are closed."""
    rest, pushed = ratio / (1.0 - ratio), s.n_c + s.n_t
    for c in range(s.n_c):
        p = rest * s.turn_impulse[c]
        if p > 0.0:
            before = s.velocity[s.n_j + c] if s.mode[c] == OPEN else 0.0
            s.log(s.t0, c, before, 0.0, p, ACCUMULATION)
            s.since[c], s.struck[c] = s.t0 - s.struck[c], s.t0
            if s.mode[c] == OPEN:
                rough = rubs(s, c)
                s.mode[c] = STICKS if rough and rests(s, s.n_j + s.n_c + c, ratio) else SLIDES
    for i in range(s.n_j):
        s.push(i, rest * s.turn_impulse[pushed + i])
    for k in range(pushed):
        s.push(s.n_j + k, rest * s.turn_impulse[k])
    s.stop()
    look_back(s)


def close_if_faded(s: Contacts) -> bool:
    """Close the contacts that touch, if those that go on striking do so by next to nothing; whether it is so.

    Rounding adds up from impact to impact, and what is held from all sides may return its own rounding for ever.
    """
    for c in range(s.n_c):
        u = s.velocity[s.n_j + c]
        u = abs(u) if s.turn_impulse[c] > 0.0 or s.mode[c] != OPEN else max(-u, 0.0)
        if (s.mode[c] != OPEN or is_met(s, c)) and u > FAINT * s.terms[c]:
            return False
    for c in range(s.n_c):
        if is_met(s, c) and s.velocity[s.n_j + c] <= FAINT * s.terms[c]:
            s.mode[c] = SLIDES
    s.stop()
    look_back(s)
    return True
