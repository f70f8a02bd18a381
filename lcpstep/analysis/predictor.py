"""Following a branch: predictor along the tangent, corrector in the hyperplane across it.

    F(x, p) = P_p^n(x) - x = 0,      tau . (z - z_predicted) = 0,      z = (x, p)

Source: Yu. Kuznetsov, Elements of Applied Bifurcation Theory (Springer 2004), sections 10.2-10.3.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.branch import Branch, Special, State, Steps
from lcpstep.analysis.derivative import STENCIL
from lcpstep.analysis.fixed_points import image_and_derivative, multipliers
from lcpstep.analysis.special_points import between
from lcpstep.errors import LcpStepError
from lcpstep.maps.iteration import Map, iterate

Array = NDArray[np.float64]
Family = Callable[[float], Map]
Monitor = Callable[[float, Array], Mapping[str, float]]
Progress = Callable[[float, Array, NDArray[np.complex128]], None]
CORRECTIONS = 12  # Newton iterations of a point on the branch
CONVERGED = 1e-11  # residual, relative to the size of the point
CONTRACTION = 0.5  # a residual that shrinks by less than this is at its rounding, or will not converge
STAGNATED = 1e-8
INTERRUPTED = "interrupted"  # why a branch ended
CLOSED = "back where it began: the branch is closed"
SAME = 1e-6  # distance of two points that are one, in units of steps
SOON = 3  # corrections after which dF/dp is computed anew
FEW = 4  # corrections after which the step may grow
GROWTH, SHRINK = 1.4, 0.5
PARAMETER_STEP = 1e-5  # of the range, for the derivative by the parameter
NEAREST = 1e-9  # the same near grazing, where longer differences see other motions
SPOILT = 10.0  # of such steps: a motion of another kind within that spoils it


class Follower:
    """Predictor, corrector, and the end of the branch."""

    def __init__(
        self, family: Family, n: int, low: float, high: float, steps: Steps, monitor: Monitor | None,
        character: Callable[[float, Array], object] | None, progress: Progress | None,
    ) -> None:  # fmt: skip
        self.family, self.n, self.low, self.high = family, n, low, high
        self.steps, self.monitor, self.character, self.beside = steps, monitor, character, PARAMETER_STEP
        self.largest = 0.0  # of the points so far: what states are measured by
        self.progress = progress

    def branch(self, z: Array, direction: float) -> Branch:
        """The branch from the point z on, at first in this direction of the parameter."""
        ahead = np.append(np.zeros(len(z) - 1), direction)
        states, special, ds, ended = [self.started(z)], list[Special](), self.steps.first, ""
        tangent = self.tangent(states[0], ahead)
        self.tell(states[0])
        try:
            while not ended:
                if len(states) == self.steps.points:
                    ended = f"{len(states)} points computed"
                    break
                found = self.step(states[-1], tangent, ds)
                if found is None:
                    ds, self.beside = ds * SHRINK, max(self.beside * SHRINK**3, NEAREST)
                    if ds < self.steps.smallest:
                        ended = f"no point of the branch beyond p = {states[-1].z[-1]:.12g}"
                    continue
                new, effort = found
                if not self.low <= new.z[-1] <= self.high:
                    new, ended = self.at_the_end(states[-1], new), "left the range"
                if new is states[-1]:
                    break
                if not ended and self.passes(states, tangent, new):
                    new, ended = states[0], CLOSED
                reached = float(tangent @ ((new.z - states[-1].z) / self.scale))
                found_between = between(self, states[-1], new, tangent, reached)
                special += [s._replace(after=len(states) - 1) for s in found_between]
                states.append(new)
                self.tell(new)
                ahead = tangent * self.scale
                self.measure(new.z)
                new.slope = self.slope(new.z)
                tangent = self.tangent(new, ahead / self.scale)
                growth = GROWTH if effort <= FEW else 1.0
                ds, self.beside = (
                    min(self.steps.largest, ds * growth),
                    min(PARAMETER_STEP, self.beside * growth),
                )
        except KeyboardInterrupt:
            ended = INTERRUPTED
        return Branch(
            p=np.array([s.z[-1] for s in states]), x=np.array([s.z[:-1] for s in states]),
            multipliers=np.array([multipliers(s.J) for s in states]), special=tuple(special), ended=ended,
        )  # fmt: skip

    def tell(self, state: State) -> None:
        """Report a point that was found."""
        if self.progress is not None:
            self.progress(float(state.z[-1]), state.z[:-1], multipliers(state.J))

    def started(self, z: Array) -> State:
        """The first point."""
        self.measure(z)
        return self.with_tests(State(z, self.equations(z)[1], self.slope(z)))

    def size(self, z: Array) -> float:
        """Of the states of the branch up to the point z; one where all of them are zero."""
        self.largest = max(self.largest, float(np.max(np.abs(z[:-1]))))
        return self.largest or 1.0

    def measure(self, z: Array) -> None:
        """The units in which steps from z are counted."""
        size = self.size(z)
        self.scale = np.append(np.full(len(z) - 1, size), self.high - self.low)

    def passes(self, states: list[State], tangent: Array, new: State) -> bool:
        """Whether the step to a new point goes through the first one, as on a branch that is closed."""
        first, last = states[0], states[-1]
        back, step = ((z - last.z) / self.scale for z in (first.z, new.z))
        ahead = float(tangent @ back)
        if (
            len(states) < 3
            or not 0.0 < ahead <= float(tangent @ step)
            or np.linalg.norm(back) > 2.0 * np.linalg.norm(step)
        ):
            return False
        found = self.step(last, tangent, ahead)  # the branch at the height of the first point
        return found is not None and float(np.linalg.norm((found[0].z - first.z) / self.scale)) <= SAME

    def at_the_end(self, state: State, outside: State) -> State:
        """The point of the branch at the end of the range, between two points; the former where it is lost."""
        end = self.low if outside.z[-1] < self.low else self.high
        share = (end - state.z[-1]) / (outside.z[-1] - state.z[-1])
        fixed = np.append(np.zeros(len(state.z) - 1), 1.0)  # Newton's method at this parameter
        predicted = state.z + share * (outside.z - state.z)
        predicted[-1] = end
        try:
            found, _ = self.correct(predicted, fixed)
        except (ValueError, LcpStepError):
            return state
        if found is None or self.differ(state.z, found.z):
            return state
        found.z[-1] = end
        return self.with_tests(found)

    def step(self, state: State, tangent: Array, ds: float) -> tuple[State, int] | None:
        """The point at the distance ds along the tangent, corrected; None where there is none."""
        try:
            found, effort = self.correct(state.z + ds * tangent * self.scale, tangent)
            if found is None:
                return None
            moved = float(np.linalg.norm((found.z - state.z) / self.scale))
            if moved > 3.0 * abs(ds) or self.differ(state.z, found.z):  # caught by another branch
                return None
            return self.with_tests(found), effort
        except (ValueError, LcpStepError):
            return None

    def differ(self, z: Array, other: Array) -> bool:
        """Whether two points are of different character, and so not of one branch."""
        if self.character is None:
            return False
        one, two = (self.character(float(y[-1]), y[:-1]) for y in (z, other))
        return one != two

    def correct(self, predicted: Array, tangent: Array) -> tuple[State | None, int]:
        """Newton's method on F = 0 within the hyperplane through the predicted point.

        dF/dp costs most, and is that of the predicted point unless that does not converge soon.
        """
        z, before, slope = predicted.copy(), np.inf, None
        for k in range(CORRECTIONS):
            F, J = self.equations(z)
            if slope is None or k >= SOON:
                slope = self.slope(z)
            error, size = float(np.max(np.abs(F))), max(self.size(predicted), float(np.max(np.abs(z[:-1]))))
            off = float(tangent @ ((z - predicted) / self.scale))
            if error <= CONVERGED * size or (error <= STAGNATED * size and error > CONTRACTION * before):
                return State(z, J, slope), k
            if k > 2 and error > 10.0 * before:
                return None, k
            before = error
            matrix = np.vstack([extended(J, slope) * self.scale, tangent])
            z = z - np.linalg.solve(matrix, np.append(F, off)) * self.scale
        return None, CORRECTIONS

    def equations(self, z: Array) -> tuple[Array, Array]:
        """F and DP^n at z."""
        image, J = image_and_derivative(self.family(float(z[-1])), z[:-1], self.n, self.size(z))
        if not np.all(np.isfinite(J)):  # as where a contact is grazed to the last digit
            raise LcpStepError(f"the map has no derivative at {z[:-1].tolist()}")
        return image - z[:-1], J

    def slope(self, z: Array) -> Array:
        """dF/dp at z, (d,)."""
        d = self.beside * (self.high - self.low)
        total = np.zeros(len(z) - 1)
        for s, w in STENCIL:
            for side in (1.0, -1.0):
                P = self.family(float(z[-1]) + side * s * d)
                total += side * w * iterate(P, z[:-1], self.n)[-1] / d
        return total

    def tangent(self, state: State, before: Array) -> Array:
        """Unit tangent in scaled variables, in the direction of the one before."""
        tangent = np.linalg.svd(extended(state.J, state.slope) * self.scale)[2][-1]
        return np.asarray(tangent if tangent @ before >= 0.0 else -tangent)

    def with_tests(self, state: State) -> State:
        """The point with its test functions."""
        J, one = state.J, np.eye(len(state.J))
        state.tests = {"fold": float(np.linalg.det(J - one)), "flip": float(np.linalg.det(J + one))}
        pair = [abs(m) for m in multipliers(J) if m.imag > 0.0]
        if pair:
            state.tests["torus"] = max(pair) - 1.0
        if self.monitor is not None:
            watched = self.monitor(float(state.z[-1]), state.z[:-1])
            state.tests |= {f" {name}": value for name, value in watched.items()}
        return state


def extended(J: Array, slope: Array) -> Array:
    """(F_x, F_p), (d, d + 1)."""
    return np.column_stack([J - np.eye(len(J)), slope])
