"""Contacts that brace themselves against each other at rest: which of them carry the load, as kernels.

What is wedged is held by more rows than it has ways to move. Those held first need not lie within their cones, though
forces within all cones were found: normals of both walls alone may pull at one of them. Forces of just so many edges
of cones as there are independent rows do, if any do: each contact sticks, leans on one edge of its cone or carries
nothing. While these last, nothing moves; where one is used up, modes are sought anew. Of more contacts, and where no
such forces are found, all stick, and tangents that say the same have one friction, with the limits of all.
Source: R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (SIAM 2009), chapter 1.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import LEANS, OPEN, SLIDES, STICKS
from lcpstep.events.contacts.equations import force_noise, most_friction, size_of_loads
from lcpstep.events.contacts.leaning import gives
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import hold_modes
from lcpstep.events.rows.equations import acceleration_of, size_of_acceleration
from lcpstep.events.rows.held import is_held
from lcpstep.events.rows.problem import accelerate_as_held
from lcpstep.kernels.roundings import NOISE
from lcpstep.pointers import abs, max

MOST = 4  # contacts at rest: of more not every way is tried
WAYS = 4  # of a contact: it sticks, leans on either edge, or carries nothing
ALIKE = 1e-6  # of a row: what counts for none of it
STILL = 1e-9  # relative: accelerations of what is at rest; and distance of forces from the edges of cones


def brace(s: Rubbing) -> bool:
    """Whether the rows held carry the load within their cones, or others could be found that do; these are held then.

    Where there are none the modes are not what they were.
    """
    resting, ways = 0, 1
    for c in range(s.n_c):
        if rests(s, c):
            resting += 1
            ways = ways * WAYS if resting <= MOST else 0
    if resting < 2 or carries(s, STILL):
        return True
    independent = 0  # rows, of the first way, in which all stick
    for way in range(ways):
        choose(s, way)
        held = hold_modes(s.rows)
        independent = max(independent, s.rows.n_held)
        if held and s.rows.n_held == independent and carries(s, STILL):
            return True
    return share_load(s)


def share_load(s: Rubbing) -> bool:
    """Whether contacts that all stick carry the load together, as those of what can only slide as a whole do.

    Tangents that say the same are held as one, which has the friction of all: that of each is not known.
    """
    choose(s, 0)
    if not hold_modes(s.rows):
        return False
    for c in range(s.n_c):
        s.leader[c] = c
        T = s.n_j + s.n_c + c
        if rests(s, c) and not is_held(s.rows, T):
            s.leader[c] = said_by(s, T)
            if s.leader[c] < 0:
                return False
    s.sharing = True
    return carries(s, -STILL)


def said_by(s: Rubbing, i: int) -> int:
    """The contact whose tangent, held, says what row i says, but for joints and normals that move neither; or -1."""
    gives(s, i)
    found = -1
    for m in range(s.rows.n_held):
        k = s.rows.row[m] - s.n_j
        if k >= 0 and abs(s.rows.held[m]) > ALIKE:
            if k < s.n_c or found >= 0 or abs(abs(s.rows.held[m]) - 1.0) > ALIKE:
                return -1
            found = k - s.n_c
    return found


def rests(s: Rubbing, c: int) -> bool:
    """Whether contact c is pressed and does not slide, as the modes were found."""
    return s.new_mode[c] in (STICKS, LEANS)


def choose(s: Rubbing, way: int) -> None:
    """Modes of what rests by the digits of `way`."""
    for c in range(s.n_c):
        if rests(s, c):
            one = way % WAYS
            way = way // WAYS
            s.mode[c] = STICKS if one == 0 else (SLIDES if one == 3 else LEANS)
            s.direction[c] = 1.0 if one == 1 else (-1.0 if one == 2 else s.new_direction[c])
            s.loaded[c] = 0 if one == 3 else 1


def carries(s: Rubbing, inside: float) -> bool:
    """Whether what rests stays at rest by the rows held, with forces so far within the cones, or rounding.

    At an edge others are looked for that are not: forces that go on outwards would leave it at once. Normals, too,
    where forces may be outside by a little: what begins to lean does so with none.
    """
    accelerate_as_held(s.rows)
    within, rounding = True, force_noise(s)
    noise = rounding * max(1.0, -inside / NOISE)
    for c in range(s.n_c):
        i = s.n_j + c
        T = i + s.n_c
        if rests(s, c):
            within = within and is_still(s, i, rounding) and is_still(s, T, rounding)
        if s.mode[c] == STICKS and (is_held(s.rows, i) or is_held(s.rows, T)):
            most = (1.0 - inside) * most_friction(s, c) + (1.0 + s.mu_s[c]) * noise
            within = within and s.multiplier[i] >= -noise and abs(s.multiplier[T]) <= most
        elif s.mode[c] != OPEN:
            within = within and s.multiplier[i] >= -noise
    return within


def is_still(s: Rubbing, i: int, rounding: float) -> bool:
    """Whether row i has no acceleration, or what that rounding of forces makes of none."""
    size = size_of_acceleration(s.rows, i, s.a) + size_of_loads(s, i)
    none = STILL * size + rounding * s.W[i * s.n_r + i]
    return abs(acceleration_of(s.rows, i, s.a)) <= none
