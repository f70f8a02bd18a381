"""Checks on beads on a line: gases, Galperin's blocks, the cradle, collapse, columns that come to rest."""

from __future__ import annotations

import math

import numpy as np

from lagrangian import Scene, scenes
from lagrangian.scenes.beads import collisions, weights_above
from lcpstep.hard.check import FIRST_ORDER, Found, Solver, check, states
from lcpstep.trajectory import Kind

FLIGHT = 0.1  # typical time between impacts of a bead [s]


states(
    "elastic-gas",
    "states, 12 beads",
    scenes.elastic_gas,
    period=FLIGHT,
    event_driven=1e-9,
    located=1e-9,
    moreau=FIRST_ORDER,
)


states(
    "elastic-gas",
    "states, 100 beads",
    lambda: scenes.elastic_gas(n=100, t_end=1.0),
    period=FLIGHT,
    event_driven=1e-9,
    located=1e-9,
    moreau=FIRST_ORDER,
)


states(
    "elastic-gas",
    "states, 400 beads, 1e5 impacts",
    lambda: scenes.elastic_gas(n=400, t_end=2.5),
    period=FLIGHT,
    heavy=True,
    event_driven=1e-9,
    located=1e-9,
)


states(
    "falling-gas",
    "states, 12 beads",
    scenes.falling_gas,
    period=FLIGHT,
    event_driven=1e-9,
    located=1e-9,
    moreau=FIRST_ORDER,
)


def _galperin(solve: Solver, k: int) -> Found:
    scene = scenes.galperin(k)
    end = scene.t_span[1]
    run = solve(scene, keep=[end])
    counted = int(np.sum(run.impacts.kind == Kind.IMPACT))
    energy = 0.5 * (run.v[-1, 0] ** 2 + 100.0**k * run.v[-1, 1] ** 2) / (0.5 * 100.0**k)
    return Found(
        max(abs(counted - collisions(k)), abs(energy - 1.0)),
        f"{counted} of {collisions(k)} collisions, energy off by {abs(energy - 1.0):.0e}",
    )


@check("galperin", "collisions and energy, k = 1", period=0.1, event_driven=1e-8, located=1e-8, moreau=1e-8)
def galperin_1(solve: Solver) -> Found:
    return _galperin(solve, 1)


@check("galperin", "collisions and energy, k = 3", period=0.1, event_driven=1e-8, located=1e-8, moreau=1e-8)
def galperin_3(solve: Solver) -> Found:
    return _galperin(solve, 3)


@check("galperin", "collisions and energy, k = 6", period=0.1, heavy=True, event_driven=1e-8, located=1e-8)
def galperin_6(solve: Solver) -> Found:
    return _galperin(solve, 6)


def _end_velocities(solve: Solver, scene: Scene) -> float:
    assert scene.exact is not None
    end = np.array([scene.t_span[1]])
    return float(np.max(np.abs(solve(scene, keep=end).v - scene.exact(end)[1])))


@check(
    "newtons-cradle",
    "velocities, touching: simultaneous",
    period=1.0,
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-14,
)
def cradle_touching(solve: Solver) -> float:
    return _end_velocities(solve, scenes.newtons_cradle())


@check(
    "newtons-cradle",
    "velocities, touching, r = 0.5",
    period=1.0,
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-14,
)
def cradle_half(solve: Solver) -> float:
    return _end_velocities(solve, scenes.newtons_cradle(restitution=0.5))


@check(
    "newtons-cradle",
    "velocities, 0.1 mm apart: in sequence",
    period=1.0,
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-14,
)
def cradle_apart(solve: Solver) -> float:
    return _end_velocities(solve, scenes.newtons_cradle(spacing=1e-4))


@check(
    "inelastic-collapse",
    "momentum and velocities of the cluster",
    period=1.0,
    event_driven=1e-14,
    located=1e-14,
    moreau=1e-14,
)
def collapse(solve: Solver) -> Found:
    scene = scenes.inelastic_collapse()
    run = solve(scene)
    momentum = float(np.sum(run.v[-1]) - np.sum(np.asarray(scene.v0)))
    spread = float(np.ptp(run.v[-1]))
    return Found(max(abs(momentum), spread), f"{len(run.impacts)} events")


@check(
    "inelastic-collapse",
    "number of events",
    period=1.0,
    event_driven=100.0,
    located=100.0,
    moreau=100.0,
)
def collapse_events(solve: Solver) -> float:
    return len(solve(scenes.inelastic_collapse()).impacts)


states(
    "inelastic-collapse",
    "states",
    scenes.inelastic_collapse,
    period=1.0,
    event_driven=1e-10,
    located=1e-10,
    moreau=FIRST_ORDER,
)


states(
    "inelastic-collapse",
    "states, r = 0.3: no collapse",
    lambda: scenes.inelastic_collapse(restitution=0.3),
    period=1.0,
    event_driven=1e-12,
    located=1e-12,
    moreau=FIRST_ORDER,
)


def _column(solve: Solver, n: int, restitution: float, t_end: float) -> Found:
    """Largest of the speed, the penetration and the error of the contact forces (relative) in the end."""
    scene = scenes.column(n=n, restitution=restitution, t_end=t_end)
    times = np.arange(16.0 * t_end + 1.0) / 16.0
    h = 2.0 ** math.floor(
        math.log2(solve.h)
    )  # so that kept times end steps, and impulses are those of whole steps
    run = solve(scene, keep=times, h=h)
    forces = run.impulse[-1] / (times[-1] - times[-2])
    weights = weights_above(np.ones(n), 9.81)
    gaps = np.diff(np.concatenate([[0.0], run.q[-1]]))
    energy = 0.5 * np.sum(run.v**2, axis=1) + 9.81 * np.sum(run.q, axis=1)
    parts = {
        "speed": float(np.max(np.abs(run.v[-1]))),
        "gap": float(np.max(np.abs(gaps))),
        "force": float(np.max(np.abs(forces / weights - 1.0))),
        "energy gained": max(0.0, float(np.max(np.diff(energy))) / energy[0]),
    }
    return Found(max(parts.values()), ", ".join(f"{name} {x:.0e}" for name, x in parts.items()))


@check(
    "column",
    "at rest, touching, forces; 20 beads, r = 0.5",
    period=0.2,
    event_driven=1e-12,
    located=1e-12,
    moreau=FIRST_ORDER,
)
def column(solve: Solver) -> Found:
    return _column(solve, 20, 0.5, 5.0)


@check(
    "column", "at rest, touching, forces; 20 beads, r = 0.9", period=0.2, heavy=True, event_driven=1e-12,
    located=1e-12, moreau=FIRST_ORDER,
)  # fmt: skip
def bouncing_column(solve: Solver) -> Found:
    return _column(solve, 20, 0.9, 30.0)


@check(
    "column", "at rest, touching, forces; 200 beads, r = 0.5", period=0.2, heavy=True, event_driven=1e-12,
    located=1e-12, moreau=FIRST_ORDER,
)  # fmt: skip
def tall_column(solve: Solver) -> Found:
    return _column(solve, 200, 0.5, 10.0)


@check(
    "column", "steps from 1e-5 s to 0.1 s: energy gained, relative", period=0.2, located=1e-12, moreau=1e-12
)
def column_steps(solve: Solver) -> Found:
    worst = 0.0
    for h in 10.0 ** np.arange(-5.0, -0.5):
        run = solve(scenes.column(t_end=1.0), keep=np.linspace(0.0, 1.0, 11), h=float(h))
        energy = 0.5 * np.sum(run.v**2, axis=1) + 9.81 * np.sum(run.q, axis=1)
        if not np.all(np.isfinite(energy)):
            return Found(math.inf, f"not finite at h = {h:g}")
        worst = max(worst, float(np.max(energy) / energy[0] - 1.0))
    return Found(max(worst, 0.0))
