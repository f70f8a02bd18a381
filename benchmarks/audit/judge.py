"""A block on a belt with a jerk by another way than the library's: closed forms between looks at a fixed grid.

While it slides the block oscillates about a place that friction shifts, or is under constant force; while it sticks
it goes with the belt, by Gauss' quadrature. The grid has GRID points in the span and JERK of them in each jerk; a
change between sticking and sliding is found between two points by Brent's method.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
GRID, JERK, REACH = 4000, 3000, 6.0  # REACH: half-widths of a Gaussian
PARTS, SHORTEST = 16, 1e-11  # of an interval in which more happens than its ends show
MOST = 100_000  # rounds; the largest grid takes some 22,000
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True)
class Belt:
    """Velocity p[3] + p[4] sin(p[5] t) with jerks of size p[0] and half-width p[1] about p[2] in every p[6]."""

    p: Any
    gaussian: bool

    def without_jerk(self) -> Belt:
        """The belt that runs on."""
        return replace(self, p=np.array([0.0, *self.p[1:]]))

    def velocity(self, t: Any) -> Any:
        """At times t."""
        p, s = self.p, self._place(t)
        jerk = np.exp(-s * s) if self.gaussian else np.maximum(1.0 - s * s, 0.0) ** 3
        return p[3] + p[4] * np.sin(p[5] * t) + p[0] * jerk

    def acceleration(self, t: Any) -> Any:
        """At times t."""
        p, s = self.p, self._place(t)
        jerk = -2.0 * s * np.exp(-s * s) if self.gaussian else -6.0 * s * np.maximum(1.0 - s * s, 0.0) ** 2
        return p[4] * p[5] * np.cos(p[5] * t) + p[0] / p[1] * jerk

    def _place(self, t: Any) -> Any:
        p = self.p
        if self.gaussian:
            return p[6] / (np.pi * p[1]) * np.sin(np.pi * (t - p[2]) / p[6])
        return (t - p[6] * np.floor(t / p[6]) - p[2]) / p[1]

    def grid(self, span: float) -> Array:
        """Times at which it is looked at."""
        p, parts = self.p, [np.linspace(0.0, span, GRID)]
        reach = REACH * p[1] if self.gaussian else p[1]
        for k in range(-1, math.ceil(span / p[6]) + 1):
            parts.append(k * p[6] + p[2] + reach * np.linspace(-1.0, 1.0, JERK))
        times = np.unique(np.concatenate(parts))
        return times[(times >= 0.0) & (times <= span)]

    def way(self, a: float, b: float) -> float:
        """How far it goes from a to b, which are near each other."""
        half = 0.5 * (b - a)
        return float(half * (WEIGHTS @ self.velocity(0.5 * (a + b) + half * NODES)))


def slide(q: float, v: float, push: float, stiffness: float, tau: float) -> tuple[float, float]:
    """Place and velocity after tau under a constant force and a spring, of 1 kg."""
    if stiffness == 0.0:
        return q + tau * (v + 0.5 * tau * push), v + tau * push
    w, rest = math.sqrt(stiffness), push / stiffness
    c, s = math.cos(w * tau), math.sin(w * tau)
    return rest + (q - rest) * c + v * s / w, v * c - (q - rest) * w * s


def follow(belt: Belt, friction: float, stiffness: float, v0: float, span: float) -> tuple[float, float]:
    """Place and velocity at the end of the span, of a block that begins at 0 with velocity v0."""
    times = belt.grid(span)
    t, q, v, k = 0.0, 0.0, v0, 1
    mode = 0.0 if v0 == float(belt.velocity(0.0)) else math.copysign(1.0, v0 - float(belt.velocity(0.0)))
    for _ in range(MOST):
        if k >= len(times):
            return q, v
        if mode == 0.0:
            mode = leaves(belt, friction, stiffness, t, q)
        step, before = stick if mode == 0.0 else rub, (t, q, v)
        t, q, v, changed = step(belt, friction, stiffness, t, q, v, mode, float(times[k]))
        if not changed and mode * (v - float(belt.velocity(t))) < 0.0:  # it has slid and come back in between
            if t - before[0] > SHORTEST:
                times = np.insert(times, k, np.linspace(before[0], t, PARTS + 1)[1:-1])
                t, q, v = before
                continue
            mode = -mode
        if changed:
            mode = leaves(belt, friction, stiffness, t, q, decided=mode == 0.0)
        while k < len(times) and times[k] <= t:
            k += 1
    raise RuntimeError("sticking and sliding follow each other without end, to rounding")


def leaves(belt: Belt, friction: float, stiffness: float, t: float, q: float, decided: bool = False) -> float:
    """Where it slides to from sticking: 0 where friction holds it.

    decided : it has just been found that friction does not
    """
    need = float(belt.acceleration(t)) + stiffness * q  # what friction must give
    if abs(need) < friction and not decided:
        return 0.0
    return -math.copysign(1.0, need)


def stick(
    belt: Belt, friction: float, stiffness: float, t: float, q: float, v: float, mode: float, end: float
) -> tuple[float, float, float, bool]:
    """With the belt up to `end`, or to where friction no longer holds it."""

    def excess(x: float) -> float:
        return abs(float(belt.acceleration(x)) + stiffness * (q + belt.way(t, x))) - friction

    changed = excess(end) > 0.0
    if changed and excess(t) < 0.0:
        end = first(excess, t, end)
    elif changed:
        end = t
    return end, q + belt.way(t, end), float(belt.velocity(end)), changed


def rub(
    belt: Belt, friction: float, stiffness: float, t: float, q: float, v: float, mode: float, end: float
) -> tuple[float, float, float, bool]:
    """Sliding up to `end`, or to where the belt has its velocity."""
    push = -mode * friction

    def left(x: float) -> float:
        return mode * (slide(q, v, push, stiffness, x - t)[1] - float(belt.velocity(x)))

    changed = left(end) <= 0.0 and left(t) > 0.0
    if changed:
        end = first(left, t, end)
    q, v = slide(q, v, push, stiffness, end - t)
    return end, q, v, changed


def first(f: Callable[[float], float], a: float, b: float) -> float:
    """The zero between a and b."""
    return float(brentq(f, a, b, xtol=1e-15, rtol=1e-15))
