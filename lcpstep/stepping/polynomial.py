"""Pieces of smooth motion as polynomials, as kernels: Taylor's of a linear system, Hermite's of a Runge-Kutta step.

Taylor: y'' = M^-1 (F(t) - C y' - K y) under constant and harmonic forces gives each coefficient from the two before,

    (k+1) (k+2) T_{k+2} = M^-1 (F_k - C (k+1) T_{k+1} - K T_k),

exact to rounding where the piece is short against the periods. In a moving frame y = q + c(t). Runge-Kutta: the
classical step of order four, and the quintic through position, velocity and acceleration at both of its ends. Closed
contacts enter by their forces, lambda = -(G M^-1 G^T)^-1 (G a + bias). Sources: E. Hairer, S. Norsett, G. Wanner,
Solving Ordinary Differential Equations I, sections I.8 and II.1; G. Osorio, eq. 3.5.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.compiled import call, inline
from lcpstep.dense import assign, grow_factor, solve_factored
from lcpstep.dynamics import gap_rates, gaps, obstacle, product
from lcpstep.model import ABSENT
from lcpstep.stepping.located_work import (
    A_TRY,
    ALPHA,
    BIAS,
    CHANGE,
    CLOSED,
    CLOSED_NOW,
    DEGREE,
    DOUBT,
    FORCE_NOW,
    FORCES,
    GAP_T,
    GAP_T_TRY,
    HELD,
    Q_END,
    Q_STAGE,
    STATUS,
    V_END,
    V_STAGE,
    V_TRY,
    P,
    Q,
    V,
)
from lcpstep.stepping.smooth import free_acceleration, gap_bias, respond, within

QUINTIC = 5
DOUBTFUL = 64.0  # rounding of a factor's diagonal, in its own units, from which on forces are corrected,
CORRECTIONS = 2  # so many times
NODES = (
    (0.06943184420297371, 0.17392742256872692),
    (0.33000947820757187, 0.32607257743127307),
    (0.6699905217924281, 0.32607257743127307),
    (0.9305681557970263, 0.17392742256872692),
)  # Gauss-Legendre on [0, 1]


@inline
def on_surface(m: Any, plan: Any, w: Any, x: Any) -> bool:
    """Whether the one coordinate of an exact motion lies on its obstacle, which then says where it is."""
    return plan.exact and x[CLOSED_NOW] > 0 and w.vec.shape[1] == 1


@inline
def acceleration(m: Any, plan: Any, w: Any, x: Any, t: float, q: Any, v: Any, out: Any, count: Any) -> bool:
    """Acceleration with the forces of closed contacts, if there are any; False where a matrix fails."""
    count[FORCES] += 1
    if x[CLOSED_NOW] == 0:
        return free_acceleration(m, w, within(plan, x, t), q, v, out)
    return constrained(m, plan, w, x, t, q, v, out)


@inline
def biases(m: Any, plan: Any, w: Any, x: Any, t: float, q: Any, v: Any) -> None:
    """Gap accelerations at v' = 0, into w.num[BIAS]."""
    inner = within(plan, x, t)
    if not m.flat:
        gap_bias(m, w, inner, q, v)
        return
    obstacle(m, inner, q, v)
    for c in range(w.num.shape[1]):
        w.num[BIAS, c] = -m.motion_now[c, 2] if m.motion != ABSENT else 0.0


def constrained(m: Any, plan: Any, w: Any, x: Any, t: float, q: Any, v: Any, out: Any) -> bool:
    """Acceleration with the forces of closed contacts, which go to w.num[P]; False where a matrix fails."""
    if not free_acceleration(m, w, within(plan, x, t), q, v, out):
        return False
    gap_rates(m, t, q, v, w.G, w.num[GAP_T])
    biases(m, plan, w, x, t, q, v)
    if not plan.constant:
        respond(m, w)
    for c in range(w.num.shape[1]):
        w.num[ALPHA, c] = product(w.G, out, c) + w.num[BIAS, c]
    factor_closed(w)
    press(w, out, 1.0)
    return True


def factor_closed(w: Any) -> None:
    """Cholesky's factor of the closed contacts' Delassus matrix: of the independent ones, those under load first."""
    n_c, n_k = w.num.shape[1], 0
    L = w.problem.reshape((n_c, n_c))
    for loaded in (True, False):
        for c in range(n_c):
            if w.mark[STATUS, c] == CLOSED and (w.num[FORCE_NOW, c] > 0.0) == loaded:
                w.mark[HELD, n_k] = c
                if grow_factor(w.W, L, w.mark[HELD], w.num[DOUBT], n_k):
                    n_k += 1
    w.pivots[n_c] = n_k


def press(w: Any, out: Any, share: float) -> None:
    """Forces that cancel w.num[ALPHA] of the closed contacts, into w.num[P]; what they do to the acceleration `out`.

    Where the factor is in doubt, as beside very unlike masses, what the acceleration leaves of `share` of the
    obstacles' own w.num[BIAS] is taken out of both.
    """
    n_c, n_k, doubt = w.num.shape[1], w.pivots[w.num.shape[1]], 0.0
    for c in range(n_c):
        w.num[P, c] = 0.0
    for k in range(n_k):
        doubt = max(doubt, w.num[DOUBT, k])
    add_forces(w, out, n_k)
    if doubt > DOUBTFUL:
        for _ in range(CORRECTIONS):
            for k in range(n_k):
                c = w.mark[HELD, k]
                w.num[ALPHA, c] = product(w.G, out, c) + share * w.num[BIAS, c]
            add_forces(w, out, n_k)


def add_forces(w: Any, out: Any, n_k: int) -> None:
    """Add to w.num[P] and to the acceleration what cancels w.num[ALPHA]."""
    n_c = w.num.shape[1]
    for k in range(n_k):
        w.num[CHANGE, k] = -w.num[ALPHA, w.mark[HELD, k]]
    solve_factored(w.problem.reshape((n_c, n_c)), n_k, w.num[CHANGE])
    for k in range(n_k):
        c, force = w.mark[HELD, k], w.num[CHANGE, k]
        w.num[P, c] += force
        for i in range(len(out)):
            out[i] += w.MG[c, i] * force


@inline
def expand(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, length: float, count: Any) -> bool:
    """The polynomial of the piece that begins at t."""
    if plan.exact:
        return taylor(m, plan, w, x, z, t)
    return hermite(m, plan, w, x, z, t, length, count)


@inline
def taylor(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float) -> bool:
    """Taylor coefficients of y at t."""
    n = w.vec.shape[1]
    z.scale[0] = 1.0
    assign(z.T[0], w.vec[Q])
    assign(z.T[1], w.vec[V])
    if m.frame != ABSENT:
        call(m.frame, t, w.vec[Q], w.vec[V], m.p, m.frame_now)
        for i in range(n):
            z.T[0, i] += m.frame_now[i, 0]
            z.T[1, i] += m.frame_now[i, 1]
    if on_surface(m, plan, w, x):
        return True
    if x[CLOSED_NOW] > 0:
        factor_closed(w)
    c_k, s_k = math.cos(m.omega * t), math.sin(m.omega * t)
    for k in range(DEGREE - 1):
        for i in range(n):
            w.vec[A_TRY, i] = m.cosine[i] * c_k + m.sine[i] * s_k + (m.constant[i] if k == 0 else 0.0)
            for j in range(n):
                w.vec[A_TRY, i] -= m.C[i, j] * (k + 1) * z.T[k + 1, j] + m.K[i, j] * z.T[k, j]
        for i in range(n):
            w.vec[V_TRY, i] = product(m.M_inverse, w.vec[A_TRY], i)
        if x[CLOSED_NOW] > 0:
            for c in range(w.num.shape[1]):
                w.num[ALPHA, c] = product(m.G, w.vec[V_TRY], c)
            press(w, w.vec[V_TRY], 0.0)
        for i in range(n):
            z.T[k + 2, i] = w.vec[V_TRY, i] / ((k + 1) * (k + 2))
        c_k, s_k = -m.omega * s_k / (k + 1), m.omega * c_k / (k + 1)
    return True


@inline
def hermite(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, L: float, count: Any) -> bool:
    """Runge-Kutta step of length L, and the quintic through both of its ends.

    The changes are summed up without the state, beside which those of a very short step would be rounded away.
    """
    n = w.vec.shape[1]
    good = acceleration(m, plan, w, x, t, w.vec[Q], w.vec[V], z.a[0], count)
    for i in range(n):
        z.vec[Q_END, i] = L * w.vec[V, i] / 6.0
        z.vec[V_END, i] = L * z.a[0, i] / 6.0
        z.vec[V_STAGE, i] = w.vec[V, i]
    for k in range(1, 4):
        share = 1.0 if k == 3 else 0.5
        weight = L / (6.0 if k == 3 else 3.0)
        for i in range(n):
            z.vec[Q_STAGE, i] = w.vec[Q, i] + share * L * z.vec[V_STAGE, i]
            z.vec[V_STAGE, i] = w.vec[V, i] + share * L * z.a[k - 1, i]
        good = good and acceleration(
            m, plan, w, x, t + share * L, z.vec[Q_STAGE], z.vec[V_STAGE], z.a[k], count
        )
        for i in range(n):
            z.vec[Q_END, i] += weight * z.vec[V_STAGE, i]
            z.vec[V_END, i] += weight * z.a[k, i]
    for i in range(n):
        z.vec[Q_STAGE, i] = w.vec[Q, i] + z.vec[Q_END, i]
        z.vec[V_STAGE, i] = w.vec[V, i] + z.vec[V_END, i]
    good = good and acceleration(m, plan, w, x, t + L, z.vec[Q_STAGE], z.vec[V_STAGE], z.a[4], count)
    z.scale[0] = L
    for i in range(n):
        c_1, c_2 = L * w.vec[V, i], 0.5 * L * L * z.a[0, i]
        d = z.vec[Q_END, i] - c_1 - c_2
        d_v = L * z.vec[V_END, i] - 2.0 * c_2
        d_a = L * L * z.a[4, i] - 2.0 * c_2
        z.T[0, i], z.T[1, i], z.T[2, i] = w.vec[Q, i], c_1, c_2
        z.T[3, i] = 10.0 * d - 4.0 * d_v + 0.5 * d_a
        z.T[4, i] = -15.0 * d + 7.0 * d_v - d_a
        z.T[5, i] = 6.0 * d - 3.0 * d_v + 0.5 * d_a
        good = good and math.isfinite(z.T[5, i])  # what all stages are in
    return good


@inline
def state_at(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, tau: float) -> None:
    """State at tau after the base t of the piece, into z.vec[Q] and z.vec[V]."""
    n = w.vec.shape[1]
    if on_surface(m, plan, w, x):
        surface_state(m, plan, w, x, z, t + tau)
        return
    degree = DEGREE if plan.exact else QUINTIC
    s = tau / z.scale[0]
    for i in range(n):
        q, v = z.T[degree, i], 0.0
        for k in range(degree - 1, -1, -1):
            v = v * s + q
            q = q * s + z.T[k, i]
        z.vec[Q, i], z.vec[V, i] = q, v / z.scale[0]
    if plan.exact and m.frame != ABSENT:
        call(m.frame, t + tau, w.vec[Q], w.vec[V], m.p, m.frame_now)
        for i in range(n):
            z.vec[Q, i] -= m.frame_now[i, 0]
            z.vec[V, i] -= m.frame_now[i, 1]


@inline
def surface_state(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float) -> None:
    """State of the one coordinate on its obstacle; at a corner with the velocity on the near side."""
    inner = within(plan, x, t)
    for c in range(w.num.shape[1]):
        if w.mark[STATUS, c] == CLOSED:
            obstacle(m, t, w.vec[Q], w.vec[V])
            z.vec[Q, 0] = (m.motion_now[c, 0] - m.offset[c]) / m.G[c, 0]
            if inner != t:
                obstacle(m, inner, w.vec[Q], w.vec[V])
            z.vec[V, 0] = m.motion_now[c, 1] / m.G[c, 0]


@inline
def contacts_at(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, tau: float, g: Any, u: Any) -> None:
    """Gaps and gap velocities at tau after the base of the piece."""
    state_at(m, plan, w, x, z, t, tau)
    gaps(m, t + tau, z.vec[Q], z.vec[V], g)
    gap_rates(m, t + tau, z.vec[Q], z.vec[V], w.G_try, w.num[GAP_T_TRY])
    for c in range(len(u)):
        u[c] = product(w.G_try, z.vec[V], c) + w.num[GAP_T_TRY, c]


@inline
def force_at(m: Any, plan: Any, w: Any, x: Any, z: Any, t: float, tau: float, count: Any) -> bool:
    """Forces of the closed contacts at tau after the base of the piece, into w.num[P]."""
    state_at(m, plan, w, x, z, t, tau)
    return acceleration(m, plan, w, x, t + tau, z.vec[Q], z.vec[V], w.vec[V_TRY], count)
