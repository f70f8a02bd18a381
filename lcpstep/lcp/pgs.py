"""Projected Gauss-Seidel: the cheap approximate method.

    z_i <- max(0, z_i - (W z + b)_i / W_ii),   i = 1..n, again and again

It converges for symmetric positive semidefinite W with positive diagonal (O. L. Mangasarian, J. Optim. Theory
Appl. 22 (1977) 465), linearly and, in long chains, very slowly: the error falls by a factor in about n^2
sweeps. It says "solved" only if the judge does.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.compiled import compiled
from lcpstep.lcp.judge import residual
from lcpstep.lcp.problem import Solution, check_finite, is_sparse
from lcpstep.lcp.status import MAX_ITERATIONS, SOLVED, Status

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
    done, limit = 0, SWEEPS if max_iterations is None else max_iterations
    z = np.maximum(z, 0.0)
    error = residual(matrix, b, z)
    while error > tol and done < limit:
        count = min(BETWEEN, limit - done)
        compiled(sweep)(matrix.indptr, matrix.indices, matrix.data, b, z, count)
        done += count
        error = residual(matrix, b, z)
    status = SOLVED if error <= tol else MAX_ITERATIONS
    return Solution(z, W @ z + b, Status(status), done, error, "pgs")


def _csr(W: Any) -> Any:
    from scipy.sparse import csr_array

    return csr_array(W)


def sweep(indptr: Any, indices: Any, data: Any, b: Any, z: Any, count: int) -> None:
    """Pass `count` times over all unknowns; the matrix is in CSR form."""
    for _ in range(count):
        for i in range(b.shape[0]):
            w, pivot = b[i], 1.0
            for p in range(indptr[i], indptr[i + 1]):
                w += data[p] * z[indices[p]]
                if indices[p] == i:
                    pivot = data[p]
            z[i] = max(0.0, z[i] - w / pivot)
