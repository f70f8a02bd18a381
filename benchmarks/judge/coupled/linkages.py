"""Random chains of pendulums whose joints strike a rough floor that may move, and two walls, in angles alone."""

import numpy as np

from lagrangian import Contacts, Coulomb, Scene, System

G = 9.81
# p: for n links m_i and l_i, then damping, torque, its rate, height of floor, its amplitude and rate, width


def mass(t, q, v, p, out):
    n = len(q)
    for i in range(n):
        for j in range(n):
            m = 0.0
            for k in range(max(i, j), n):
                m += p[k]
            out[i, j] = m * p[n + i] * p[n + j] * np.cos(q[i] - q[j])
        out[i, i] += 0.1 * p[i] * p[n + i] ** 2


def force(t, q, v, p, out):
    n = len(q)
    c, torque, rate = p[2 * n], p[2 * n + 1], p[2 * n + 2]
    for i in range(n):
        below = 0.0
        for k in range(i, n):
            below += p[k]
        out[i] = -below * G * p[n + i] * np.sin(q[i]) - c * (v[i] - (v[i - 1] if i > 0 else 0.0))
        if i + 1 < n:
            out[i] -= c * (v[i] - v[i + 1])
        for j in range(n):
            m = 0.0
            for k in range(max(i, j), n):
                m += p[k]
            out[i] -= m * p[n + i] * p[n + j] * np.sin(q[i] - q[j]) * v[j] ** 2
    out[0] += torque * np.sin(rate * t)


def gaps(t, q, v, p, out):
    """Of each joint to the floor, then of the last to both walls."""
    n, x, y = len(q), 0.0, 0.0
    h = p[2 * n + 3] - p[2 * n + 4] * np.sin(p[2 * n + 5] * t)
    for k in range(n):
        x, y = x + p[n + k] * np.sin(q[k]), y - p[n + k] * np.cos(q[k])
        if k > 0:
            out[k - 1] = y + h
    out[n - 1], out[n] = x + p[2 * n + 6], p[2 * n + 6] - x


def rates(t, q, v, p, out):
    n = len(q)
    out[:] = 0.0
    for k in range(n - 1):
        out[k] = -p[2 * n + 4] * p[2 * n + 5] * np.cos(p[2 * n + 5] * t)


def normals(t, q, v, p, out):
    n = len(q)
    out[:] = 0.0
    for i in range(n):
        up, along = p[n + i] * np.sin(q[i]), p[n + i] * np.cos(q[i])
        lead(out, i, up)
        out[n - 1, i], out[n, i] = along, -along


def tangents(t, q, v, p, out):
    n = len(q)
    out[:] = 0.0
    for i in range(n):
        up, along = p[n + i] * np.sin(q[i]), p[n + i] * np.cos(q[i])
        lead(out, i, along)
        out[n - 1, i] = out[n, i] = up


def lead(out, i, share):
    """Link i moves all joints from its lower end on, each of them by as much; the first joint meets nothing."""
    for k in range(max(i, 1), out.shape[1]):
        out[k - 1, i] = share


def linkage(seed):
    """Two to four links of random masses and lengths, friction and restitution."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 5))
    m, lengths = rng.uniform(0.5, 2, n), rng.uniform(0.5, 1.5, n)
    mu, r = float(rng.choice([0, 0.1, 0.3, 0.6, 1.0])), float(rng.choice([0, 0.3, 0.7, 1.0]))
    q0 = rng.uniform(-1.5, 1.5, n)
    depth, across = np.max(np.cumsum(lengths * np.cos(q0))), abs(np.sum(lengths * np.sin(q0)))
    floor, width = max(depth, 0.0) + rng.uniform(0.02, 0.3), across + rng.uniform(0.05, 0.6)
    driven = rng.choice([0.0, 0.3]), rng.choice([0.0, 5.0]), rng.uniform(2, 8)
    shaken = rng.choice([0.0, 0.03]), rng.uniform(3, 15)
    return Scene(
        System(n_q=n, mass=mass, force=force),
        q0,
        v0=rng.choice([0.3, 2.0]) * rng.normal(size=n),
        t_span=(0.0, 1.5),
        contacts=Contacts(
            n + 1, gaps, normals, rates, restitution=r, friction=Coulomb(mu, tangents) if mu else None
        ),
        p=[*m, *lengths, *driven, floor, *shaken, width],
    )
