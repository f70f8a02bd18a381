"""What the page shows of a run, in numbers: curves broken where velocities jump, and a map of impacts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lagrangian.labels import own_unit
from lcpstep.trajectory import Trajectory, blows

Array = NDArray[np.float64]
SAMPLES = 3000  # of a curve
MOST = 10000  # impacts that are drawn, the last ones


@dataclass(frozen=True)
class Curves:
    """Times (n,) and states (n, n_q); a row of not-a-numbers, but for the time, where velocities jump."""

    t: Array
    q: Array
    v: Array


def curves(run: Trajectory) -> Curves:
    """The motion at times close to each other, and on both sides of every impact."""
    jumps = np.unique(impacts(run).time)
    jumps = jumps[jumps > run.t[0]]
    before = np.nextafter(jumps, run.t[0])
    t = np.unique(np.concatenate([np.linspace(run.t[0], run.t[-1], SAMPLES), jumps, before]))
    q, v = run.at(t)
    landed = np.searchsorted(t, jumps)
    return Curves(np.insert(t, landed, jumps), *(np.insert(x, landed, np.nan, axis=0) for x in (q, v)))


def impacts(run: Trajectory) -> Any:
    """The last blows of the log."""
    return blows(run.impacts)[-MOST:]


def impact_map(run: Trajectory) -> tuple[Array, Array, NDArray[np.int64]]:
    """Of each impact its phase of the forcing, or the speed before it, the speed of this or the next, the contact.

    A scene with a period gives (phase, speed), one without (speed, speed of the next impact of the same contact).
    """
    found = impacts(run)
    speed = -found.before
    if math.isfinite(run.scene.period):
        return np.mod(found.time / run.scene.period, 1.0), speed, found.contact
    pairs = [np.flatnonzero(found.contact == c) for c in np.unique(found.contact)]
    first = np.concatenate([np.zeros(0, int), *(own[:-1] for own in pairs)])
    second = np.concatenate([np.zeros(0, int), *(own[1:] for own in pairs)])
    return speed[first], speed[second], found.contact[first]


def impact_labels(scene: Scene) -> tuple[str, str]:
    """Names of the axes of the map of impacts."""
    unit = own_unit("m/s", scene.labels)
    if math.isfinite(scene.period):
        return "phase of the impact", f"speed before it [{unit}]"
    return f"speed before an impact [{unit}]", f"speed before the next [{unit}]"


def rectangle(run: Trajectory) -> tuple[Array, Array]:
    """Lowest and highest (q, v) of the first coordinate's motion, with some room around them."""
    x = np.column_stack([run.q[:, 0], run.v[:, 0]])
    low, high = x.min(axis=0), x.max(axis=0)
    room = 0.5 * (high - low) + 0.5 * (high == low)
    return low - room, high + room
