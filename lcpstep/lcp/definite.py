"""Whether W is symmetric positive semidefinite, decided without a unit: on d_i W_ij d_j with unit diagonal."""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.problem import is_sparse

ASYMMETRY = 1e-10  # largest |W_ij - W_ji|, next to a unit diagonal, that passes for rounding
NEGATIVE = 1e-12  # most negative eigenvalue, per unknown, that passes for rounding


def require_semidefinite(W: Any) -> None:
    """ValueError that says why, unless W is symmetric positive semidefinite up to rounding."""
    reason = defect(W)
    if reason:
        raise ValueError(
            f"W is not symmetric positive semidefinite: {reason}; a quadratic programme would "
            'solve another problem. method="lemke" takes any W'
        )


def defect(W: Any) -> str:
    """Why W is not symmetric positive semidefinite; empty if it is."""
    diagonal = W.diagonal()
    if (diagonal < 0.0).any():
        i = int(np.argmin(diagonal))
        return f"W[{i}, {i}] = {diagonal[i]:.3g} is negative"
    S = scaled(W, unit_diagonal(W))
    if len(diagonal) == 0:
        return ""
    difference = abs(S - S.T)
    if difference.max() > ASYMMETRY:
        i, j = sorted(largest(difference))
        return f"W[{i}, {j}] = {W[i, j]:.6g} but W[{j}, {i}] = {W[j, i]:.6g}"
    shift = NEGATIVE * len(diagonal)
    if positive_definite(S, shift):
        return ""
    lowest = lowest_eigenvalue(S)
    return "" if lowest >= -shift else f"an eigenvalue is {lowest:.3g} (of W scaled to unit diagonal)"


def unit_diagonal(W: Any) -> Any:
    """The d that gives diag(d) W diag(d) a unit diagonal; one where the diagonal is not positive."""
    diagonal = W.diagonal()
    return 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))


def scaled(W: Any, d: Any) -> Any:
    """diag(d) W diag(d)."""
    if not is_sparse(W):
        return d[:, None] * W * d
    from scipy.sparse import diags_array

    return (diags_array(d) @ W @ diags_array(d)).tocsc()


def largest(A: Any) -> tuple[int, int]:
    """Row and column of the largest entry."""
    if not is_sparse(A):
        i, j = np.unravel_index(np.argmax(A), A.shape)
        return int(i), int(j)
    A = A.tocoo()
    p = int(np.argmax(A.data))
    return int(A.row[p]), int(A.col[p])


def positive_definite(S: Any, shift: float) -> bool:
    """Whether S + shift I has a Cholesky factor; for a sparse S, an LDL^T factor with positive D."""
    n = S.shape[0]
    if not is_sparse(S):
        try:
            np.linalg.cholesky(S + shift * np.eye(n))
        except np.linalg.LinAlgError:
            return False
        return True
    from scipy.sparse import identity
    from scipy.sparse.linalg import splu

    options = {"SymmetricMode": True}
    try:
        lu = splu((S + shift * identity(n)).tocsc(), "MMD_AT_PLUS_A", 0.0, options=options)
    except RuntimeError:
        return False
    return bool((lu.perm_r == lu.perm_c).all() and (lu.U.diagonal() > 0.0).all())


def lowest_eigenvalue(S: Any) -> float:
    """Smallest eigenvalue of a symmetric matrix."""
    if not is_sparse(S):
        return float(np.linalg.eigvalsh(S)[0])
    if S.shape[0] <= 500:
        return float(np.linalg.eigvalsh(S.toarray())[0])
    from scipy.sparse.linalg import eigsh

    return float(eigsh(S, k=1, which="SA", return_eigenvectors=False)[0])
