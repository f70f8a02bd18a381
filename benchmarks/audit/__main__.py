"""Random cases with and without the audit: `python -m benchmarks.audit --cases 10000 --seed 1`.

In portions: `--cases 500 --seed 1`, `--seed 2`, ... are different cases. Whether an obstacle is met, the exact motion
says. An audit certifies the computed one: where that does not touch though the exact one would, an audited run is
"passed by for the method's error", and its audit must list the time. What is no event as it should be is printed with
the case's number: `--cases 1000 --seed 30003 --case 446` runs that one again.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from collections.abc import Iterator
from typing import Any

import numpy as np

from benchmarks.audit.cases import KINDS, Case, blind
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit
from lcpstep.audit.result import Audit
from lcpstep.trajectory import Trajectory

# With the gap nearer to zero than which an event is left out. The error of order 2 may still be larger: it grows to
# 2e-4 m in these spans, so that what an audited run passes by is judged by the motion that the run has computed.
METHODS: list[tuple[str, dict[str, Any], float]] = [
    ("EventDriven", {}, 1e-10),
    ("Located, order 2", {"h": 1e-3}, 1e-4),
    ("EventDriven", {}, 1e-10),
    ("Located, order 4", {"h": 1e-3, "order": 4}, 1e-7),
]
REACH = 1e-3  # [m], more than errors of these methods: such computed motions are looked at, too
PASSED, MISSED = "passed by for the method's error", "missed with the audit on"
TOLD = PASSED, MISSED, "of these unreported", "reported, but none", "struck, but none"


def struck(run: Trajectory) -> bool:
    """Whether the run has seen the event."""
    return len(run.impacts) > 0


def reported(case: Case, run: Trajectory, answer: Audit) -> bool:
    """Whether an audit says that the event is missed, which the computed motion bears out, or lists its time."""
    at = case.lowest[1]
    listed = any(x.start <= at <= x.end for x in answer.windows)
    return listed or any(case.gaps(run, np.array([x.time]))[0] < 0.0 for x in answer.missed)


def judge(
    case: Case, kind: type[EventDriven | Located], options: dict[str, Any], found: Counter[str]
) -> Trajectory:
    """One case by one method: without looks where it turns fast, as it is, and audited; the audited run."""
    method = kind(**options)
    met = case.least < 0.0
    found["cases"] += 1
    with blind():
        plain = simulate(case.scene, method)
        answer = audit(plain)
    if met and not struck(plain):
        found["missed without looks"] += 1
        found[f"of these {'' if reported(case, plain, answer) else 'un'}reported"] += 1
    if not met and answer.missed:
        found["reported, but none"] += 1
    own = simulate(case.scene, method)
    found["missed by default"] += met and not struck(own)
    audited = simulate(case.scene, kind(**options, audit=True))
    if case.least < REACH and not struck(audited):
        touches = case.least_of(audited) < 0.0  # whatever the exact motion does
        found[MISSED] += touches
        found[PASSED] += met and not touches
        if touches or met:
            found["of these listed"] += reported(case, audited, audited.audit)
    found["struck, but none"] += not met and struck(audited)
    found["flights"] += audited.audit.flights
    found["certified"] += audited.audit.certified
    return audited


def told(found: Counter[str]) -> str:
    """The counts in words."""
    return ", ".join(f"{key} {n}" for key, n in found.items() if n)


def drawn(count: int, seed: int) -> Iterator[tuple[int, Case, tuple[str, dict[str, Any], float]]]:
    """Cases in their order, with their numbers and methods."""
    rng, names = np.random.default_rng(seed), list(KINDS)
    for k in range(count):
        kind = names[k % len(names)]
        yield k, KINDS[kind](kind, rng), METHODS[k // len(names) % len(METHODS)]


def main() -> None:
    """Print a table by kind and method."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--case", type=int, help="this one alone, with its audit")
    options = parser.parse_args()
    counts: dict[tuple[str, str], Counter[str]] = {}
    start = time.process_time()
    for k, case, (name, own, clear) in drawn(options.cases, options.seed):
        if options.case not in (None, k) or abs(case.least) < clear:
            continue
        found: Counter[str] = Counter()
        run = judge(case, EventDriven if name == "EventDriven" else Located, own, found)
        if options.case is not None or any(found[x] for x in TOLD):
            print(
                f"case {k}, {case.scene.name}, {name}, least gap {case.least:.3g} m: {told(found)}\n{run.audit}"
            )
        counts.setdefault((case.kind, name), Counter()).update(found)
    for (kind, name), found in counts.items():
        print(f"{kind}, {name}: {told(found)}")
    for name in sorted({name for _, name in counts}):
        total = sum((found for (_, own), found in counts.items() if own == name), Counter())
        print(f"ALL, {name}: {told(total)}")
    print(f"{time.process_time() - start:.0f} CPU s")


if __name__ == "__main__":
    main()
