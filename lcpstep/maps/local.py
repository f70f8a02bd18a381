"""The equations of a scene with one contact at a point (t, q, v), for tools that ask a few times per impact.

Free acceleration M^-1 f, gap rates G and g_t, response M^-1 G^T and G M^-1 G^T, gap acceleration at given
acceleration; and Newton's impact law as a map of states. Functions of the scene stay in Python.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.faults import cause, forget
from lcpstep.model import called_model

if not cython.compiled:
    from lcpstep.arrays import doubles
    from lcpstep.kernels.acceleration import free_acceleration
    from lcpstep.kernels.dynamics import bias as gap_bias
    from lcpstep.kernels.dynamics import gap_rates, mass
    from lcpstep.kernels.linear import positive_definite, solve_definite
    from lcpstep.kernels.vectors import copy, product

Array = NDArray[np.float64]


class Local:
    """Evaluates a scene's equations; see the head of the file."""

    def __init__(self, scene: Scene) -> None:
        n_q, n_c = scene.n_q, max(scene.n_c, 1)
        self.scene, self.model = scene, called_model(scene)
        self.restitution = float(self.model.arrays["restitution"][0]) if scene.n_c else 0.0
        self.vectors, self.matrices = np.zeros((6, max(n_q, n_c))), np.zeros((3, max(n_q, n_c) * n_q))
        self.a, self.y, self.MG = doubles(self.vectors[0]), doubles(self.vectors[1]), doubles(self.vectors[2])
        self.g_t, self.shifted, self.out = (
            doubles(self.vectors[3]),
            doubles(self.vectors[4]),
            doubles(self.vectors[5]),
        )
        self.M, self.G = doubles(self.matrices[0]), doubles(self.matrices[1])
        self.G_shifted = doubles(self.matrices[2])

    def acceleration(self, t: float, q: Any, v: Any) -> Array:
        """M^-1 f, the acceleration without contact, (n_q,)."""
        x, x_t = state(q), state(v)
        forget()
        free_acceleration(self.model, t, doubles(x), doubles(x_t), self.M, self.y, self.a)
        raised()
        return self.vectors[0, : len(x)].copy()

    def rates(self, t: float, q: Any, v: Any) -> tuple[Array, float]:
        """G (n_q,) and gap velocity u = G v + g_t."""
        x, x_t = state(q), state(v)
        forget()
        gap_rates(self.model, t, doubles(x), doubles(x_t), self.G, self.g_t)
        raised()
        G = self.matrices[1, : len(x)].copy()
        return G, float(G @ x_t + self.vectors[3, 0])

    def response(self, t: float, q: Any, v: Any) -> tuple[Array, float]:
        """M^-1 G^T (n_q,) and G M^-1 G^T."""
        x, x_t = state(q), state(v)
        n = len(x)
        forget()
        gap_rates(self.model, t, doubles(x), doubles(x_t), self.G, self.g_t)
        copy(self.MG, self.G, n)
        mass(self.model, t, doubles(x), doubles(x_t), self.M)
        positive_definite(self.M, n)
        solve_definite(self.M, self.MG, n)
        W = product(self.G, self.MG, 0, n)
        raised()
        return self.vectors[2, :n].copy(), W

    def bias(self, t: float, q: Any, v: Any) -> float:
        """The gap acceleration at v' = 0."""
        x, x_t = state(q), state(v)
        forget()
        gap_bias(
            self.model, t, doubles(x), doubles(x_t), self.shifted, self.G_shifted, self.g_t, self.out
        )  # fmt: skip
        raised()
        return self.out[0]

    def after_impact(self, t: float, q: Any, v: Any) -> Array:
        """v+ = v - (1 + r) u M^-1 G^T / (G M^-1 G^T), Newton's impact law (n_q,)."""
        MG, W = self.response(t, q, v)
        _, u = self.rates(t, q, v)
        return v - (1.0 + self.restitution) * u / W * MG

    def before_impact(self, t: float, q: Any, v: Any, impulse: float) -> Array:
        """The velocities just before an impact, from those after it and its impulse (n_q,)."""
        MG, _ = self.response(t, q, v)
        return v - impulse * MG


def state(x: Any) -> Array:
    """Coordinates or velocities as kernels take them."""
    return np.ascontiguousarray(x, dtype=float)


def raised() -> None:
    """Raise what a function of the scene has raised."""
    error = cause()
    forget()
    if error is not None:
        raise error
