"""The proof that no z >= 0 has W z + b >= 0, if that is so: y >= 0 with W^T y <= 0 and b^T y < 0 (Farkas).

The linear programme "minimise 0 subject to W z + b >= 0, z >= 0" is the complementarity problem of

    [ 0  -W^T ]      [ 0 ]
    [ W    0  ],     [ b ],

which is positive semidefinite, so Lemke's method solves it or leaves along a ray whose second half is y
(R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem (1992), theorem 4.4.1).
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.lcp.balanced import balanced
from lcpstep.lcp.judge import proves_infeasible
from lcpstep.lcp.lemke import lemke
from lcpstep.lcp.problem import Ray, Solution, is_sparse
from lcpstep.lcp.scaling import equilibrate
from lcpstep.lcp.status import RAY, Status
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import after
from lcpstep.rows import copy

PIVOTS = 50  # per unknown
LARGEST = 200  # unknowns up to which the proof is looked for where the method itself gives no ray
SMALLEST_PIVOT = 1e-11
ROUNDING = 1e-9  # of the terms of w along a ray


def explained(W: Any, b: Any, solution: Solution) -> Solution:
    """The solution as it is, or as infeasible where a method that cannot tell has failed for that reason."""
    if solution.solved or len(b) > LARGEST:
        return solution
    y = farkas(W.toarray() if is_sparse(W) else W, b)
    return solution if y is None else solution._replace(status=Status.INFEASIBLE, certificate=y)


def farkas(W: Any, b: Any) -> Any:
    """The vector y for a dense W, or None if there is no proof up to rounding."""
    n, own = len(b), balanced(W, b)
    V, c = (W, b) if own is None else (own.W, own.b)
    M, q = np.zeros((2 * n, 2 * n)), np.concatenate((np.zeros(n), c))
    M[:n, n:], M[n:, :n] = -V.T, V
    work = Workspace(2 * n)
    equilibrate(doubles(M), doubles(q), 2 * n, work)
    for i in range(2 * n):
        work.chosen[i] = 0
    if lemke(2 * n, 2 * PIVOTS * n, SMALLEST_PIVOT, True, work) != RAY:
        return None
    y = np.empty(n)
    copy(doubles(y), after(work.ray_direction, n), n)
    if own is not None:
        y = np.ldexp(y, own.rows)
    y = np.ldexp(y, 1 - np.frexp(np.max(y))[1])
    return y if proves_infeasible(doubles(W), doubles(b), doubles(y), n) else None


def is_ray(W: Any, b: Any, ray: Ray) -> bool:
    """Whether a ray is what it says it is, up to rounding: pivots that have gone astray end anywhere."""
    positive = (ray.z > 0.0) | (ray.dz > 0.0)
    signs = np.concatenate((ray.z, ray.dz, ray.d, [ray.z_0, ray.dz_0]))
    if not (np.all(np.isfinite(signs)) and np.all(signs >= 0.0) and positive.any()):
        return False
    for z, z_0, c in ((ray.z, ray.z_0, b), (ray.dz, ray.dz_0, np.zeros_like(b))):
        w, slack = W @ z + c + z_0 * ray.d, ROUNDING * (abs(W) @ z + np.abs(c) + z_0 * ray.d)
        if np.any(w < -slack) or np.any(w[positive] > slack[positive]):
            return False
    return True
