"""Border collisions of continuous piecewise-linear maps: canonical form, Feigin's counts, verdict.

    x -> A- x + B- m   where  C x + D m < 0,        x -> A+ x + B+ m   where  C x + D m > 0

with the parameter m measured from the collision. Continuity across the border asks for A+ - A- = E C and
B+ - B- = E D with one vector E. With s(+1), s(-1) the numbers of real eigenvalues above 1 and below -1:

    s+(+1) + s-(+1) even   persistence: one fixed point goes over into the other
                    odd    nonsmooth fold: the two meet and vanish
    s+(-1) + s-(-1) odd    an orbit of period two is born or dies (nonsmooth period doubling)

Source: M. Feigin, Doubling of the oscillation period with C-bifurcations, PMM 34 (1970); M. di Bernardo, M. Feigin,
S. Hogan, M. Homer, Local analysis of C-bifurcations in n-dimensional piecewise-smooth dynamical systems, Chaos,
Solitons and Fractals 10 (1999); G. Osorio, Complex Behavior in Impacting Systems, sections 5.3-5.4.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.errors import LcpStepError
from lcpstep.pace import counted

Array = NDArray[np.float64]
CONTINUOUS = 1e-5  # gap across the border, relative to the matrices, below which a map counts as continuous
ON_THE_CIRCLE = 1e-9  # an eigenvalue this close to +1 or -1 leaves the verdict open
REAL = 1e-9  # relative size of the imaginary part of a real eigenvalue


class NotContinuous(LcpStepError):
    """The two sides of a map do not meet on its border; `gap` is the relative size of what is missing."""

    def __init__(self, gap: float) -> None:
        super().__init__(
            f"the map is not continuous across its border: A+ - A- = E C and B+ - B- = E D hold for no E; "
            f"what is left over is {gap:.3g} of the matrices"
        )
        self.gap = gap


@dataclass(frozen=True, eq=False)
class PiecewiseLinearMap:
    """A map that is linear on both sides of a border; see the head of the file.

    Parameters
    ----------
    A_minus, A_plus : (d, d)   derivatives by the state, where C x + D m < 0 and > 0
    B_minus, B_plus : (d,)   derivatives by the parameter
    C : (d,)   border by the state
    D : border by the parameter

    Raises
    ------
    ValueError   a shape does not fit, a number is not finite, or C is zero
    """

    A_minus: ArrayLike
    A_plus: ArrayLike
    B_minus: ArrayLike
    B_plus: ArrayLike
    C: ArrayLike
    D: float

    def __post_init__(self) -> None:
        d = len(checks.vector("C", self.C))
        for name in ("A_minus", "A_plus"):
            object.__setattr__(self, name, checks.array(name, getattr(self, name), (d, d)))
        for name in ("B_minus", "B_plus", "C"):
            object.__setattr__(self, name, checks.array(name, getattr(self, name), (d,)))
        object.__setattr__(self, "D", checks.number("D", self.D))
        if not np.any(np.asarray(self.C)):
            raise ValueError("C: expected a border that depends on the state, got zeros")

    def __call__(self, x: ArrayLike, m: float) -> Array:
        """The image of x at the parameter m, (d,)."""
        return self.at(m)(np.asarray(x, dtype=float))

    def at(self, m: float) -> Callable[[Array], Array]:
        """The map of states (d,) at the parameter m, for many images."""
        C, A_minus, A_plus = map(np.asarray, (self.C, self.A_minus, self.A_plus))
        border, b_minus, b_plus = -self.D * m, np.asarray(self.B_minus) * m, np.asarray(self.B_plus) * m

        def image(x: Array) -> Array:
            return np.asarray(A_minus @ x + b_minus if C @ x < border else A_plus @ x + b_plus)

        return image

    def gap(self) -> tuple[float, Array]:
        """What keeps the map from being continuous, relative to its matrices, and the vector E that comes nearest."""
        border = np.append(np.asarray(self.C), self.D)
        minus = np.column_stack([np.asarray(self.A_minus), np.asarray(self.B_minus)])
        plus = np.column_stack([np.asarray(self.A_plus), np.asarray(self.B_plus)])
        # Columns weighed alike, whatever their units
        size = np.maximum(np.abs(minus), np.abs(plus))
        columns = np.maximum(np.max(size, axis=0), np.finfo(float).tiny)
        jump, normal = (plus - minus) / columns, border / columns
        E = jump @ normal / (normal @ normal)
        left = jump - np.outer(E, normal)
        rows = np.maximum(np.max(np.abs(plus / columns), axis=1), np.max(np.abs(minus / columns), axis=1))
        return float(np.max(np.abs(left) / np.maximum(rows, np.finfo(float).tiny)[:, None])), E


class Fixed(NamedTuple):
    """Fixed points per unit of the parameter: x = x_side m; admissible where it lies on its own side."""

    minus: Array
    plus: Array
    minus_exists: tuple[bool, bool]  # for m < 0, m > 0
    plus_exists: tuple[bool, bool]


@dataclass(frozen=True, eq=False)
class BorderCollision:
    """What happens as the parameter of a piecewise-linear map passes zero.

    Attributes
    ----------
    verdict : "persistence", "nonsmooth fold" or "undecided" (an eigenvalue is +1)
    period_doubling : whether an orbit of period two is born or dies; None where an eigenvalue is -1
    multipliers_minus, multipliers_plus : (d,) eigenvalues of A- and A+
    above, below : ((s-, s+)) numbers of real eigenvalues above +1 and below -1 on each side
    fixed : Fixed
    two_cycle : (for m < 0, for m > 0) whether an admissible orbit of period two with a point on each side exists
    canonical : (d + 1, 2)   coefficients of the characteristic polynomials, of A- and A+, highest power first: the
        canonical (companion) form of both sides
    gap : how far the map is from being continuous
    """

    verdict: str
    period_doubling: bool | None
    multipliers_minus: NDArray[np.complex128]
    multipliers_plus: NDArray[np.complex128]
    above: tuple[int, int]
    below: tuple[int, int]
    fixed: Fixed
    two_cycle: tuple[bool, bool]
    canonical: Array
    gap: float

    @property
    def words(self) -> str:
        """The verdict as a sentence."""
        doubling = {True: ", with a period-two orbit", False: "", None: ", doubling undecided"}
        return self.verdict + doubling[self.period_doubling]


def classify(f: PiecewiseLinearMap) -> BorderCollision:
    """Feigin's classification of the border collision of f at m = 0.

    Raises
    ------
    NotContinuous   the two sides do not meet on the border
    """
    checks.instance("f", f, PiecewiseLinearMap)
    gap, _ = f.gap()
    if gap > CONTINUOUS:
        raise NotContinuous(gap)
    minus, plus = (np.linalg.eigvals(np.asarray(A)).astype(complex) for A in (f.A_minus, f.A_plus))
    above = _real_beyond(minus, 1.0), _real_beyond(plus, 1.0)
    below = _real_beyond(minus, -1.0), _real_beyond(plus, -1.0)
    return BorderCollision(
        verdict=_verdict(minus, plus, above),
        period_doubling=None if _touches(minus, plus, -1.0) else bool(sum(below) % 2),
        multipliers_minus=minus,
        multipliers_plus=plus,
        above=above,
        below=below,
        fixed=_fixed_points(f),
        two_cycle=(_two_cycle(f, -1.0), _two_cycle(f, 1.0)),
        canonical=np.column_stack([np.poly(np.asarray(A)) for A in (f.A_minus, f.A_plus)]).astype(float),
        gap=gap,
    )


def diagram(
    f: PiecewiseLinearMap, m: ArrayLike, *, drop: int = 500, keep: int = 60, bound: float = 1e6
) -> list[Array]:
    """Brute-force bifurcation diagram of the local map: the last points of an orbit, (keep, d), for each m.

    Orbits are continued from one m to the next, and start at the origin. One that leaves `bound` times |m| (1 + |B|)
    has no points.
    """
    checks.instance("f", f, PiecewiseLinearMap)
    points, x = [], np.zeros(len(np.asarray(f.C)))
    size = 1.0 + float(np.max(np.abs(np.concatenate([np.asarray(f.B_minus), np.asarray(f.B_plus)]))))
    for value in counted(checks.vector("m", m).tolist()):
        orbit: list[Array] = []
        image, limit = f.at(value), bound * size * abs(value)
        for k in range(drop + keep):
            x = image(x)
            if not all(-limit <= a <= limit for a in x.tolist()):
                orbit, x = [], np.zeros_like(x)
                break
            if k >= drop:
                orbit.append(x)
        points.append(np.array(orbit).reshape(-1, len(x)))
    return points


def _real_beyond(eigenvalues: NDArray[np.complex128], bound: float) -> int:
    """Real eigenvalues above 1 (bound = 1) or below -1 (bound = -1)."""
    real = eigenvalues[np.abs(eigenvalues.imag) <= REAL * np.abs(eigenvalues)].real
    return int(np.sum(real > bound if bound > 0.0 else real < bound))


def _touches(minus: NDArray[np.complex128], plus: NDArray[np.complex128], value: float) -> bool:
    return bool(np.any(np.abs(np.append(minus, plus) - value) <= ON_THE_CIRCLE))


def _verdict(minus: NDArray[np.complex128], plus: NDArray[np.complex128], above: tuple[int, int]) -> str:
    if _touches(minus, plus, 1.0):
        return "undecided"
    return "nonsmooth fold" if sum(above) % 2 else "persistence"


def _fixed_points(f: PiecewiseLinearMap) -> Fixed:
    """x = (1 - A)^-1 B m on each side, and for which sign of m it lies there; NaN where 1 - A is singular."""
    one = np.eye(len(np.asarray(f.C)))

    def solved(A: Array, B: Array, side: float) -> tuple[Array, tuple[bool, bool]]:
        try:
            x: Array = np.linalg.solve(one - A, B).astype(float)
        except np.linalg.LinAlgError:
            return np.full(len(B), np.nan), (False, False)
        place = side * (float(np.asarray(f.C) @ x) + f.D)
        return x, (place < 0.0, place > 0.0)

    minus, minus_exists = solved(np.asarray(f.A_minus), np.asarray(f.B_minus), -1.0)
    plus, plus_exists = solved(np.asarray(f.A_plus), np.asarray(f.B_plus), 1.0)
    return Fixed(minus, plus, minus_exists, plus_exists)


def _two_cycle(f: PiecewiseLinearMap, m: float) -> bool:
    """Whether x on the minus side and its image on the plus side come back after two steps."""
    A, B = np.asarray(f.A_minus), np.asarray(f.B_minus) * m
    A2, B2 = np.asarray(f.A_plus), np.asarray(f.B_plus) * m
    try:
        x = np.linalg.solve(np.eye(len(B)) - A2 @ A, A2 @ B + B2)
    except np.linalg.LinAlgError:
        return False
    C = np.asarray(f.C)
    return bool(C @ x + f.D * m < 0.0 < C @ (A @ x + B) + f.D * m)
