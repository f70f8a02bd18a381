"""Gauss' quadrature over [0, 1]: n nodes, exact for polynomials up to degree 2 n - 1."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@functools.cache
def gauss(n: int) -> tuple[Array, Array]:
    """Nodes and weights, each (n,)."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    return 0.5 + 0.5 * nodes, 0.5 * weights
