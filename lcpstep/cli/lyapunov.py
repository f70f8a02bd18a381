"""`lcpstep lyapunov`: the largest Lyapunov exponent of a scene's motion, from derivatives along it."""

from __future__ import annotations

import argparse
import json
import math
from typing import Any

from lcpstep.analysis.lyapunov import lyapunov
from lcpstep.analysis.variation import PeriodMap
from lcpstep.cli.common import DONE, scene_arguments
from lcpstep.cli.studies import method_of, study_scene


def add(commands: Any) -> None:
    """Arguments of the command."""
    p = commands.add_parser(
        "lyapunov",
        help="largest Lyapunov exponent of a scene's motion",
        description="Follows the event-driven motion of a scene with a period, modes or not, and the growth of a "
        "small deviation along it, by variational flows and saltation matrices.",
        epilog="Example: lcpstep lyapunov cam-follower --rpm 660 --periods 4000",
    )
    scene_arguments(p)
    p.add_argument("--rpm", type=float, help="cam speed [rpm]")
    p.add_argument("--tolerance", type=float, default=1e-12, help="rtol and atol (1e-12)")
    p.add_argument("--phase", type=float, default=0.0, help="of the section, a share of the period (0)")
    p.add_argument(
        "--from", dest="start", type=float, nargs="+", metavar="X", help="state; default: the scene's own"
    )
    p.add_argument("--transient", type=int, default=500, help="periods dropped (500)")
    p.add_argument("--periods", type=int, default=2000, help="periods averaged over (2000)")
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=run_lyapunov, method="event-driven")


def run_lyapunov(options: argparse.Namespace) -> int:
    """`lcpstep lyapunov`."""
    scene = study_scene(options)
    P = PeriodMap(scene, method_of(options), options.phase)
    x = scene.x0 if options.start is None else options.start
    found = lyapunov(P, x, options.periods, options.transient)
    words = "chaotic" if found.chaotic else "not chaotic"
    if options.json:
        numbers = {k: v for k, v in vars(found).items() if not isinstance(v, str)}
        finite = {k: v if math.isfinite(v) else str(v) for k, v in numbers.items()}
        print(json.dumps({"scene": scene.name, "period": scene.period, "verdict": words} | finite, indent=2))
        return DONE
    print(
        f"{scene.name}: largest Lyapunov exponent {found.largest:.6g} +- {found.error:.2g} per period, {words}"
    )
    print(f"{found.largest / scene.period:.6g} +- {found.error / scene.period:.2g} per second")
    if found.landings:
        print(f"all deviations vanish in {found.landings} of {options.periods} periods")
    return DONE
