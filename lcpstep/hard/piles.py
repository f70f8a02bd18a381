"""Checks on blocks at rest: they stay, and the forces between them are the weights."""

from __future__ import annotations

import numpy as np

from lagrangian import scenes
from lagrangian.scenes.beads import weights_above
from lcpstep.hard.check import Found, Solver, check

STEPS_AT_REST = 2**17
LAST = 2.0**-8  # time over which the forces are taken [s]


def _feet(solve: Solver, n: int, steps: int) -> Found:
    """Speed, moves, and residuals of the balances of force and moment (relative), after many steps."""
    scene = scenes.block_on_feet(n=n)
    run = solve(scene, keep=np.array([1.0 - LAST, 1.0]), h=1.0 / steps)
    forces = run.impulse[-1] / LAST
    feet = np.linspace(-0.5, 0.5, n)
    parts = {
        "speed": float(np.max(np.abs(run.v))),
        "moved": float(np.max(np.abs(run.q))),
        "force": abs(float(np.sum(forces)) / 9.81 - 1.0),
        "moment": abs(float(forces @ feet) / 9.81 - 0.1),
        "pulling": max(0.0, -float(np.min(forces)) / 9.81),
    }
    return Found(max(parts.values()), ", ".join(f"{name} {x:.0e}" for name, x in parts.items()))


@check("block-on-feet", "at rest on 2 feet, 1e5 steps", event_driven=1e-13, located=1e-13, moreau=1e-13)
def two_feet(solve: Solver) -> Found:
    return _feet(solve, 2, STEPS_AT_REST)


@check("block-on-feet", "at rest on 10 feet, 1e5 steps", event_driven=1e-13, located=1e-13, moreau=1e-13)
def ten_feet(solve: Solver) -> Found:
    return _feet(solve, 10, STEPS_AT_REST)


@check("block-on-feet", "at rest on 100 feet, 1e3 steps", event_driven=1e-13, located=1e-13, moreau=1e-13)
def many_feet(solve: Solver) -> Found:
    return _feet(solve, 100, 2**10)


@check("stack", "at rest, 10 blocks on 20 feet, 1e4 steps", event_driven=1e-13, located=1e-13, moreau=1e-13)
def stack(solve: Solver) -> Found:
    run = solve(scenes.stack(), keep=np.array([1.0 - LAST, 1.0]), h=2.0**-13)
    forces = run.impulse[-1].reshape(-1, 2) / LAST
    weights = weights_above(np.ones(10), 9.81)
    parts = {
        "speed": float(np.max(np.abs(run.v))),
        "moved": float(np.max(np.abs(run.q))),
        "forces": float(np.max(np.abs(np.sum(forces, axis=1) / weights - 1.0))),
    }
    return Found(max(parts.values()), ", ".join(f"{name} {x:.0e}" for name, x in parts.items()))


def _heavy(solve: Solver, ratio: float) -> Found:
    run = solve(scenes.heavy_on_light(ratio=ratio), keep=np.array([1.0 - LAST, 1.0]), h=2.0**-10)
    error = run.impulse[-1] / LAST / weights_above([1.0, ratio], 9.81) - 1.0
    # What the floor carries beyond the heavy block is the weight of the light one
    return Found(float(np.max(np.abs(error))), f"speed {float(np.max(np.abs(run.v))):.0e}")


@check(
    "heavy-on-light",
    "contact forces, mass ratio 1e3, relative",
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-13,
)
def heavy_3(solve: Solver) -> Found:
    return _heavy(solve, 1e3)


@check(
    "heavy-on-light",
    "contact forces, mass ratio 1e9, relative",
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-13,
)
def heavy_9(solve: Solver) -> Found:
    return _heavy(solve, 1e9)


@check(
    "heavy-on-light",
    "contact forces, mass ratio 1e12, relative",
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-13,
)
def heavy_12(solve: Solver) -> Found:
    return _heavy(solve, 1e12)
