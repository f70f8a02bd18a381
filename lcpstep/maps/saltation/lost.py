"""What is left of a deviation from surfaces that contacts and joints hold from some time on.

Positions and velocities lose what lies across the surfaces, along the forces that hold them: M^-1 C^T, C with the
friction of those that slide, as

    D = 1 - M^-1 C^T (R M^-1 C^T)^-1 R        on joints and normals; of velocities on the tangents that stick as well

The limit of infinitely many hops that end, and of a short sliding that comes to its end. Source: A. Nordmark, P.
Piiroinen, Simulation and stability analysis of impacting systems with complete chattering, Nonlinear Dynamics 58
(2009).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.events.codes import OPEN, STICKS
from lcpstep.events.contacts import point
from lcpstep.lengths import derivative

Array = NDArray[np.float64]
STEP = 1e-4  # of differences, relative


def lost(s: Any, t: float, x: Array, mode: Any, direction: Array, size: Array) -> Array:
    """What is left of a deviation from surfaces that are held from here on, (2 n_q, 2 n_q); size : see `lengths`."""
    n, n_j, n_c = s.n_q, s.n_j, s.n_c
    D = np.eye(2 * n)
    closed = [c for c in range(n_c) if mode[c] != OPEN]
    on = [*range(n_j), *(n_j + c for c in closed)]
    stuck = [n_j + n_c + c for c in closed if mode[c] == STICKS]
    if not on:
        return D
    point.hold(s, t, x, mode, direction)
    R, MR, _, _ = point.rows(s, t, x)
    C = MR.copy()
    for c, share in enumerate(point.pulls(s)):
        C[n_j + c] += share * MR[n_j + n_c + c]
    held = [*on, *stuck]
    D[:n, :n] -= C[on].T @ np.linalg.pinv(R[on] @ C[on].T) @ R[on]
    back = C[held].T @ np.linalg.pinv(R[held] @ C[held].T)
    D[n:, n:] -= back @ R[held]
    if not s.constant:
        D[n:, :n] -= back @ turning(s, t, x, held, size) @ D[:n, :n]
    return D


def turning(s: Any, t: float, x: Array, held: list[int], size: Array) -> Array:
    """Derivative of the velocities of rows by the coordinates, (rows, n_q)."""
    n = s.n_q

    def velocities(q: Array) -> Array:
        R, _, rate, _ = point.rows(s, t, np.concatenate([q, x[n:]]))
        return np.asarray((R @ x[n:] + rate)[held])

    return derivative(velocities, x[:n], STEP, size)
