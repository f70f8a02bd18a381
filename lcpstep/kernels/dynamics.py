"""The equations of a model, evaluated: forces, masses, gaps, gap velocities and accelerations.

    M v' = f(t, q, v) + G^T lambda,    u = G v + g_t,    u' = G v' + bias

Outputs are written into the arrays handed in; matrices lie row by row.
"""

from __future__ import annotations

from math import cos, sin

import cython

from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy, product, product_between
from lcpstep.pointers import Doubles, abs, after


def external_force(m: Model, t: float, q: Doubles, v: Doubles, out: Doubles) -> None:
    """F(t) of a linear system, the forces of a moving frame included."""
    n = m.n_q
    if m.force.given:
        m.force.fill(t, q, v, out)
    else:
        cosine, sine = 1.0, 0.0
        if m.omega != 0.0:
            cosine, sine = cos(m.omega * t), sin(m.omega * t)
        for i in range(n):
            out[i] = m.constant[i] + m.cosine[i] * cosine + m.sine[i] * sine
    if m.frame.given and not m.carried:
        c = m.frame_now
        m.frame.fill(t, q, v, c)
        for i in range(n):
            for j in range(n):
                k = i * n + j
                out[i] -= m.M[k] * c[3 * j + 2] + m.C[k] * c[3 * j + 1] + m.K[k] * c[3 * j]


def implicit_mass(m: Model, x: float, out: Doubles) -> None:
    """M + x C + x^2 K, by which implicit steps divide forces: x is the share of the step that these act on."""
    for i in range(m.n_q * m.n_q):
        out[i] = m.M[i] + x * m.C[i] + x * x * m.K[i]


def harmonic_terms(m: Model, i: int) -> float:
    """Size of the terms of the harmonic force on coordinate i; 0 of a callback's, whose terms are not known."""
    return 0.0 if m.force.given else abs(m.constant[i]) + abs(m.cosine[i]) + abs(m.sine[i])


@cython.ccall
@cython.nogil
def varies(m: Model) -> bool:
    """Whether F(t) of a linear system is another at another time."""
    return m.force.given or m.omega != 0.0 or (m.frame.given and not m.carried)


def total_force(m: Model, t: float, q: Doubles, v: Doubles, out: Doubles) -> None:
    """f(t, q, v): all forces but those of the contacts."""
    if m.moded:
        force_of_mode(m, t, q, v, out)
        return
    if not m.linear:
        m.force.fill(t, q, v, out)
        return
    external_force(m, t, q, v, out)
    for i in range(m.n_q):
        for j in range(m.C_ends[2 * i], m.C_ends[2 * i + 1]):
            out[i] -= m.C[i * m.n_q + j] * v[j] + m.K[i * m.n_q + j] * q[j]


def force_of_mode(m: Model, t: float, q: Doubles, v: Doubles, out: Doubles) -> None:
    """M a, with the acceleration a that the field of the mode at hand gives."""
    n = m.n_q
    copy(m.x, q, n)
    copy(after(m.x, n), v, n)
    m.modes.fill(m.mode, t, m.x, m.x, m.x_t)
    mass(m, t, q, v, m.mass_now)
    for i in range(n):
        out[i] = product(m.mass_now, after(m.x_t, n), i, n)


def mass(m: Model, t: float, q: Doubles, v: Doubles, out: Doubles) -> None:
    """M(t, q)."""
    if m.mass.given:
        m.mass.fill(t, q, v, out)
    else:
        copy(out, m.M, m.n_q * m.n_q)


def gaps(m: Model, t: float, q: Doubles, v: Doubles, g: Doubles) -> None:
    """g(t, q)."""
    if not m.flat:
        m.gap.fill(t, q, v, g)
        return
    obstacle(m, t, q, v)
    for c in range(m.n_c):
        g[c] = m.offset[c] - m.motion_now[3 * c]
        for j in range(m.G_ends[2 * c], m.G_ends[2 * c + 1]):
            g[c] += m.G[c * m.n_q + j] * q[j]


def gap_rates(m: Model, t: float, q: Doubles, v: Doubles, G: Doubles, g_t: Doubles) -> None:
    """G(t, q) and g_t(t, q), so that u = G v + g_t."""
    if m.flat:
        obstacle(m, t, q, v)
        for c in range(m.n_c):
            g_t[c] = -m.motion_now[3 * c + 1]
            for j in range(m.n_q):
                G[c * m.n_q + j] = m.G[c * m.n_q + j]
        return
    m.jacobian.fill(t, q, v, G)
    for c in range(m.n_c):
        g_t[c] = 0.0
    if m.gap_t.given:
        m.gap_t.fill(t, q, v, g_t)


def gap_velocities(m: Model, t: float, q: Doubles, v: Doubles, G: Doubles, g_t: Doubles, u: Doubles) -> None:
    """U = G v + g_t, right after the `gaps` of the same state; rows that change are left in G, g_t."""
    if m.flat:  # the obstacle's velocity came with the gap
        for c in range(m.n_c):
            u[c] = product_between(m.G, v, c, m.n_q, m.G_ends) - m.motion_now[3 * c + 1]
        return
    gap_rates(m, t, q, v, G, g_t)
    for c in range(m.n_c):
        u[c] = product(G, v, c, m.n_q) + g_t[c]


def obstacle(m: Model, t: float, q: Doubles, v: Doubles) -> None:
    """Position, velocity and acceleration of the obstacles of flat contacts, into `m.motion_now`."""
    if m.motion.given:
        m.motion.fill(t, q, v, m.motion_now)
    if m.carried:
        carry_obstacles(m, t, q, v)


@cython.ccall
@cython.nogil
def moves(m: Model) -> bool:
    """Whether obstacles of flat contacts move."""
    return m.motion.given or m.carried


def carry_obstacles(m: Model, t: float, q: Doubles, v: Doubles) -> None:
    """Add the motion of the frame to that of the obstacles: with x = q + c the gap is G x + offset - (s + G c)."""
    m.frame.fill(t, q, v, m.frame_now)
    for c in range(m.n_c):
        for k in range(3):
            own = m.motion_now[3 * c + k] if m.motion.given else 0.0
            for j in range(m.n_q):
                own += m.G[c * m.n_q + j] * m.frame_now[3 * j + k]
            m.motion_now[3 * c + k] = own
