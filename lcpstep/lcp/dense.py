"""Pivoting and enumeration on a dense W, called from Python: one call into compiled code a problem."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from lcpstep.compiled import compiled
from lcpstep.lcp.enumeration import enumerate_bases
from lcpstep.lcp.infeasible import farkas
from lcpstep.lcp.judge import judge
from lcpstep.lcp.kernel import ENOUGH, PER_UNKNOWN, solve_dense
from lcpstep.lcp.problem import Ray, Solution, check_finite
from lcpstep.lcp.small import solve_one, solve_two
from lcpstep.lcp.status import FAILED, INFEASIBLE, RAY, SOLVED, Status
from lcpstep.lcp.workspace import (
    BEST_RESIDUAL,
    ITERATIONS,
    RAY_DIRECTION,
    RAY_DZ0,
    RAY_START,
    RAY_Z0,
    RESIDUAL,
    ROW_SCALE,
    SIZE,
    SLACK,
    carve,
    integers_needed,
    numbers_needed,
)

NOT_FINITE = -1
STATUS = tuple(Status)
LARGEST_KEPT = 100  # unknowns up to which work arrays are kept: 250 kB at most
LARGEST_ENUMERATION = 20  # unknowns; a million bases


@cache
def kernel(entry: Callable[..., Any]) -> Callable[..., Any]:
    """The compiled twin of an entry, looked up once."""
    return compiled(entry)


class _Kept(threading.local):
    """Work arrays of small problems by size, kept from call to call; every thread has its own."""

    def __init__(self) -> None:
        self.blocks: dict[int, tuple[Any, Any]] = {}


_kept = _Kept()


def blocks(n: int) -> tuple[Any, Any]:
    """Blocks for the work arrays of n unknowns."""
    found = _kept.blocks.get(n)
    if found is None:
        found = np.empty(numbers_needed(n)), np.zeros(integers_needed(n), np.int64)
        if n <= LARGEST_KEPT:
            _kept.blocks[n] = found
    return found


def pivot_once(
    W: Any, b: Any, z: Any, w: Any, numbers: Any, integers: Any, tolerance: float, max_pivots: int
) -> tuple[int, int, float]:
    """`solve_dense` on work arrays carved from two blocks: status, iterations, residual; fills z and w."""
    if not all_finite(W, b):
        return NOT_FINITE, 0, np.inf
    work = carve(numbers, integers, b.shape[0])
    status = solve_dense(W, b, z, tolerance, max_pivots, work)
    return finish(status, w, work)


def closed_form(W: Any, b: Any, out: Any, tolerance: float) -> float:
    """Residual of the closed form for one or two unknowns, infinite if it has none; out holds z, w and sizes."""
    if not all_finite(W, b):
        return np.inf
    if b.shape[0] == 1:
        return solve_one(W, b, out[0], out[1], out[2])
    return solve_two(W, b, out[0], out[1], out[2], tolerance)


def enumerate_once(
    W: Any, b: Any, z: Any, w: Any, numbers: Any, integers: Any, tolerance: float, limit: int
) -> tuple[int, int, float]:
    """`enumerate_bases` in the same way."""
    if not all_finite(W, b):
        return NOT_FINITE, 0, np.inf
    work = carve(numbers, integers, b.shape[0])
    work.report[ITERATIONS], work.report[BEST_RESIDUAL] = 0.0, tolerance
    status = enumerate_bases(W, b, z, tolerance, limit, work)
    if status != SOLVED:
        for i in range(b.shape[0]):
            z[i] = max(z[i], 0.0)
        work.report[RESIDUAL] = judge(W, b, z, work.vectors[SLACK], work.vectors[SIZE])
    return finish(status, w, work)


def finish(status: int, w: Any, work: Any) -> tuple[int, int, float]:
    """Copy w out and report."""
    for i in range(w.shape[0]):
        w[i] = work.vectors[SLACK, i]
    return status, int(work.report[ITERATIONS]), work.report[RESIDUAL]


def all_finite(W: Any, b: Any) -> bool:
    """Whether no entry is NaN or infinite: a number minus itself is zero exactly then."""
    n, total = b.shape[0], 0.0
    for i in range(n):
        total += b[i] - b[i]
        for j in range(n):
            total += W[i, j] - W[i, j]
    return total == 0.0


def pivoting(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Principal and Lemke's pivoting; where they end in a ray, the search for a proof of infeasibility."""
    n = len(b)
    if n <= 2:
        out = np.empty((3, n))
        residual = kernel(closed_form)(W, b, out, tol)
        if residual <= tol:
            return Solution(out[0], out[1], STATUS[SOLVED], 0, residual, "lemke")
    limit = max_iterations
    if limit is None:
        limit = ENOUGH if n < ENOUGH // PER_UNKNOWN else PER_UNKNOWN * n
    return _call(pivot_once, "lemke", W, b, z, tol, limit)


def enumeration(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Every complementary basis in turn."""
    n = b.shape[0]
    if n > LARGEST_ENUMERATION:
        raise ValueError(f"W is too large to enumerate: 2^{n} bases; at most {LARGEST_ENUMERATION} unknowns")
    limit = 2**n if max_iterations is None else max_iterations
    return _call(enumerate_once, "enumeration", W, b, z, tol, limit)


def _call(entry: Callable[..., Any], method: str, W: Any, b: Any, z: Any, tol: float, limit: int) -> Solution:
    n = len(b)
    w, (numbers, integers) = np.empty(n), blocks(n)
    status, iterations, residual = kernel(entry)(W, b, z, w, numbers, integers, tol, limit)
    if status == SOLVED:
        return Solution(z, w, STATUS[SOLVED], iterations, residual, method)
    if status == NOT_FINITE:
        check_finite(W, b)
    certificate: Any = None
    if status == INFEASIBLE:
        certificate = carve(numbers, integers, n).vectors[RAY_DIRECTION, :n].copy()
    elif status == RAY or (status == FAILED and entry is enumerate_once):
        certificate = farkas(W, b)
        if certificate is not None:
            status = INFEASIBLE
        elif status == RAY:
            certificate = ray(carve(numbers, integers, n), n)
    return Solution(z, w, STATUS[status], iterations, residual, method, certificate)


def ray(work: Any, n: int) -> Ray:
    """The ray that the work arrays hold."""
    vectors, report = work.vectors, work.report
    return Ray(
        vectors[RAY_START, :n].copy(),
        vectors[RAY_DIRECTION, :n].copy(),
        float(report[RAY_Z0]),
        float(report[RAY_DZ0]),
        1.0 / vectors[ROW_SCALE, :n],
    )
