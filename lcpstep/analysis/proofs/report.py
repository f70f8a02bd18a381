"""What a proof says: enclosures that can be printed, and sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, ctx

from lcpstep.analysis.proofs.obstacles import above, below

DIGITS, SPARE = 30, 8  # printed at most, unless the precision has more than these and some to spare


@dataclass(frozen=True)
class Enclosure:
    """A number that is proved to lie in [lower, upper]; `text` has the digits that are certain, and the radius."""

    lower: float
    upper: float
    text: str

    @classmethod
    def of(cls, x: arb) -> Enclosure:
        """From a ball, rounded outwards."""
        return cls(below(x), above(x), x.str(max(DIGITS, ctx.dps - SPARE)))

    def __contains__(self, x: Any) -> bool:
        return bool(self.lower <= x <= self.upper)

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class ProvedImpact:
    """An impact.

    time : t within the n periods from the section on [s];  before, after : gap velocities, the first negative [m/s]
    """

    time: Enclosure
    contact: int
    before: Enclosure
    after: Enclosure


@dataclass(frozen=True)
class Unique:
    """How far there is no other orbit: of times of impacts [s], positions [m], and velocities after them [m/s].

    Infinite for a motion without impacts: there is no other one.
    """

    time: float
    position: float
    velocity: float


@dataclass(frozen=True)
class Proof:
    """A periodic orbit that is proved to exist.

    Attributes
    ----------
    name : O(n, m);  periods : n, the least number of periods after which it repeats
    period : of the forcing [s]
    x : (n, 2 n_q) states (q, v) on the section
    impacts : in the order of time; between them no gap is zero
    multipliers : moduli, the largest first
    stability : "stable", "unstable", or "not decided" where a modulus may be one
    unique : there is no other orbit with such impacts within these distances of it
    bits : precision of the arithmetic
    """

    name: str
    periods: int
    period: Enclosure
    x: tuple[tuple[Enclosure, ...], ...]
    impacts: tuple[ProvedImpact, ...]
    multipliers: tuple[Enclosure, ...]
    stability: str
    unique: Unique
    bits: int

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        yield f"proved: {self.name} exists, and touches nothing between its impacts; {self.stability}"
        yield f"period of the forcing: {self.period} s"
        yield from _impact_lines(self.impacts)
        yield from (f"modulus of a multiplier: {m}" for m in self.multipliers)
        yield _unique_line(self.unique)


@dataclass(frozen=True)
class ProvedSpeed:
    """A speed of the forcing at which a periodic orbit is at a bifurcation, proved.

    Attributes
    ----------
    kind : "corner", "flip" or "fold"
    omega, rpm : turns of the scene's period, in rad/s and per minute
    name, periods, impacts, unique, bits : of the orbit there, as in `Proof`
    speed_radius : there is no other such speed within this distance, near this orbit [rad/s]
    """

    kind: str
    omega: Enclosure
    rpm: Enclosure
    name: str
    periods: int
    impacts: tuple[ProvedImpact, ...]
    unique: Unique
    speed_radius: float
    bits: int

    def __str__(self) -> str:
        return "\n".join(self._lines())

    def _lines(self) -> Iterator[str]:
        yield f"proved: {self.kind} of {self.name} at {self.rpm} turns of the forcing per minute"
        yield f"omega: {self.omega} rad/s, the only one within {self.speed_radius:.2g} rad/s"
        yield from _impact_lines(self.impacts)
        yield _unique_line(self.unique)


def verdict(moduli: Sequence[Enclosure]) -> str:
    """Whether an orbit with these moduli of multipliers is stable."""
    if all(m.upper < 1.0 for m in moduli):
        return "stable"
    return "unstable" if any(m.lower > 1.0 for m in moduli) else "not decided"


def _impact_lines(impacts: tuple[ProvedImpact, ...]) -> Iterator[str]:
    for impact in impacts:
        yield f"impact of contact {impact.contact} at t = {impact.time} s"
        yield f"    gap velocity {impact.before} -> {impact.after} m/s"


def _unique_line(unique: Unique) -> str:
    if math.isinf(unique.time):
        return "no other without impacts"
    size = f"{unique.time:.2g} s, {unique.position:.2g} m and {unique.velocity:.2g} m/s"
    return f"no other with such impacts within {size} of these"


def down(x: arb) -> float:
    """A radius as a float that is not larger."""
    return max(0.0, below(x)) if x.is_finite() else math.nan
