"""Mechanisms from SymPy's own mechanics: objects of `KanesMethod`, `LagrangesMethod` and `System`.

Kane's equations are in speeds u with q' = W u + w; here they are brought back to velocities v = q':

    M_k u' = f_k,   u = Y (v - w),  Y = W^-1,   u' = Y v' + r      becomes      Y^T M_k Y v' = Y^T (f_k - M_k r)

which keeps the mass matrix symmetric. Source: T. R. Kane, D. A. Levinson, Dynamics: Theory and Applications
(McGraw-Hill 1985), chapters 2 and 6.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy
from numpy.typing import ArrayLike
from sympy import Expr, ImmutableMatrix
from sympy.physics.mechanics import KanesMethod, LagrangesMethod

from lagrangian.symbolic import (
    Equations,
    Mechanism,
    _jacobian,
    _parameters,
    _sequence,
    _tidy,
    _Variables,
    made,
)


def from_sympy(
    method: Any,
    *,
    parameters: Mapping[Any, float] | None = None,
    gaps: Expr | list[Expr] = (),
    restitution: ArrayLike = 0.0,
    name: str = "mechanism",
) -> Mechanism:
    """See `lagrangian.symbolic.from_sympy`."""
    method = _formed(method)
    coordinates = list(method.q)
    values = _parameters(parameters or {})
    x = _Variables.of(coordinates, None, values)
    kane = isinstance(method, KanesMethod)
    mass, forcing, offset, rates = _in_velocities(method, coordinates) if kane else _as_they_are(method)
    n = len(coordinates)
    Y, w = (_read(x, "the kinematic equations", part) for part in (rates, offset))
    M_k = _read(x, "the mass matrix", mass)
    f_k = _read(x, "the forces", forcing)
    v = ImmutableMatrix(x.v)
    U = Y * (v - w)
    r = _jacobian(U, x.q) * v + U.diff(x.t)
    M = (Y.T * M_k * Y).applyfunc(_tidy)
    M = ImmutableMatrix(n, n, lambda i, j: M[min(i, j), max(i, j)])
    f = Y.T * (f_k - M_k * r)
    if present := M.free_symbols & set(x.v):
        raise ValueError(f"method: expected a mass matrix without velocities, got {x.names(present)} in it")
    g = [x.read(f"gaps[{i}]", gap, x.v) for i, gap in enumerate(_sequence(gaps))]
    G = _jacobian(g, x.q)
    gap = ImmutableMatrix(len(g), 1, g)
    gap_t = gap.diff(x.t)
    u = G * v + gap_t
    equations = Equations(
        M=M,
        N=ImmutableMatrix.zeros(n, 1),
        F=f,
        force=f,
        force_q=_jacobian(f, x.q),
        force_v=_jacobian(f, x.v),
        gap=gap,
        jacobian=G,
        gap_t=gap_t,
        bias=_jacobian(u, x.q) * v + u.diff(x.t),
        energy=ImmutableMatrix(0, 1, []),
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
    Y = W.inv().applyfunc(_tidy)
    U = Y * (sympy.Matrix(rates) - w)
    written = dict(zip(speeds, U, strict=True))
    return method.mass_matrix.xreplace(written), method.forcing.xreplace(written), w, Y


def _as_they_are(method: LagrangesMethod) -> tuple[Any, Any, Any, Any]:
    """Lagrange's equations are in the velocities already."""
    n = len(method.q)
    return method.mass_matrix, method.forcing, sympy.zeros(n, 1), sympy.eye(n)


def _read(x: _Variables, name: str, matrix: Any) -> ImmutableMatrix:
    """A matrix of the author's in q, v, t, p."""
    return ImmutableMatrix(matrix.rows, matrix.cols, [x.read(f"method: {name}", entry) for entry in matrix])
