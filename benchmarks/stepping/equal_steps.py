"""The same scene, step and theta in the library and in Siconos: time of the run, and the error of each."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.stepping.moreau import mean_error
from benchmarks.stepping.peer import Siconos
from benchmarks.stepping.questions import BALL, CAM, Question, errors_of
from benchmarks.stepping.timing import clocked, ratio, take_turns
from lcpstep import Moreau, simulate

STEPS = (1e-3, 1e-4, 1e-5)
DRIVERS = ("run", "python", "force")  # see `peer_worker`


def equal_steps(peer: Siconos | None, rounds: int) -> list[dict[str, Any]]:
    return [one(question, h, peer, rounds) for question in (BALL, CAM) for h in STEPS]


def one(question: Question, h: float, peer: Siconos | None, rounds: int) -> dict[str, Any]:
    """One scene and step."""
    scene, method, steps = question.scene(), Moreau(h), round(question.t_end / h)
    request = {"scene": question.name, "t_end": question.t_end, "h": h}
    runs = {"library": clocked(lambda: simulate(scene, method))}
    for driver in drivers(question) if peer else ():
        runs[driver] = peer.timed(method=driver, **request)  # type: ignore[union-attr]
    timings = take_turns(runs, rounds)
    motion = simulate(scene, method)
    row: dict[str, Any] = {"scene": question.name, "h": h, "steps": steps, **errors_of(question, motion)}
    row["mean_sup_q"] = mean_error(question, h)
    for name, timing in timings.items():
        row[f"{name} [s/run]"] = timing.per(1)
        if name != "library":
            row[f"{name} / library"] = ratio(timing, timings["library"])
    return row | (siconos_errors(question, peer, request, motion.q[:, 0]) if peer else {})


def drivers(question: Question) -> tuple[str, ...]:
    """The ball's force is a constant, which no function computes."""
    return DRIVERS[:2] if question is BALL else DRIVERS


def siconos_errors(question: Question, peer: Siconos, request: dict[str, Any], ours: Any) -> dict[str, Any]:
    """Error of Siconos' motion, and how far it lies from the library's."""
    rows = peer.motion(method="python", **request)
    if isinstance(rows, str):
        return {"siconos_error": rows}
    t, q, v = rows.T
    jumps = np.flatnonzero((v[:-1] < 0.0) & (v[1:] > 0.0) & (q[:-1] < 1e-2))
    first = float(t[jumps[0] + 1]) if len(jumps) else float("nan")
    errors = {f"siconos_{name}": value for name, value in question.errors(t, q, first).items()}
    shared = min(len(q), len(ours))
    return errors | {"siconos_apart": float(np.max(np.abs(q[:shared] - ours[:shared])))}
