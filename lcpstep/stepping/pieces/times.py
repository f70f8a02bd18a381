"""Times of `Located` to rounding, as kernels that the compiler merges into others."""

from __future__ import annotations

import cython

from lcpstep.pointers import abs, max, min
from lcpstep.stepping.pieces.codes import EPS
from lcpstep.stepping.pieces.state import Plan, Work


def within(w: Work, t: float) -> float:
    """A time moved off the corners, where forces jump, into the smooth interval at hand."""
    return float(min(max(t, w.low + w.margin), w.high - w.margin))


def at_corner(plan: Plan, w: Work, t: float) -> bool:
    """Whether a time is that of the next corner, to rounding; then its impacts are those of the corner."""
    return bool(not plan.plain and t >= w.high - 2.0 * w.margin)


def driven_by(w: Work, c: int, t: float) -> float:
    """How far the obstacle of contact c goes in what time t is rounded by, and a phase that callbacks make of it."""
    return float(4.0 * EPS * abs(t * w.gap_t[c]))
