"""What happens on the surface, as kernels: impact, chattering, lasting contact, release, and corners.

    u+ = -r u-,    v+ = v- + M^-1 G^T p,    p = -(1 + r) u- / (G M^-1 G^T)         an impact (Newton's law)
    T = 2 u+ / (|alpha| (1 - r))               after which the impacts of a chattering sequence accumulate

Source: see `contact`.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dense import assign, largest
from lcpstep.events.bookkeeping import ACCUMULATION, IMPACT, RELEASE, STICK
from lcpstep.events.clock import HIGH, T0, find_corners
from lcpstep.events.contact import (
    ALPHA0,
    CLOSED,
    EDGE_ALPHA,
    EDGE_G,
    EDGE_U,
    FREE,
    IMPULSE,
    JUST_RELEASED,
    MODE,
    NOW,
    ON_SURFACE,
    SPEED0,
    accumulation,
    log,
    sticks,
)
from lcpstep.events.single.equations import contact_response, project, surface_acceleration
from lcpstep.events.single.keep import keep_event
from lcpstep.events.single.motion import gap_acceleration, rebase, state_at


def impact(s: Any, record: Any, count: Any, u: float) -> None:
    """Newton's law u+ = -r u- at the state s.q, s.v; then free flight, chattering or lasting contact."""
    t, r = s.x[NOW], s.model.restitution[0]
    W = contact_response(s, t, s.q, s.v)
    p = -(1.0 + r) * u / W
    for i in range(len(s.v)):
        s.v[i] += s.MG[i] * p
    s.x[IMPULSE] += p
    log(s, record, count, t, IMPACT, u, -r * u, p)
    rebase(s, t)
    settle(s, record, count, -r * u)
    keep_event(s, record, count)


def settle(s: Any, record: Any, count: Any, u: float) -> None:
    """On the surface at the base of the piece, leaving it with gap velocity u >= 0: which mode comes next."""
    t, r = s.x[NOW], s.model.restitution[0]
    find_corners(s, t)
    s.x[SPEED0], s.x[ON_SURFACE], s.x[MODE] = u, 1.0, FREE
    alpha = gap_acceleration(s, 0.0)
    s.x[ALPHA0] = alpha
    s.x[EDGE_G], s.x[EDGE_U], s.x[EDGE_ALPHA] = 0.0, u, alpha
    if alpha > 0.0 or (alpha == 0.0 and u > 0.0):
        return
    if sticks(u, alpha, t):
        stick(s, record, count, t)
    elif r < 1.0:
        T = accumulation(u, alpha, r)
        if chatter_is_over(s, u, alpha, T):
            W = contact_response(s, t, s.q0, s.v0)
            log(s, record, count, t + T, ACCUMULATION, -u, 0.0, (-alpha * T - u) / W)
            s.x[IMPULSE] -= u / W  # the contact force up to t + T, which counts as closed, gives the rest
            stick(s, record, count, t + T)


def chatter_is_over(s: Any, u: float, alpha: float, T: float) -> bool:
    """Whether taking the remaining impacts as one is within the tolerance.

    They accumulate at T but for T |change of alpha| / |alpha|, and the hops that are left out rise no higher than
    u^2 / (2 |alpha|).
    """
    if s.x[NOW] + T > min(s.x[HIGH], s.plan.t_end):
        return False
    speed = largest(s.v0, 1.0)
    tolerance = s.plan.atol + s.plan.rtol * largest(s.q0, 0.0)
    if u * u / (-2.0 * alpha) > tolerance:
        return False
    # The hops are so low that the state moves along the surface, by its tangent up to O(T^2).
    for i in range(len(s.q0)):
        s.q[i], s.v[i] = s.q0[i] + T * s.v0[i], s.v0[i] + T * s.a[i]
    later = surface_acceleration(s, s.x[NOW] + T)
    return later < 0.0 and abs(later - alpha) * T * speed <= -alpha * tolerance


def stick(s: Any, record: Any, count: Any, t_log: float) -> None:
    """From now on the contact is closed; t_log: when the log says so (the end of a chattering sequence)."""
    s.x[MODE] = CLOSED
    assign(s.q, s.q0)
    assign(s.v, s.v0)
    project(s, s.x[NOW])
    rebase(s, s.x[NOW])
    log(s, record, count, t_log, STICK, 0.0, 0.0, 0.0)


def settle_again(s: Any, record: Any, count: Any) -> None:
    """The contact that seemed to open did so by less than rounding: it is closed, for this interval at least."""
    state_at(s, s.x[NOW] - s.x[T0])
    rebase(s, s.x[NOW])
    s.x[EDGE_G], s.x[EDGE_U], s.x[EDGE_ALPHA] = 0.0, 0.0, -JUST_RELEASED
    stick(s, record, count, s.x[NOW])
    keep_event(s, record, count)


def release(s: Any, record: Any, count: Any, alpha: float) -> None:
    """The closed contact opens now, with the gap acceleration alpha."""
    project(s, s.x[NOW])
    rebase(s, s.x[NOW])
    log(s, record, count, s.x[NOW], RELEASE, 0.0, 0.0, 0.0)
    s.x[MODE], s.x[ON_SURFACE] = FREE, 1.0
    s.x[EDGE_G], s.x[EDGE_U], s.x[EDGE_ALPHA] = 0.0, 0.0, alpha
