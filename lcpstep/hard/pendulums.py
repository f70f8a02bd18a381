"""Checks on systems that turn: pendulums with a stop, a wall, a joint; a bowl; a rocking block; a slider-crank."""

from __future__ import annotations

import math

import numpy as np

from lagrangian import scenes
from lagrangian.scenes.double_pendulum import (
    REFERENCE_IMPACTS,
    REFERENCE_STATES,
    REFERENCE_TIMES,
    as_points,
)
from lagrangian.scenes.pendulum import tension
from lagrangian.scenes.rocking_block import impact_ratio, rocking_times
from lagrangian.scenes.slider_crank import energy
from lcpstep.hard.check import (
    FIRST_ORDER,
    SECOND_ORDER,
    Found,
    Solver,
    check,
    sample_times,
    states,
)
from lcpstep.kernels.gauss import gauss
from lcpstep.trajectory import Kind

SWING = 2.0  # period of pendulums of a metre [s]
QUADRATURE = 8  # nodes for the impulse of a force


states(
    "pendulum-stop",
    "states, as an angle",
    scenes.pendulum_stop,
    period=SWING,
    event_driven=1e-10,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


states(
    "pendulum-stop",
    "states, as a point on a rod",
    lambda: scenes.pendulum_stop(form="rod"),
    period=SWING,
    event_driven=1e-10,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


@check(
    "pendulum-stop",
    "length of the rod",
    period=SWING,
    event_driven=1e-12,
    located=1e-12,
    moreau=FIRST_ORDER,
)
def length(solve: Solver) -> float:
    run = solve(scenes.pendulum_stop(form="rod"))
    return float(np.max(np.abs(np.hypot(run.q[:, 0], run.q[:, 1]) - 1.0)))


@check(
    "pendulum-stop",
    "tension of the rod, mean over 0.05 s [N]",
    period=SWING,
    event_driven=1e-8,
    located=1e-2,
    moreau=0.05,
)
def rod_tension(solve: Solver) -> float:
    scene = scenes.pendulum_stop(form="rod")
    plain = scenes.pendulum_stop().exact
    times = np.arange(0.0, 5.0, 0.05)
    run = solve(scene, keep=times)
    assert plain is not None
    nodes, weights = gauss(QUADRATURE)
    worst = 0.0
    hits = run.impacts.time
    for k in range(1, len(times)):
        if np.any((hits >= times[k - 1]) & (hits <= times[k])):
            continue  # the quadrature stops at jumps
        theta, rate = plain(times[k - 1] + 0.05 * nodes)
        mean = float(weights @ tension(theta, rate, 1.0, 9.81)[:, 0])
        worst = max(worst, abs(-float(run.joint_impulse[k, 0]) / 0.05 - mean))
    return worst


@check(
    "double-pendulum", "states", period=SWING, event_driven=1e-10, located=SECOND_ORDER, moreau=FIRST_ORDER
)
def double_states(solve: Solver) -> float:
    run = solve(scenes.double_pendulum(), keep=REFERENCE_TIMES)
    return float(np.max(np.abs(np.hstack([run.q, run.v]) - REFERENCE_STATES)))


@check(
    "double-pendulum",
    "states, as two points on rods",
    period=SWING,
    event_driven=1e-10,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)
def double_rods(solve: Solver) -> float:
    run = solve(scenes.double_pendulum(form="rods"), keep=REFERENCE_TIMES)
    return float(np.max(np.abs(np.hstack([run.q, run.v]) - as_points(REFERENCE_STATES))))


@check(
    "double-pendulum",
    "length of the rods",
    period=SWING,
    event_driven=1e-12,
    located=1e-12,
    moreau=FIRST_ORDER,
)
def double_lengths(solve: Solver) -> float:
    q = solve(scenes.double_pendulum(form="rods")).q
    return float(np.max(np.abs([np.hypot(*q[:, :2].T) - 1.0, np.hypot(*(q[:, 2:] - q[:, :2]).T) - 1.0])))


@check(
    "double-pendulum",
    "times of the impacts",
    period=SWING,
    event_driven=1e-10,
    located=8e-3,
    moreau=SWING / 200,
)
def double_impacts(solve: Solver) -> float:
    log = solve(scenes.double_pendulum()).impacts
    times = log.time[log.kind == Kind.IMPACT]
    if len(times) != len(REFERENCE_IMPACTS):
        return math.inf
    return float(np.max(np.abs(times - REFERENCE_IMPACTS)))


states(
    "bowl", "states", scenes.bowl, period=SWING, event_driven=1e-9, located=SECOND_ORDER, moreau=FIRST_ORDER
)


@check("bowl", "gap while it slides", period=SWING, event_driven=1e-12, located=1e-12, moreau=FIRST_ORDER)
def bowl_gap(solve: Solver) -> float:
    scene = scenes.bowl()
    run = solve(scene, keep=sample_times(scene))
    sliding = run.t > run.impacts.time[0]
    return float(np.max(np.abs(1.0 - np.hypot(run.q[sliding, 0], run.q[sliding, 1]))))


states(
    "rocking-block",
    "states, angle alone",
    scenes.rocking_block,
    period=0.6,
    event_driven=1e-9,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


@check(
    "rocking-block",
    "times of 20 impacts and rates after them",
    period=0.6,
    event_driven=1e-9,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)
def rocking_impacts(solve: Solver) -> float:
    scene = scenes.rocking_block()
    log = solve(scene).impacts
    log = log[log.kind == Kind.IMPACT][:20]
    p2, alpha = np.array(scene.p)
    times, rates = rocking_times(0.15, alpha, math.sqrt(p2), impact_ratio(0.1, 0.4), 20)
    after = impact_ratio(0.1, 0.4) * rates
    return max(float(np.max(np.abs(log.time - times))), float(np.max(np.abs(log.after - after))))


states(
    "rocking-block",
    "states, two corners with friction",
    lambda: scenes.rocking_block(form="corners"),
    period=0.6,
    event_driven=1e-9,
    moreau=FIRST_ORDER,
)


TURN = 2.0 * math.pi / 150.0  # of the crank [s]


@check(
    "slider-crank",
    "states, no friction, against half the step or tolerance",
    period=TURN,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)
def crank_converges(solve: Solver) -> Found:
    scene = scenes.slider_crank(mu=0.0)
    times = sample_times(scene)
    h = solve.h / 10.0
    coarse, fine = solve(scene, keep=times, h=h), solve(scene, keep=times, h=0.5 * h)
    hits = [int(np.sum(run.impacts.kind == Kind.IMPACT)) for run in (coarse, fine)]
    solve.h = h
    return Found(float(np.max(np.abs(coarse.q - fine.q))), f"{hits[0]} and {hits[1]} impacts")


@check(
    "slider-crank",
    "energy gained, no friction, relative",
    period=TURN,
    event_driven=1e-11,
    located=1e-4,
    moreau=1e-3,
)
def crank_energy(solve: Solver) -> float:
    return _energy_gained(solve, 0.0)


@check("slider-crank", "energy gained, with friction, relative", period=TURN, moreau=1e-3)
def crank_energy_friction(solve: Solver) -> float:
    return _energy_gained(solve, 0.01)


def _energy_gained(solve: Solver, mu: float) -> float:
    scene = scenes.slider_crank(mu=mu)
    run = solve(scene, keep=sample_times(scene))
    total = energy(run.q, run.v)
    start = energy(np.atleast_2d(scene.q0), np.atleast_2d(scene.v0))[0]
    return max(0.0, float(np.max(np.diff(np.concatenate([[start], total])))) / start)
