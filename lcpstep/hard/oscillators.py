"""Checks on oscillators with a stop: many impacts, sticking and release, an elastic chain."""

from __future__ import annotations

import math

import numpy as np

from lagrangian import scenes
from lagrangian.scenes.chain import ChainMotion
from lcpstep.hard.check import FIRST_ORDER, SECOND_ORDER, Found, Solver, check, state_error, states
from lcpstep.trajectory import Kind

states(
    "impact-oscillator",
    "states, T = 100 s",
    scenes.impact_oscillator,
    period=math.pi,
    event_driven=1e-10,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


@check("impact-oscillator", "number of impacts", period=math.pi, event_driven=0.0, located=0.0, moreau=0.0)
def number_of_impacts(solve: Solver) -> float:
    log = solve(scenes.impact_oscillator()).impacts
    return abs(int(np.sum(log.kind == Kind.IMPACT)) - 32)


@check("impact-oscillator", "steps from 1e-4 s to 1 s: error over its bound", period=math.pi, moreau=1.0)
def steps_of_any_size(solve: Solver) -> Found:
    scene = scenes.impact_oscillator()
    worst, note = 0.0, []
    for h in 10.0 ** np.arange(-4.0, 0.5):
        one = Solver(solve.method, math.pi)
        one.h = float(h)
        error = state_error(one, scene)
        solve.seconds += one.seconds
        worst = max(worst, error / (h * (one.jumps + one.speed)))
        note.append(f"{error:.0e}")
    return Found(worst, "errors " + " ".join(note))


states(
    "sticking-oscillator",
    "states through chattering and sticking",
    scenes.sticking_oscillator,
    period=6.28,
    event_driven=1e-9,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


@check("sticking-oscillator", "phase of the releases [rad]", period=6.28, event_driven=1e-9, located=4e-3)
def release(solve: Solver) -> float:
    log = solve(scenes.sticking_oscillator()).impacts
    phases = 0.25 * log.time[log.kind == Kind.RELEASE] % (2.0 * math.pi)
    return float(np.max(np.abs(phases - math.acos(0.25)))) if len(phases) == 3 else math.inf


states(
    "elastic-chain",
    "states, 10 springs",
    lambda: scenes.elastic_chain(n=10),
    period=0.5,
    event_driven=1e-9,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


def _release_time(solve: Solver, n: int) -> float:
    scene = scenes.elastic_chain(n=n, t_end=2.3)
    assert isinstance(scene.exact, ChainMotion)
    scene.exact(np.array([scene.t_span[1]]))
    log = solve(scene, keep=[scene.t_span[1]]).impacts
    found = log.time[log.kind == Kind.RELEASE]
    return float(abs(found[0] - scene.exact.releases[0])) if len(found) else math.inf


@check("elastic-chain", "time of release, 2 springs", period=0.5, event_driven=1e-9, located=2e-3)
def release_2(solve: Solver) -> float:
    return _release_time(solve, 2)


@check("elastic-chain", "time of release, 100 springs", period=0.05, event_driven=1e-9, located=2e-3)
def release_100(solve: Solver) -> float:
    return _release_time(solve, 100)


@check("elastic-chain", "time of release, 1000 springs", period=0.005, heavy=True, located=2e-3)
def release_1000(solve: Solver) -> float:
    return _release_time(solve, 1000)
