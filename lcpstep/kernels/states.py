"""What a model says of many states of a motion: gaps, velocities of its contacts, power and energy.

States are times t (n,), positions and velocities q, v (n, n_q), contiguous.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles
    from lcpstep.kernels.acceleration import divide_by_mass, free_acceleration
    from lcpstep.kernels.dynamics import gap_rates, gaps, mass, total_force
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import Doubles, after, max, min, nan


def extremes(m: Model, t: Any, q: Any, v: Any) -> tuple[Any, Any]:
    """The smallest and the largest value of every gap, (n_c,) each; infinite where there are no states."""
    low, high, g = np.full(m.n_c, np.inf), np.full(m.n_c, -np.inf), np.zeros(m.n_c)
    count = len(t)
    at, x, x_t, own, least, most = doubles(t), doubles(q), doubles(v), doubles(g), doubles(low), doubles(high)
    find_extremes(m, count, at, x, x_t, own, least, most)
    return low, high


def find_extremes(
    m: Model, count: int, t: Doubles, q: Doubles, v: Doubles, g: Doubles, low: Doubles, high: Doubles
) -> None:
    """Kernel of `extremes`."""
    with cython.nogil:
        for k in range(count):
            gaps(m, t[k], after(q, k * m.n_q), after(v, k * m.n_q), g)
            for c in range(m.n_c):
                low[c], high[c] = min(low[c], g[c]), max(high[c], g[c])


def gaps_at(m: Model, t: Any, q: Any) -> Any:
    """Every gap at these times and positions, (n, n_c)."""
    count, found, rest = len(t), np.zeros((len(t), m.n_c)), np.zeros(m.n_q)
    at, x, x_t, out = doubles(t), doubles(q), doubles(rest), doubles(found)
    find_gaps(m, count, at, x, x_t, out)
    return found


def find_gaps(m: Model, count: int, t: Doubles, q: Doubles, v: Doubles, out: Doubles) -> None:
    """Kernel of `gaps_at`."""
    with cython.nogil:
        for k in range(count):
            gaps(m, t[k], after(q, k * m.n_q), v, after(out, k * m.n_c))


def own_rates(m: Model, t: Any, q: Any, v: Any, moved: bool) -> Any:
    """g_t of every contact, (n, n_c); with `moved` the whole gap velocity G v + g_t."""
    count, rates = len(t), np.zeros((len(t), m.n_c))
    G, g_t = np.zeros(m.n_c * m.n_q), np.zeros(m.n_c)
    at, x, x_t, jacobian, own, out = (
        doubles(t),
        doubles(q),
        doubles(v),
        doubles(G),
        doubles(g_t),
        doubles(rates),
    )
    find_rates(m, count, at, x, x_t, jacobian, own, moved, out)
    return rates


def find_rates(
    m: Model,
    count: int,
    t: Doubles,
    q: Doubles,
    v: Doubles,
    G: Doubles,
    g_t: Doubles,
    moved: bool,
    out: Doubles,
) -> None:
    """Kernel of `own_rates`."""
    with cython.nogil:
        n = m.n_q
        for k in range(count):
            gap_rates(m, t[k], after(q, k * n), after(v, k * n), G, g_t)
            for c in range(m.n_c):
                rate = g_t[c]
                if moved:
                    for j in range(n):
                        rate += G[c * n + j] * v[k * n + j]
                out[k * m.n_c + c] = rate


def power(m: Model, t: Any, q: Any, v: Any) -> tuple[Any, Any]:
    """Kinetic energy, and the power v^T f of all forces but those of contacts, (n,) each."""
    count, kinetic, supplied = len(t), np.zeros(len(t)), np.zeros(len(t))
    M, f = np.zeros(m.n_q * m.n_q), np.zeros(m.n_q)
    at, x, x_t, matrix, force = doubles(t), doubles(q), doubles(v), doubles(M), doubles(f)
    energy, work = doubles(kinetic), doubles(supplied)
    find_power(m, count, at, x, x_t, matrix, force, energy, work)
    return kinetic, supplied


def find_power(
    m: Model,
    count: int,
    t: Doubles,
    q: Doubles,
    v: Doubles,
    M: Doubles,
    f: Doubles,
    kinetic: Doubles,
    power: Doubles,
) -> None:
    """Kernel of `power`."""
    with cython.nogil:
        n = m.n_q
        for k in range(count):
            x, x_t = after(q, k * n), after(v, k * n)
            mass(m, t[k], x, x_t, M)
            total_force(m, t[k], x, x_t, f)
            for i in range(n):
                power[k] += x_t[i] * f[i]
                for j in range(n):
                    kinetic[k] += 0.5 * M[i * n + j] * x_t[i] * x_t[j]


def energy(m: Model, t: Any, q: Any, v: Any) -> Any:
    """(v^T M v + q^T K q)/2 - constant^T q, (n,)."""
    count, total, M = len(t), np.zeros(len(t)), np.zeros(m.n_q * m.n_q)
    at, x, x_t, matrix, out = doubles(t), doubles(q), doubles(v), doubles(M), doubles(total)
    find_energy(m, count, at, x, x_t, matrix, out)
    return total


def find_energy(m: Model, count: int, t: Doubles, q: Doubles, v: Doubles, M: Doubles, out: Doubles) -> None:
    """Kernel of `energy`."""
    with cython.nogil:
        n = m.n_q
        for k in range(count):
            x, x_t, total = after(q, k * n), after(v, k * n), 0.0
            mass(m, t[k], x, x_t, M)
            for i in range(n):
                total -= m.constant[i] * x[i]
                momentum = elastic = 0.0  # of a row each: rows do not wait for one another
                for j in range(n):
                    momentum += M[i * n + j] * x_t[j]
                    elastic += m.K[i * n + j] * x[j]
                total += 0.5 * (x_t[i] * momentum + x[i] * elastic)
            out[k] = total


def accelerations(m: Model, t: Any, q: Any, v: Any) -> Any:
    """M^-1 f without the forces of contacts, (n, n_q); not-a-number where M is singular."""
    count, found, work = len(t), np.zeros((len(t), m.n_q)), np.zeros((m.n_q + 1) * m.n_q)
    at, x, x_t, space, out = doubles(t), doubles(q), doubles(v), doubles(work), doubles(found)
    find_accelerations(m, count, at, x, x_t, space, out)
    return found


def find_accelerations(
    m: Model, count: int, t: Doubles, q: Doubles, v: Doubles, work: Doubles, out: Doubles
) -> None:
    """Kernel of `accelerations`."""
    with cython.nogil:
        n = m.n_q
        for k in range(count):
            a = after(out, k * n)
            if not free_acceleration(m, t[k], after(q, k * n), after(v, k * n), after(work, n), work, a):
                for i in range(n):
                    a[i] = nan


def responses(m: Model, t: Any, q: Any, v: Any) -> tuple[Any, Any]:
    """The gaps' Jacobian G and M^-1 G^T by rows, (n, n_c, n_q) each."""
    count, work, rates = len(t), np.zeros((m.n_q + 1) * m.n_q), np.zeros(m.n_c)
    G, MG = np.zeros((2, len(t), m.n_c, m.n_q))
    at, x, x_t, own, space = doubles(t), doubles(q), doubles(v), doubles(rates), doubles(work)
    rows, back = doubles(G), doubles(MG)
    find_responses(m, count, at, x, x_t, own, space, rows, back)
    return G, MG


def find_responses(
    m: Model, count: int, t: Doubles, q: Doubles, v: Doubles, rates: Doubles, work: Doubles, G: Doubles,
    MG: Doubles,
) -> None:  # fmt: skip
    """Kernel of `responses`."""
    with cython.nogil:
        n, size = m.n_q, m.n_c * m.n_q
        for k in range(count):
            x, x_t, own = after(q, k * n), after(v, k * n), after(G, k * size)
            gap_rates(m, t[k], x, x_t, own, rates)
            copy(after(MG, k * size), own, size)
            for c in range(m.n_c):
                divide_by_mass(m, t[k], x, x_t, after(work, n), work, after(MG, k * size + c * n))
