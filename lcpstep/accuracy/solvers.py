"""Complementarity solvers inside one method: from where on does their tolerance, and not h, limit the motion?

    d(tol, h) = |motion with the solver at tol - motion with Lemke|,     e(h) = |motion with Lemke - reference|

Lemke's vertices are exact up to rounding, so that e is what the step costs and d what the solver adds. The
tolerance limits the motion from where d exceeds e.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.accuracy.errors import Difference, Motion
from lcpstep.errors import LcpStepError
from lcpstep.lcp import solve_lcp
from lcpstep.lcp.qp import TOLERANCES, known_solvers
from lcpstep.simulation import simulate
from lcpstep.trajectory import Status, Trajectory

EXACT = "lemke"
LEVELS = (1e-2, 1e-4, 1e-6, 1e-8)


@dataclass(frozen=True)
class SolverRun:
    """One run: solver as `Moreau` names it, step, tolerance (None for a solver without), and what came out.

    added is the distance from the run with Lemke, error that from the reference, error_of_step the same of the
    run with Lemke: all sup norms of the position [m]. seconds is CPU time.
    """

    solver: str
    tolerance: float | None
    h: float
    status: str
    added: float
    error: float
    error_of_step: float
    seconds: float
    lcp_calls: int
    message: str = ""

    @property
    def limits(self) -> bool:
        """Whether the solver, and not the step, decides the error."""
        return not self.added <= self.error_of_step


@dataclass(eq=False)
class Solvers:
    """Runs of every solver, tolerance and step; `str` gives the table and a verdict for each solver."""

    runs: list[SolverRun] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def limit(self, solver: str, h: float) -> float | None:
        """The tolerance above which a solver limits the motion at this step, between the levels tried.

        Where d crosses e, on a straight line in the logarithms; 0 where even the tightest level limits it, infinite
        where none does, None for a solver without tolerances.
        """
        runs = [r for r in self.runs if (r.solver, r.h) == (solver, h) and r.tolerance is not None]
        runs.sort(key=lambda r: r.tolerance or 0.0)
        if not runs:
            return None
        first = next((k for k, r in enumerate(runs) if r.limits), None)
        if first is None:
            return math.inf
        if first == 0:
            return 0.0
        a, b = runs[first - 1], runs[first]
        low, high = float(a.tolerance or 0.0), float(b.tolerance or 0.0)
        if not (a.added > 0.0 and math.isfinite(b.added)):
            return math.sqrt(low * high)
        share = math.log(b.error_of_step / a.added) / math.log(b.added / a.added)
        return low * (high / low) ** share

    def verdict(self, solver: str, h: float) -> str:
        """In words, from where on the solver limits the motion."""
        runs = [r for r in self.runs if (r.solver, r.h) == (solver, h)]
        limit = self.limit(solver, h)
        at = f"{solver} at h = {h:g}:"
        if limit is None:
            return f"{at} {'limits' if any(r.limits for r in runs) else 'does not limit'} the motion"
        tried = [r.tolerance for r in runs if r.tolerance is not None]
        if limit == 0.0:
            return f"{at} limits the motion at every tolerance tried, down to {min(tried):g}"
        if math.isinf(limit):
            return f"{at} does not limit the motion at any tolerance tried, up to {max(tried):g}"
        return f"{at} limits the motion for tolerances above {limit:.1g}"

    def as_dict(self) -> dict[str, Any]:
        """Numbers and verdicts for JSON."""
        rows = [vars(r) | {"limits": r.limits} for r in self.runs]
        rows = [
            {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in r.items()}
            for r in rows
        ]
        return {"runs": rows, "verdicts": self.verdicts(), "notes": self.notes}

    def verdicts(self) -> list[str]:
        """One sentence for each solver and step."""
        pairs = dict.fromkeys((r.solver, r.h) for r in self.runs if r.solver != EXACT)
        return [self.verdict(*pair) for pair in pairs]

    def __str__(self) -> str:
        lines = [
            f"{'solver':14}{'tolerance':>10}{'h':>10}{'added by it':>13}{'error':>11}{'CPU [s]':>10}{'LCPs':>8}"
        ]
        for r in self.runs:
            tolerance = "" if r.tolerance is None else f"{r.tolerance:g}"
            if r.status != "DONE":
                lines.append(f"{r.solver:14}{tolerance:>10}{r.h:>10.3g}  {r.status}: {r.message}")
                continue
            mark = " <- limits" if r.limits else ""
            lines.append(
                f"{r.solver:14}{tolerance:>10}{r.h:>10.3g}{r.added:>13.1e}{r.error:>11.1e}{r.seconds:>10.3g}"
                f"{r.lcp_calls:>8}{mark}"
            )
        return "\n".join([*lines, *self.verdicts(), *(f"note: {x}" for x in self.notes)])


def installed_solvers() -> list[str]:
    """QP solvers that are there, as `Moreau(lcp=...)` names them."""
    import qpsolvers

    return [f"qp:{name}" for name in known_solvers() if name in qpsolvers.available_solvers]


def compare_solvers(
    scene: Scene,
    method: Any,
    h: Sequence[float],
    reference: Motion,
    *,
    solvers: Sequence[str] | None = None,
    tolerances: Sequence[float] = LEVELS,
    progress: Callable[[str], None] | None = None,
) -> Solvers:
    """Run a time-stepping method with every complementarity solver and measure what each adds to the error.

    Parameters
    ----------
    method : a method with fields `h` and `lcp`, as `Moreau`
    h : steps [s]
    reference : the motion errors are measured against
    solvers : names as "qp:osqp"; default: all that are installed
    tolerances : of solvers that have one; their answers are then taken as they are, without polishing

    Raises
    ------
    TypeError   the method has no `lcp` to choose
    """
    if not (hasattr(method, "lcp") and hasattr(method, "h")):
        raise TypeError(
            f"method: expected one with a step h and a solver lcp, as lcpstep.Moreau, got {method!r}"
        )
    found, say = Solvers(), progress or (lambda _: None)
    for step in h:
        say(f"{EXACT}, h = {step:g}")
        exact, seconds, message = _run(scene, replace(method, h=step, lcp=EXACT))
        if exact is None:
            found.notes.append(f"h = {step:g} is left out: {message}")
            continue
        error = _apart(exact, reference)
        found.runs.append(_row(EXACT, None, step, exact, 0.0, error, error, seconds))
        for solver in installed_solvers() if solvers is None else solvers:
            levels = tolerances if solver.removeprefix("qp:") in TOLERANCES else (None,)
            for tolerance in levels:
                name = solver if tolerance is None else f"{solver}:{tolerance:g}"
                say(f"{name}, h = {step:g}")
                try:
                    run, seconds, message = _run(scene, replace(method, h=step, lcp=name))
                except (LcpStepError, ValueError) as refused:
                    run, seconds, message = None, math.nan, str(refused)
                if run is None:
                    lost = SolverRun(
                        solver, tolerance, step, "FAILED", math.inf, math.inf, error, seconds, 0, message
                    )
                    found.runs.append(lost)
                    continue
                errors = _apart(run, exact), _apart(run, reference), error
                found.runs.append(_row(solver, tolerance, step, run, *errors, seconds))
    return found


def _run(scene: Scene, method: Any) -> tuple[Trajectory | None, float, str]:
    """The run, or None and why it failed; its CPU time."""
    solve_lcp(np.eye(1), np.array([-1.0]), method=method.lcp)  # loads the solver
    begin = time.process_time()
    try:
        run = simulate(scene, method)
    except (LcpStepError, ValueError) as error:
        return None, time.process_time() - begin, str(error)
    seconds = time.process_time() - begin
    return (run, seconds, run.message) if run.status is Status.DONE else (None, seconds, run.message)


def _apart(a: Motion, b: Motion) -> float:
    return Difference(a, b).sup_position


def _row(
    solver: str, tolerance: float | None, h: float, run: Trajectory, added: float, error: float, of_step: float,
    seconds: float,
) -> SolverRun:  # fmt: skip
    return SolverRun(solver, tolerance, h, "DONE", added, error, of_step, seconds, run.counts.lcp_calls)
