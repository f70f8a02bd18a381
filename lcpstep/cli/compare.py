"""`lcpstep compare`: a scene by every method, side by side: what each costs, how far off it is, how to read it."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.accuracy.contest import Contest, Entrant, contest
from lcpstep.cli.common import (
    DONE,
    FAILED,
    event_driven,
    moreau,
    progress_bar,
    save_figure,
    scene_arguments,
    scene_with_contacts,
    step,
    stepping_arguments,
)
from lcpstep.errorbar.estimate import error_bar
from lcpstep.maps import Sections, sections
from lcpstep.simulation import Method
from lcpstep.stepping.located import Located
from lcpstep.trajectory import Status

APART = 0.01  # the distance at which two motions no longer count as the same, in the unit of the coordinates
FLANK_NOSE = 1  # the corner of the cam at which the thesis cuts the circle of phases (Fig 3.6)
DROPPED = 0.1  # share of the periods of a map that is transient
LOST = 0.1  # of the motion's size: an error that a chaotic motion has blown up


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "compare",
        help="run a scene by every method: error, CPU time, impacts",
        description="Runs a scene by Moreau time-stepping, by steps with located impacts of order 2 and 4, and event "
        "by event; prints error, CPU time and impacts of each against the motion in closed form or a tighter "
        "event-driven run, and draws motions, errors, and what accuracy costs.",
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
        "--error", action="store_true", help="error bars of all runs, each by a run of another method"
    )
    p.add_argument("--json", action="store_true", help="print JSON in place of the table")
    p.set_defaults(run=run_compare)


def run_compare(options: argparse.Namespace) -> int:
    """`lcpstep compare`."""
    cam = options.scene == "cam-follower"
    if options.rpm and not cam:
        raise ValueError("--rpm: only the cam-follower turns")
    speeds = (options.rpm or [358.0, 660.0, 700.0]) if cam else [None]
    results: list[tuple[str, Contest]] = []
    for rpm in speeds:
        scene = scene_with_contacts(options, **({} if rpm is None else {"rpm": rpm}))
        title = scene.name if rpm is None else f"{rpm:g} rpm"
        with progress_bar(scene, title) as progress:
            results.append((title, contest(scene, _methods(options, scene), progress)))
    maps = {} if options.no_pictures or not cam or options.map_periods < 1 else _maps(options)
    pictures = [] if options.no_pictures else _draw(options, results, maps)
    if options.json:
        cases = [_case(title, found, options.error) for title, found in results]
        print(json.dumps({"comparisons": cases, "pictures": [str(x) for x in pictures]}, indent=2))
    else:
        print(
            "\n".join(
                [
                    _table(results, options.error),
                    "",
                    *_reading(results, bool(maps)),
                    "",
                    *_next(options, pictures),
                ]
            )
        )
    runs = [x.run for _, found in results for x in found.entrants if x.run is not None]
    return DONE if all(run.status == Status.DONE and not run.doubt for run in runs) else FAILED


def _methods(options: argparse.Namespace, scene: Scene) -> list[Method]:
    """The methods that are compared, at the step and the tolerance of the options."""
    h = step(options, scene)
    return [moreau(options, scene), Located(h), Located(h, order=4), event_driven(options)]


def _case(title: str, found: Contest, bars: bool) -> dict[str, Any]:
    return {
        "case": title,
        "reference": found.reference,
        "methods": [_row(found, x) | (_bar(x) if bars else {}) for x in found.entrants],
    }


def _bar(x: Entrant) -> dict[str, Any]:
    """The error bar of a run."""
    bar = error_bar(x.run, False, x.seconds) if x.run is not None else None
    return {} if bar is None else {"error_bar": bar.as_dict(), "error_bar_in_words": str(bar)}


def _row(found: Contest, x: Entrant) -> dict[str, Any]:
    """What the table says of one method."""
    if x.run is None:
        return {"method": x.name, "refused": x.reason}
    return {
        "method": x.name,
        "settings": repr(x.method),
        "status": x.run.status.name,
        "doubt": x.run.doubt,
        "steps": x.run.counts.steps,
        "impacts": len(x.impacts),
        "cpu_seconds": x.seconds,
        "error": x.error,
        "first_impacts_off": found.first_impacts_off(x),
        "agrees_until": x.agrees_until(APART),
        "levels": [{"value": y.value, "error": y.error, "cpu_seconds": y.seconds} for y in x.levels],
    }


def _table(results: list[tuple[str, Contest]], bars: bool) -> str:
    """A block for each case, a line for each method."""
    width = max(len(x.name) for _, found in results for x in found.entrants) + 2
    unit = {found.unit for _, found in results}.pop()
    head = f"{'method':{width}}{'error':>12}{'CPU time':>12}{'impacts':>9}{'steps':>9}"
    head += f"{'first impacts':>15}{'apart by 0.01':>15}"
    units = f"{'':{width}}{f'[{unit}]':>12}{'[ms]':>12}{'':18}{'off by [s]':>15}{'from [s] on':>15}"
    lines = [head, units]
    for title, found in results:
        end = float(found.t[-1])
        lines.append(f"{title}: {found.t[0]:g} .. {end:g} s; reference: {found.reference}")
        for x in found.entrants:
            r = _row(found, x)
            if x.run is None:
                lines.append(f"{x.name:{width}}left out: {x.reason}")
                continue
            off = "" if r["first_impacts_off"] is None else f"{r['first_impacts_off']:.1e}"
            apart = f"{r['agrees_until']:.4f}" if x.error > APART else "never"
            lines.append(
                f"{x.name:{width}}{r['error']:>12.1e}{1e3 * r['cpu_seconds']:>12.2f}{r['impacts']:>9}{r['steps']:>9}"
                f"{off:>15}{apart:>15}"
            )
            lines += [f"{'':{width}}{s}" for s in (r["status"], r["doubt"]) if s not in ("DONE", "")]
            if bars:
                lines.append(f"{'':{width}}error bar: {_bar(x)['error_bar_in_words']}")
    return "\n".join(lines)


def _reading(results: list[tuple[str, Contest]], maps: bool) -> list[str]:
    """Three sentences on what the table says."""
    lost = [title for title, found in results if _worst(found) > LOST * float(np.max(np.abs(found.q)))]
    title, found = min(results, key=lambda result: _worst(result[1]))
    ran = {x.name: x for x in found.runs}
    moreau_, event = (
        next((x for n, x in ran.items() if n.startswith(k)), None) for k in ("Moreau", "EventDriven")
    )
    first = "Moreau moves every impact to the end of its step, and its error falls only as the step does"
    if moreau_ is not None:
        first += f": {_reached(moreau_, found)}{f' at {title}' if len(results) > 1 else ''}"
    second = (
        "Located puts every impact at its own time within the step and keeps order 2 or 4 through impacts"
    )
    said = [
        f"{_reached(x, found)} by order {x.method.order}" for n, x in ran.items() if n.startswith("Located")
    ]
    second += f": at the same step {' and '.join(said)}" if said else ", and does not treat this scene"
    third = "EventDriven goes from impact to impact and is the reference while these are few"
    third += f": {_reached(event, found)}" if event is not None else ", and does not treat this scene"
    if lost and len(results) > 1:
        advice = "compare the attractors in the maps" if maps else "compare statistics of them"
        third += f"; where small errors grow ({', '.join(lost)}) motions part sooner or later: {advice}"
    return [f"{sentence}." for sentence in (first, second, third)]


def _worst(found: Contest) -> float:
    return max((x.error for x in found.runs), default=0.0)


def _reached(x: Entrant, found: Contest) -> str:
    return f"{x.error:.1e} {found.unit} off in {1e3 * x.seconds:.2g} ms"


def _next(options: argparse.Namespace, pictures: list[Path]) -> list[str]:
    """Where the pictures are, and what to try."""
    lines = [f"wrote {picture}" for picture in pictures]
    name = options.scene
    lines.append(
        f"Try next: lcpstep simulate {name} --method located --film {Path(name).stem}.gif    the motion as a film"
    )
    lines.append(f"          lcpstep study {name}    errors and orders, averaged over nearby steps")
    if name == "cam-follower":
        lines.append(f"          lcpstep attractor {name} --rpm 358.5    what motions settle to")
    return lines


def _maps(options: argparse.Namespace) -> dict[str, Sections]:
    """Impact and stroboscopic maps of the cam-follower: by located impacts, and event by event."""
    scene = scene_with_contacts(options, rpm=options.map_rpm)
    periods = options.map_periods
    found: dict[str, Sections] = {}
    methods: dict[str, Method] = {
        "Located, order 2": Located(step(options, scene)),
        "event-driven": event_driven(options),
    }
    for name, method in methods.items():
        with progress_bar(scene, f"maps, {name}") as progress:
            found[name] = sections(scene, method, periods, math.ceil(DROPPED * periods), progress)
    return found


def _draw(
    options: argparse.Namespace, results: list[tuple[str, Contest]], found: dict[str, Sections]
) -> list[Path]:
    from lcpstep.plot.contest import contests
    from lcpstep.plot.sections import maps

    titles, compared = zip(*results, strict=True)
    figures = {"comparison.png": contests(compared, titles)}
    if found:
        scene = scene_with_contacts(options, rpm=options.map_rpm)
        corners = [float(c) / scene.period for c in np.asarray(scene.corners)]
        title = f"cam-follower at {options.map_rpm:g} rpm, {options.map_periods} periods"
        figures[f"maps-{options.map_rpm:g}-rpm.png"] = maps(found, title, corners[FLANK_NOSE], corners)
    for name, figure in figures.items():
        save_figure(figure, options.out / name)
    return [options.out / name for name in figures]
