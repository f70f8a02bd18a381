"""Border collision of a fixed point of a piecewise-smooth map x -> P(x, p): where it is, and both sides of it.

    P(x, p) - x = 0,    H(x, p) = 0        by Newton's method, with the derivatives of the side that the point lies on

On each side the derivatives by x and p are limits from inside of it, extrapolated from four places a step apart. The
result is the piecewise-linear map of `border_collision`, whose classification says what happens. Source: M. di
Bernardo, C. Budd, A. Champneys, P. Kowalczyk, Piecewise-smooth Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.border_collision import PiecewiseLinearMap
from lcpstep.analysis.derivative import differences, one_sided
from lcpstep.analysis.fixed_points import NotConverged
from lcpstep.errors import LcpStepError, UnknownName
from lcpstep.maps.formulas import Family

Array = NDArray[np.float64]
STEP = 1e-3  # of the extrapolation, in units of the point: farther than the differences reach
CONVERGED = 1e-11
ITERATIONS = 40


class Collision(NamedTuple):
    """The fixed point on the border, the parameter there, and the map's linear parts on both sides."""

    x: Array
    p: float
    map: PiecewiseLinearMap


def border_point(family: Family, parameter: str, near: float, x: ArrayLike | None = None) -> Collision:
    """Where a fixed point of the family meets the border H = 0 as a parameter varies.

    Parameters
    ----------
    family : with a function `side` H(x, parameters), the border of its smooth pieces
    parameter, near : name of the parameter, and a guess of its value
    x : (d,)   guess of the point; the family's start where not given

    Raises
    ------
    UnknownName   the family has no such parameter
    LcpStepError   it has no border, or H does not depend on x there
    NotConverged   no fixed point on the border near the guess
    """
    if family.side is None:
        raise LcpStepError(f"{family.name}: has no border; give a function side(x, parameters), zero on it")
    if parameter not in family.parameters:
        raise UnknownName(f"parameter of {family.name}", parameter, family.parameters)
    d = len(np.asarray(family.x0))
    start = checks.array("x", family.x0 if x is None else x, (d,))
    z: Array = np.append(start, checks.number(parameter, near))
    local = _Local(family, parameter)
    for _ in range(ITERATIONS):
        C, D = local.border(z)
        if not np.any(C):
            raise LcpStepError(f"{family.name}: side does not depend on x at x = {z[:-1].tolist()}")
        F = np.append(local.image(z) - z[:-1], local.H(z))
        error = float(np.max(np.abs(F)))
        if error <= CONVERGED * max(1.0, float(np.max(np.abs(z)))):
            return Collision(z[:-1], float(z[-1]), local.linear(z, C, D))
        A, B = local.derivatives(z, C, 1.0 if local.H(z) > 0.0 else -1.0)
        matrix = np.block([[A - np.eye(d), B[:, None]], [C[None, :], np.atleast_2d(D)]])
        z = z + np.linalg.lstsq(matrix, -F, rcond=None)[0]
        if not np.all(np.isfinite(z)):
            break
    raise NotConverged(f"no fixed point on the border near {parameter} = {near:g}", z[:-1], error)


class _Local:
    """The family as functions of z = (x, p)."""

    def __init__(self, family: Family, parameter: str) -> None:
        self.family, self.parameter = family, parameter

    def at(self, p: float) -> Family:
        """The family at a value of the parameter."""
        return self.family.with_values({self.parameter: p})

    def image(self, z: Array) -> Array:
        """P(x, p)."""
        return self.at(float(z[-1])).point(np.asarray(z[:-1]))

    def H(self, z: Array) -> float:
        """The border's function."""
        return self.at(float(z[-1])).border_value(np.asarray(z[:-1]))

    def border(self, z: Array) -> tuple[Array, float]:
        """H_x and H_p."""
        slope = differences(lambda y: np.array([self.H(y)]), z)[0]
        return slope[:-1], float(slope[-1])

    def derivatives(self, z: Array, C: Array, side: float) -> tuple[Array, Array]:
        """P_x and P_p as limits from one side of the border, H > 0 or < 0."""
        inwards = np.append(C / np.sqrt(C @ C), 0.0)
        step = STEP * max(1.0, float(np.max(np.abs(z[:-1]))))
        away = abs(self.H(z)) / float(np.sqrt(C @ C))
        if away > 2.0 * step:  # well inside a piece
            J = differences(self.image, z)
        else:
            J = one_sided(lambda s: differences(self.image, z + s * inwards), 0.0, side * step)
        return J[:, :-1], J[:, -1]

    def linear(self, z: Array, C: Array, D: float) -> PiecewiseLinearMap:
        """Both sides at the collision, as a map of deviations."""
        (A_minus, B_minus), (A_plus, B_plus) = (self.derivatives(z, C, side) for side in (-1.0, 1.0))
        return PiecewiseLinearMap(A_minus, A_plus, B_minus, B_plus, C, D)
