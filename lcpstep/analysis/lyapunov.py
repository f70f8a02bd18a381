"""Largest Lyapunov exponent of a map: growth of a small deviation, brought back to length one at every iteration.

    lambda = lim 1/n sum log |DP(x_k) e_{k-1}|,    e_k = DP(x_k) e_{k-1} / |DP(x_k) e_{k-1}|

The standard error is that of means over blocks. For a scene's `PeriodMap` the derivative is made of saltation
matrices; divide by the period for exponents per second. Source: G. Benettin et al., Meccanica 15 (1980).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.derivative import along
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
    growth = np.zeros(n)
    direction = np.eye(len(x))[0]
    for k, J in enumerate(along(P, x, n, drop)[1]):
        direction = J @ direction
        length = math.sqrt(direction @ direction)
        if length == 0.0:
            direction, growth[k] = np.eye(len(x))[0], math.nan
        else:
            direction, growth[k] = direction / length, math.log(length)
    landings = int(np.sum(np.isnan(growth)))
    if landings > RARE * n:
        return Lyapunov(-math.inf, 0.0, landings)
    growth = growth[np.isfinite(growth)]
    blocks = [np.mean(block) for block in np.array_split(growth, min(BLOCKS, len(growth)))]
    error = float(np.std(blocks, ddof=1) / math.sqrt(len(blocks))) if len(blocks) > 1 else math.inf
    return Lyapunov(float(np.mean(growth)), error, landings)
