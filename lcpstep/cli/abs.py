"""`lcpstep abs`: the hybrid anti-lock controller, its cycle, multiplier, basins and bifurcation."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian.hybrid import HybridScene
from lagrangian.scenes.hybrid_abs import MODELS, ROADS, hybrid_abs
from lcpstep.analysis.abs_basins import Basins, allowed_bias, basins, margins
from lcpstep.analysis.abs_cycle import OUTCOMES, Cycle, NoCycle, limit_cycle, peak, stopping
from lcpstep.analysis.abs_parameters import bifurcation, edge, has_cycle, vanishing, with_thresholds
from lcpstep.cli import interrupt
from lcpstep.cli.common import DONE, FAILED, INTERRUPTED, save_figure, save_text
from lcpstep.errors import StudyInterrupted
from lcpstep.events import EventDriven
from lcpstep.files import replacing
from lcpstep.simulation import simulate
from lcpstep.trajectory import Status

THRESHOLDS = ("torque_max", "torque_min", "slip_max", "slip_min")
FILES = ("abs.json", "abs-basins.npz", "abs.png")
HIGHEST = 3.0  # torque thresholds looked at, in units of the cycle's own
MOST_TIME = 60.0  # of one stop [s]
FINE = 1e-9  # width of an edge [N m]


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "abs",
        help="limit cycle, multiplier, basins and bifurcation of the hybrid anti-lock controller",
        description="Computes the limit cycle of a quarter car under the four-state anti-lock controller, its "
        "multiplier by saltation matrices and by differences, the errors of measurement that it bears, where it "
        "vanishes as the torque threshold changes, and the basins for each starting state; --out DIR receives "
        "abs.json, abs-basins.npz and abs.png.",
        epilog="Example: lcpstep abs --road wet --torque-max 1000 --torque-min 630 --out out",
    )
    p.add_argument("--road", choices=list(ROADS), default="dry", help="(dry)")
    p.add_argument(
        "--model", choices=MODELS, default="slip",
        help="omega = v (1 - slip)/r (slip, the default), or constant; full: the speed is a state, one stop is run",
    )  # fmt: skip
    for name, value, unit in zip(
        THRESHOLDS, (1600.0, 1000.0, 0.35, 0.08), ("N m", "N m", "-", "-"), strict=True
    ):
        p.add_argument(f"--{name.replace('_', '-')}", type=float, default=value, help=f"[{unit}] ({value:g})")
    p.add_argument("--rate", type=float, default=1e4, help="of the torque [N m/s] (10000)")
    p.add_argument("--speed", type=float, default=30.0, help="of the car [m/s] (30)")
    p.add_argument("--crossing", action="store_true", help="switch only where a threshold is passed through")
    p.add_argument(
        "--grid", type=int, default=60, help="cells per axis of the basins; 0 leaves them out (60)"
    )
    p.add_argument("--torque-range", type=float, nargs=2, default=(0.0, 2500.0), metavar=("LOW", "HIGH"),
                   help="of the basins [N m] (0 2500)")  # fmt: skip
    p.add_argument(
        "--points", type=int, default=120, help="torque thresholds of the bifurcation diagram (120)"
    )
    p.add_argument("--out", type=Path, metavar="DIR", help="where the files go; default: nothing is saved")
    p.add_argument("--overwrite", action="store_true", help="write over files that exist")
    p.add_argument("--no-picture", action="store_true", help="leave the picture out")
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=run_abs)


def run_abs(options: argparse.Namespace) -> int:
    """`lcpstep abs`."""
    scene = _scene(options)
    if options.model == "full":
        return _run_stop(scene, options)
    cycle, result = _study(scene)
    _save(options, result)
    over = bifurcation(scene, _thresholds(result, options.points)) if cycle is not None else None
    if over is not None:
        result["bifurcation"] = over.as_dict()
    found, status = None, DONE
    if options.grid:
        found, status = _basins(scene, options)
        result["basins"] = {"outcomes": list(OUTCOMES), "shares": found.shares()}
    _save(options, result)
    if options.out is not None:
        if found is not None:
            names = np.array(OUTCOMES)
            with replacing(options.out / FILES[1]) as draft:
                np.savez_compressed(
                    draft, slip=found.slip, torque=found.torque, labels=found.labels, outcomes=names
                )
        if not options.no_picture:
            from lcpstep.plot.abs_cycle import overview

            title = f"hybrid anti-lock controller, {options.road} road, model {options.model!r}"
            save_figure(overview(scene, cycle, over, found, title), options.out / FILES[2])
    print(json.dumps(result, indent=1) if options.json else _text(result))
    _tell_files(options)
    return status


def _run_stop(scene: HybridScene, options: argparse.Namespace) -> int:
    """Braking with the speed as a state, until the car stands or MOST_TIME has passed."""
    run = simulate(scene, EventDriven())
    stop = stopping(run)
    _save(options, stop)
    if options.out is not None and not options.no_picture:
        from lcpstep.plot.abs_cycle import stopping as draw

        title = f"hybrid anti-lock controller, {options.road} road, full model"
        save_figure(draw(run, title), options.out / FILES[2])
    if options.json:
        print(json.dumps(stop, indent=1))
    else:
        print(f"{options.road} road, full model: {run.status.name}, {stop['end']} after {stop['time']:.9f} s, "
              f"{stop['distance']:.6f} m, at {stop['speed']:.6g} m/s; the wheel "
              + ("never locks" if stop["locked"] is None else f"locks at {stop['locked']:.9f} s"))  # fmt: skip
        for line in stop["switches"]:
            print(f"  {line['time']:.9f} s: enters {line['state']}, slip {line['slip']:.9f}, "
                  f"torque {line['torque']:.6f} N m, speed {line['speed']:.6f} m/s")  # fmt: skip
    _tell_files(options)
    return DONE if run.status == Status.DONE else FAILED


def _scene(options: argparse.Namespace) -> HybridScene:
    if options.grid < 0 or options.grid == 1:
        raise ValueError(f"--grid: expected at least 2 cells, or 0 for no basins, got {options.grid}")
    if options.points < 2:
        raise ValueError(f"--points: expected at least 2, got {options.points}")
    low, high = options.torque_range
    if not 0.0 <= low < high:
        raise ValueError(f"--torque-range: expected 0 <= LOW < HIGH, got {low:g} {high:g}")
    if options.out is not None and not options.overwrite:
        for name in FILES:
            if (options.out / name).exists():
                raise FileExistsError(
                    f"--out: {options.out / name} exists already; --overwrite writes over it"
                )
    values = {name: getattr(options, name) for name in THRESHOLDS}
    return hybrid_abs(
        options.road,
        options.model,
        rate=options.rate,
        speed=options.speed,
        crossing=options.crossing,
        t_end=MOST_TIME,
        **values,
    )


def _study(scene: HybridScene) -> tuple[Cycle | None, dict[str, Any]]:
    """The cycle, and all that is known of it but its basins."""
    slip, top = peak(scene)
    result: dict[str, Any] = {"parameters": dict(scene.parameters), "peak": {"slip": slip, "torque": top}}
    try:
        cycle = limit_cycle(scene)
    except NoCycle as none:
        return None, result | {"cycle": None, "why": str(none)}

    def exists(T: float) -> bool:
        return has_cycle(with_thresholds(scene, torque_max=T))

    now = float(scene.parameters["torque_max"])
    ends = [T for T in np.linspace(now, HIGHEST * now, 101)[1:] if not exists(float(T))]
    return cycle, result | {
        "cycle": cycle.as_dict(),
        "vanishes_below": vanishing(scene),
        "vanishes_above": edge(exists, now, float(ends[0]), FINE) if ends else None,
        "margins": [vars(margin) for margin in margins(scene, cycle)],
        "allowed_bias": {quantity: allowed_bias(scene, quantity) for quantity in ("slip", "torque")},
    }


def _thresholds(result: dict[str, Any], points: int) -> list[float]:
    """Torque thresholds from where the cycle vanishes to where it is lost, closer together near the former."""
    low = result["vanishes_below"]
    high = result["vanishes_above"] or HIGHEST * result["parameters"]["torque_max"]
    return [float(low + (high - low) * s * s) for s in np.linspace(0.02, 1.0 - 1e-9, points)]


def _basins(scene: HybridScene, options: argparse.Namespace) -> tuple[Basins, int]:
    from tqdm import tqdm

    n = options.grid
    slip, torque = ((np.arange(n) + 0.5) / n * (b - a) + a for a, b in ((0.0, 1.0), options.torque_range))
    with tqdm(total=4 * n, desc="basins", disable=None, leave=False) as bar:
        try:
            return basins(scene, slip, torque, lambda done: bar.update(done - bar.n)), DONE
        except StudyInterrupted as stopped:
            interrupt.answer()
            return stopped.study, INTERRUPTED


def _save(options: argparse.Namespace, result: dict[str, Any]) -> None:
    if options.out is not None:
        save_text(json.dumps(result, indent=1), options.out / FILES[0])


def _tell_files(options: argparse.Namespace) -> None:
    """What has been written to --out, for who reads the text."""
    with_basins = options.grid > 0 and options.model != "full"
    if options.out is not None and not options.json:
        for name, made in zip(FILES, (True, with_basins, not options.no_picture), strict=True):
            if made:
                print(f"wrote {options.out / name}")


def _text(result: dict[str, Any]) -> str:
    p, top = result["parameters"], result["peak"]
    lines = [
        f"{p['road']} road, model {p['model']!r}: max Psi = {top['torque']:.11f} N m at slip {top['slip']:.14f}"
    ]
    cycle = result["cycle"]
    if cycle is None:
        lines.append(result["why"])
    else:
        lines.append(f"limit cycle of period {cycle['period']:.12f} s")
        for state, t, slip, torque in zip(
            *(cycle[k] for k in ("states", "times", "slip", "torque")), strict=True
        ):
            lines.append(f"  enters {state} at {t:.12f} s, slip {slip:.12f}, torque {torque:.6f} N m")
        lines.append(f"  slip {cycle['slip_range'][0]:.9f} .. {cycle['slip_range'][1]:.9f}")
        lines.append(
            f"  multiplier {cycle['multiplier']:.1e} by saltation matrices, "
            f"{cycle['multiplier_by_differences']:.1e} by differences"
        )
        above = result["vanishes_above"]
        lines.append(
            f"it exists from T_max = {result['vanishes_below']:.9f} "
            + (f"to {above:.9f} N m" if above else "N m on")
        )
        for m in result["margins"]:
            down, up = ("any" if m[k] is None else f"{m[k]:.6f}" for k in ("down", "up"))
            lines.append(f"  allowed error of the slip entering {m['state']}: down {down}, up {up}")
        for name, (low, high) in result["allowed_bias"].items():
            edges = ("any" if x is None else f"{x:+.6g}" for x in (low, high))
            lines.append(f"  allowed constant error of the measured {name}: {' .. '.join(edges)}")
    for q, shares in result.get("basins", {}).get("shares", {}).items():
        lines.append(
            f"basins from state {q}: " + ", ".join(f"{name} {x:.4f}" for name, x in shares.items() if x)
        )
    return "\n".join(lines)
