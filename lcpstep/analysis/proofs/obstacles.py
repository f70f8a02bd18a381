"""Obstacles as formulas of the phase: at rest, harmonic, a turning cam of circular arcs.

The phase theta = omega t runs through 2 pi while the scene's forcing repeats once. Each formula is written once, and
is fed with power series in balls: their coefficients are the derivatives, over an interval where the ball is one.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from flint import arb, arb_series

from lagrangian.profiles import HEAD

Formula = Callable[[arb_series], Any]
TWO_PI = 2.0 * math.pi


@dataclass(frozen=True)
class Stretch:
    """Phases between which an obstacle is given by one formula; None: without end."""

    start: arb | None
    end: arb | None
    formula: Formula

    def holds(self, phase: arb) -> bool:
        """Whether all phases of a ball lie inside, off the corners at the ends."""
        after = self.start is None or bool(phase > self.start)
        return after and (self.end is None or bool(phase < self.end))


class Obstacle(Protocol):
    """Height of an obstacle over the phase."""

    def corners(self, phase: float) -> list[arb]:
        """Ends of stretches around a phase, at least one on either side of it; empty where there are none."""

    def formula(self, phase: float) -> Formula:
        """The formula of the stretch that a phase lies in."""


@dataclass(frozen=True)
class Harmonic:
    """amplitude sin(multiple theta + lead)."""

    amplitude: arb
    multiple: int
    lead: arb

    def corners(self, phase: float) -> list[arb]:
        """None."""
        return []

    def formula(self, phase: float) -> Formula:
        """The same everywhere."""
        return lambda theta: self.amplitude * (self.multiple * theta + self.lead).sin()


@dataclass(frozen=True)
class Sum:
    """height + sum of factor times obstacle; a wall where there are none."""

    height: arb
    parts: tuple[tuple[arb, Obstacle], ...] = ()

    def corners(self, phase: float) -> list[arb]:
        """Those of all parts."""
        return sorted((c for _, part in self.parts for c in part.corners(phase)), key=float)

    def formula(self, phase: float) -> Formula:
        """The sum of their formulas."""
        terms = [(factor, part.formula(phase)) for factor, part in self.parts]
        return lambda theta: sum((factor * f(theta) for factor, f in terms), self.height + 0 * theta)


@dataclass(frozen=True)
class Cam:
    """Lift of a cam of arcs at the angle multiple theta + lead; see `lagrangian.profiles`.

    arcs : (end, kappa, psi, rho) in order;  symmetric : the second half of the turn mirrors the first
    """

    multiple: int
    lead: arb
    offset: arb
    symmetric: bool
    arcs: tuple[tuple[float, float, float, float], ...]

    def corners(self, phase: float) -> list[arb]:
        """Where arcs meet, and where a symmetric cam is folded unless it is a dwell, over three of its turns."""
        angles = [arb(arc[0]) for arc in self.arcs[:-1]]
        if self.symmetric:
            angles += [2 * arb.pi() - angle for angle in angles]
            angles += [arb.pi() * k for k, arc in enumerate((self.arcs[0], self.arcs[-1])) if arc[1] != 0.0]
        else:
            angles.append(arb(0))
        turn = self._turn(phase)
        found = [
            (angle + 2 * arb.pi() * (turn + k) - self.lead) / self.multiple
            for angle in angles
            for k in (-1, 0, 1)
        ]
        return sorted(found, key=float)

    def formula(self, phase: float) -> Formula:
        """That of the arc under the follower."""
        turn = self._turn(phase)
        angle = self.multiple * phase + float(self.lead) - TWO_PI * turn
        mirrored = self.symmetric and angle > math.pi
        ends = [arc[0] for arc in self.arcs[:-1]]
        _, kappa, psi, rho = self.arcs[bisect_right(ends, TWO_PI - angle if mirrored else angle)]

        def height(theta: arb_series) -> Any:
            beta = self.multiple * theta + (self.lead - 2 * arb.pi() * turn)
            beta = 2 * arb.pi() - beta if mirrored else beta
            if kappa == 0.0:
                return arb(rho) - self.offset + 0 * beta
            sine, cosine = (beta - psi).sin_cos()
            b = kappa * sine
            return kappa * cosine + (arb(rho) ** 2 - b * b).sqrt() - self.offset

        return height

    def _turn(self, phase: float) -> int:
        return math.floor((self.multiple * phase + float(self.lead)) / TWO_PI)


def turning_cam(p: Sequence[float], multiple: int) -> Cam:
    """From the parameters of `lagrangian.profiles.rotating_cam`, see `CamProfile.pack`."""
    numbers = [float(x) for x in p[HEAD : HEAD + 4 * int(p[4])]]
    arcs = tuple(
        (numbers[k], numbers[k + 1], numbers[k + 2], numbers[k + 3]) for k in range(0, len(numbers), 4)
    )
    return Cam(multiple, arb(float(p[1])), arb(float(p[2])), bool(p[3] < 4.0), arcs)


def stretch(obstacle: Obstacle, phase: float) -> Stretch:
    """The stretch that a phase lies in; from a corner on it is the one that begins there."""
    corners = obstacle.corners(phase)
    if not corners:
        return Stretch(None, None, obstacle.formula(phase))
    k = bisect_right([float(c) for c in corners], phase)
    start, end = corners[k - 1], corners[k]
    return Stretch(start, end, obstacle.formula(0.5 * (float(start) + float(end))))


def stretches(obstacle: Obstacle, start: float, end: float) -> list[Stretch]:
    """Those between two phases, in order."""
    found = [stretch(obstacle, start)]
    while found[-1].end is not None and float(found[-1].end) < end:
        found.append(stretch(obstacle, float(found[-1].end)))
    return found


def beside(obstacle: Obstacle, phase: float) -> tuple[Stretch, Stretch] | None:
    """The stretches that meet at the corner nearest to a phase; None where the obstacle has no corners."""
    here = stretch(obstacle, phase)
    if here.start is None or here.end is None:
        return None
    if phase - float(here.start) < float(here.end) - phase:
        return stretch(obstacle, math.nextafter(float(here.start), -math.inf)), here
    return here, stretch(obstacle, float(here.end))


def covering(stretch: Stretch, start: float, end: float) -> tuple[float, float]:
    """The part of a stretch between two phases, rounded outwards."""
    low = start if stretch.start is None else max(start, below(stretch.start))
    high = end if stretch.end is None else min(end, above(stretch.end))
    return low, high


def below(x: arb) -> float:
    """A float not above any number of a ball."""
    y = float(x.lower())
    return y if bool(arb(y) <= x) else math.nextafter(y, -math.inf)


def above(x: arb) -> float:
    """A float not below any number of a ball."""
    return -below(-x)
