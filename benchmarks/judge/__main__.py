"""Judge random scenes: `python -m benchmarks.judge --scenes 10000 --seed 1`."""

from __future__ import annotations

import argparse
import os
import sys
from collections import Counter

from benchmarks.judge.draw import draw
from benchmarks.judge.pool import CPU_LIMIT, answers
from benchmarks.judge.runs import WAYS, lines


def main() -> int:
    """Exit status 1 if anything was found."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.judge", description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000, help="how many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--method", nargs="+", choices=sorted(WAYS), default=list(WAYS))
    parser.add_argument("--family", nargs="+", default=None, help="only these classes of scenes")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--limit", type=float, default=CPU_LIMIT, help="CPU seconds of one run")
    parser.add_argument("--shown", type=int, default=3, help="anomalies shown of each class and method")
    given = parser.parse_args()
    numbers = range(given.first, given.first + given.scenes)
    scenes = ((k, draw(given.seed, k)) for k in numbers)
    chosen = ((k, d) for k, d in scenes if given.family is None or d.family in given.family)
    runs: Counter[tuple[str, str]] = Counter()
    found: Counter[tuple[str, str]] = Counter()
    for answer in answers(chosen, given.method, given.workers, given.limit):
        for name, ending in answer.endings.items():
            runs[name, ending] += 1
        for finding in answer.findings:
            found[finding.method, finding.kind] += 1
            if found[finding.method, finding.kind] <= given.shown:
                print(f"# scene {answer.index}, {finding.method}: {finding.kind}: {finding.text}")
                print(lines(answer.scene, finding.method), end="\n\n", flush=True)
    for key, count in sorted(runs.items()):
        print(*key, count)
    print()
    for key, count in sorted(found.items()):
        print(*key, count)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
