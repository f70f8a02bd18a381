"""The equations of a model, evaluated: forces, masses, gaps, gap velocities and accelerations.

    M v' = f(t, q, v) + G^T lambda,    u = G v + g_t,    u' = G v' + bias

Kernels in plain Python (see `lcpstep.compiled`); outputs are written into the arrays handed in.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import call, inline
from lcpstep.dense import assign
from lcpstep.model import ABSENT

# Fourth-order differences that stand in for a missing bias: the longest way they take; the third difference, relative
# to the terms of the rate, that they may show, and what a shorter step aims at; how often it is shortened, and beyond
# what a gap has turned so much that nothing is seen of it
DIFFERENCE = 1e-3
BENT, SMOOTH, SHORTENINGS, LOST = 1e-8, 1e-9, 5, 1e-2
TOGETHER = 64 * 2.0**-52  # of the terms of a gap, their signs left aside: smaller ones are zero to rounding
SAME_OUTCOME, TURNS = 1e-10, 64  # of impacts in turn: relative difference of speeds; impacts of each contact


@inline
def external_force(model: Any, t: float, q: Any, v: Any, out: Any) -> None:
    """F(t) of a linear system, the forces of a moving frame included."""
    n = len(out)
    if model.force != ABSENT:
        call(model.force, t, q, v, model.p, out)
    else:
        cosine, sine = 1.0, 0.0
        if model.omega != 0.0:
            cosine, sine = math.cos(model.omega * t), math.sin(model.omega * t)
        for i in range(n):
            out[i] = model.constant[i] + model.cosine[i] * cosine + model.sine[i] * sine
    if model.frame != ABSENT and not model.carried:
        c = model.frame_now
        call(model.frame, t, q, v, model.p, c)
        for i in range(n):
            for j in range(n):
                out[i] -= model.M[i, j] * c[j, 2] + model.C[i, j] * c[j, 1] + model.K[i, j] * c[j, 0]


@inline
def total_force(model: Any, t: float, q: Any, v: Any, out: Any) -> None:
    """f(t, q, v): all forces but those of the contacts."""
    if not model.linear:
        call(model.force, t, q, v, model.p, out)
        return
    external_force(model, t, q, v, out)
    for i in range(len(out)):
        for j in range(len(out)):
            out[i] -= model.C[i, j] * v[j] + model.K[i, j] * q[j]


@inline
def mass(model: Any, t: float, q: Any, v: Any, out: Any) -> None:
    """M(t, q)."""
    if model.mass != ABSENT:
        call(model.mass, t, q, v, model.p, out)
    else:
        assign(out, model.M)


@inline
def gaps(model: Any, t: float, q: Any, v: Any, g: Any) -> None:
    """g(t, q)."""
    if not model.flat:
        call(model.gap, t, q, v, model.p, g)
        return
    obstacle(model, t, q, v)
    for c in range(len(g)):
        g[c] = model.offset[c] - model.motion_now[c, 0]
        for j in range(len(q)):
            g[c] += model.G[c, j] * q[j]


@inline
def gap_rates(model: Any, t: float, q: Any, v: Any, G: Any, g_t: Any) -> None:
    """G(t, q) and g_t(t, q), so that u = G v + g_t."""
    if model.flat:
        obstacle(model, t, q, v)
        for c in range(len(g_t)):
            g_t[c] = -model.motion_now[c, 1]
            for j in range(len(q)):
                G[c, j] = model.G[c, j]
        return
    call(model.jacobian, t, q, v, model.p, G)
    for c in range(len(g_t)):
        g_t[c] = 0.0
    if model.gap_t != ABSENT:
        call(model.gap_t, t, q, v, model.p, g_t)


@inline
def bias(model: Any, t: float, q: Any, v: Any, shifted: Any, G: Any, rate: Any, out: Any) -> None:
    """(dG/dt) v + d(g_t)/dt along the motion; by differences of order four where the scene does not give it.

    Work space: shifted (n_q,), G (n_c, n_q), rate (n_c,).
    """
    for c in range(len(out)):
        out[c] = 0.0
    if model.flat:
        if moves(model):
            obstacle(model, t, q, v)
            for c in range(len(out)):
                out[c] = -model.motion_now[c, 2]
        return
    if model.bias != ABSENT:
        call(model.bias, t, q, v, model.p, out)
        return
    d = difference_step(model, t, q, v, shifted, G, rate)
    for c in range(len(out)):
        near, far = model.motion_now[c, 0], model.motion_now[c, 1]
        out[c] = (8.0 * near - far) / (12.0 * d)


def difference_step(model: Any, t: float, q: Any, v: Any, shifted: Any, G: Any, rate: Any) -> float:
    """A step short enough for the differences of the gaps' rates along the motion; it leaves these in `motion_now`.

    Gaps may bend at any scale. A third difference that is too large asks for a shorter step, in proportion to its
    third root, unless the last one has shown that this does not help: the curvature jumps nearby.
    """
    speed = 1.0
    for i in range(len(q)):
        speed = max(speed, abs(v[i]))
    d, before, shorter = DIFFERENCE / speed, math.inf, 1.0
    for _ in range(SHORTENINGS):
        bent = differences(model, t, q, v, shifted, G, rate, d)
        helped = bent > LOST or bent <= before * shorter
        if not bent > BENT or not helped:
            return d
        change = max((SMOOTH / bent) ** (1.0 / 3.0), DIFFERENCE)
        before, shorter = bent, change * math.sqrt(change)
        d *= change
    differences(model, t, q, v, shifted, G, rate, d)
    return d


def differences(model: Any, t: float, q: Any, v: Any, shifted: Any, G: Any, rate: Any, d: float) -> float:
    """Differences of G v + g_t between -d and d, and -2 d and 2 d, into `motion_now`; the third one, relative.

    Contacts whose gap is a function have no obstacle that moves, and its place is free.
    """
    now = model.motion_now
    for c in range(len(rate)):
        now[c, 0] = now[c, 1] = now[c, 2] = 0.0
    for k in range(4):
        shift = d * (1.0 + k // 2) * (1.0 if k % 2 == 0 else -1.0)
        for i in range(len(q)):
            shifted[i] = q[i] + shift * v[i]
        gap_rates(model, t + shift, shifted, v, G, rate)
        for c in range(len(rate)):
            terms = abs(rate[c])
            for j in range(len(q)):
                terms += abs(G[c, j] * v[j])
            now[c, 2] = max(now[c, 2], terms)
            now[c, k // 2] += (product(G, v, c) + rate[c]) * (1.0 if k % 2 == 0 else -1.0)
    bent = 0.0
    for c in range(len(rate)):
        if now[c, 2] > 0.0:
            bent = max(bent, abs(now[c, 1] - 2.0 * now[c, 0]) / now[c, 2])
    return bent


@inline
def obstacle(model: Any, t: float, q: Any, v: Any) -> None:
    """Position, velocity and acceleration of the obstacles of flat contacts, into `model.motion_now`."""
    if model.motion != ABSENT:
        call(model.motion, t, q, v, model.p, model.motion_now)
    if model.carried:
        carry_obstacles(model, t, q, v)


@inline
def moves(model: Any) -> bool:
    """Whether obstacles of flat contacts move."""
    return model.motion != ABSENT or model.carried


@inline
def carry_obstacles(model: Any, t: float, q: Any, v: Any) -> None:
    """Add the motion of the frame to that of the obstacles: with x = q + c the gap is G x + offset - (s + G c)."""
    call(model.frame, t, q, v, model.p, model.frame_now)
    for c in range(len(model.motion_now)):
        for k in range(3):
            own = model.motion_now[c, k] if model.motion != ABSENT else 0.0
            for j in range(len(model.frame_now)):
                own += model.G[c, j] * model.frame_now[j, k]
            model.motion_now[c, k] = own


@inline
def gap_rounding(model: Any, G: Any, q: Any, c: int, path: float) -> float:
    """What rounding may leave of gap c where it is closed: of its terms, and of the way by which it has come.

    Of contacts whose gaps are as small at one instant it is not known which came first; where that matters
    (`order_matters`) they strike together. A moving obstacle's place must be known (`gaps`).
    """
    size = path
    if model.flat:
        size += abs(model.offset[c])
        if moves(model):
            size += abs(model.motion_now[c, 0])
    for j in range(len(q)):
        size += abs(G[c, j] * q[j])
    return TOGETHER * size


def order_matters(
    W_c: float, W_d: float, W_cd: float, r_c: float, r_d: float, u_c: float, u_d: float
) -> bool:
    """Whether the impacts of two contacts, taken in turn, leave other speeds where the other one is first.

    It does not for elastic bodies of one mass that meet, which exchange their speeds; it does for most.
    """
    if W_cd == 0.0:
        return False
    c, d = in_turn(W_c, W_d, W_cd, r_c, r_d, u_c, u_d)
    other_d, other_c = in_turn(W_d, W_c, W_cd, r_d, r_c, u_d, u_c)
    return abs(c - other_c) + abs(d - other_d) > SAME_OUTCOME * (abs(u_c) + abs(u_d))


def in_turn(
    W_c: float, W_d: float, W_cd: float, r_c: float, r_d: float, u_c: float, u_d: float
) -> tuple[float, float]:
    """Speeds after the impacts of two contacts in turn, the first one's at first."""
    slow = SAME_OUTCOME * (abs(u_c) + abs(u_d))
    for _ in range(TURNS):
        if u_c < -slow:
            p = -(1.0 + r_c) * u_c / W_c
            u_c, u_d = -r_c * u_c, u_d + W_cd * p
        if not u_d < -slow:
            break
        p = -(1.0 + r_d) * u_d / W_d
        u_d, u_c = -r_d * u_d, u_c + W_cd * p
        if not u_c < -slow:
            break
    return u_c, u_d


@inline
def product(G: Any, v: Any, c: int) -> float:
    """(G v)_c."""
    total = 0.0
    for j in range(len(v)):
        total += G[c, j] * v[j]
    return total
