"""`lcpstep compare`: a scene by time-stepping and event by event, side by side."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from lcpstep.cli.common import (
    DONE,
    FAILED,
    event_driven,
    moreau,
    progress_bar,
    save_figure,
    scene_arguments,
    scene_with_contacts,
    stepping_arguments,
)
from lcpstep.compare import Comparison, compare
from lcpstep.errorbar.estimate import error_bar
from lcpstep.maps import Sections, sections
from lcpstep.simulation import Method
from lcpstep.trajectory import Status

CENTIMETRE = 0.01  # the distance at which two motions no longer count as the same [m]
FLANK_NOSE = 1  # the corner of the cam at which the thesis cuts the circle of phases (Fig 3.6)
DROPPED = 0.1  # share of the periods of a map that is transient


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "compare",
        help="run a scene by time-stepping and event by event, and compare",
        description="Runs a scene by Moreau time-stepping and by the event-driven integrator; prints steps, "
        "impacts, wall time and the error of the former against the latter, and draws both.",
        epilog="Example: lcpstep compare cam-follower --rpm 358 660 700 --h 1e-4 --t-end 2 --out out",
    )
    scene_arguments(p)
    p.add_argument(
        "--rpm",
        type=float,
        nargs="+",
        metavar="N",
        help="cam speeds; default for the cam-follower: 358 660 700",
    )
    stepping_arguments(p)
    p.add_argument(
        "--tolerance", type=float, default=1e-12, help="rtol and atol of the event-driven run (1e-12)"
    )
    p.add_argument(
        "--map-rpm", type=float, default=660.0, help="speed of the impact and stroboscopic maps (660 rpm)"
    )
    p.add_argument("--map-periods", type=int, default=3000, help="periods in these maps; 0: none (3000)")
    p.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="where the pictures go (out)")
    p.add_argument("--no-pictures", action="store_true", help="print the table only")
    p.add_argument(
        "--error", action="store_true", help="error bars of both runs, each by a run of another method"
    )
    p.add_argument("--json", action="store_true", help="print JSON in place of the table")
    p.set_defaults(run=run_compare)


def run_compare(options: argparse.Namespace) -> int:
    """`lcpstep compare`."""
    cam = options.scene == "cam-follower"
    if options.rpm and not cam:
        raise ValueError("--rpm: only the cam-follower turns")
    speeds = (options.rpm or [358.0, 660.0, 700.0]) if cam else [None]
    results: list[tuple[str, Comparison]] = []
    for rpm in speeds:
        scene = scene_with_contacts(options, **({} if rpm is None else {"rpm": rpm}))
        title = scene.name if rpm is None else f"{rpm:g} rpm"
        with progress_bar(scene, title) as progress:
            results.append((title, compare(scene, moreau(options), event_driven(options), progress)))
    table = [_row(title, c) | (_bars(c) if options.error else {}) for title, c in results]
    maps = {} if options.no_pictures or not cam or options.map_periods < 1 else _maps(options)
    pictures = [] if options.no_pictures else _draw(options, results, maps)
    if options.json:
        print(json.dumps({"comparisons": table, "pictures": [str(x) for x in pictures]}, indent=2))
    else:
        print(_table(table))
        for picture in pictures:
            print(f"wrote {picture}")
    runs = [r.trajectory for _, c in results for r in (c.fast, c.reference)]
    ok = all(run.status == Status.DONE and not run.doubt for run in runs)
    return DONE if ok else FAILED


def _row(title: str, c: Comparison) -> dict[str, Any]:
    fast, exact = c.fast.trajectory, c.reference.trajectory
    return {
        "case": title,
        "status": [fast.status.name, exact.status.name],
        "doubt": [x for x in (fast.doubt, exact.doubt) if x],
        "steps": [fast.counts.steps, exact.counts.steps],
        "impacts": [len(c.fast.impacts), len(c.reference.impacts)],
        "seconds": [c.fast.seconds, c.reference.seconds],
        "sup_q": c.sup_q,
        "l1_q": c.l1_q,
        "l1_v": c.l1_v,
        "first_impacts": c.first_impacts.tolist(),
        "agree_until": c.agree_until(CENTIMETRE),
    }


def _bars(c: Comparison) -> dict[str, Any]:
    """Error bars of the fast run and of the reference."""
    bars = [error_bar(x.trajectory, True, x.seconds) for x in (c.fast, c.reference)]
    return {"error": [bar.as_dict() for bar in bars], "error_in_words": [str(bar) for bar in bars]}


def _table(rows: list[dict[str, Any]]) -> str:
    """Two columns a quantity, time-stepping | event-driven, then the errors of the former."""
    head = (
        f"{'':14}{'steps':>15}{'impacts':>11}{'wall time [ms]':>18}   {'sup|dq|':>9}{'L1 dq':>9}{'L1 dv':>9}"
        f"   {'first impacts: error [s]':32}{'apart by 1 cm':>14}\n"
        f"{'':14}{'step | event':>15}{'step|event':>11}{'step | event':>18}   {'[m]':>9}{'[m s]':>9}{'[m]':>9}"
    )
    lines = [head]
    for r in rows:
        first = " ".join(f"{x:+.1e}" for x in r["first_impacts"])
        ms = [1e3 * x for x in r["seconds"]]
        lines.append(
            f"{r['case']:14}{r['steps'][0]:>7} | {r['steps'][1]:<5}{r['impacts'][0]:>6}|{r['impacts'][1]:<4}"
            f"{ms[0]:>9.2f} | {ms[1]:<6.2f}   {r['sup_q']:9.1e}{r['l1_q']:9.1e}{r['l1_v']:9.1e}"
            f"   {first:32}{r['agree_until']:>10.4f} s"
        )
        lines += [f"{'':14}{s}" for s in (*r["status"], *r["doubt"]) if s != "DONE"]
        bars = zip(("step", "event"), r.get("error_in_words", ()), strict=False)
        lines += [f"{'':14}error bar, {name}: {text}" for name, text in bars]
    return "\n".join(lines)


def _maps(options: argparse.Namespace) -> dict[str, Sections]:
    """Impact and stroboscopic maps of the cam-follower from both methods."""
    scene = scene_with_contacts(options, rpm=options.map_rpm)
    periods = options.map_periods
    found: dict[str, Sections] = {}
    methods: dict[str, Method] = {"time-stepping": moreau(options), "event-driven": event_driven(options)}
    for name, method in methods.items():
        with progress_bar(scene, f"maps, {name}") as progress:
            found[name] = sections(scene, method, periods, math.ceil(DROPPED * periods), progress)
    return found


def _draw(
    options: argparse.Namespace, results: list[tuple[str, Comparison]], found: dict[str, Sections]
) -> list[Path]:
    from lcpstep.plot.motion import portraits, time_series
    from lcpstep.plot.sections import maps

    titles, comparisons = zip(*results, strict=True)
    figures = {
        "time-series.png": time_series(comparisons, titles),
        "state-space.png": portraits(comparisons, titles),
    }
    if found:
        scene = scene_with_contacts(options, rpm=options.map_rpm)
        corners = [float(c) / scene.period for c in np.asarray(scene.corners)]
        title = f"cam-follower at {options.map_rpm:g} rpm, {options.map_periods} periods"
        figures[f"maps-{options.map_rpm:g}-rpm.png"] = maps(found, title, corners[FLANK_NOSE], corners)
    options.out.mkdir(parents=True, exist_ok=True)
    for name, figure in figures.items():
        save_figure(figure, options.out / name)
    return [options.out / name for name in figures]
