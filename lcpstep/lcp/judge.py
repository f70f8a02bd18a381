"""The neutral judge: how well z solves 0 <= z, W z + b >= 0, z^T (W z + b) = 0, from W, b and z alone.

The residual is the natural map, max_i |min(z_i, w_i)|, of two numbers without a unit,

    w_i / s_i                    s_i = |b_i| + sum_j |W_ij z_j|   the size of the terms that w_i is a sum of
    z_i max_k |W_ki| / s_k       the largest share that z_i has in any row

so it is unchanged when rows and columns are scaled. It is a componentwise backward error in the sense of
W. Oettli and W. Prager, Numer. Math. 6 (1964) 405: up to a factor n, z solves exactly a problem whose data
differ from W and b by this relative amount.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.compiled import compiled

EPSILON = 2.220446049250313e-16
ROUNDING = 1e-14  # relative error that may be rounding
LITTLE = 1e-2  # part of the size of its row that b keeps as a rule
LOST = 1e-12  # part of the size of its row below which b is lost in rounding


def judge(W: Any, b: Any, z: Any, w: Any, s: Any) -> float:
    """Residual of z for a dense W; fills w = W z + b and the sizes s."""
    n = b.shape[0]
    for i in range(n):
        total, size = row_sums(W[i], z, n)
        w[i], s[i] = b[i] + total, abs(b[i]) + size
    worst = 0.0
    for i in range(n):
        if not s[i] < np.inf:
            return np.inf
        relative = w[i] / s[i] if s[i] > 0.0 else 0.0
        if z[i] < 0.0 or (z[i] > 0.0 and relative > worst):
            worst = max(worst, violation(z[i], relative, share(W, z, s, i)))
        else:
            worst = max(worst, -relative)
    return weighed(worst, b, s)


def row_sums(row: Any, z: Any, n: int) -> tuple[float, float]:
    """Sums of W_ij z_j and of |W_ij z_j|, in partial sums that the processor can overlap."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    e, f, g, h = 0.0, 0.0, 0.0, 0.0
    whole = n - n % 4
    for j in range(0, whole, 4):
        t, u, v, w = row[j] * z[j], row[j + 1] * z[j + 1], row[j + 2] * z[j + 2], row[j + 3] * z[j + 3]
        a, b, c, d = a + t, b + u, c + v, d + w
        e, f, g, h = e + abs(t), f + abs(u), g + abs(v), h + abs(w)
    for j in range(whole, n):
        t = row[j] * z[j]
        a, e = a + t, e + abs(t)
    return (a + b) + (c + d), (e + f) + (g + h)


def violation(z: float, relative: float, part: float) -> float:
    """|min(z, w)| in relative terms: part is the share of |z|, relative is w / s."""
    return max(part, -relative) if z < 0.0 else max(min(part, relative), -relative)


def weighed(worst: float, b: Any, s: Any) -> float:
    """The residual, relative to what is left of b in the rows that z enters, if that is little.

    An infeasible problem with singular W has "solutions" of any size, in which W z + b is as negative as b
    but small next to its terms. Only an error that is rounding may hide behind large terms.
    """
    left, some = 0.0, False
    for i in range(b.shape[0]):
        if b[i] != 0.0 and s[i] > abs(b[i]):
            left, some = max(left, abs(b[i]) / s[i]), True
    if not some or left >= LITTLE or (worst <= ROUNDING and left >= LOST):
        return worst
    return min(1.0, worst / left) if left >= LOST else 1.0


def share(W: Any, z: Any, s: Any, i: int) -> float:
    """Largest relative contribution of z_i to a row; one if no row feels it, for then only zero is right."""
    largest, felt = 0.0, False
    for k in range(z.shape[0]):
        if W[k, i] != 0.0 and s[k] > 0.0:
            felt = True
            largest = max(largest, abs(W[k, i] * z[i]) / s[k])
    return largest if felt else 1.0


def proves_infeasible(W: Any, b: Any, y: Any) -> bool:
    """Whether y >= 0, W^T y <= 0 and b^T y < 0 hold up to rounding, so that W z + b >= 0, z >= 0 cannot.

    For then 0 <= y^T (W z + b) = (W^T y)^T z + b^T y < 0 (Farkas).
    """
    n = b.shape[0]
    slack = 4.0 * n * EPSILON
    for j in range(n + 1):
        total, size = 0.0, 0.0
        for i in range(n):
            term = y[i] * (W[i, j] if j < n else b[i])
            total += term
            size += abs(term)
            if not y[i] >= 0.0:
                return False
        if (j < n and total > slack * size) or (j == n and not total < -slack * size):
            return False
    return True


def residual(W: Any, b: Any, z: Any) -> float:
    """Judged residual of z, dense or sparse W.

    Parameters
    ----------
    W : (n, n) array or scipy.sparse matrix
    b, z : (n,)

    Returns
    -------
    The relative natural-map residual of this module: zero exactly at a solution, about 1e-16 for an answer
    as good as rounding allows, infinite where W z + b overflows or is not a number.
    """
    if hasattr(W, "tocsc"):
        return _sparse(W, b, z)
    W, b, z = (np.array(a, dtype=float, order="C") for a in (W, b, z))
    return float(compiled(judge)(W, b, z, np.empty_like(b), np.empty_like(b)))


def _sparse(W: Any, b: Any, z: Any) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        w = W @ z + b
        s = abs(W) @ np.abs(z) + np.abs(b)
    if not np.all(s < np.inf):
        return float("inf")
    relative = np.divide(w, s, out=np.zeros_like(s), where=s > 0.0)
    doubtful = (z < 0.0) | ((z > 0.0) & (relative > EPSILON))
    parts = shares(W, z, s) if doubtful.any() else np.ones_like(z)
    return float(compiled(_worst)(z, relative, parts, b, s))


def shares(W: Any, z: Any, s: Any) -> Any:
    """Largest relative contribution of each z_i to a row, as `share` has it, for a dense or sparse W."""
    inverse = np.divide(1.0, s, out=np.zeros_like(s), where=s > 0.0)
    if hasattr(W, "tocsc"):
        columns = abs(W).tocsc()
        columns.eliminate_zeros()
        weighted = np.append(columns.data * inverse[columns.indices], 0.0)
        largest = np.maximum.reduceat(weighted, columns.indptr[:-1])
        largest[np.diff(columns.indptr) == 0] = 0.0
    else:
        largest = np.max(np.abs(W) * inverse[:, None], axis=0, initial=0.0)
    return np.where(largest > 0.0, largest * np.abs(z), 1.0)


def _worst(z: Any, relative: Any, parts: Any, b: Any, s: Any) -> float:
    worst = 0.0
    for i in range(z.shape[0]):
        worst = max(worst, violation(z[i], relative[i], parts[i] if z[i] != 0.0 else 0.0))
    return weighed(worst, b, s)
