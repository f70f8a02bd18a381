"""Lagrange's equations of the second kind from L(t, q, v): see the head of `lagrangian.symbolic`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy
from numpy.typing import ArrayLike
from sympy import Expr, ImmutableMatrix

from lagrangian.symbolic.expressions import Equations, beside_jumps, gap_rows, jacobian_of, tidy
from lagrangian.symbolic.mechanism import Mechanism, made
from lagrangian.symbolic.variables import Variables, parameter_values, sequence


def derive(
    lagrangian: Expr,
    coordinates: Expr | Sequence[Expr],
    *,
    velocities: Expr | Sequence[Expr] | None = None,
    parameters: Mapping[Any, float] | None = None,
    dissipation: Expr | float = 0,
    forces: Sequence[Expr] | Mapping[Expr, Expr] | None = None,
    gaps: Expr | Sequence[Expr] = (),
    restitution: ArrayLike = 0.0,
    name: str = "mechanism",
) -> Mechanism:
    """Equations of motion and contacts of a mechanism from its Lagrangian.

    Expressions may contain the coordinates, their velocities, the time, and the parameters.

    Parameters
    ----------
    lagrangian : L = T - V [J], quadratic in the velocities, with a positive definite mass matrix
    coordinates : functions of time, as `dynamicsymbols` makes them (their velocities are q.diff(t), and t is
        their argument); or plain symbols, with `velocities` (the time is then the symbol t)
    velocities : symbols that stand for the coordinates' time derivatives
    parameters : names (or symbols) and values of every other symbol; symbols are told apart by name alone
    dissipation : Rayleigh's function D [W], which puts the force -dD/dv on each coordinate
    forces : generalised forces Q, one a coordinate, or a mapping {coordinate: force}
    gaps : gap functions g(t, q) >= 0 [m], free of velocities
    restitution : (n_c,) or one number for all gaps, 0 <= r <= 1
    name : a short name, for reports

    Returns
    -------
    Mechanism; `mechanism.scene(q0, v0, t_span)` is what `lcpstep.simulate` takes

    Raises
    ------
    ValueError   an expression has unknown symbols or is not real, the Lagrangian is not quadratic in the
        velocities or its mass matrix not positive definite, or a number of entries does not fit; the message
        names the argument

    Notes
    -----
    Where an expression jumps (sign, Heaviside, Piecewise), derivatives are those on either side of the jump.

    Examples
    --------
    >>> from sympy import cos, symbols
    >>> from sympy.physics.mechanics import dynamicsymbols
    >>> theta, (m, g, l) = dynamicsymbols("theta"), symbols("m g l")
    >>> L = m * l**2 * theta.diff() ** 2 / 2 + m * g * l * cos(theta)
    >>> pendulum = derive(L, theta, parameters={"m": 1.0, "g": 9.81, "l": 0.5})
    >>> pendulum.equations.M
    Matrix([[l**2*m]])
    """
    values = parameter_values(parameters or {})
    variables = Variables.of(sequence(coordinates), velocities, values)
    L = variables.read("lagrangian", lagrangian)
    D = variables.read("dissipation", dissipation)
    Q = _generalised_forces(forces, variables)
    g = [variables.read(f"gaps[{i}]", gap, variables.v) for i, gap in enumerate(sequence(gaps))]
    return made(lagranges_equations(L, D, Q, g, variables), g, variables, values, restitution, name)


def _generalised_forces(forces: Any, variables: Variables) -> list[Expr]:
    n_q = len(variables.q)
    if forces is None:
        return [sympy.S.Zero] * n_q
    if isinstance(forces, Mapping):
        if strange := [str(x) for x in forces if x not in variables.coordinates]:
            raise ValueError(
                f"forces: {', '.join(strange)} is no coordinate; these are {variables.coordinates}"
            )
        forces = [forces.get(x, 0) for x in variables.coordinates]
    forces = sequence(forces)
    if len(forces) != n_q:
        raise ValueError(f"forces: expected {n_q}, one a coordinate, got {len(forces)}")
    return [variables.read(f"forces[{i}]", force) for i, force in enumerate(forces)]


def lagranges_equations(L: Expr, D: Expr, Q: list[Expr], g: list[Expr], x: Variables) -> Equations:
    """Lagrange's equations and the gaps' derivatives, in q, v, t, p."""
    M, b, L_0 = _collected(L, x)
    v = ImmutableMatrix(x.v)
    momentum, moving = M * v + b, v.T * M * v / 2 + b.T * v
    N = jacobian_of(momentum, x.q) * v + (M * v).diff(x.t) - jacobian_of(moving, x.q).T
    F = jacobian_of([L_0], x.q).T - b.diff(x.t) - jacobian_of([D], x.v).T + ImmutableMatrix(Q)
    found = Equations(
        M=M,
        N=N,
        F=F,
        force=F - N,
        force_q=jacobian_of(F - N, x.q),
        force_v=jacobian_of(F - N, x.v),
        energy=v.T * M * v / 2 - ImmutableMatrix([L_0]),
        **gap_rows(g, x),
    )
    return found.each(beside_jumps)


def _collected(L: Expr, x: Variables) -> tuple[ImmutableMatrix, ImmutableMatrix, Expr]:
    """M, b, L_0 of L = v^T M v / 2 + b^T v + L_0; every coordinate must have inertia."""
    rates = set(x.v)
    momentum = jacobian_of([L], x.v).T
    M = jacobian_of(momentum, x.v).applyfunc(tidy)
    if M.free_symbols & rates:
        M = M.applyfunc(sympy.simplify)
    if present := M.free_symbols & rates:
        raise ValueError(
            f"lagrangian: expected one quadratic in the velocities, but its second derivatives by them "
            f"depend on {x.names(present)}"
        )
    if massless := [str(q) for i, q in enumerate(x.coordinates) if not any(M.row(i))]:
        raise ValueError(f"lagrangian: singular mass matrix: no kinetic energy in {', '.join(massless)}")
    n, at_rest = len(x.q), dict.fromkeys(x.v, sympy.S.Zero)
    symmetric = ImmutableMatrix(n, n, lambda i, j: M[min(i, j), max(i, j)])
    return symmetric, momentum.xreplace(at_rest).applyfunc(tidy), tidy(L.xreplace(at_rest))
