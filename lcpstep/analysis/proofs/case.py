"""An orbit whose impacts are enclosed: what else must be shown of it, and what can be said.

Impacts have a speed, flights touch nothing, it does not repeat earlier; its multipliers are the eigenvalues of the
product of flows and saltation matrices, see `lcpstep.analysis.variation`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from flint import acb_mat, arb, arb_mat

from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.flights import Flight
from lcpstep.analysis.proofs.formulas import Formulas
from lcpstep.analysis.proofs.jets import Jet
from lcpstep.analysis.proofs.obstacles import stretch
from lcpstep.analysis.proofs.report import Enclosure, ProvedImpact
from lcpstep.analysis.proofs.shooting import Node, Struck, flown, forcing, rebound


@dataclass(frozen=True)
class Case:
    """An orbit whose impacts are enclosed: what else has to be shown of it, and what can be said."""

    formulas: Formulas
    struck: Sequence[Struck]
    contacts: Sequence[int]
    periods: int
    nodes: Sequence[Node]
    slowness: Jet

    def show(self) -> None:
        """NotProved unless it is an orbit, with gaps open between its impacts, that does not repeat earlier."""
        for k in range(len(self.nodes)):
            before, after = self.rates(k)
            if not (before < 0 and after > 0):
                raise NotProved(f"grazing: impact {k} is not shown to have a speed")
        for k in range(len(self.nodes)):
            self.flight(k).show_clear()
        self._show_least()

    @property
    def A(self) -> arb_mat:
        """Of dz/dtheta = A z."""
        s = self.slowness.c[0]
        return self.formulas.A0 + s * self.formulas.A1 + s * s * self.formulas.A2

    def end(self, k: int) -> arb:
        """The phase at which flight k ends."""
        last = k + 1 == len(self.nodes)
        return self.nodes[0][0].c[0] + 2 * self.periods * arb.pi() if last else self.nodes[k + 1][0].c[0]

    def flight(self, k: int) -> Flight:
        """The flight after impact k."""
        theta, x = self.nodes[k]
        z = [*(y.c[0] for y in x), *(y.c[0] for y in forcing(self.formulas, theta))]
        following = self.contacts[(k + 1) % len(self.nodes)]
        return Flight(
            self.formulas, self.A, theta.c[0], arb_mat(len(z), 1, z), self.end(k), self.contacts[k], following
        )  # fmt: skip

    def arrival(self, k: int) -> list[Jet]:
        """The state (y, w) just before impact k."""
        k = (k - 1) % len(self.nodes)
        return flown(self.formulas, self.slowness, self.nodes[k], Jet([self.end(k)]))

    def rates(self, k: int) -> tuple[arb, arb]:
        """The rates of the gap before and after impact k, by the phase."""
        s = self.struck[k]
        before = rebound(self.formulas, s, self.nodes[k][0], self.arrival(k))[1].c[0]
        return before, -s.contact.restitution * before

    def _show_least(self) -> None:
        """NotProved where it may be that the orbit repeats after fewer periods."""
        n, m = self.periods, len(self.nodes)
        for d in (d for d in range(1, n) if n % d == 0 and m % (n // d) == 0):
            ahead = m * d // n
            others = [self._turned(k + ahead, d) for k in range(m)]
            if not any(_apart(self.nodes[k], other) for k, other in enumerate(others)):
                raise NotProved(
                    f"the orbit repeats after {d} of these {n} periods already, or it is not shown that it does not"
                )

    def _turned(self, k: int, d: int) -> Node:
        """Impact k, d periods earlier."""
        turns, at = divmod(k, len(self.nodes))
        theta, x = self.nodes[at]
        return theta + 2 * (turns * self.periods - d) * arb.pi(), x

    def impacts(self) -> tuple[ProvedImpact, ...]:
        """As they are reported."""
        found = []
        omega = 1 / self.slowness.c[0]
        for k, (theta, _) in enumerate(self.nodes):
            before, after = self.rates(k)
            time = theta.c[0] / omega
            found.append(
                ProvedImpact(
                    Enclosure.of(time),
                    self.contacts[k],
                    Enclosure.of(before * omega),
                    Enclosure.of(after * omega),
                )
            )
        return tuple(found)

    def section(self, phase: arb) -> tuple[Enclosure, ...]:
        """The state (q, v) at a phase; NotProved where an impact may lie on it."""
        theta, x = self.nodes[-1]
        starts = [(theta - 2 * self.periods * arb.pi(), x), *self.nodes]
        ends = [self.nodes[0][0].c[0], *(self.end(k) for k in range(len(self.nodes)))]
        for start, end in zip(starts, ends, strict=True):
            if start[0].c[0] < phase < end:
                state = flown(self.formulas, self.slowness, start, Jet([phase]))
                return given_state(self.formulas, self.slowness, phase, state)
        raise NotProved("an impact lies on the section: see lcpstep.analysis.orbits.moved for another one")

    def multipliers(self) -> tuple[Enclosure, ...]:
        """Their moduli, the largest first."""
        return moduli(self.monodromy())

    def monodromy(self) -> arb_mat:
        """The derivative of n periods by (y, w), just after the first impact: flows and saltation matrices."""
        n2 = 2 * self.formulas.n
        D = arb_mat(n2, n2, [int(i == j) for i in range(n2) for j in range(n2)])
        for k in range(len(self.nodes)):
            E = ((self.end(k) - self.nodes[k][0].c[0]) * self.A).exp()
            flow = arb_mat([[E[i, j] for j in range(n2)] for i in range(n2)])
            D = self._saltation((k + 1) % len(self.nodes)) * flow * D
        return D

    def _saltation(self, k: int) -> arb_mat:
        """R_x + (F+ - R_x F- - R_theta) H_x / u-, see `lcpstep.analysis.variation`."""
        f, s = self.formulas, self.struck[k]
        n, c, (theta, after) = f.n, s.contact, self.nodes[k]
        before = self.arrival(k)
        u = self.rates(k)[0]
        curve = [*s.stretches[0].formula(theta.series(2)).coeffs(), arb(0), arb(0), arb(0)][2] * 2
        R = arb_mat(2 * n, 2 * n, [int(i == j) for i in range(2 * n) for j in range(2 * n)])
        for i in range(n):
            for j in range(n):
                R[n + i, n + j] -= (1 + c.restitution) * c.lever[i] * c.G[j]
        early, late = (self._field(theta, x) for x in (before, after))
        bent = arb_mat(2 * n, 1, [0] * n + [(1 + c.restitution) * curve * lever for lever in c.lever])
        surplus = (late - R * early - bent) * (1 / u)
        return R + surplus * arb_mat(1, 2 * n, [*c.G, *([0] * n)])

    def _field(self, theta: Jet, x: Sequence[Jet]) -> arb_mat:
        """d(y, w)/dtheta."""
        z = [*(y.c[0] for y in x), *(y.c[0] for y in forcing(self.formulas, theta))]
        whole = self.A * arb_mat(len(z), 1, z)
        return arb_mat(len(x), 1, [whole[i, 0] for i in range(len(x))])


def _apart(one: Node, other: Node) -> bool:
    """Whether two impacts are shown to be different ones."""
    pairs = [(one[0], other[0]), *zip(one[1], other[1], strict=True)]
    return not all(a.c[0].overlaps(b.c[0]) for a, b in pairs)


def moduli(D: arb_mat) -> tuple[Enclosure, ...]:
    """Those of the eigenvalues, the largest first; infinite enclosures where these could not be told apart."""
    found = acb_mat(D).eig(multiple=True, nonstop=True)
    balls = [arb(x.abs_lower()).union(arb(x.abs_upper())) for x in found]
    if not all(x.is_finite() for x in balls):
        return tuple(Enclosure(0.0, math.inf, "not enclosed") for _ in found)
    return tuple(Enclosure.of(x) for x in sorted(balls, key=float, reverse=True))


def given_state(f: Formulas, slowness: Jet, phase: arb, state: Sequence[Jet]) -> tuple[Enclosure, ...]:
    """(q, v) from (y, w)."""
    y = [z.c[0] for z in state]
    lift, slope = frame_at(f, Jet([phase]))
    omega = 1 / slowness.c[0]
    q = [z - c for z, c in zip(y[: f.n], lift, strict=True)]
    v = [(z - c) * omega for z, c in zip(y[f.n :], slope, strict=True)]
    return tuple(Enclosure.of(z) for z in q + v)


def frame_at(f: Formulas, theta: Jet) -> tuple[list[arb], list[arb]]:
    """c and dc/dtheta."""
    found = []
    for part in f.frame:
        series = stretch(part, float(theta.c[0])).formula(theta.series(1))
        found.append([*series.coeffs(), arb(0), arb(0)])
    return [x[0] for x in found], [x[1] for x in found]
