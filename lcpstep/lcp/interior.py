"""Interior-point method for a monotone problem (W + W^T positive semidefinite), dense or sparse.

Newton's method on W z + b - w = 0, z_i w_i = mu with mu -> 0; eliminating w leaves the matrix

    W + diag(w / z),

which has factors even where W has none (redundant contacts). Predictor and corrector share them: S. Mehrotra,
SIAM J. Optim. 2 (1992) 575; S. J. Wright, Primal-Dual Interior-Point Methods (1997), chapter 8.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.factor import Factoriser, Singular

STEPS = 60
BACK_OFF = 0.995  # part of the way to the boundary that a step may go
SMALLEST = 1e-13  # relative complementarity at which rounding takes over


def interior_point(W: Any, b: Any, factors: Factoriser) -> tuple[Any, int]:
    """The last point z > 0, and the number of steps; not judged."""
    # Products of huge numbers would overflow
    unit = np.ldexp(1.0, -np.frexp(np.max(np.abs(b), initial=0.0))[1])
    z, steps = from_unit(W, unit * b, factors)
    return z / unit, steps


def from_unit(W: Any, b: Any, factors: Factoriser) -> tuple[Any, int]:
    """The same for a b of size one."""
    n, everywhere = len(b), np.ones(len(b), dtype=bool)
    z, w, scale = start(W, b)
    for step in range(STEPS):
        mu, defect = float(z @ w) / n, W @ z + b - w
        done = mu <= SMALLEST * scale and np.max(np.abs(defect)) <= SMALLEST * np.max(np.abs(w))
        if done or mu == 0.0:  # products of numbers near the smallest that there are come to nothing
            return z, step
        try:
            solve = factors.factor(everywhere, w / z)
        except Singular:
            return z, step
        dz = solve(-defect - w)
        dw = -w - w / z * dz
        reach = min(longest(z, dz), longest(w, dw))
        centre = (float((z + reach * dz) @ (w + reach * dw)) / (n * mu)) ** 3
        target = (centre * mu - dz * dw) / z
        dz = solve(target - w - defect)
        dw = target - w - w / z * dz
        reach = min(1.0, BACK_OFF * min(longest(z, dz, 2.0), longest(w, dw, 2.0)))
        if not reach > 0.0 or not np.isfinite(dz).all():
            return z, step
        z, w = z + reach * dz, w + reach * dw
    return z, STEPS


def start(W: Any, b: Any) -> tuple[Any, Any, float]:
    """A first point whose products z_i w_i are all alike, and their size."""
    diagonal = np.abs(W.diagonal())
    diagonal = np.where(diagonal > 0.0, diagonal, np.max(diagonal) or 1.0)
    level = np.max(np.abs(b) / np.sqrt(diagonal)) or 1.0
    z = level / np.sqrt(diagonal)
    w = level * np.sqrt(diagonal)
    return z, w, float(level) * float(level)


def longest(x: Any, dx: Any, most: float = 1.0) -> float:
    """Largest step, up to `most`, that keeps x + step dx >= 0."""
    falling = dx < 0.0
    return float(np.min(x[falling] / -dx[falling], initial=most))
