"""Lyapunov exponents of a map: growth of small deviations, by QR factorisation at every iteration.

    lambda_i = lim 1/n sum log |R_ii|,    DP(x_k) Q_{k-1} = Q_k R_k

The standard error is that of means over blocks. For a scene's `PeriodMap` the derivative is made of saltation
matrices; divide by the period for exponents per second. Source: G. Benettin et al., Meccanica 15 (1980).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.derivative import derivative
from lcpstep.maps.iteration import Map

Array = NDArray[np.float64]
RARE = 0.01  # landings per iteration, below which the growth between them is told
BLOCKS = 20  # for the standard error


@dataclass(frozen=True)
class Lyapunov:
    """Largest exponent and the standard error of it, per iteration; -inf where deviations vanish.

    A landing on an obstacle (the contact closes for good) wipes out all deviations of one degree of freedom. Where
    this is rare, `largest` is the growth between landings, of which there were `landings`.
    """

    largest: float
    error: float
    landings: int = 0

    @property
    def chaotic(self) -> bool:
        """Whether it is positive by more than three standard errors."""
        return self.largest > 3.0 * self.error and self.largest > 0.0


def lyapunov(P: Map, x: ArrayLike, n: int, drop: int = 0) -> Lyapunov:
    """Largest Lyapunov exponent of a map along the orbit of x.

    Parameters
    ----------
    P : map
    x : (d,)   where the orbit starts
    n : iterations that are averaged over
    drop : iterations before

    Raises
    ------
    ValueError   n is not positive or drop is negative
    """
    x = np.array(checks.vector("x", x))
    n, drop = checks.count("n", n), int(checks.number("drop", drop, least=0))
    Q = np.eye(len(x))
    growth = np.zeros(n)
    for k in range(-drop, n):
        if k >= 0:
            Q, R = np.linalg.qr(derivative(P, x) @ Q)
            if R[0, 0] == 0.0:
                Q, growth[k] = np.eye(len(x)), math.nan
            else:
                growth[k] = math.log(abs(R[0, 0]))
        x = np.atleast_1d(np.asarray(P(x), dtype=float))
    landings = int(np.sum(np.isnan(growth)))
    if landings > RARE * n:
        return Lyapunov(-math.inf, 0.0, landings)
    growth = growth[np.isfinite(growth)]
    blocks = [np.mean(block) for block in np.array_split(growth, min(BLOCKS, len(growth)))]
    error = float(np.std(blocks, ddof=1) / math.sqrt(len(blocks))) if len(blocks) > 1 else math.inf
    return Lyapunov(float(np.mean(growth)), error, landings)
