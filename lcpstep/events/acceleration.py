"""The free acceleration M^-1 f of a general system, as kernels.

`s` is whatever has the fields `model`, `M` (n_q, n_q) and `y` (2 n_q,): `single.equations.Piece`,
`several.state.Several`.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dense import positive_definite, solve_definite
from lcpstep.dynamics import mass, total_force
from lcpstep.model import ABSENT


def free_acceleration(s: Any, t: float, q: Any, v: Any, a: Any) -> bool:
    """a = M^-1 f; False where M is singular or f is not finite."""
    total_force(s.model, t, q, v, a)
    if s.model.mass == ABSENT:
        for i in range(len(a)):
            s.y[i] = a[i]
        for i in range(len(a)):
            a[i] = 0.0
            for j in range(len(a)):
                a[i] += s.model.M_inverse[i, j] * s.y[j]
        return a[0] - a[0] == 0.0
    mass(s.model, t, q, v, s.M)
    if not positive_definite(s.M):
        return False
    solve_definite(s.M, a)
    return a[0] - a[0] == 0.0


def inverse_mass(s: Any, x: Any) -> None:
    """x <- M^-1 x, M being that of the last `free_acceleration`."""
    if s.model.mass != ABSENT:
        solve_definite(s.M, x)
        return
    n = len(x)
    for i in range(n):
        s.y[i] = x[i]
    for i in range(n):
        x[i] = 0.0
        for j in range(n):
            x[i] += s.model.M_inverse[i, j] * s.y[j]
