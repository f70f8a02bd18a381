"""Speeds of the forcing at which a periodic orbit is at a bifurcation: corner impact, flip, fold.

The speed omega is one more unknown beside the phases and states of the impacts; with F = 0 for the orbit,

    corner      the phase of one impact is that of the corner
    flip, fold  F_z w = 0 with mu w_1 for the first impact where it comes again, l w = 1: a deviation w from the orbit
                that is mu times as large a turn of it later, mu = -1 or 1

A zero that Krawczyk's operator proves is a regular one: the multiplier is simple and passes -1 with a speed that is
not zero; at a fold the branch turns like a parabola. All numbers of the scene stay as they are but its frequencies,
which keep their proportions. Source: Y. Kuznetsov, Elements of Applied Bifurcation Theory (Springer 2004), 10.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from flint import arb, ctx

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.corners import CornerImpact
from lcpstep.analysis.orbits import PeriodicOrbit
from lcpstep.analysis.proofs.case import Case
from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.formulas import Formulas, formulas
from lcpstep.analysis.proofs.jets import Jet
from lcpstep.analysis.proofs.newton import improved, zero
from lcpstep.analysis.proofs.obstacles import Stretch, beside
from lcpstep.analysis.proofs.orbit import MOST_BITS, impacts_of, in_place, refuse, scales, unique
from lcpstep.analysis.proofs.report import Enclosure, ProvedSpeed, down
from lcpstep.analysis.proofs.shooting import Node, Struck, closing, nodes_of
from lcpstep.errors import UnknownName

MULTIPLIER = {"flip": -1, "fold": 1}
KINDS = ("corner", *MULTIPLIER)


class Given(NamedTuple):
    """The orbit that is looked at, whatever it was found by."""

    scene: Scene | HybridScene
    phase: float
    x: Any
    time: Any
    periods: int
    name: str
    sticks: bool


def prove_speed(orbit: PeriodicOrbit | CornerImpact, kind: str = "corner", *, bits: int = 128) -> ProvedSpeed:
    """Prove the speed of the forcing, near that of an orbit, at which this is at a bifurcation.

    Parameters
    ----------
    orbit : near the speed sought, from `periodic_orbit`, `continue_orbit` or `lcpstep.analysis.corners.corner_impact`
    kind : "corner" (of the impact and the corner that are nearest to each other), "flip" or "fold"
    bits : precision of the arithmetic, 64 to a million

    Raises
    ------
    UnknownName   there is no such kind
    NotProved   the reason in words, as in `prove`
    """
    checks.instance("orbit", orbit, PeriodicOrbit, CornerImpact)
    checks.number("bits", bits, least=64, most=MOST_BITS)
    if kind not in KINDS:
        raise UnknownName("kind", kind, KINDS)
    given = _given(orbit)
    with ctx.workprec(int(bits)):
        f = formulas(given.scene)
        refuse(given)
        if len(given.time) == 0:
            raise NotProved(f"{given.name}: the motion has no impact")
        if f.written:
            raise NotProved(
                f"{given.scene.name}: how a callback changes with the speed of the forcing is not known"
            )
        guess, struck, contacts = impacts_of(given, f)
        system: AtCorner | Critical = (
            at_corner(f, struck, given.periods, guess)
            if kind == "corner"
            else Critical(f, struck, given.periods, guess, MULTIPLIER[kind])
        )
        x = improved(system.equations, system.start)
        found = zero(system.equations, x, system.scales(x), system.allowed)
        nodes, slowness = system.orbit([Jet([ball]) for ball in found.balls])
        case = Case(f, system.struck, contacts, given.periods, nodes, slowness)
        case.show()
        omega = found.balls[system.place]
        return ProvedSpeed(
            kind=kind, omega=Enclosure.of(omega), rpm=Enclosure.of(30 * omega / arb.pi()), name=given.name,
            periods=given.periods, impacts=case.impacts(), unique=unique(found, omega),
            speed_radius=down(found.radii[system.place]), bits=int(bits),
        )  # fmt: skip


def _given(orbit: PeriodicOrbit | CornerImpact) -> Given:
    if isinstance(orbit, PeriodicOrbit):
        return Given(orbit.scene, orbit.phase, orbit.x, orbit.time, orbit.periods, orbit.name, orbit.sticks)
    time = np.sort(np.append(orbit.others, orbit.time))
    name = f"O({orbit.periods}, {len(time)})"
    return Given(orbit.scene, orbit.phase, orbit.x[None], time, orbit.periods, name, False)


@dataclass(frozen=True)
class AtCorner:
    """The equations of an orbit whose impact number `which` is at the corner `theta`; omega takes its place."""

    formulas: Formulas
    struck: Sequence[Struck]
    periods: int
    guess: Sequence[arb]
    which: int
    theta: arb

    @property
    def place(self) -> int:
        """Of omega among the unknowns."""
        return self.which * (2 * self.formulas.n + 1)

    @property
    def start(self) -> list[arb]:
        """About the unknowns."""
        return [*self.guess[: self.place], self.formulas.omega.mid(), *self.guess[self.place + 1 :]]

    def orbit(self, unknowns: Sequence[Jet]) -> tuple[list[Node], Jet]:
        """Impacts, and 1/omega."""
        nodes = nodes_of(self.formulas, unknowns)
        omega, x = nodes[self.which]
        nodes[self.which] = (omega.like(self.theta), x)
        return nodes, omega.inverse()

    def equations(self, unknowns: Sequence[Jet]) -> list[Jet]:
        """What must vanish."""
        nodes, slowness = self.orbit(unknowns)
        return closing(self.formulas, self.struck, self.periods, slowness, nodes, [*nodes[1:], nodes[0]])

    def scales(self, x: Sequence[arb]) -> list[arb]:
        """What is large for each unknown."""
        found = scales(self.formulas, x, {self.place})
        found[self.place] = abs(x[self.place])
        return found

    def allowed(self, box: Sequence[arb]) -> bool:
        """Whether the formulas hold in a box."""
        phases = list(box[:: 2 * self.formulas.n + 1])
        phases[self.which] = self.theta
        return bool(box[self.place] > 0) and in_place(self.struck, self.periods, phases)


def at_corner(f: Formulas, struck: Sequence[Struck], periods: int, guess: Sequence[arb]) -> AtCorner:
    """For the impact and the corner that are nearest to each other."""
    m = 2 * f.n + 1
    found: list[tuple[float, int, arb, tuple[Stretch, ...]]] = []
    for k, s in enumerate(struck):
        phase = float(guess[k * m])
        pair = beside(s.contact.obstacle, phase)
        if pair is not None and pair[0].end is not None:
            found.append((abs(float(pair[0].end) - phase), k, pair[0].end, pair))
    if not found:
        raise NotProved("the obstacle has no corners")
    _, which, theta, sides = min(found, key=lambda x: x[0])
    impacts = [Struck(s.contact, sides) if k == which else s for k, s in enumerate(struck)]
    return AtCorner(f, impacts, periods, guess, which, theta)


@dataclass(frozen=True)
class Critical:
    """The equations of an orbit with the multiplier mu; unknown are the impacts, omega, and a deviation w."""

    formulas: Formulas
    struck: Sequence[Struck]
    periods: int
    guess: Sequence[arb]
    mu: int

    @property
    def place(self) -> int:
        """Of omega among the unknowns."""
        return len(self.guess)

    @cached_property
    def start(self) -> list[arb]:
        """About the unknowns."""
        return [*self.guess, self.formulas.omega.mid(), *(arb(float(x)) for x in self.deviation)]

    @cached_property
    def deviation(self) -> Any:
        """About the deviation w, of length one."""
        n = self.place
        point = [Jet([x]) for x in [*self.guess, self.formulas.omega.mid()]]
        columns = []
        for j in range(n):
            w = [Jet([int(i == j)]) for i in range(n)]
            columns.append([float(y.c[1]) for y in self.deviated(point, w)])
        return np.linalg.svd(np.array(columns).T)[2][-1]

    def orbit(self, unknowns: Sequence[Jet]) -> tuple[list[Node], Jet]:
        """Impacts, and 1/omega."""
        return nodes_of(self.formulas, unknowns[: self.place]), unknowns[self.place].inverse()

    def deviated(self, unknowns: Sequence[Jet], w: Sequence[Jet]) -> list[Jet]:
        """F, with one generator more that bears its derivative along w."""
        turned = [x if k > 2 * self.formulas.n else x * self.mu for k, x in enumerate(w)]
        z = unknowns[: self.place]
        nodes, ends = (
            nodes_of(self.formulas, [Jet([*a.c, *b.c]) for a, b in zip(z, d, strict=True)])
            for d in (w, turned)
        )
        slowness = unknowns[self.place].inverse()
        wider = Jet([*slowness.c, *([0] * len(slowness.c))])
        return closing(self.formulas, self.struck, self.periods, wider, nodes, [*ends[1:], ends[0]])

    def equations(self, unknowns: Sequence[Jet]) -> list[Jet]:
        """What must vanish."""
        w = unknowns[self.place + 1 :]
        found = self.deviated(unknowns, w)
        half = len(unknowns[0].c)
        length = sum(
            (x * arb(float(y)) for x, y in zip(w, self.deviation, strict=True)), unknowns[0].like(-1)
        )
        return [*(Jet(y.c[:half]) for y in found), *(Jet(y.c[half:]) for y in found), length]

    def scales(self, x: Sequence[arb]) -> list[arb]:
        """What is large for each unknown."""
        n = self.place
        return [*scales(self.formulas, x[:n]), abs(x[n]), *([arb(1)] * n)]

    def allowed(self, box: Sequence[arb]) -> bool:
        """Whether the formulas hold in a box."""
        phases = box[: self.place : 2 * self.formulas.n + 1]
        return bool(box[self.place] > 0) and in_place(self.struck, self.periods, phases)
