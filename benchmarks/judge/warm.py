"""Machine code before the clock runs: what a worker compiles would count as its scene's time, and end it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from benchmarks.judge.describe import Description
from benchmarks.judge.runs import REFERENCE, run

WALL = Description(
    M=((1.0,),), q0=(0.01,), v0=(0.0,), t_span=(0.0, 0.1), h=0.01, G=((1.0,),), offset=(0.0,), restitution=0.5,
    K=((1.0,),), constant=(-10.0,), family="wall",
)  # fmt: skip
CORNER = Description(
    M=((1.0, 0.0), (0.0, 1.0)), q0=(0.01, 0.02), v0=(0.0, 0.0), t_span=(0.0, 0.1), h=0.01,
    G=((1.0, 0.0), (0.1, 1.0)), offset=(0.0, 0.0), restitution=0.5, constant=(-10.0, -10.0), family="corner",
)  # fmt: skip
SHAKEN = {"amplitude": (0.01, 0.01), "phase": (0.0, 0.0), "omega": 3.0}
SCENES = (
    WALL, CORNER, replace(WALL, general=True, function=True), replace(CORNER, general=True),
    replace(CORNER, bend=(0.1, 0.1)), replace(CORNER, **SHAKEN),
    replace(CORNER, J=((1.0, -1.0),), joint_offset=(0.01,)),
)  # fmt: skip


def warm(methods: Iterable[str]) -> None:
    """Compile what the methods need, once per machine; workers then find it on disk."""
    for name in dict.fromkeys([REFERENCE, *methods]):
        for d in SCENES:
            run(d, name)
