"""A piece of smooth motion that can be asked for any time within it, as kernels: state, impulses."""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import assign, join, split
from lcpstep.dynamics import gap_rounding
from lcpstep.events.clock import start_at
from lcpstep.events.dop853 import interpolate
from lcpstep.events.several.earliest import observe
from lcpstep.events.several.state import (
    ACCELERATION,
    GAP,
    HELD_ROWS,
    IMPULSE,
    LENGTH,
    MULTIPLIER,
    Q0,
    V0,
    Q,
    V,
)


def rebase(s: Any, t: float) -> None:
    """Begin a new piece at time t with the state Q, V."""
    assign(s.state[Q0], s.state[Q])
    assign(s.state[V0], s.state[V])
    if not s.constant:
        join(s.w.y, s.state[Q], s.state[V])
    start_at(s.x, t)


def state_at(s: Any, tau: float) -> None:
    """Q, V at the time tau after the base."""
    if s.constant:
        a = s.state[ACCELERATION]
        for j in range(len(a)):
            s.state[Q, j] = s.state[Q0, j] + tau * (s.state[V0, j] + 0.5 * tau * a[j])
            s.state[V, j] = s.state[V0, j] + tau * a[j]
    elif tau == 0.0:
        assign(s.state[Q], s.state[Q0])
        assign(s.state[V], s.state[V0])
    else:
        interpolate(s.w.F, s.w.y, tau / s.x[LENGTH], s.w.y_stage)
        split(s.w.y_stage, s.state[Q], s.state[V])


def lift(s: Any, c: int) -> None:
    """Put Q onto the surface of contact c, which it misses by no more than the tolerance: hops start from there."""
    i = len(s.J) + c
    for j in range(s.state.shape[1]):
        s.state[Q, j] -= s.MR[i, j] * s.contact[GAP, c] / s.D[i, i]
    s.contact[GAP, c] = 0.0


def gap_tolerance(s: Any, c: int) -> float:
    """The gap of contact c that `lift` takes out without moving a coordinate by more than its tolerance.

    Zero where it depends on no coordinate, as in the middle of a bowl.
    """
    return least_effect(s, c, s.state[Q])


def touching(s: Any, c: int) -> float:
    """The gap below which contact c is closed: rounding, and the tolerance where gaps are not followed exactly."""
    way = 0.0
    if s.x[LENGTH] > 0.0:
        for j in range(s.state.shape[1]):
            way += abs(s.R[len(s.J) + c, j] * s.state[V, j])
        way *= s.x[LENGTH]
    rounding = gap_rounding(s.model, s.G, s.state[Q], c, way)
    return rounding if s.constant else max(rounding, gap_tolerance(s, c))


def speed_tolerance(s: Any, c: int) -> float:
    """The gap velocity of contact c that goes without changing a velocity by more than its tolerance."""
    return least_effect(s, c, s.state[V])


def least_effect(s: Any, c: int, x: Any) -> float:
    """The gap, or gap velocity, that contact c can change without changing an x by more than its tolerance."""
    i, least = len(s.J) + c, math.inf
    for j in range(len(x)):
        moved = abs(s.MR[i, j])
        if moved > 0.0:
            least = min(least, (s.plan.atol + s.plan.rtol * abs(x[j])) * s.D[i, i] / moved)
    return least if least < math.inf else 0.0


def press(s: Any, tau: float) -> None:
    """Add the impulses of the forces over the time tau."""
    for c in range(len(s.G)):
        s.contact[IMPULSE, c] += s.contact[MULTIPLIER, c] * tau
    for i in range(len(s.J)):
        s.joint[IMPULSE, i] += s.joint[MULTIPLIER, i] * tau


def press_between(s: Any, a: float, b: float) -> None:
    """The same for forces that change between a and b after the base: Gauss' quadrature."""
    if s.number[HELD_ROWS] == 0 or b <= a:
        return
    for k in range(len(s.plan.nodes)):
        observe(s, a + s.plan.nodes[k] * (b - a))
        press(s, s.plan.weights[k] * (b - a))
