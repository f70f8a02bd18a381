"""Contacts that lean, as kernels: they have all the friction that they can, and do not slide, for others keep them.

What leans on others sticks where these, or nothing but it, can carry it.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import EDGE, LEANS, SLIDES, STICKS
from lcpstep.events.contacts.equations import force_noise
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import hold_modes
from lcpstep.events.rows.held import constrain
from lcpstep.events.rows.problem import accelerate_as_held
from lcpstep.kernels.vectors import clear, copy, copy_indices, product
from lcpstep.pointers import abs, after


def stand_alone(s: Rubbing) -> None:
    """Of those that lean those stick that nothing else keeps from sliding, until their forces leave the cone.

    What is wedged, or stands on three feet, leans with the forces found: with a tangent held a normal may have none.
    """
    for c in range(s.n_c):
        if s.mode[c] == LEANS and not kept_by_others(s, c):
            s.mode[c] = STICKS


def kept_by_others(s: Rubbing, c: int) -> bool:
    """Whether the rows that the modes hold keep contact c, which leans, from sliding.

    It depends on them where what moves it alone does not, once these are kept.
    """
    i = s.n_j + s.n_c + c
    return hold_modes(s.rows) and abs(gives(s, i)) <= EDGE * s.W[i * s.n_r + i]


def wavers(s: Rubbing, c: int) -> bool:
    """Whether contact c, which sticks, is decided to be at the very edge of its cone, and leans on nothing.

    Whether it slides a force tells that has left the cone by more than rounding.
    """
    if s.mode[c] != STICKS or s.new_mode[c] != LEANS:
        return False
    copy_indices(s.tried, s.mode, s.n_c)
    copy_indices(s.mode, s.new_mode, s.n_c)
    alone = not kept_by_others(s, c)
    copy_indices(s.mode, s.tried, s.n_c)
    return alone


def gives(s: Rubbing, i: int) -> float:
    """What an impulse along row i makes of its velocity once the rows held are kept, and of all, into `dv`."""
    copy(s.dv, after(s.MR, i * s.n_q), s.n_q)
    clear(s.shifted_rate, s.n_r)
    constrain(s.rows, s.dv, s.shifted_rate)
    return product(s.R, s.dv, i, s.n_q)


def stand(s: Rubbing) -> bool:
    """Let those that stick carry what others lean on them with, if they can; modes are as before where they cannot.

    Feet that share a direction may brace themselves against each other: their forces are known in sum alone.
    """
    for c in range(s.n_c):
        s.mode[c] = STICKS if s.mode[c] == LEANS else s.mode[c]
    stands = hold_modes(s.rows)
    if stands:
        accelerate_as_held(s.rows)
    for c in range(s.n_c):
        i = s.n_j + c
        if s.mode[c] == STICKS:
            most = (1.0 - EDGE) * s.mu_s[c] * s.multiplier[i]
            stands = stands and abs(s.multiplier[i + s.n_c]) < most
        elif s.mode[c] == SLIDES:
            stands = stands and s.multiplier[i] >= -force_noise(s)
    for c in range(s.n_c):
        s.mode[c] = s.mode[c] if stands else s.new_mode[c]
    return stands
