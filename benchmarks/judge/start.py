"""Initial state, step and span of a random scene."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description
from benchmarks.judge.shapes import digits

PER_TIME = (1.5, 2.5)  # decades: steps in the shortest time of the motion
DECADES = 3.3  # of steps in a span
LONG, LONG_DECADES = 0.01, (3.3, 6.0)


def started(rng: Any, d: Description, shape: dict[str, Any]) -> Description:
    """The scene with a place and a velocity to start from, and the offsets that put it there."""
    d = _turned(rng, d)
    n, m = d.n, d.contacts
    q0 = np.zeros(n) if rng.random() < 0.4 and not any(d.joint_bend) else rng.normal(size=n)
    q0 = np.vectorize(digits)(q0)
    share = rng.choice([0.0, 0.4, 1.0])
    closed = rng.random(m) < share
    gap = np.where(closed, 0.0, np.vectorize(digits)(10.0 ** rng.uniform(-2.0, 0.5, m)))
    if shape.get("slit") and rng.random() < 0.5:
        gap[:], closed[:] = 0.0, True
    flat = np.max(np.abs(physics.jacobians(d, q0)), axis=1) < 0.1
    gap[flat], closed[flat] = np.maximum(gap[flat], 0.1), False
    t = d.t_span[0]
    d = replace(d, offset=tuple(map(float, gap - physics.gaps(d, t, q0))))
    d = replace(
        d, offset=tuple(map(float, d.row("offset", m) - np.minimum(physics.gaps(d, t, q0) - gap, 0.0)))
    )
    d = joined(d, q0)
    v0 = _velocity(rng, d, t, q0, closed)
    d = replace(d, q0=tuple(map(float, q0)), v0=tuple(map(float, v0)))
    return _balanced(rng, d)


def _turned(rng: Any, d: Description) -> Description:
    """Times near zero or far from it."""
    if rng.random() < 0.75:
        return d
    t = digits(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(0.0, 5.0))
    return replace(d, t_span=(t, t + 1.0))


def joined(d: Description, q0: Any) -> Description:
    """The scene with joints that hold at a place."""
    if not d.J:
        return d
    bent = d.row("joint_bend", len(d.J))
    return replace(d, joint_offset=tuple(map(float, -(np.array(d.J) @ q0) - 0.5 * bent * (q0 @ q0))))


def along(rows: Any, v: Any) -> Any:
    """The part of a velocity that changes no row (k, n)."""
    if len(rows):
        least = 1e-13 * np.max(np.abs(v))
        v = v - np.linalg.pinv(rows) @ (rows @ v)
        v = v - np.linalg.pinv(rows) @ (rows @ v)
        v[np.abs(v) < least] = 0.0
    return v


def _velocity(rng: Any, d: Description, t: float, q0: Any, closed: Any) -> Any:
    """Nothing, anything, or along the contacts that are closed; always along the joints."""
    kind = rng.random()
    if kind < 0.45:
        return np.zeros(d.n)
    v = np.vectorize(digits)(rng.normal(size=d.n) * 10.0 ** rng.uniform(-1.0, 0.7))
    held = physics.jacobians(d, q0)[closed] if kind < 0.7 else np.zeros((0, d.n))
    if d.J:
        held = np.vstack([held, physics.joint_rows(d, q0)])
    return along(held, v)


def _balanced(rng: Any, d: Description) -> Description:
    """Some of the scenes at rest start where all forces cancel: contact forces begin at exactly zero."""
    if any(d.v0) or rng.random() > 0.2:
        return d
    q, v = np.array(d.q0), np.array(d.v0)
    return replace(d, constant=tuple(map(float, d.row("constant") - physics.forces(d, d.t_span[0], q, v))))


def timed(rng: Any, d: Description) -> Description:
    """The scene with a step that its motion asks for, and a span of one step to very many."""
    decades = rng.uniform(*LONG_DECADES) if rng.random() < LONG else rng.uniform(0.0, DECADES)
    h = digits(shortest(d) / 10.0 ** rng.uniform(*PER_TIME))
    steps = max(1.0, math.floor(10.0**decades)) if rng.random() < 0.7 else 10.0**decades
    start = d.t_span[0]
    least = 1e-11 * abs(start)
    h = max(h, digits(least))
    return replace(d, h=h, t_span=(start, start + digits(steps * h, 6)))


def shortest(d: Description) -> float:
    """The shortest time in which something turns, at a length of one."""
    q, v = np.array(d.q0), np.array(d.v0)
    inverse = np.linalg.inv(physics.masses(d, q))
    b = d.row("b")
    squares = np.abs(np.linalg.eigvals(inverse @ (d.matrix("K") + abs(d.pendulum) * np.outer(b, b))))
    damping = np.abs(np.linalg.eigvals(inverse @ d.matrix("C")))
    a = inverse @ (np.abs(d.row("constant")) + np.abs(d.row("cosine")) + np.abs(d.row("sine")))
    rates = [
        math.sqrt(np.max(squares)),
        np.max(damping),
        np.max(np.abs(v)),
        math.sqrt(np.max(np.abs(a)) / 2.0),
    ]
    slowest = 2.0 * math.pi / max([*d.frequencies(), 1e-3])
    return min(slowest, 2.0 * math.pi / max(*map(float, rates), 0.3))
