"""Scaling by powers of two, so that no decision of a solver depends on units.

With positive diagonal R and C, z = C z' solves the problem of W and b exactly when z' solves that of R W C
and R b. R and C bring the largest entry of each row and column of R W C near one; powers of two bring no
rounding. What is left free, a common factor of z, makes the largest entry of R b one.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.lcp.workspace import COLUMN_SCALE, DSLACK, ROW_SCALE, SCALED_B

BLOCK = 8  # columns that are filled together


def equilibrate(W: Any, b: Any, work: Any) -> None:
    """Fill columns, b, rows_by and columns_by of the work arrays with the scaled problem."""
    n = b.shape[0]
    columns, r, c = work.columns, work.vectors[ROW_SCALE], work.vectors[COLUMN_SCALE]
    balance(W, r, c, n, work.vectors[DSLACK])
    largest = 0.0
    for i in range(n):
        largest = max(largest, abs(r[i] * b[i]))
    unit = 1.0 / inverse_power_of_two(largest)
    for i in range(n):
        work.vectors[SCALED_B, i] = r[i] * b[i] / unit
    for first in range(0, n, BLOCK):  # a few columns at a time: all of them would not fit into the caches
        last = min(first + BLOCK, n)
        for i in range(n):
            for j in range(first, last):
                columns[j, i] = W[i, j] * r[i] * c[j]
    for i in range(n):
        r[i], c[i] = r[i] / unit, c[i] * unit


def balance(W: Any, r: Any, c: Any, n: int, largest: Any) -> None:
    """Scale the largest entry of each row, then of each column, to between 1/2 and 1."""
    for j in range(n):
        largest[j] = 0.0
    for i in range(n):
        row = W[i]
        r[i] = inverse_power_of_two(largest_entry(row, n))
        for j in range(n):
            largest[j] = max(largest[j], abs(row[j]) * r[i])
    for j in range(n):
        c[j] = inverse_power_of_two(largest[j])


def largest_entry(x: Any, n: int) -> float:
    """Largest |x_i| for i < n, in four parts that the processor can overlap."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = n - n % 4
    for i in range(0, whole, 4):
        a, b = max(a, abs(x[i])), max(b, abs(x[i + 1]))
        c, d = max(c, abs(x[i + 2])), max(d, abs(x[i + 3]))
    for i in range(whole, n):
        a = max(a, abs(x[i]))
    return max(max(a, b), max(c, d))


def inverse_power_of_two(x: float) -> float:
    """The 2^k with x 2^k in [1/2, 1); one for x = 0."""
    return math.ldexp(1.0, min(max(-math.frexp(x)[1], -1000), 1000)) if x > 0.0 else 1.0
