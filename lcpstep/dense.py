"""Small dense linear algebra inside kernels, without allocation: copies, and Gaussian elimination with pivoting.

Source: G. Golub, C. Van Loan, Matrix Computations, algorithm 3.4.1. LAPACK pays off only beyond the sizes that
mechanisms have, and cannot be called from here without allocating.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import inline

DEPENDENT = 2.0**-50  # relative rounding: what a row must have more of that the rows before it have not


@inline
def assign(x: Any, y: Any) -> None:
    """X <- y, for arrays of one shape that do not overlap."""
    for i in range(x.size):
        x.flat[i] = y.flat[i]


def add(x: Any, factor: float, y: Any) -> None:
    """X <- x + factor y."""
    for i in range(x.size):
        x.flat[i] += factor * y.flat[i]


@inline
def largest(x: Any, least: float) -> float:
    """Largest magnitude of the entries of x, or `least`."""
    for i in range(len(x)):
        least = max(least, abs(x[i]))
    return least


def join(x: Any, y: Any, z: Any) -> None:
    """X <- (y, z)."""
    for i in range(len(y)):
        x[i], x[len(y) + i] = y[i], z[i]


def split(x: Any, y: Any, z: Any) -> None:
    """(y, z) <- x."""
    for i in range(len(y)):
        y[i], z[i] = x[i], x[len(y) + i]


def factorise(A: Any, pivots: Any) -> bool:
    """P A = L U in place; False where A is singular or not finite."""
    n = len(A)
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i, k]) > abs(A[best, k]):
                best = i
        pivots[k] = best
        if not abs(A[best, k]) > 0.0:
            return False
        if best != k:
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
        for i in range(k + 1, n):
            A[i, k] /= A[k, k]
            for j in range(k + 1, n):
                A[i, j] -= A[i, k] * A[k, j]
    return True


def solve(A: Any, pivots: Any, x: Any) -> None:
    """x <- A^-1 x, with A from `factorise`."""
    n = len(A)
    for k in range(n):
        x[k], x[pivots[k]] = x[pivots[k]], x[k]
    for k in range(n):
        for i in range(k + 1, n):
            x[i] -= A[i, k] * x[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            x[k] -= A[k, j] * x[j]
        x[k] /= A[k, k]


def positive_definite(A: Any) -> bool:
    """Whether a symmetric A is positive definite: Cholesky's method, A = L L^T, in the lower half of A."""
    for k in range(len(A)):
        for j in range(k):
            A[k, k] -= A[k, j] * A[k, j]
        if not A[k, k] > 0.0:
            return False
        A[k, k] = math.sqrt(A[k, k])
        for i in range(k + 1, len(A)):
            for j in range(k):
                A[i, k] -= A[i, j] * A[k, j]
            A[i, k] /= A[k, k]
    return True


def solve_definite(L: Any, x: Any) -> None:
    """X <- A^-1 x, with L from `positive_definite`."""
    solve_factored(L, len(L), x)


def solve_factored(L: Any, n: int, x: Any) -> None:
    """X[:n] <- (L L^T)^-1 x[:n] for the first n rows and columns of a lower triangle L."""
    for i in range(n):
        for j in range(i):
            x[i] -= L[i, j] * x[j]
        x[i] /= L[i, i]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            x[i] -= L[j, i] * x[j]
        x[i] /= L[i, i]


def grow_factor(D: Any, L: Any, rows: Any, doubt: Any, k: int) -> bool:
    """Row k of the Cholesky factor L of D[rows, rows]; False where it depends on those before, to rounding.

    D is symmetric and positive semidefinite. `doubt` keeps the relative errors of the diagonal, in units of
    rounding.
    """
    i = rows[k]
    pivot = size_of_pivot = D[i, i]
    first = 0  # of the rows that this one is coupled with; those of a chain are few
    while first < k and D[i, rows[first]] == 0.0:
        L[k, first] = 0.0
        first += 1
    for m in range(first, k):
        total = D[i, rows[m]]
        size = abs(total)
        for n in range(first, m):
            total -= L[k, n] * L[m, n]
            size += abs(L[k, n] * L[m, n])
        x = total / L[m, m]
        L[k, m] = x
        pivot -= x * x
        size_of_pivot += 2.0 * abs(x) * (size / L[m, m] + abs(x) * doubt[m])
    if not pivot > DEPENDENT * size_of_pivot:
        return False
    L[k, k] = math.sqrt(pivot)
    doubt[k] = 0.5 * size_of_pivot / pivot
    return True
