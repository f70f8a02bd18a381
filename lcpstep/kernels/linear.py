"""Small dense linear algebra inside kernels, without allocation: elimination with pivoting, Cholesky's method.

Matrices lie row by row. Source: G. Golub, C. Van Loan, Matrix Computations, algorithms 3.4.1 and 4.2.1. LAPACK pays
off only beyond the sizes that mechanisms have.
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.kernels.vectors import size_of_product
from lcpstep.pointers import Doubles, Indices, abs, after

DEPENDENT = 2.0**-50  # relative rounding: what a row must have more of that the rows before it have not
ROUNDED = 2.0**-46  # of the terms of a sum: less is rounding of these, and of what they were solved for
# Of the product of two rows' own mobilities: the square of one between them that is rounding, or may be
APART, DOUBTFUL = 2.0**-92, 2.0**-64


def factorise(A: Doubles, pivots: Indices, n: int) -> bool:
    """P A = L U in place; False where A is singular or not finite."""
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(A[i * n + k]) > abs(A[best * n + k]):
                best = i
        pivots[k] = best
        if not abs(A[best * n + k]) > 0.0:
            return False
        if best != k:
            for j in range(n):
                A[k * n + j], A[best * n + j] = A[best * n + j], A[k * n + j]
        for i in range(k + 1, n):
            A[i * n + k] /= A[k * n + k]
            for j in range(k + 1, n):
                A[i * n + j] -= A[i * n + k] * A[k * n + j]
    return True


def solve(A: Doubles, pivots: Indices, x: Doubles, n: int) -> None:
    """x <- A^-1 x, with A from `factorise`."""
    for k in range(n):
        x[k], x[pivots[k]] = x[pivots[k]], x[k]
    solve_triangles(A, n, n, x)


def solve_triangles(LU: Doubles, stride: int, n: int, x: Doubles) -> None:
    """X[:n] <- (L U)^-1 x[:n] for the first n rows and columns of both, `stride` numbers a row; L has ones within."""
    for i in range(n):
        for j in range(i):
            x[i] -= LU[i * stride + j] * x[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            x[i] -= LU[i * stride + j] * x[j]
        x[i] /= LU[i * stride + i]


def invert_matrix(A: Doubles, pivots: Indices, scale: float, column: Doubles, out: Doubles, n: int) -> None:
    """Out <- scale A^-1; A becomes its factors. column : (n,)   work space."""
    factorise(A, pivots, n)
    for j in range(n):
        for i in range(n):
            column[i] = scale if i == j else 0.0
        solve(A, pivots, column, n)
        for i in range(n):
            out[i * n + j] = column[i]


def positive_definite(A: Doubles, n: int) -> bool:
    """Whether a symmetric A is finite and positive definite: Cholesky's method, A = L L^T, in its lower half."""
    for k in range(n):
        for j in range(k):
            A[k * n + k] -= A[k * n + j] * A[k * n + j]
        if not (A[k * n + k] > 0.0 and A[k * n + k] - A[k * n + k] == 0.0):
            return False
        A[k * n + k] = sqrt(A[k * n + k])
        for i in range(k + 1, n):
            for j in range(k):
                A[i * n + k] -= A[i * n + j] * A[k * n + j]
            A[i * n + k] /= A[k * n + k]
    return True


def solve_definite(L: Doubles, x: Doubles, n: int) -> None:
    """X <- A^-1 x, with L from `positive_definite`."""
    solve_factored(L, n, n, x)


def solve_factored(L: Doubles, stride: int, n: int, x: Doubles) -> None:
    """X[:n] <- (L L^T)^-1 x[:n] for the first n rows and columns of a lower triangle L, `stride` numbers a row."""
    for i in range(n):
        for j in range(i):
            x[i] -= L[i * stride + j] * x[j]
        x[i] /= L[i * stride + i]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            x[i] -= L[j * stride + i] * x[j]
        x[i] /= L[i * stride + i]


def grow_factor(D: Doubles, n_D: int, L: Doubles, n_L: int, rows: Indices, doubt: Doubles, k: int) -> bool:
    """Row k of the Cholesky factor L of D[rows, rows]; False where it depends on those before, to rounding.

    D (n_D columns) is symmetric and positive semidefinite; L has n_L. `doubt` keeps the relative errors of the
    diagonal, in units of rounding.
    """
    i = rows[k]
    pivot = size_of_pivot = D[i * n_D + i]
    first = 0  # of the rows that this one is coupled with; those of a chain are few
    while first < k and D[i * n_D + rows[first]] == 0.0:
        L[k * n_L + first] = 0.0
        first += 1
    for m in range(first, k):
        total = D[i * n_D + rows[m]]
        size = abs(total)
        for n in range(first, m):
            total -= L[k * n_L + n] * L[m * n_L + n]
            size += abs(L[k * n_L + n] * L[m * n_L + n])
        x = total / L[m * n_L + m]
        L[k * n_L + m] = x
        pivot -= x * x
        size_of_pivot += 2.0 * abs(x) * (size / L[m * n_L + m] + abs(x) * doubt[m])
    if not pivot > DEPENDENT * size_of_pivot:
        return False
    L[k * n_L + k] = sqrt(pivot)
    doubt[k] = 0.5 * size_of_pivot / pivot
    return True


def uncouple(W: Doubles, R: Doubles, X: Doubles, first: int, last: int, n: int, n_q: int) -> None:
    """Take for nothing what is rounding in the mobilities W = R X^T (n numbers a row) of the rows from first to last.

    In coordinates that mix bodies apart from each other these sums cancel but for that. It would tie a contact at
    rest to every blow elsewhere, and be all that a complementarity problem has in its row.
    """
    for i in range(first, last):
        for k in range(first, i):
            uncouple_two(W, R, X, i, k, n, n_q)


def uncouple_two(W: Doubles, R: Doubles, X: Doubles, i: int, k: int, n: int, n_q: int) -> None:
    """The same of rows i and k, which are not one."""
    one, other, own = W[i * n + k], W[k * n + i], W[i * n + i] * W[k * n + k]
    if one != 0.0 and cancels(one, own, after(R, i * n_q), after(X, k * n_q), n_q):
        W[i * n + k] = 0.0
    if other != 0.0 and cancels(other, own, after(R, k * n_q), after(X, i * n_q), n_q):
        W[k * n + i] = 0.0


def cancels(both: float, own: float, row: Doubles, way: Doubles, n_q: int) -> bool:
    """Whether a row times what another does is rounding; own: the product of what each of them does to itself."""
    if not both * both < DOUBTFUL * own:
        return False
    return both * both < APART * own or abs(both) <= ROUNDED * size_of_product(row, way, 0, n_q)
