"""Error against CPU time: `python -m benchmarks.work_precision --help`.

Every method of the library that takes the scene, and Siconos' Moreau-Jean in the same run where a Python on the
machine has it; each level is the mean over nearby steps, each time the median of repeated runs.
"""

from __future__ import annotations

import argparse
import json
import math
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.stepping import peer
from benchmarks.work_precision.cost import costs
from benchmarks.work_precision.report import markdown
from benchmarks.work_precision.siconos import MoreauJean
from lagrangian import LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, Moreau, study
from lcpstep.accuracy.work_precision import Study

HERE = Path(__file__).parent
SPREAD = (0.9, 1.0, 1.11)
MEASURES = ("sup_position", "l1_velocity", "penetration")
TOLERANCES = (1e-5, 1e-7, 1e-9, 1e-11)


@dataclass(frozen=True)
class Case:
    """A scene, the steps of Moreau, of methods that locate impacts, and the finest of Siconos (inf: none) [s]."""

    name: str
    scene: Scene
    steps: tuple[float, ...]
    located: tuple[float, ...]
    finest_peer: float


THREE_DECADES = (1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
CASES = (
    Case(
        "bouncing ball, 5 s",
        scenes.bouncing_ball(),
        (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5),
        (0.1, 1e-2, 1e-3),
        3e-5,
    ),
    Case("impact oscillator, 100 s", scenes.impact_oscillator(), (*THREE_DECADES, 3e-5), THREE_DECADES, 1e-3),
    Case(
        "sticking oscillator, 100 s",
        scenes.sticking_oscillator(),
        THREE_DECADES,
        THREE_DECADES,
        math.inf,
    ),
    Case(
        "double pendulum and wall, 3 s",
        scenes.double_pendulum(),
        (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5),
        (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5),
        math.inf,
    ),
    Case(
        "cam-follower at 358 rpm, 1 s",
        scenes.cam_follower(t_end=1.0),
        (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6),
        (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6),
        1e-5,
    ),
)


def library_methods(case: Case) -> dict[str, list[Any]]:
    """Every method of the library over its range."""
    methods: dict[str, list[Any]] = {"Moreau": [Moreau(h) for h in case.steps]}
    # What is more accurate comes down to rounding at larger steps
    finest: dict[int | str, int] = {2: len(case.located), 4: 5}
    if isinstance(case.scene.system, LinearSystem):
        finest["exact"] = 3
    for order, levels in finest.items():
        methods[f"Located, order {order}"] = [Located(h, order) for h in case.located[:levels]]
    methods["EventDriven"] = [EventDriven(t, t) for t in TOLERANCES]
    return methods


def one(case: Case, siconos: peer.Siconos | None, repeats: int) -> Study:
    """The study of one scene, Siconos' times as the worker reports them."""
    methods, seconds = library_methods(case), dict[float, list[float]]()
    if siconos is not None and case.finest_peer < math.inf:
        steps = [h for h in case.steps if h >= case.finest_peer]
        methods["Siconos Moreau-Jean"] = [MoreauJean(h, peer=siconos, seconds=seconds) for h in steps]
    found = study(
        case.scene,
        methods,
        measures=MEASURES,
        spread=SPREAD,
        repeats=repeats,
        progress=lambda line: print(line, flush=True),
    )
    found.levels = [
        replace(x, seconds=median(reported(x.value, seconds)))
        if x.method.startswith("Siconos") and seconds
        else x
        for x in found.levels
    ]
    return found


def reported(h: float, seconds: dict[float, list[float]]) -> Iterable[float]:
    """The times that the worker reported for the steps near h."""
    return [s for step, times in seconds.items() if 0.8 < step / h < 1.25 for s in times]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.work_precision", description=__doc__)
    parser.add_argument("--repeats", type=int, default=5, help="rounds of timing (5)")
    parser.add_argument(
        "--siconos", metavar="PYTHON", help="a Python that has Siconos; found by itself if possible"
    )
    parser.add_argument("--no-siconos", action="store_true", help="leave Siconos out")
    parser.add_argument(
        "--out", type=Path, default=HERE, help="folder of results.md, results.json and the pictures"
    )
    asked = parser.parse_args()
    python = None if asked.no_siconos else peer.find(asked.siconos)
    if python is None and not asked.no_siconos:
        print("Siconos was not found and is left out. Debian: apt-get install python3-siconos gcc")
    with tempfile.TemporaryDirectory() as folder:
        siconos = peer.Siconos(python, Path(folder)) if python else None
        found = {case.name: one(case, siconos, asked.repeats) for case in CASES}
        per_step = costs(asked.repeats)
        version = siconos.version if siconos else "not found"
        if siconos:
            siconos.close()
    asked.out.mkdir(parents=True, exist_ok=True)
    stored = {
        "siconos": version,
        "studies": {name: s.as_dict() for name, s in found.items()},
        "steps": [c.as_dict() for c in per_step],
    }
    (asked.out / "results.json").write_text(json.dumps(stored, indent=1) + "\n")
    text = markdown(found, per_step, version)
    (asked.out / "results.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
