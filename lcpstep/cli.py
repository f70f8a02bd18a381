"""The command `lcpstep`: compare both methods, run one, list the scenes.

Exit status: 0 done; 1 a run ended early, and its status says why; 2 a wrong argument; 130 interrupted.
"""

from __future__ import annotations

import argparse
import inspect
import json
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import Scene
from lagrangian.scenes import CATALOGUE
from lagrangian.scenes.cam_follower import HALF_TURN, PROFILE
from lcpstep import EventDriven, Moreau, __version__, simulate
from lcpstep.compare import Comparison, compare
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted, UnknownName
from lcpstep.maps import Sections, sections
from lcpstep.simulate import Method
from lcpstep.trajectory import Kind, Status, Trajectory

DONE, FAILED, USAGE, INTERRUPTED = 0, 1, 2, 130
CENTIMETRE = 0.01  # the distance at which two motions no longer count as the same [m]
DROPPED = 0.1  # share of the periods of a map that is transient


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; returns the exit status."""
    options = parser().parse_args(arguments)
    try:
        return int(options.run(options))
    except (SimulationInterrupted, KeyboardInterrupt):
        print("lcpstep: interrupted", file=sys.stderr)
        return INTERRUPTED
    except SimulationError as error:
        print(f"lcpstep: {error}", file=sys.stderr)
        return FAILED
    except (LcpStepError, ValueError, FileExistsError) as error:
        print(f"lcpstep: {error}", file=sys.stderr)
        return USAGE


def parser() -> argparse.ArgumentParser:
    """Arguments of the command line."""
    top = argparse.ArgumentParser(
        prog="lcpstep",
        description="Mechanical systems with impacts: time-stepping and event-driven simulation.",
        epilog="Start with: lcpstep compare cam-follower",
    )
    top.add_argument("--version", action="version", version=f"lcpstep {__version__}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    _compare_parser(commands)
    _simulate_parser(commands)
    listing = commands.add_parser("scenes", help="list the scenes, one line each, with their parameters")
    listing.add_argument("--json", action="store_true", help="print JSON")
    listing.set_defaults(run=run_scenes)
    return top


def _compare_parser(commands: Any) -> None:
    p = commands.add_parser(
        "compare",
        help="run a scene by time-stepping and event by event, and compare",
        description="Runs a scene by Moreau time-stepping and by the event-driven integrator; prints steps, "
        "impacts, wall time and the error of the former against the latter, and draws both.",
        epilog="Example: lcpstep compare cam-follower --rpm 358 660 700 --h 1e-4 --t-end 2 --out out",
    )
    _scene_arguments(p)
    p.add_argument(
        "--rpm",
        type=float,
        nargs="+",
        metavar="N",
        help="cam speeds; default for the cam-follower: 358 660 700",
    )
    _stepping_arguments(p)
    p.add_argument(
        "--tolerance", type=float, default=1e-12, help="rtol and atol of the event-driven run (1e-12)"
    )
    p.add_argument(
        "--map-rpm", type=float, default=660.0, help="speed of the impact and stroboscopic maps (660 rpm)"
    )
    p.add_argument("--map-periods", type=int, default=3000, help="periods in these maps; 0: none (3000)")
    p.add_argument("--out", type=Path, default=Path("out"), metavar="DIR", help="where the pictures go (out)")
    p.add_argument("--no-pictures", action="store_true", help="print the table only")
    p.add_argument("--json", action="store_true", help="print JSON in place of the table")
    p.set_defaults(run=run_compare)


def _simulate_parser(commands: Any) -> None:
    p = commands.add_parser(
        "simulate",
        help="run one scene and save its motion",
        description="Runs a scene and prints how it went; --out FILE.npz saves t, q, v, impulse and impacts.",
        epilog="Example: lcpstep simulate bouncing-ball --method event-driven --set restitution=0.5 --out ball.npz",
    )
    _scene_arguments(p)
    p.add_argument("--method", choices=["moreau", "event-driven"], default="moreau", help="(moreau)")
    _stepping_arguments(p)
    p.add_argument("--tolerance", type=float, default=1e-12, help="rtol and atol, event-driven only (1e-12)")
    p.add_argument("--every", type=int, default=1, metavar="K", help="keep every K-th step (1)")
    p.add_argument("--out", type=Path, metavar="FILE", help="save the motion (.npz)")
    p.add_argument("--picture", type=Path, metavar="FILE", help="draw the motion (.png, .pdf, .svg)")
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=run_simulate)


def _scene_arguments(p: argparse.ArgumentParser) -> None:
    p.add_argument("scene", metavar="SCENE", help=f"one of: {', '.join(CATALOGUE)} (see: lcpstep scenes)")
    p.add_argument("--t-end", type=float, help="length of the simulation [s]; default: the scene's own")
    p.add_argument(
        "--set",
        nargs="+",
        default=[],
        metavar="NAME=VALUE",
        help="parameters of the scene, see: lcpstep scenes",
    )


def _stepping_arguments(p: argparse.ArgumentParser) -> None:
    p.add_argument("--h", type=float, default=1e-4, help="step of the time-stepping [s] (1e-4)")
    p.add_argument("--theta", type=float, default=0.5, help="0 explicit, 0.5 trapezoidal, 1 implicit (0.5)")
    p.add_argument("--lcp", default="lemke", help="complementarity solver: lemke, qp, qp:daqp, ... (lemke)")


# --- commands -------------------------------------------------------------------------------------------------


def run_scenes(options: argparse.Namespace) -> int:
    """`lcpstep scenes`."""
    lines: list[dict[str, Any]] = [
        {"scene": name, "about": (inspect.getdoc(make) or "").splitlines()[0], "parameters": _defaults(make)}
        for name, make in CATALOGUE.items()
    ]
    if options.json:
        print(json.dumps(lines, indent=2))
        return DONE
    for line in lines:
        print(f"{line['scene']:20} {line['about']}")
        print(" " * 21 + ", ".join(f"{k}={v}" for k, v in line["parameters"].items()))
    return DONE


def run_simulate(options: argparse.Namespace) -> int:
    """`lcpstep simulate`."""
    scene = _scene(options)
    method = _method(options) if options.method == "moreau" else _reference(options)
    if options.out and options.out.exists():
        raise FileExistsError(f"--out: {options.out} exists already")
    try:
        with progress_bar(scene, options.method) as progress:
            run = simulate(scene, method, keep=options.every, progress=progress)
    except (SimulationError, SimulationInterrupted) as stopped:
        _save(options.out, stopped.trajectory)
        raise
    _save(options.out, run)
    if options.picture:
        from lcpstep.plot.motion import overview

        overview(run).savefig(options.picture, dpi=150)
    print(json.dumps(_summary(run), indent=2) if options.json else _sentence(run))
    return DONE if run.status == Status.DONE else FAILED


def run_compare(options: argparse.Namespace) -> int:
    """`lcpstep compare`."""
    cam = options.scene == "cam-follower"
    if options.rpm and not cam:
        raise ValueError("--rpm: only the cam-follower turns")
    speeds = (options.rpm or [358.0, 660.0, 700.0]) if cam else [None]
    results: list[tuple[str, Comparison]] = []
    for rpm in speeds:
        scene = _scene(options, **({} if rpm is None else {"rpm": rpm}))
        title = scene.name if rpm is None else f"{rpm:g} rpm"
        with progress_bar(scene, title) as progress:
            results.append((title, compare(scene, _method(options), _reference(options), progress)))
    table = [_row(title, c) for title, c in results]
    maps = {} if options.no_pictures or not cam or options.map_periods < 1 else _maps(options)
    pictures = [] if options.no_pictures else _draw(options, results, maps)
    if options.json:
        print(json.dumps({"comparisons": table, "pictures": [str(x) for x in pictures]}, indent=2))
    else:
        print(_table(table))
        for picture in pictures:
            print(f"wrote {picture}")
    ok = all(r.trajectory.status == Status.DONE for _, c in results for r in (c.fast, c.reference))
    return DONE if ok else FAILED


# --- questions and methods from the options -------------------------------------------------------------------


def _scene(options: argparse.Namespace, **more: Any) -> Scene:
    if options.scene not in CATALOGUE:
        raise UnknownName("scene", options.scene, CATALOGUE)
    make = CATALOGUE[options.scene]
    known = _defaults(make)
    values = dict(more)
    for setting in options.set:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set: expected NAME=VALUE, got {setting!r}")
        if name not in known:
            raise UnknownName(f"parameter of {options.scene}", name, known)
        values[name] = value if isinstance(known[name], str) else _number(name, value)
    if options.t_end is not None:
        values["t_end"] = options.t_end
    return make(**values)


def _defaults(make: Callable[..., Scene]) -> dict[str, Any]:
    parameters = inspect.signature(make).parameters.values()
    return {p.name: p.default for p in parameters if isinstance(p.default, (int, float, str))}


def _number(name: str, value: str) -> float:
    try:
        return float(value)
    except ValueError:
        raise ValueError(f"--set: {name}: expected a number, got {value!r}") from None


def _method(options: argparse.Namespace) -> Moreau:
    return Moreau(h=options.h, theta=options.theta, lcp=options.lcp)


def _reference(options: argparse.Namespace) -> EventDriven:
    return EventDriven(rtol=options.tolerance, atol=options.tolerance)


@contextmanager
def progress_bar(scene: Scene, title: str) -> Iterator[Callable[[float], None]]:
    """A bar over the scene's time span, on a terminal only."""
    from tqdm import tqdm

    t_start, t_end = scene.t_span
    form = "{desc}: {percentage:3.0f}% |{bar}| {n:.3g}/{total:.3g} s [{elapsed}<{remaining}]"
    with tqdm(total=t_end - t_start, desc=title, bar_format=form, disable=None, leave=False) as bar:

        def progress(t: float) -> None:
            bar.n = t - t_start
            bar.refresh()

        yield progress


# --- answers --------------------------------------------------------------------------------------------------


def _summary(run: Trajectory) -> dict[str, Any]:
    kinds = {kind.name.lower(): int(np.sum(run.impacts.kind == kind)) for kind in Kind}
    return {
        "scene": run.scene.name,
        "parameters": dict(run.scene.parameters),
        "method": repr(run.method),
        "status": run.status.name,
        "message": run.message,
        "t_end": float(run.t[-1]),
        "q_end": run.q[-1].tolist(),
        "v_end": run.v[-1].tolist(),
        "steps": run.counts.steps,
        "lcp_calls": run.counts.lcp_calls,
        "force_evaluations": run.counts.force_evaluations,
        "events": kinds,
    }


def _sentence(run: Trajectory) -> str:
    s = _summary(run)
    events = ", ".join(f"{n} {kind}" for kind, n in s["events"].items())
    return (
        f"{s['scene']} by {s['method']}: {s['status']}, {s['message']}\n"
        f"t = {s['t_end']:g} s, q = {s['q_end']}, v = {s['v_end']}\n"
        f"{s['steps']} steps, {s['lcp_calls']} complementarity problems; events: {events}"
    )


def _save(file: Path | None, run: Trajectory) -> None:
    if file is not None:
        log = np.asarray(run.impacts)
        np.savez_compressed(
            file,
            t=run.t,
            q=run.q,
            v=run.v,
            impulse=run.impulse,
            impacts=log,
            summary=json.dumps(_summary(run)),
        )


def _row(title: str, c: Comparison) -> dict[str, Any]:
    fast, exact = c.fast.trajectory, c.reference.trajectory
    return {
        "case": title,
        "status": [fast.status.name, exact.status.name],
        "steps": [fast.counts.steps, exact.counts.steps],
        "impacts": [len(c.fast.impacts), len(c.reference.impacts)],
        "seconds": [c.fast.seconds, c.reference.seconds],
        "sup_q": c.sup_q,
        "l1_q": c.l1_q,
        "l1_v": c.l1_v,
        "first_impacts": c.first_impacts.tolist(),
        "agree_until": c.agree_until(CENTIMETRE),
    }


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
        lines += [f"{'':14}{s}" for s in r["status"] if s != "DONE"]
    return "\n".join(lines)


def _maps(options: argparse.Namespace) -> dict[str, Sections]:
    """Impact and stroboscopic maps of the cam-follower from both methods."""
    scene = _scene(options, rpm=options.map_rpm)
    periods = options.map_periods
    found: dict[str, Sections] = {}
    methods: dict[str, Method] = {"time-stepping": _method(options), "event-driven": _reference(options)}
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
        corner = PROFILE.arcs[1].end  # where the flank meets the nose
        title = f"cam-follower at {options.map_rpm:g} rpm, {options.map_periods} periods"
        figures[f"maps-{options.map_rpm:g}-rpm.png"] = maps(found, title, HALF_TURN, corner)
    options.out.mkdir(parents=True, exist_ok=True)
    for name, figure in figures.items():
        figure.savefig(options.out / name, dpi=150)
    return [options.out / name for name in figures]


if __name__ == "__main__":
    sys.exit(main())
