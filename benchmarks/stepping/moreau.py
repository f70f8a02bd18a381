"""Time-stepping: nanoseconds per step, the ratio to the hand-written floor, and the error at the same step."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from benchmarks.stepping import floor
from benchmarks.stepping.questions import (
    READY,
    USER_LINEAR,
    USER_NONLINEAR,
    Question,
    errors_of,
)
from benchmarks.stepping.timing import Timing, clocked, ratio, take_turns
from lagrangian import scenes
from lcpstep import Moreau, simulate

STEPS = 2_000_000
NEVER = 10**9  # keep the first and the last state only
SPREAD = (1.0, 1.07, 1.13, 1.21, 1.29, 1.37)  # an impact falls at another place of its step for every h


def against_floor(question: Question, rounds: int, steps: int = STEPS) -> dict[str, Any]:
    """One scene, with and without storage, by the library and by hand."""
    h, scene = question.t_end / steps, question.scene()
    method, kernel = Moreau(h), floor.KERNELS[question.name]
    timings = take_turns(
        {
            "floor": clocked(lambda: kernel(h, steps, floor.NOTHING)),
            "library": clocked(lambda: simulate(scene, method, keep=NEVER)),
            "floor, stored": clocked(lambda: floor.stored(question.name, h, steps)),
            "library, stored": clocked(lambda: simulate(scene, method)),
        },
        rounds,
    )
    motion = simulate(scene, method)
    by_hand = floor.stored(question.name, h, steps)
    apart = float(np.max(np.abs(by_hand[:, 1] - motion.q[:, 0])))
    row = {
        "scene": question.name,
        "h": h,
        "steps": steps,
        "floor_apart": apart,
        **errors_of(question, motion),
    }
    return row | _figures(timings, steps, motion.counts.lcp_calls / steps)


def ball_at_rest(rounds: int, steps: int = STEPS) -> dict[str, Any]:
    """Contact steps only: the ball lies on the floor; its error is how far it moves."""
    h = 5.0 / steps
    scene, method = scenes.bouncing_ball(h0=0.0, t_end=5.0), Moreau(h)
    timings = take_turns(
        {
            "floor": clocked(lambda: floor.bouncing_ball(h, steps, floor.NOTHING, 0.0)),
            "library": clocked(lambda: simulate(scene, method, keep=NEVER)),
        },
        rounds,
    )
    motion = simulate(scene, method)
    row = {"scene": "ball at rest", "h": h, "steps": steps, "sup_q": float(np.max(np.abs(motion.q)))}
    return row | _figures(timings, steps, motion.counts.lcp_calls / steps)


def user_scenes(rounds: int, steps: int = STEPS // 10) -> list[dict[str, Any]]:
    """Scenes with a user's force, linear and not (Newton's iteration); nothing is stored."""
    rows = []
    for question in (USER_LINEAR, USER_NONLINEAR):
        h, scene = question.t_end / steps, question.scene()
        method = Moreau(h)
        run = clocked(lambda scene=scene, method=method: simulate(scene, method, keep=NEVER))
        timings = take_turns({"library": run}, rounds)
        motion = simulate(scene, method)
        row = {"scene": question.name, "h": h, "steps": steps, **errors_of(question, motion)}
        rows.append(row | _figures(timings, steps, motion.counts.lcp_calls / steps))
    return rows


def cost_of_a_call(rounds: int) -> list[dict[str, Any]]:
    """A call of `simulate` for a single step: what a short run pays besides its steps."""
    rows = []
    for question in READY:
        scene = question.scene(t_end=1e-4)
        run = clocked(lambda scene=scene: simulate(scene, Moreau(1e-4)))
        rows.append({"scene": question.name, **take_turns({"call": run}, 5 * rounds)["call"].per(1)})
    return rows


def mean_error(question: Question, h: float) -> float:
    """Mean of the sup norms over six neighbouring steps: one step's error scatters by a factor of ten."""
    motions = (simulate(question.scene(), Moreau(h * s)) for s in SPREAD)
    return float(np.mean([errors_of(question, m)["sup_q"] for m in motions]))


def _figures(timings: dict[str, Timing], steps: int, contact_share: float) -> dict[str, Any]:
    """Times per step, ratios to the floor, and the share of steps with a complementarity problem."""
    row: dict[str, Any] = {f"{name} [s/step]": t.per(steps) for name, t in timings.items()}
    row["contact_share"] = contact_share
    for kind in ("", ", stored"):
        pair = timings.get("library" + kind), timings.get("floor" + kind)
        row["ratio" + kind] = ratio(*pair) if all(pair) else math.nan  # type: ignore[arg-type]
    return row


def all_scenes(rounds: int) -> list[dict[str, Any]]:
    rows = [against_floor(question, rounds) for question in READY]
    return [*rows, ball_at_rest(rounds), *user_scenes(rounds)]
