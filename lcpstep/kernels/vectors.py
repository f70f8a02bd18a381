"""Short loops over short vectors, which the compiler merges into the kernels that use them: no calls, no checks.

For long rows see `lcpstep.rows`.
"""

from __future__ import annotations

import cython

from lcpstep.pointers import Doubles, Indices, abs


def copy(x: Doubles, y: Doubles, n: int) -> None:
    """X <- y."""
    for i in range(n):
        x[i] = y[i]


def clear(x: Doubles, n: int) -> None:
    """X <- 0."""
    for i in range(n):
        x[i] = 0.0


def add(x: Doubles, factor: float, y: Doubles, n: int) -> None:
    """X <- x + factor y."""
    for i in range(n):
        x[i] += factor * y[i]


def product(G: Doubles, v: Doubles, c: int, n: int) -> float:
    """(G v)_c."""
    total = 0.0
    for j in range(n):
        total += G[c * n + j] * v[j]
    return total


def product_between(G: Doubles, v: Doubles, c: int, n: int, ends: Indices) -> float:
    """(G v)_c, the entries of row c before the column ends[2 c], and from ends[2 c + 1] on, being zero."""
    total = 0.0
    for j in range(ends[2 * c], ends[2 * c + 1]):
        total += G[c * n + j] * v[j]
    return total


def filled(x: Doubles, n: int, places: Indices) -> int:
    """How many entries of x are not zero, and where they are."""
    n_k = 0
    for j in range(n):
        if x[j] != 0.0:
            places[n_k] = j
            n_k += 1
    return n_k


def product_at(G: Doubles, v: Doubles, c: int, n: int, places: Indices, n_k: int) -> float:
    """(G v)_c, all entries of v but these being zero."""
    total = 0.0
    for k in range(n_k):
        total += G[c * n + places[k]] * v[places[k]]
    return total


def size_of_product(G: Doubles, v: Doubles, c: int, n: int) -> float:
    """Size of the terms of (G v)_c, their signs left aside."""
    size = 0.0
    for j in range(n):
        size += abs(G[c * n + j] * v[j])
    return size


def product_and_size(G: Doubles, v: Doubles, c: int, n: int) -> tuple[float, float]:
    """(G v)_c and the size of its terms, by one way through the row."""
    total = size = 0.0
    for j in range(n):
        term = G[c * n + j] * v[j]
        total += term
        size += abs(term)
    return total, size


def largest(x: Doubles, least: float, n: int) -> float:
    """Largest magnitude of the entries of x, or `least`."""
    for i in range(n):
        if x[i] > least:
            least = x[i]
        elif -x[i] > least:
            least = -x[i]
    return least


def finite(x: Doubles, n: int) -> bool:
    """Whether no entry is nan or infinite."""
    total = 0.0
    for i in range(n):
        total += x[i] - x[i]
    return total == 0.0


def distance(x: Doubles, y: Doubles, n: int) -> float:
    """Largest difference of two vectors."""
    most = 0.0
    for i in range(n):
        if x[i] - y[i] > most:
            most = x[i] - y[i]
        elif y[i] - x[i] > most:
            most = y[i] - x[i]
    return most


def copy_indices(x: Indices, y: Indices, n: int) -> None:
    """X <- y, of indices."""
    for i in range(n):
        x[i] = y[i]
