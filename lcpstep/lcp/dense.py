"""Pivoting and enumeration on a dense W, called from Python: one call into compiled code a problem."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from typing import Any

import numpy as np

from lcpstep.compiled import brief, compiled, entry_point
from lcpstep.lcp.enumeration import enumerate_bases
from lcpstep.lcp.infeasible import explained, farkas
from lcpstep.lcp.judge import judge
from lcpstep.lcp.kernel import ENOUGH, PER_UNKNOWN, solve_closed, solve_dense
from lcpstep.lcp.problem import Ray, Solution, check_finite
from lcpstep.lcp.scaling import all_finite
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
    length_needed,
)

NOT_FINITE = -1
STATUS = tuple(Status)
NAME_OF_SOLVED = Status.SOLVED
new = tuple.__new__  # naming the fields of a Solution takes as long as solving for two unknowns
LARGEST_KEPT = 100  # unknowns up to which work arrays are kept: 250 kB at most
LARGEST_ENUMERATION = 20  # unknowns; a million bases


class _Kept(threading.local):
    """Work arrays by number of unknowns, kept from call to call; every thread has its own."""

    def __init__(self) -> None:
        self.blocks: dict[int, Any] = {}


_kept = _Kept()


def block_for(n: int) -> Any:
    """A block for the work arrays of n unknowns."""
    block = np.zeros(length_needed(n))
    if n <= LARGEST_KEPT:
        _kept.blocks[n] = block
    return block


@functools.cache
def machine_code() -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The compiled `close_once` and `pivot_once`."""
    vector, matrix = np.zeros(1), np.zeros((1, 1))
    arrays = matrix, vector, vector, vector, vector
    return entry_point(close_once, *arrays, 0.0), entry_point(pivot_once, *arrays, 0.0, 0)


@brief
def close_once(W: Any, b: Any, z: Any, w: Any, block: Any, tolerance: float) -> float:
    """Residual of the closed form for one or two unknowns, infinite for one that is not finite; fills z and w."""
    return solve_closed(W, b, z, w, block, tolerance)


def pivot_once(
    W: Any, b: Any, z: Any, w: Any, block: Any, tolerance: float, max_pivots: int
) -> tuple[int, int, float]:
    """`solve_dense` on work arrays carved from a block: status, iterations, residual; fills z and w."""
    if not all_finite(W, b):
        return NOT_FINITE, 0, np.inf
    work = carve(block, b.shape[0])
    return finish(solve_dense(W, b, z, tolerance, max_pivots, work), w, work)


def enumerate_once(
    W: Any, b: Any, z: Any, w: Any, block: Any, tolerance: float, limit: int
) -> tuple[int, int, float]:
    """`enumerate_bases` in the same way."""
    if not all_finite(W, b):
        return NOT_FINITE, 0, np.inf
    work = carve(block, b.shape[0])
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


def pivoting(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Principal and Lemke's pivoting; where they end in a ray, the search for a proof of infeasibility."""
    n = len(b)
    block = _kept.blocks.get(n)
    if block is None:
        block = block_for(n)
    close, pivot = machine_code()
    w = np.empty(n)
    if n <= 2:
        residual = close(W, b, z, w, block, tol)
        if residual <= tol:
            return new(Solution, (z, w, NAME_OF_SOLVED, 0, residual, "lemke", None))
    limit = ENOUGH + PER_UNKNOWN * n if max_iterations is None else max_iterations
    status, iterations, residual = pivot(W, b, z, w, block, tol, limit)
    if status == SOLVED:
        return new(Solution, (z, w, NAME_OF_SOLVED, iterations, residual, "lemke", None))
    if status == NOT_FINITE:
        check_finite(W, b)
    certificate: Any = None
    if status == INFEASIBLE:
        certificate = carve(block, n).vectors[RAY_DIRECTION, :n].copy()
    elif status == RAY:
        certificate = farkas(W, b)
        if certificate is not None:
            status = INFEASIBLE
        else:
            certificate = ray(carve(block, n), n)
    return Solution(z, w, STATUS[status], iterations, residual, "lemke", certificate)


def enumeration(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Every complementary basis in turn."""
    n = b.shape[0]
    if n > LARGEST_ENUMERATION:
        raise ValueError(f"W is too large to enumerate: 2^{n} bases; at most {LARGEST_ENUMERATION} unknowns")
    limit = 2**n if max_iterations is None else max_iterations
    w, block = np.empty(n), np.zeros(length_needed(n))
    status, iterations, residual = compiled(enumerate_once)(W, b, z, w, block, tol, limit)
    if status == NOT_FINITE:
        check_finite(W, b)
    found = Solution(z, w, STATUS[status], iterations, residual, "enumeration")
    return explained(W, b, found) if status == FAILED else found


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
