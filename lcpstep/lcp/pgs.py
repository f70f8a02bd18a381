"""Projected Gauss-Seidel: the cheap approximate method.

    z_i <- max(0, z_i - (W z + b)_i / W_ii),   i = 1..n, again and again

It converges for symmetric positive semidefinite W with positive diagonal (O. L. Mangasarian, J. Optim. Theory
Appl. 22 (1977) 465), linearly and, in long chains, very slowly: the error falls by a factor in about n^2
sweeps. It says "solved" only if the judge does.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.lcp.judged import residual
from lcpstep.lcp.problem import Solution, check_finite, is_sparse
from lcpstep.lcp.status import MAX_ITERATIONS, SOLVED, Status
from lcpstep.pointers import Doubles, Indices, max

SWEEPS = 1000
BETWEEN = 10  # sweeps between two visits of the judge


def pgs(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Sweep from the guess until the judge is content or the limit is reached."""
    check_finite(W, b)
    diagonal = W.diagonal()
    if not (diagonal > 0.0).all():
        i = int(np.argmin(diagonal))
        raise ValueError(f"W must have a positive diagonal for Gauss-Seidel; W[{i}, {i}] = {diagonal[i]:g}")
    matrix = W if is_sparse(W) else _csr(W)
    starts, columns = matrix.indptr.astype(np.intp), matrix.indices.astype(np.intp)
    done, limit = 0, SWEEPS if max_iterations is None else max_iterations
    z = np.maximum(z, 0.0)
    error = residual(matrix, b, z)
    while error > tol and done < limit:
        count = min(BETWEEN, limit - done)
        sweep(indices(starts), indices(columns), doubles(matrix.data), doubles(b), doubles(z), len(b), count)
        done += count
        error = residual(matrix, b, z)
    status = SOLVED if error <= tol else MAX_ITERATIONS
    return Solution(z, W @ z + b, Status(status), done, error, "pgs")


def _csr(W: Any) -> Any:
    from scipy.sparse import csr_array

    return csr_array(W)


def sweep(starts: Indices, columns: Indices, W: Doubles, b: Doubles, z: Doubles, n: int, count: int) -> None:
    """Pass `count` times over all unknowns; the matrix is in CSR form."""
    for _ in range(count):
        for i in range(n):
            w, pivot = b[i], 1.0
            for p in range(starts[i], starts[i + 1]):
                w += W[p] * z[columns[p]]
                if columns[p] == i:
                    pivot = W[p]
            z[i] = max(0.0, z[i] - w / pivot)
