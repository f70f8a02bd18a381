"""Quadratic programming back-ends, through qpsolvers, for symmetric positive semidefinite W.

Then z solves the complementarity problem exactly when it minimises 1/2 z^T W z + b^T z over z >= 0 (these are
its Karush-Kuhn-Tucker conditions). Such a solver stops at its own tolerances; its set of positive z is
therefore solved for afresh, and the better of the two answers is judged and returned.
"""

from __future__ import annotations

import contextlib
import io
import warnings
from functools import cache
from typing import Any

import numpy as np

from lcpstep.errors import MissingSolver, UnknownName
from lcpstep.lcp.definite import require_semidefinite, scaled, unit_diagonal
from lcpstep.lcp.factor import factoriser
from lcpstep.lcp.infeasible import explained
from lcpstep.lcp.judged import residual
from lcpstep.lcp.newton import best_of, polish
from lcpstep.lcp.problem import Solution, check_finite, is_sparse
from lcpstep.lcp.status import FAILED, SOLVED, Status

DEFAULT = "osqp"
TIGHT: dict[str, dict[str, Any]] = {  # solvers that stop too early unless they are told not to
    "osqp": {"eps_abs": 1e-10, "eps_rel": 1e-10, "max_iter": 20_000, "polishing": True},
    "proxqp": {"eps_abs": 1e-10},
    "piqp": {"eps_abs": 1e-11, "eps_rel": 1e-12},
    "scs": {"eps_abs": 1e-9, "eps_rel": 1e-9},
    "clarabel": {"tol_gap_abs": 1e-12, "tol_gap_rel": 1e-12, "tol_feas": 1e-12},
}
TOLERANCES: dict[str, tuple[str, ...]] = {  # what a solver calls its tolerances; active-set methods have none
    "osqp": ("eps_abs", "eps_rel"),
    "proxqp": ("eps_abs", "eps_rel"),
    "piqp": ("eps_abs", "eps_rel"),
    "scs": ("eps_abs", "eps_rel"),
    "clarabel": ("tol_gap_abs", "tol_gap_rel", "tol_feas"),
}
ITERATIONS = {
    "osqp": "max_iter",
    "proxqp": "max_iter",
    "piqp": "max_iter",
    "scs": "max_iters",
    "clarabel": "max_iter",
}
NEEDS_DEFINITE = ("quadprog",)
DEFINITE = 1e-10  # added to the unit diagonal for these; the polishing solves without it
EXCHANGES = 40  # of the polishing


@cache
def known_solvers() -> tuple[str, ...]:
    """Names of all the solvers that qpsolvers has an interface for, installed or not."""
    import qpsolvers

    suffix = "_solve_problem"
    return tuple(n.removesuffix(suffix) for n in dir(qpsolvers.solvers) if n.endswith(suffix))


def require_solver(name: str) -> None:
    """UnknownName or MissingSolver unless this back-end can be used."""
    import qpsolvers

    if name not in known_solvers():
        raise UnknownName("LCP solver", f"qp:{name}", [f"qp:{n}" for n in known_solvers()])
    if name not in qpsolvers.available_solvers:
        from importlib.metadata import metadata

        extras = metadata("qpsolvers").get_all("Provides-Extra") or []
        how = (
            f"pip install 'qpsolvers[{name}]'"
            if name in extras
            else f"pip install its own package, see the documentation of {name}"
        )
        raise MissingSolver(f"the QP solver {name!r} is not installed: {how}")


def quadratic(name: str, W: Any, b: Any, z: Any, tol: float, max_iterations: int | None) -> Solution:
    """Solve with the qpsolvers back-end of this name; ValueError if W is not symmetric semidefinite."""
    require_solver(name)
    check_finite(W, b)
    require_semidefinite(W)
    d = unit_diagonal(W)
    found = call_solver(name, scaled(W, d), d * b, z / d, max_iterations)
    raw = np.zeros_like(b) if found is None else np.maximum(found * d, 0.0)
    with np.errstate(all="ignore"):  # a diverging attempt may overflow; the judge sees to it
        polished, used = polish(W, b, raw, tol, EXCHANGES, factoriser(W))
        best, error = best_of(W, b, polished)
    status = SOLVED if error <= tol else FAILED
    return explained(W, b, Solution(best, W @ best + b, Status(status), used, error, f"qp:{name}"))


def unpolished(
    name: str, tolerance: float, W: Any, b: Any, z: Any, tol: float, max_iterations: int | None
) -> Solution:
    """The solver's own answer at its own tolerance, for judging solvers: solved means that the solver says so."""
    check_finite(W, b)
    require_semidefinite(W)
    d = unit_diagonal(W)
    options = dict.fromkeys(TOLERANCES[name], tolerance) | ({"polishing": False} if name == "osqp" else {})
    found = call_solver(name, scaled(W, d), d * b, z / d, max_iterations, options)
    answer = np.zeros_like(b) if found is None else np.maximum(found * d, 0.0)
    error = residual(W, b, answer)
    status = FAILED if found is None else SOLVED
    return Solution(answer, W @ answer + b, Status(status), 0, error, f"qp:{name}:{tolerance:g}")


def parse(method: str) -> tuple[str, float | None]:
    """Solver and tolerance that "qp:NAME" or "qp:NAME:TOLERANCE" name; ValueError for a tolerance that is none."""
    name, colon, text = method.removeprefix("qp:").partition(":")
    if not colon:
        return name, None
    try:
        tolerance = float(text)
    except ValueError:
        tolerance = -1.0
    if name in known_solvers() and name not in TOLERANCES:
        raise ValueError(f"method: {name} has no tolerance to set, got {method!r}; use 'qp:{name}'")
    if not 0.0 < tolerance < 1.0:
        raise ValueError(f"method: expected a tolerance between 0 and 1 as in 'qp:osqp:1e-6', got {method!r}")
    return name, tolerance


def call_solver(
    name: str,
    P: Any,
    q: Any,
    guess: Any,
    max_iterations: int | None,
    options: dict[str, Any] | None = None,
) -> Any:
    """Minimiser that the solver found, or None; P has a unit diagonal and q is brought to size one."""
    import qpsolvers

    options = dict(TIGHT.get(name, {}) if options is None else options)
    if max_iterations is not None and name in ITERATIONS:
        options[ITERATIONS[name]] = max(max_iterations, 1)  # none at all is an error of theirs
    if name in NEEDS_DEFINITE:
        P = P + DEFINITE * np.eye(len(q))
    if name not in qpsolvers.sparse_solvers:
        P = P.toarray() if is_sparse(P) else np.asarray(P)
    elif is_sparse(P) or name not in qpsolvers.dense_solvers:
        P = _column_form(P)
    size = float(np.max(np.abs(q), initial=0.0)) or 1.0
    problem = qpsolvers.Problem(P, q / size, lb=np.zeros_like(q))
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")  # what they say of their tolerances; the judge decides here
        try:
            x = qpsolvers.solve_problem(problem, name, initvals=guess / size, **options).x
        except (ValueError, ArithmeticError, qpsolvers.exceptions.QPError):
            return None
    return None if x is None or not np.isfinite(x).all() else np.asarray(x) * size


def _column_form(P: Any) -> Any:
    """CSC as the solvers expect it: piqp reads indices in the order they come, osqp has 32 bits for them."""
    from scipy.sparse import csc_matrix

    P = csc_matrix(P)
    P.sort_indices()
    indices, indptr = P.indices.astype(np.int32), P.indptr.astype(np.int32)
    return csc_matrix((P.data, indices, indptr), shape=P.shape)
