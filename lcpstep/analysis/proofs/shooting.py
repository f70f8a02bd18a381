"""The equations of a periodic orbit: from impact to impact, and back to the first after n periods.

Unknown are, for every impact, its phase theta and the state x = (y, w) just after it. Of each flight it is asked

    g_c(theta', y') = 0,      R_c(theta', phi(theta' - theta) x) - x' = 0

where ' stands for the next impact, that of the first one 2 pi n later. Between impacts the motion is a matrix
exponential (`lcpstep.analysis.proofs.formulas`), so that no error of an integration enters.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from flint import arb, arb_mat

from lcpstep.analysis.proofs.formulas import Contact, Formulas
from lcpstep.analysis.proofs.jets import Jet, applied, derivative, exponential
from lcpstep.analysis.proofs.obstacles import Stretch

REMEMBERED = 128  # matrix exponentials


@dataclass(frozen=True)
class Struck:
    """An impact: which contact, and the stretch of its obstacle; two where it lies at a corner."""

    contact: Contact
    stretches: tuple[Stretch, ...]

    def obstacle(self, theta: Jet) -> tuple[Jet, Jet]:
        """o and do/dtheta; the hull of both sides of a corner."""
        variable = theta.series(1)
        heights = [list(s.formula(variable).coeffs()) for s in self.stretches]
        heights = [h + [arb(0)] * (theta.length + 1 - len(h)) for h in heights]
        height = [
            a if len(heights) == 1 else a.union(b) for a, b in zip(heights[0], heights[-1], strict=True)
        ]
        return theta.through(height), theta.through(derivative(height))


Node = tuple[Jet, list[Jet]]  # phase, and state (y, w) after the impact


def forcing(f: Formulas, theta: Jet) -> list[Jet]:
    """1, cos k theta, sin k theta."""
    sine, cosine = (f.multiple * theta.series()).sin_cos()
    return [theta.like(1), theta.through(cosine.coeffs()), theta.through(sine.coeffs())]


def flown(f: Formulas, slowness: Jet, node: Node, theta: Jet) -> list[Jet]:
    """The state (y, w) of the free flight from a node at another phase; slowness: 1/omega."""
    start, x = node
    span = theta - start
    return applied(propagator(f, span, slowness), [*x, *forcing(f, start)])[: 2 * f.n]


def propagator(f: Formulas, span: Jet, slowness: Jet) -> list[arb_mat]:
    """The parts of exp(span A); remembered, for derivatives by states ask for the same one again and again."""
    key = (*span.key(), *slowness.key())
    if key not in f.remembered:
        if len(f.remembered) >= REMEMBERED:
            f.remembered.clear()
        terms = [(span, f.A0), (span * slowness, f.A1), (span * slowness * slowness, f.A2)]
        f.remembered[key] = exponential(terms)
    return f.remembered[key]


def rebound(f: Formulas, struck: Struck, theta: Jet, x: Sequence[Jet]) -> tuple[Jet, Jet, list[Jet]]:
    """Gap, its rate dg/dtheta before, and the state after the impact."""
    c, n = struck.contact, f.n
    height, rate = struck.obstacle(theta)
    gap, u = -height, -rate
    for i in range(n):
        gap, u = gap + x[i] * c.G[i], u + x[n + i] * c.G[i]
    w = [x[n + i] - u * (c.lever[i] * (1 + c.restitution)) for i in range(n)]
    return gap, u, [*x[:n], *w]


def closing(
    f: Formulas,
    impacts: Sequence[Struck],
    periods: int,
    slowness: Jet,
    nodes: Sequence[Node],
    ends: Sequence[Node],
) -> list[Jet]:
    """What must vanish; ends : the node at the end of each flight, for the last one that of the first turn."""
    rest = []
    for k, (theta, x) in enumerate(ends):
        last = k + 1 == len(impacts)
        arrival = theta + 2 * periods * arb.pi() if last else theta
        there = flown(f, slowness, nodes[k], arrival)
        gap, _, after = rebound(f, impacts[0 if last else k + 1], theta, there)
        rest += [gap, *(a - b for a, b in zip(after, x, strict=True))]
    return rest


def nodes_of(f: Formulas, unknowns: Sequence[Jet]) -> list[Node]:
    """The unknowns, impact by impact."""
    m = 2 * f.n + 1
    return [(unknowns[k], list(unknowns[k + 1 : k + m])) for k in range(0, len(unknowns), m)]
