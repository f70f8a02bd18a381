"""The equations of a mechanism as expressions, and what every way to them does: derivatives, tidying."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import sympy
from sympy import Expr, ImmutableMatrix, Symbol

if TYPE_CHECKING:
    from lagrangian.symbolic.variables import Variables


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations of a mechanism in its author's symbols: M v' + N = F + G^T lambda, gaps g >= 0.

    M : (n_q, n_q)   mass matrix
    N : (n_q, 1)   gyroscopic and Coriolis terms: what the Lagrangian gives beyond its value at v = 0
    F : (n_q, 1)   all other forces
    force, force_q, force_v : f = F - N and its Jacobians df/dq, df/dv
    gap, jacobian, gap_t, bias : g, G = dg/dq, partial g / partial t, and (dG/dt) v + d(g_t)/dt; one row a gap
    energy : (1, 1)   Jacobi's integral v dL/dv - L, the energy where nothing moves by prescription
    """

    M: ImmutableMatrix
    N: ImmutableMatrix
    F: ImmutableMatrix
    force: ImmutableMatrix
    force_q: ImmutableMatrix
    force_v: ImmutableMatrix
    gap: ImmutableMatrix
    jacobian: ImmutableMatrix
    gap_t: ImmutableMatrix
    bias: ImmutableMatrix
    energy: ImmutableMatrix

    def each(self, change: Callable[[Expr], Expr]) -> Equations:
        """The same with every expression changed."""
        return Equations(
            **{field.name: getattr(self, field.name).applyfunc(change) for field in fields(self)}
        )


def tidy(expression: Expr) -> Expr:
    """Without the squares of sines and cosines that velocities in Cartesian coordinates leave."""
    if not expression.has(sympy.sin, sympy.cos):
        return expression
    return min(expression, sympy.trigsimp(sympy.expand(expression)), key=sympy.count_ops)


def jacobian_of(rows: Iterable[Expr], x: Sequence[Symbol]) -> ImmutableMatrix:
    """Matrix of the derivatives of each row by each symbol."""
    listed = list(rows)
    return ImmutableMatrix(len(listed), len(x), [row.diff(y) for row in listed for y in x])


def gap_rows(g: Sequence[Expr], x: Variables) -> dict[str, ImmutableMatrix]:
    """Gaps and their derivatives, as `Equations` names them."""
    gap, G = ImmutableMatrix(len(g), 1, list(g)), jacobian_of(g, x.q)
    gap_t, v = gap.diff(x.t), ImmutableMatrix(x.v)
    u = G * v + gap_t
    return {"gap": gap, "jacobian": G, "gap_t": gap_t, "bias": jacobian_of(u, x.q) * v + u.diff(x.t)}


def beside_jumps(expression: Expr) -> Expr:
    """Derivatives on either side of a jump: without the impulse at it."""
    return stepped(expression.replace(sympy.DiracDelta, lambda *_: sympy.S.Zero))


def stepped(expression: Expr) -> Expr:
    """Heaviside's step by the sign, which Python can write."""
    return expression.replace(sympy.Heaviside, lambda y, *_: (1 + sympy.sign(y)) / 2)
