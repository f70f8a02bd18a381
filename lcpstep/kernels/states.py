"""What a model says of many states of a motion: gaps, velocities of its contacts, power and energy.

States are times t (n,), positions and velocities q, v (n, n_q), contiguous.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.acceleration import divide_by_mass, free_acceleration
from lcpstep.kernels.dynamics import gap_rates, gaps, mass, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import after, max, min, nan


@cython.ccall
def extremes(m: Model, t: Any, q: Any, v: Any) -> tuple[Any, Any]:
    """The smallest and the largest value of every gap, (n_c,) each; infinite where there are no states."""
    low, high, now = np.full(m.n_c, np.inf), np.full(m.n_c, -np.inf), np.zeros(m.n_c)
    count, at, x, x_t, g = len(t), doubles(t), doubles(q), doubles(v), doubles(now)
    least, most = doubles(low), doubles(high)
    with cython.nogil:
        for k in range(count):
            gaps(m, at[k], after(x, k * m.n_q), after(x_t, k * m.n_q), g)
            for c in range(m.n_c):
                least[c], most[c] = min(least[c], g[c]), max(most[c], g[c])
    return low, high


@cython.ccall
def gaps_at(m: Model, t: Any, q: Any) -> Any:
    """Every gap at these times and positions, (n, n_c)."""
    found, rest = np.zeros((len(t), m.n_c)), np.zeros(m.n_q)
    count, at, x, x_t, out = len(t), doubles(t), doubles(q), doubles(rest), doubles(found)
    with cython.nogil:
        for k in range(count):
            gaps(m, at[k], after(x, k * m.n_q), x_t, after(out, k * m.n_c))
    return found


@cython.ccall
def own_rates(m: Model, t: Any, q: Any, v: Any, moved: bool) -> Any:
    """g_t of every contact, (n, n_c); with `moved` the whole gap velocity G v + g_t."""
    rates, rows, own = np.zeros((len(t), m.n_c)), np.zeros(m.n_c * m.n_q), np.zeros(m.n_c)
    count, n, at, x, x_t = len(t), m.n_q, doubles(t), doubles(q), doubles(v)
    G, g_t, out = doubles(rows), doubles(own), doubles(rates)
    with cython.nogil:
        for k in range(count):
            gap_rates(m, at[k], after(x, k * n), after(x_t, k * n), G, g_t)
            for c in range(m.n_c):
                rate = g_t[c]
                if moved:
                    for j in range(n):
                        rate += G[c * n + j] * x_t[k * n + j]
                out[k * m.n_c + c] = rate
    return rates


@cython.ccall
def power(m: Model, t: Any, q: Any, v: Any) -> tuple[Any, Any]:
    """Kinetic energy, and the power v^T f of all forces but those of contacts, (n,) each."""
    kinetic, supplied, work = np.zeros(len(t)), np.zeros(len(t)), np.zeros((m.n_q + 1) * m.n_q)
    count, n, at, x, x_t = len(t), m.n_q, doubles(t), doubles(q), doubles(v)
    T, P, f = doubles(kinetic), doubles(supplied), doubles(work)
    M = after(f, n)
    with cython.nogil:
        for k in range(count):
            q_k, v_k = after(x, k * n), after(x_t, k * n)
            mass(m, at[k], q_k, v_k, M)
            total_force(m, at[k], q_k, v_k, f)
            for i in range(n):
                P[k] += v_k[i] * f[i]
                for j in range(n):
                    T[k] += 0.5 * M[i * n + j] * v_k[i] * v_k[j]
    return kinetic, supplied


@cython.ccall
def energy(m: Model, t: Any, q: Any, v: Any) -> Any:
    """(v^T M v + q^T K q)/2 - constant^T q, (n,)."""
    found, matrix = np.zeros(len(t)), np.zeros(m.n_q * m.n_q)
    count, n, at, x, x_t = len(t), m.n_q, doubles(t), doubles(q), doubles(v)
    M, out = doubles(matrix), doubles(found)
    with cython.nogil:
        for k in range(count):
            q_k, v_k, total = after(x, k * n), after(x_t, k * n), 0.0
            mass(m, at[k], q_k, v_k, M)
            for i in range(n):
                total -= m.constant[i] * q_k[i]
                momentum = elastic = 0.0  # of a row each: rows do not wait for one another
                for j in range(n):
                    momentum += M[i * n + j] * v_k[j]
                    elastic += m.K[i * n + j] * q_k[j]
                total += 0.5 * (v_k[i] * momentum + q_k[i] * elastic)
            out[k] = total
    return found


@cython.ccall
def accelerations(m: Model, t: Any, q: Any, v: Any) -> Any:
    """M^-1 f without the forces of contacts, (n, n_q); not-a-number where M is singular."""
    found, work = np.zeros((len(t), m.n_q)), np.zeros((m.n_q + 1) * m.n_q)
    count, n, at, x, x_t = len(t), m.n_q, doubles(t), doubles(q), doubles(v)
    y, out = doubles(work), doubles(found)
    with cython.nogil:
        for k in range(count):
            a = after(out, k * n)
            if not free_acceleration(m, at[k], after(x, k * n), after(x_t, k * n), after(y, n), y, a):
                for i in range(n):
                    a[i] = nan
    return found


@cython.ccall
def responses(m: Model, t: Any, q: Any, v: Any) -> tuple[Any, Any]:
    """The gaps' Jacobian G and M^-1 G^T by rows, (n, n_c, n_q) each."""
    work, own = np.zeros((m.n_q + 1) * m.n_q), np.zeros(m.n_c)
    G, MG = np.zeros((2, len(t), m.n_c, m.n_q))
    count, n, size, at, x, x_t = len(t), m.n_q, m.n_c * m.n_q, doubles(t), doubles(q), doubles(v)
    y, rates, rows, back = doubles(work), doubles(own), doubles(G), doubles(MG)
    with cython.nogil:
        for k in range(count):
            q_k, v_k, row = after(x, k * n), after(x_t, k * n), after(rows, k * size)
            gap_rates(m, at[k], q_k, v_k, row, rates)
            copy(after(back, k * size), row, size)
            for c in range(m.n_c):
                divide_by_mass(m, at[k], q_k, v_k, after(y, n), y, after(back, k * size + c * n))
    return G, MG


@cython.ccall
def gradients_at(m: Model, t: Any, q: Any) -> Any:
    """Those of every gap at these times and positions, (n, n_c, n_q)."""
    found, rest, own = np.zeros((len(t), m.n_c, m.n_q)), np.zeros(m.n_q), np.zeros(m.n_c)
    count, at, x, x_t, g_t, out = len(t), doubles(t), doubles(q), doubles(rest), doubles(own), doubles(found)
    with cython.nogil:
        for k in range(count):
            gap_rates(m, at[k], after(x, k * m.n_q), x_t, after(out, k * m.n_c * m.n_q), g_t)
    return found
