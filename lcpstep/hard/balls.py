"""Checks on balls: Zeno's paradox, impacts on the grid, a million bounces, steps of any size."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from lagrangian import scenes
from lagrangian.scenes.bouncing_ball import impact_times
from lagrangian.scenes.grazing import touch
from lcpstep.hard.check import FIRST_ORDER, Found, Solver, check, state_error, states
from lcpstep.trajectory import Kind

FALL = 0.9  # a flight of the bouncing ball, up and down [s]


states(
    "bouncing-ball",
    "states through the accumulation",
    scenes.bouncing_ball,
    period=FALL,
    event_driven=1e-13,
    located=1e-12,
    moreau=FIRST_ORDER,
)


@check(
    "bouncing-ball",
    "exactly at rest in the end",
    period=FALL,
    event_driven=0.0,
    located=0.0,
    moreau=0.0,
)
def ball_at_rest(solve: Solver) -> float:
    return float(abs(solve(scenes.bouncing_ball()).v[-1, 0]))


@check("bouncing-ball", "steps from 1e-5 s to 1 s: error over its bound", period=FALL, moreau=1.0)
def steps_of_any_size(solve: Solver) -> Found:
    scene = scenes.bouncing_ball()
    worst, note = 0.0, []
    for h in 10.0 ** np.arange(-5.0, 0.5):
        one = Solver(solve.method, FALL)
        one.h = float(h)
        error = state_error(one, scene)
        allowed = h * (one.jumps + one.speed)
        solve.seconds += one.seconds
        worst = max(worst, error / allowed)
        note.append(f"{error:.0e}")
    return Found(worst, "errors " + " ".join(note))


@check("bouncing-ball", "steps from 1e-5 s to 1 s: states", period=FALL, located=1e-12)
def any_size_exact(solve: Solver) -> Found:
    worst, note = 0.0, []
    for h in 10.0 ** np.arange(-5.0, 0.5):
        one = Solver(solve.method, FALL)
        one.h = float(h)
        worst = max(worst, error := state_error(one, scenes.bouncing_ball()))
        solve.seconds += one.seconds
        note.append(f"{error:.0e}")
    return Found(worst, "errors " + " ".join(note))


@check("dyadic-ball", "times of the impacts", period=1.0, event_driven=1e-15, located=1e-15, moreau=0.01)
def dyadic_times(solve: Solver) -> float:
    log = solve(scenes.dyadic_ball()).impacts
    n = 20 if solve.method != "moreau" else 5
    times = log.time[log.kind == Kind.IMPACT][:n]
    return (
        float(np.max(np.abs(times - impact_times(1.0, 0.0, 2.0, 0.5, len(times)))))
        if len(times) == n
        else math.inf
    )


@check(
    "dyadic-ball",
    "the same answer for h and h (1 + eps)",
    period=1.0,
    located=1e-12,
    moreau=FIRST_ORDER,
)
def dyadic_step(solve: Solver) -> float:
    h, scene = 2.0**-10, scenes.dyadic_ball(t_end=2.25)
    ends = [solve(scene, h=x).q[-1, 0] for x in (h * (1.0 - 2.0**-52), h, h * (1.0 + 2.0**-52))]
    solve.h = h
    return float(np.ptp(ends))


def _bounces(solve: Solver, n: int) -> float:
    scene = scenes.elastic_ball(bounces=n)
    period = scene.t_span[1] / n
    early = (n - 0.25) * period  # on the last way up, at three quarters of the height
    run = solve(replace(scene, t_span=(0.0, early)), keep=[early])
    q, v = float(run.q[-1, 0]), float(run.v[-1, 0])
    energy = abs((0.5 * v * v + 9.81 * q) / 9.81 - 1.0)
    phase = abs(v - 9.81 * 0.25 * period) / (9.81 * period)
    return max(energy, phase)


@check("elastic-ball", "energy and phase after 1e5 bounces", period=FALL, event_driven=1e-9)
def many_bounces(solve: Solver) -> float:
    return _bounces(solve, 100_000)


@check("elastic-ball", "energy and phase after 1e6 bounces", period=FALL, heavy=True, event_driven=1e-9)
def a_million_bounces(solve: Solver) -> float:
    return _bounces(solve, 1_000_000)


@check("elastic-ball", "energy and phase after 100 bounces", period=FALL, located=1e-9, moreau=0.1)
def some_bounces(solve: Solver) -> float:
    return _bounces(solve, 100)


@check(
    "grazing", "speed of the touch at depths from 1e-2 to 1e-12 m, h = 0.1 s", period=10.0,
    event_driven=1.6e-8, located=1.6e-8, moreau=1.6e-8,
)  # fmt: skip
def grazing_depths(solve: Solver) -> Found:
    worst, missed = 0.0, []
    for d in 10.0 ** -np.arange(2.0, 12.5):
        log = solve(scenes.grazing(d=float(d)), h=0.1).impacts
        u = log.before[log.kind == Kind.IMPACT]
        if len(u) == 0:
            missed.append(d)
        speed = -float(u[0]) if len(u) else 0.0
        worst = max(worst, abs(speed - touch(float(d), 1.0, 1.03125)[1]))
    return Found(worst, f"missed depths: {len(missed)} of 11" if missed else "")
