"""One scene in other words: whatever a method makes of it, it has to make the same of these.

Each variant is a description, and how its motion is read as one of the first: a map of times and of coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import PER_ROW, Description, numbers
from benchmarks.judge.scales import EPS, scales

STILL = 1e-14  # of the speed that forces would give, or the way: what is left of one by rounding


@dataclass(frozen=True)
class Variant:
    """A scene in other words: its time is t + shift, its coordinates q / unit, its contacts `order` of these.

    until : time up to which steps are those of the scene
    """

    name: str
    scene: Description
    shift: float = 0.0
    unit: Any = 1.0
    order: Any = None
    until: float = np.inf


def longer(d: Description, rng: Any) -> Variant:
    """The same up to a later end, by whole steps; where the last step is cut short by the end, up to that one."""
    start, end = d.t_span
    steps, whole = d.length / d.h, round(d.length / d.h)
    until = np.inf if abs(steps - whole) < 1e-6 else start + d.h * int(steps)
    new = replace(d, t_span=(start, end + d.h * int(rng.integers(1, 9))))
    return Variant("another end", new, until=until)


def later(d: Description, rng: Any) -> Variant:
    """The same at another time: phases of everything that is driven move with it."""
    by = float(rng.choice([1.0, -3.0, 64.0]))
    c, s = np.cos(d.force_omega * by), np.sin(d.force_omega * by)
    cosine, sine = np.array([[c, -s], [s, c]]) @ np.stack([d.row("cosine"), d.row("sine")])
    driven = any(d.cosine) or any(d.sine)
    new = replace(
        d, t_span=(d.t_span[0] + by, d.t_span[1] + by), phase=numbers(np.array(d.phase) - d.omega * by),
        cosine=numbers(cosine) if driven else (), sine=numbers(sine) if driven else (),
    )  # fmt: skip
    return Variant("shifted in time", new, shift=by)


def renumbered(d: Description, rng: Any) -> Variant:
    """Contacts in another order."""
    order = rng.permutation(d.contacts)

    def mixed(x: Any) -> Any:
        return tuple(x[i] for i in order) if isinstance(x, tuple) and x else x

    return Variant(
        "contacts renumbered", replace(d, **{k: mixed(getattr(d, k)) for k in PER_ROW}), order=order
    )


def reordered(d: Description, rng: Any) -> Variant:
    """Coordinates in another order."""
    order = rng.permutation(d.n)
    return _turned(d, np.eye(d.n)[order], "coordinates renumbered")


def rescaled(d: Description, rng: Any) -> Variant:
    """Coordinates in other units, powers of two, so that nothing is rounded."""
    return _turned(d, np.diag(2.0 ** rng.integers(-3, 4, d.n)), "coordinates rescaled")


def _turned(d: Description, T: Any, name: str) -> Variant:
    """Coordinates T q in place of q."""
    back = np.linalg.inv(T)

    def matrix(x: Any) -> Any:
        return numbers(back.T @ np.array(x) @ back) if x else x

    def covector(x: Any) -> Any:
        return numbers(back.T @ np.array(x)) if x else x

    def rows(x: Any) -> Any:
        return numbers(np.array(x) @ back) if x else x

    new = replace(
        d, M=matrix(d.M), K=matrix(d.K), C=matrix(d.C),
        q0=numbers(T @ np.array(d.q0)), v0=numbers(T @ np.array(d.v0)),
        constant=covector(d.constant), cosine=covector(d.cosine), sine=covector(d.sine), b=covector(d.b),
        G=rows(d.G), T=rows(d.T), J=rows(d.J), frame=numbers(T @ np.array(d.frame)) if d.frame else (),
    )  # fmt: skip
    return Variant(name, new, unit=back)


def heavier(d: Description, rng: Any) -> Variant:
    """Masses and forces in another unit: nothing moves differently."""
    unit = float(2.0 ** rng.integers(-6, 7))

    def more(x: Any) -> Any:
        return numbers(unit * np.array(x)) if np.size(x) else x

    names = ("M", "K", "C", "constant", "cosine", "sine")
    scene = replace(
        d, **{k: more(getattr(d, k)) for k in names}, spread=unit * d.spread, pendulum=unit * d.pendulum
    )
    return Variant("masses rescaled", scene)


def in_units(d: Description, length: float, time: float, mass: float) -> Description:
    """The same in other units: every length, time and mass is so many times as large a number."""
    units = {
        "M": mass, "K": mass / time**2, "C": mass / time, "q0": length, "v0": length / time, "t_span": time,
        "offset": length, "slip": length / time, "sway": length / time,
        "amplitude": length, "frame": length, "round": length, "joint_offset": length,
        "constant": mass * length / time**2, "cosine": mass * length / time**2, "sine": mass * length / time**2,
        "b": 1.0 / length,
    }  # fmt: skip
    rows = {name: numbers(unit * np.array(x)) for name, unit in units.items() if (x := getattr(d, name))}
    bend = [x if r > 0.0 else x / length for x, r in zip(d.bend, d.row("round", len(d.bend)), strict=True)]
    return replace(
        d, **rows, h=time * d.h, omega=d.omega / time, force_omega=d.force_omega / time, bend=numbers(bend),
        joint_bend=numbers(np.array(d.joint_bend) / length), spread=mass * length**2 * d.spread,
        pendulum=mass * length**2 / time**2 * d.pendulum,
    )  # fmt: skip


def as_general(d: Description, rng: Any) -> Variant:
    """A linear system whose forces the library sees as a function of the state."""
    return Variant("as a general system", replace(d, general=True))


def as_curved(d: Description, rng: Any) -> Variant:
    """Flat contacts that the library sees as functions of the state."""
    return Variant("as curved contacts", replace(d, gaps=True))


def rest(d: Description, rng: Any, motion: Any, promised: float = 0.0) -> Variant:
    """The second part of the span, from where a motion is after some whole steps.

    Speeds that are rounding are none: between two walls that leave no room they are an approach that, by Newton's law
    of impact, no impulses end. So are those of closed contacts below what is promised of velocities: from there an
    elastic contact would hop for ever, as often as it is pressed (a/2u times a second), where the motion rests.
    Places that are rounding are none either: a wall 5e-16 m away from where everything else is zero is an open one to
    `Moreau`, whose lengths are those of the start, and is met a step later.
    """
    steps = int(d.length / d.h)
    t = d.t_span[0] + d.h * int(rng.integers(1, max(2, steps)))
    q, v = motion.at(t)
    sizes = scales(d, motion.q, motion.v)
    q = np.where(np.abs(q) > STILL * sizes.reach, q, 0.0)
    v = np.where(np.abs(v) > STILL * sizes.reach / sizes.time, v, 0.0)
    if promised > 0.0 and d.contacts and not d.J:
        v = at_rest(d, t, q, v, promised, 1e3 * EPS * sizes.place)
    return Variant("span in two parts", replace(d, q0=numbers(q), v0=numbers(v), t_span=(t, d.t_span[1])))


def at_rest(d: Description, t: float, q: Any, v: Any, promised: float, rounding: Any) -> Any:
    """Velocities without those of closed gaps that velocities known to within `promised` do not tell."""
    rows, u = physics.jacobians(d, q), physics.rates(d, t, q, v)
    rests = (physics.gaps(d, t, q) <= rounding) & (np.abs(u) <= promised * np.sum(np.abs(rows), axis=-1))
    G = rows[rests]
    mobility = np.linalg.solve(physics.masses(d, q), G.T)
    return v - mobility @ np.linalg.lstsq(G @ mobility, u[rests], rcond=None)[0]


VARIANTS: dict[str, Callable[[Description, Any], Variant]] = {
    "end": longer, "time": later, "contacts": renumbered, "order": reordered, "units": rescaled, "mass": heavier,
    "general": as_general, "curved": as_curved,
}  # fmt: skip


def fits(name: str, d: Description, method: str) -> bool:
    """Whether a variant is the same question to a method; steps treat general systems by other formulas.

    Of order two, they carry the force at their end over, found with the velocity foretold for it: where it depends on
    velocities, as that of a contact beside round joints does, a run begun anew differs by the order.
    """
    round_joints = any(d.joint_bend)
    carried = (d.general or d.nonlinear or bool(d.J)) and (
        bool(d.C) or d.spread != 0.0 or (round_joints and d.contacts > 0)
    )
    return {
        "contacts": d.contacts > 1,
        "order": d.n > 1,
        "units": d.n > 1 and not d.curved and not round_joints,
        "time": not any(d.frame) and not any(d.sway) and not (d.form and d.moving),
        "rest": not (carried and method in ("located", "located-tolerance")),
        "general": method.startswith("event")
        and not (d.general or d.nonlinear or d.function or any(d.frame)),
        "curved": method.startswith("event") and d.contacts > 0 and not d.curved,
    }.get(name, True)
