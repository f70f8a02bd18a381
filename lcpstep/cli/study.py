"""`lcpstep study`: error against CPU time of several methods on one scene, as tables and a picture."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lagrangian import Scene
from lcpstep import EventDriven, Located, Moreau, study
from lcpstep.accuracy.errors import MEASURES
from lcpstep.accuracy.reference import find_reference
from lcpstep.accuracy.solvers import LEVELS, compare_solvers
from lcpstep.accuracy.work_precision import Study
from lcpstep.cli import interrupt
from lcpstep.cli.common import (
    DONE,
    FAILED,
    INTERRUPTED,
    save_figure,
    save_text,
    scene_arguments,
    scene_with_contacts,
)
from lcpstep.cli.studies import work_bar
from lcpstep.errors import StudyInterrupted
from lcpstep.simulation import Method

LONGEST = 100  # steps in the span, at least, where a tolerance chooses them
METHODS: dict[str, Callable[[argparse.Namespace, float], Method]] = {
    "moreau": lambda options, span: Moreau(theta=options.theta, lcp=options.lcp),
    "located": lambda options, span: Located(),
    "moreau-adaptive": lambda options, span: Moreau(span / LONGEST, theta=options.theta, tolerance=1e-4),
    "located-adaptive": lambda options, span: Located(span / LONGEST, tolerance=1e-4),
    "event-driven": lambda options, span: EventDriven(),
}


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "study",
        help="what accuracy costs on a scene: error against CPU time",
        description="Runs a scene by every method over a range of steps or tolerances, each level averaged "
        "over a few nearby steps, and prints errors, CPU times and fitted orders with their 95 % intervals. "
        "--out DIR receives study.json, study.csv and study.png; the same command carries an interrupted study on.",
        epilog="Example: lcpstep study impact-oscillator --h 1e-2 1e-3 1e-4 --out out",
    )
    scene_arguments(p)
    p.add_argument(
        "--methods", nargs="+", choices=list(METHODS), default=["moreau", "located"], help="(moreau located)"
    )
    p.add_argument("--h", type=float, nargs="+", help="steps [s]; default: 1/250 of the span to 1/64000")
    p.add_argument("--tolerances", type=float, nargs="+", help="of methods that have one (1e-4 to 1e-10)")
    p.add_argument("--theta", type=float, default=0.5, help="0 explicit, 0.5 trapezoidal, 1 implicit (0.5)")
    p.add_argument("--lcp", default="lemke", help="complementarity solver: lemke, qp, qp:daqp, ... (lemke)")
    p.add_argument("--measures", nargs="+", metavar="M", default=list(MEASURES), help=", ".join(MEASURES))
    p.add_argument("--horizon", type=float, help="compare up to this time only [s]")
    p.add_argument("--repeats", type=int, default=3, help="rounds of timing (3)")
    p.add_argument(
        "--solvers",
        nargs="*",
        metavar="NAME",
        help="compare complementarity solvers inside Moreau's method, against Lemke and the reference: "
        "qp:osqp, qp:daqp, ...; none named: all that are installed",
    )
    p.add_argument(
        "--solver-tolerances", type=float, nargs="+", default=list(LEVELS), help="(1e-2 1e-4 1e-6 1e-8)"
    )
    p.add_argument("--out", type=Path, metavar="DIR", help="where the files go; default: nothing is saved")
    p.add_argument("--no-picture", action="store_true", help="leave the picture out")
    p.add_argument("--json", action="store_true", help="print JSON in place of the table")
    p.set_defaults(run=run_study)


def run_study(options: argparse.Namespace) -> int:
    """`lcpstep study`."""
    scene = scene_with_contacts(options)
    if options.solvers is not None:
        return run_solvers(scene, options)
    span = scene.t_span[1] - scene.t_span[0]
    methods = [METHODS[name](options, span) for name in dict.fromkeys(options.methods)]
    file = None if options.out is None else options.out / "study.json"
    interrupt.keeps(options, lambda: str(file) if file and file.exists() else "")
    with work_bar("reference") as name_stage:
        try:
            result = study(
                scene, methods, h=options.h, tolerances=options.tolerances, measures=options.measures,
                horizon=options.horizon, repeats=options.repeats, save=file, progress=name_stage,
            )  # fmt: skip
        except StudyInterrupted as stopped:
            interrupt.answer()
            _report(stopped.study, options)
            return INTERRUPTED
    _report(result, options)
    return DONE if all(x.status == "DONE" for x in result.levels) else FAILED


def run_solvers(scene: Scene, options: argparse.Namespace) -> int:
    """`lcpstep study --solvers`."""
    if "moreau" not in options.methods:
        raise ValueError("--solvers: only --methods moreau leaves the complementarity solver to choose")
    reference = find_reference(scene, None)
    if reference.motion is None:
        raise ValueError(f"--solvers: {reference.notes[0]}")
    steps = options.h or [(scene.t_span[1] - scene.t_span[0]) / n for n in (1000, 10_000)]
    found = compare_solvers(
        scene, METHODS["moreau"](options, 0.0), steps, reference.motion, solvers=options.solvers or None,
        tolerances=options.solver_tolerances,
    )  # fmt: skip
    text = json.dumps(found.as_dict() | {"reference": reference.text}, indent=1)
    if options.out is not None:
        save_text(text, options.out / "solvers.json")
    print(text if options.json else f"{found}\nreference: {reference.text}")
    return DONE


def _report(result: Study, options: argparse.Namespace) -> None:
    """Files and table; of a study that was interrupted without picture and fits, which whoever waits waits for."""
    files = []
    if options.out is not None and result.levels:
        files = [options.out / "study.json", options.out / "study.csv"]
        result.save(files[1])
        if result.finished and not options.no_picture:
            from lcpstep.plot.work_precision import work_precision

            files.append(options.out / "study.png")
            save_figure(work_precision(result), files[-1])
    print(json.dumps(result.as_dict(), indent=1) if options.json else result)
    if not options.json:
        for file in files:
            print(f"wrote {file}")
