"""Orders of accuracy: the slope of log(error) over log(h), with its confidence interval.

Ordinary least squares, the interval from Student's t with n - 2 degrees of freedom [N. R. Draper, H. Smith,
Applied Regression Analysis, Wiley 1998, chapter 1]. And the way back: what a wanted error costs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

CONFIDENCE = 0.95
LEAST = 3  # points of a fit


@dataclass(frozen=True)
class Order:
    """A fitted slope, the bounds of its 95 % interval and how many points it rests on."""

    slope: float
    low: float
    high: float
    points: int

    def __str__(self) -> str:
        return f"{self.slope:.2f} [{self.low:.2f}, {self.high:.2f}]"


def fitted_order(h: ArrayLike, error: ArrayLike) -> Order | None:
    """Order of the errors (n,) over the steps or tolerances h (n,); None where all are equal, or fewer than three:
    through two points there is a line whatever they are.

    Points whose error is zero or not finite are left out.
    """
    x, y = np.asarray(h, dtype=float), np.asarray(error, dtype=float)
    usable = np.isfinite(y) & (y > 0.0) & (x > 0.0)
    x, y = np.log(x[usable]), np.log(y[usable])
    n = len(x)
    if n < LEAST or np.ptp(x) == 0.0 or np.ptp(y) == 0.0:
        return None
    from scipy.special import stdtrit
    from scipy.stats import linregress

    line = linregress(x, y)
    slope, half = float(line.slope), float(stdtrit(n - 2, 0.5 + 0.5 * CONFIDENCE) * line.stderr)
    return Order(slope, slope - half, slope + half, n)


@dataclass(frozen=True)
class Cost:
    """CPU time for an error; `extrapolated` where no run was as coarse or as accurate as that [s]."""

    seconds: float
    extrapolated: bool


def cost_of(error: float, errors: ArrayLike, seconds: ArrayLike) -> Cost | None:
    """CPU time at which a method reaches an error, from its levels, coarse to fine; None for fewer than two.

    Between levels on the straight line in the logarithms, at the first crossing from the fine end, so that a
    lucky coarse level does not count; beyond them along the line fitted through all.
    """
    if not error > 0.0:
        raise ValueError(f"error: expected a positive number, got {error!r}")
    x, y = np.asarray(errors, dtype=float), np.asarray(seconds, dtype=float)
    usable = np.isfinite(x) & (x > 0.0) & (y > 0.0)
    x, y = np.log(x[usable]), np.log(y[usable])
    if len(x) < 2 or np.ptp(x) == 0.0:
        return None
    wanted = math.log(error)
    for k in range(len(x) - 1, 0, -1):
        if x[k] <= wanted < x[k - 1]:
            share = (wanted - x[k]) / (x[k - 1] - x[k])
            return Cost(math.exp(y[k] + share * (y[k - 1] - y[k])), False)
    slope, height = np.polyfit(x, y, 1)
    return Cost(math.exp(slope * wanted + height), True)
