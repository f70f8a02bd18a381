"""Put what the judge has reported into a page: `python -m benchmarks.judge.page REPORT ... --write docs/accuracy.md`.

Reports are files that `python -m benchmarks.judge --report FILE` has written, of one portion of scenes each.
"""

from __future__ import annotations

import argparse
from itertools import groupby
from pathlib import Path

from benchmarks.judge.report import Tally, anomalies, endings, joined, orders
from benchmarks.marked import put

NAME = "judge"


def text(t: Tally) -> str:
    """How the scenes were drawn, and the tables."""
    return "\n\n".join([f"{t.scenes} scenes: {drawn(t)}.", endings(t), orders(t), anomalies(t)])


def drawn(t: Tally) -> str:
    """Seeds and numbers of the scenes, portions that follow each other as one."""
    parts = []
    for seed, portions in groupby(sorted(t.asked), lambda x: x[0]):
        runs: list[list[int]] = []
        for _, first, end in portions:
            if runs and runs[-1][1] == first:
                runs[-1][1] = end
            elif first < end:
                runs.append([first, end])
        numbers = ", ".join(f"{first} to {end - 1}" for first, end in runs)
        parts.append(f"seed {seed}, numbers {numbers}")
    return "; ".join(parts)


def main() -> int:
    """Print the tables, or write them into a page between its marks."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("reports", nargs="+", type=Path)
    parser.add_argument("--write", type=Path, metavar="PAGE", help="put the tables there, between its marks")
    given = parser.parse_args()
    tables = text(joined(file.read_text(encoding="utf-8") for file in given.reports))
    print(tables)
    if given.write:
        put(given.write, NAME, tables)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
