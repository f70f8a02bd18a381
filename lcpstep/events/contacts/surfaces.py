"""Positions on the surfaces that contacts have come to, as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN
from lcpstep.events.contacts.equations import measure, share_left
from lcpstep.events.contacts.leaning import gives
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import gap_tolerance, speed_tolerance
from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import clear, largest, product
from lcpstep.pointers import Doubles, abs, after, max, min

FREE = 1e-6  # relative: what a row can move of itself while others are held, or it depends on them
TOGETHER = 1e-3  # of the tolerance of a gap, and of a hop
GONE = 1e-90  # of the tolerance: what is left of a motion that has died away
SURE = 0.5  # of a gap: by how much its slope may change over Newton's step to zero if there is one
LATE = 8.0  # roundings of a time: what two events must be apart to be told from one


def lift(s: Rubbing, c: int) -> bool:
    """Put q onto the surface of contact c, which it misses by no more than the tolerance; False where there is none.

    Along its own way where a time cannot tell the difference, so that gaps that close at one instant, as those of two
    corners of a block, go on closing together; else with the rows held where they are: what brings one of those back
    takes the contact off its surface again, by more than the last hops of a chattering.
    """
    i, g, u, n = s.n_j + c, s.gap[s.n_j + c], s.velocity[s.n_j + c], s.n_q
    way, speed, straight = s.v, u, True
    if s.rate[i] != 0.0 or u >= 0.0 or abs(g) > -s.rows.untold(s.length) * u:
        way, speed, straight = after(s.MR, i * n), s.W[i * s.n_r + i], s.model.flat
        if s.rows.n_held > 0:
            u = gives(s, i)
            if abs(u) > FREE * speed:
                way, speed = s.dv, u
    s.gap[i] = 0.0
    if speed == 0.0:  # as in the middle of a bowl
        return True
    if not (straight or s.rate[i] >= 0.0 or is_known(s, c, way, speed)):
        return False
    for j in range(n):
        s.q[j] -= way[j] * g / speed
    return straight or has_room(s, c, way, speed, g)


def is_known(s: Rubbing, c: int, way: Doubles, speed: float) -> bool:
    """Whether the normal of contact c stays what it is within a time too short to be told; not in mid-bowl.

    Meanwhile the body goes on with its velocity, and is pushed along `way` by the obstacle that closes in.
    """
    moment, pushed = s.rows.untold(s.length), s.rate[s.n_j + c] / speed
    for j in range(s.n_q):
        s.seen[j] = s.q[j] + moment * (s.v[j] - pushed * way[j])
    gap_rates(s.model, s.rows.t0, s.seen, s.v, s.rows.G, s.rows.near)
    return abs(product(s.rows.G, way, c, s.n_q) - speed) <= SURE * abs(speed)


def has_room(s: Rubbing, c: int, way: Doubles, speed: float, g: float) -> bool:
    """Whether contact c, whose gap g `lift` has taken along `way`, leaves room; where it was led astray q goes back.

    By h = |(G' - G) dq| / |G dq|: Newton's step leads towards a zero where h <= 1/2. Beyond that a parabola that
    bends downwards, as in the middle of a bowl, has none if g < 0, and if g > 0 rises by no more than g. Source of h:
    L. Kantorovich, Functional analysis and applied mathematics, Uspekhi Matematicheskikh Nauk 3 (1948).
    """
    gap_rates(s.model, s.rows.t0, s.q, s.v, s.rows.G, s.rows.near)
    bend = product(s.rows.G, way, c, s.n_q) - speed
    if abs(bend) <= SURE * abs(speed):
        return True
    for j in range(s.n_q):
        s.q[j] += way[j] * g / speed
    downwards = bend * speed * g > 0.0
    return not (downwards and (g < 0.0 or s.rate[s.n_j + c] < 0.0))


def come_to_rest(s: Rubbing) -> bool:
    """Put a motion of which nothing is left at rest, at zero; False where something is not finite there.

    Numbers that small soon have no digits any more: squares of them vanish, and impacts have no answer.
    """
    left = largest(s.y, 0.0, 2 * s.n_q)
    if left == 0.0 or left > GONE * s.atol:
        return True
    clear(s.y, 2 * s.n_q)
    if not measure(s, s.rows.t0, s.y):
        return False
    find_touching(s)
    return True


def closed_below(s: Rubbing, c: int, share: float) -> float:
    """The gap below which contact c is closed when another one is: rounding, and a little of the tolerance.

    Late times tell no better which of two gaps that close together, as at two corners of a block, was first.
    share : of the tolerance that counts, see `share_left`
    """
    late = LATE * RESOLUTION * abs(s.rows.t0) * abs(s.velocity[s.n_j + c])
    return s.rows.rounding_of_gap(c) + TOGETHER * share * gap_tolerance(s.rows, c) + late


def find_closed(s: Rubbing) -> None:
    """Mark the contacts that begin closed: gaps zero to rounding, or to the tolerance where they do not move.

    A contact that moves is in a hop, and to begin that at the surface would leave it only the height that it has
    beyond. What callbacks make of rest, as of an obstacle at the end of its swing, is no blow.
    """
    for c in range(s.n_c):
        g, u = s.gap[s.n_j + c], abs(s.velocity[s.n_j + c])
        still = u <= speed_tolerance(s.rows, s.n_j + c)
        s.touches[c] = 1 if g <= s.rows.rounding_of_gap(c) or (still and g <= gap_tolerance(s.rows, c)) else 0
        if s.touches[c] == 1 and still:
            s.terms[c] = max(s.terms[c], u)


def find_touching(s: Rubbing) -> None:
    """Mark the open contacts whose gap is closed to rounding or to the tolerance."""
    share = share_left(s)
    for c in range(s.n_c):
        s.touches[c] = 1 if s.mode[c] != OPEN or s.gap[s.n_j + c] <= closed_below(s, c, share) else 0


def find_coming(s: Rubbing, c: int) -> None:
    """Mark those too that close before it can be told when contact c, which has come to its surface, has done so.

    A slow contact takes long to cross what rounding leaves of its gap: where it comes into a corner of walls, all of
    these are struck at once. After a hop the time is known better: to the same share of the hop's length.
    """
    u, share = s.velocity[s.n_j + c], share_left(s)
    moment = (
        min(closed_below(s, c, share) / -u, TOGETHER * (s.rows.t0 - s.rows.struck[c])) if u < 0.0 else 0.0
    )
    for d in range(s.n_c):
        way = min(-s.velocity[s.n_j + d] * moment, share * gap_tolerance(s.rows, d))
        if s.gap[s.n_j + d] <= way:
            s.touches[d] = 1
