"""Lengths over which a function is smooth: what its differences are taken over, whatever the units it is written in.

The difference quotient over 2 h differs from that over h by h^2 f'''/2. Where that is no small part of the slope, as
that of a force over a metre in a mechanism of micrometres, lengths are cut down until it is. What is periodic, or
bounded, is hidden over lengths far beyond the motion by what is not, so these are taken only if shorter tell less.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SMOOTH = 1e-6  # error of a slope, of that itself, that is small
KNOWN = 1e-2  # error of one that is known at all
SHORTER, SHORTEST = 0.1, 1e-3  # from length to length; of the size of the motion
ASIDE = 0.05  # of the size: where lengths for a whole motion are sought, for starts are where even functions are flat
BEYOND = 100.0  # times the size of the motion: lengths that are far beyond it
ROUNDING = np.finfo(float).eps


def sizes(run: Any) -> Array:
    """Of the coordinates and velocities of a run, (2 n_q,), one at least for what does not move at all.

    What lies near zero in all states that were kept is as large as its speed, or its way, makes it in the span.
    """
    span = max(float(run.t[-1] - run.t[0]), 1e-300)
    q, v = np.max(np.abs(run.q), axis=0), np.max(np.abs(run.v), axis=0)
    both = np.concatenate([np.maximum(q, v * span), np.maximum(v, q / span)])
    return np.where(both > 0.0, both, 1.0)


def lengths(f: Callable[[Array], Any], x: Array, step: float, size: Array) -> Array:
    """For each number of x (d,) the length of which differences of f are a share `step`.

    One, or its own size, if f is smooth over that; size : (d,) of the motion
    """
    return np.array([
        _length(_along(f, x, i), float(x[i]), step, float(size[i])) for i in range(len(x))
    ])  # fmt: skip


def derivative(f: Callable[[Array], Any], x: Array, step: float, size: Array) -> Array:
    """Of f: (d,) -> (e,), by differences of fourth order over these shares of such lengths, (e, d)."""
    columns = []
    for i, length in enumerate(lengths(f, x, step, size)):
        along, d = _along(f, x, i), step * length
        columns.append((8.0 * (along(d) - along(-d)) - along(2.0 * d) + along(-2.0 * d)) / (12.0 * d))
    return np.stack(columns, axis=1)


def _along(f: Callable[[Array], Any], x: Array, i: int) -> Callable[[float], Array]:
    """f as a function of how far its i-th number lies from that of x."""

    def along(d: float) -> Array:
        y = np.array(x, dtype=float)
        y[i] += d
        return np.atleast_1d(f(y))

    return along


def _length(f: Callable[[float], Array], at: float, step: float, size: float) -> float:
    """The longest one over which the slope of f is known, or that over which it is known best."""
    length = max(1.0, abs(at))
    best, least, shortest = length, (True, np.inf), SHORTEST * min(size, 1.0)
    while length > shortest:
        slope, error = _slope(f, step * length)
        if error == 0.0 or (error <= SMOOTH * slope and length <= BEYOND * size):
            return length
        found = (length > BEYOND * size or error > KNOWN * slope, error)
        if np.isfinite(error) and found < least:
            best, least = length, found
        length *= SHORTER
    return best


def _slope(f: Callable[[float], Array], h: float) -> tuple[float, float]:
    """The largest slope of f, and its error by bends and by rounding; none where f does not depend on this."""
    values = np.array([f(d) for d in (-2.0 * h, -h, h, 2.0 * h)])
    near, far = (values[2] - values[1]) / (2.0 * h), (values[3] - values[0]) / (4.0 * h)
    if not np.any(near) and not np.any(far):
        return 0.0, 0.0
    rounding = ROUNDING * float(np.max(np.abs(values))) / h
    return float(np.max(np.abs(near))), float(np.max(np.abs(far - near))) + rounding
