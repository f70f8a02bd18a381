"""CPU time of audits against that of the runs, in one process: `python -m benchmarks.audit.costs`."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from typing import Any

from lagrangian import Scene, scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit
from lcpstep.errors import LcpStepError

REPEATS = 3
# spans that are long enough for what a run costs beside its steps not to count
SPANS = {
    "elastic-ball": 3e4, "impact-oscillator": 2e4, "chaotic-oscillator": 2e4, "sticking-oscillator": 2e4,
    "ball-on-table": 3e3, "cam-follower": 4e3, "chattering-table": 1e3, "elastic-gas": 100.0,
    "double-pendulum": 200.0, "pendulum-stop": 200.0, "rocking-block": None, "elastic-chain": 50.0, "bowl": 500.0,
}  # fmt: skip
METHODS = [EventDriven(), Located(1e-3), Located(1e-3, order=4), Located(1e-3, order="exact")]
FEWER = 0.02  # of the span: steps take longer


def best(f: Callable[[], Any]) -> tuple[float, Any]:
    """The least CPU time of several calls, and what the last returned."""
    least = float("inf")
    for _ in range(REPEATS):
        start = time.process_time()
        found = f()
        least = min(least, time.process_time() - start)
    return least, found


def scene_of(name: str, span: float | None) -> Scene:
    """A ready scene over a span."""
    make = scenes.CATALOGUE[name].make
    return make() if span is None else make(t_end=span)  # type: ignore[return-value]


def main() -> None:
    """Print a table."""
    warnings.simplefilter("ignore")
    print("| scene | method | states | run [us a state] | audit, of the run | flights certified |")
    print("|---|---|---|---|---|---|")
    for name, span in SPANS.items():
        for method in METHODS:
            few = span and (span if isinstance(method, EventDriven) else FEWER * span)
            scene = scene_of(name, few)
            try:
                own, run = best(lambda: simulate(scene, method))  # noqa: B023
            except LcpStepError:
                continue
            seconds, answer = best(lambda: audit(run))  # noqa: B023
            n = len(run.t)
            words = "EventDriven" if isinstance(method, EventDriven) else f"Located, order {method.order}"
            print(
                f"| `{name}` | {words} | {n} | {own / n * 1e6:.2f} | {seconds / own:.2f} | "
                f"{answer.certified} of {answer.flights} |", flush=True,
            )  # fmt: skip


if __name__ == "__main__":
    main()
