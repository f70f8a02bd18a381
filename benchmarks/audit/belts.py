"""Random belts with a jerk, and tables with a burr, under friction: `python -m benchmarks.audit.belts --cases 300`.

A block of 1 kg, with or without a spring, lies on a belt whose velocity has one short jerk, or one in each period;
the judge (`benchmarks.audit.judge`) is another way to compute the same. A body that drifts along a table and swings
above it meets a burr of the table or does not, which the free motion says. Widths are 1e-1 to 1e-5 of the period or
span. A run is lost where the jerk or burr has left no trace, and wrong where it is off by more than the method.
"""

from __future__ import annotations

import argparse
import math
from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.audit.cases import TURN, bell, bump, smallest
from benchmarks.audit.judge import Belt, follow
from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, simulate
from lcpstep.trajectory import Status

GRAVITY, SPAN, OFFSET = 9.81, 10.0, 1.05
METHODS: list[tuple[str, Any, float]] = [  # with the error that is the method's own [m]
    ("EventDriven", EventDriven(), 1e-8),
    ("Located(1e-3)", Located(1e-3), 1e-4),
    ("Located(1e-3, order=4)", Located(1e-3, order=4), 1e-6),
]
CLEAR = {"EventDriven": 1e-10, "Located(1e-3)": 1e-4, "Located(1e-3, order=4)": 1e-7}  # of a burr: least gap


def tangent(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Along the belt."""
    out[0, 0], out[0, 1] = 1.0, 0.0


def polynomial(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """A belt that runs at p[3] + p[4] sin(p[5] t), but for jerks of p[0] (1 - s^2)^3 about p[2] in every p[6]."""
    s = (t - p[6] * math.floor(t / p[6]) - p[2]) / p[1]
    jerk = p[0] * (1.0 - s * s) ** 3 if abs(s) < 1.0 else 0.0
    out[0] = -(p[3] + p[4] * math.sin(p[5] * t) + jerk)


def gaussian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """The same with jerks p[0] exp(-s^2), s being as far as on a circle, so that it has no corner."""
    s = p[6] / (math.pi * p[1]) * math.sin(math.pi * (t - p[2]) / p[6])
    out[0] = -(p[3] + p[4] * math.sin(p[5] * t) + p[0] * math.exp(-s * s))


@dataclass(frozen=True)
class Drawn:
    """A scene on a belt, and what its judge needs."""

    scene: Scene
    belt: Belt
    mu: float
    stiffness: float


def on_a_belt(rng: np.random.Generator) -> Drawn:
    """A block that begins at rest on it, or slides."""
    period = float(rng.choice([SPAN, SPAN, 2.5]))
    width = period * 10.0 ** rng.uniform(-5.0, -1.0)
    mu, stiffness = rng.uniform(0.1, 0.8), float(rng.choice([0.0, rng.uniform(1.0, 20.0)]))
    sway = float(rng.choice([0.0, rng.uniform(0.05, 0.5)]))
    omega = TURN / period * int(rng.integers(1, 4))
    at = rng.uniform(0.05, 0.95) * period
    jerk = float(rng.choice([-1.0, 1.0])) * 10.0 ** rng.uniform(-2.0, 0.5)
    p = np.array([jerk, width, at, rng.uniform(-0.5, 0.5), sway, omega, period])
    shape = polynomial if rng.random() < 0.5 else gaussian
    scene = Scene(
        system=LinearSystem(M=np.eye(2), K=np.diag([stiffness, 0.0]), force=[0.0, -GRAVITY]),
        contacts=LinearContacts([[0.0, 1.0]], 0.0, 0.0, friction=Coulomb(mu, tangent, shape)),
        q0=[0.0, 0.0], v0=[float(rng.choice([p[3], rng.uniform(-1.0, 1.0)])), 0.0], t_span=(0.0, SPAN), p=p,
        period=period if period < SPAN else math.inf, name=f"{shape.__name__} {width:.2g}",
    )  # fmt: skip
    return Drawn(scene, Belt(p, shape is gaussian), mu, stiffness)


def judge_belt(drawn: Drawn, found: dict[str, Counter[str]], tell: bool) -> None:
    """One belt by all methods."""
    v0 = float(drawn.scene.v0[0])
    try:
        true = follow(drawn.belt, drawn.mu * GRAVITY, drawn.stiffness, v0, SPAN)
        plain = follow(drawn.belt.without_jerk(), drawn.mu * GRAVITY, drawn.stiffness, v0, SPAN)
    except RuntimeError:
        found["judge"]["has given up"] += 1
        return
    effect = abs(true[0] - plain[0])
    for name, method, own in METHODS:
        run = simulate(drawn.scene, method)
        off = abs(run.q[-1, 0] - true[0])
        found[name]["belts"] += 1
        found[name]["seen to matter"] += effect > 10.0 * own
        if run.status != Status.DONE:
            found[name]["stopped early, and said so"] += 1
            continue
        lost = effect > 10.0 * own and abs(run.q[-1, 0] - plain[0]) < 0.1 * effect
        wrong = not off <= own + 0.01 * effect
        found[name]["lost"] += lost
        found[name]["wrong"] += wrong and not lost
        if tell and (lost or wrong):
            print(
                name, drawn.scene.name, list(drawn.scene.p), drawn.mu, drawn.stiffness, v0, "off", off, effect
            )


def judge_table(rng: np.random.Generator, found: dict[str, Counter[str]], tell: bool) -> None:
    """One burr of a table by all methods."""
    width, phase = SPAN * 10.0 ** rng.uniform(-5.0, -1.0), rng.uniform(0.0, TURN)
    at, motion = rng.uniform(0.03, 0.97) * SPAN, bell if rng.random() < 0.5 else bump
    p, mu, out = np.array([rng.uniform(0.05, 1.0), width, at]), rng.uniform(0.1, 0.8), np.zeros((1, 3))
    scene = Scene(
        system=LinearSystem(M=np.eye(2), K=np.diag([0.0, TURN**2])),
        contacts=LinearContacts([[0.0, 1.0]], OFFSET, 0.8, motion=motion, friction=Coulomb(mu, [[1.0, 0.0]])),
        q0=[0.0, math.cos(phase)], v0=[1.0, -TURN * math.sin(phase)], t_span=(0.0, SPAN), p=p,
    )  # fmt: skip

    def gap(t: float) -> float:
        motion(t, None, None, p, out)
        return math.cos(TURN * t + phase) + OFFSET - float(out[0, 0])

    if gap(0.0) <= 0.0:
        return
    least = smallest(gap, max(at - 4.0 * width, 0.0), min(at + 4.0 * width, SPAN))
    for name, method, _ in METHODS:
        if abs(least) < CLEAR[name]:
            continue
        struck = len(simulate(scene, method).impacts) > 0
        found[name]["burrs"] += 1
        found[name]["in the way"] += least < 0.0
        found[name]["lost burrs"] += least < 0.0 and not struck
        found[name]["struck, but none"] += least > 0.0 and struck
        if tell and (least < 0.0) != struck:
            print(name, motion.__name__, list(p), mu, phase, "least", least)


def main() -> None:
    """Print the counts by method."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tell", action="store_true", help="print the cases that are lost or wrong")
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    found: dict[str, Counter[str]] = {name: Counter() for name in [*(x[0] for x in METHODS), "judge"]}
    for k in range(options.cases):
        if k % 3 == 2:
            judge_table(rng, found, options.tell)
        else:
            judge_belt(on_a_belt(rng), found, options.tell)
    for name, counts in found.items():
        print(f"{name}: " + ", ".join(f"{key} {n}" for key, n in counts.items()))


if __name__ == "__main__":
    main()
