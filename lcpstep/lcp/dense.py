"""Pivoting and enumeration on a dense W, called from Python: checked arrays in, a Solution out."""

from __future__ import annotations

import threading
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import are_doubles, doubles, indices
from lcpstep.lcp.balanced import balanced, in_units
from lcpstep.lcp.enumeration import TINY, enumerate_bases, enumerate_vertices
from lcpstep.lcp.infeasible import explained, farkas, is_ray
from lcpstep.lcp.judge import judge
from lcpstep.lcp.kernel import solve_dense
from lcpstep.lcp.problem import Ray, Solution, check_finite
from lcpstep.lcp.scaling import all_finite
from lcpstep.lcp.small import solve_closed
from lcpstep.lcp.status import (
    ENOUGH,
    FAILED,
    INFEASIBLE,
    MAX_ITERATIONS,
    NOT_FINITE,
    PER_UNKNOWN,
    RAY,
    SOLVED,
    Status,
)
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import Doubles, Indices, after, max
from lcpstep.rows import copy

NAMES = tuple(Status)
NAME_OF_SOLVED = Status.SOLVED
new: Any = tuple.__new__  # naming the fields of a Solution takes as long as solving for two unknowns
LARGEST_KEPT = 100  # unknowns up to which work spaces are kept: 250 kB at most
LARGEST_ENUMERATION = 20  # unknowns; a million bases


class _Kept(threading.local):
    """Work spaces by number of unknowns, kept from call to call; every thread has its own."""

    def __init__(self) -> None:
        self.spaces: dict[int, Workspace] = {}


_kept = _Kept()


@cython.cfunc
def space_for(n: int) -> Workspace:
    """A work space for n unknowns."""
    spaces = _kept.spaces
    work = spaces.get(n)
    if work is None:
        work = Workspace(n)
        if n <= LARGEST_KEPT:
            spaces[n] = work
    return work


def is_checked(W: Any, b: Any) -> bool:
    """Whether W and b are arrays that need no conversion, of matching shapes; asked for every problem."""
    return are_doubles(W, 2) and are_doubles(b, 1) and len(W) == len(b) and W.size == len(b) * len(b)


def pivoting(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Principal and Lemke's pivoting; where they end in a ray, the search for a proof of infeasibility."""
    n, w = len(b), np.empty(len(b))
    work = space_for(n)
    if n <= 2:
        residual = solve_closed(doubles(W), doubles(b), doubles(z), n, doubles(w), work.size, tol)
        if residual <= tol:
            return new(Solution, (z, w, NAME_OF_SOLVED, 0, residual, "lemke", None))
    limit = ENOUGH + PER_UNKNOWN * n if max_iterations is None else max_iterations
    status = pivot_once(doubles(W), doubles(b), doubles(z), n, doubles(w), tol, limit, work)
    if status == SOLVED:
        return new(Solution, (z, w, NAME_OF_SOLVED, work.iterations, work.residual, "lemke", None))
    if status in (RAY, FAILED, MAX_ITERATIONS) and max_iterations is None:
        return search(W, b, z, w, tol, limit, work, status)
    return told(W, b, z, w, work, status)


@cython.cfunc
def search(W: Any, b: Any, z: Any, w: Any, tol: float, limit: int, work: Workspace, status: int) -> Solution:
    """The same in units of the problem's own, the thorough search, and another method, unless a proof ends it."""
    if status in (RAY, FAILED) and (certificate := farkas(W, b)) is not None:
        return Solution(z, w, Status.INFEASIBLE, work.iterations, work.residual, "lemke", certificate)
    n, own, first = len(b), balanced(W, b), None
    if own is not None:
        x, y = np.zeros(n), np.empty(n)
        status = pivot_once(doubles(own.W), doubles(own.b), doubles(x), n, doubles(y), tol, limit, work)
        first = in_units(own, told(own.W, own.b, x, y, work, status))
        if first.status in (SOLVED, INFEASIBLE):
            return first
    z[:] = 0.0
    work.thorough = True
    status = pivot_once(doubles(W), doubles(b), doubles(z), n, doubles(w), tol, limit, work)
    work.thorough = False
    if status not in (SOLVED, INFEASIBLE):
        from lcpstep.lcp.newton import newton

        other = newton(W, b, np.zeros(n), tol, None)
        if other.solved:
            return other
    last = told(W, b, z, w, work, status)
    return first if first is not None and first.status == RAY and last.status == FAILED else last


@cython.cfunc
def told(W: Any, b: Any, z: Any, w: Any, work: Workspace, status: int) -> Solution:
    """The solution, or why there is none."""
    n = len(b)
    if status == NOT_FINITE:
        check_finite(W, b)
    certificate: Any = None
    iterations, residual = work.iterations, work.residual
    if status == INFEASIBLE:
        certificate = array_of(work.ray_direction, n)
    elif status in (RAY, FAILED):
        certificate = farkas(W, b)
        if certificate is not None:
            status = INFEASIBLE
        elif status == RAY:
            certificate = ray(work, n)
            if not is_ray(W, b, certificate):
                status, certificate = FAILED, None
    return Solution(z, w, NAMES[status], iterations, residual, "lemke", certificate)


def enumeration(W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Every complementary basis in turn, and every vertex of a few unknowns."""
    n, w = len(b), np.empty(len(b))
    if n > LARGEST_ENUMERATION:
        raise ValueError(f"W is too large to enumerate: 2^{n} bases; at most {LARGEST_ENUMERATION} unknowns")
    limit, work = (1 << n) if max_iterations is None else max_iterations, space_for(n)
    status = enumerate_all(doubles(W), doubles(b), doubles(z), n, doubles(w), tol, limit, work)
    if status == NOT_FINITE:
        check_finite(W, b)
    found = Solution(z, w, NAMES[status], work.iterations, work.residual, "enumeration")
    if status != FAILED:
        return found
    if (own := balanced(W, b)) is not None:
        status = enumerate_all(doubles(own.W), doubles(own.b), doubles(z), n, doubles(w), tol, limit, work)
        if status == SOLVED:
            return in_units(own, Solution(z, w, NAMES[status], work.iterations, work.residual, "enumeration"))
    return explained(W, b, found)


def many(
    matrices: Any, b: Any, z: Any, w: Any, status: Any, iterations: Any, residual: Any, tol: float, limit: int
) -> None:
    """Pivoting on one problem after the other; a single matrix serves all. For `batch`, which has the arrays."""
    size = len(b[0])
    solve_all(
        doubles(matrices), len(matrices) == 1, doubles(b), doubles(z), doubles(w), indices(status),
        indices(iterations), doubles(residual), len(b), size, tol, limit, space_for(size),
    )  # fmt: skip


@cython.cfunc
def pivot_once(
    W: Doubles,
    b: Doubles,
    z: Doubles,
    n: int,
    w: Doubles,
    tolerance: float,
    limit: int,
    work: Workspace,
) -> int:
    """`solve_dense` while other threads may run; NOT_FINITE for a problem that is not; fills z and w."""
    with cython.nogil:
        if not all_finite(W, b, n):
            return NOT_FINITE
        status = solve_dense(W, b, z, n, tolerance, limit, work)
        copy(w, work.slack, n)
        return status


@cython.cfunc
def enumerate_all(
    W: Doubles,
    b: Doubles,
    z: Doubles,
    n: int,
    w: Doubles,
    tolerance: float,
    limit: int,
    work: Workspace,
) -> int:
    """Every basis, and every vertex of a few unknowns, in the same way."""
    with cython.nogil:
        if not all_finite(W, b, n):
            return NOT_FINITE
        work.iterations, work.best_residual = 0, tolerance
        status = enumerate_bases(W, b, z, n, tolerance, limit, work)
        if status == FAILED and n <= TINY:
            status = enumerate_vertices(W, b, z, n, tolerance, work)
        if status != SOLVED:
            for i in range(n):
                z[i] = max(z[i], 0.0)
            work.residual = judge(W, b, z, n, work.slack, work.size)
        copy(w, work.slack, n)
        return status


@cython.cfunc
def solve_all(
    matrices: Doubles,
    shared: bool,
    b: Doubles,
    z: Doubles,
    w: Doubles,
    status: Indices,
    iterations: Indices,
    residual: Doubles,
    m: int,
    n: int,
    tolerance: float,
    limit: int,
    work: Workspace,
) -> None:
    """`pivot_once` for m problems."""
    for i in range(m):
        W = matrices if shared else after(matrices, i * n * n)
        x, y = after(z, i * n), after(w, i * n)
        status[i] = pivot_once(W, after(b, i * n), x, n, y, tolerance, limit, work)
        if status[i] != NOT_FINITE:
            iterations[i], residual[i] = work.iterations, work.residual


@cython.cfunc
def ray(work: Workspace, n: int) -> Ray:
    """The ray that the work space holds."""
    direction, start = array_of(work.ray_direction, n), array_of(work.ray_start, n)
    return Ray(start, direction, work.ray_z_0, work.ray_dz_0, 1.0 / array_of(work.row_scale, n))


@cython.cfunc
def array_of(x: Doubles, n: int) -> Any:
    """An array with these numbers."""
    array = np.empty(n)
    copy(doubles(array), x, n)
    return array
