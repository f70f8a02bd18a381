"""Corners: the smooth interval that begins there, and short hops that cross one, as kernels.

A hop far below the rounding of positions goes on beyond a corner from the gap and the gap velocity that its own
acceleration has given it (`motion.near_surface`); only the acceleration is asked for anew.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import largest
from lcpstep.events.clock import HIGH, RESOLUTION, T0, find_corners
from lcpstep.events.contact import ALPHA0, EDGE_ALPHA, EDGE_G, EDGE_U, NONE, NOW, ON_SURFACE, SPEED0
from lcpstep.events.single.equations import GAP0
from lcpstep.events.single.motion import contact_at, near_surface, rebase, state_at

SHORT = 0.02  # of the scan interval: what the quadrature of a hop resolves to rounding
LOW = 1e-6  # of the positions: higher gaps are as well known by their difference
JUMP = 1e-9  # of the velocities: a gap velocity that changes by less at a corner does so by rounding
MAX_ITERATIONS = 60


def fall(g: float, u: float, alpha: float) -> float:
    """Time in which a gap g >= 0 closes that begins with the velocity u, under a constant acceleration alpha < 0."""
    if g == 0.0:
        return 2.0 * u / -alpha
    root = math.sqrt(u * u - 2.0 * alpha * g)
    return (root + u) / -alpha if u > 0.0 else 2.0 * g / (root - u)


def low_hop(s: Any, guess: float, longest: float) -> float:
    """End of a hop that begins with the gap GAP0 at the base, or NONE if it is longer: Newton's method."""
    x, g0 = guess, s.x[GAP0]
    for _ in range(MAX_ITERATIONS):
        if not 0.0 < x <= longest:
            return NONE
        at = near_surface(s, x)
        f, slope = at[0] + g0 / x, (at[1] - at[0] - g0 / x) / x
        if not slope < 0.0:
            return NONE
        step = -f / slope
        x = max(x + step, 0.1 * x)
        if abs(step) <= 2.0 * RESOLUTION * x:
            break
    return x


def is_low(s: Any, h: float) -> bool:
    """Whether a flight from the surface, or from a gap that is known, is pressed and low up to the corner h ahead."""
    x = s.x
    if x[ON_SURFACE] != 1.0 or not x[EDGE_ALPHA] < 0.0 or h > SHORT * s.plan.scan or h < x[HIGH] - x[T0]:
        return False
    highest = x[GAP0] + h * (abs(x[EDGE_U]) + 0.5 * h * abs(x[EDGE_ALPHA]))
    return bool(highest <= LOW * largest(s.q0, 0.0))


def reach_end(s: Any, stop: float) -> None:
    """The next piece begins at the end of this one; on a corner, with the low gap of the hop that crosses it."""
    x = s.x
    crosses, g, u = is_low(s, stop), 0.0, 0.0
    if crosses:
        at = near_surface(s, stop)
        g, u = x[GAP0] + at[0] * stop, at[1]
    state_at(s, stop)
    rebase(s, x[NOW])
    if crosses and g > 0.0:
        x[GAP0], x[SPEED0], x[ON_SURFACE] = g, u, 1.0
        x[EDGE_G], x[EDGE_U] = g, u


def turn_corner(s: Any) -> None:
    """Enter the next smooth interval, with the accelerations of its side."""
    x = s.x
    find_corners(s, x[NOW])
    if s.contact:
        _, u, x[EDGE_ALPHA] = contact_at(s, x[NOW] - x[T0])
        x[ALPHA0] = x[EDGE_ALPHA]
        if x[GAP0] > 0.0 and abs(u - x[SPEED0]) > JUMP * largest(s.v, 1.0):
            x[GAP0], x[ON_SURFACE] = 0.0, 0.0
