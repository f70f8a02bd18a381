"""On which side of a corner a run begins: callbacks are asked for the one on which the motion goes on."""

from __future__ import annotations

import math

import numpy as np

from lagrangian import Scene

MARGIN = 2.0**-49  # relative: what rounding may make of the phase of a callback, and of the time of a corner;
# by so much times are moved off a corner


def start_side(scene: Scene, t: float) -> float:
    """The time t, or, where that is a corner of the scene to rounding, the next one that callbacks tell from it."""
    period = scene.period
    periodic = math.isfinite(period)
    margin = MARGIN * max(abs(t), period if periodic else scene.t_span[1] - scene.t_span[0])
    for corner in np.asarray(scene.corners).tolist():
        apart = t - corner
        if periodic:
            apart = (apart + 0.5 * period) % period - 0.5 * period
        if abs(apart) <= margin:
            return t + margin
    return t
