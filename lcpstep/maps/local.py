"""The equations of a scene with one contact at a point (t, q, v), called from Python.

Free acceleration M^-1 f, gap rates G and g_t, response M^-1 G^T and G M^-1 G^T, gap acceleration at given
acceleration; and Newton's impact law as a map of states. For tools that ask a few times per impact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.kernels.point import Point
from lcpstep.model import model

Array = NDArray[np.float64]


class Local:
    """Evaluates a scene's equations; see the head of the file."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.model = scene, model(scene)
        self.point = Point(self.model)
        self.restitution = float(self.model.arrays["restitution"][0])

    def acceleration(self, t: float, q: Array, v: Array) -> Array:
        """M^-1 f, the acceleration without contact, (n_q,)."""
        return np.asarray(self.point.acceleration(t, *states(q, v)))

    def rates(self, t: float, q: Array, v: Array) -> tuple[Array, float]:
        """G (n_q,) and gap velocity u = G v + g_t."""
        return self.point.rates(t, *states(q, v))

    def response(self, t: float, q: Array, v: Array) -> tuple[Array, float]:
        """M^-1 G^T (n_q,) and G M^-1 G^T."""
        return self.point.response(t, *states(q, v))

    def bias(self, t: float, q: Array, v: Array) -> float:
        """The gap acceleration at v' = 0."""
        return self.point.gap_bias(t, *states(q, v))

    def after_impact(self, t: float, q: Array, v: Array) -> Array:
        """v+ = v - (1 + r) u M^-1 G^T / (G M^-1 G^T), Newton's impact law (n_q,)."""
        MG, W = self.response(t, q, v)
        _, u = self.rates(t, q, v)
        return v - (1.0 + self.restitution) * u / W * MG

    def before_impact(self, t: float, q: Array, v: Array, impulse: float) -> Array:
        """The velocities just before an impact, from those after it and its impulse (n_q,)."""
        MG, _ = self.response(t, q, v)
        return v - impulse * MG


def states(q: Array, v: Array) -> tuple[Array, Array]:
    """Both as kernels take them."""
    return np.ascontiguousarray(q, dtype=float), np.ascontiguousarray(v, dtype=float)
