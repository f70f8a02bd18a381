"""What one step costs: Located beside the library's own Moreau, at equal h, in turns, with the errors of both.

Several impacts fall into a step where h is long: the gas and the column.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from benchmarks.stepping.timing import clocked, ratio, take_turns
from lagrangian import Scene, scenes
from lcpstep import Located, Moreau, simulate
from lcpstep.accuracy.errors import Difference
from lcpstep.accuracy.reference import find_reference

SECONDS = 0.05  # each timing repeats its run for about so long, so that the clock's ticks do not count


@dataclass(frozen=True)
class StepCost:
    """Cost of a step of both methods [s], median ratio of a round, impacts in a step, errors [m], depth [m]."""

    scene: str
    h: float
    moreau: float
    located: float
    ratio: float
    impacts: float
    moreau_error: float
    located_error: float
    penetration: float

    def as_dict(self) -> dict[str, Any]:
        """The figures by name."""
        return asdict(self)


def questions() -> Iterator[tuple[str, Scene, float]]:
    """Scenes and steps."""
    yield "bouncing ball", scenes.bouncing_ball(), 1e-4
    yield "impact oscillator", scenes.impact_oscillator(), 1e-3
    yield "sticking oscillator", scenes.sticking_oscillator(), 1e-3
    yield "cam-follower, 358 rpm", scenes.cam_follower(t_end=1.0), 1e-5
    yield "double pendulum and wall", scenes.double_pendulum(), 1e-3
    for h in (1e-3, 1e-2, 5e-2):
        yield "elastic gas, 20 beads", scenes.elastic_gas(n=20), h
    for h in (1e-1, 2.5e-1):
        yield "elastic gas, 20 beads, 100 s", scenes.elastic_gas(n=20, t_end=100.0), h
    for h in (1e-3, 1e-2):
        yield "column of 20 that comes to rest", scenes.column(n=20, t_end=2.0), h


def costs(rounds: int) -> list[StepCost]:
    """All of them."""
    return [cost(*question, rounds) for question in questions()]


def cost(name: str, scene: Scene, h: float, rounds: int) -> StepCost:
    """Both methods on one scene with one step."""
    methods = {"Moreau": Moreau(h), "Located": Located(h)}
    runs = {m: simulate(scene, method) for m, method in methods.items()}
    steps = runs["Moreau"].counts.steps
    end = [scene.t_span[1]]

    def work(method: Any, times: int) -> Any:
        return lambda: [simulate(scene, method, keep=end) for _ in range(times)]

    single = take_turns({m: clocked(work(x, 1)) for m, x in methods.items()}, 1)
    times = max(1, math.ceil(SECONDS / min(t.median for t in single.values())))
    taken = take_turns({m: clocked(work(x, times)) for m, x in methods.items()}, rounds)
    reference = find_reference(scene, None).motion
    errors = {m: Difference(run, reference).sup_position for m, run in runs.items()}
    impacts = float(np.sum(runs["Located"].impacts.impulse > 0.0)) / steps
    per = times * steps
    return StepCost(
        name, h, taken["Moreau"].median / per, taken["Located"].median / per,
        ratio(taken["Located"], taken["Moreau"]), impacts, errors["Moreau"], errors["Located"],
        Difference(runs["Located"], runs["Located"]).penetration,
    )  # fmt: skip
