"""Directions of constraints and how a system answers forces along them: kernels on rows of numbers."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.linear import solve_definite
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import Doubles, Indices, after


def mobilities(H: Doubles, X: Doubles, ids: Indices, n_k: int, W: Doubles, n: int, n_q: int) -> None:
    """W = H X^T on the rows that take part."""
    for k in range(n_k):
        for m in range(n_k):
            W[ids[k] * n + ids[m]] = product(H, after(X, ids[m] * n_q), ids[k], n_q)


def divide_by_mass(
    constant: bool, inverse: Doubles, L: Doubles, row: Doubles, out: Doubles, n_q: int
) -> None:
    """Out <- M^-1 row, by the inverse of a constant mass or else by Cholesky's factor L."""
    copy(out, row, n_q)
    if constant:
        for i in range(n_q):
            out[i] = product(inverse, row, i, n_q)
    else:
        solve_definite(L, out, n_q)
