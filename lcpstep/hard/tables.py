"""Checks on tables that move: periodic orbit, release, a velocity that jumps."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from lagrangian import scenes
from lagrangian.scenes.table import orbit_trace
from lcpstep.hard.check import FIRST_ORDER, SECOND_ORDER, Found, Solver, check, state_error, states
from lcpstep.trajectory import Kind

ORBIT, CHATTER = 2.0 * math.pi / 35.0, 2.0 * math.pi / 40.0  # periods of the tables [s]
NUDGE_Q, NUDGE_V = 1e-6, 1e-5  # of the state, for differences that give the multipliers [m, m/s]
TURNS = (0.3, 0.3 + 1e-13, 0.25, 1.0 / 3.0, 0.3141592653589793)


states(
    "ball-on-table",
    "states on the periodic orbit",
    scenes.ball_on_table,
    period=ORBIT,
    event_driven=1e-10,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


@check(
    "ball-on-table",
    "sum and product of the multipliers",
    period=ORBIT,
    event_driven=1e-6,
    located=1e-2,
    moreau=1e-2,
)
def multipliers(solve: Solver) -> float:
    scene = scenes.ball_on_table()
    start = 0.5 * scene.period  # in mid-flight
    assert scene.exact is not None
    q, v = (float(x[0, 0]) for x in scene.exact(np.array([start])))
    columns = []
    for dq, dv in ((NUDGE_Q, 0.0), (0.0, NUDGE_V)):
        span = (start, start + scene.period)
        ends = [solve(replace(scene, q0=q + s * dq, v0=v + s * dv, t_span=span)) for s in (1.0, -1.0)]
        change = [ends[0].q[-1, 0] - ends[1].q[-1, 0], ends[0].v[-1, 0] - ends[1].v[-1, 0]]
        columns.append(np.array(change) / (2.0 * (dq + dv)))
    J = np.array(columns).T
    trace = orbit_trace(0.01, 35.0, 9.81, 0.5)
    return float(max(abs(np.trace(J) - trace), abs(np.linalg.det(J) - 0.25)))


states(
    "chattering-table",
    "states",
    scenes.chattering_table,
    period=CHATTER,
    event_driven=1e-10,
    located=SECOND_ORDER,
    moreau=FIRST_ORDER,
)


@check("chattering-table", "phase of the releases [rad]", period=CHATTER, event_driven=1e-10, located=4e-3)
def release(solve: Solver) -> float:
    log = solve(scenes.chattering_table()).impacts
    phases = 40.0 * log.time[log.kind == Kind.RELEASE] % (2.0 * math.pi)
    return float(np.max(np.abs(phases - math.asin(9.81 / 16.0)))) if len(phases) > 5 else math.inf


@check("chattering-table", "events a cycle", period=CHATTER, event_driven=60.0, located=60.0)
def events_a_cycle(solve: Solver) -> float:
    scene = scenes.chattering_table()
    return len(solve(scene).impacts) / (scene.t_span[1] / scene.period)


def _jump(solve: Solver, after: float, falling: int) -> Found:
    errors = []
    for at in TURNS:
        scene = scenes.jumping_table(at=at, after=after, falling=falling)
        errors.append(state_error(solve, scene))
    return Found(max(errors), f"of {len(TURNS)} times of the jump")


@check(
    "jumping-table", "pushed up at rest", period=0.3, event_driven=1e-10, located=1e-10, moreau=FIRST_ORDER
)
def pushed(solve: Solver) -> Found:
    return _jump(solve, 0.5, 0)


@check(
    "jumping-table",
    "dropped at rest",
    period=0.3,
    event_driven=1e-10,
    located=1e-10,
    moreau=FIRST_ORDER,
)
def dropped(solve: Solver) -> Found:
    return _jump(solve, -0.5, 0)


@check(
    "jumping-table",
    "struck as it is pushed up",
    period=0.3,
    event_driven=1e-10,
    located=1e-10,
    moreau=FIRST_ORDER,
)
def struck_rising(solve: Solver) -> Found:
    return _jump(solve, 0.5, 1)


@check(
    "jumping-table", "struck as it drops", period=0.3, event_driven=1e-10, located=1e-10, moreau=FIRST_ORDER
)
def struck_dropping(solve: Solver) -> Found:
    return _jump(solve, -0.5, 1)
