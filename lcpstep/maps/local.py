"""The equations of a scene with one contact at a point (t, q, v), in plain Python.

Free acceleration M^-1 f, gap rates G and g_t, response M^-1 G^T and G M^-1 G^T, gap acceleration at given
acceleration; and Newton's impact law as a map of states. For tools that ask a few times per impact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.dynamics import gap_rates
from lcpstep.events.acceleration import free_acceleration
from lcpstep.events.single.equations import contact_response, gap_bias
from lcpstep.events.single.run import piece
from lcpstep.model import plain_model

Array = NDArray[np.float64]


class Local:
    """Evaluates a scene's equations; see the head of the file."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.model = scene, plain_model(scene)
        self._piece = piece(scene, self.model)
        self.restitution = float(self.model.restitution[0])

    def acceleration(self, t: float, q: Array, v: Array) -> Array:
        """M^-1 f, the acceleration without contact, (n_q,)."""
        a = np.zeros(len(q))
        free_acceleration(self._piece, t, q, v, a)
        return a

    def rates(self, t: float, q: Array, v: Array) -> tuple[Array, float]:
        """G (n_q,) and gap velocity u = G v + g_t."""
        G, g_t = np.zeros((1, len(q))), np.zeros(1)
        gap_rates(self.model, t, q, v, G, g_t)
        return G[0], float(G[0] @ v + g_t[0])

    def response(self, t: float, q: Array, v: Array) -> tuple[Array, float]:
        """M^-1 G^T (n_q,) and G M^-1 G^T."""
        W = contact_response(self._piece, t, q, v)
        return self._piece.MG.copy(), float(W)

    def bias(self, t: float, q: Array, v: Array) -> float:
        """The gap acceleration at v' = 0."""
        return float(gap_bias(self._piece, t, q, v))

    def after_impact(self, t: float, q: Array, v: Array) -> Array:
        """v+ = v - (1 + r) u M^-1 G^T / (G M^-1 G^T), Newton's impact law (n_q,)."""
        MG, W = self.response(t, q, v)
        _, u = self.rates(t, q, v)
        return v - (1.0 + self.restitution) * u / W * MG

    def before_impact(self, t: float, q: Array, v: Array, impulse: float) -> Array:
        """The velocities just before an impact, from those after it and its impulse (n_q,)."""
        MG, _ = self.response(t, q, v)
        return v - impulse * MG
