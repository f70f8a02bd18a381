"""Checks on motions that stick and slip: where and when they stop or roll, belts, a superball, work of friction."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lagrangian import Scene, scenes
from lagrangian.scenes.belts import shaken_arc, stick_slip_period
from lagrangian.scenes.dry_friction import slip_time
from lagrangian.scenes.slider_crank import energy
from lcpstep.hard.check import FIRST_ORDER, SECOND_ORDER, Found, Solver, check, states
from lcpstep.hard.work import unbalanced
from lcpstep.trajectory import Kind, Trajectory

TURN = 2.0 * math.pi


def times(run: Trajectory, kind: Kind, contact: int = 0) -> Any:
    """When this happened at a contact."""
    return run.impacts.time[(run.impacts.kind == kind) & (run.impacts.contact == contact)]


@check(
    "coulomb-oscillator",
    "stops at its place",
    period=TURN,
    moreau=FIRST_ORDER,
    event_driven=1e-12,
    located=SECOND_ORDER,
)
def stops_at_its_place(solve: Solver) -> float:
    return abs(float(solve(scenes.coulomb_oscillator()).q[-1, 0]) + 0.05)


@check(
    "coulomb-oscillator",
    "times of turning and stopping",
    period=TURN,
    event_driven=1e-11,
    located=SECOND_ORDER,
)
def turns(solve: Solver) -> float:
    run = solve(scenes.coulomb_oscillator())
    found = np.append(times(run, Kind.REVERSE), times(run, Kind.STICK_TANGENT))
    return float(np.max(np.abs(found - math.pi * np.arange(1, 6)))) if len(found) == 5 else math.inf


@check("slipping-wheel", "time at which it begins to roll", period=0.5, event_driven=1e-12, located=1e-12)
def begins_to_roll(solve: Solver) -> float:
    found = times(solve(scenes.slipping_wheel()), Kind.STICK_TANGENT)
    return abs(float(found[0]) - slip_time(1.0, 0.2, 0.5, 9.81)) if len(found) == 1 else math.inf


states(
    "mass-on-belt",
    "states",
    scenes.mass_on_belt,
    period=TURN,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


states(
    "mass-on-belt",
    "states, from far off",
    lambda: scenes.mass_on_belt(belt=0.5, mu=0.1, x0=-2.5, v0=0.9),
    period=TURN,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check(
    "mass-on-belt",
    "velocity while it is carried",
    period=TURN,
    moreau=1e-12,
    event_driven=1e-12,
    located=1e-12,
)
def carried(solve: Solver) -> float:
    scene = scenes.mass_on_belt()
    run = solve(scene, keep=np.linspace(0.5, 3.0, 50))  # carried from 0.25 s to 3.2 s
    return float(np.max(np.abs(run.v[:, 0] - 0.2)))


states(
    "stick-slip-belt",
    "states",
    scenes.stick_slip_belt,
    period=TURN,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check("stick-slip-belt", "period of the orbit", period=TURN, event_driven=1e-11, located=SECOND_ORDER)
def orbit_period(solve: Solver) -> float:
    slips = times(solve(scenes.stick_slip_belt()), Kind.SLIP)
    return float(np.max(np.abs(np.diff(slips) - stick_slip_period(0.2, 0.6, 1.0))))


@check(
    "stick-slip-belt",
    "period, Stribeck's coefficient, against a quadrature",
    period=TURN,
    event_driven=1e-10,
    located=SECOND_ORDER,
)
def stribeck_period(solve: Solver) -> float:
    slips = times(solve(scenes.stick_slip_belt(decay=0.3)), Kind.SLIP)
    return float(np.max(np.abs(np.diff(slips) - slip_and_ride(0.2, 0.6, 1.0, 0.3))))


def slip_and_ride(belt: float, mu: float, mu_s: float, decay: float) -> float:
    """Period on an even belt by Stribeck's coefficient: the slip integrated on its own, and the ride back."""
    from scipy.integrate import solve_ivp

    def rates(_: float, y: Any) -> list[float]:
        friction = mu + (mu_s - mu) * math.exp(-abs(belt - y[1]) / decay)
        return [y[1], friction - y[0]]

    def caught(t: float, y: Any) -> float:
        return float(y[1] - belt) if t > 0.5 else -1.0  # not the slip itself

    caught.terminal = True  # type: ignore[attr-defined]
    start = [mu_s * (1.0 + 1e-15), belt]
    done = solve_ivp(rates, (0.0, 20.0), start, method="DOP853", rtol=1e-13, atol=1e-14, events=caught)
    return float(done.t_events[0][0] + (mu_s - done.y_events[0][0][0]) / belt)


states(
    "mass-on-shaken-belt",
    "states",
    scenes.mass_on_shaken_belt,
    period=TURN,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check(
    "mass-on-shaken-belt",
    "times of turning, over 20 periods",
    period=TURN / 1.5,
    event_driven=1e-10,
    located=SECOND_ORDER,
)
def shaken_turns(solve: Solver) -> float:
    half = math.pi / 1.5
    found = times(solve(scenes.mass_on_shaken_belt(t_end=40.5 * half)), Kind.REVERSE)
    found = found[found > 0.5 * half]
    return float(np.max(np.abs(found - half * np.arange(1, 41)))) if len(found) == 40 else math.inf


@check("mass-on-shaken-belt", "amplitude", period=TURN / 1.5, event_driven=1e-10)
def shaken_amplitude(solve: Solver) -> float:
    x, v, _ = shaken_arc(0.1, 1.5)
    t = math.atan(math.tan(0.25 * TURN / 1.5))  # where v = 0
    assert abs(float(v(np.array([t]))[0])) < 1e-15
    run = solve(scenes.mass_on_shaken_belt(), keep=t + TURN / 1.5 * np.arange(9))
    return float(np.max(np.abs(run.q[:, 0] - float(x(np.array([t]))[0]))))


states(
    "superball",
    "states",
    scenes.superball,
    period=0.64,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


states(
    "superball",
    "states, to and fro over one place",
    lambda: scenes.superball(spin=1.0 / (0.4 * 0.03)),
    period=0.64,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


states(
    "superball",
    "states, sliding through its impacts",
    lambda: scenes.superball(v0=3.0, mu=0.1),
    period=0.64,
    moreau=FIRST_ORDER,
    event_driven=1e-10,
    located=SECOND_ORDER,
)


@check(
    "sliding-rocking-block",
    "states as its corner stops",
    period=1.0,
    event_driven=1e-10,
    located=SECOND_ORDER,
)
def rocks_and_slides(solve: Solver) -> float:
    scene = scenes.sliding_rocking_block(t_end=0.1)
    found = times(solve(scene), Kind.STICK_TANGENT)
    return abs(float(found[0]) - sliding_end(scene)) if len(found) else math.inf


def sliding_end(scene: Scene) -> float:
    """When the corner of the rocking block stops: its normal force eliminated by hand, two equations left."""
    from scipy.integrate import solve_ivp

    b, h = np.asarray(scene.p, dtype=float)
    mu, g, J = float(scene.parameters["mu"]), float(scene.parameters["g"]), (b * b + h * h) / 3.0

    def arms(angle: float) -> tuple[float, float]:
        s, c = math.sin(angle), math.cos(angle)
        return b * c - h * s, b * s + h * c

    def rates(_: float, y: Any) -> list[float]:
        _, angle, spin = y
        a, w = arms(angle)
        force = (g - w * spin**2) / (1.0 + a * (a + mu * w) / J)  # slides forwards
        return [-mu * force, spin, -(a + mu * w) * force / J]

    def slip(_: float, y: Any) -> float:
        return float(y[0] + arms(y[1])[1] * y[2])

    slip.terminal = True  # type: ignore[attr-defined]
    start = [float(np.asarray(scene.v0)[0]), float(np.asarray(scene.q0)[2]), 0.0]
    done = solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-13, atol=1e-14, events=slip)
    return float(done.t_events[0][0])


@check(
    "sliding-rocking-block",
    "friction against momentum, normal forces against weight and momentum",
    period=1.0,
    moreau=1e-12,
    event_driven=1e-10,
    located=1e-12,
)
def momentum(solve: Solver) -> Found:
    run = solve(scenes.sliding_rocking_block())
    gained = run.v[-1, :2] - np.asarray(run.scene.v0)[:2]
    across = float(np.sum(run.friction_impulse)) - gained[0]
    up = float(np.sum(run.impulse)) - 9.81 * float(run.t[-1]) - gained[1]
    return Found(max(abs(across), abs(up)), f"{np.sum(run.impacts.kind == Kind.IMPACT)} impacts")


# Of the largest energy, for a tolerance of 1e-12 and some hundred steps
BALANCED = {
    "coulomb-oscillator": scenes.coulomb_oscillator,
    "mass-on-belt": scenes.mass_on_belt,
    "stick-slip-belt": scenes.stick_slip_belt,
    "mass-on-shaken-belt": scenes.mass_on_shaken_belt,
    "slipping-wheel": scenes.slipping_wheel,
    "sliding-block": scenes.sliding_block,
    "slope-landing": scenes.slope_landing,
    "superball": scenes.superball,
    "falling-rod": scenes.falling_rod,
    "woodpecker": scenes.woodpecker,
    "slider-crank": scenes.slider_crank,
    "sliding-rocking-block": scenes.sliding_rocking_block,
}


def _balance(name: str, make: Any) -> None:
    @check(name, "energy between impacts against the work of friction", event_driven=1e-10)
    def balance(solve: Solver) -> float:
        return unbalanced(solve(make()), energy if name == "slider-crank" else None)


for _name, _make in BALANCED.items():
    _balance(_name, _make)
