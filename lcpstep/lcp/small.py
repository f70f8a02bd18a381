"""Closed forms for one and two unknowns, each answer judged.

One unknown: z = max(0, -b / W). Two: the four complementary bases, solved by Cramer's rule, in the order of
their size.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.judge import judge
from lcpstep.pointers import Doubles, inf

ROUNDING = 1e-14  # residual up to which Cramer's rule is accurate enough


def solve_closed(
    W: Doubles, b: Doubles, z: Doubles, n: int, w: Doubles, s: Doubles, tolerance: float
) -> float:
    """Residual of the closed form for one or two unknowns; fills z, w and the sizes s of the terms of w."""
    if n == 1:
        return solve_one(W, b, z, w, s)
    return solve_two(W, b, z, w, s, tolerance)


def solve_one(W: Doubles, b: Doubles, z: Doubles, w: Doubles, s: Doubles) -> float:
    """Residual of z = max(0, -b / W) for numbers W and b; large where there is no solution."""
    z[0] = -b[0] / W[0] if b[0] < 0.0 and W[0] > 0.0 else 0.0
    return judge(W, b, z, 1, w, s)


def solve_two(W: Doubles, b: Doubles, z: Doubles, w: Doubles, s: Doubles, tolerance: float) -> float:
    """Residual of the basis that is right up to rounding; infinite, with z = 0, if none of the four is."""
    for basis in range(4):
        if cramer(W, b, z, basis):
            residual = judge(W, b, z, 2, w, s)
            if residual <= ROUNDING and residual <= tolerance:
                return residual
    z[0], z[1] = 0.0, 0.0
    return inf


def cramer(W: Doubles, b: Doubles, z: Doubles, basis: int) -> bool:
    """Fill z with the answer of one basis: 0 none, 1 the first, 2 the second, 3 both positive."""
    z[0], z[1] = 0.0, 0.0
    if basis == 0:
        return b[0] >= 0.0 and b[1] >= 0.0
    if basis < 3:
        i = basis - 1
        if W[3 * i] == 0.0:
            return False
        z[i] = -b[i] / W[3 * i]
        return z[i] >= 0.0
    determinant = W[0] * W[3] - W[1] * W[2]
    if determinant == 0.0:
        return False
    z[0] = (W[1] * b[1] - W[3] * b[0]) / determinant
    z[1] = (W[2] * b[0] - W[0] * b[1]) / determinant
    return z[0] >= 0.0 and z[1] >= 0.0
