"""Measure everything here: `python -m benchmarks.scaling --help`."""

from __future__ import annotations

import argparse
import json
import logging
import subprocess
import sys
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from benchmarks.scaling.column import CASES, FOLLOWED, true_motion
from benchmarks.stepping import peer
from benchmarks.stepping.machine import machine

HERE = Path(__file__).parent
SIZES = (10, 100, 1000, 10_000)
STEPS = {10: 200, 100: 200, 1000: 100, 10_000: 50}
PEER_STEPS = {
    "touching": {10: 200, 100: 200, 1000: 5, 10_000: 2},
    "falling": {10: 200, 100: 200, 1000: 100, 10_000: 2},
}  # fewer where a run would take minutes
SOLVERS = {"Siconos, Lemke": "SICONOS_LCP_LEMKE", "Siconos, Newton": "SICONOS_LCP_NEWTON_FB_FBLSA"}
TEXT = """# A column of N bodies

Made by `python -m benchmarks.scaling`. {machine}.
Each figure is the median of {rounds} runs in processes of their own that took turns: the processor time of a step,
averaged over a run. The library's time is that of the whole call of `simulate`, Siconos' that of its time loop alone.
Memory is what the run added to the process. Restitution 1/2, h = 1 ms, theta = 1/2.

*Touching*: at rest on the floor; the error is the largest speed in the end, which must be zero, in brackets the
largest relative error of the contact forces. *Falling*: 1 mm between neighbours; the error is the penetration in the
end, which the scheme has whatever the solver, and up to N = 100 how far positions and velocities are from those of
the event-driven motion, in the mean over all bodies and 20 times. Steps of a run: {steps};
of Siconos where it is slow: {fewer}. "-": not within {limit:g} s.
"""


def ask(command: list[str], limit: float) -> dict[str, Any]:
    """What one process measured, or that it did not."""
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return {"refused": f"not within {limit:g} s"}
    lines = run.stdout.strip().splitlines()
    return json.loads(lines[-1]) if run.returncode == 0 and lines else {"refused": run.stderr.strip()[-200:]}


def measured(rounds: int, python: str | None, limit: float, sizes: tuple[int, ...]) -> list[dict[str, Any]]:
    """One row a case, size and contestant."""
    rows = []
    for case in CASES:
        for n in sizes:
            own = [sys.executable, "-m", "benchmarks.scaling.column", str(n), case, str(STEPS[n])]
            contestants = {"lcpstep": own}
            if python:
                worker = [python, str(HERE / "siconos_column.py"), str(n), case, str(PEER_STEPS[case][n])]
                contestants |= {name: [*worker, solver] for name, solver in SOLVERS.items()}
            answers: dict[str, list[dict[str, Any]]] = {name: [] for name in contestants}
            for _ in range(rounds):
                for name, command in contestants.items():
                    if not any("refused" in answer for answer in answers[name]):
                        answers[name].append(ask(command, limit))
            truth = true_motion(n, STEPS[n]) if case == "falling" and n <= FOLLOWED else None
            for name, found in answers.items():
                row = {"case": case, "n": n, "name": name} | middle(found)
                if truth is not None and "refused" not in row:
                    row |= distance(found[-1], truth)
                logging.info("%s", row)
                rows.append(row)
    return rows


def distance(answer: dict[str, Any], truth: tuple[Any, Any]) -> dict[str, float]:
    """How far positions and velocities are from those of the true motion; means over bodies and times."""
    return {
        f"off_{name}": float(np.mean(np.abs(np.array(answer[name]) - x)))
        for name, x in zip("qv", truth, strict=True)
    }


def middle(found: list[dict[str, Any]]) -> dict[str, Any]:
    """Medians of the figures of several runs."""
    if any("refused" in answer for answer in found):
        return {"refused": found[-1]["refused"]}
    numbers = [key for key, value in found[0].items() if isinstance(value, (int, float))]
    return {key: median(answer[key] for answer in found) for key in numbers} | {
        "low": min(answer["seconds"] for answer in found),
        "high": max(answer["seconds"] for answer in found),
    }


def tables(rows: list[dict[str, Any]]) -> str:
    """Markdown, one table a case."""
    parts = []
    for case in CASES:
        lines = [f"## {case.capitalize()}", ""]
        lines += [
            "| N | by | time of a step [ms] | per body [us] | memory [MB] | error | from the true motion |",
            "|---:|---|---:|---:|---:|---:|---:|",
        ]
        for row in rows:
            if row["case"] != case:
                continue
            if "refused" in row:
                lines.append(f"| {row['n']} | {row['name']} | - | - | - | - | - |")
                continue
            unit = "m/s" if case == "touching" else "m"
            error = f"{row['error']:.1e} {unit}" if row["error"] else "0"
            error += f" ({row['force_error']:.0e})" if "force_error" in row else ""
            spread = f"{1e3 * row['seconds']:.3g} ({1e3 * row['low']:.3g} .. {1e3 * row['high']:.3g})"
            per_body = f"{1e6 * row['seconds'] / row['n']:.3g}"
            away = f"{row['off_q']:.1e} m, {row['off_v']:.1e} m/s" if "off_q" in row else "-"
            figures = row["n"], row["name"], spread, per_body, f"{row['megabytes']:.1f}", error, away
            lines.append(f"| {' | '.join(map(str, figures))} |")
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def main() -> None:
    logging.basicConfig(format="%(message)s", level=logging.INFO)
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scaling", description=__doc__)
    parser.add_argument("--rounds", type=int, default=5, help="how often each contestant runs (default 5)")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds that a run may take (default 60)")
    parser.add_argument(
        "--sizes", type=int, nargs="+", choices=SIZES, default=list(SIZES), help="numbers of bodies"
    )
    parser.add_argument("--siconos", metavar="PYTHON", help="a Python that can import Siconos")
    parser.add_argument("--no-siconos", action="store_true", help="leave Siconos out")
    parser.add_argument("--out", type=Path, default=HERE, help="folder of results.md and results.json")
    asked = parser.parse_args()
    python = None if asked.no_siconos else peer.find(asked.siconos)
    if python is None and not asked.no_siconos:
        logging.warning("Siconos was not found and is left out (Debian: apt-get install python3-siconos)")
    rows = measured(asked.rounds, python, asked.limit, tuple(asked.sizes))
    facts = machine()
    asked.out.mkdir(parents=True, exist_ok=True)
    (asked.out / "results.json").write_text(json.dumps({"machine": facts, "rows": rows}, indent=1) + "\n")
    head = TEXT.format(
        machine=", ".join(f"{key} {value}" for key, value in facts.items()),
        rounds=asked.rounds,
        limit=asked.limit,
        steps=", ".join(f"{STEPS[n]} for N = {n}" for n in asked.sizes),
        fewer=", ".join(
            f"{peer_steps[n]} for N = {n}, {case}"
            for case, peer_steps in PEER_STEPS.items()
            for n in asked.sizes
            if peer_steps[n] < STEPS[n]
        ),
    )
    text = head + "\n" + tables(rows)
    (asked.out / "results.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
