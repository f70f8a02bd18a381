"""Derivative of a motion with modes by its initial state, along its log of switches, as kernels.

    J' = F_x J in a mode,    D = R_x + (F+ - R_x F- - R_t) H_x / (H_x F- + H_t) at a switch

with the reset R and the guard H. Switches at one instant are one: the guard is that of the first, the reset all of
theirs one after another, F+ the field of the last mode; the modes between have no duration, and their fields no say.
A switch at the very start puts the mode right, at a time that does not move: D = R_x. Sliding that begins loses a
dimension by the same formula, for there F+ is Filippov's field and H_x D = 0; so one multiplier of an orbit that
slides is zero. A motion that starts sliding is one that has been put on the surface first. Source: G. Osorio, Complex
Behavior in Impacting Systems, eqs. 3.42-3.43; R. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth
Mechanical Systems (Springer 2004), chapter 7.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lcpstep.compiled import by_address, call_first_order
from lcpstep.dense import assign
from lcpstep.events import dop853
from lcpstep.events.dop853 import STAGES, combine, error_norm, factor
from lcpstep.events.hybrid.field import (
    ARRIVE,
    INNER,
    NOT_SLIDING,
    OUTER,
    RESOLUTION,
    field,
    guard_gradient,
    surface_gradient,
)
from lcpstep.events.hybrid.state import SWITCH_LEAD

WALKED, NOT_TRANSVERSAL, NOT_INTEGRATED = range(3)
TOLERANCE = 1e-12  # of the variational flow
DIFFERENCE = np.finfo(float).eps ** 0.2 * 0.1  # step of the differences of fields and resets, relative
SHORTEST = 1e-10  # step, relative to the span


@by_address
class Tangent(NamedTuple):
    """Work space for the derivative of a motion of n states."""

    m: Any  # the system, a `field.Machine`
    w: Any  # of the Runge-Kutta method, for the state and its derivative together, n + n^2 numbers
    J: Any  # (n, n) the derivative so far
    A: Any  # (n, n) F_x, or the derivative of one reset
    D: Any  # (n, n) of a switch
    R: Any  # (n, n) R_x of all resets at one instant
    R_t: Any  # (n,)
    H_x: Any  # (n,)
    x: Any  # (n,) a shifted state
    start: Any  # (n,) state at the start of a piece
    F_before: Any  # (n,)
    F_after: Any
    up: Any  # (n,) values on both sides
    down: Any


def tangent(m: Any, n: int) -> Tangent:
    """Work space for a system of n states."""
    square, vector = iter(np.zeros((4, n, n))), iter(np.zeros((8, n)))
    return Tangent(
        m, dop853.work(n + n * n), *(next(square) for _ in range(4)), *(next(vector) for _ in range(8))
    )


def walk(s: Any, log: Any, count: int, mode: int, t: float, x: Any, t_end: float) -> int:
    """Derivative of the state at t_end by the state x at t, into s.J.

    log : the `count` switches between, see `state.Memory`
    mode : at t, before any switch there
    """
    n, k = len(s.x), 0
    assign(s.start, x)
    for i in range(n):
        for j in range(n):
            s.J[i, j] = 1.0 if i == j else 0.0
    now, t_first = t, t
    if s.m.below[mode] != NOT_SLIDING:
        put_on_surface(s, mode, t)
        times(s, s.R)
    while k < count:
        if not flow(s, mode, now, log[k, 0]):
            return NOT_INTEGRATED
        first = k
        now = log[k, 0]
        while k + 1 < count and log[k + 1, 0] == now:
            k += 1
        if not switch(s, log, first, k, now > t_first):
            return NOT_TRANSVERSAL
        mode = int(log[k, 2])
        for i in range(n):
            s.start[i] = log[k, SWITCH_LEAD + n + i]
        k += 1
    return WALKED if flow(s, mode, now, t_end) else NOT_INTEGRATED


def times(s: Any, D: Any) -> None:
    """J <- D J."""
    n = len(s.x)
    for j in range(n):
        for i in range(n):
            s.up[i] = 0.0
            for k in range(n):
                s.up[i] += D[i, k] * s.J[k, j]
        for i in range(n):
            s.J[i, j] = s.up[i]


def flow(s: Any, mode: int, a: float, b: float) -> bool:
    """Smooth motion in a mode from s.start at a to b, state and derivative together; False where it fails."""
    n, w = len(s.x), s.w
    for i in range(n):
        w.y[i] = s.start[i]
        for j in range(n):
            w.y[n + i * n + j] = s.J[i, j]
    t, h, whole = a, b - a, b - a
    while t < b:
        h = min(h, b - t)
        variation(s, mode, t, w.y, w.K[0])
        for stage in range(1, STAGES):
            combine(w, h, stage)
            variation(s, mode, t + w.tab.C[stage] * h, w.y_stage, w.K[stage])
        combine(w, h, STAGES)
        assign(w.y_new, w.y_stage)
        variation(s, mode, t + h, w.y_new, w.K[STAGES])
        error = error_norm(w, h, TOLERANCE, TOLERANCE)
        if error < 1.0:
            t = b if h >= b - t else t + h
            assign(w.y, w.y_new)
        elif not h > SHORTEST * whole + 4.0 * RESOLUTION * abs(t):
            return False
        h *= factor(error) if error < 1e30 else 0.1
    for i in range(n):
        for j in range(n):
            s.J[i, j] = w.y[n + i * n + j]
    return True


def variation(s: Any, mode: int, t: float, z: Any, out: Any) -> None:
    """Rates of the state and of its derivative: F and F_x J."""
    n = len(s.x)
    for j in range(n):
        d = DIFFERENCE * max(1.0, abs(z[j]))
        for i in range(n):
            s.A[i, j] = 0.0
        for k in range(2):
            step, weight = (d, INNER) if k == 0 else (2.0 * d, OUTER)
            for i in range(n):
                s.x[i] = z[i]
            s.x[j] = above = z[j] + step
            field(s.m, mode, t, s.x, s.up)
            s.x[j] = z[j] - step
            field(s.m, mode, t, s.x, s.down)
            for i in range(n):
                s.A[i, j] += 2.0 * (1 + k) * weight * (s.up[i] - s.down[i]) / (above - s.x[j])
    for i in range(n):
        s.x[i] = z[i]
    field(s.m, mode, t, s.x, s.up)
    for i in range(n):
        out[i] = s.up[i]
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += s.A[i, k] * z[n + k * n + j]
            out[n + i * n + j] = total


def switch(s: Any, log: Any, first: int, last: int, moves: bool) -> bool:
    """J <- D J for the switches first .. last of one instant; moves: whether the instant depends on the state."""
    n, m, t = len(s.x), s.m, log[first, 0]
    before = log[first, SWITCH_LEAD : SWITCH_LEAD + n]
    source, guard = int(log[first, 1]), int(log[first, 3])
    for i in range(n):
        s.R_t[i] = 0.0
        for j in range(n):
            s.R[i, j] = 1.0 if i == j else 0.0
    for k in range(first, last + 1):
        compose(s, log, k, t)
    if not moves:
        times(s, s.R)
        return True
    H_t = guard_gradient(m, source, guard, t, before)
    assign(s.H_x, m.work.g_x)
    field(m, source, t, before, s.F_before)
    field(m, int(log[last, 2]), t, log[last, SWITCH_LEAD + n : SWITCH_LEAD + 2 * n], s.F_after)
    crossing = H_t
    for i in range(n):
        crossing += s.H_x[i] * s.F_before[i]
    if not abs(crossing) > 0.0:
        return False
    for i in range(n):
        gain = s.F_after[i] - s.R_t[i]
        for j in range(n):
            gain -= s.R[i, j] * s.F_before[j]
        for j in range(n):
            s.D[i, j] = s.R[i, j] + gain * s.H_x[j] / crossing
    times(s, s.D)
    return True


def compose(s: Any, log: Any, k: int, t: float) -> None:
    """R and R_t with the reset of switch k after them, and the surface of a sliding mode that it leads to."""
    n, m, guard, target = len(s.x), s.m, int(log[k, 3]), int(log[k, 2])
    if m.has_reset[guard]:
        before = log[k, SWITCH_LEAD : SWITCH_LEAD + n]
        for j in range(n):
            d = DIFFERENCE * max(1.0, abs(before[j]))
            differenced(s, guard, t, before, j, d)
            for i in range(n):
                s.D[i, j] = s.up[i]
        product(s)
        differenced(s, guard, t, before, -1, m.dt)
        for i in range(n):
            s.R_t[i] += s.up[i]
    if m.below[target] != NOT_SLIDING and m.kind[guard] != ARRIVE:
        H_t, square = surface_gradient(m, target, t, log[k, SWITCH_LEAD + n : SWITCH_LEAD + 2 * n]), 0.0
        for i in range(n):
            square += m.work.H_x[i] ** 2
        for i in range(n):
            for j in range(n):
                s.D[i, j] = (1.0 if i == j else 0.0) - m.work.H_x[i] * m.work.H_x[j] / square
        product(s)
        for i in range(n):
            s.R_t[i] -= m.work.H_x[i] * H_t / square


def product(s: Any) -> None:
    """R <- D R, R_t <- D R_t."""
    n = len(s.x)
    for j in range(n + 1):
        for i in range(n):
            s.down[i] = 0.0
            for k in range(n):
                s.down[i] += s.D[i, k] * (s.R[k, j] if j < n else s.R_t[k])
        for i in range(n):
            if j < n:
                s.R[i, j] = s.down[i]
            else:
                s.R_t[i] = s.down[i]


def differenced(s: Any, guard: int, t: float, x: Any, j: int, d: float) -> None:
    """Derivative of a reset by state j, or by the time where j is -1, into s.up."""
    n = len(s.x)
    for i in range(n):
        s.F_after[i] = 0.0
    for k in range(2):
        step, weight = (d, INNER) if k == 0 else (2.0 * d, OUTER)
        for side in (1.0, -1.0):
            for i in range(n):
                s.x[i] = x[i]
                s.up[i] = 0.0
            if j >= 0:
                s.x[j] = x[j] + side * step
            call_first_order(s.m.resets[guard], t + (side * step if j < 0 else 0.0), s.x, s.m.p, s.up)
            for i in range(n):
                s.F_after[i] += side * weight * s.up[i] / d
    assign(s.up, s.F_after)


def put_on_surface(s: Any, mode: int, t: float) -> None:
    """R of putting a state on the surface of its sliding mode: the nearest one there."""
    n, square = len(s.x), 0.0
    surface_gradient(s.m, mode, t, s.start)
    for i in range(n):
        square += s.m.work.H_x[i] ** 2
    for i in range(n):
        for j in range(n):
            s.R[i, j] = (1.0 if i == j else 0.0) - s.m.work.H_x[i] * s.m.work.H_x[j] / square
