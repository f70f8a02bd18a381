"""Scaling by powers of two, so that no decision of a solver depends on units.

With positive diagonal R and C, z = C z' solves the problem of W and b exactly when z' solves that of R W C
and R b. R and C bring the largest entry of each row and column of R W C near one; powers of two bring no
rounding. What is left free, a common factor of z, makes the largest entry of R b one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.workspace import COLUMN_SCALE, DSLACK, ROW_SCALE, SCALED_B

# A double x > 0 as an integer: the higher, the larger x; from bit 52 on 1022 plus the k with 2^-k x in [1/2, 1)
MAGNITUDE = 0x7FFFFFFFFFFFFFFF  # all bits but the sign
INFINITY = 0x7FF0000000000000  # and beyond it what is not a number
MANTISSA = 52
LARGEST_POWER, SMALLEST_POWER = 1023 + 1000, 1023 - 1000


def equilibrate(W: Any, b: Any, work: Any) -> None:
    """Fill columns, b, rows_by and columns_by of the work arrays with the scaled problem."""
    n = b.shape[0]
    r, c, scaled = work.vectors[ROW_SCALE], work.vectors[COLUMN_SCALE], work.vectors[SCALED_B]
    balance(W, r, c, n)
    unit = work.vectors[DSLACK]
    unit[0] = 0.0
    for i in range(n):
        scaled[i] = r[i] * b[i]
        unit[0] = max(unit[0], abs(scaled[i]))
    to_inverse_powers(unit, 1)
    for i in range(n):
        scaled[i] *= unit[0]
    for j in range(n):
        column, factor = work.columns[j], c[j]
        for i in range(n):
            column[i] = W[i, j] * r[i] * factor
    for i in range(n):
        r[i], c[i] = r[i] * unit[0], c[i] / unit[0]


def balance(W: Any, r: Any, c: Any, n: int) -> None:
    """Scale the largest entry of each row, then of each column, to between 1/2 and 1."""
    bits = r.view(np.int64)
    for i in range(n):
        bits[i], c[i] = largest_magnitude(W[i], n), 0.0
    to_inverse_powers(r, n)
    for i in range(n):
        row, factor = W[i], r[i]
        for j in range(n):
            c[j] = max(c[j], abs(row[j]) * factor)
    to_inverse_powers(c, n)


def largest_magnitude(x: Any, n: int) -> int:
    """Largest |x_i| for i < n as an integer; integers are compared several at a time."""
    bits, largest = x.view(np.int64), 0
    for i in range(n):
        largest = max(largest, bits[i] & MAGNITUDE)
    return largest


def to_inverse_powers(x: Any, n: int) -> None:
    """Replace every x_i >= 0 by the 2^k with x_i 2^k in [1/2, 1), at most 2^1000; zero by one."""
    bits = x.view(np.int64)
    for i in range(n):
        power = min(max(1023 + 1022 - (bits[i] >> MANTISSA), SMALLEST_POWER), LARGEST_POWER)
        bits[i] = (power if bits[i] > 0 else 1023) << MANTISSA


def all_finite(W: Any, b: Any) -> bool:
    """Whether no entry is NaN or infinite."""
    n = b.shape[0]
    largest = largest_magnitude(b, n)
    for i in range(n):
        largest = max(largest, largest_magnitude(W[i], n))
    return largest < INFINITY
