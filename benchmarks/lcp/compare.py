"""Solvers for complementarity problems, compared: how many are solved, and how fast.

    python -m benchmarks.lcp.compare [--quick]

writes benchmarks/lcp/results.md. An answer is judged by `lcpstep.lcp.residual`, with the better of z as it
came and z without what is below 1e-13 of its largest entry, so that nobody fails for a rounding error in z.
"""

from __future__ import annotations

import argparse
import importlib.metadata
import platform
import time
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.lcp.problems import FAMILIES, Problem, problems
from benchmarks.lcp.solvers import SOLVERS, Answer, siconos, timed
from lcpstep.lcp import residual, solve_lcp, solve_lcp_batch

SIZES = (1, 2, 3, 5, 10, 20, 50, 100, 200, 500)
REPEATS = 2  # problems of each family and size
ACCURATE, CRUDE = 1e-8, 1e-3  # residuals: solved up to the first, wrong beyond the second
REFERENCE = "quantecon lcp_lemke"
PACKAGES = (
    "numpy",
    "scipy",
    "numba",
    "quantecon",
    "qpsolvers",
    "osqp",
    "daqp",
    "quadprog",
    "piqp",
    "clarabel",
    "proxsuite",
)


def error(problem: Problem, z: Any) -> float:
    """Judged residual, rounding noise in z forgiven."""
    if not np.isfinite(z).all():
        return np.inf
    tidy = np.where(np.abs(z) > 1e-13 * np.max(np.abs(z), initial=0.0), z, 0.0)
    return min(residual(problem.W, problem.b, z), residual(problem.W, problem.b, tidy))


def verdict(claimed: bool, found: float) -> str:
    if not claimed:
        return "failed"
    return "solved" if found <= ACCURATE else "inaccurate" if found <= CRUDE else "wrong"


def collect(set_of: list[Problem]) -> dict[str, list[tuple[Problem, str, float, float]]]:
    """For every solver: problem, verdict, residual and seconds.

    Each problem goes to all solvers in turn, so that the ratio of two times does not depend on what else the
    machine does meanwhile.
    """
    outcome: dict[str, list[tuple[Problem, str, float, float]]] = {name: [] for name in SOLVERS}

    def note(name: str, problem: Problem, answer: Answer) -> None:
        z, claimed, seconds = answer
        r = error(problem, z)
        outcome[name].append((problem, verdict(claimed, r), r, seconds))

    for problem in set_of:
        for name, solver in SOLVERS.items():
            answer = solver(problem)
            if answer is not None:
                note(name, problem, answer)
    from_siconos = siconos(set_of)
    if from_siconos is None:
        print("Siconos is not installed for the system's python3: left out")
    else:
        outcome["Siconos Lemke"] = []
        for problem, answer in zip(set_of, from_siconos, strict=True):
            note("Siconos Lemke", problem, answer)
    return outcome


def geometric_mean(values: list[float]) -> float:
    return float(np.exp(np.mean(np.log(values)))) if values else np.nan


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def reliability(outcome: dict[str, Any]) -> str:
    kinds = ("solved", "inaccurate", "wrong", "failed")
    rows = []
    for name, results in outcome.items():
        count = [sum(v == kind for _, v, _, _ in results) for kind in kinds]
        worst = max((r for _, v, r, _ in results if v == "solved"), default=np.nan)
        rows.append([name, str(len(results)), *map(str, count), f"{worst:.0e}"])
    return table(["solver", "problems", *kinds, "worst residual among solved"], rows)


def failures(outcome: dict[str, Any]) -> str:
    rows = []
    for name, results in outcome.items():
        for family in FAMILIES:
            bad = [f"{p.n} {v}" for p, v, _, _ in results if p.family == family and v != "solved"]
            if bad:
                shown = ", ".join(bad[:6]) + (f", ... ({len(bad)})" if len(bad) > 6 else "")
                rows.append([name, family, shown])
    return table(["solver", "family", "n and verdict"], rows)


def speed(outcome: dict[str, Any]) -> str:
    """Geometric mean of the time over the reference's, where both have solved."""
    reference = {id(p): t for p, v, _, t in outcome[REFERENCE] if v == "solved"}
    sizes = [n for n in SIZES if any(p.size == n for p, *_ in outcome[REFERENCE])]
    rows = []
    for name, results in outcome.items():
        row = [name]
        for n in sizes:
            ratios = [
                t / reference[id(p)]
                for p, v, _, t in results
                if v == "solved" and p.size == n and id(p) in reference
            ]
            row.append(f"{geometric_mean(ratios):.2f}" if ratios else "")
        rows.append(row)
    absolute = ["median, " + REFERENCE]
    for n in sizes:
        absolute.append(f"{1e6 * np.median([t for p, _, _, t in outcome[REFERENCE] if p.size == n]):.1f} us")
    return table(["time ratio at n =", *map(str, sizes)], [*rows, absolute])


def compiled_calls() -> str:
    """Time of a problem inside compiled code: a batch of many, divided by their number."""
    rows = []
    for n in (1, 2, 3, 5, 10):
        rng = np.random.default_rng(n)
        m = 20_000
        G = rng.normal(size=(m, n, n))
        W, b = G @ G.swapaxes(1, 2), rng.normal(size=(m, n))
        s, seconds = timed(lambda W=W, b=b: solve_lcp_batch(W, b))
        rows.append(
            [str(n), f"{1e6 * seconds / m:.3f} us", f"{s.residual.max():.0e}", f"{s.solved.mean():.0%}"]
        )
    return table(["n", "time a problem", "worst residual", "solved"], rows)


def chains(quick: bool) -> str:
    """Beads in a row thrown together: the Delassus form here, the velocity form by piqp and clarabel."""
    import qpsolvers
    import scipy.sparse as sp

    rows = []
    for n in (1000, 10_000) if quick else (1000, 10_000, 100_000):
        rng = np.random.default_rng(0)
        G = sp.diags_array([-np.ones(n), np.ones(n)], offsets=[0, 1], shape=(n, n + 1)).tocsc()
        v = rng.normal(size=n + 1)
        W, b = (G @ G.T).tocsr(), G @ v
        s, seconds = timed(lambda W=W, b=b: solve_lcp(W, b, "auto"))
        rows.append([str(n), "lcpstep auto", f"{1e3 * seconds:.1f} ms", f"{s.residual:.0e}", "1"])
        lower = -G
        lower.sort_indices()
        primal = qpsolvers.Problem(
            sp.identity(n + 1, format="csc"), -v, G=sp.csc_matrix(lower), h=np.zeros(n)
        )
        for name in ("piqp", "clarabel"):
            q, other = timed(lambda primal=primal, name=name: qpsolvers.solve_problem(primal, name))
            found = residual(W, b, np.maximum(q.z, 0.0))
            rows.append(
                [
                    str(n),
                    f"{name}, velocity form",
                    f"{1e3 * other:.1f} ms",
                    f"{found:.0e}",
                    f"{seconds / other:.2f}",
                ]
            )
    return table(["beads", "solver", "time", "residual", "ratio of lcpstep to it"], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="sizes up to 50")
    parser.add_argument("--output", type=Path, default=Path(__file__).with_name("results.md"))
    arguments = parser.parse_args()
    sizes = tuple(n for n in SIZES if n <= (50 if arguments.quick else SIZES[-1]))
    start = time.time()
    set_of = list(problems(sizes, REPEATS))
    outcome = collect(set_of)
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in PACKAGES)
    report = f"""# Complementarity solvers, measured

By `python -m benchmarks.lcp.compare`. {platform.machine()}, Python {platform.python_version()}; {versions}.
{len(set_of)} problems, all solvable, of {len(FAMILIES)} families (see problems.py), n from 1 to {sizes[-1]}; the QP
solvers get the symmetric positive semidefinite ones. Solved: claimed, and the judged residual is at most
{ACCURATE:.0e}; inaccurate: claimed, at most {CRUDE:.0e}; wrong: claimed, and worse; failed: not claimed.

## Reliability

{reliability(outcome)}
### What was not solved

{failures(outcome)}
## Time, called from Python, as a ratio to {REFERENCE}

Geometric means over the problems that both solved.

{speed(outcome)}
## Inside compiled code

Random positive definite problems, without a guess.

{compiled_calls()}
## Chains of beads

{chains(arguments.quick)}
"""
    arguments.output.write_text(report)
    print(report)
    print(f"{time.time() - start:.0f} s")


if __name__ == "__main__":
    main()
