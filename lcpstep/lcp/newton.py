"""Newton's method for large problems: a few factorisations, each about linear in n for a narrow band.

First on min(z, W z + b) = 0: solve for the set of positive z, exchange the indices on the wrong side, repeat
(M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865). It ends with the solution of a linear
system, refined, so to rounding; for a P-matrix it usually takes fewer than ten systems. Where it cycles, as
it may with redundant contacts, an interior-point method brings a set that it can end from.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.factor import Factoriser, Singular, factoriser
from lcpstep.lcp.interior import interior_point
from lcpstep.lcp.judge import residual
from lcpstep.lcp.problem import Solution, check_finite
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED, Status

EXCHANGES = 40
PATIENCE = 5  # exchanges that may pass without fewer indices on the wrong side
REFINEMENTS = 2


def newton(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Solve by exchanges of the active set, then by an interior point; dense or sparse W."""
    check_finite(W, b)
    limit = EXCHANGES if max_iterations is None else max_iterations
    factors = factoriser(W)
    best, used = exchange(W, b, z > 0.0 if z.any() else b < 0.0, tol, limit, factors)
    error = residual(W, b, best)
    if error > tol:
        inner, steps = interior_point(W, b, tol, factors)
        polished, more = exchange(W, b, positive_set(W, b, inner), tol, limit, factors)
        used += steps + more
        for candidate in (inner, polished):
            found = residual(W, b, candidate)
            if found < error:
                best, error = candidate, found
    status = SOLVED if error <= tol else MAX_ITERATIONS if used >= limit else FAILED
    return Solution(best, W @ best + b, Status(status), used, error, "newton")


def exchange(W: Any, b: Any, active: Any, tol: float, limit: int, factors: Factoriser) -> tuple[Any, int]:
    """Exchange indices from the set `active`; returns the last answer, z >= 0, and the number of systems."""
    size_of = abs(W)
    diagonal = np.abs(W.diagonal())
    none = np.zeros_like(b)
    z, used, fewest, patience = none, 0, len(b) + 1, PATIENCE
    while used < limit and patience >= 0:
        used += 1
        try:
            solve = factors.factor(active, none)
        except Singular:
            break
        z = np.where(active, solve(-b), 0.0)
        for _ in range(REFINEMENTS):
            z -= np.where(active, solve(W @ z + b), 0.0)
        w, size = W @ z + b, size_of @ np.abs(z) + np.abs(b)
        if not np.isfinite(size).all():
            return none, used
        leaves = active & (diagonal * z < -tol * size)
        enters = ~active & (w < -tol * size)
        wrong = np.count_nonzero(leaves) + np.count_nonzero(enters)
        if wrong == 0:
            break
        patience = PATIENCE if wrong < fewest else patience - 1
        fewest = min(fewest, wrong)
        active = (active & ~leaves) | enters
    return np.maximum(z, 0.0), used


def positive_set(W: Any, b: Any, z: Any) -> Any:
    """Where z rather than w is positive, each relative to the size of the terms of its row."""
    size = abs(W) @ np.abs(z) + np.abs(b)
    return np.abs(W.diagonal()) * z > np.abs(W @ z + b) * (size > 0.0)
