"""The clock of a motion, as kernels: the base time of its pieces, and the smooth interval around it.

A motion is a chain of pieces, each known at the time tau after its base time. Its numbers lie in an array x, of
which the first are those of the clock. Corners are the times at which an acceleration, or an obstacle's velocity, may
jump; between two of them lies a smooth interval.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import inline

# Places in x: base time, what rounding has taken from it and will take from the next; the smooth interval around it;
# a typical time; the period of the corners; time of the last event
T0, T0_REST, REST, LOW, HIGH, SCALE, PERIOD, LAST_EVENT = range(8)
N_CLOCK = 8
RESOLUTION = 2.0**-52
NUDGE = 2.0**-49  # relative; keeps accelerations on their own side of a corner


def clock(scene: Scene, numbers: int) -> NDArray[np.float64]:
    """The array x at the start of the span, with this many numbers."""
    x = np.zeros(numbers)
    x[T0], x[PERIOD], x[LAST_EVENT] = scene.t_span[0], scene.period, -math.inf
    x[SCALE] = scene.period if math.isfinite(scene.period) else scene.t_span[1] - scene.t_span[0]
    x[LOW], x[HIGH] = math.inf, -math.inf  # not known yet
    return x


def after(x: Any, tau: float) -> float:
    """The time tau after the base; what rounding takes from it is kept for the next base.

    Without it, 10^5 equal flights would drift by 10^5 roundings of the time, all of one sign.
    """
    step = x[T0_REST] + tau
    t = x[T0] + step
    moved = t - x[T0]
    x[REST] = (x[T0] - (t - moved)) + (step - moved)
    return float(t)


def start_at(x: Any, t: float) -> None:
    """The next piece begins at time t."""
    x[T0] = t
    x[T0_REST], x[REST] = x[REST], 0.0


@inline
def inside(x: Any, t: float) -> float:
    """A time moved off the ends of its smooth interval, where accelerations, and an obstacle's velocity, may jump."""
    margin = NUDGE * max(abs(t), x[SCALE])
    return min(max(t, x[LOW] + margin), x[HIGH] - margin)


def find_corners(s: Any, t: float) -> None:
    """The smooth interval of a motion s that begins at t or contains it."""
    x = s.x
    near = t + 0.5 * NUDGE * max(abs(t), x[SCALE])
    if x[LOW] <= near < x[HIGH]:
        return
    x[LOW], x[HIGH] = -math.inf, math.inf
    n = len(s.corners)
    if n == 0:
        return
    start = 0.0
    if x[PERIOD] < math.inf:
        turn = math.floor(near / x[PERIOD])
        start = turn * x[PERIOD]
        x[LOW], x[HIGH] = (turn - 1.0) * x[PERIOD] + s.corners[n - 1], (turn + 1.0) * x[PERIOD] + s.corners[0]
        if near >= x[HIGH]:  # the quotient was rounded down
            x[LOW], start = x[HIGH], (turn + 1.0) * x[PERIOD]
            x[HIGH] = (turn + 2.0) * x[PERIOD] + s.corners[0]
    for corner in s.corners:
        if start + corner > near:
            x[HIGH] = start + corner
            break
        x[LOW] = start + corner
