"""Many small problems of one size in one compiled call."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from lcpstep.lcp.dense import many
from lcpstep.lcp.problem import as_array, check_finite, limits
from lcpstep.lcp.status import ENOUGH, NOT_FINITE, PER_UNKNOWN, SOLVED, TOLERANCE


@dataclass(frozen=True, slots=True)
class BatchSolution:
    """What was found for each problem of a batch.

    Attributes
    ----------
    z, w : (m, n) arrays
    status : (m,) int array of Status values
    iterations : (m,) int array
    residual : (m,) array, judged
    """

    z: Any
    w: Any
    status: Any
    iterations: Any
    residual: Any

    @property
    def solved(self) -> Any:
        """(m,) bool array: which answers the judge has passed."""
        return self.status == SOLVED


def solve_lcp_batch(
    W: Any, b: Any, *, tol: float = TOLERANCE, guess: Any = None, max_iterations: int | None = None
) -> BatchSolution:
    """Solve m problems of n unknowns each, as `solve_lcp` does with method "lemke".

    Parameters
    ----------
    W : (m, n, n) array, or (n, n) for one matrix that all problems share
    b : (m, n) array
    tol, max_iterations : as for `solve_lcp`
    guess : (m, n) array whose positive entries are tried first, or None

    Returns
    -------
    BatchSolution

    Raises
    ------
    ValueError : naming the argument that has a wrong shape or is not real and finite
    """
    b = as_array(b, "b", 2)
    W = as_array(W, "W", 2 if np.ndim(W) == 2 else 3)
    max_iterations = limits(tol, max_iterations)
    m, n = b.shape
    if W.shape not in ((n, n), (m, n, n)):
        raise ValueError(f"W must be of shape {(m, n, n)} or {(n, n)} to match b, not {W.shape}")
    z = np.zeros((m, n)) if guess is None else as_array(guess, "guess", 2).copy()
    if z.shape != b.shape:
        raise ValueError(f"guess must have the shape of b, {b.shape}, not {z.shape}")
    if guess is not None and not np.isfinite(z).all():
        raise ValueError("guess contains NaN or infinity")
    w, residual = np.empty((m, n)), np.zeros(m)
    status, iterations = np.zeros(m, dtype=np.intp), np.zeros(m, dtype=np.intp)
    limit = ENOUGH + PER_UNKNOWN * n if max_iterations is None else max_iterations
    if m > 0 and n > 0:
        matrices = W if W.ndim == 3 else W[None]
        many(matrices, b, z, w, status, iterations, residual, tol, limit)
    if (status == NOT_FINITE).any():
        check_finite(W, b)
    return BatchSolution(z, w, status, iterations, residual)
