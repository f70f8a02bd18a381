"""How long a motion can be predicted: how fast a small disturbance of its start grows.

    factor(t) = max over s <= t of |q_disturbed(s) - q(s)| / |disturbance|

In chaos the factor grows exponentially, and beyond the time at which it reaches `LIMIT` two trajectories say
nothing about each other: an error of 1e-5 of the motion's size has become a tenth of it. Growth as a power of
time (the phase of an elastic ball) sets no limit. The rate is a finite-time Lyapunov exponent [A. Wolf et al.,
Determining Lyapunov exponents from a time series, Physica D 16, 1985].
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import LcpStepError
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Status, Trajectory

Array = NDArray[np.float64]
LIMIT = 1e4
LOST = 0.1  # of the size of the motion: two trajectories that far apart have nothing to do with each other
SMALL, COARSE = 1e-9, 1e-3  # disturbance in units of the size; of methods that round impacts to a grid
LOOKS = 4000
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)  # multiples of it, less what is whole, are all different
EXPONENTIAL = 0.75  # at half the time an exponential has reached the power 1/2 of its end, others more


@dataclass(frozen=True, eq=False)
class Growth:
    """How a disturbance grows.

    Attributes
    ----------
    t, factor : (n,)   times [s], and how many times larger than at the start the disturbance has been until then
    rate : exponential rate up to the horizon [1/s]
    horizon : end of predictability, or infinite if not within the span [s]
    size : half the range of the coordinate that moves most [m]
    disturbed : the disturbed motion; its start was moved by `disturbance` [m]
    """

    t: Array
    factor: Array
    rate: float
    horizon: float
    size: float
    disturbed: Trajectory
    disturbance: float

    def __str__(self) -> str:
        text = f"a disturbance grows {self.factor[-1]:.2g}-fold in {self.t[-1] - self.t[0]:g} s"
        if math.isinf(self.horizon):
            return text
        return f"{text}, exponentially ({self.rate:.3g} per s); predictable up to t = {self.horizon:.6g} s"


def growth(scene: Scene, method: Method, motion: Trajectory | None = None) -> Growth | None:
    """Growth of a small disturbance of the initial state; None where the start cannot be disturbed.

    Parameters
    ----------
    scene, method : the motion asked about; `motion` itself where it is there already
    """
    motion = simulate(scene, method) if motion is None else motion
    t = np.linspace(motion.t[0], motion.t[-1], LOOKS + 1)
    q = motion.at(t)[0]
    size = float(np.max(np.ptp(q, axis=0))) / 2.0
    if not (np.isfinite(size) and size > 0.0):
        return None
    small = COARSE if hasattr(method, "h") else SMALL
    for start in _moved(scene, small * size):
        try:
            disturbed = simulate(replace(scene, **start), method)
        except (ValueError, LcpStepError):  # inside an obstacle, or off a joint
            continue
        if disturbed.status is not Status.DONE:
            continue
        apart = np.maximum.accumulate(np.max(np.abs(disturbed.at(t)[0] - q), axis=1))
        factor = apart / (small * size)
        horizon = _horizon(t, factor, min(LIMIT, LOST / small))
        return Growth(t, factor, _rate(t, factor, horizon), horizon, size, disturbed, small * size)
    return None


def _moved(scene: Scene, by: float) -> Iterator[dict[str, Any]]:
    """Initial states a little off: coordinates moved either way, else velocities.

    By amounts of their own, since many motions are the same wherever they take place; else all by the same, which
    parts no bodies that touch.
    """
    q, v, length = np.asarray(scene.q0), np.asarray(scene.v0), float(np.ptp(scene.t_span))
    uneven = 1.0 - 0.5 * np.mod(GOLDEN * np.arange(len(q)), 1.0)
    for share in (uneven, np.ones(len(q))) if len(q) > 1 else (uneven,):
        yield {"q0": q + by * share}
        yield {"q0": q - by * share}
    yield {"v0": v + by / length * uneven}
    yield {"v0": v - by / length * uneven}


def _horizon(t: Array, factor: Array, limit: float) -> float:
    beyond = np.flatnonzero(factor >= limit)
    if len(beyond) == 0:
        return math.inf
    k = int(beyond[0])
    half = factor[np.searchsorted(t, 0.5 * (t[0] + t[k]))]
    return float(t[k]) if half <= limit**EXPONENTIAL else math.inf


def _rate(t: Array, factor: Array, horizon: float) -> float:
    used = (t <= horizon) & (factor > 0.0)
    return float(np.polyfit(t[used], np.log(factor[used]), 1)[0]) if np.sum(used) > 2 else 0.0
