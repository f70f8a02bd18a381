"""The solvers that are compared, each as (problem) -> z, whether it claims success, and seconds."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import time
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.lcp.problems import Problem
from lcpstep.lcp import solve_lcp

Answer = tuple[Any, bool, float]
LEAST = 2e-3  # seconds that a measurement should last
SLOW = 0.05  # seconds beyond which once more is enough
REPEATS = 5


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """Result and median seconds of a call."""
    start = time.perf_counter()
    result = call()
    once = time.perf_counter() - start
    number = max(1, min(200, int(LEAST / max(once, 1e-7))))
    seconds = []
    for _ in range(REPEATS if once < SLOW else 1):
        start = time.perf_counter()
        for _ in range(number):
            call()
        seconds.append((time.perf_counter() - start) / number)
    return result, float(np.median(seconds))


def ours(method: str, problem: Problem) -> Answer | None:
    if method == "qp" and not problem.symmetric:
        return None
    s, seconds = timed(lambda: solve_lcp(problem.W, problem.b, method))
    return s.z, s.solved, seconds


def quantecon(problem: Problem) -> Answer:
    from quantecon.optimize import lcp_lemke

    s, seconds = timed(lambda: lcp_lemke(problem.W, problem.b, max_iter=20_000))
    return s.z, bool(s.success), seconds


def bare_qp(name: str, problem: Problem) -> Answer | None:
    """A solver of qpsolvers as it comes, default tolerances."""
    import qpsolvers
    from scipy.sparse import csc_matrix

    if not problem.symmetric:
        return None
    P = csc_matrix(problem.W) if name in ("osqp", "clarabel") else problem.W
    lower = np.zeros(problem.n)

    def call() -> Any:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                return qpsolvers.solve_problem(qpsolvers.Problem(P, problem.b, lb=lower), name)
            except (ValueError, qpsolvers.exceptions.QPError):
                return None

    s, seconds = timed(call)
    if s is None or s.x is None:
        return np.zeros(problem.n), False, seconds
    return np.maximum(s.x, 0.0), bool(s.found), seconds


SOLVERS: dict[str, Callable[[Problem], Answer | None]] = {
    "lcpstep lemke": partial(ours, "lemke"),
    "quantecon lcp_lemke": quantecon,
    "lcpstep auto": partial(ours, "auto"),
    "lcpstep newton": partial(ours, "newton"),
    "lcpstep qp (osqp)": partial(ours, "qp"),
    **{
        f"bare {name}": partial(bare_qp, name)
        for name in ("osqp", "daqp", "quadprog", "piqp", "clarabel", "proxqp")
    },
}


def siconos(problems: list[Problem]) -> list[Answer] | None:
    """Siconos' Lemke on all problems, by the system's interpreter; None where it is not installed."""
    python = shutil.which("python3", path="/usr/bin:/usr/local/bin")
    if (
        python is None
        or subprocess.run([python, "-c", "import siconos.numerics"], capture_output=True).returncode
    ):
        return None
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "problems.npz"), Path(folder, "answers.npz")
        arrays = {f"{key}{i}": getattr(p, key) for i, p in enumerate(problems) for key in "Wb"}
        np.savez(source, **arrays)
        script = Path(__file__).with_name("siconos_lemke.py")
        subprocess.run([python, str(script), str(source), str(target)], check=True, capture_output=True)
        with np.load(target) as answers:
            return [
                (answers[f"z{i}"], bool(answers[f"report{i}"][0]), float(answers[f"report{i}"][1]))
                for i in range(len(problems))
            ]
