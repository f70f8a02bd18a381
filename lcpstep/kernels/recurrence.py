"""Impacts without end at one instant that repeat, as kernels: a body between two walls without clearance, a wedge.

The laws of impact are homogeneous: where the speeds of the contacts struck return in proportion, u -> rho u, they do
so for ever. With rho < 1 the impacts that are left sum to rho / (1 - rho) of those of the last turn, and leave no
speed; with rho = 1 they have no end. The turn is looked for by comparison with the speeds at powers of two. Source of
the search: R. Brent, An improved Monte Carlo factorization algorithm, BIT 20 (1980), section 2.
"""

from __future__ import annotations

import cython

from lcpstep.pointers import Doubles, abs, max

RETURNS = 2.0**-40  # relative deviation from proportion
FOR_EVER = 1.0 - 2.0**-30  # of rho: nothing is lost
GROWN = 2.0**-30  # of the speeds: by as much more they do not return, but where they have been measured anew
FAINT = 2.0**13  # roundings of a speed: next to nothing beside the speeds of the instant
CERTAIN = 2.0**-7  # of 1 - rho: what the speeds' rounding may leave of it, for the sum to be known


@cython.ccall
@cython.nogil
def looks_back(turn: int) -> bool:
    """Whether speeds are compared with those before problem `turn` from then on."""
    return turn & (turn - 1) == 0


def proportion(pushed: Doubles, before: Doubles, now: Doubles, noise: Doubles, n: int) -> float:
    """The ratio rho in which the speeds of those of n contacts that have been pushed have returned, or 0."""
    most, ratio, rounding = 0.0, 0.0, 0.0
    for c in range(n):
        if pushed[c] > 0.0:
            rounding = max(rounding, noise[c])
            if abs(before[c]) > most:
                most = abs(before[c])
                ratio = now[c] / before[c]
    if not ratio > 0.0 or (ratio - 1.0) * most > GROWN * most + rounding:
        return 0.0
    for c in range(n):
        if pushed[c] > 0.0 and abs(now[c] - ratio * before[c]) > RETURNS * ratio * most + noise[c]:
            return 0.0
    if ratio < FOR_EVER and RETURNS * ratio * most + rounding > CERTAIN * (1.0 - ratio) * most:
        return 0.0
    return ratio


def left(before: float, now: float, ratio: float) -> float:
    """The velocity that all further turns leave of one that the last has changed: each changes it by rho as much."""
    return now + ratio / (1.0 - ratio) * (now - before)
