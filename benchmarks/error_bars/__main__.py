"""How right error bars are: random scenes, four methods at random steps and tolerances, bars against true errors.

    python -m benchmarks.error_bars --runs 500 --seed 1 --write docs/accuracy.md

Scenes are those of `benchmarks.judge` with 30 to 3000 of the steps that their motion asks for.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.error_bars.report import Judged, Outcome, tables
from benchmarks.error_bars.truth import (
    FRICTION,
    MEASURES,
    METHODS,
    Truth,
    method_of,
    rubbing,
    sizes,
    step,
    told,
    truth,
    truth_of_friction,
    within,
)
from benchmarks.judge.describe import Description
from benchmarks.judge.draw import draw
from benchmarks.marked import put
from lcpstep import Moreau
from lcpstep.simulation import Method

LONG_ENOUGH, SHORT_ENOUGH = 30.0, 3000.0  # steps in a span
AT_ONCE = 0.01  # of the span: a bar that ends before is none
KNOWN = 0.2  # of the error or the bar, by which two true motions may be apart
ROUNDING = 1e-13  # of what a number is made of: below it neither is the truth known to two digits


def main() -> int:
    """Run it."""
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--runs", type=int, default=500)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--seconds", type=float, default=np.inf, help="end after so long, with the runs so far")
    p.add_argument("--write", type=Path, metavar="FILE", help="put the tables into a page, between its marks")
    p.add_argument(
        "--verbose", action="store_true", help="print every measure that is not within a factor of two"
    )
    options = p.parse_args()
    outcomes, begin = [], time.monotonic()
    for outcome in judged(options.seed):
        outcomes.append(outcome)
        if options.verbose:
            print(outcome, flush=True)
        if len(outcomes) >= options.runs or time.monotonic() - begin > options.seconds:
            break
        print(f"\r{len(outcomes)} runs", end="", file=sys.stderr)
    text = tables(outcomes, options.seed)
    print(f"\n{text}")
    if options.write:
        put(options.write, "error bars", text)
    return 0


def judged(seed: int) -> Iterator[Outcome]:
    """Runs of all methods on one scene after the other."""
    index = -1
    while True:
        index += 1
        d = draw(seed, index)
        if LONG_ENOUGH * d.h < d.length < SHORT_ENOUGH * d.h:
            with np.errstate(all="ignore"):
                yield from on_one(d, index, np.random.default_rng([seed, index, 1]))


def on_one(d: Description, index: int, rng: Any) -> Iterator[Outcome]:
    """Runs on a scene, and one with friction added."""
    true, scene = truth(d), d.scene()
    found = []
    for name in METHODS if true else ():
        found.append(one(Outcome(index, d.family, name), scene, method_of(name, d, rng), true))
    scene, moreau = rubbing(d, rng), Moreau(step(d, rng))
    if scene is not None and (true := truth_of_friction(scene, moreau.h)) is not None:
        for name, method in zip(FRICTION, (moreau, method_of("EventDriven", d, rng)), strict=True):
            found.append(one(Outcome(index, d.family, name), scene, method, true))
    yield from (x for x in found if x is not None)


def one(start: Outcome, scene: Any, method: Method, true: Truth) -> Outcome | None:
    """One run and its bar; None where the method does not treat the scene."""
    begin = time.process_time()
    alone = within(scene, method)
    between = time.process_time()
    run = within(scene, method, error=True)
    if run is None or alone is None:
        return None
    start.cost = (time.process_time() - between) / (between - begin) - 1.0
    start.until = (run.error.until - scene.t_span[0]) / (scene.t_span[1] - scene.t_span[0])
    start.reason, start.seconds = run.error.reason, between - begin
    if start.until < AT_ONCE:
        return start
    found, unsure = true.told(run)
    bars, of = told(run.error, found.known), sizes(run)
    for m in MEASURES:
        larger = max(bars[m], found.of[m])
        kind = "judged"
        if larger <= ROUNDING * of[m]:
            kind = "rounding"
        elif not (np.isfinite(found.of[m]) and unsure[m] <= KNOWN * larger):
            kind = "not known"
        start.measures[m] = Judged(kind, bars[m], found.of[m], unsure[m])
    return start


if __name__ == "__main__":
    sys.exit(main())
