"""Derivative of a map: its own where it has one, by differences of fourth order where not."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lcpstep.maps.iteration import Map, iterate

Array = NDArray[np.float64]
# f' = sum w (f(x + s d) - f(x - s d)) / d; the step balances the rounding of f with the fifth derivative
STENCIL = ((1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0))
RELATIVE_STEP = np.finfo(float).eps ** 0.2 * 0.1


def derivative(P: Map, x: ArrayLike) -> Array:
    """dP/dx at x, (d, d)."""
    own = getattr(P, "jacobian", None)
    if own is not None:
        return np.atleast_2d(np.asarray(own(np.asarray(x, dtype=float)), dtype=float))
    return differences(P, x)


def along(P: Map, x: ArrayLike, n: int, drop: int = 0) -> tuple[Array, Array]:
    """Images of the n iterations after the first `drop`, (n, d), and the derivative of each, (n, d, d).

    By the map itself where it knows them all at once.
    """
    own = getattr(P, "along", None)
    if own is not None:
        images, derivatives = own(x, n, drop)
        return images, derivatives
    points = iterate(P, x, drop + n)[drop:]
    return points[1:], np.array([derivative(P, y) for y in points[:-1]])


def differences(f: Any, x: ArrayLike, step: float = RELATIVE_STEP) -> Array:
    """Derivative of f: (d,) -> (e,) by central differences of fourth order, (e, d)."""
    x = np.atleast_1d(np.asarray(x, dtype=float))
    columns = []
    for i in range(len(x)):
        d = np.zeros(len(x))
        d[i] = step * max(1.0, abs(x[i]))
        total: Any = 0.0
        for s, w in STENCIL:
            total = total + w * (np.atleast_1d(f(x + s * d)) - np.atleast_1d(f(x - s * d)))
        columns.append(total / d[i])
    return np.stack(columns, axis=1)
