"""Where a body and what it strikes are, in coordinates that rest: q + c(t), and the obstacle's surface below it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene

Array = NDArray[np.float64]


def absolute(scene: Scene, t: Array, q: Array, v: Array) -> tuple[Array, Array | None]:
    """Positions (m, n_q) at times t, and the obstacle's (m,) where there is one coordinate and one contact."""
    position = q + np.array([frame(scene, float(s)) for s in t])
    if scene.n_q != 1 or scene.n_c != 1:
        return position, None
    gaps = np.array([scene.gap(float(s), x, w)[0][0] for s, x, w in zip(t, q, v, strict=True)])
    return position, position[:, 0] - gaps / slope(scene, float(t[0]), q[0], v[0])


def frame(scene: Scene, t: float) -> Array:
    """Displacement c(t) of the frame that coordinates are measured in, (n_q,)."""
    callback: Any = getattr(scene.system, "frame", None)
    if callback is None:
        return np.zeros(scene.n_q)
    out = np.zeros((scene.n_q, 3))
    callback(t, np.zeros(scene.n_q), np.zeros(scene.n_q), np.asarray(scene.p, dtype=float), out)
    return out[:, 0]


def slope(scene: Scene, t: float, q: Array, v: Array) -> float:
    """G of the one contact: what one unit of velocity adds to the gap velocity."""
    rates = [scene.gap(t, q, v + extra)[1][0] for extra in (0.0, 1.0)]
    return float(rates[1] - rates[0])
