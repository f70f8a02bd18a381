"""Largest Lyapunov exponents of attractors, by either method."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.fixed_points import image_and_derivative, multipliers
from lcpstep.analysis.grid_error import finer_method
from lcpstep.analysis.lyapunov import Lyapunov, growth_of_runs, lyapunov
from lcpstep.analysis.variation import PeriodMap
from lcpstep.errors import LcpStepError, SimulationError
from lcpstep.events import EventDriven
from lcpstep.maps.batch import Periods

Array = NDArray[np.float64]
LYAPUNOV_PERIODS = 400
# Of periodic motions by time-stepping: shares of h, runs on each, turns averaged over, and before
GRIDS, RUNS, AVERAGED, FORGOTTEN = (1.0, 0.9, 0.8, 0.71, 0.6, 0.5), 2, 60, 40
UNSURE = 0.5  # of an exponent: an error beyond which it is not told
MOST = 512  # impacts of a period that are kept


def exponent(P: PeriodMap, sample: Periods, x: Array, n: int) -> Lyapunov:
    """Largest Lyapunov exponent per period: from the multipliers of a periodic motion, or along an aperiodic one."""
    if not sample.tangents.shape[1]:  # no closed form
        if not isinstance(P.method, EventDriven) and getattr(P.scene, "n_c", 0):
            return Lyapunov(
                math.nan, math.nan, reason="differences across the impacts of time-stepping say nothing"
            )
        try:
            return (
                _of_multipliers(image_and_derivative(P, x, n)[1], n)
                if n
                else lyapunov(P, x, LYAPUNOV_PERIODS)
            )
        except SimulationError:
            raise
        except LcpStepError as error:  # an attractor is one, whether its motion has a derivative or not
            return Lyapunov(math.nan, math.nan, reason=str(error))
    if n and isinstance(P.method, EventDriven):
        J = np.eye(len(x))
        for factor in sample.tangents[0]:
            J = factor @ J
        return _of_multipliers(J, n)
    if n:
        return _of_scattered(P, sample.final[:RUNS], n)
    return growth_of_runs(sample.tangents)


def _of_scattered(P: PeriodMap, starts: Array, n: int) -> Lyapunov:
    """Of a periodic motion by time-stepping, from motions with steps of h/2 to h.

    Each grid scatters the impacts, and moves their mean; the derivative is that along the mean impacts of a run. What
    the exponents on the grids differ by is their error. Where that is as large as a good part of the exponent the
    motion has left the orbit too far for its derivative to be that of the orbit, and nothing is told.
    """
    parts = []
    for share in GRIDS:
        finer = replace(P, method=finer_method(P.method, share))
        run = finer.many(starts, (AVERAGED + FORGOTTEN) * n, FORGOTTEN * n, most=MOST)
        for i in range(len(starts)):
            log, counts = mean_impacts(run, i, n)
            J = np.eye(2)
            known = np.any(counts)  # and else it flies, or rests
            for factor in (
                P.from_impacts(log[None], counts[None])[0] if known else P.along(run.final[i], n)[1]
            ):
                J = factor @ J
            parts.append(_of_multipliers(J, n).largest)
    if -math.inf in parts:
        return Lyapunov(-math.inf, 0.0)
    largest = float(np.median(parts))
    error = float(np.max(np.abs(np.array(parts) - largest)))
    if error > UNSURE * abs(largest):
        reason = (
            f"from {min(parts):.3g} to {max(parts):.3g} with steps of h/2 to h; the motion by time-stepping lies too "
            f"far from the orbit: take a smaller h"
        )
        return Lyapunov(math.nan, error, reason=reason)
    return Lyapunov(largest, error)


def mean_impacts(sample: Periods, i: int, n: int) -> tuple[Array, NDArray[np.int64]]:
    """Time and velocity of the impacts of run i, (n, most, 2), averaged over its turns of n periods; their numbers.

    Of turns with another number of impacts than most have nothing is taken.
    """
    most = sample.time.shape[2]
    log, counts = np.full((n, most, 2), np.nan), np.zeros((n, 2), dtype=np.int64)
    for j in range(n):
        numbers, ends = sample.impacts[i, j::n], sample.ends[i, j::n]
        usual = int(np.bincount(numbers).argmax())
        alike = numbers == usual
        counts[j] = usual, int(np.median(ends[alike]))
        shown = min(usual, most)
        log[j, :shown, 0] = np.mean(sample.time[i, j::n][alike][:, :shown], axis=0)
        log[j, :shown, 1] = np.mean(sample.before[i, j::n][alike][:, :shown], axis=0)
    return log, counts


def _of_multipliers(J: Array, n: int) -> Lyapunov:
    largest = float(abs(multipliers(J)[0]))
    return Lyapunov(math.log(largest) / n if largest > 0.0 else -math.inf, 0.0)
