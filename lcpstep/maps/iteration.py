"""Iterating a map x -> P(x): what every tool of `lcpstep.analysis` asks of a map, and no more."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.pace import counted

Array = NDArray[np.float64]


class Map(Protocol):
    """Anything that takes a point (d,) to its image (d,): a function, a `StroboscopicMap`, ...

    A map may also have a method `jacobian(x)`, its derivative (d, d); it is differenced where not given.
    """

    def __call__(self, x: Array, /) -> ArrayLike:
        """The image of x."""


def iterate(P: Map, x: ArrayLike, n: int) -> Array:
    """The orbit x, P(x), ..., P^n(x).

    Parameters
    ----------
    P : map
    x : (d,)   where the orbit starts
    n : number of iterations

    Returns
    -------
    (n + 1, d)   the points, the first one included

    Raises
    ------
    ValueError   n is not positive, x is no vector of finite numbers, or P changes its shape
    """
    checks.function("P", P, "a state, a map")
    points = [checks.vector("x", x)]
    for _ in counted(range(checks.count("n", n))):
        image = np.atleast_1d(np.asarray(P(points[-1]), dtype=float))
        if image.shape != points[0].shape:
            raise ValueError(f"P: expected an image of shape {points[0].shape}, got {image.shape}")
        points.append(image)
    return np.array(points)
