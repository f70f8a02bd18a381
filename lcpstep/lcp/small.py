"""Closed forms for one and two unknowns, each answer judged.

One unknown: z = max(0, -b / W). Two: the four complementary bases, solved by Cramer's rule, in the order of
their size.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.judge import judge

ROUNDING = 1e-14  # residual up to which Cramer's rule is accurate enough


def solve_one(W: Any, b: Any, z: Any, w: Any, s: Any) -> float:
    """Residual of z = max(0, -b / W) for numbers W and b; large where there is no solution."""
    z[0] = -b[0] / W[0, 0] if b[0] < 0.0 < W[0, 0] else 0.0
    return judge(W, b, z, w, s)


def solve_two(W: Any, b: Any, z: Any, w: Any, s: Any, tolerance: float) -> float:
    """Residual of the basis that is right up to rounding; infinite, with z = 0, if none of the four is."""
    for basis in range(4):
        if cramer(W, b, z, basis):
            residual = judge(W, b, z, w, s)
            if residual <= ROUNDING and residual <= tolerance:
                return residual
    z[0], z[1] = 0.0, 0.0
    return np.inf


def cramer(W: Any, b: Any, z: Any, basis: int) -> bool:
    """Fill z with the answer of one basis: 0 none, 1 the first, 2 the second, 3 both positive."""
    z[0], z[1] = 0.0, 0.0
    if basis == 0:
        return bool(b[0] >= 0.0 and b[1] >= 0.0)
    if basis < 3:
        i = basis - 1
        if W[i, i] == 0.0:
            return False
        z[i] = -b[i] / W[i, i]
        return bool(z[i] >= 0.0)
    determinant = W[0, 0] * W[1, 1] - W[0, 1] * W[1, 0]
    if determinant == 0.0:
        return False
    z[0] = (W[0, 1] * b[1] - W[1, 1] * b[0]) / determinant
    z[1] = (W[1, 0] * b[0] - W[0, 0] * b[1]) / determinant
    return bool(z[0] >= 0.0 and z[1] >= 0.0)
