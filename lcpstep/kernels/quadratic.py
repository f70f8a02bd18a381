"""When a gap that moves as g + u tau + half tau^2 falls to zero: the first time, found without cancellation.

A gap that starts at zero has just been left (u >= 0) or is about to be struck (u < 0); one root is then known, and
the other needs no difference of nearly equal numbers: so the smallest hops of a chattering contact keep all digits.
Source: W. Press et al., Numerical Recipes, section 5.6.
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.pointers import abs, inf


def first_zero(g: float, u: float, half: float) -> float:
    """Smallest tau >= 0 at which the gap is zero and falling; infinite if there is none."""
    if g <= 0.0:
        if u < 0.0:
            return 0.0
        return -u / half if half < 0.0 else inf
    if u >= 0.0:
        if half >= 0.0:
            return inf
        return 0.5 * (u + sqrt(u * u - 4.0 * half * g)) / -half
    discriminant = u * u - 4.0 * half * g  # negative: the lowest point lies above zero
    return 2.0 * g / (sqrt(discriminant) - u) if discriminant >= 0.0 else inf


def accumulation(u: float, alpha: float, r: float) -> float:
    """Time in which the impacts accumulate after one with u+ = u, under a constant acceleration alpha < 0."""
    return 2.0 * u / (-alpha * (1.0 - r))


def may_reach_zero(g: float, u: float, half: float, tau: float) -> bool:
    """Whether the gap can be zero within [0, tau]; a cheap bound, true where in doubt."""
    if half <= 0.0:  # lowest at the ends
        return g <= 0.0 or g + tau * (u + tau * half) <= 0.0
    return g <= 0.0 or g + tau * u <= 0.0  # above its tangent


def highest(g: float, u: float, alpha: float, tau: float) -> float:
    """How high, at most, a gap is within [0, tau] that has the acceleration alpha."""
    return g + tau * (abs(u) + 0.5 * tau * abs(alpha))
