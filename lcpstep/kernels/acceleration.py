"""The free acceleration M^-1 f of a model, and M^-1 x.

Work space: M (n_q, n_q), which keeps the factor of the mass matrix, and y (n_q,).
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import mass, total_force
from lcpstep.kernels.linear import positive_definite, solve_definite
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import Doubles


def free_acceleration(m: Model, t: float, q: Doubles, v: Doubles, M: Doubles, y: Doubles, a: Doubles) -> bool:
    """A = M^-1 f; False where M is singular or f is not finite."""
    total_force(m, t, q, v, a)
    return divide_by_mass(m, t, q, v, M, y, a)


def divide_by_mass(m: Model, t: float, q: Doubles, v: Doubles, M: Doubles, y: Doubles, a: Doubles) -> bool:
    """A <- M^-1 a at this state; False where M is singular or a is not finite."""
    if not factor_mass(m, t, q, v, M):
        return False
    inverse_mass(m, M, y, a)
    return a[0] - a[0] == 0.0


def factor_mass(m: Model, t: float, q: Doubles, v: Doubles, M: Doubles) -> bool:
    """The factor of a mass matrix that changes, at this state, into M; False where that is singular."""
    if not m.mass.given:
        return True
    mass(m, t, q, v, M)
    return positive_definite(M, m.n_q)


def response(m: Model, M: Doubles, y: Doubles, row: Doubles, out: Doubles) -> None:
    """Out <- M^-1 row: what an impulse along a row does to the velocities."""
    copy(out, row, m.n_q)
    inverse_mass(m, M, y, out)


def inverse_mass(m: Model, M: Doubles, y: Doubles, x: Doubles) -> None:
    """X <- M^-1 x, M being that of the last `free_acceleration`."""
    n = m.n_q
    if m.mass.given:
        solve_definite(M, x, n)
        return
    copy(y, x, n)
    for i in range(n):
        x[i] = 0.0
        for j in range(m.M_ends[2 * i], m.M_ends[2 * i + 1]):
            x[i] += m.M_inverse[i * n + j] * y[j]
