"""Growth of a small deviation along the derivatives of an orbit, as a kernel.

growth_k = log |J_k e_{k-1}|,    e_k = J_k e_{k-1} / |J_k e_{k-1}|
"""

from __future__ import annotations

from math import log, sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.pointers import Doubles, after, nan


def growth_along(derivatives: Any, direction: Any) -> Any:
    """Growth along each of the derivatives (m, d, d), (m,); nan where one wipes out all deviations.

    direction : (d,) array   of length one; the last one, afterwards
    """
    derivatives = np.ascontiguousarray(derivatives, dtype=float)
    m, d = derivatives.shape[:2]
    growth, e = np.zeros(m), np.array([direction, direction])
    follow(doubles(derivatives), doubles(e), doubles(growth), m, d)
    direction[:] = e[0]
    return growth


def follow(J: Doubles, e: Doubles, growth: Doubles, m: int, d: int) -> None:
    """The same; e : (2, d)   the direction, and work space."""
    image = after(e, d)
    for k in range(m):
        square = 0.0
        for i in range(d):
            image[i] = 0.0
            for j in range(d):
                image[i] += J[(k * d + i) * d + j] * e[j]
            square += image[i] * image[i]
        length = sqrt(square)
        growth[k] = log(length) if length != 0.0 else nan
        for i in range(d):
            if length != 0.0:
                e[i] = image[i] / length
            else:
                e[i] = 1.0 if i == 0 else 0.0
