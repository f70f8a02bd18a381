"""Periodic points of a map by Newton's method, stable and unstable alike, and their multipliers.

    P^n(x) = x;      multipliers: eigenvalues of DP^n(x) = DP(x_{n-1}) ... DP(x_0)

Source: Yu. Kuznetsov, Elements of Applied Bifurcation Theory (Springer 2004), section 10.1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.derivative import along
from lcpstep.errors import LcpStepError
from lcpstep.maps.iteration import Map, iterate

Array = NDArray[np.float64]
MAX_ITERATIONS = 30
HALVINGS = 8  # of a Newton step that does not come closer
CONVERGED = 1e-11  # residual, relative to the size of the point
# Residual that rounding leaves; what it shrinks to while there are digits to gain
ROUNDED, CONTRACTION = 1e-15, 0.5
STAGNATED = 1e-8  # a residual that rounding keeps from becoming smaller is accepted below this
FAR = 1e3  # of the size of the guess: how much larger a point near it may be


class NotConverged(LcpStepError):
    """Newton's method found no periodic point; its last one is in `x`, the residual there in `residual`."""

    def __init__(self, message: str, x: Array, residual: float) -> None:
        super().__init__(message)
        self.x, self.residual = x, residual


@dataclass(frozen=True, eq=False)
class PeriodicPoint:
    """A point that comes back after n iterations.

    Attributes
    ----------
    points : (n, d)   the points of the orbit
    multipliers : (d,)   eigenvalues of DP^n, largest modulus first
    residual : max |P^n(x) - x|
    """

    points: Array
    multipliers: NDArray[np.complex128]
    residual: float

    @property
    def period(self) -> int:
        """Number of points."""
        return len(self.points)

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return bool(np.all(np.abs(self.multipliers) < 1.0))


def periodic_point(P: Map, x: ArrayLike, n: int = 1) -> PeriodicPoint:
    """Newton's method for P^n(x) = x, from the guess x.

    Parameters
    ----------
    P : map
    x : (d,)   guess
    n : number of iterations after which the point comes back

    Raises
    ------
    ValueError   n is not positive, or x is no vector of finite numbers
    NotConverged   no periodic point near the guess
    """
    checks.function("P", P, "a state, a map")
    n = checks.count("n", n)
    x = np.array(checks.vector("x", x))
    size = float(np.max(np.abs(x)))
    F, J = _residual(P, x, n, size)
    # That of the guess, for the point may be zero. Its image tells nothing where it is no point that comes back
    size = guessed = size or float(np.max(np.abs(F)))
    for _ in range(MAX_ITERATIONS):
        # Where all drifts steadily, steps lead away without end, and no residual is large beside such points
        size = min(max(size, float(np.max(np.abs(x)))), FAR * guessed)
        error = float(np.max(np.abs(F)))
        if error <= ROUNDED * size:
            break
        step: Array = np.linalg.lstsq(J - np.eye(len(x)), -F, rcond=None)[0].astype(float)
        better = _shortened(P, x, F, step, n, size)
        # A point far from zero, or where multipliers are nearly one, has more digits to give than its residual says
        if error <= CONVERGED * size and (better is None or np.max(np.abs(better[1])) > CONTRACTION * error):
            break
        if better is None:
            if error <= STAGNATED * size:
                break
            raise NotConverged(f"no point of period {n} near {x.tolist()}: residual {error:.3g}", x, error)
        x, F, J = better
    else:
        raise NotConverged(
            f"no point of period {n} within {MAX_ITERATIONS} iterations, residual {np.max(np.abs(F)):.3g}",
            x, float(np.max(np.abs(F))),
        )  # fmt: skip
    return PeriodicPoint(iterate(P, x, n)[:n], multipliers(J), float(np.max(np.abs(F))))


def image_and_derivative(P: Map, x: Array, n: int, size: float = 0.0) -> tuple[Array, Array]:
    """P^n(x), and DP^n(x) by the chain rule along the orbit; size : see `along`."""
    images, derivatives = along(P, x, n, size=size)
    J = np.eye(len(x))
    for factor in derivatives:
        J = factor @ J
    return images[-1], J


def multipliers(J: Array) -> NDArray[np.complex128]:
    """Eigenvalues of a monodromy matrix, largest modulus first."""
    values = np.linalg.eigvals(J).astype(complex)
    return values[np.argsort(-np.abs(values), kind="stable")]


def _residual(P: Map, x: Array, n: int, size: float) -> tuple[Array, Array]:
    image, J = image_and_derivative(P, x, n, size)
    return image - x, J


def _shortened(
    P: Map, x: Array, F: Array, step: Array, n: int, size: float
) -> tuple[Array, Array, Array] | None:
    """The Newton step, halved until it brings the residual down; None where it never does."""
    for k in range(HALVINGS):
        trial = x + 0.5**k * step
        try:
            moved = iterate(P, trial, n)
        except (ValueError, LcpStepError):  # outside of where the map is defined
            continue
        if np.max(np.abs(moved[-1] - trial)) < np.max(np.abs(F)):
            return trial, *_residual(P, trial, n, size)
    return None
