"""Cost and error of a step as features are switched on one at a time: `python -m benchmarks.features --help`."""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.features.throws import T_END, at_rest, throws
from benchmarks.stepping.machine import machine
from benchmarks.stepping.report import table
from benchmarks.stepping.timing import Timing, clocked, ratio, take_turns
from lcpstep import Moreau, simulate

HERE = Path(__file__).parent
STEPS = 200_000
H = 1e-3
SPREAD = (1.0, 1.07, 1.13, 1.21, 1.29, 1.37)
SHORT = 1e-6  # step of the timed flights, so short that the ball stays in the air
INTRO = f"""
Made by `python -m benchmarks.features`. A ball thrown over a floor, described with one feature more than the first
line each; its motion is known in every case. Cost: processor time of the whole call of `simulate`, nothing kept,
divided by {STEPS:,} steps; in the air, and at rest on the floor with the contact closed in every step. Medians, in
brackets shortest and longest; ratios are medians of the ratios within a round. Error: distance from the exact place
after {T_END:g} s with h about {H:g} s, the mean over six neighbouring steps.
"""
OLDER = """
The same scenes without any of the features, in this checkout and in an older one that had none of them
(`--against CHECKOUT`). Each run is a process of its own; the two take turns.
"""
OLD_WORKER = """
import time, numpy as np
from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep import Moreau, simulate
for y, h in ((0.5, 1e-6), (0.0, 1e-3)):
    scene = Scene(system=LinearSystem(M=np.eye(2), force=[0.0, -9.81]),
        contacts=LinearContacts([[0.0, 1.0]], restitution=0.6), q0=[0.0, y], v0=[0.0, 0.0], t_span=(0.0, STEPS * h))
    simulate(scene, Moreau(h), keep=STEPS)
    times = []
    for _ in range(5):
        begin = time.process_time()
        simulate(scene, Moreau(h), keep=STEPS)
        times.append(time.process_time() - begin)
    print(sorted(times)[2])
""".replace("STEPS", str(STEPS))


def costs(rounds: int) -> tuple[dict[str, Timing], dict[str, Timing]]:
    """Times of STEPS steps, in the air and at rest."""
    air, rest = {}, {}
    for name, throw in throws().items():
        for contestants, scene, h in ((air, throw.scene, SHORT), (rest, at_rest(throw), H)):
            long = replace(scene, t_span=(0.0, STEPS * h))
            method = Moreau(h, projected=throw.projected)
            contestants[name] = clocked(lambda s=long, m=method: simulate(s, m, keep=STEPS))
    return take_turns(air, rounds), take_turns(rest, rounds)


def mean_error(throw: Any) -> float:
    """Error at the end of the span, meant over neighbouring steps."""
    errors = []
    for s in SPREAD:
        m = simulate(throw.scene, Moreau(T_END / round(T_END / H * s), projected=throw.projected))
        errors.append(throw.error(m.q[-1]))
    return float(np.mean(errors))


def against(older: Path, rounds: int) -> dict[str, tuple[Timing, Timing]]:
    """Times of featureless steps here and in an older checkout: in the air and at rest."""
    places = {"here": HERE.parent.parent, "older": older}
    seconds: dict[str, list[list[float]]] = {name: [] for name in places}
    for k in range(rounds + 1):
        for name, folder in places.items():
            environment = {**os.environ, "PYTHONPATH": str(folder)}
            done = subprocess.run(
                [sys.executable, "-c", OLD_WORKER], cwd=folder, env=environment,
                check=True, capture_output=True, text=True,
            )  # fmt: skip
            if k > 0:
                seconds[name].append([float(x) for x in done.stdout.split()])
    columns = {name: [Timing(x) for x in zip(*rows, strict=True)] for name, rows in seconds.items()}
    return dict(zip(("in the air", "at rest"), zip(*columns.values(), strict=True), strict=True))


def measure(rounds: int, older: Path | None) -> dict[str, Any]:
    """All figures; times in seconds a step."""
    air, rest = costs(rounds)
    figures: dict[str, Any] = {"machine": machine(), "rounds": rounds, "features": {}}
    for name, throw in throws().items():
        figures["features"][name] = {
            "air": air[name].per(STEPS), "air ratio": ratio(air[name], air["one contact"]),
            "rest": rest[name].per(STEPS), "rest ratio": ratio(rest[name], rest["one contact"]),
            "error": mean_error(throw),
        }  # fmt: skip
    if older is not None:
        figures["off"] = {
            name: {"here": here.per(STEPS), "older": old.per(STEPS), "ratio": ratio(here, old)}
            for name, (here, old) in against(older, rounds).items()
        }
    return figures


def nanoseconds(x: dict[str, float]) -> str:
    return f"{1e9 * x['median']:.0f} ({1e9 * x['low']:.0f}-{1e9 * x['high']:.0f})"


def markdown(figures: dict[str, Any]) -> str:
    """The results file."""
    head = ["with", "in the air [ns]", "ratio", "at rest [ns]", "ratio", "error [m]"]
    rows = [
        [name, nanoseconds(f["air"]), f"{f['air ratio']:.2f}", nanoseconds(f["rest"]), f"{f['rest ratio']:.2f}",
         f"{f['error']:.1e}"]
        for name, f in figures["features"].items()
    ]  # fmt: skip
    parts = [
        "# What a feature costs",
        ", ".join(f"{key} {value}" for key, value in figures["machine"].items()) + ".",
        INTRO.strip(),
        table(head, rows),
    ]
    if "off" in figures:
        rows = [
            [name, nanoseconds(f["here"]), nanoseconds(f["older"]), f"{f['ratio']:.2f}"]
            for name, f in figures["off"].items()
        ]
        parts += ["## What is off", OLDER.strip(), table(["steps", "here [ns]", "older [ns]", "ratio"], rows)]
    return "\n\n".join(parts) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.features", description=__doc__)
    parser.add_argument("--rounds", type=int, default=9, help="how often each contestant runs (default 9)")
    parser.add_argument(
        "--against", type=Path, metavar="CHECKOUT", help="an older checkout, without the features"
    )
    parser.add_argument(
        "--out", type=Path, default=HERE, help="folder of results.md and results.json (default: here)"
    )
    asked = parser.parse_args()
    figures = measure(asked.rounds, asked.against)
    asked.out.mkdir(parents=True, exist_ok=True)
    (asked.out / "results.json").write_text(json.dumps(figures, indent=1) + "\n")
    (asked.out / "results.md").write_text(markdown(figures))
    print(markdown(figures))


if __name__ == "__main__":
    main()
