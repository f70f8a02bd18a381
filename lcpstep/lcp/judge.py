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
from lcpstep.lcp.status import FINER, LITTLE, LOST, MERE
from lcpstep.pointers import Doubles, abs, after, inf, max, min
from lcpstep.rows import dot, dot_sizes

EPSILON = 2.220446049250313e-16


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
    worst = weighed(worst, b, s, n)
    return weighed_by_row(worst, W, b, z, n, w, s) if worst < LITTLE else worst


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
    if not some or left >= LITTLE or (worst <= MERE and left >= LOST):
        return worst
    return min(1.0, worst / left) if left >= LOST else 1.0


def weighed_by_row(worst: float, W: Doubles, b: Doubles, z: Doubles, n: int, w: Doubles, s: Doubles) -> float:
    """The residual by the same rule for each row with little left of b: as if alone with the rows it hangs on.

    Beside rows in which all is well, others may have terms of any size among themselves, their b lost. Two rows
    hang on each other where they share a z that is among the largest terms of both.
    """
    level, wrong = 0.0, worst > MERE
    for i in range(n):
        if b[i] != 0.0 and abs(b[i]) < LITTLE * s[i]:
            if wrong and error_of(W, z, n, w, s, i) > MERE:
                level = LITTLE
                break
            if abs(b[i]) < LOST * s[i]:
                level = LOST
    while level > 0.0:
        settled = True
        hold(W, b, z, n, w, s, level)
        for i in range(n):
            w[i] = b[i] + dot(after(W, i * n), z, n)
        for i in range(n):
            if s[i] > 0.0 and b[i] != 0.0:
                settled = False
                error = error_of(W, z, n, w, s, i) if wrong else 0.0
                if error > MERE:
                    worst = max(worst, min(1.0, error / level))
            s[i] = abs(s[i])
        if settled:
            return worst
        if level <= LOST:
            return 1.0
        level = max(FINER * level, LOST)
    return worst


def error_of(W: Doubles, z: Doubles, n: int, w: Doubles, s: Doubles, i: int) -> float:
    """The violation of row i."""
    size = abs(s[i])
    relative = w[i] / size if size > 0.0 else 0.0
    if z[i] == 0.0 or (z[i] > 0.0 and relative <= 0.0):
        return max(-relative, 0.0)
    return violation(z[i], relative, share(W, z, n, s, i))


def hold(W: Doubles, b: Doubles, z: Doubles, n: int, held: Doubles, s: Doubles, level: float) -> None:
    """Change the sign of s in rows of which b is this part, and in those that hang on them.

    `held` is filled with the z that are among the largest terms of such rows.
    """
    waiting, turn, changed = 0, 0, True
    for j in range(n):
        held[j] = 0.0
    for i in range(n):
        if b[i] != 0.0 and abs(b[i]) >= level * s[i]:
            hold_row(W, z, n, held, s, level, i)
        elif b[i] != 0.0:
            waiting += 1
    while changed and waiting > 0:
        changed = False
        for c in range(n):
            i = c if turn == 0 else n - 1 - c
            if s[i] > 0.0 and dot_sizes(after(W, i * n), held, n) >= level * s[i]:
                hold_row(W, z, n, held, s, level, i)
                changed = True
                if b[i] != 0.0:
                    waiting -= 1
        turn = 1 - turn


def hold_row(W: Doubles, z: Doubles, n: int, held: Doubles, s: Doubles, level: float, i: int) -> None:
    """Mark the row, and its largest terms."""
    row, least = after(W, i * n), level / (n + 1) * s[i]
    for j in range(n):  # without a branch, so that several are looked at at once
        held[j] = z[j] if abs(row[j] * z[j]) >= least else held[j]
    s[i] = -s[i]


def share(W: Doubles, z: Doubles, n: int, s: Doubles, i: int) -> float:
    """Largest relative contribution of z_i to a row; one if no row feels it, for then only zero is right."""
    largest, felt = 0.0, False
    for k in range(n):
        if W[k * n + i] != 0.0 and s[k] != 0.0:
            felt = True
            largest = max(largest, abs(W[k * n + i] * z[i] / s[k]))
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
