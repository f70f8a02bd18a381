"""What error bars cost: CPU time of the bar over that of the run, of short and longer runs by every method.

    python -m benchmarks.error_bars.cost --write docs/accuracy.md

Spans of ready scenes are chosen so that a run takes about a millisecond, or twenty. Runs with a bar and without take
turns; of each the fastest counts, so that a busy machine changes little.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.marked import put
from lagrangian.scenes import CATALOGUE
from lcpstep import EventDriven, LcpStepError, Located, Moreau, simulate

SCENES = (
    "bouncing-ball", "impact-oscillator", "sticking-oscillator", "cam-follower", "newtons-cradle", "elastic-gas",
    "bowl", "double-pendulum",
)  # fmt: skip
STEPS = 500  # in the span of the catalogue
METHODS: dict[str, Callable[[float], Any]] = {
    "Moreau": Moreau,
    "`Located`, order 2": Located,
    "order 4": lambda h: Located(h, 4),
    "by a tolerance": lambda h: Located(20.0 * h, tolerance=1e-5),
    "`EventDriven`": lambda _: EventDriven(),
}
LENGTHS = (1e-3, 20e-3)  # CPU seconds of a run
NEAR = 2.0  # times more or less than these
LONGEST, TRIES = 1e4, 12  # times the span of the catalogue, and spans tried
TURNS, SECONDS = 200, 0.6  # of runs with and without bar, at most


def taken(scene: Any, method: Any, error: bool) -> float:
    """CPU seconds of a run."""
    begin = time.thread_time()
    simulate(scene, method, error=error)
    return time.thread_time() - begin


def lasting(scene: Any, method: Any, seconds: float) -> Any:
    """The scene with a span that takes so long; None where there is none."""
    start, end = scene.t_span
    length = end - start
    for _ in range(TRIES):
        length = max(length, 2.0 * getattr(method, "h", 0.0))
        some = replace(scene, t_span=(start, start + length))
        now = min(taken(some, method, False) for _ in range(5))
        if seconds / NEAR < now < seconds * NEAR:
            return some
        length *= min(max(seconds / now, 0.1), 4.0)
        if length > LONGEST * (end - start):
            return None
    return None


def ratio(scene: Any, method: Any) -> float:
    """CPU time of the bar over that of the run alone."""
    alone, both, begin = [], [], time.monotonic()
    while len(alone) < TURNS and (len(alone) < 3 or time.monotonic() - begin < SECONDS):
        alone.append(taken(scene, method, False))
        both.append(taken(scene, method, True))
    return min(both) / min(alone) - 1.0


def measured(name: str, make: Callable[[float], Any], seconds: float) -> float:
    """The ratio of one scene, nan where the method or the span is none."""
    scene = CATALOGUE[name].make()
    method = make((scene.t_span[1] - scene.t_span[0]) / STEPS)
    try:
        some = lasting(scene, method, seconds)
        return ratio(some, method) if some is not None else np.nan
    except LcpStepError:
        return np.nan


def main() -> int:
    """Run it."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--write", type=Path, metavar="FILE", help="put the table into a page, between its marks")
    options = p.parse_args()
    lines = ["| run of | " + " | ".join(METHODS) + " |", "|---|" + "---|" * len(METHODS)]
    for seconds in LENGTHS:
        cells = []
        for method, make in METHODS.items():
            found = np.array([measured(name, make, seconds) for name in SCENES])
            found = np.sort(found[np.isfinite(found)])
            print(
                f"{1e3 * seconds:g} ms, {method}: {np.round(found, 1).tolist()}", file=sys.stderr, flush=True
            )
            cells.append(f"{np.median(found):.1f} ({len(found)})" if len(found) else "")
        lines.append(f"| {1e3 * seconds:g} ms | " + " | ".join(cells) + " |")
    text = "\n".join(lines)
    print(text)
    if options.write:
        put(options.write, "costs of error bars", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
