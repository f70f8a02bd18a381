"""Mechanisms from SymPy's own mechanics: objects of `KanesMethod`, `LagrangesMethod` and `System`.

Kane's equations are in speeds u with q' = W u + w; here they are brought back to velocities v = q':

    M_k u' = f_k,   u = Y (v - w),  Y = W^-1,   u' = Y v' + r      becomes      Y^T M_k Y v' = Y^T (f_k - M_k r)

which keeps the mass matrix symmetric. Source: T. R. Kane, D. A. Levinson, Dynamics: Theory and Applications
(McGraw-Hill 1985), chapters 2 and 6.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy
from numpy.typing import ArrayLike
from sympy import Expr, ImmutableMatrix
from sympy.physics.mechanics import KanesMethod, LagrangesMethod

from lagrangian.symbolic.expressions import Equations, gap_rows, jacobian_of, tidy
from lagrangian.symbolic.mechanism import Mechanism, made
from lagrangian.symbolic.variables import Variables, parameter_values, sequence


def from_sympy(
    method: Any,
    *,
    parameters: Mapping[Any, float] | None = None,
    gaps: Expr | Sequence[Expr] = (),
    restitution: ArrayLike = 0.0,
    name: str = "mechanism",
) -> Mechanism:
    """A mechanism from SymPy's own mechanics: its equations, with gaps.

    Parameters
    ----------
    method : sympy.physics.mechanics.System, KanesMethod or LagrangesMethod whose equations are formed, in independent
        coordinates and speeds; speeds may be any that the kinematic equations give
    parameters, gaps, restitution, name : as of `derive`; gaps in the method's coordinates

    Returns
    -------
    Mechanism, whose velocities are the derivatives of the coordinates; its energy is not known

    Raises
    ------
    ValueError   method is none of these, or has dependent coordinates or speeds; a symbol has no value
    """
    method = _formed(method)
    coordinates = list(method.q)
    values = parameter_values(parameters or {})
    x = Variables.of(coordinates, None, values)
    kane = isinstance(method, KanesMethod)
    mass, forcing, offset, rates = _in_velocities(method, coordinates) if kane else _as_they_are(method)
    n = len(coordinates)
    Y, w = (_read(x, "the kinematic equations", part) for part in (rates, offset))
    M_k = _read(x, "the mass matrix", mass)
    f_k = _read(x, "the forces", forcing)
    v = ImmutableMatrix(x.v)
    U = Y * (v - w)
    r = jacobian_of(U, x.q) * v + U.diff(x.t)
    M = (Y.T * M_k * Y).applyfunc(tidy)
    M = ImmutableMatrix(n, n, lambda i, j: M[min(i, j), max(i, j)])
    f = Y.T * (f_k - M_k * r)
    if present := M.free_symbols & set(x.v):
        raise ValueError(f"method: expected a mass matrix without velocities, got {x.names(present)} in it")
    g = [x.read(f"gaps[{i}]", gap, x.v) for i, gap in enumerate(sequence(gaps))]
    equations = Equations(
        M=M,
        N=ImmutableMatrix.zeros(n, 1),
        F=f,
        force=f,
        force_q=jacobian_of(f, x.q),
        force_v=jacobian_of(f, x.v),
        energy=ImmutableMatrix(0, 1, []),
        **gap_rows(g, x),
    )
    return made(equations, g, x, values, restitution, name)


def _formed(method: Any) -> KanesMethod | LagrangesMethod:
    """The method that holds the equations; ValueError for what is none, or has constraints."""
    if hasattr(method, "form_eoms") and hasattr(method, "eom_method"):  # a System
        if method.eom_method is None:
            method.form_eoms()
        method = method.eom_method
    if not isinstance(method, KanesMethod | LagrangesMethod):
        raise ValueError(f"method: expected a SymPy System, KanesMethod or LagrangesMethod, got {method!r}")
    formed = getattr(method, "_fr" if isinstance(method, KanesMethod) else "_m_d", None)
    if not formed:
        call = "kanes_equations()" if isinstance(method, KanesMethod) else "form_lagranges_equations()"
        raise ValueError(f"method: its equations are not formed yet; call {call} first")
    dependent = [x for name in ("_qdep", "_udep", "lam_vec") for x in getattr(method, name, None) or ()]
    if dependent:
        raise ValueError(
            f"method: expected independent coordinates and speeds, got {', '.join(map(str, dependent))}; "
            "what a constraint ties together is given as a joint: see lagrangian.Joints"
        )
    return method


def _in_velocities(method: KanesMethod, q: list[Expr]) -> tuple[Any, Any, Any, Any]:
    """Mass matrix and forces with u written in the coordinates' derivatives, and w, Y of u = Y (q' - w)."""
    rates = [x.diff(sympy.physics.mechanics.dynamicsymbols._t) for x in q]
    speeds = list(method.u)
    if speeds == rates:
        n = len(q)
        return method.mass_matrix, method.forcing, sympy.zeros(n, 1), sympy.eye(n)
    known = method.kindiffdict()
    given = sympy.Matrix([known[rate] for rate in rates])
    W = given.jacobian(speeds)
    w = given.xreplace(dict.fromkeys(speeds, sympy.S.Zero))
    Y = W.inv().applyfunc(tidy)
    U = Y * (sympy.Matrix(rates) - w)
    written = dict(zip(speeds, U, strict=True))
    return method.mass_matrix.xreplace(written), method.forcing.xreplace(written), w, Y


def _as_they_are(method: LagrangesMethod) -> tuple[Any, Any, Any, Any]:
    """Lagrange's equations are in the velocities already."""
    n = len(method.q)
    return method.mass_matrix, method.forcing, sympy.zeros(n, 1), sympy.eye(n)


def _read(x: Variables, name: str, matrix: Any) -> ImmutableMatrix:
    """A matrix of the author's in q, v, t, p."""
    return ImmutableMatrix(matrix.rows, matrix.cols, [x.read(f"method: {name}", entry) for entry in matrix])
