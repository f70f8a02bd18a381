"""Random cases with and without the audit: `python -m benchmarks.audit --cases 10000 --seed 1`.

In portions: `--cases 500 --seed 1`, `--seed 2`, ... are different cases.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from typing import Any

import numpy as np

from benchmarks.audit.cases import KINDS, Case, blind
from lcpstep import EventDriven, Located, simulate
from lcpstep.audit import audit
from lcpstep.trajectory import Trajectory

METHODS: list[tuple[str, dict[str, Any], float]] = [
    (
        "EventDriven",
        {},
        1e-10,
    ),  # with the gap beyond which whether it is met is no question of the method's error
    ("Located, order 2", {"h": 1e-3}, 1e-4),
    ("EventDriven", {}, 1e-10),
    ("Located, order 4", {"h": 1e-3, "order": 4}, 1e-7),
]


def struck(run: Trajectory) -> bool:
    """Whether the run has seen the event."""
    return len(run.impacts) > 0


def judge(
    case: Case, kind: type[EventDriven | Located], options: dict[str, Any], found: Counter[str]
) -> None:
    """One case by one method: without looks where it turns fast, as it is, and audited."""
    method = kind(**options)
    met = case.least < 0.0
    found["cases"] += 1
    with blind():
        plain = simulate(case.scene, method)
        answer = audit(plain)
    if met and not struck(plain):
        found["missed without looks"] += 1
        found["of these reported"] += bool(answer.missed or answer.windows)
        found["of these unreported"] += not answer.missed and not answer.windows
    if not met and answer.missed:
        found["reported, but none"] += 1
    own = simulate(case.scene, method)
    found["missed by default"] += met and not struck(own)
    audited = simulate(case.scene, kind(**options, audit=True))
    lost = met and not struck(audited)
    found["missed with the audit on"] += lost
    found["of these listed"] += lost and bool(audited.audit.windows)
    found["struck, but none"] += not met and struck(audited)
    found["flights"] += audited.audit.flights
    found["certified"] += audited.audit.certified


def told(found: Counter[str]) -> str:
    """The counts in words."""
    return ", ".join(f"{key} {n}" for key, n in found.items() if n)


def main() -> None:
    """Print a table by kind and method."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    counts: dict[tuple[str, str], Counter[str]] = {}
    names = list(KINDS)
    start = time.process_time()
    for k in range(options.cases):
        kind = names[k % len(names)]
        case = KINDS[kind](kind, rng)
        name, own, clear = METHODS[k // len(names) % len(METHODS)]
        if abs(case.least) < clear:
            continue
        method = EventDriven if name == "EventDriven" else Located
        judge(case, method, own, counts.setdefault((kind, name), Counter()))
    for (kind, name), found in counts.items():
        print(f"{kind}, {name}: {told(found)}")
    for name in sorted({name for _, name in counts}):
        total = sum((found for (_, own), found in counts.items() if own == name), Counter())
        print(f"ALL, {name}: {told(total)}")
    print(f"{time.process_time() - start:.0f} CPU s")


if __name__ == "__main__":
    main()
