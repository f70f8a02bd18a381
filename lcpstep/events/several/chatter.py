"""Chattering that is over, as kernels: contacts whose further impacts stay below the tolerance are closed.

Hops under a pressing acceleration alpha accumulate after T = 2 u / (|alpha| (1 - r)); they are left out when no
higher than the tolerance. So are hops that are as slow as the tolerance, elastic ones too, and impacts of contacts
that nothing presses (inelastic collapse) when they have both a speed and a way below it. Source: A. Nordmark, P.
Piiroinen, Simulation and stability analysis of impacting systems with complete chattering, Nonlinear Dynamics 58
(2009).
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import largest
from lcpstep.dynamics import product
from lcpstep.events.bookkeeping import ACCUMULATION
from lcpstep.events.clock import HIGH, T0
from lcpstep.events.contact import accumulation
from lcpstep.events.several.equations import bias_of, biases, constraint_rows, measure_again
from lcpstep.events.several.held import hold_contacts, right_hand_side, solve_held
from lcpstep.events.several.impact import apply
from lcpstep.events.several.keep import log
from lcpstep.events.several.motion import gap_tolerance
from lcpstep.events.several.parabolas import first_root
from lcpstep.events.several.state import (
    ACCELERATION,
    CHATTERS,
    CLOSED,
    CURVE,
    GAP,
    HELD_ROWS,
    NOISE,
    SINCE,
    SPEED,
    STRUCK,
    WAS_CLOSED,
    Q,
    V,
)


def close_chatter(s: Any, record: Any, count: Any) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there was one."""
    n_c, n_j, t, some = len(s.G), len(s.J), s.x[T0], False
    for c in range(n_c):
        moved = s.contact[STRUCK, c] == t or s.mode[WAS_CLOSED, c] == 1  # struck, or driven off by another
        if s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0 and moved:
            T = chatter_left(s, c)
            if T >= 0.0:
                u, alpha = s.contact[SPEED, c], s.contact[CURVE, c]
                p = max(-alpha * T - u, 0.0) / s.D[n_j + c, n_j + c]
                log(s, record, count, t + T, c, float(ACCUMULATION), -u, 0.0, p)
                s.mode[CLOSED, c], s.contact[CHATTERS, c], some = 1, t + T, True
    if some:
        for c in range(n_c):  # those that the forces have just opened meet other forces now
            if s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0 and s.contact[SPEED, c] == 0.0:
                s.mode[CLOSED, c] = 1
        stop(s)
    return some


def stop(s: Any) -> None:
    """Take their speeds from the closed contacts."""
    n_j = len(s.J)
    hold_contacts(s)
    for m in range(s.number[HELD_ROWS]):
        i = s.row[m]
        s.change[m] = 0.0 if i < n_j else -s.contact[SPEED, i - n_j]
    solve_held(s, s.number[HELD_ROWS], s.change)
    apply(s)
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 1:
            s.contact[SPEED, c] = 0.0


def chatter_left(s: Any, c: int) -> float:
    """How long the impacts of contact c that are left out would last, or -1 if they may not be.

    Pressed by alpha < 0 they accumulate after 2 u / (|alpha| (1 - r)), no hop being higher than u^2 / (2 |alpha|).
    """
    u, alpha, r = s.contact[SPEED, c], s.contact[CURVE, c], s.model.restitution[c]
    if u == 0.0:  # opened by the forces
        return -1.0
    speed = largest(s.state[V], 0.0)
    tolerance = gap_tolerance(s, c)
    slow = u <= s.plan.atol + s.plan.rtol * speed
    low = alpha < 0.0 and u * u <= -2.0 * alpha * tolerance
    if slow and low:
        return 0.0
    if r == 1.0:
        return -1.0
    if alpha == 0.0 or abs(alpha) * s.contact[SINCE, c] <= NOISE * (u + speed):  # an inelastic collapse
        return 0.0 if slow and u * s.contact[SINCE, c] <= tolerance else -1.0
    if not low:
        return -1.0
    T = accumulation(u, alpha, r)
    if s.x[T0] + T > min(s.x[HIGH], s.plan.t_end):
        return -1.0
    for d in range(len(s.G)):  # nothing else may happen meanwhile
        g, u_d, alpha_d = s.contact[GAP, d], s.contact[SPEED, d], s.contact[CURVE, d]
        if s.mode[CLOSED, d] == 0 and g > 0.0 and first_root(g, u_d, alpha_d) < T:
            return -1.0
    if s.constant:
        return T
    change = later(s, c, T) - alpha
    return T if abs(change) * T * max(speed, 1.0) <= -alpha * tolerance else -1.0


def later(s: Any, c: int, T: float) -> float:
    """Gap acceleration of contact c at the time T from now, along the tangent of the motion."""
    y, n = s.w.y_stage, s.state.shape[1]
    for j in range(n):
        y[j] = s.state[Q, j] + T * s.state[V, j]
        y[n + j] = s.state[V, j] + T * s.state[ACCELERATION, j]
    curve = math.nan
    if right_hand_side(s, s.x[T0] + T, y, s.dy):
        biases(s, s.model, s.G, s.contact, s.x[T0] + T, y[:n], y[n:])
        constraint_rows(s, s.x[T0] + T, y[:n], y[n:])
        curve = product(s.R, s.dy[n:], len(s.J) + c) + bias_of(s, len(s.J) + c)
    measure_again(s, s.x[T0])
    return curve
