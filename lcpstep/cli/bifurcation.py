"""`lcpstep bifurcation`: brute-force bifurcation diagrams."""

from __future__ import annotations

import argparse
from functools import partial
from typing import Any

import numpy as np

from lagrangian.scenes import CATALOGUE
from lcpstep.analysis.bifurcation import STARTS, WINDOWS, bifurcation
from lcpstep.cli.attractor import box
from lcpstep.cli.common import DONE
from lcpstep.cli.studies import (
    PARTS,
    files,
    finish,
    method_of,
    parts_bar,
    stopped,
    study_arguments,
    study_scene,
)
from lcpstep.errors import UnknownName
from lcpstep.plot import diagrams


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
    p.add_argument("--parameter", default="rpm", help="parameter of the scene that varies (rpm)")
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
    p.set_defaults(run=stopped(run_bifurcation))


def run_bifurcation(options: argparse.Namespace) -> int:
    """`lcpstep bifurcation`."""
    low, high = _range(options)
    if options.points < 1:
        raise ValueError(f"--points: expected a positive number, got {options.points}")
    if options.rpm is not None and options.parameter == "rpm":
        raise ValueError("--rpm: it is the parameter that varies; give --range or --window")
    scene = study_scene(options)
    known = CATALOGUE[options.scene].parameters
    if options.parameter not in known:
        raise UnknownName(f"parameter of {options.scene}", options.parameter, known)
    names = files(options, "bifurcation")
    fixed = {k: v for k, v in scene.parameters.items() if k in known and k != options.parameter}
    make = partial(CATALOGUE[options.scene].make, **fixed)
    with parts_bar(f"{options.parameter} {low:g} .. {high:g}") as progress:
        data = bifurcation(
            make, options.parameter, np.linspace(low, high, options.points),
            method=method_of(options), start=options.start, runs=options.runs, seed=options.seed,
            box=box(options) if options.start == "random" else None, drop=options.drop, keep=options.keep,
            phase=options.phase, jobs=options.jobs, out=options.out / PARTS, progress=progress,
        )  # fmt: skip
    finish(options, data, diagrams.bifurcation(data), names)
    failed = int((data["status"] != 0).sum())
    print(f"{data.sizes[options.parameter]} values, {failed} runs ended early")
    return DONE


def _range(options: argparse.Namespace) -> tuple[float, float]:
    if options.window is not None:
        if options.window not in WINDOWS:
            raise UnknownName("window", options.window, WINDOWS)
        return WINDOWS[options.window]
    if options.range is None:
        if options.scene == "cam-follower" and options.parameter == "rpm":
            return WINDOWS["114-850"]
        raise ValueError("--range: expected LOW HIGH, the range of the parameter")
    low, high = options.range
    if not low < high:
        raise ValueError(f"--range: expected LOW < HIGH, got {low:g} {high:g}")
    return low, high
