"""The arrays that the pivoting kernels work in, made once for the largest problem and used for smaller ones.

They are few, so that handing them from kernel to kernel costs little; their rows have names.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

# rows of Workspace.vectors
SCALED_B = 0  # b of the scaled problem
ROW_SCALE = 1  # powers of two that the rows were multiplied by
COLUMN_SCALE = 2  # the same for columns: z = column scale * scaled z
X, DX = 3, 4  # basic z by position, and its change with the entering variable
SLACK, DSLACK = 5, 6  # w by index, and its change
LEFT = 7  # a left product with the inverse
TRIAL = 8  # a solution on trial, or marks
SIZE = 9  # sizes of the terms of w, the judge's scale
RAY_DIRECTION, RAY_START = (
    10,
    11,
)  # the ray that pivoting left along, in the units of z
BEST = 12  # the best answer so far that passes the tolerance asked for
VECTORS = 13

# entries of Workspace.report
RESIDUAL, ITERATIONS = 0, 1  # of the last problem
RAY_DZ0, RAY_Z0 = 2, 3  # the covering variable's share in the ray
BEST_RESIDUAL = 4  # of the answer in BEST
SMALLEST = 5  # size above which a component of Lemke's direction counts
REPORT = 6

# rows of Workspace.indices
BASIC, TIGHT = 0, 1  # by position: index of the basic z; index of the row whose w is not basic
Z_PLACE, W_PLACE = 2, 3  # position of z_j in BASIC, of w_i in TIGHT; -1 where there is none
TIED = 4  # variables that reach zero together
ORDER = 5  # row interchanges of an elimination
ACTIVE, CHOSEN = 6, 7  # indices of a principal submatrix, and 1 for each of them, else 0
INDICES = 8


class Workspace(NamedTuple):
    """Work arrays for problems of up to n unknowns.

    columns : (n+1, n)   columns of the scaled W, each in one piece; the last is Lemke's covering vector
    inverse : (n, n)     inverse of the basis matrix
    factor : (n, n)      LU factors of a principal submatrix
    vectors : (13, n+1)  see the names of its rows in this module
    indices : (8, 2n+1)  likewise
    report : (6,)        likewise: residual, number of iterations, ...
    """

    columns: Any
    inverse: Any
    factor: Any
    vectors: Any
    indices: Any
    report: Any


def workspace(n_max: int) -> Workspace:
    """Work arrays for problems of up to n_max unknowns; every thread needs its own."""
    return carve(np.empty(numbers_needed(n_max)), np.zeros(integers_needed(n_max), np.int64), n_max)


def numbers_needed(n: int) -> int:
    """Length of the block of floats that `carve` divides."""
    return (n + 1) * n + 2 * n * n + VECTORS * (n + 1) + REPORT


def integers_needed(n: int) -> int:
    """Length of the block of integers."""
    return INDICES * (2 * n + 1)


def carve(numbers: Any, integers: Any, n: int) -> Workspace:
    """Work arrays for n unknowns as parts of two blocks; for kernels that are handed the blocks."""
    inverse = (n + 1) * n
    factor = inverse + n * n
    vectors = factor + n * n
    report = vectors + VECTORS * (n + 1)
    return Workspace(
        numbers[:inverse].reshape((n + 1, n)),
        numbers[inverse:factor].reshape((n, n)),
        numbers[factor:vectors].reshape((n, n)),
        numbers[vectors:report].reshape((VECTORS, n + 1)),
        integers[: INDICES * (2 * n + 1)].reshape((INDICES, 2 * n + 1)),
        numbers[report : report + REPORT],
    )
