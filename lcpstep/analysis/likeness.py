"""Are two attractors the same? Their distributions compared, where single trajectories cannot agree.

Phase and velocity of the impacts are compared by the largest distance of their distribution functions (Kuiper's
form for the phase, which does not depend on where the circle is cut, and Kolmogorov's for the velocity); impacts per
period by their means. Consecutive impacts of a motion are not independent, so the samples are cut into long blocks,
and blocks are what is permuted (for the probability that equal attractors would look this different) and redrawn
(for the confidence interval). Source: B. Efron, R. Tibshirani, An Introduction to the Bootstrap (1993), chapters 8
and 15.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.maps.batch import periods
from lcpstep.simulation import Method
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
BLOCKS = 40
BINS = 400  # in which distribution functions are compared
RESAMPLES = 2000
CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class Sample:
    """Impacts of one long motion, in blocks of periods.

    Attributes
    ----------
    phase, before : lists of (m_i,)   phases in [0, 1) and gap velocities [m/s], block by block
    periods : number of periods of a block
    states : (k, 2 n_q)   states on the section
    """

    phase: list[Array]
    before: list[Array]
    periods: int
    states: Array

    @property
    def rates(self) -> Array:
        """(blocks,) impacts per period."""
        return np.array([len(x) for x in self.phase]) / self.periods


@dataclass(frozen=True)
class Likeness:
    """Distance of two distributions.

    Attributes
    ----------
    distance : largest difference of the distribution functions; for impacts per period, of the means
    low, high : its 95 % confidence interval
    p_value : probability that two samples of one attractor are this far apart
    """

    distance: float
    low: float
    high: float
    p_value: float


def sample(
    scene: Scene, method: Method, x: ArrayLike, n: int, *, drop: int = 500, phase: float = 0.0, most: int = 64
) -> Sample:
    """Impacts of the motion from the state x at the section, over n periods after the first `drop`.

    Raises
    ------
    ValueError   fewer periods than blocks, or a number is out of range
    LcpStepError   the motion ended early
    """
    n = checks.count("n", n)
    if n < 2 * BLOCKS:
        raise ValueError(f"n: expected at least {2 * BLOCKS} periods, got {n}")
    run = periods(scene, method, x, n + drop, drop=drop, phase=phase, most=most)
    if run.status[0] != Status.DONE:
        raise LcpStepError(f"the motion ended early: {Status(run.status[0]).name}")
    size = n // BLOCKS
    cut = [slice(k * size, (k + 1) * size) for k in range(BLOCKS)]

    def blocks(values: Array) -> list[Array]:
        return [values[0, s][np.isfinite(values[0, s])] for s in cut]

    return Sample(blocks(run.time / scene.period % 1.0), blocks(run.before), size, run.states[0])


def likeness(a: Sample, b: Sample, seed: int = 0) -> dict[str, Likeness]:
    """How far apart two samples are: "phase", "velocity" and "impacts per period"."""
    for name, given in (("a", a), ("b", b)):
        checks.instance(name, given, Sample)
    speeds = np.concatenate(a.before + b.before)
    if len(speeds) == 0:
        raise ValueError("a, b: no impacts to compare")
    edges = np.linspace(np.min(speeds), np.max(speeds), BINS + 1)
    circle = np.linspace(0.0, 1.0, BINS + 1)
    histograms = {
        "phase": ([_counts(x, circle) for x in s.phase] for s in (a, b)),
        "velocity": ([_counts(x, edges) for x in s.before] for s in (a, b)),
    }
    result = {}
    for name, (one, other) in ((name, tuple(map(np.array, pair))) for name, pair in histograms.items()):
        distance = _kuiper if name == "phase" else _kolmogorov
        result[name] = _judged(
            one, other, lambda u, v, d=distance: d(_distribution(u), _distribution(v)), seed
        )
    rates = a.rates[:, None], b.rates[:, None]
    result["impacts per period"] = _judged(
        *rates, lambda u, v: abs(float(np.mean(u)) - float(np.mean(v))), seed
    )
    return result


def _counts(values: Array, edges: Array) -> Array:
    """How many lie between neighbouring edges."""
    return np.histogram(values, edges)[0].astype(float)


def _distribution(blocks: Array) -> Array:
    total = np.cumsum(np.sum(blocks, axis=0))
    return np.asarray(total / max(total[-1], 1))


def _kolmogorov(F: Array, H: Array) -> float:
    return float(np.max(np.abs(F - H)))


def _kuiper(F: Array, H: Array) -> float:
    return float(np.max(F - H) + np.max(H - F))


def _judged(a: Array, b: Array, distance: object, seed: int) -> Likeness:
    """The distance with its interval by redrawn blocks, and its probability by permuted ones."""
    random = np.random.default_rng(seed)
    both, n = np.concatenate([a, b]), len(a)
    found = distance(a, b)  # type: ignore[operator]
    chance, redrawn = np.zeros(RESAMPLES), np.zeros(RESAMPLES)
    for k in range(RESAMPLES):
        order = random.permutation(len(both))
        chance[k] = distance(both[order[:n]], both[order[n:]])  # type: ignore[operator]
        i, j = random.integers(n, size=n), random.integers(len(b), size=len(b))
        redrawn[k] = distance(a[i], b[j])  # type: ignore[operator]
    low, high = np.quantile(redrawn, [0.5 * (1.0 - CONFIDENCE), 0.5 * (1.0 + CONFIDENCE)])
    p = (1.0 + float(np.sum(chance >= found))) / (RESAMPLES + 1.0)
    return Likeness(found, float(low), float(high), p if math.isfinite(found) else math.nan)
