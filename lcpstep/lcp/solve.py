"""`solve_lcp`: the problem, the name of a method, and the judged answer."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from lcpstep.errors import UnknownName
from lcpstep.lcp.automatic import automatic, dense
from lcpstep.lcp.dense import enumeration, is_checked, pivoting
from lcpstep.lcp.newton import newton
from lcpstep.lcp.pgs import pgs
from lcpstep.lcp.problem import Solution, as_arrays, as_guess, limits
from lcpstep.lcp.qp import DEFAULT, known_solvers, parse, quadratic, require_solver, unpolished
from lcpstep.lcp.status import TOLERANCE, Status

Method = Callable[[Any, Any, Any, float, int | None], Solution]

METHODS: dict[str, Method] = {
    "auto": automatic,
    "lemke": pivoting,
    "enumeration": enumeration,
    "newton": newton,
    "pgs": pgs,
    "qp": partial(quadratic, DEFAULT),
}
NEEDS_DENSE = ("lemke", "enumeration")


def solve_lcp(
    W: Any,
    b: Any,
    method: str = "lemke",
    *,
    tol: float = TOLERANCE,
    guess: Any = None,
    max_iterations: int | None = None,
) -> Solution:
    """Find z >= 0 with w = W z + b >= 0 and z^T w = 0.

    Parameters
    ----------
    W : (n, n) array or scipy.sparse matrix; any real matrix, symmetric or not (see `method`)
    b : (n,) array
    method : str
        "lemke"        pivoting: principal exchanges first, then Lemke's path; any W
        "auto"         chosen by size, structure and symmetry; for large or sparse W
        "newton"       a few sparse or dense factorisations, then an interior point; large W
        "enumeration"  every basis, up to 20 unknowns
        "pgs"          projected Gauss-Seidel; cheap and approximate
        "qp"           quadratic programme by osqp; "qp:NAME" by another solver of qpsolvers.
                       Only symmetric positive semidefinite W. "qp:NAME:TOLERANCE", as "qp:osqp:1e-4", gives
                       what the solver itself finds at that tolerance, to judge solvers by
    tol : float          largest judged residual of an answer that is called solved, relative and unit-free
    guess : (n,) array or a Solution of a similar problem; its positive z are tried first
    max_iterations : int  of what the method counts: pivots, bases, factorisations, sweeps

    Returns
    -------
    Solution : z, w, status, solved, iterations, residual, method, certificate. Arguments are not modified.

    Raises
    ------
    ValueError : W or b are not real, finite and of matching shapes; W is outside of what the method solves
    UnknownName, MissingSolver : no such method; its package is not installed
    """
    if not is_checked(W, b):
        W, b = as_arrays(W, b)
    max_iterations = limits(tol, max_iterations)
    n = len(b)
    z = np.zeros(n) if guess is None else as_guess(guess, n)
    if n == 0:
        check_method(method)
        return Solution(z, z.copy(), Status.SOLVED, 0, 0.0, method)
    solver = (METHODS.get(method) if isinstance(method, str) else None) or find_method(method)
    if type(W) is not np.ndarray and method in NEEDS_DENSE:
        W = dense(W)
    return solver(W, b, z, tol, max_iterations)


def check_method(method: str) -> None:
    """UnknownName or MissingSolver unless `solve_lcp` can use this method."""
    if not isinstance(method, str) or method not in METHODS:
        find_method(method)


def find_method(method: str) -> Method:
    """The QP back-end that "qp:NAME" names."""
    if isinstance(method, str) and method.startswith("qp:"):
        name, tolerance = parse(method)
        require_solver(name)
        return partial(quadratic, name) if tolerance is None else partial(unpolished, name, tolerance)
    raise UnknownName("LCP solver", method, [*METHODS, *(f"qp:{name}" for name in known_solvers())])
