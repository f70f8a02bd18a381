"""Derivative of a map: its own where it has one, by differences of fourth order where not."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lcpstep.lengths import lengths
from lcpstep.maps.iteration import Map, iterate

Array = NDArray[np.float64]
# f' = sum w (f(x + s d) - f(x - s d)) / d; the step balances the rounding of f with the fifth derivative
STENCIL = ((1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0))
EIGHTH = (
    (1.0, 4.0 / 5.0),
    (2.0, -1.0 / 5.0),
    (3.0, 4.0 / 105.0),
    (4.0, -1.0 / 280.0),
)  # the same of order eight
EXTRAPOLATION = (4.0, -6.0, 4.0, -1.0)  # of values at 1, 2, 3, 4 steps to the value at 0
RELATIVE_STEP = np.finfo(float).eps ** 0.2 * 0.1


def derivative(P: Map, x: ArrayLike) -> Array:
    """dP/dx at x, (d, d)."""
    own = getattr(P, "jacobian", None)
    if own is not None:
        return np.atleast_2d(np.asarray(own(np.asarray(x, dtype=float)), dtype=float))
    return along(P, x, 1)[1][0]


def _lengths(P: Map, points: Array, size: float) -> Array:
    """Lengths over which a map is smooth along an orbit, (d,)."""
    size = max(size, float(np.max(np.abs(points))))
    at = points[np.argsort(np.max(np.abs(points), axis=1))[len(points) // 2]]
    return lengths(P, at, RELATIVE_STEP, np.full(points.shape[1], size if size > 0.0 else 1.0))


def along(P: Map, x: ArrayLike, n: int, drop: int = 0, *, size: float = 0.0) -> tuple[Array, Array]:
    """Images of the n iterations after the first `drop`, (n, d), and the derivative of each, (n, d, d).

    By the map itself where it knows them all at once; else by differences over lengths on which it is smooth.
    size : of the points, at the least, where these may lie much nearer to zero than the map is wide
    """
    own = getattr(P, "along", None)
    if own is not None:
        images, derivatives = own(x, n, drop)
        return images, derivatives
    points = iterate(P, x, drop + n)[drop:]
    if n and getattr(P, "jacobian", None) is None:
        scale = _lengths(P, points, size)
        return points[1:], np.array([differences(P, y, scale=scale) for y in points[:-1]])
    return points[1:], np.array([derivative(P, y) for y in points[:-1]])


def differences(
    f: Any, x: ArrayLike, step: float = RELATIVE_STEP, stencil: tuple[tuple[float, float], ...] = STENCIL,
    scale: Array | None = None,
) -> Array:  # fmt: skip
    """Derivative of f: (d,) -> (e,) by central differences, of fourth order unless the stencil is another, (e, d).

    scale : (d,)   lengths that steps are a share of; one, or the size of x, where not given
    """
    x = np.atleast_1d(np.asarray(x, dtype=float))
    scale = np.maximum(1.0, np.abs(x)) if scale is None else scale
    columns = []
    for i in range(len(x)):
        d = np.zeros(len(x))
        d[i] = step * scale[i]
        total: Any = 0.0
        for s, w in stencil:
            total = total + w * (np.atleast_1d(f(x + s * d)) - np.atleast_1d(f(x - s * d)))
        columns.append(total / d[i])
    return np.stack(columns, axis=1)


def one_sided(f: Callable[[float], Array], t: float, step: float) -> Array:
    """The limit of f at t from the side that the step points to, from four values there, by extrapolation."""
    return np.asarray(sum(w * f(t + (k + 1) * step) for k, w in enumerate(EXTRAPOLATION)))
