"""Positions on the surfaces that contacts have come to, and joints that come apart, as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import OPEN

if not cython.compiled:
    from lcpstep.events.friction.equations import (
        gap_tolerance,
        rounding_of_gap,
    )
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.events.rows.held import constrain, contradiction, parted
    from lcpstep.kernels.clock import RESOLUTION
    from lcpstep.kernels.dynamics import gaps
    from lcpstep.kernels.vectors import clear, copy, product
    from lcpstep.pointers import abs, after

FREE = 1e-9  # relative: what a row can move of itself while others are held, or it depends on them
TOGETHER = 1e-3  # of the tolerance of a gap
LATE = 8.0  # roundings of a time: what two events must be apart to be told from one


def contradict(s: Rubbing) -> bool:
    """Whether joints left out ask for another acceleration than the joints held leave, in `a`; `culprit`."""
    i = contradiction(s.rows, s.a)
    s.culprit = i if i >= 0 else s.culprit
    return i >= 0


def come_apart(s: Rubbing) -> bool:
    """Whether a joint left out is no longer closed at the base state; `culprit`."""
    gaps(s.rows.joints, s.clock.t0, s.q, s.v, s.gap)
    i = parted(s.rows, s.gap, s.q)
    s.culprit = i if i >= 0 else s.culprit
    return i >= 0


def lift(s: Rubbing, c: int) -> None:
    """Put q onto the surface of contact c, which it misses by no more than the tolerance.

    Along its own way where a time cannot tell the difference, so that gaps that close at one instant, as those of two
    corners of a block, go on closing together; else with the rows held where they are: what brings one of those back
    takes the contact off its surface again, by more than the last hops of a chattering.
    """
    i, g, u, n = s.n_j + c, s.gap[s.n_j + c], s.velocity[s.n_j + c], s.n_q
    way, speed = s.v, u
    if s.rate[i] != 0.0 or u >= 0.0 or abs(g) > -s.clock.untold(s.length) * u:
        way, speed = after(s.MR, i * n), s.W[i * s.n_r + i]
        if s.rows.n_held > 0:
            copy(s.dv, way, n)
            clear(s.shifted_rate, s.n_r)
            constrain(s.rows, s.dv, s.shifted_rate)
            u = product(s.R, s.dv, i, n)
            if abs(u) > FREE * speed:
                way, speed = s.dv, u
    for j in range(n):
        s.q[j] -= way[j] * g / speed
    s.gap[i] = 0.0


def touching(s: Rubbing, c: int) -> float:
    """The gap below which contact c is closed when another one is: rounding, and a little of the tolerance.

    Late times tell no better which of two gaps that close together, as at two corners of a block, was first.
    """
    late = LATE * RESOLUTION * abs(s.clock.t0) * abs(s.velocity[s.n_j + c])
    return rounding_of_gap(s, c) + TOGETHER * gap_tolerance(s, c) + late


def find_touching(s: Rubbing) -> None:
    """Mark the open contacts whose gap is closed to rounding or to the tolerance."""
    for c in range(s.n_c):
        s.touches[c] = 1 if s.mode[c] != OPEN or s.gap[s.n_j + c] <= touching(s, c) else 0
