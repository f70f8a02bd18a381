"""Measure everything here: `python -m benchmarks.stepping --help`."""

from __future__ import annotations

import argparse
import json
import logging
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.stepping import equal_steps, events, first_use, moreau, peer, report
from benchmarks.stepping.machine import machine

HERE = Path(__file__).parent
NO_SICONOS = """Siconos was not found and is left out.
Debian: apt-get install python3-siconos gcc; elsewhere name a Python that has it with --siconos"""


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.stepping", description=__doc__)
    parser.add_argument("--rounds", type=int, default=7, help="how often each contestant runs (default 7)")
    parser.add_argument(
        "--siconos", metavar="PYTHON", help="a Python that can import Siconos; found by itself if possible"
    )
    parser.add_argument("--no-siconos", action="store_true", help="leave Siconos out")
    parser.add_argument(
        "--no-first-use", action="store_true", help="leave out what compiling costs (about two minutes)"
    )
    parser.add_argument(
        "--out", type=Path, default=HERE, help="folder of results.md and results.json (default: here)"
    )
    return parser.parse_args()


def measure(asked: argparse.Namespace, siconos: peer.Siconos | None) -> dict[str, Any]:
    """All figures; times in seconds."""
    rounds = asked.rounds
    figures: dict[str, Any] = {"machine": machine(), "rounds": rounds}
    figures["siconos"] = siconos.version if siconos else "not found"
    figures["moreau"] = moreau.all_scenes(rounds)
    figures["call"] = moreau.cost_of_a_call(rounds)
    figures["equal_steps"] = equal_steps.equal_steps(siconos, rounds)
    figures["events"] = events.library(rounds)
    if siconos:
        figures["siconos_events"] = events.siconos(siconos, rounds)
    if not asked.no_first_use:
        figures["first_use"] = first_use.first_use(rounds)
    return figures


def main() -> None:
    logging.basicConfig(format="%(message)s")
    asked = arguments()
    python = None if asked.no_siconos else peer.find(asked.siconos)
    if python is None and not asked.no_siconos:
        logging.warning(NO_SICONOS)
    with tempfile.TemporaryDirectory() as folder:
        siconos = peer.Siconos(python, Path(folder)) if python else None
        figures = measure(asked, siconos)
        if siconos:
            siconos.close()
    asked.out.mkdir(parents=True, exist_ok=True)
    (asked.out / "results.json").write_text(json.dumps(figures, indent=1) + "\n")
    text = report.markdown(figures)
    (asked.out / "results.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
