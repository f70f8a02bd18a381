"""The times in the span of a scene at which its callbacks jump or bend: its `corners`, again in every period."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene

Array = NDArray[np.float64]


def corner_times(scene: Scene, end: float, most: int) -> Array:
    """Those between the start of the span and a time, in their order; the first ones where they are more."""
    return repeated(np.asarray(scene.corners, dtype=np.float64), scene.period, scene.t_span[0], end, most)


def repeated(own: Array, period: float, start: float, end: float, most: int) -> Array:
    """The same of times in [0, period), or anywhere where that is infinite, given in their order."""
    if not len(own):
        return np.zeros(0)
    if math.isfinite(period):
        first = math.floor(start / period)
        last = min(math.floor(end / period), first + most // len(own) + 1)
        own = (np.arange(first, last + 1)[:, None] * period + own).ravel()
    return np.asarray(own[(own > start) & (own < end)][:most])


def corners_before(scene: Scene, t: Array) -> Array:
    """How many there are before each of some times, whole numbers, from any one time on."""
    own = np.asarray(scene.corners, dtype=np.float64)
    turn = np.zeros(len(t))
    if math.isfinite(scene.period):
        turn = np.floor(t / scene.period)
        t = t - turn * scene.period
    return np.asarray(turn * len(own) + np.searchsorted(own, t), dtype=np.float64)
