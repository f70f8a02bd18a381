"""That a periodic orbit exists, is alone, touches nothing between its impacts, and is stable or not."""

from __future__ import annotations

from collections.abc import Container, Sequence
from typing import Any

import numpy as np
from flint import arb, ctx

from lagrangian import Scene, checks
from lcpstep.analysis.orbits import PeriodicOrbit
from lcpstep.analysis.proofs.case import Case, frame_at
from lcpstep.analysis.proofs.errors import NotProved
from lcpstep.analysis.proofs.formulas import Formulas, formulas
from lcpstep.analysis.proofs.free import prove_free
from lcpstep.analysis.proofs.jets import Jet
from lcpstep.analysis.proofs.newton import Zero, improved, zero
from lcpstep.analysis.proofs.obstacles import stretch
from lcpstep.analysis.proofs.report import Enclosure, Proof, Unique, down, verdict
from lcpstep.analysis.proofs.shooting import Node, Struck, closing, flown, nodes_of, rebound

MOST_BITS = 1_000_000  # of what flint counts in an int
NEAR = 1e-6  # relative: how far what is proved may lie from what was given


def prove(orbit: PeriodicOrbit, *, bits: int = 128) -> Proof:
    """Prove a periodic orbit with impacts of a linear scene under harmonic forces.

    By Krawczyk's operator in ball arithmetic on the equations from impact to impact; see the files beside this one.

    Parameters
    ----------
    orbit : from `lcpstep.analysis.orbits.periodic_orbit`
    bits : precision of the arithmetic, 64 to a million

    Raises
    ------
    NotProved   the reason in words: a scene that no proof can be given of (nonlinear, friction, joints, callbacks
        that cannot be enclosed), an orbit that sticks, chatters, grazes, strikes a corner or touches something, or
        one that is none
    """
    checks.instance("orbit", orbit, PeriodicOrbit)
    checks.number("bits", bits, least=64, most=MOST_BITS)
    with ctx.workprec(int(bits)):
        f = formulas(orbit.scene)
        refuse(orbit)
        if len(orbit.time) == 0:
            result = prove_free(orbit, f, int(bits))
            check_near(orbit, result)
            return result
        guess, struck, contacts = impacts_of(orbit, f)
        slowness = Jet([1 / f.omega])
        found = _solved(f, struck, orbit.periods, guess)
        nodes = nodes_of(f, [Jet([x]) for x in found.balls])
        case = Case(f, struck, contacts, orbit.periods, nodes, slowness)
        case.show()
        moduli = case.multipliers()
        turns = [2 * arb.pi() * (arb(orbit.phase) + k) for k in range(orbit.periods)]
        result = Proof(
            name=orbit.name, periods=orbit.periods, period=Enclosure.of(2 * arb.pi() / f.omega),
            x=tuple(case.section(phase) for phase in turns), impacts=case.impacts(),
            multipliers=moduli, stability=verdict(moduli), unique=unique(found, f.omega), bits=int(bits),
        )  # fmt: skip
        check_near(orbit, result)
        return result


def refuse(orbit: Any) -> None:
    """NotProved for orbits that these equations are not those of."""
    if orbit.sticks:
        raise NotProved(
            f"{orbit.name}: the motion sticks to the obstacle or chatters (infinitely many impacts); proofs are for "
            "finitely many impacts with rebound"
        )
    if isinstance(orbit.scene, Scene) and len(orbit.time) == 0 and np.any(_resting(orbit)):
        raise NotProved(
            f"{orbit.name}: the motion sticks to contact {int(np.argmax(_resting(orbit)))} all the time"
        )


def _resting(orbit: Any) -> Any:
    """(n_c,) which contacts are closed on the section of a motion without impacts."""
    scene = orbit.scene
    q, v = np.split(np.asarray(orbit.x[0]), 2)
    gap, rate = scene.gap(orbit.phase * scene.period, q, v)
    length = float(np.max(np.abs(q)))
    speed = float(np.max(np.abs(v))) + length / scene.period
    return (np.abs(gap) <= NEAR * length) & (np.abs(rate) <= NEAR * speed)


def _solved(f: Formulas, struck: Sequence[Struck], periods: int, guess: Sequence[arb]) -> Zero:
    """The zero of the equations of the orbit."""

    def equations(unknowns: Sequence[Jet]) -> list[Jet]:
        nodes = nodes_of(f, unknowns)
        return closing(f, struck, periods, unknowns[0].like(1 / f.omega), nodes, [*nodes[1:], nodes[0]])

    def allowed(box: Sequence[arb]) -> bool:
        return in_place(struck, periods, box[:: 2 * f.n + 1])

    x = improved(equations, guess)
    if not in_place(struck, periods, x[:: 2 * f.n + 1]):
        raise NotProved(
            "an impact lies at a corner of the obstacle, or they come in another order: no orbit as it was given"
        )
    return zero(equations, x, scales(f, x), allowed)


def impacts_of(orbit: Any, f: Formulas) -> tuple[list[arb], list[Struck], list[int]]:
    """The unknowns as the orbit has them, and which contacts are struck."""
    slowness, section = Jet([1 / f.omega]), Jet([2 * arb.pi() * arb(orbit.phase)])
    node: Node = section, start_of(orbit, f, section)
    unknowns, struck, contacts = [], [], []
    for time in orbit.time:
        theta = Jet([(f.omega * arb(float(time))).mid()])
        x = flown(f, slowness, node, theta)
        candidates = [Struck(c, (stretch(c.obstacle, float(theta.c[0])),)) for c in f.contacts]
        gaps = [abs(float(rebound(f, s, theta, x)[0].c[0])) for s in candidates]
        which = int(np.argmin(gaps))
        if f.contacts[which].restitution.is_zero():
            raise NotProved(
                f"contact {which} has no restitution: it closes for good at an impact, and the motion sticks"
            )
        node = theta, [Jet([y.c[0].mid()]) for y in rebound(f, candidates[which], theta, x)[2]]
        struck.append(candidates[which])
        contacts.append(which)
        unknowns += [theta.c[0], *(y.c[0] for y in node[1])]
    return unknowns, struck, contacts


def start_of(orbit: Any, f: Formulas, section: Jet) -> list[Jet]:
    """The state on the section in absolute coordinates, (y, w)."""
    x = [arb(float(z)) for z in orbit.x[0]]
    lift, slope = frame_at(f, section)
    y = [z + c for z, c in zip(x[: f.n], lift, strict=True)]
    w = [z / f.omega + c for z, c in zip(x[f.n :], slope, strict=True)]
    return [Jet([z.mid()]) for z in y + w]


def in_place(struck: Sequence[Struck], periods: int, phases: Sequence[arb]) -> bool:
    """Whether the impacts come one after another, each on its stretch of the obstacle."""
    later = [*phases[1:], phases[0] + 2 * periods * arb.pi()]
    return all(a < b for a, b in zip(phases, later, strict=True)) and all(
        len(s.stretches) == 2 or s.stretches[0].holds(theta) for s, theta in zip(struck, phases, strict=True)
    )


def scales(f: Formulas, x: Sequence[arb], others: Container[int] = ()) -> list[arb]:
    """What is large: a radian of phase, and the largest position or velocity for all states; `others` are neither."""
    m = 2 * f.n + 1
    size = arb(0)
    for k, z in enumerate(x):
        size = size if k % m == 0 or k in others else size.max(abs(z))
    return [arb(1) if k % m == 0 else size for k in range(len(x))]


def unique(found: Zero, omega: arb) -> Unique:
    """The radii of uniqueness with their units; those of states are all the same."""
    return Unique(down(found.radius / omega), down(found.radii[1]), down(found.radii[1] * omega))


def check_near(orbit: PeriodicOrbit, proof: Proof) -> None:
    """NotProved where the orbit that was proved is not the one given."""
    T, fastest = orbit.scene.period, float(np.max(np.abs(orbit.before), initial=0.0))
    size = max(float(np.max(np.abs(orbit.x))), 1e-300)
    given = [("time", orbit.time, T), ("before", orbit.before, fastest), ("after", orbit.after, fastest)]
    for name, values, scale in given:
        for k, impact in enumerate(proof.impacts):
            _compare(f"{name} of impact {k}", float(values[k]), getattr(impact, name), scale)
    if np.shape(orbit.x) != (len(proof.x), len(proof.x[0])):
        raise NotProved(
            f"the orbit given is none: states of shape {np.shape(orbit.x)} for {len(proof.x)} periods"
        )
    for row, states in zip(orbit.x, proof.x, strict=True):
        for k, x in enumerate(states):
            _compare(f"state {k} on the section", float(row[k]), x, size)


def _compare(what: str, given: float, proved: Enclosure, scale: float) -> None:
    off = max(abs(given - proved.lower), abs(given - proved.upper))
    if not off <= NEAR * scale:
        raise NotProved(f"the orbit given is none: {what} is {given!r}, and the orbit near it has {proved}")
