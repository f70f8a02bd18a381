"""Judge random scenes: `python -m benchmarks.judge --scenes 10000 --seed 1`; those of round numbers: `--tidy`;
of bodies whose contacts hang together: `--coupled`.

Every anomaly is printed with the lines that reproduce it, and at the end tables; exit status 1 if there is any in a
run that does not say itself, by its `doubt`, that it is wrong. After an interrupt (Ctrl-C) the tables are those of
what was judged so far, and a line says how to go on.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from benchmarks.judge.case import SHARE
from benchmarks.judge.coupled.scenes import FAMILIES as COUPLED
from benchmarks.judge.coupled.scenes import Coupled, coupled
from benchmarks.judge.describe import Description
from benchmarks.judge.draw import draw
from benchmarks.judge.pool import CPU_LIMIT, Answer, Court, answers
from benchmarks.judge.report import Tally, report, saved
from benchmarks.judge.runs import WAYS, Finding, lines, silent
from benchmarks.judge.shapes import FAMILIES
from benchmarks.judge.tidy import FAMILIES as TIDY
from benchmarks.judge.tidy import tidy

INTERRUPTED = 130  # as shells say it


def options() -> argparse.ArgumentParser:
    """What can be asked for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.judge", description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000, help="how many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tidy", action="store_true", help="scenes as people write them, of round numbers")
    parser.add_argument("--coupled", action="store_true", help="heaps, rods and linkages")
    parser.add_argument("--first", type=int, default=0, help="number of the first scene")
    parser.add_argument("--method", nargs="+", choices=sorted(WAYS), default=list(WAYS))
    parser.add_argument(
        "--family",
        nargs="+",
        choices=sorted({*FAMILIES, *TIDY, *COUPLED}),
        help="only these classes of scenes",
    )
    parser.add_argument("--kind", help="only anomalies whose class has this in its name are shown")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--limit", type=float, default=CPU_LIMIT, help="CPU seconds of one run")
    parser.add_argument(
        "--share", type=float, default=SHARE, help="of runs asked in other words; 1: do everything"
    )
    parser.add_argument("--shown", type=int, default=3, help="anomalies shown of each class and method")
    parser.add_argument(
        "--shrink", type=float, default=0.0, metavar="SECONDS", help="to make each of these small"
    )
    parser.add_argument("--report", metavar="FILE", help="write the tables there, in Markdown; for `page`")
    return parser


def scenes(given: argparse.Namespace) -> Iterator[tuple[int, Description | Coupled]]:
    """The scenes asked for, with their numbers."""
    one = tidy if given.tidy else coupled if given.coupled else draw
    for k in range(given.first, given.first + given.scenes):
        d = one(given.seed, k)
        if not given.family or d.family in given.family:
            yield k, d


def small(d: Description, finding: Finding, given: argparse.Namespace) -> Description:
    """The scene made small, in `given.shrink` seconds."""
    from benchmarks.judge.shrink import shrunk

    court = Court(given.limit)

    def wrong(new: Description) -> bool:
        return any(
            x.kind == finding.kind for x in court.ask(new, finding.method) if x.method == finding.method
        )

    try:
        return shrunk(d, wrong, given.shrink)
    finally:
        court.close()


def show(answer: Answer, finding: Finding, given: argparse.Namespace) -> None:
    """An anomaly, and what reproduces it."""
    print(f"# scene {answer.index}, {finding.method}: {finding.kind}: {finding.text}")
    d = answer.scene
    if given.shrink and isinstance(d, Description):
        d = small(d, finding, given)
    print(lines(d, finding.method), end="\n\n", flush=True)


def judge(given: argparse.Namespace, tally: Tally) -> int:
    """Judge the scenes asked for, and show what is found; the number of the first that is not judged in the end."""
    shown, done = Counter[tuple[str, str]](), set[int]()
    end = given.first + given.scenes
    verdicts = answers(scenes(given), given.method, given.workers, given.limit, given.share)
    try:
        for answer in verdicts:
            tally.add(answer)
            done.add(answer.index)
            for finding in answer.findings:
                key = finding.method, finding.kind
                shown[key] += 1
                if shown[key] <= given.shown and (given.kind or "") in finding.kind:
                    show(answer, finding, given)
    except KeyboardInterrupt:
        verdicts.close()
        return next((k for k, _ in scenes(given) if k not in done), end)
    return end


def main() -> int:
    """Exit status 1 if anything was found; what was judged up to an interrupt is told, and how to go on."""
    given, tally = options().parse_args(), Tally()
    reached, end = judge(given, tally), given.first + given.scenes
    print(report(tally))
    tally.asked.append((given.seed, given.first, reached))
    if given.report:
        Path(given.report).write_text(saved(tally), encoding="utf-8")
    if reached < end:
        print(f"Interrupted. To go on: --first {reached} --scenes {end - reached}", flush=True)
        return INTERRUPTED
    return 1 if any(silent(kind) for _, kind in tally.found) else 0


if __name__ == "__main__":
    sys.exit(main())
