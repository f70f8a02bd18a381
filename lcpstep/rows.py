"""Loops over rows of numbers, as kernels: where the time of a large problem goes.

On x86 under Linux the compiler also makes a version of most for newer processors, and the one that suits is taken
when the library is loaded (`rows.h`). All round alike: sums are formed in four parts, and nothing is fused.
"""

from __future__ import annotations

import cython

from lcpstep.pointers import Doubles, abs, after, bits, inf, max, min

MAGNITUDE = 0x7FFFFFFFFFFFFFFF  # all bits of a double but its sign


def dot(x: Doubles, y: Doubles, m: int) -> float:
    """Sum of x_i y_i for i < m, in four partial sums that the processor can overlap."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = m - m % 4
    for i in range(0, whole, 4):
        a += x[i] * y[i]
        b += x[i + 1] * y[i + 1]
        c += x[i + 2] * y[i + 2]
        d += x[i + 3] * y[i + 3]
    for i in range(whole, m):
        a += x[i] * y[i]
    return (a + b) + (c + d)


def dot_sizes(x: Doubles, y: Doubles, m: int) -> float:
    """Sum of |x_i y_i| for i < m, in four parts as well; beside `dot`, for both in one loop are slower than apart."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = m - m % 4
    for i in range(0, whole, 4):
        a += abs(x[i] * y[i])
        b += abs(x[i + 1] * y[i + 1])
        c += abs(x[i + 2] * y[i + 2])
        d += abs(x[i + 3] * y[i + 3])
    for i in range(whole, m):
        a += abs(x[i] * y[i])
    return (a + b) + (c + d)


def subtract(target: Doubles, source: Doubles, factor: float, m: int) -> None:
    """Target -= factor * source in the first m entries."""
    for i in range(m):
        target[i] -= factor * source[i]


def add_four(target: Doubles, x: Doubles, stride: int, by: Doubles, jump: int, m: int) -> None:
    """Target += by_0 x_0 + .. + by_3 x_3 for i < m; x_k begins at x[k * stride], by_k is by[k * jump]."""
    t, u, v, w = x, after(x, stride), after(x, 2 * stride), after(x, 3 * stride)
    a, b, c, d = by[0], by[jump], by[2 * jump], by[3 * jump]
    for i in range(m):
        target[i] += (a * t[i] + b * u[i]) + (c * v[i] + d * w[i])


def ratios(target: Doubles, x: Doubles, slack: float, d: Doubles, smallest: float, m: int) -> None:
    """Target = (max(x, 0) + slack) / -d where -d is above `smallest`, else infinite."""
    for i in range(m):
        target[i] = (max(x[i], 0.0) + slack) / -d[i] if -d[i] > smallest else inf


def excesses(target: Doubles, x: Doubles, bound: float, d: Doubles, smallest: float, m: int) -> None:
    """Target = x + bound d where -d is above `smallest`, else infinite: at most zero where x is used up by then."""
    for i in range(m):
        target[i] = x[i] + bound * d[i] if -d[i] > smallest else inf


def raise_to(target: Doubles, x: Doubles, factor: float, m: int) -> None:
    """Target = max(target, |x| factor) in the first m entries."""
    for i in range(m):
        target[i] = max(target[i], abs(x[i]) * factor)


def largest_magnitude(x: Doubles, m: int) -> int:
    """Largest |x_i| for i < m as an integer, in four parts; integers are compared, and not-a-number is largest."""
    a, b, c, d, part = bits(0.0), bits(0.0), bits(0.0), bits(0.0), m // 4
    y, z, w = after(x, part), after(x, 2 * part), after(x, 3 * part)
    for i in range(part):
        a, b = larger(a, bits(x[i]) & MAGNITUDE), larger(b, bits(y[i]) & MAGNITUDE)
        c, d = larger(c, bits(z[i]) & MAGNITUDE), larger(d, bits(w[i]) & MAGNITUDE)
    for i in range(4 * part, m):
        a = larger(a, bits(x[i]) & MAGNITUDE)
    return larger(larger(a, b), larger(c, d))


def larger(a: int, b: int) -> int:
    """The larger of two integers."""
    return a if a > b else b


def turn_four(target: Doubles, x: Doubles, by: Doubles, c: Doubles, stride: int, m: int) -> None:
    """Four rows x_k, that begin at x[k * stride], as columns of m rows of the target: by_k x_ki c_i."""
    t, u, v, w = x, after(x, stride), after(x, 2 * stride), after(x, 3 * stride)
    r, s, p, q = by[0], by[1], by[2], by[3]
    for i in range(m):
        target[i * stride] = t[i] * r * c[i]
        target[i * stride + 1] = u[i] * s * c[i]
        target[i * stride + 2] = v[i] * p * c[i]
        target[i * stride + 3] = w[i] * q * c[i]


def multiply(target: Doubles, factor: float, m: int) -> None:
    """Target *= factor in the first m entries."""
    for i in range(m):
        target[i] *= factor


def copy(target: Doubles, source: Doubles, m: int) -> None:
    """Target = source in the first m entries."""
    for i in range(m):
        target[i] = source[i]


def largest_entry(x: Doubles, m: int) -> float:
    """Largest |x_i| for i < m, in four parts that the processor can overlap."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = m - m % 4
    for i in range(0, whole, 4):
        a, b = max(a, abs(x[i])), max(b, abs(x[i + 1]))
        c, d = max(c, abs(x[i + 2])), max(d, abs(x[i + 3]))
    for i in range(whole, m):
        a = max(a, abs(x[i]))
    return max(max(a, b), max(c, d))


def lowest_entry(x: Doubles, m: int) -> float:
    """Lowest x_i for i < m, in four parts as well."""
    a, b, c, d = inf, inf, inf, inf
    whole = m - m % 4
    for i in range(0, whole, 4):
        a, b, c, d = min(a, x[i]), min(b, x[i + 1]), min(c, x[i + 2]), min(d, x[i + 3])
    for i in range(whole, m):
        a = min(a, x[i])
    return min(min(a, b), min(c, d))
