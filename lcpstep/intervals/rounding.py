# cython: annotation_typing=True
"""Sums, products and inverses of intervals: bounds that hold what floating-point numbers round, and those of waves.

What is computed is rounded to nearest and then moved outwards by more than the rounding; where that is no number, as
zero times infinity is none, there is no bound. They are functions of each element of arrays as numpy's own (`ufunc`).
"""

from __future__ import annotations

from math import ceil, floor
from typing import Any

import cython
import numpy as np

from lcpstep.pointers import abs, inf, max, min

OUT = 2.0**-51  # relative; more than rounding
TINY = 1e-300
TURN = 6.283185307179586


def below(x: float, units: float) -> float:
    """A lower bound of what has been rounded to x."""
    y = x - (units * OUT * abs(x) + TINY)
    return y if y == y else -inf


def above(x: float, units: float) -> float:
    """An upper bound of what has been rounded to x."""
    y = x + (units * OUT * abs(x) + TINY)
    return y if y == y else inf


@cython.ufunc
@cython.cfunc
def moved_out(
    lo: cython.double, hi: cython.double, units: cython.double
) -> tuple[cython.double, cython.double]:
    """Bounds moved by more than the rounding of what made them."""
    return below(lo, units), above(hi, units)


@cython.ufunc
@cython.cfunc
def added(
    a: cython.double, b: cython.double, c: cython.double, d: cython.double
) -> tuple[cython.double, cython.double]:
    """[a, b] + [c, d]."""
    return below(a + c, 1.0), above(b + d, 1.0)


@cython.ufunc
@cython.cfunc
def subtracted(
    a: cython.double, b: cython.double, c: cython.double, d: cython.double
) -> tuple[cython.double, cython.double]:
    """[a, b] - [c, d]."""
    return below(a - d, 1.0), above(b - c, 1.0)


@cython.ufunc
@cython.cfunc
def multiplied(
    a: cython.double, b: cython.double, c: cython.double, d: cython.double
) -> tuple[cython.double, cython.double]:
    """[a, b] times [c, d]."""
    w, x, y, z = a * c, a * d, b * c, b * d
    if w != w or x != x or y != y or z != z:
        return -inf, inf
    return below(min(min(w, x), min(y, z)), 1.0), above(max(max(w, x), max(y, z)), 1.0)


@cython.ufunc
@cython.cfunc
def inverted(a: cython.double, b: cython.double) -> tuple[cython.double, cython.double]:
    """1 / [a, b], without bounds where that may be zero."""
    if a <= 0.0 and b >= 0.0:
        return -inf, inf
    return below(1.0 / b, 1.0), above(1.0 / a, 1.0)


@cython.ufunc
@cython.cfunc
def between(
    a: cython.double, b: cython.double, at_a: cython.double, at_b: cython.double, shift: cython.double
) -> tuple[cython.double, cython.double]:
    """What a wave is over [a, b], by its values there; its extremes lie at whole and half turns after the shift."""
    slack = 1e-15 * (1.0 + max(abs(a), abs(b)))
    first, last = (a - slack) / TURN - shift, (b + slack) / TURN - shift
    least, most = max(below(min(at_a, at_b), 8.0), -1.0), min(above(max(at_a, at_b), 8.0), 1.0)
    if at_a != at_a or at_b != at_b or floor(last - 0.5) >= ceil(first - 0.5):
        least = -1.0
    if at_a != at_a or at_b != at_b or floor(last) >= ceil(first):
        most = 1.0
    return least, most


if not cython.compiled:
    moved_out, added, subtracted, multiplied, inverted, between = (
        np.vectorize(f, otypes=[float, float])
        for f in (moved_out, added, subtracted, multiplied, inverted, between)
    )


def wave(lo: Any, hi: Any, shift: float, f: Any) -> tuple[Any, Any]:
    """Sine (shift 1/4) or cosine (0)."""
    bounds: tuple[Any, Any] = between(lo, hi, f(lo), f(hi), shift)
    return bounds
