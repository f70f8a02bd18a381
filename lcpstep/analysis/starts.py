"""States that searches for attractors start from."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.maps.batch import periodic

Array = NDArray[np.float64]


def random_starts(box: ArrayLike, n: int, seed: int) -> Array:
    """N states drawn uniformly from a box (2, 2 n_q) of lowest and highest ones, (n, 2 n_q)."""
    box = checks.matrix("box", box)
    if len(box) != 2 or not np.all(box[0] <= box[1]):
        raise ValueError(f"box: expected the lowest and the highest states, got {box.tolist()}")
    return np.random.default_rng(seed).uniform(box[0], box[1], (checks.count("n", n), box.shape[1]))


def outside(scene: Scene | HybridScene, x: Array, phase: float) -> Array:
    """Those of the states (m, 2 n_q) that do not lie inside of the obstacle; all where there is none."""
    if isinstance(scene, HybridScene):
        return x
    periodic(scene)
    t = phase * scene.period
    n = scene.n_q
    return x[[bool(np.all(scene.gap(t, y[:n], y[n:])[0] >= 0.0)) for y in x]]
