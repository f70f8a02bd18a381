"""Sparse matrices of large systems: checked as the dense ones are, and never made dense.

A symmetric matrix is positive definite exactly if elimination without exchange of rows meets positive pivots only
(G. Golub, C. Van Loan, Matrix Computations, section 4.2); with a fill-reducing order this costs about as much as
one step of a motion. SciPy is loaded when a sparse matrix is met.
"""

from __future__ import annotations

from typing import Any

import numpy as np

EPSILON = float(np.finfo(float).eps)
ASYMMETRY = 1e-12  # of the largest entry: what rounding may leave


def is_sparse(value: Any) -> bool:
    """Whether this is a scipy.sparse matrix or array, asked without loading SciPy."""
    return hasattr(value, "tocsr")


def matrix(name: str, value: Any, shape: tuple[int, int] | None = None) -> Any:
    """Own, read-only, canonical CSR copy of a real, finite, sparse or dense matrix."""
    from scipy.sparse import csr_array

    try:
        if np.dtype(value.dtype if is_sparse(value) else np.asarray(value).dtype).kind not in "biuf":
            raise TypeError
        result = csr_array(value, dtype=np.float64, copy=True)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: expected a matrix of real numbers, got {value!r}") from None
    if result.ndim != 2 or 0 in result.shape:
        raise ValueError(f"{name}: expected a matrix, got shape {result.shape}")
    if shape is not None and result.shape != shape:
        raise ValueError(f"{name}: expected shape {shape}, got {result.shape}")
    result.sum_duplicates()
    if not np.all(np.isfinite(result.data)):
        rows, columns = result.nonzero()
        k = int(np.argmin(np.isfinite(result[rows, columns])))
        raise ValueError(
            f"{name}: expected finite numbers, got {result[rows[k], columns[k]]} in row {rows[k]}, "
            f"column {columns[k]}"
        )
    for part in (result.data, result.indices, result.indptr):
        part.flags.writeable = False
    return result


def zero(n: int) -> Any:
    """The (n, n) matrix of zeros."""
    from scipy.sparse import csr_array

    return matrix("zero", csr_array((n, n)))


def symmetric(name: str, K: Any) -> Any:
    """A symmetric matrix up to rounding, or an error that says that it is not."""
    difference = abs(K - K.T)
    if difference.nnz and difference.max() > ASYMMETRY * abs(K).max():
        raise ValueError(
            f"{name}: expected a symmetric matrix, got one with entries {difference.max():g} apart from their mirror "
            f"images; forces without a potential are given by lagrangian.System"
        )
    return K


def products(A: Any, B: Any) -> Any:
    """Inner products of the rows of two matrices, each dense or sparse."""
    if not (is_sparse(A) or is_sparse(B)):
        return np.einsum("ij,ij->i", A, B)
    from scipy.sparse import csr_array

    return np.asarray(csr_array(A).multiply(B).sum(axis=1)).ravel()


def empty_rows(G: Any) -> Any:
    """Numbers of the rows without an entry that is not zero."""
    return np.flatnonzero(abs(G).sum(axis=1) == 0.0)


def mass_matrix(name: str, M: Any) -> Any:
    """A symmetric positive definite matrix, or an error that says which of the two it is not."""
    difference = abs(M - M.T)
    if difference.nnz and difference.max() > ASYMMETRY * abs(M).max():
        i, j = (int(k) for k in np.unravel_index(int(difference.argmax()), M.shape))
        raise ValueError(
            f"{name}: the mass matrix must be symmetric, but entry ({i}, {j}) is {M[i, j]:g} and "
            f"entry ({j}, {i}) is {M[j, i]:g}"
        )
    diagonal = M.diagonal()
    if np.any(diagonal <= 0.0):
        i = int(np.argmin(diagonal))
        raise ValueError(
            f"{name}: the mass matrix must be positive definite, but entry ({i}, {i}) of its diagonal is "
            f"{diagonal[i]:g}"
        )
    if M.nnz > len(diagonal) and not _positive_pivots(M, diagonal):
        raise ValueError(
            f"{name}: the mass matrix must be positive definite, but elimination meets a pivot that is not "
            "positive beyond rounding: it is singular or indefinite"
        )
    return M


def _positive_pivots(M: Any, diagonal: Any) -> bool:
    from scipy.sparse import diags_array
    from scipy.sparse.linalg import splu

    unit = diags_array(
        1.0 / np.sqrt(diagonal)
    )  # pivots are judged next to a diagonal of ones: without a unit
    scaled = (unit @ M @ unit).tocsc()
    try:
        lu = splu(scaled, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError:  # a pivot is exactly zero
        return False
    exchanged = not np.array_equal(lu.perm_r, lu.perm_c)
    return not exchanged and bool(np.min(lu.U.diagonal()) > len(diagonal) * EPSILON)
