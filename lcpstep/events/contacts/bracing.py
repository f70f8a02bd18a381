"""Contacts that brace themselves against each other at rest: which of them carry the load, as kernels.

What is wedged is held by more rows than it has ways to move. Those held first need not lie within their cones, though
forces within all cones were found: normals of both walls alone may pull at one of them. Forces of just so many edges
of cones as there are independent rows do, if any do: each contact sticks, leans on one edge of its cone or carries
nothing. While these last, nothing moves; where one is used up, modes are sought anew.
Source: R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (SIAM 2009), chapter 1.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import LEANS, OPEN, SLIDES, STICKS
from lcpstep.events.contacts.equations import force_noise, size_of_loads
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.accelerations import accelerate_as_held
from lcpstep.events.rows.contacts import hold_modes
from lcpstep.events.rows.equations import size_of_acceleration
from lcpstep.events.rows.held import is_held
from lcpstep.kernels.vectors import product
from lcpstep.pointers import abs

MOST = 4  # contacts at rest: of more not every way is tried
WAYS = 4  # of a contact: it sticks, leans on either edge, or carries nothing
STILL = 1e-9  # relative: accelerations of what is at rest; and distance of forces from the edges of cones


def braced(s: Rubbing) -> bool:
    """Whether the rows held carry the load within their cones, or others could be found that do; these are held then.

    Where there are none the modes are not what they were.
    """
    resting, ways = 0, 1
    for c in range(s.n_c):
        if rests(s, c):
            resting += 1
            ways = ways * WAYS if resting <= MOST else 0
    if resting < 2 or carries(s):
        return True
    choose(s, 0)
    hold_modes(s.rows)
    independent = s.rows.n_held  # rows, where all stick
    choose_as_found(s)
    if hold_modes(s.rows) and s.rows.n_held == independent and carries(s):
        return True
    for way in range(ways):
        choose(s, way)
        if hold_modes(s.rows) and s.rows.n_held == independent and carries(s):
            return True
    return False


def rests(s: Rubbing, c: int) -> bool:
    """Whether contact c is pressed and does not slide, as the modes were found."""
    return s.new_mode[c] == STICKS or s.new_mode[c] == LEANS


def choose_as_found(s: Rubbing) -> None:
    """Modes of what rests by the forces found: what bears none of them carries nothing.

    The solver finds them on independent edges of cones; contacts at one place that bear nothing, held before these,
    would take their loads.
    """
    for c in range(s.n_c):
        if rests(s, c):
            s.mode[c] = s.new_mode[c] if s.new_loaded[c] == 1 else SLIDES
            s.direction[c], s.loaded[c] = s.new_direction[c], s.new_loaded[c]


def choose(s: Rubbing, way: int) -> None:
    """Modes of what rests by the digits of `way`."""
    for c in range(s.n_c):
        if rests(s, c):
            one = way % WAYS
            way = way // WAYS
            s.mode[c] = STICKS if one == 0 else (SLIDES if one == 3 else LEANS)
            s.direction[c] = 1.0 if one == 1 else (-1.0 if one == 2 else s.new_direction[c])
            s.loaded[c] = 0 if one == 3 else 1


def carries(s: Rubbing) -> bool:
    """Whether what rests stays at rest by the rows held, with forces within the cones by more than rounding.

    At an edge others are looked for that are not: forces that go on outwards would leave it at once.
    """
    accelerate_as_held(s.rows)
    within, noise = True, force_noise(s)
    for c in range(s.n_c):
        i = s.n_j + c
        T = i + s.n_c
        if rests(s, c):
            within = within and is_still(s, i) and is_still(s, T)
        if s.mode[c] == STICKS and (is_held(s.rows, i) or is_held(s.rows, T)):
            most = (1.0 - STILL) * s.mu_s[c] * s.multiplier[i] + (1.0 + s.mu_s[c]) * noise
            within = within and s.multiplier[i] >= -noise and abs(s.multiplier[T]) <= most
        elif s.mode[c] != OPEN:
            within = within and s.multiplier[i] >= -noise
    return within


def is_still(s: Rubbing, i: int) -> bool:
    """Whether row i has no acceleration."""
    size = size_of_acceleration(s.rows, i, s.a) + size_of_loads(s, i)
    return abs(product(s.R, s.a, i, s.n_q) + s.bias[i]) <= STILL * size
