"""Times of `Located` to rounding, and the way along a piece of order two, as kernels merged into others."""

from __future__ import annotations

import cython

from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.pointers import abs, max, min
from lcpstep.stepping.pieces.codes import SAME_TIME
from lcpstep.stepping.pieces.state import Plan, Work


def within(w: Work, t: float) -> float:
    """A time moved off the corners, where forces jump, into the smooth interval at hand."""
    return float(min(max(t, w.low + w.margin), w.high - w.margin))


def at_corner(plan: Plan, w: Work, t: float) -> bool:
    """Whether a time is that of the next corner, to rounding; then its impacts are those of the corner."""
    return bool(not plan.plain and t >= w.high - 2.0 * w.margin)


def untold(t: float, h: float) -> float:
    """By what times near t are one to rounding, in steps of h."""
    return float(SAME_TIME * (abs(t) + h))


def driven_by(w: Work, c: int, t: float) -> float:
    """How far the obstacle of contact c goes in what time t is rounded by, and a phase that callbacks make of it."""
    return float(4.0 * RESOLUTION * abs(t * w.gap_t[c]))


def look_one(w: Work, i: int, tau: float) -> None:
    """Coordinate i and its velocity at tau after its base, into w.q_try and w.v_try."""
    w.q_try[i] = w.q[i] + tau * (w.v[i] + 0.5 * tau * w.a[i])
    w.v_try[i] = w.v[i] + tau * w.a[i]


def move_one(w: Work, i: int, tau: float) -> None:
    """Move coordinate i and its velocity on by tau."""
    w.q[i] += tau * (w.v[i] + 0.5 * tau * w.a[i])
    w.v[i] += tau * w.a[i]


def move_gap(w: Work, c: int, tau: float) -> None:
    """Gap c and its velocity at tau after its base become its base."""
    w.gap[c] += tau * (w.velocity[c] + tau * w.half[c])
    w.velocity[c] += 2.0 * tau * w.half[c]
