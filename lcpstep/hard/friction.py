"""Checks on dry friction: stopping, rolling, landing, and the impact that creates energy."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from lagrangian import Scene, scenes
from lagrangian.scenes.dry_friction import slip_time
from lagrangian.scenes.kane_pendulum import after_impact, kinetic_energy
from lcpstep.hard.check import FIRST_ORDER, SECOND_ORDER, Found, Solver, check, states

states(
    "coulomb-oscillator",
    "states",
    scenes.coulomb_oscillator,
    period=2.0 * math.pi,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check(
    "coulomb-oscillator",
    "stops exactly, within the dead zone",
    period=2.0 * math.pi,
    moreau=0.0,
    event_driven=0.0,
    located=0.0,
)
def stops(solve: Solver) -> Found:
    run = solve(scenes.coulomb_oscillator(), keep=np.array([18.0, 19.0, 20.0]))
    moved = float(np.ptp(run.q[:, 0]))
    speed = float(np.max(np.abs(run.v)))
    return Found(max(moved, speed), f"at {run.q[-1, 0]:.12f}, speed {speed:.0e}")


states(
    "slipping-wheel",
    "states",
    scenes.slipping_wheel,
    period=0.5,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check(
    "slipping-wheel",
    "rolls without slip from then on",
    period=0.5,
    moreau=1e-12,
    event_driven=1e-12,
    located=1e-12,
)
def rolls(solve: Solver) -> float:
    run = solve(scenes.slipping_wheel())
    rolling = run.t > 1.05 * slip_time(1.0, 0.2, 0.5, 9.81)
    return float(np.max(np.abs(run.v[rolling, 0] + 0.3 * run.v[rolling, 2])))


states(
    "sliding-block",
    "states",
    scenes.sliding_block,
    period=0.5,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check("sliding-block", "stops exactly", period=0.5, moreau=0.0, event_driven=0.0, located=0.0)
def block_stops(solve: Solver) -> float:
    return float(np.max(np.abs(solve(scenes.sliding_block()).v[-1])))


states(
    "slope-landing",
    "states: slides, then stops",
    scenes.slope_landing,
    period=0.5,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


states(
    "slope-landing",
    "states: sticks as it lands",
    lambda: scenes.slope_landing(mu=2.5),
    period=0.5,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


states(
    "slope-landing",
    "states: slides for ever",
    lambda: scenes.slope_landing(mu=0.2),
    period=0.5,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


BRIEF = 1e-6  # after which the velocities are looked at [s]


def _kane(solve: Solver, scene: Scene) -> tuple[float, float]:
    """Error of the velocities after the impact, and the energy gained."""
    v = solve(replace(scene, t_span=(0.0, BRIEF)), h=0.1 * BRIEF).v[-1]
    q0 = np.array(scene.q0)
    gained = kinetic_energy(q0, v) / kinetic_energy(q0, np.array(scene.v0)) - 1.0
    return float(np.max(np.abs(v - after_impact(scene)))), gained


@check(
    "kane-pendulum",
    "velocities after the impact, Newton and Coulomb",
    moreau=1e-6,
    event_driven=1e-6,
    located=1e-6,
)
def kane_newton(solve: Solver) -> Found:
    error, gained = _kane(solve, scenes.kane_pendulum(law="newton"))
    return Found(error, f"energy {100.0 * gained:+.2f} %, as this law has it")


@check(
    "kane-pendulum", "velocities after the impact, Moreau's law", moreau=1e-6, event_driven=1e-6, located=1e-6
)
def kane_moreau(solve: Solver) -> Found:
    error, gained = _kane(solve, scenes.kane_pendulum())
    return Found(error, f"energy {100.0 * gained:+.2f} %")


@check("kane-pendulum", "energy gained under the default law", moreau=0.0, event_driven=0.0, located=0.0)
def kane_energy(solve: Solver) -> float:
    return max(0.0, _kane(solve, scenes.kane_pendulum())[1])


@check(
    "woodpecker",
    "friction impulses against weight and momentum",
    period=0.146,
    moreau=1e-12,
    event_driven=1e-11,
    located=1e-12,
)
def woodpecker(solve: Solver) -> Found:
    run = solve(scenes.woodpecker())
    system: Any = run.scene.system
    M, weight = system.M, float(system.force.constant[0])
    gained = M[0] @ (run.v[-1] - np.array(run.scene.v0)) - weight * (run.t[-1] - run.t[0])
    pecks = run.impacts.time[run.impacts.contact == 0]
    lost = abs(float(np.sum(run.friction_impulse)) - gained) / abs(weight)
    return Found(lost, f"last pecks {pecks[-1] - pecks[-2]:.9f} s apart")


@check(
    "woodpecker",
    "height, against half the step or tolerance",
    period=0.146,
    moreau=FIRST_ORDER,
    located=SECOND_ORDER,
)
def woodpecker_height(solve: Solver) -> float:
    coarse, fine = (solve(scenes.woodpecker(), h=h) for h in (solve.h, 0.5 * solve.h))
    return abs(float(coarse.q[-1, 0] - fine.q[-1, 0]))


@check("falling-rod", "states", period=1.0, moreau=FIRST_ORDER, event_driven=1e-10, located=SECOND_ORDER)
def rod(solve: Solver) -> float:
    scene = scenes.falling_rod(t_end=0.15)
    run = solve(scene)
    return float(np.max(np.abs(run.q[-1] - sliding_rod(scene, run.t[-1]))))


def sliding_rod(scene: Scene, t: float) -> np.ndarray[Any, Any]:
    """Position of the sliding rod at t: its normal force eliminated by hand, two equations left."""
    from scipy.integrate import solve_ivp

    half, g = np.asarray(scene.p, dtype=float)
    mu, J = float(scene.parameters["mu"]), 1.0 / 12.0

    def rates(_: float, y: Any) -> list[float]:
        x_t, angle, spin = y[1], y[2], y[3]
        s, c = half * math.sin(angle), half * math.cos(angle)
        force = (g - s * spin**2) / (1.0 + c * (c - mu * s) / J)
        return [x_t, mu * force, spin, (mu * s - c) * force / J]

    q, v = np.asarray(scene.q0), np.asarray(scene.v0)
    start = [q[0], v[0], q[2], v[2]]
    x, _, angle, _ = solve_ivp(rates, (0.0, t), start, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    return np.array([x, half * math.sin(angle), angle])
