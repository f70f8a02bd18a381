"""Scaling by powers of two, so that no decision of a solver depends on units.

With positive diagonal R and C, z = C z' solves the problem of W and b exactly when z' solves that of R W C
and R b. R and C bring the largest entry of each row and column of R W C near one; powers of two bring no
rounding. What is left free, a common factor of z, makes the largest entry of R b one.
"""

from __future__ import annotations

import cython

from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, abs, after, bits, double_of, max
from lcpstep.rows import largest_magnitude, raise_to, turn_four

# A double x > 0 as an integer: the higher, the larger x; from bit 52 on 1022 plus the k with 2^-k x in [1/2, 1)
INFINITE = 0x7FF0000000000000  # and beyond it what is not a number
MANTISSA = 52
LARGEST_POWER, SMALLEST_POWER = 1023 + 1000, 1023 - 1000


def equilibrate(W: Doubles, b: Doubles, n: int, work: Workspace) -> None:
    """Fill columns, scaled_b, row_scale and column_scale of the work space with the scaled problem."""
    r, c, scaled, columns = work.row_scale, work.column_scale, work.scaled_b, work.columns
    balance(W, r, c, n)
    largest = 0.0
    for i in range(n):
        scaled[i] = r[i] * b[i]
        largest = max(largest, abs(scaled[i]))
    unit = inverse_power(largest)
    for i in range(n):
        scaled[i] *= unit
    first = 0
    while first + 4 <= n:
        turn_four(after(columns, first), after(W, first * n), after(r, first), c, n, n)
        first += 4
    for i in range(first, n):
        for j in range(n):
            columns[j * n + i] = W[i * n + j] * r[i] * c[j]
    for i in range(n):
        r[i], c[i] = r[i] * unit, c[i] / unit


def balance(W: Doubles, r: Doubles, c: Doubles, n: int) -> None:
    """Scale the largest entry of each row, then of each column, to between 1/2 and 1."""
    for i in range(n):
        r[i], c[i] = inverse_power(double_of(largest_magnitude(after(W, i * n), n))), 0.0
    for i in range(n):
        raise_to(c, after(W, i * n), r[i], n)
    for j in range(n):
        c[j] = inverse_power(c[j])


def inverse_power(x: float) -> float:
    """The 2^k with x 2^k in [1/2, 1), at most 2^1000; one for x = 0. x must not be negative."""
    if not bits(x) > 0:
        return 1.0
    power = 1023 + 1022 - (bits(x) >> MANTISSA)
    if power < SMALLEST_POWER:
        power = SMALLEST_POWER
    if power > LARGEST_POWER:
        power = LARGEST_POWER
    return double_of(power << MANTISSA)


def all_finite(W: Doubles, b: Doubles, n: int) -> bool:
    """Whether no entry is NaN or infinite."""
    return largest_magnitude(W, n * n) < INFINITE and largest_magnitude(b, n) < INFINITE
