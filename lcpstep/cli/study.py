"""`lcpstep study`: error against CPU time of several methods on one scene, as tables and a picture."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from lcpstep import EventDriven, Moreau, study
from lcpstep.analysis.errors import MEASURES
from lcpstep.analysis.work_precision import Study
from lcpstep.cli.common import DONE, FAILED, INTERRUPTED, scene_arguments, scene_of
from lcpstep.errors import StudyInterrupted
from lcpstep.simulate import Method

METHODS: dict[str, Callable[[argparse.Namespace], Method]] = {
    "moreau": lambda options: Moreau(theta=options.theta, lcp=options.lcp),
    "event-driven": lambda options: EventDriven(),
}


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "study",
        help="what accuracy costs on a scene: error against CPU time",
        description="Runs a scene by every method over a range of steps or tolerances, each level averaged "
        "over a few nearby steps, and prints errors, CPU times and fitted orders with their 95 %% intervals. "
        "--out DIR receives study.json, study.csv and study.png; the same command carries an interrupted study on.",
        epilog="Example: lcpstep study impact-oscillator --h 1e-2 1e-3 1e-4 --out out",
    )
    scene_arguments(p)
    p.add_argument("--methods", nargs="+", choices=list(METHODS), default=["moreau"], help="(moreau)")
    p.add_argument("--h", type=float, nargs="+", help="steps [s]; default: 1/250 of the span to 1/64000")
    p.add_argument("--tolerances", type=float, nargs="+", help="of methods that have one (1e-4 to 1e-10)")
    p.add_argument("--theta", type=float, default=0.5, help="0 explicit, 0.5 trapezoidal, 1 implicit (0.5)")
    p.add_argument("--lcp", default="lemke", help="complementarity solver: lemke, qp, qp:daqp, ... (lemke)")
    p.add_argument("--measures", nargs="+", metavar="M", default=list(MEASURES), help=", ".join(MEASURES))
    p.add_argument("--horizon", type=float, help="compare up to this time only [s]")
    p.add_argument("--repeats", type=int, default=3, help="rounds of timing (3)")
    p.add_argument("--out", type=Path, metavar="DIR", help="where the files go; default: nothing is saved")
    p.add_argument("--no-picture", action="store_true", help="leave the picture out")
    p.add_argument("--json", action="store_true", help="print JSON in place of the table")
    p.set_defaults(run=run_study)


def run_study(options: argparse.Namespace) -> int:
    """`lcpstep study`."""
    scene = scene_of(options)
    methods = [METHODS[name](options) for name in dict.fromkeys(options.methods)]
    file = None if options.out is None else options.out / "study.json"
    from tqdm import tqdm

    with tqdm(bar_format="{desc}", disable=None, leave=False) as bar:
        try:
            result = study(
                scene, methods, h=options.h, tolerances=options.tolerances, measures=options.measures,
                horizon=options.horizon, repeats=options.repeats, save=file, progress=bar.set_description_str,
            )  # fmt: skip
        except StudyInterrupted as stopped:
            _report(stopped.study, options)
            return INTERRUPTED
    _report(result, options)
    return DONE if all(x.status == "DONE" for x in result.levels) else FAILED


def _report(result: Study, options: argparse.Namespace) -> None:
    files = []
    if options.out is not None and result.levels:
        files = [options.out / "study.json", options.out / "study.csv"]
        result.save(files[1])
        if not options.no_picture:
            from lcpstep.plot.work_precision import work_precision

            files.append(options.out / "study.png")
            work_precision(result).savefig(files[-1], dpi=150)
    print(json.dumps(result.as_dict(), indent=1) if options.json else result)
    if not options.json:
        for file in files:
            print(f"wrote {file}")
