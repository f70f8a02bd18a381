"""Largest Lyapunov exponent of a map: growth of a small deviation, brought back to length one at every iteration.

    lambda = lim 1/n sum log |DP(x_k) e_{k-1}|,    e_k = DP(x_k) e_{k-1} / |DP(x_k) e_{k-1}|

The standard error is that of means over blocks. Along neutral motions (elastic or without friction) deviations grow
in proportion to time: log(n)/n in n iterations, alike in each of many runs, so that no scatter tells it. For a
scene's `PeriodMap` the derivative is made of saltation matrices; divide by the period for exponents per second.
Source: G. Benettin et al., Meccanica 15 (1980).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.derivative import along
from lcpstep.analysis.growth import growth_along
from lcpstep.maps.iteration import Map
from lcpstep.pace import FIRST, Pace

Array = NDArray[np.float64]
NOTHING = 1e-9  # an exponent per iteration that the digits of derivatives do not tell from zero
# Power of time up to which growth is that of a neutral motion: with the first what turns a deviation
SQUARE = 2.0
RARE = 0.01  # landings per iteration, below which the growth between them is told
BLOCKS = 20  # for the standard error
ALIGNING = 500  # iterations, at most, in which the deviation turns to where it grows most
PIECES = 1000  # of a run that sums are kept of
PORTION = 65536  # iterations between two looks at the outside world, at most
Progress = Callable[[int, "Lyapunov", Array], None]


@dataclass(frozen=True)
class Lyapunov:
    """Largest exponent and the standard error of it, per iteration; -inf where deviations vanish.

    A landing on an obstacle (the contact closes for good) wipes out all deviations of one degree of freedom. Where
    this is rare, `largest` is the growth between landings, of which there were `landings`. Not-a-number where it is
    not known, for the `reason` given. `neutral` is what deviations would show that grow like the square of time.
    """

    largest: float
    error: float
    landings: int = 0
    reason: str = ""
    neutral: float = 0.0

    @property
    def least(self) -> float:
        """What is no zero: three standard errors, or where runs are all alike what derivatives resolve."""
        return max(3.0 * self.error, NOTHING)

    @property
    def chaotic(self) -> bool:
        """Whether it is positive by more than three standard errors, and no growth of neutral motions."""
        return self.largest > max(self.least, self.neutral)

    @property
    def nearing(self) -> bool:
        """Whether it is negative by more than three standard errors: motions near each other come nearer."""
        return self.largest < -self.least


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
    drop = min(drop, n - 1)
    growth = growth[:, drop:]
    found = mean_growth(growth.T.ravel())  # in the order of time: runs may have come together
    error = found.error if m == 1 else max(found.error, mean_growth(growth.ravel(), m).error)
    return replace(found, error=error, neutral=neutral_growth(drop, n))


def neutral_growth(first: int, last: int) -> float:
    """What a deviation like the square of time would grow by, per iteration, between two of its iterations."""
    return SQUARE * math.log(last / max(first, 1)) / (last - first)


def mean_growth(growth: Array, blocks: int = BLOCKS) -> Lyapunov:
    """Largest exponent from the growth in each iteration, nan where a landing wiped out all deviations."""
    summed = Growth(len(growth))
    summed.add(growth)
    return summed.exponent(blocks)


class Growth:
    """The growth in n iterations, after `aligned` ones, summed over pieces of them, so that none need be kept."""

    def __init__(self, n: int, aligned: int = 0) -> None:
        self.n, self.aligned, self.done, self.landings = n, aligned, 0, 0
        self.total, self.count = np.zeros(min(n, PIECES)), np.zeros(min(n, PIECES), dtype=np.int64)

    def add(self, growth: Array) -> None:
        """The next iterations; nan where a landing wiped out all deviations."""
        piece = np.arange(self.done, self.done + len(growth)) * len(self.total) // self.n
        known = np.isfinite(growth)
        np.add.at(self.total, piece[known], growth[known])
        np.add.at(self.count, piece[known], 1)
        self.done, self.landings = self.done + len(growth), self.landings + int(np.sum(~known))

    def exponent(self, blocks: int = BLOCKS) -> Lyapunov:
        """Largest exponent of the iterations so far, with the standard error of means over blocks."""
        if self.landings > RARE * self.done:
            return Lyapunov(-math.inf, 0.0, self.landings)
        known = self.count > 0
        total, count = self.total[known], self.count[known]
        parts = np.array_split(np.arange(len(count)), min(blocks, len(count)))
        means = [np.sum(total[part]) / np.sum(count[part]) for part in parts]
        error = float(np.std(means, ddof=1) / math.sqrt(len(means))) if len(means) > 1 else math.inf
        neutral = neutral_growth(self.aligned, self.aligned + self.done)
        return Lyapunov(float(np.sum(total) / np.sum(count)), error, self.landings, neutral=neutral)


def lyapunov(P: Map, x: ArrayLike, n: int, drop: int = 0, *, progress: Progress | None = None) -> Lyapunov:
    """Largest Lyapunov exponent of a map along the orbit of x.

    Parameters
    ----------
    P : map
    x : (d,)   where the orbit starts
    n : iterations that are averaged over; their number costs time, not memory
    drop : iterations before, in the last of which the deviation turns to where it grows most
    progress : called now and then with the iterations averaged so far, their exponent, and the state reached (d,)

    Raises
    ------
    ValueError   n is not positive or drop is negative
    """
    checks.function("P", P, "a state, a map")
    state = np.array(checks.vector("x", x))
    n, drop = checks.count("n", n), int(checks.number("drop", drop, least=0))
    growth, direction, pace = Growth(n, min(drop, ALIGNING)), np.eye(len(state))[0], Pace(PORTION, FIRST, n)
    if drop > 0:
        images, derivatives = along(P, state, growth.aligned, drop - growth.aligned)
        growth_along(derivatives, direction)
        state = images[-1]
    while growth.done < n:
        portion = min(pace.goal(growth.done), n) - growth.done
        images, derivatives = along(P, state, portion)
        growth.add(growth_along(derivatives, direction))
        state = images[-1]
        if progress is not None:
            progress(growth.done, growth.exponent(), state)
    return growth.exponent()
