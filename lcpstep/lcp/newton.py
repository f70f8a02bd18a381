"""Newton's method for large problems: a few factorisations, each about linear in n for a narrow band.

First on min(z, W z + b) = 0: solve for the set of positive z, exchange the indices on the wrong side, repeat
(M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865). It ends with the solution of a linear
system, refined, so to rounding; for a P-matrix it usually takes fewer than fifteen systems. Where it cycles,
as it may with redundant contacts, an interior-point method finds the set, and the same exchanges end from
its point. The systems are solved by proximal steps, z <- z - (W_aa + d)^-1 (W z + b)_a with a small diagonal
d, which converge for singular W_aa too, to a solution near where they start.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.lcp.factor import Factoriser, Singular, factoriser
from lcpstep.lcp.infeasible import explained
from lcpstep.lcp.interior import interior_point
from lcpstep.lcp.judged import residual, shares
from lcpstep.lcp.problem import Solution, check_finite
from lcpstep.lcp.status import FAILED, MAX_ITERATIONS, SOLVED, Status

EXCHANGES = 100
PATIENCE = 5  # exchanges that may pass without fewer indices on the wrong side
STRICT = 1e-13  # relative size of a negative z or w that is rounding
PROXIMAL = (1e-13, 1e-10)  # d, relative to the diagonal of W; the second for a set that may be singular
REFINEMENTS = 6
DECISIVE = 0.001  # part of the indices whose entering needs no refined answer
NOISE = 1e-13  # share of z below which it may be rounding


def newton(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Solve by exchanges of the active set, then by an interior point; dense or sparse W."""
    check_finite(W, b)
    with np.errstate(all="ignore"):  # a diverging attempt may overflow; the judge sees to it
        return explained(W, b, _newton(W, b, z, tol, max_iterations))


def _newton(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    limit = EXCHANGES if max_iterations is None else max_iterations
    factors = factoriser(W)
    z, used = exchange(W, b, z, z > 0.0 if z.any() else b < 0.0, limit, factors)
    error = residual(W, b, z)
    if error > tol:
        inner, steps = interior_point(W, b, factors)
        polished, more = polish(W, b, inner, tol, limit, factors)
        used += steps + more
        z, error = best_of(W, b, z, polished)
    status = SOLVED if error <= tol else MAX_ITERATIONS if used >= limit else FAILED
    return Solution(z, W @ z + b, Status(status), used, error, "newton")


def polish(W: Any, b: Any, z: Any, tol: float, limit: int, factors: Factoriser) -> tuple[Any, int]:
    """The best that exchanges make of an approximate answer, whose set may have a singular matrix.

    From z, near which a solution is; where the judge refuses that, from zero: unknowns that hang on each other alone
    and have no b stay exactly zero then, where proximal steps from z leave numbers that are all of their rows.
    """
    active, best, used = positive_set(W, b, z), z, 0
    for first in (z, np.zeros_like(z)):
        candidates = [best, np.zeros_like(z)]  # solvers know zero to their tolerance
        for proximal in PROXIMAL:
            answer, more = exchange(W, b, first, active, limit, factors, proximal)
            candidates.append(answer)
            used += more
        best, error = best_of(W, b, *candidates)
        if error <= tol:
            break
    return best, used


def exchange(
    W: Any, b: Any, z: Any, active: Any, limit: int, factors: Factoriser, proximal: float = PROXIMAL[0]
) -> tuple[Any, int]:
    """Exchange indices from the set `active`; returns the last answer, z >= 0, and the number of systems."""
    d = proximal * diagonal_scale(W)
    size_of, used, fewest, patience = abs(W), 0, len(b) + 1, PATIENCE
    while used < limit and patience >= 0:
        used += 1
        try:
            solve = factors.factor(active, d)
        except Singular:
            break
        z = np.where(active, z, 0.0) if used == 1 else np.zeros_like(b)
        for steps in (1, REFINEMENTS):  # one decides, if many enter and none leaves
            z, w, size = settle(W, b, z, active, size_of, solve, steps)
            if not np.isfinite(size).all():
                return np.zeros_like(b), used
            leaves, enters = wrong_side(W, z, w, size, active)
            wrong = int(np.count_nonzero(leaves) + np.count_nonzero(enters))
            if wrong > DECISIVE * len(b) and not leaves.any():
                break
        if wrong == 0:
            break
        patience = PATIENCE if wrong < fewest else patience - 1
        fewest = min(fewest, wrong)
        active = (active & ~leaves) | enters
    return np.maximum(z, 0.0), used


def wrong_side(W: Any, z: Any, w: Any, size: Any, active: Any) -> tuple[Any, Any]:
    """Which indices leave the set, their z negative beyond rounding, and which enter it, w being so."""
    leaves = active & (z < 0.0)
    if leaves.any():
        leaves &= shares(W, z, size) > STRICT
    return leaves, ~active & (w < -STRICT * size)


def settle(W: Any, b: Any, z: Any, active: Any, size_of: Any, solve: Any, steps: int) -> tuple[Any, Any, Any]:
    """Proximal steps towards W z + b = 0 on the set; returns z, w and the sizes of the terms of w."""
    w, before = W @ z + b if z.any() else b, np.inf
    for step in range(steps):
        z = z - solve(w)
        w, size = W @ z + b, size_of @ np.abs(z) + np.abs(b)
        if step + 1 == steps or not np.isfinite(size).all():
            break
        relative = np.abs(w[active]) / np.where(size[active] > 0.0, size[active], 1.0)
        error = float(np.max(relative, initial=0.0))
        if not STRICT / 100 < error < 0.5 * before:
            break
        before = error
    return z, w, size


def diagonal_scale(W: Any) -> Any:
    """Sizes of the diagonal, of the largest entry of the column where the diagonal is zero."""
    diagonal = np.abs(W.diagonal())
    if (diagonal == 0.0).any():
        largest = abs(W).max(axis=0)
        largest = largest.toarray().ravel() if hasattr(largest, "toarray") else largest
        diagonal = np.where(diagonal > 0.0, diagonal, np.where(largest > 0.0, largest, 1.0))
    return diagonal


def positive_set(W: Any, b: Any, z: Any) -> Any:
    """Where z rather than w is positive, each in relative terms."""
    size = abs(W) @ np.abs(z) + np.abs(b)
    w = np.abs(W @ z + b)
    return shares(W, z, size) > np.divide(w, size, out=np.zeros_like(w), where=size > 0.0)


def best_of(W: Any, b: Any, *candidates: Any) -> tuple[Any, float]:
    """The candidate with the least residual, and that; each also without what may be rounding in z."""
    best, error = candidates[0], np.inf
    for z in candidates:
        size = abs(W) @ np.abs(z) + np.abs(b)
        for version in (z, np.where(shares(W, z, size) > NOISE, z, 0.0)):
            found = residual(W, b, version)
            if found < error:
                best, error = version, found
    return best, error
