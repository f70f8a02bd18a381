"""The choice of a method by size, structure and symmetry, measured in benchmarks/lcp.

few unknowns, or a matrix without structure     pivoting
sparse, or too large for pivoting               Newton's method; pivoting if the judge refuses its answer
                                                and the matrix is small enough to be made dense
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.dense import pivoting
from lcpstep.lcp.newton import newton
from lcpstep.lcp.problem import Solution, is_sparse

SMALL = 400  # unknowns up to which compiled pivoting is as fast as sparse factors
SPARSE = 0.1  # part of nonzero entries below which a large dense W is treated as sparse
LARGEST_DENSE = 3000  # the same for a matrix without structure; and where Newton's method has failed


def automatic(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Solve with the method that suits W, and with pivoting where that fails."""
    n = len(b)
    full = not is_sparse(W) and np.count_nonzero(W) > SPARSE * n * n
    if n <= (LARGEST_DENSE if full else SMALL):
        return pivoting(dense(W), b, z, tol, max_iterations)
    suited = W if full or is_sparse(W) else _csr(W)
    solution = newton(suited, b, z, tol, max_iterations)
    if solution.solved or n > LARGEST_DENSE:
        return solution
    return pivoting(dense(W), b, z, tol, max_iterations)


def dense(W: Any) -> Any:
    """W as an array."""
    return W.toarray() if is_sparse(W) else W


def _csr(W: Any) -> Any:
    from scipy.sparse import csr_array

    return csr_array(W)
