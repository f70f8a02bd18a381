"""Seconds for the studies of the cam-follower and for every figure of the thesis; how far time-stepping is off.

python -m benchmarks.analysis [--jobs N] [--quick] [--only PART ..]      writes results.md and results.json

With --only the other parts stay as they were measured before.
"""

from __future__ import annotations

import argparse
import json
import os
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Moreau, simulate
from lcpstep.analysis.basins import basins
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.analysis.likeness import likeness, sample
from lcpstep.maps import periods
from lcpstep.thesis import FIGURES, make
from lcpstep.thesis.page import chapter_of

HERE = Path(__file__).parent
REPEATS = 3
PARTS = ("impacts", "sweeps", "figures", "lockstep", "agreement")
LONG = 3.0  # a figure that takes longer is made once [s]


def timed(f: Callable[[], Any]) -> tuple[float, float, Any]:
    """Wall and CPU seconds of the fastest of a few calls, after one that compiles; and its value."""
    value, best = None, (np.inf, np.inf)
    for _ in range(REPEATS):
        wall, cpu = time.perf_counter(), time.process_time()
        value = f()
        best = min(best, (time.perf_counter() - wall, time.process_time() - cpu))
    return *best, value


def impacts() -> list[dict[str, Any]]:
    """Microseconds per impact of event-driven runs: bouncing, chattering and sticking, chaotic."""
    rows = []
    for rpm, kind in (
        (358.5, "O(3, 8)"),
        (125.0, "two chattering sequences and rests a period"),
        (660.0, "chaotic"),
    ):
        scene = cam_follower(rpm=rpm)
        run = lambda scene=scene: periods(scene, EventDriven(), [0.0, 0.1], 2000, most=0)  # noqa: E731
        run()
        _, cpu, found = timed(run)
        count = int(found.impacts.sum())
        rows.append({"rpm": rpm, "motion": kind, "impacts": count, "microseconds": 1e6 * cpu / count})
    return rows


def sweeps(jobs: int, quick: bool) -> list[dict[str, Any]]:
    """Seconds of the basin and of the diagrams, by number of threads."""
    rows = []
    cells, speeds = (200, 100) if quick else (1000, 1000)
    still = cam_follower(rpm=358.5, coordinates="absolute")
    basin = lambda: basins(still, [0.1, -60.0], [1.6, 60.0], (cells, cells), jobs=jobs)  # noqa: E731
    rows.append(row(f"basin, {cells} x {cells} cells, 358.5 rpm", jobs, basin))
    methods = (
        ("event-driven", EventDriven(), speeds),
        ("time-stepping, h = 1e-4 s", Moreau(h=1e-4), speeds // 10),
    )
    for name, method, points in methods:
        for n in sorted({1, jobs}):
            diagram = lambda n=n, m=method, k=points: bifurcation(  # noqa: E731
                cam_follower, "rpm", np.linspace(114.0, 850.0, k), method=m, drop=500, keep=60, jobs=n
            )
            rows.append(row(f"diagram 114-850 rpm, {points} speeds, 500 + 60 periods, {name}", n, diagram))
    return rows


def row(study: str, jobs: int, f: Callable[[], Any]) -> dict[str, Any]:
    """One study, timed once after a short warm-up elsewhere."""
    wall, cpu = time.perf_counter(), time.process_time()
    f()
    return {
        "study": study,
        "jobs": jobs,
        "wall": time.perf_counter() - wall,
        "cpu": time.process_time() - cpu,
    }


def figures() -> list[dict[str, Any]]:
    """Seconds for each figure of the thesis with its data, kernels on disk; the second time where it is short."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in FIGURES:
            for _ in range(2):
                wall, cpu = time.perf_counter(), time.process_time()
                make(name, Path(folder), overwrite=True)
                found = {"wall": time.perf_counter() - wall, "cpu": time.process_time() - cpu}
                if found["cpu"] > LONG:
                    break
            rows.append({"figure": name, "chapter": chapter_of(name), "shows": FIGURES[name].about, **found})
    return rows


def lockstep() -> dict[str, Any]:
    """Time-stepping of many runs at once against one after another; and whether they agree bit for bit."""
    scene, m = cam_follower(rpm=358.5), 512
    method = Moreau(h=scene.period / 2000)
    starts = np.random.default_rng(0).uniform([0.1, -20.0], [1.0, 20.0], (m, 2))
    span = (0.0, scene.period)

    def singly() -> np.ndarray:
        runs = [
            simulate(replace(scene, q0=x[:1], v0=x[1:], t_span=span), method, keep=[span[1]])
            for x in starts[:64]
        ]
        return np.array([[r.q[-1, 0], r.v[-1, 0]] for r in runs])

    batch = lambda: periods(scene, method, starts, 1).states[:, 0]  # noqa: E731
    singly(), batch()
    _, slow, one_by_one = timed(singly)
    _, fast, together = timed(batch)
    return {
        "ns_per_step_single": 1e9 * slow / 64 / 2000,
        "ns_per_step_in_lockstep": 1e9 * fast / m / 2000,
        "equal_bits": bool(np.array_equal(one_by_one, together[:64])),
    }


def agreement(quick: bool) -> list[dict[str, Any]]:
    """Chaos at 660 rpm, and the window 690-735 rpm, by time-stepping against event-driven as h goes down."""
    chaotic, n = cam_follower(rpm=660.0), 800 if quick else 4000
    exact = sample(chaotic, EventDriven(), [0.4, 0.4], n)
    speeds = np.linspace(690.0, 735.0, 16)
    reference = first_impacts(bifurcation(cam_follower, "rpm", speeds, drop=300, keep=20))
    rows = []
    for h in (1e-3, 1e-4) if quick else (1e-3, 1e-4, 1e-5):
        found = likeness(sample(chaotic, Moreau(h=h), [0.4, 0.4], n), exact)
        window = first_impacts(
            bifurcation(cam_follower, "rpm", speeds, method=Moreau(h=h), x0=[1.33, -66.0], drop=300, keep=20)
        )
        rows.append(
            {"h": h, "window_phase_error": float(np.mean(np.abs(window - reference)))}
            | {name: [x.distance, x.low, x.high, x.p_value] for name, x in found.items()}
        )
    return rows


def first_impacts(data: Any) -> np.ndarray:
    """Mean phase of the first impact of a period, for each speed."""
    first = data["impact_number"].values == 1
    value, phase = data["impact_value"].values[first], data["impact_phase"].values[first]
    return np.bincount(value, phase) / np.bincount(value)


def report(r: dict[str, Any]) -> str:
    """The results as tables."""
    lines = [
        "# Studies of the cam-follower",
        "",
        f"{r['cores']} cores, load {r['load']:.1f} at the start.",
        "",
    ]
    lines += ["| event-driven run | impacts | microseconds of CPU per impact |", "|---|---|---|"]
    lines += [
        f"| {x['rpm']:g} rpm: {x['motion']} | {x['impacts']} | {x['microseconds']:.2f} |"
        for x in r["impacts"]
    ]
    lines += ["", "| study | threads | wall [s] | CPU [s] |", "|---|---|---|---|"]
    lines += [f"| {x['study']} | {x['jobs']} | {x['wall']:.1f} | {x['cpu']:.1f} |" for x in r["sweeps"]]
    lines += ["", "| figure of the thesis | shows | wall [s] | CPU [s] |", "|---|---|---|---|"]
    lines += [f"| {x['figure']} | {x['shows']} | {x['wall']:.1f} | {x['cpu']:.1f} |" for x in r["figures"]]
    for words, chapters in (("chapters 2 to 6", range(2, 7)), ("chapter 7", (7,))):
        part = [x for x in r["figures"] if x["chapter"] in chapters]
        wall, cpu = (sum(x[name] for x in part) for name in ("wall", "cpu"))
        lines.append(f"| all of {words} | | {wall:.1f} | {cpu:.1f} |")
    x = r["lockstep"]
    lines += [
        "", f"Time-stepping: {x['ns_per_step_single']:.1f} ns per step one run after another, "
        f"{x['ns_per_step_in_lockstep']:.1f} ns in lockstep (512 runs); equal bits: {x['equal_bits']}.", "",
        "Time-stepping against event-driven: mean difference of the phase of impact over 690-735 rpm (O(1, 1), in "
        "periods); at 660 rpm (chaotic) the distance of distributions [95 % interval], p: the probability of so "
        "large a distance between samples of one attractor.", "",
        "| h [s] | phase, 690-735 rpm | phase, 660 rpm | velocity, 660 rpm | impacts per period, 660 rpm |",
        "|---|---|---|---|---|",
    ]  # fmt: skip
    for x in r["agreement"]:
        cells = [x[name] for name in ("phase", "velocity", "impacts per period")]
        shown = " | ".join(f"{d:.4f} [{low:.4f}, {high:.4f}], p = {p:.3f}" for d, low, high, p in cells)
        lines.append(f"| {x['h']:g} | {x['window_phase_error']:.2e} | {shown} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    p = argparse.ArgumentParser(description=__doc__)
    p.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    p.add_argument("--quick", action="store_true", help="small grids, to see that it runs")
    p.add_argument("--only", nargs="+", choices=PARTS, default=PARTS, help="parts to measure (all)")
    options = p.parse_args()
    file = HERE / ("quick.json" if options.quick else "results.json")
    results = json.loads(file.read_text()) if set(options.only) != set(PARTS) else {}
    results |= {"cores": os.cpu_count(), "load": os.getloadavg()[0]}
    measure: dict[str, Callable[[], Any]] = {
        "impacts": impacts, "sweeps": lambda: sweeps(options.jobs, options.quick), "figures": figures,
        "lockstep": lockstep, "agreement": lambda: agreement(options.quick),
    }  # fmt: skip
    for name in options.only:
        results[name] = measure[name]()
        file.write_text(json.dumps(results, indent=1))
    file.with_suffix(".md").write_text(report(results))
    print(report(results))


if __name__ == "__main__":
    main()
