"""Branches of periodic points over a parameter, through folds, by pseudo-arclength continuation.

    F(x, p) = P_p^n(x) - x = 0,      tau . (z - z_predicted) = 0,      z = (x, p)

On the way bifurcations are located as roots along the branch:

    fold   det(DP^n - 1) = 0, the branch turns back      (it goes straight on at a branch point)
    flip   det(DP^n + 1) = 0
    torus  a complex pair of multipliers crosses the unit circle
    jump   the multipliers jump across one of these: a border collision, where the map is not smooth (known to
           within a step only where the branch has a kink there)

Source: Yu. Kuznetsov, Elements of Applied Bifurcation Theory (Springer 2004), sections 10.2-10.3.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.derivative import STENCIL
from lcpstep.analysis.fixed_points import image_and_derivative, multipliers, periodic_point
from lcpstep.errors import LcpStepError
from lcpstep.maps.iteration import Map, iterate

Array = NDArray[np.float64]
Family = Callable[[float], Map]
Monitor = Callable[[float, Array], Mapping[str, float]]
CORRECTIONS = 12  # Newton iterations of a point on the branch
CONVERGED = 1e-11  # residual, relative to the size of the point
CONTRACTION = 0.5  # a residual that shrinks by less than this is at its rounding, or will not converge
STAGNATED = 1e-8
FEW = 4  # corrections after which the step may grow
GROWTH, SHRINK = 1.4, 0.5
PARAMETER_STEP = 1e-5  # of the range, for the derivative by the parameter
ROOT = 1e-13  # of a step, where a bifurcation is located
SMALL = 1e-4  # a test function this small at its sign change, relative to the ends, is zero there and no jump


class Special(NamedTuple):
    """A special point of a branch; kind: fold, branch point, flip, torus, jump, or a name of the monitor's."""

    kind: str
    p: float
    x: Array
    multipliers: NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Branch:
    """Periodic points along a branch, in the order in which they were found.

    Attributes
    ----------
    p : (k,)   parameter
    x : (k, d)   points
    multipliers : (k, d)   of P^n
    special : the bifurcations located on the way
    ended : why the continuation ended, in words
    """

    p: Array
    x: Array
    multipliers: NDArray[np.complex128]
    special: tuple[Special, ...]
    ended: str

    @property
    def stable(self) -> NDArray[np.bool_]:
        """(k,) whether the points are stable."""
        return np.asarray(np.all(np.abs(self.multipliers) < 1.0, axis=1))

    def of_kind(self, kind: str) -> list[Special]:
        """The special points of one kind."""
        return [s for s in self.special if s.kind == kind]


@dataclass(frozen=True)
class Steps:
    """Step control: first, smallest and largest step, as shares of the parameter's range; most points."""

    first: float = 0.01
    smallest: float = 1e-7
    largest: float = 0.05
    points: int = 400

    def __post_init__(self) -> None:
        for name in ("first", "smallest", "largest"):
            checks.positive(name, getattr(self, name))
        checks.count("points", self.points)


def continue_point(
    family: Family,
    x: ArrayLike,
    p: float,
    p_range: tuple[float, float],
    *,
    n: int = 1,
    steps: Steps | None = None,
    monitor: Monitor | None = None,
    character: Callable[[float, Array], object] | None = None,
    forward: bool = True,
) -> Branch:
    """Follow the periodic point near x at the parameter p as p changes.

    Parameters
    ----------
    family : p -> map
    x : (d,)   guess of the periodic point
    p, p_range : where to start, and the range that the branch must not leave
    n : period of the point
    steps : step control
    monitor : (p, x) -> named numbers whose sign changes are located and reported under their names
    character : (p, x) -> what points of one branch have in common; a step to a point that differs is refused
    forward : the direction of p in which the branch is followed first

    Raises
    ------
    ValueError   the range is empty or reversed, or p lies outside of it
    NotConverged   no periodic point near x
    """
    low, high = (checks.number("p_range", end) for end in p_range)
    if not low < high:
        raise ValueError(f"p_range: expected low < high, got {p_range!r}")
    p = checks.number("p", p, least=low, most=high)
    start = periodic_point(family(p), x, n)
    follower = _Follower(family, n, low, high, steps or Steps(), monitor, character)
    return follower.branch(np.append(start.points[0], p), 1.0 if forward else -1.0)


@dataclass
class _State:
    """A point of the branch with all that is known there."""

    z: Array
    J: Array
    tests: dict[str, float] = field(default_factory=dict)


class _Follower:
    """Predictor, corrector, and the search for special points between two points."""

    def __init__(
        self, family: Family, n: int, low: float, high: float, steps: Steps, monitor: Monitor | None,
        character: Callable[[float, Array], object] | None,
    ) -> None:  # fmt: skip
        self.family, self.n, self.low, self.high = family, n, low, high
        self.steps, self.monitor, self.character = steps, monitor, character

    def branch(self, z: Array, direction: float) -> Branch:
        self.scale = np.append(
            np.full(len(z) - 1, max(1.0, float(np.max(np.abs(z[:-1]))))), self.high - self.low
        )
        state = self.known(z, np.append(np.zeros(len(z) - 1), direction))
        tangent = self.tangent(state, np.append(np.zeros(len(z) - 1), direction))
        states, special, ds, ended = [state], [], self.steps.first, ""
        while not ended:
            if len(states) == self.steps.points:
                ended = f"{len(states)} points computed"
                break
            found = self.step(states[-1], tangent, ds)
            if found is None:
                ds *= SHRINK
                if ds < self.steps.smallest:
                    ended = f"no point of the branch beyond p = {states[-1].z[-1]:.12g}"
                continue
            new, effort = found
            if not self.low <= new.z[-1] <= self.high:
                ended = "left the range"
            special += self.between(states[-1], tangent, ds)
            tangent = self.tangent(new, tangent)
            states.append(new)
            ds = min(self.steps.largest, ds * (GROWTH if effort <= FEW else 1.0))
        return Branch(
            p=np.array([s.z[-1] for s in states]), x=np.array([s.z[:-1] for s in states]),
            multipliers=np.array([multipliers(s.J) for s in states]), special=tuple(special), ended=ended,
        )  # fmt: skip

    def step(self, state: _State, tangent: Array, ds: float) -> tuple[_State, int] | None:
        """The point at the distance ds along the tangent, corrected; None where there is none."""
        try:
            z, effort = self.correct(state.z + ds * tangent * self.scale, tangent)
            if z is None:
                return None
            moved = float(np.linalg.norm((z - state.z) / self.scale))
            if moved > 3.0 * ds or self.differ(state.z, z):  # caught by another branch
                return None
            return self.known(z, tangent), effort
        except (ValueError, LcpStepError, np.linalg.LinAlgError):
            return None

    def differ(self, z: Array, other: Array) -> bool:
        """Whether two points are of different character, and so not of one branch."""
        if self.character is None:
            return False
        one, two = (self.character(float(y[-1]), y[:-1]) for y in (z, other))
        return one != two

    def correct(self, predicted: Array, tangent: Array) -> tuple[Array | None, int]:
        """Newton's method on F = 0 within the hyperplane through the predicted point."""
        z, before = predicted.copy(), np.inf
        for k in range(CORRECTIONS):
            F, J = self.equations(z)
            error, size = float(np.max(np.abs(F))), max(1.0, float(np.max(np.abs(z[:-1]))))
            off = float(tangent @ ((z - predicted) / self.scale))
            if error <= CONVERGED * size or (error <= STAGNATED * size and error > CONTRACTION * before):
                return z, k
            if k > 2 and error > 10.0 * before:
                return None, k
            before = error
            matrix = np.vstack([self.extended(z, J) * self.scale, tangent])
            z = z - np.linalg.solve(matrix, np.append(F, off)) * self.scale
        return None, CORRECTIONS

    def equations(self, z: Array) -> tuple[Array, Array]:
        """F and DP^n at z."""
        P = self.family(float(z[-1]))
        image, J = image_and_derivative(P, z[:-1], self.n)
        return image - z[:-1], J

    def extended(self, z: Array, J: Array) -> Array:
        """(F_x, F_p), (d, d + 1)."""
        d = PARAMETER_STEP * (self.high - self.low)
        F_p = np.zeros(len(J))
        for s, w in STENCIL:
            for side in (1.0, -1.0):
                P = self.family(float(z[-1]) + side * s * d)
                F_p += side * w * iterate(P, z[:-1], self.n)[-1] / d
        return np.column_stack([J - np.eye(len(J)), F_p])

    def tangent(self, state: _State, before: Array) -> Array:
        """Unit tangent in scaled variables, in the direction of the one before."""
        matrix = self.extended(state.z, state.J) * self.scale
        tangent = np.linalg.svd(matrix)[2][-1]
        return tangent if tangent @ before >= 0.0 else -tangent

    def known(self, z: Array, tangent: Array) -> _State:
        """The point with its derivative and test functions."""
        _, J = self.equations(z)
        one = np.eye(len(J))
        tests = {"fold": float(np.linalg.det(J - one)), "flip": float(np.linalg.det(J + one))}
        pair = [abs(m) for m in multipliers(J) if m.imag > 0.0]
        if pair:
            tests["torus"] = max(pair) - 1.0
        if self.monitor is not None:
            tests |= {f" {name}": value for name, value in self.monitor(float(z[-1]), z[:-1]).items()}
        return _State(z, J, tests)

    def between(self, state: _State, tangent: Array, ds: float) -> list[Special]:
        """Special points within a step, in their order."""
        from scipy.optimize import brentq

        end = self.step(state, tangent, ds)
        if end is None:
            return []
        found = []
        for name, value in state.tests.items():
            other = end[0].tests.get(name)
            if other is None or value * other >= 0.0:
                continue
            at: dict[float, _State] = {0.0: state, 1.0: end[0]}

            def test(s: float, name: str = name, at: dict[float, _State] = at) -> float:
                if s not in at:
                    point = self.step(state, tangent, s * ds)
                    if point is None or name not in point[0].tests:
                        raise LcpStepError("lost")
                    at[s] = point[0]
                return at[s].tests[name]

            try:
                s = brentq(test, 0.0, 1.0, xtol=ROOT, rtol=1e-15)
            except LcpStepError:  # the branch has a kink in between, sharper than the hyperplane can follow
                if not name.startswith(" "):
                    found.append(
                        (1.0, Special("jump", float(end[0].z[-1]), end[0].z[:-1], multipliers(end[0].J)))
                    )
                continue
            there = at[s]
            jumps = abs(test(s)) > SMALL * max(abs(value), abs(other))
            if jumps and name.startswith(" "):  # a monitored number that jumps does not pass zero
                continue
            kind = "jump" if jumps else name.strip()
            if kind == "fold" and self.tangent(state, tangent)[-1] * self.tangent(end[0], tangent)[-1] > 0.0:
                kind = "branch point"
            found.append((s, Special(kind, float(there.z[-1]), there.z[:-1], multipliers(there.J))))
        return [special for _, special in sorted(found, key=lambda pair: pair[0])]
