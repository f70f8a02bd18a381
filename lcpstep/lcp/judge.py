"""The neutral judge, as kernels: how well z solves 0 <= z, W z + b >= 0, z^T (W z + b) = 0, from W, b and z alone.

The residual is the natural map, max_i |min(z_i, w_i)|, of two numbers without a unit,

    w_i / s_i                    s_i = |b_i| + sum_j |W_ij z_j|   the size of the terms that w_i is a sum of
    z_i max_k |W_ki| / s_k       the largest share that z_i has in any row

so it is unchanged when rows and columns are scaled. It is a componentwise backward error in the sense of
W. Oettli and W. Prager, Numer. Math. 6 (1964) 405: up to a factor n, z solves exactly a problem whose data
differ from W and b by this relative amount.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.pointers import Doubles, abs, after, inf, max, min
from lcpstep.rows import dot, dot_sizes

EPSILON = 2.220446049250313e-16
ROUNDING = 1e-14  # relative error that may be rounding
LITTLE = 1e-2  # part of the size of its row that b keeps as a rule
LOST = 1e-12  # part of the size of its row below which b is lost in rounding


def judge(W: Doubles, b: Doubles, z: Doubles, n: int, w: Doubles, s: Doubles) -> float:
    """Residual of z for a dense W; fills w = W z + b and the sizes s."""
    for i in range(n):
        row = after(W, i * n)
        w[i], s[i] = b[i] + dot(row, z, n), abs(b[i]) + dot_sizes(row, z, n)
    worst = 0.0
    for i in range(n):
        if not s[i] < inf:
            return inf
        relative = w[i] / s[i] if s[i] > 0.0 else 0.0
        if z[i] < 0.0 or (z[i] > 0.0 and relative > worst):
            worst = max(worst, violation(z[i], relative, share(W, z, n, s, i)))
        else:
            worst = max(worst, -relative)
    return weighed(worst, b, s, n)


def violation(z: float, relative: float, part: float) -> float:
    """|min(z, w)| in relative terms: part is the share of |z|, relative is w / s."""
    return max(part, -relative) if z < 0.0 else max(min(part, relative), -relative)


def weighed(worst: float, b: Doubles, s: Doubles, n: int) -> float:
    """The residual, relative to what is left of b in the rows that z enters, if that is little.

    An infeasible problem with singular W has "solutions" of any size, in which W z + b is as negative as b
    but small next to its terms. Only an error that is rounding may hide behind large terms.
    """
    left, some = 0.0, False
    for i in range(n):
        if b[i] != 0.0 and s[i] > abs(b[i]):
            left, some = max(left, abs(b[i]) / s[i]), True
    if not some or left >= LITTLE or (worst <= ROUNDING and left >= LOST):
        return worst
    return min(1.0, worst / left) if left >= LOST else 1.0


def share(W: Doubles, z: Doubles, n: int, s: Doubles, i: int) -> float:
    """Largest relative contribution of z_i to a row; one if no row feels it, for then only zero is right."""
    largest, felt = 0.0, False
    for k in range(n):
        if W[k * n + i] != 0.0 and s[k] > 0.0:
            felt = True
            largest = max(largest, abs(W[k * n + i] * z[i]) / s[k])
    return largest if felt else 1.0


def proves_infeasible(W: Doubles, b: Doubles, y: Doubles, n: int) -> bool:
    """Whether y >= 0, W^T y <= 0 and b^T y < 0 hold up to rounding, so that W z + b >= 0, z >= 0 cannot.

    For then 0 <= y^T (W z + b) = (W^T y)^T z + b^T y < 0 (Farkas).
    """
    slack = 4.0 * n * EPSILON
    for j in range(n + 1):
        total, size = 0.0, 0.0
        for i in range(n):
            term = y[i] * (W[i * n + j] if j < n else b[i])
            total += term
            size += abs(term)
            if not y[i] >= 0.0:
                return False
        if (j < n and total > slack * size) or (j == n and not total < -slack * size):
            return False
    return True


def worst_of(z: Doubles, relative: Doubles, parts: Doubles, b: Doubles, s: Doubles, n: int) -> float:
    """The residual, from w / s and the shares of z."""
    largest = 0.0
    for i in range(n):
        largest = max(largest, violation(z[i], relative[i], parts[i] if z[i] != 0.0 else 0.0))
    return weighed(largest, b, s, n)


def judge_dense(W: Any, b: Any, z: Any) -> float:
    """`judge`, called from Python with float64 arrays in C order."""
    w, s = np.empty_like(b), np.empty_like(b)
    return judge(doubles(W), doubles(b), doubles(z), len(b), doubles(w), doubles(s))


def judge_terms(z: Any, relative: Any, parts: Any, b: Any, s: Any) -> float:
    """`worst_of` in the same way."""
    return worst_of(doubles(z), doubles(relative), doubles(parts), doubles(b), doubles(s), len(b))


def is_proof(W: Any, b: Any, y: Any) -> bool:
    """`proves_infeasible` in the same way."""
    return proves_infeasible(doubles(W), doubles(b), doubles(y), len(b))
