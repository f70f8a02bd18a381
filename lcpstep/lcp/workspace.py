"""The arrays that the pivoting kernels work in, made once for the largest problem and used for smaller ones.

They are few, so that handing them from kernel to kernel costs little; their rows have names.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lcpstep.compiled import by_address

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
CHANGES = 13  # of the tableau: changes that are still to be made, four rows
SHARES = 17  # what each column takes of them
VECTORS = 21

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
NONBASIC, PLACE = 8, 9  # of the tableau: variable by column; column by variable, -1 for a basic one
INDICES = 10


@by_address
class Workspace(NamedTuple):
    """Work arrays for problems of up to n unknowns.

    columns : (n+1, n)   columns of the scaled W, each in one piece, the last Lemke's covering vector; or the tableau
    inverse : (n, n)     inverse of the basis matrix
    factor : (n, n)      LU factors of a principal submatrix
    vectors : (21, n+1)  see the names of its rows in this module
    indices : (10, 2n+1)  likewise
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
    return carve(np.zeros(length_needed(n_max)), n_max)


def length_needed(n: int) -> int:
    """Length of the block of numbers that `carve` divides."""
    return (n + 1) * n + 2 * n * n + VECTORS * (n + 1) + REPORT + INDICES * (2 * n + 1)


def carve(block: Any, n: int) -> Workspace:
    """Work arrays for n unknowns as parts of one block of floats; for kernels that are handed the block."""
    inverse = (n + 1) * n
    factor = inverse + n * n
    vectors = factor + n * n
    report = vectors + VECTORS * (n + 1)
    indices = report + REPORT
    return Workspace(
        block[:inverse].reshape((n + 1, n)),
        block[inverse:factor].reshape((n, n)),
        block[factor:vectors].reshape((n, n)),
        block[vectors:report].reshape((VECTORS, n + 1)),
        block[indices:].view(np.int64).reshape((INDICES, 2 * n + 1)),
        block[report:indices],
    )
