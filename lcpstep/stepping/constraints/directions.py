"""Directions of constraints and how a system answers forces along them: kernels on rows of numbers."""

from __future__ import annotations

import cython

from lcpstep.kernels.vectors import clear, largest, product
from lcpstep.pointers import Doubles, Indices, after

HELD = 1e-9  # of a row: what is left of it where the place is off joints that turn by rounding


def mobilities(H: Doubles, X: Doubles, ids: Indices, n_k: int, W: Doubles, n: int, n_q: int) -> None:
    """W = H X^T on the rows that take part."""
    for k in range(n_k):
        for m in range(n_k):
            W[ids[k] * n + ids[m]] = product(H, after(X, ids[m] * n_q), ids[k], n_q)


def forget_rounding(left: Doubles, row: Doubles, n_q: int) -> None:
    """What joints that turn leave of a row is nothing if it may be no more than the rounding of the place."""
    if largest(left, 0.0, n_q) <= HELD * largest(row, 0.0, n_q):
        clear(left, n_q)
