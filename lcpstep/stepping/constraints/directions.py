"""Directions of constraints and how a system answers forces along them: kernels on rows of numbers."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.vectors import product
    from lcpstep.pointers import Doubles, Indices, after


def mobilities(H: Doubles, X: Doubles, ids: Indices, n_k: int, W: Doubles, n: int, n_q: int) -> None:
    """W = H X^T on the rows that take part."""
    for k in range(n_k):
        for m in range(n_k):
            W[ids[k] * n + ids[m]] = product(H, after(X, ids[m] * n_q), ids[k], n_q)
