"""Bounds that hold what floating-point numbers round, and those of sine and cosine."""

from __future__ import annotations

from typing import Any

import numpy as np

OUT = 2.0**-51  # relative; more than rounding
TINY = 1e-300


def moved_out(lo: Any, hi: Any, units: float = 1.0) -> tuple[Any, Any]:
    """Bounds moved by more than the rounding of what made them."""
    return lo - (units * OUT * np.abs(lo) + TINY), hi + (units * OUT * np.abs(hi) + TINY)


def wave(lo: Any, hi: Any, shift: float, f: Any) -> tuple[Any, Any]:
    """Sine (shift 1/4) or cosine (0): their extremes lie at whole and half turns after the shift."""
    a, b = f(lo), f(hi)
    slack = 1e-15 * (1.0 + np.maximum(np.abs(lo), np.abs(hi)))
    first, last = (lo - slack) / (2.0 * np.pi) - shift, (hi + slack) / (2.0 * np.pi) - shift
    top = np.floor(last) >= np.ceil(first)
    bottom = np.floor(last - 0.5) >= np.ceil(first - 0.5)
    least, most = moved_out(np.minimum(a, b), np.maximum(a, b), 8.0)
    return np.where(bottom, -1.0, np.maximum(least, -1.0)), np.where(top, 1.0, np.minimum(most, 1.0))
