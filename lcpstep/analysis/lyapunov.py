"""Largest Lyapunov exponent of a map: growth of a small deviation, brought back to length one at every iteration.

    lambda = lim 1/n sum log |DP(x_k) e_{k-1}|,    e_k = DP(x_k) e_{k-1} / |DP(x_k) e_{k-1}|

The standard error is that of means over blocks. For a scene's `PeriodMap` the derivative is made of saltation
matrices; divide by the period for exponents per second. Source: G. Benettin et al., Meccanica 15 (1980).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

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
    this is rare, `largest` is the growth between landings, of which there were `landings`. Not-a-number where it is
    not known, for the `reason` given.
    """

    largest: float
    error: float
    landings: int = 0
    reason: str = ""

    @property
    def chaotic(self) -> bool:
        """Whether it is positive by more than three standard errors."""
        return self.largest > 3.0 * self.error and self.largest > 0.0


def growth_of_runs(derivatives: Array, drop: int = 20) -> Lyapunov:
    """Largest exponent from the derivatives along m runs on one attractor, (m, n, d, d); the first `drop` align."""
    m, n, d, _ = derivatives.shape
    directions = np.tile(np.eye(d)[0], (m, 1))
    growth = np.zeros((m, n))
    for k in range(n):
        directions = np.einsum("mij,mj->mi", derivatives[:, k], directions)
        length = np.sqrt(np.sum(directions**2, axis=1))
        lost = length == 0.0
        growth[:, k] = np.where(lost, math.nan, np.log(np.where(lost, 1.0, length)))
        directions = np.where(lost[:, None], np.eye(d)[0], directions / np.where(lost, 1.0, length)[:, None])
    growth = growth[:, min(drop, n - 1) :]
    found = mean_growth(growth.T.ravel())  # in the order of time: runs may have come together
    return found if m == 1 else replace(found, error=max(found.error, mean_growth(growth.ravel(), m).error))


def mean_growth(growth: Array, blocks: int = BLOCKS) -> Lyapunov:
    """Largest exponent from the growth in each iteration, nan where a landing wiped out all deviations."""
    landings = int(np.sum(np.isnan(growth)))
    if landings > RARE * len(growth):
        return Lyapunov(-math.inf, 0.0, landings)
    growth = growth[np.isfinite(growth)]
    means = [np.mean(block) for block in np.array_split(growth, min(blocks, len(growth)))]
    error = float(np.std(means, ddof=1) / math.sqrt(len(means))) if len(means) > 1 else math.inf
    return Lyapunov(float(np.mean(growth)), error, landings)


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
    return mean_growth(growth)
