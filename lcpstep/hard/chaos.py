"""Checks on chaotic motion: statistics with standard errors, and the largest Lyapunov exponent.

Two runs of a chaotic system cannot be compared state by state. What can: means over the attractor, each with a
standard error from the scatter of independent runs (not from one run, whose impacts are correlated). The reference
is the event-driven run with other initial states. Lyapunov exponent: two runs are started `APART` from each other,
and one is drawn back to that distance once a period. Source: G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn,
Lyapunov characteristic exponents for smooth dynamical systems, Meccanica 15 (1980).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from lagrangian import Scene, scenes
from lcpstep.hard.check import Array, Found, Solver, check
from lcpstep.hard.methods import EVENT
from lcpstep.trajectory import Kind

RUNS = 12
PERIODS, TRANSIENT = 300, 50  # of every run, and those left out at its start
APART = 1e-7  # of the Lyapunov exponent's two runs
CONFIDENCE = 3.0  # standard errors
LEAST = 0.02  # exponent per period that counts as chaos


def _means(solve: Solver, scene: Scene, first: int) -> Array:
    """Mean impact speed, of its square, and impacts a period, one row for each of several runs."""
    rows = []
    for k in range(RUNS):
        q0 = float(np.asarray(scene.q0)[0]) * (1.0 + 0.01 * ((first + k) * 0.6180339887 % 1.0))
        span = (0.0, PERIODS * scene.period)
        run = solve(replace(scene, q0=q0, t_span=span), keep=[span[1]])
        log = run.impacts[(run.impacts.kind == Kind.IMPACT) & (run.impacts.time > TRANSIENT * scene.period)]
        speed = -log.before
        rows.append([np.mean(speed), np.mean(speed**2), len(log) / (PERIODS - TRANSIENT)])
    return np.array(rows)


def _statistics(solve: Solver, scene: Scene) -> Found:
    """Largest distance of the means from those of the event-driven reference, in standard errors."""
    mine, reference = _means(solve, scene, 0), _means(Solver(EVENT, scene.period), scene, RUNS)
    spread = np.sqrt((np.var(mine, axis=0, ddof=1) + np.var(reference, axis=0, ddof=1)) / RUNS)
    off = np.mean(mine, axis=0) - np.mean(reference, axis=0)
    relative = float(off[0] / np.mean(reference, axis=0)[0])
    return Found(float(np.max(np.abs(off) / spread)), f"mean impact speed {100.0 * relative:+.2f} %")


def _exponent(solve: Solver, scene: Scene, periods: int = 400) -> tuple[float, float]:
    """Largest Lyapunov exponent per period of the forcing, and its standard error from ten parts of the run."""
    growth, T = [], scene.period
    start = solve(replace(scene, t_span=(0.0, TRANSIENT * T)), keep=[TRANSIENT * T])
    x = np.concatenate([start.q[-1], start.v[-1]])
    apart = np.array([APART, 0.0])
    for _ in range(periods):
        ends = []
        for state in (x, x + apart):
            run = solve(replace(scene, q0=state[0], v0=state[1], t_span=(0.0, T)), keep=[T])
            ends.append(np.array([run.q[-1, 0], run.v[-1, 0]]))
        distance = float(np.linalg.norm(ends[1] - ends[0]))
        growth.append(math.log(max(distance, 1e-300) / APART))
        x, apart = ends[0], (ends[1] - ends[0]) * APART / max(distance, 1e-300)
        if scene.gap(0.0, x[:1] + apart[:1], x[1:])[0][0] < 0.0:
            apart = -apart
    parts = np.mean(np.array(growth).reshape(10, -1), axis=1)
    return float(np.mean(parts)), float(np.std(parts, ddof=1) / math.sqrt(10.0))


def _chaos(solve: Solver, scene: Scene) -> Found:
    """How far the exponent is from being positive by three standard errors."""
    exponent, error = _exponent(solve, scene)
    return Found(
        max(0.0, LEAST - (exponent - CONFIDENCE * error)), f"exponent {exponent:.3f} +- {error:.3f} a period"
    )


OSCILLATOR, CAM = 2.0 * math.pi / 2.2, 60.0 / 660.0  # periods of the forcing [s]


@check(
    "chaotic-oscillator",
    "statistics, in standard errors",
    period=OSCILLATOR,
    event_driven=3.0,
    located=3.0,
    moreau=3.0,
)
def oscillator(solve: Solver) -> Found:
    return _statistics(solve, scenes.chaotic_oscillator())


@check(
    "cam-follower",
    "statistics at 660 rpm, in standard errors",
    period=CAM,
    event_driven=3.0,
    located=3.0,
    moreau=3.0,
)
def cam(solve: Solver) -> Found:
    return _statistics(solve, replace(scenes.cam_follower(rpm=660.0), exact=None))


@check("chaotic-oscillator", "largest Lyapunov exponent is positive", period=OSCILLATOR, event_driven=0.0)
def oscillator_exponent(solve: Solver) -> Found:
    return _chaos(solve, scenes.chaotic_oscillator())


@check("cam-follower", "largest Lyapunov exponent at 660 rpm is positive", period=CAM, event_driven=0.0)
def cam_exponent(solve: Solver) -> Found:
    return _chaos(solve, replace(scenes.cam_follower(rpm=660.0), exact=None))
