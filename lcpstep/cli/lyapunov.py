"""`lcpstep lyapunov`: the largest Lyapunov exponent of a scene's motion, from derivatives along it."""

from __future__ import annotations

import argparse
import json
import math
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import checks
from lcpstep.analysis.lyapunov import Lyapunov, Progress, lyapunov
from lcpstep.analysis.variation import PeriodMap
from lcpstep.cli import interrupt
from lcpstep.cli.common import DONE, INTERRUPTED, scene_arguments
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
    p.add_argument("--transient", type=whole, default=500, help="periods dropped (500)")
    p.add_argument("--periods", type=whole, default=2000, help="periods averaged over (2000)")
    p.add_argument("--json", action="store_true", help="print JSON")
    p.set_defaults(run=run_lyapunov, method="event-driven")


def whole(text: str) -> int:
    """A whole number, also as 1e8."""
    number = float(text)
    if not number.is_integer():
        raise ValueError
    return int(number)


def run_lyapunov(options: argparse.Namespace) -> int:
    """`lcpstep lyapunov`; what there is of it is printed where it is interrupted."""
    checks.count("--periods", options.periods)
    scene = study_scene(options)
    P = PeriodMap(scene, method_of(options, scene), options.phase)
    x = scene.x0 if options.start is None else options.start
    latest: list[tuple[int, Lyapunov, NDArray[np.float64]]] = []
    options.wanted = options.periods
    interrupt.keeps(options, lambda: _kept(latest), lambda: _go_on(options, latest))
    with _periods_bar(options, latest) as progress:
        try:
            found, status = lyapunov(P, x, options.periods, options.transient, progress=progress), DONE
        except KeyboardInterrupt:
            if not latest:
                raise
            interrupt.answer()
            (options.periods, found, _), status = latest[-1], INTERRUPTED
    _print(options, scene, found)
    return status


def _kept(latest: list[Any]) -> str:
    return f"the exponent over {latest[-1][0]} periods" if latest else ""


def _go_on(options: argparse.Namespace, latest: list[Any]) -> list[str]:
    """The command for the periods that are left."""
    done, _, x = latest[-1]
    start = [np.format_float_positional(y, trim="0") for y in x]  # argparse takes -1e-5 for an option
    return [*options.words, "--from", *start, "--transient", "0", "--periods", str(options.wanted - done)]


@contextmanager
def _periods_bar(options: argparse.Namespace, latest: list[Any]) -> Generator[Progress, None, None]:
    """A bar over the periods, on a terminal only; the exponent so far goes into `latest`."""
    from tqdm import tqdm

    with tqdm(total=options.periods, desc="lyapunov", unit="period", disable=None, leave=False) as bar:

        def progress(done: int, found: Lyapunov, x: NDArray[np.float64]) -> None:
            latest[:] = [(done, found, x)]
            bar.set_postfix_str(f"{found.largest:.6g} +- {found.error:.2g}", refresh=False)
            bar.update(done - bar.n)

        yield progress


def _print(options: argparse.Namespace, scene: Any, found: Lyapunov) -> None:
    negative = found.largest <= -3.0 * found.error
    words = "chaotic" if found.chaotic else "not chaotic" if negative else "too uncertain to tell chaos"
    if options.json:
        numbers = {k: v for k, v in vars(found).items() if not isinstance(v, str)}
        finite = {k: v if math.isfinite(v) else str(v) for k, v in numbers.items()}
        what = {"scene": scene.name, "period": scene.period, "periods": options.periods, "verdict": words}
        print(json.dumps(what | finite, indent=2))
        return
    print(
        f"{scene.name}: largest Lyapunov exponent {found.largest:.6g} +- {found.error:.2g} per period, {words}"
    )
    print(
        f"{found.largest / scene.period:.6g} +- {found.error / scene.period:.2g} per second, "
        f"over {options.periods} periods"
    )
    if found.landings:
        print(f"all deviations vanish in {found.landings} of {options.periods} periods")
