"""The event-driven integrator: microseconds per run and per impact, and the error, at several tolerances."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.stepping.peer import Siconos
from benchmarks.stepping.questions import (
    BALL,
    LONG,
    READY,
    USER_LINEAR,
    USER_NONLINEAR,
    Question,
    errors_of_events,
    impact_times,
)
from benchmarks.stepping.timing import clocked, take_turns
from lcpstep import EventDriven, Kind, Trajectory, simulate

TOLERANCES = (1e-6, 1e-9, 1e-12)
LOOKS = 100  # times at which Siconos' event-driven run is stopped to be looked at


def library(rounds: int) -> list[dict[str, Any]]:
    rows = [one(question, tolerance, rounds) for question in READY for tolerance in TOLERANCES]
    rows.append(one(LONG, TOLERANCES[-1], rounds) | {"scene": "impact-oscillator, 400 s"})
    return rows + [one(question, TOLERANCES[-1], rounds) for question in (USER_LINEAR, USER_NONLINEAR)]


def one(question: Question, tolerance: float, rounds: int) -> dict[str, Any]:
    """One scene and tolerance; the motion has its dense output."""
    scene, method = question.scene(), EventDriven(rtol=tolerance, atol=tolerance)
    motion = simulate(scene, method)
    timing = take_turns({"run": clocked(lambda: simulate(scene, method))}, 5 * rounds)["run"]
    impacts = len(impact_times(motion))
    row = {"scene": question.name, "tolerance": tolerance, "impacts": impacts, "steps": motion.counts.steps}
    return row | {"run [s]": timing.per(1), "impact [s]": timing.per(impacts)} | errors(question, motion)


def errors(question: Question, motion: Trajectory) -> dict[str, float]:
    """Against closed forms and fifty digits; a user's scene against the integrator at its tightest."""
    if question in (USER_LINEAR, USER_NONLINEAR):
        t = np.linspace(0.0, question.t_end, 10_001)
        first = abs(float(impact_times(motion)[0]) - question.first_impact())
        apart = motion.at(t)[0][:, 0] - question.position(t)
        return {"sup_q": float(np.max(np.abs(apart))), "first_impact": first}
    found = errors_of_events(question, motion)
    if question is BALL:
        found["accumulation"] = accumulation_error(motion)
    return found


def accumulation_error(motion: Trajectory) -> float:
    """Relative error of the time at which the ball comes to rest."""
    log, exact = motion.impacts, math.sqrt(2.0 / 9.81) * 1.8 / 0.2
    found = log.time[log.kind == Kind.ACCUMULATION]
    return abs(float(found[0]) / exact - 1.0) if len(found) else math.nan


def siconos(peer: Siconos, rounds: int) -> list[dict[str, Any]]:
    """Siconos' EventDriven, at its default tolerance and at the library's."""
    rows = []
    for question in READY:
        for tolerance in (None, *TOLERANCES):
            request: dict[str, Any] = {"scene": question.name, "t_end": question.t_end, "method": "events"}
            request["h"] = question.t_end / LOOKS
            if tolerance is not None:
                request["tolerance"] = tolerance
            rows.append(
                {"scene": question.name, "tolerance": tolerance} | run(question, peer, request, rounds)
            )
    return rows


def run(question: Question, peer: Siconos, request: dict[str, Any], rounds: int) -> dict[str, Any]:
    motion = peer.motion(**request)
    if isinstance(motion, str):
        return {"fails": motion}
    t, q, _ = motion.T
    timing = take_turns({"run": peer.timed(**request)}, rounds)["run"]
    impacts = peer.ask(**request)["steps"]
    error = float(np.max(np.abs(q - question.position(t))))
    return {"impacts": impacts, "run [s]": timing.per(1), "sup_q": error}
