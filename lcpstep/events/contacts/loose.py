"""Rows at rest that depend on those held, as kernels: until when these keep them there.

Of walls around a body, or feet of one, those held keep the others closed, and from sliding, as long as obstacles and
belts go alike. Where these part, however slowly, the acceleration of a row that is not held is no longer zero: its
contact opens, or bears what the others have borne, or slides, and new modes are sought.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.contacts.equations import force_noise, size_of_loads
from lcpstep.events.contacts.held import know_biases, know_rows
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.rows.contacts import rubs
from lcpstep.events.rows.equations import acceleration_of, measure_biases, size_of_acceleration
from lcpstep.events.rows.held import DRIFT, is_held
from lcpstep.kernels.dop853 import STAGES
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.pointers import Doubles, abs, after, max, min

NEAR = 1e-3  # of the way to either end of where it is sought: how well a time is known
# An acceleration is seen to rise from rounding (NOISE) to DRIFT of its terms: by how much of the time between the two
# it has begun earlier, if it grows by power 8 of time
EARLIER = 0.35
MORE = 4.0  # times larger the acceleration must be by which a contact is seen to leave its rest once more


def find_loose(s: Rubbing) -> None:
    """How many contacts have a row at rest that is not held and may leave it, as modes begin."""
    s.loose = 0
    for c in range(s.n_c if s.rows.moving or not s.rows.fixed else 0):
        i, sticks = s.n_j + c, s.mode[c] != SLIDES and rubs(s.rows, c)
        loose = not is_held(s.rows, i) or (sticks and not is_held(s.rows, i + s.n_c))
        if s.mode[c] != OPEN and loose:
            s.loose += 1
        else:
            s.stray[c] = 0.0


def forget(s: Rubbing) -> None:
    """No guard acts within the step, and all rows are at rest where it begins, as far as has been seen."""
    s.guard, s.found = -1, 2.0
    s.kept_to, s.shown, s.delay = 0.0, 2.0, 0.0


def notice(s: Rubbing, place: float, t: float) -> None:
    """Look at the rows at the fraction `place` of a step, at time t, where guards have just been looked at.

    Up to `kept_to` they have been at rest, and they are no longer at `shown`.
    """
    if s.loose == 0 or s.shown <= 1.0 or place == 0.0:
        return
    a = after(s.dy, s.n_q)
    if place == 1.0:
        a = after(s.K, STAGES * s.n + s.n_q)
        measure_biases(s.rows, t, s.y_new)
    else:
        know_biases(s, t, s.seen)
    if straying(s, a, DRIFT) < 0:
        s.kept_to = place
    else:
        s.shown = place


def first_stray(s: Rubbing, h: float, low: float, high: float) -> bool:
    """The first row that leaves its rest between two fractions of the step of size h; whether there is one.

    In the place of the guard found, as a guard of its contact; when goes into `found`, as of other guards, and how
    much later it shows into `delay`.
    """
    c = s.straying_at(high, h, DRIFT) if low < high else -1
    if c < 0:
        return False
    high = first_beyond(s, low, high, h, DRIFT)
    place = first_beyond(s, 0.0, high, h, NOISE)
    s.found = max(0.0, place - EARLIER * (high - place))
    s.guard, s.risen, s.delay = GUARDS * c, False, high - s.found
    s.stray[c] = MORE * max(1.0, s.stray[c])
    return True


def first_beyond(s: Rubbing, low: float, high: float, h: float, level: float) -> float:
    """Where between low and high, at which it is, an acceleration comes to be beyond that share of its terms."""
    s.bracket.begin(low, high, True, 0.5 * (low + high))
    while s.bracket.seek(max(NEAR * min(s.bracket.b - low, high - s.bracket.a), RESOLUTION)):
        s.bracket.halve(s.straying_at(s.bracket.x, h, level) < 0)
    return s.bracket.b


def straying(s: Rubbing, a: Doubles, level: float) -> int:
    """The first contact that has a row leave its rest under the acceleration a, or -1; rows and biases are known."""
    for c in range(s.n_c):
        i, mode, least = s.n_j + c, s.mode[c], level * max(1.0, s.stray[c])
        if mode != OPEN and (strays(s, i, a, least) or (mode != SLIDES and strays(s, i + s.n_c, a, least))):
            return c
    return -1


def straying_seen(s: Rubbing, t: float, level: float) -> int:
    """The same at the state `seen` of time t; -1 as well where that is not finite."""
    return straying(s, after(s.dy, s.n_q), level) if know_rows(s, t) else -1


def strays(s: Rubbing, i: int, a: Doubles, least: float) -> bool:
    """Whether row i is not held and has, under a, an acceleration of more than that share of its terms.

    Forces of bodies that hang together are rounded as the largest is: in one that bears none, this leaves as much.
    """
    alpha = 0.0 if is_held(s.rows, i) else abs(acceleration_of(s.rows, i, a))
    if alpha == 0.0 or alpha <= least * (size_of_acceleration(s.rows, i, a) + size_of_loads(s, i)):
        return False
    return alpha > force_noise(s) * s.W[i * s.n_r + i]
