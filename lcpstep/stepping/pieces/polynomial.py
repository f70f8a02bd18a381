"""Pieces of smooth motion as polynomials, as kernels: Taylor's of a linear system, Hermite's of a Runge-Kutta step.

Taylor: y'' = M^-1 (F(t) - C y' - K y) under constant and harmonic forces gives each coefficient from the two before,

    (k+1) (k+2) T_{k+2} = M^-1 (F_k - C (k+1) T_{k+1} - K T_k),

exact to rounding where the piece is short against the periods. Runge-Kutta: the classical step of order four, and the
quintic through position, velocity and acceleration at both of its ends. Closed contacts enter by their forces, lambda
= -(G M^-1 G^T)^-1 (G a + bias). Sources: E. Hairer, S. Norsett, G. Wanner, Solving Ordinary Differential Equations I,
sections I.8 and II.1; G. Osorio, eq. 3.5.
"""

from __future__ import annotations

from math import cos, isfinite, sin

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import gap_rates, gap_velocities, gaps, obstacle
from lcpstep.kernels.linear import grow_factor, solve_factored
from lcpstep.kernels.model import Model
from lcpstep.kernels.turn import Turn
from lcpstep.kernels.vectors import add, clear, copy, product, product_between
from lcpstep.pointers import Doubles, after, max
from lcpstep.stepping.pieces.codes import CLOSED
from lcpstep.stepping.pieces.smooth import free_acceleration, gap_accelerations, gap_bias, respond
from lcpstep.stepping.pieces.state import Plan, Work
from lcpstep.stepping.pieces.times import within

DEGREE, QUINTIC = 22, 5  # of Taylor's polynomials and of Hermite's
PROBES = 4  # of contact forces on a piece
DOUBTFUL = 64.0  # rounding of a factor's diagonal, in its own units, from which on forces are corrected,
CORRECTIONS = 2  # so many times


class Polynomial:
    """A piece of motion q(tau) = sum_k T_k (tau / scale)^k, and work space for making it and finding its events.

    T : (DEGREE + 1, n_q)   of which those up to `degree` are not zero
    t, scale                base of the piece, and what times after it are divided by
    a : (5, n_q)            accelerations of the stages
    q, v                    state last asked for
    q_stage, v_stage, q_end, v_end
    gap_from, velocity_from, gap_to, velocity_to    gaps and their velocities at both ends of an interval of the scan
    velocity_now
    pressed : (PROBES + 1, n_c)   contact forces at equal distances;  turn  in which their least is sought

    Parameters
    ----------
    n_q, n_c : int   coordinates, contacts
    """

    def __init__(self, n_q: int, n_c: int) -> None:
        self.kept = np.zeros((DEGREE + 1 + 5 + 6) * n_q + (6 + PROBES) * n_c)
        x = doubles(self.kept)
        self.t, self.scale, self.degree = 0.0, 1.0, 1
        self.T, self.a = x, after(x, (DEGREE + 1) * n_q)
        x = after(x, (DEGREE + 6) * n_q)
        self.q, self.v, self.q_stage = x, after(x, n_q), after(x, 2 * n_q)
        self.v_stage, self.q_end, self.v_end = after(x, 3 * n_q), after(x, 4 * n_q), after(x, 5 * n_q)
        x = after(x, 6 * n_q)
        self.gap_from, self.velocity_from, self.gap_to = x, after(x, n_c), after(x, 2 * n_c)
        self.velocity_to, self.velocity_now = after(x, 3 * n_c), after(x, 4 * n_c)
        self.pressed = after(x, 5 * n_c)
        self.turn = Turn()


def on_surface(plan: Plan, w: Work) -> bool:
    """Whether the one coordinate of an exact motion lies on its obstacle, which then says where it is."""
    return plan.exact and w.closed_now > 0 and w.n_q == 1


def acceleration(m: Model, plan: Plan, w: Work, t: float, q: Doubles, v: Doubles, out: Doubles) -> bool:
    """Acceleration with the forces of closed contacts, if there are any; False where a matrix fails."""
    w.force_evaluations += 1
    if w.closed_now == 0:
        return free_acceleration(m, w, within(w, t), q, v, out)
    return constrained(m, plan, w, t, q, v, out)


def constrained(m: Model, plan: Plan, w: Work, t: float, q: Doubles, v: Doubles, out: Doubles) -> bool:
    """Acceleration with the forces of closed contacts, which go to w.p; False where a matrix fails."""
    if not free_acceleration(m, w, within(w, t), q, v, out):
        return False
    gap_rates(m, t, q, v, w.G, w.gap_t)
    gap_bias(m, w, t, q, v)
    if not plan.constant:
        respond(m, w)
    gap_accelerations(w, out)
    factor_closed(w)
    press(w, out, 1.0)
    return True


def factor_closed(w: Work) -> None:
    """Cholesky's factor of the closed contacts' Delassus matrix: of the independent ones, those under load first."""
    n_c, n_k = w.n_c, 0
    for loaded in range(1, -1, -1):
        for c in range(n_c):
            if w.status[c] == CLOSED and (w.force_now[c] > 0.0) == loaded:
                w.held[n_k] = c
                if grow_factor(w.W, n_c, w.problem, n_c, w.held, w.doubt, n_k):
                    n_k += 1
    w.n_held = n_k


def press(w: Work, out: Doubles, share: float) -> None:
    """Forces that cancel w.alpha of the closed contacts, into w.p; what they do to the acceleration `out`.

    Where the factor is in doubt, as beside very unlike masses, what the acceleration leaves of `share` of the
    obstacles' own w.bias is taken out of both.
    """
    n_c, n_k, doubt = w.n_c, w.n_held, 0.0
    clear(w.p, n_c)
    for k in range(n_k):
        doubt = max(doubt, w.doubt[k])
    add_forces(w, out, n_k)
    if doubt > DOUBTFUL:
        for _ in range(CORRECTIONS):
            for k in range(n_k):
                c = w.held[k]
                w.alpha[c] = product(w.G, out, c, w.n_q) + share * w.bias[c]
            add_forces(w, out, n_k)


def add_forces(w: Work, out: Doubles, n_k: int) -> None:
    """Add to w.p and to the acceleration what cancels w.alpha."""
    for k in range(n_k):
        w.change[k] = -w.alpha[w.held[k]]
    solve_factored(w.problem, w.n_c, n_k, w.change)
    for k in range(n_k):
        c, force = w.held[k], w.change[k]
        w.p[c] += force
        add(out, force, after(w.MG, c * w.n_q), w.n_q)


def expand(m: Model, plan: Plan, w: Work, z: Polynomial, t: float, length: float) -> bool:
    """The polynomial of the piece that begins at t."""
    z.t = t
    if plan.exact:
        return taylor(m, plan, w, z, t)
    return hermite(m, plan, w, z, t, length)


def taylor(m: Model, plan: Plan, w: Work, z: Polynomial, t: float) -> bool:
    """Taylor coefficients of y at t, up to where all that follow are zero."""
    n, quiet = w.n_q, 0
    z.scale, z.degree = 1.0, 1
    copy(z.T, w.q, w.n_q)
    copy(after(z.T, n), w.v, w.n_q)
    if on_surface(plan, w):
        return True
    if w.closed_now > 0:
        factor_closed(w)
    c_k, s_k = cos(m.omega * t), sin(m.omega * t)
    for k in range(DEGREE - 1):
        moves = False
        for i in range(n):
            w.a_try[i] = m.cosine[i] * c_k + m.sine[i] * s_k
            moves = moves or w.a_try[i] != 0.0
            w.a_try[i] += m.constant[i] if k == 0 else 0.0
            for j in range(m.C_ends[2 * i], m.C_ends[2 * i + 1]):
                w.a_try[i] -= (
                    m.C[i * n + j] * (k + 1) * z.T[(k + 1) * n + j] + m.K[i * n + j] * z.T[k * n + j]
                )
        for i in range(n):
            w.v_try[i] = product_between(m.M_inverse, w.a_try, i, w.n_q, m.M_ends)
        if w.closed_now > 0:
            for c in range(w.n_c):
                w.alpha[c] = product_between(m.G, w.v_try, c, w.n_q, m.G_ends)
            press(w, w.v_try, 0.0)
        for i in range(n):
            z.T[(k + 2) * n + i] = w.v_try[i] / ((k + 1) * (k + 2))
            moves = moves or w.v_try[i] != 0.0
        z.degree = k + 2
        quiet = 0 if moves else quiet + 1
        if quiet == 2:  # what follows is made of these two, and of forces that vanish like theirs
            return True
        c_k, s_k = -m.omega * s_k / (k + 1), m.omega * c_k / (k + 1)
    return True


def hermite(m: Model, plan: Plan, w: Work, z: Polynomial, t: float, L: float) -> bool:
    """Runge-Kutta step of length L, and the quintic through both of its ends.

    The changes are summed up without the state, beside which those of a very short step would be rounded away.
    """
    n = w.n_q
    good = acceleration(m, plan, w, t, w.q, w.v, z.a)
    for i in range(n):
        z.q_end[i] = L * w.v[i] / 6.0
        z.v_end[i] = L * z.a[i] / 6.0
        z.v_stage[i] = w.v[i]
    for k in range(1, 4):
        share = 1.0 if k == 3 else 0.5
        weight = L / (6.0 if k == 3 else 3.0)
        for i in range(n):
            z.q_stage[i] = w.q[i] + share * L * z.v_stage[i]
            z.v_stage[i] = w.v[i] + share * L * z.a[(k - 1) * n + i]
        good = good and acceleration(m, plan, w, t + share * L, z.q_stage, z.v_stage, after(z.a, k * n))
        for i in range(n):
            z.q_end[i] += weight * z.v_stage[i]
            z.v_end[i] += weight * z.a[k * n + i]
    for i in range(n):
        z.q_stage[i] = w.q[i] + z.q_end[i]
        z.v_stage[i] = w.v[i] + z.v_end[i]
    good = good and acceleration(m, plan, w, t + L, z.q_stage, z.v_stage, after(z.a, 4 * n))
    z.scale, z.degree = L, QUINTIC
    for i in range(n):
        c_1, c_2 = L * w.v[i], 0.5 * L * L * z.a[i]
        d = z.q_end[i] - c_1 - c_2
        d_v = L * z.v_end[i] - 2.0 * c_2
        d_a = L * L * z.a[4 * n + i] - 2.0 * c_2
        z.T[i], z.T[n + i], z.T[2 * n + i] = w.q[i], c_1, c_2
        z.T[3 * n + i] = 10.0 * d - 4.0 * d_v + 0.5 * d_a
        z.T[4 * n + i] = -15.0 * d + 7.0 * d_v - d_a
        z.T[5 * n + i] = 6.0 * d - 3.0 * d_v + 0.5 * d_a
        good = good and isfinite(z.T[5 * n + i])  # what all stages are in
    return good


def state_at(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float) -> None:
    """State at tau after the base of the piece, into z.q and z.v."""
    n = w.n_q
    if on_surface(plan, w):
        surface_state(m, w, z, z.t + tau)
        return
    s = tau / z.scale
    for i in range(n):
        q, v = z.T[z.degree * n + i], 0.0
        for k in range(z.degree - 1, -1, -1):
            v = v * s + q
            q = q * s + z.T[k * n + i]
        z.q[i], z.v[i] = q, v / z.scale


def surface_state(m: Model, w: Work, z: Polynomial, t: float) -> None:
    """State of the one coordinate on its obstacle; at a corner with the velocity on the near side."""
    inner = within(w, t)
    for c in range(w.n_c):
        if w.status[c] == CLOSED:
            obstacle(m, t, w.q, w.v)
            z.q[0] = (m.motion_now[3 * c] - m.offset[c]) / m.G[c]
            if inner != t:
                obstacle(m, inner, w.q, w.v)
            z.v[0] = m.motion_now[3 * c + 1] / m.G[c]


def contacts_at(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float, g: Doubles, u: Doubles) -> None:
    """Gaps and gap velocities at tau after the base of the piece."""
    state_at(m, plan, w, z, tau)
    gaps(m, z.t + tau, z.q, z.v, g)
    gap_velocities(m, z.t + tau, z.q, z.v, w.G_try, w.gap_t_try, u)


def force_at(m: Model, plan: Plan, w: Work, z: Polynomial, tau: float) -> bool:
    """Forces of the closed contacts at tau after the base of the piece, into w.p."""
    state_at(m, plan, w, z, tau)
    return acceleration(m, plan, w, z.t + tau, z.q, z.v, w.v_try)
