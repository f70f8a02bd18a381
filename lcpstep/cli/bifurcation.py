"""`lcpstep bifurcation`: brute-force bifurcation diagrams."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep import Moreau, dataset
from lcpstep.analysis.agreement import Summary, agreement, summary, tolerance_of_stepping
from lcpstep.analysis.bifurcation import IMPACTS_RECORDED, STARTS, WINDOWS, bifurcation
from lcpstep.cli.attractor import box
from lcpstep.cli.common import DONE, making, parameters_of, vary
from lcpstep.cli.studies import (
    PARTS,
    files,
    finish,
    keeps_parts,
    method_of,
    parts_bar,
    stopped,
    study_arguments,
    study_scene,
)
from lcpstep.errors import UnknownName
from lcpstep.plot import bifurcation as pictures
from lcpstep.plot.words import method_words
from lcpstep.simulation import Method

AGREEMENT = "agreement.nc"


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "bifurcation",
        help="brute-force bifurcation diagram over a parameter",
        description="At every parameter value: simulate, drop the transient, record the states once per period and "
        "the impacts. A run that was interrupted goes on with the same command.",
        epilog=f"Example: lcpstep bifurcation cam-follower --window 660-760. Windows [rpm]: {', '.join(WINDOWS)}",
    )
    study_arguments(p)
    p.add_argument("--parameter", help="parameter of the scene that varies (rpm)")
    p.add_argument("--range", type=float, nargs=2, metavar=("LOW", "HIGH"), help="of the parameter")
    p.add_argument(
        "--window", metavar="NAME", help=f"a range of the cam-follower by name: {', '.join(WINDOWS)}"
    )
    p.add_argument("--points", type=int, default=500, help="parameter values (500)")
    p.add_argument("--start", choices=STARTS, default="fixed", help="(fixed: zero position and velocity)")
    p.add_argument("--runs", type=int, default=4, help="random starts at each value (4)")
    p.add_argument(
        "--box", type=float, nargs=4, metavar=("QMIN", "QMAX", "VMIN", "VMAX"), help="to draw from"
    )
    p.add_argument("--drop", type=int, default=500, help="periods dropped (500)")
    p.add_argument("--keep", type=int, default=60, help="periods recorded (60)")
    p.add_argument(
        "--compare", type=float, nargs="+", metavar="H",
        help="also by time-stepping with these steps [s]: overlaid, and how far each diagram is from the first",
    )  # fmt: skip
    p.add_argument(
        "--show", nargs="+", choices=tuple(pictures.PANELS), metavar="PANEL",
        help=f"panels of the picture: {', '.join(pictures.PANELS)} (phase position, and where the motion chatters "
        "accumulation impacts)",
    )  # fmt: skip
    p.add_argument(
        "--most", type=int, default=IMPACTS_RECORDED,
        help=f"impacts recorded of each period ({IMPACTS_RECORDED}); told and drawn where there are more",
    )  # fmt: skip
    p.set_defaults(run=stopped(run_bifurcation))


def run_bifurcation(options: argparse.Namespace) -> int:
    """`lcpstep bifurcation`."""
    low, high = _range(options)
    vary(options)
    if options.points < 1:
        raise ValueError(f"--points: expected a positive number, got {options.points}")
    if options.rpm is not None and options.parameter == "rpm":
        raise ValueError("--rpm: it is the parameter that varies; give --range or --window")
    scene = study_scene(options)
    steps = [Moreau(h=h, theta=options.theta, lcp=options.lcp) for h in options.compare or ()]
    names = files(options, "bifurcation")
    if steps:
        dataset.check_new(options.out / AGREEMENT, options.overwrite)
    make = making(options, scene, options.parameter)
    values = np.linspace(low, high, options.points)
    keeps_parts(options)
    method = method_of(options, scene, (make(**{options.parameter: float(x)}) for x in (low, high)))
    data = _diagram(options, make, values, method, options.out / PARTS)
    title = _title(options, scene, method, low, high)
    if steps:
        figure = _compared(options, make, data, steps, title)
    else:
        figure = pictures.bifurcation(data, title, options.show)
    finish(options, data, figure, names)
    _print_counts(data)
    return DONE


def _title(options: argparse.Namespace, scene: Scene, method: Method, low: float, high: float) -> str:
    """Scene, window and method in words."""
    window = (
        f"{low:g} to {high:g} rpm"
        if options.parameter == "rpm"
        else f"{options.parameter} = {low:g} to {high:g}"
    )
    return (
        f"{scene.name}, {window}: {options.start} start, {options.drop} periods dropped, {options.keep} shown\n"
        f"{method_words(method)}, section at phase {options.phase:g}"
    )


def _print_counts(data: Any) -> None:
    """How much was recorded, and what is missing."""
    parameter, most = str(data.attrs["parameter"]), int(data.attrs["most"])
    failed = int((data["status"] != 0).sum())
    print(f"{data.sizes[parameter]} values, {failed} runs ended early")
    counts = data["impacts"].values
    event = "switches" if data.attrs["modes"] else "impacts"
    print(f"{data.sizes['impact']} {event} recorded, at most {int(counts.max(initial=0))} in a period")
    cut = np.any(counts > most, axis=(0, 2))
    if np.any(cut):
        shown = ", ".join(f"{x:g}" for x in data[parameter].values[cut][:8])
        print(
            f"only the first {most} {event} of a period are recorded at {int(cut.sum())} values of {parameter}: "
            f"{shown}{', ..' if cut.sum() > 8 else ''}; --most raises that"
        )


def _diagram(options: argparse.Namespace, make: Any, values: Any, method: Method, out: Path) -> Any:
    """The diagram by one method, its unfinished parts in `out`."""
    random = options.start == "random"
    states = box(options, make(**{options.parameter: float(values[0])})) if random else None
    with parts_bar(f"{options.parameter} {values[0]:g} .. {values[-1]:g}") as progress:
        return bifurcation(
            make, options.parameter, values, method=method, start=options.start, runs=options.runs,
            seed=options.seed, box=states, drop=options.drop,
            keep=options.keep, phase=options.phase, most=options.most, jobs=options.jobs, out=out, progress=progress,
        )  # fmt: skip


def _compared(options: argparse.Namespace, make: Any, data: Any, steps: list[Moreau], title: str) -> Any:
    """Figure of the diagram with those of time-stepping; their distances in a file and in a table."""
    import xarray

    values = data[options.parameter].values
    periods = np.array([make(**{options.parameter: float(x)}).period for x in values])
    others, apart = {}, {}
    for method in steps:
        name = f"h = {method.h:g} s"
        others[name] = _diagram(options, make, values, method, options.out / PARTS / name.replace(" ", ""))
        apart[name] = agreement(others[name], data, tolerance_of_stepping(method.h, periods))
    lists = ["impact", "landing"]
    tables = [apart[name].merge(others[name].drop_dims(lists)) for name in others]
    together = [xarray.concat(tables, "h", combine_attrs="drop_conflicts")]
    for kind in lists:  # of different lengths: one after another, each entry with the index of its step
        parts = [
            data[[name for name in data.data_vars if data[name].dims == (kind,)]].assign(
                {f"{kind}_h": (kind, np.full(data.sizes[kind], k, dtype=np.int32))}
            )
            for k, data in enumerate(others.values())
        ]
        together.append(xarray.concat(parts, kind, combine_attrs="drop"))
    joined = xarray.merge(together, combine_attrs="override").assign_coords(
        h=("h", [method.h for method in steps], {"units": "s"})
    )
    print(f"wrote {dataset.save(joined, options.out / AGREEMENT, overwrite=options.overwrite)}")
    _print_table(steps, [summary(x) for x in apart.values()])
    return pictures.overlaid(data, others, apart, title, options.show)


def _print_table(steps: list[Moreau], found: list[Summary]) -> None:
    print(
        "distance from the diagram by the first method: medians over the window; share of values with the same motion"
    )
    print(f"{'h [s]':>8}  {'phase [periods]':>16}  {'state [relative]':>16}  same O(n, m)")
    for method, row in zip(steps, found, strict=True):
        print(f"{method.h:8g}  {row.phase:16.3g}  {row.state:16.3g}  {row.same:12.1%}")
    row = found[0]
    print(
        f"{'floor':>8}  {row.phase_floor:16.3g}  {row.state_floor:16.3g}  between the halves of its own record"
    )


def _range(options: argparse.Namespace) -> tuple[float, float]:
    if options.window is not None:
        if options.parameter not in (None, "rpm"):
            raise ValueError(f"--window: it names speeds [rpm]; give --range, that of {options.parameter}")
        if options.window not in WINDOWS:
            raise UnknownName("window", options.window, WINDOWS)
        return WINDOWS[options.window]
    if options.range is None:
        if options.scene == "cam-follower" and options.parameter in (None, "rpm"):
            return WINDOWS["114-850"]
        names = ", ".join(parameters_of(options.scene))
        raise ValueError(
            f"--range: expected LOW HIGH, the range of the --parameter; those of {options.scene} are {names}"
        )
    low, high = options.range
    if not low < high:
        raise ValueError(f"--range: expected LOW < HIGH, got {low:g} {high:g}")
    return low, high
