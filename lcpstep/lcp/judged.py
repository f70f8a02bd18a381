"""The judge, asked from Python: the residual of any z, whoever found it; the matrix may be sparse."""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.judge import judge_dense, judge_terms
from lcpstep.lcp.status import FINER, LITTLE, LOST, MERE

EPSILON = np.finfo(float).eps


def residual(W: Any, b: Any, z: Any) -> float:
    """Judged residual of z, dense or sparse W.

    Parameters
    ----------
    W : (n, n) array or scipy.sparse matrix
    b, z : (n,)

    Returns
    -------
    The relative natural-map residual of `judge`: zero exactly at a solution, about 1e-16 for an answer
    as good as rounding allows, infinite where W z + b overflows or is not a number.
    """
    b, z = (np.array(a, dtype=float, order="C") for a in (b, z))
    if hasattr(W, "tocsc"):
        return _sparse(W, b, z)
    W = np.array(W, dtype=float, order="C")
    return judge_dense(W, b, z)


def _sparse(W: Any, b: Any, z: Any) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        w = W @ z + b
        s = abs(W) @ np.abs(z) + np.abs(b)
    if not np.all(s < np.inf):
        return float("inf")
    relative = np.divide(w, s, out=np.zeros_like(s), where=s > 0.0)
    doubtful = (z < 0.0) | ((z > 0.0) & (relative > EPSILON))
    parts = shares(W, z, s) if doubtful.any() else np.ones_like(z)
    worst = judge_terms(z, relative, parts, b, s)
    return weighed_by_row(worst, W, b, z, relative, parts, s) if worst < LITTLE else worst


def weighed_by_row(worst: float, W: Any, b: Any, z: Any, relative: Any, parts: Any, s: Any) -> float:
    """`judge.weighed_by_row` for a sparse W."""
    errors = np.where(z < 0.0, parts, np.where(z > 0.0, np.minimum(parts, relative), 0.0))
    errors = np.maximum(errors, -relative)
    little = (b != 0.0) & (np.abs(b) < LITTLE * s)
    wrong = little & (errors > MERE)
    level = LITTLE if wrong.any() else LOST if np.any(little & (np.abs(b) < LOST * s)) else 0.0
    while level > 0.0:
        lost = (b != 0.0) & ~held(W, b, z, s, level)
        if not lost.any():
            break
        if level <= LOST:
            return 1.0
        worst = max(worst, min(1.0, float(np.max(errors[lost & wrong], initial=0.0)) / level))
        level = max(FINER * level, LOST)
    return worst


def held(W: Any, b: Any, z: Any, s: Any, level: float) -> Any:
    """Rows of which b is this part, and those that hang on them."""
    from scipy.sparse import block_array, coo_array
    from scipy.sparse.csgraph import connected_components

    terms, n = coo_array(abs(W)), len(b)
    row, column = terms.coords
    large = terms.data * np.abs(z[column]) >= level / (n + 1) * s[row]
    links = coo_array((large[large], (row[large], column[large])), (n, n))
    of_rows = connected_components(block_array([[None, links], [links.T, None]]), directed=False)[1][:n]
    return np.isin(of_rows, of_rows[(b != 0.0) & (np.abs(b) >= level * s)])


def shares(W: Any, z: Any, s: Any) -> Any:
    """Largest relative contribution of each z_i to a row, as `share` has it, for a dense or sparse W."""
    inverse = np.divide(1.0, s, out=np.zeros_like(s), where=s > 0.0)
    if hasattr(W, "tocsc"):
        columns = abs(W).tocsc()
        columns.eliminate_zeros()
        weighted = np.append(columns.data * inverse[columns.indices], 0.0)
        largest = np.maximum.reduceat(weighted, columns.indptr[:-1])
        largest[np.diff(columns.indptr) == 0] = 0.0
    else:
        largest = np.max(np.abs(W) * inverse[:, None], axis=0, initial=0.0)
    return np.where(largest > 0.0, largest * np.abs(z), 1.0)
