"""Chattering that is over, as kernels: contacts whose further impacts stay below the tolerance are closed.

Hops under a pressing acceleration alpha accumulate after T = 2 u / (|alpha| (1 - r)); they are left out when no
higher than the tolerance, and when nothing else happens before T to what the contact is connected with: closed, it
answers another impact in another way than in flight. Closing takes the speed u, by an impulse that the contact force
up to T pays for. Hops as slow as the tolerance are left out too, elastic ones as well, and impacts of contacts that
nothing presses (inelastic collapse) when they have both a speed and a way below it. Source: A. Nordmark, P.
Piiroinen, Simulation and stability analysis of impacting systems with complete chattering, Nonlinear Dynamics 58
(2009).
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dynamics import product
from lcpstep.events.bookkeeping import ACCUMULATION
from lcpstep.events.clock import HIGH, T0
from lcpstep.events.contact import accumulation, hop
from lcpstep.events.several.equations import bias_of, biases, constraint_rows, measure_again
from lcpstep.events.several.held import hold_contacts, right_hand_side, solve_held
from lcpstep.events.several.impact import apply, speed_noise
from lcpstep.events.several.keep import log
from lcpstep.events.several.motion import gap_tolerance, speed_tolerance
from lcpstep.events.several.parabolas import first_root
from lcpstep.events.several.state import (
    ACCELERATION,
    CHATTERS,
    CLOSED,
    CURVE,
    GAP,
    HELD_ROWS,
    IMPULSE,
    NOISE,
    OWED,
    OWED_UNTIL,
    REST,
    SINCE,
    SPEED,
    STRUCK,
    WAS_CLOSED,
    Q,
    V,
)


def close_chatter(s: Any, record: Any, count: Any) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there was one."""
    n_c, t, some = len(s.G), s.x[T0], False
    for c in range(n_c):
        moved = s.contact[STRUCK, c] == t or s.mode[WAS_CLOSED, c] == 1  # struck, or driven off by another
        s.contact[REST, c] = -1.0
        if s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0 and moved:
            s.contact[REST, c] = chatter_left(s, c)
            some = some or s.contact[REST, c] >= 0.0
    if not some:
        return False
    for c in range(n_c):
        touches = s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0
        if (
            touches and s.contact[SPEED, c] == 0.0
        ):  # those that the forces have just opened meet other forces now
            s.contact[REST, c] = 0.0
        if s.contact[REST, c] >= 0.0:
            s.mode[CLOSED, c] = 1
    find_stop(s)
    if drives_others(s):
        for c in range(n_c):
            if s.contact[REST, c] >= 0.0:
                s.mode[CLOSED, c] = 0
        return False
    longest = 0.0
    for c in range(n_c):
        T, u, alpha = s.contact[REST, c], s.contact[SPEED, c], s.contact[CURVE, c]
        if T >= 0.0 and u != 0.0:
            p = max(-alpha * T - u, 0.0) / s.D[len(s.J) + c, len(s.J) + c]
            log(s, record, count, t + T, c, float(ACCUMULATION), -abs(u), 0.0, p)
            s.contact[CHATTERS, c] = t + T
            longest = max(longest, T if T > 0.0 or alpha >= 0.0 else hop(abs(u), alpha))
    stop(s)
    owe(s, t + longest)
    return True


def find_stop(s: Any) -> None:
    """The impulses that take their speeds from the closed contacts, into `change`."""
    n_j = len(s.J)
    hold_contacts(s)
    for m in range(s.number[HELD_ROWS]):
        i = s.row[m]
        s.change[m] = 0.0 if i < n_j else -s.contact[SPEED, i - n_j]
    solve_held(s, s.number[HELD_ROWS], s.change)


def stop(s: Any) -> None:
    """Take their speeds from the closed contacts."""
    find_stop(s)
    apply(s)
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 1:
            s.contact[SPEED, c] = 0.0


def drives_others(s: Any) -> bool:
    """Whether the impulses of `find_stop` would drive an open contact that touches onto its surface."""
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0:
            u = s.contact[SPEED, c]
            for m in range(s.number[HELD_ROWS]):
                u += s.D[len(s.J) + c, s.row[m]] * s.change[m]
            if u < -speed_tolerance(s, c):
                return True
    return False


def owe(s: Any, until: float) -> None:
    """What a stop has left of negative impulses is to be paid by the contact forces up to the time `until`."""
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 1 and s.contact[IMPULSE, c] < 0.0:
            s.contact[OWED, c] += s.contact[IMPULSE, c]
            s.contact[IMPULSE, c], s.contact[OWED_UNTIL, c] = 0.0, until


def chatter_left(s: Any, c: int) -> float:
    """How long the impacts of contact c that are left out would last, or -1 if they may not be.

    Pressed by alpha < 0 they accumulate after 2 u / (|alpha| (1 - r)), no hop being higher than u^2 / (2 |alpha|).
    """
    u, alpha, r = s.contact[SPEED, c], s.contact[CURVE, c], s.model.restitution[c]
    if u == 0.0:  # opened by the forces
        return -1.0
    tolerance, slow = gap_tolerance(s, c), abs(u) <= speed_tolerance(s, c)
    low = alpha < 0.0 and u * u <= -2.0 * alpha * tolerance
    if slow and low:
        return 0.0
    if r == 1.0 or u < 0.0:
        return -1.0
    noise = speed_noise(s, c)
    if abs(alpha) * s.contact[SINCE, c] <= noise:  # an inelastic collapse
        return 0.0 if slow and u * s.contact[SINCE, c] <= tolerance else -1.0
    if not low:
        return -1.0
    T = accumulation(u, alpha, r)
    if s.x[T0] + T > min(s.x[HIGH], s.plan.t_end) or interrupted(s, c, T):
        return -1.0
    if s.constant:
        return T
    change = abs(later(s, c, T) - alpha)
    # the end is then off by T change / |alpha|, in which the gap's terms move by no more than the tolerance
    speed = max(noise / NOISE, -alpha * s.plan.scan)
    return T if change * T * speed <= -alpha * tolerance else -1.0


def interrupted(s: Any, c: int, T: float) -> bool:
    """Whether a contact that impacts connect with contact c closes within the time T."""
    n_j, passed_on = len(s.J), False
    for i in range(n_j + len(s.G)):  # joints and closed contacts pass impulses on
        held = i < n_j or s.mode[CLOSED, i - n_j] == 1
        passed_on = passed_on or (held and s.D[n_j + c, i] != 0.0)
    for d in range(len(s.G)):
        if d != c and s.mode[CLOSED, d] == 0 and (passed_on or s.D[n_j + c, n_j + d] != 0.0):
            g, u, alpha = s.contact[GAP, d], s.contact[SPEED, d], s.contact[CURVE, d]
            if (g > 0.0 or u > 0.0) and first_root(g, u, alpha) < T:
                return True
    return False


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
