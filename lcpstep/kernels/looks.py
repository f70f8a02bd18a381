"""Looks at a finished run that tell, in one pass, whether there is anything to say of it.

`lies_inside` and `highest` hold wherever `room`, `depth` or `resolution` of `lcpstep.doubts` have something to say,
at the very states that these look at. A run is kept at times t (n,) in states q, v (n, n_q), contiguous.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import gap_rates, gaps, mass, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy, finite
from lcpstep.pointers import Doubles, abs, after, inf, max, min, whole


def lies_inside(m: Model, t: Any, q: Any, looks: int, share: float, towards: bool) -> bool:
    """Whether a gap at one of so many states is below zero by more than this share of how far the coordinates went.

    towards : how far they went towards the obstacle, instead of on the whole
    """
    count, work = len(t), np.zeros(2 * m.n_c + m.n_c * m.n_q + 4 * m.n_q)
    at, x, own = doubles(t), doubles(q), doubles(work)
    return bool(find_inside(m, count, at, x, looks, share, towards, own))


@cython.cfunc
def find_inside(
    m: Model, count: int, t: Doubles, q: Doubles, looks: int, share: float, towards: bool, work: Doubles
) -> bool:
    """Kernel of `lies_inside`."""
    n, before, lowest, square, found = m.n_q, -1, 0.0, 0.0, False
    still, low, high, x = work, after(work, n), after(work, 2 * n), after(work, 3 * n)
    g, g_t, G = after(work, 4 * n), after(work, 4 * n + m.n_c), after(work, 4 * n + 2 * m.n_c)
    with cython.nogil:
        for j in range(n):
            low[j], high[j] = inf, -inf
        for i in range(looks):
            k = place(i, looks, count)
            if k != before:
                gaps_at(m, t[k], after(q, k * n), still, x, g)
                for c in range(m.n_c):
                    if not g[c] >= lowest:
                        lowest = g[c]
                for j in range(n):
                    low[j], high[j] = min(low[j], q[k * n + j]), max(high[j], q[k * n + j])
            before = k
        for j in range(n):
            square += (high[j] - low[j]) * (high[j] - low[j])
        if not towards:
            found = not lowest >= -share * sqrt(square)
        elif not lowest >= 0.0:
            for i in range(looks):
                k = place(i, looks, count)
                gaps_at(m, t[k], after(q, k * n), still, x, g)
                gap_rates(m, t[k], after(q, k * n), still, G, g_t)
                for c in range(m.n_c):
                    if not g[c] >= 0.0:
                        size = 0.0
                        for j in range(n):
                            size += abs(G[c * n + j]) * (high[j] - low[j])
                        if not -g[c] <= share * size:
                            found = True
    return found


def gaps_at(m: Model, t: float, q: Doubles, v: Doubles, x: Doubles, g: Doubles) -> None:
    """Every gap at a state of the scene, in whatever coordinates its model is; x (n_q,) is work space."""
    copy(x, q, m.n_q)
    if m.carried:
        m.frame.fill(t, q, v, m.frame_now)
        for j in range(m.n_q):
            x[j] += m.frame_now[3 * j]
    gaps(m, t, x, v, g)


def place(i: int, looks: int, count: int) -> int:
    """Which state is the look i of so many over all states."""
    if i == looks - 1:
        return count - 1
    return whole(i * ((count - 1) / (looks - 1.0)))


def highest(m: Model, t: Any, q: Any, v: Any, looks: int, near: float) -> float:
    """The largest |v^T (f(q + e v) - f(q - e v))| / (2 e v^T M v) at so many states, e = near [rad^2/s^2]."""
    count, work = len(t), np.zeros(m.n_q * (m.n_q + 2))
    at, x, x_t, own = doubles(t), doubles(q), doubles(v), doubles(work)
    return float(find_highest(m, count, at, x, x_t, looks, near, own))


@cython.cfunc
def find_highest(
    m: Model, count: int, t: Doubles, q: Doubles, v: Doubles, looks: int, near: float, work: Doubles
) -> float:
    """Kernel of `highest`."""
    n, most = m.n_q, 0.0
    x, f, M = work, after(work, n), after(work, 2 * n)
    with cython.nogil:
        for i in range(looks):
            k = whole((i + 1) * ((count - 1.0) / looks))
            x_t, kinetic, change = after(v, k * n), 0.0, 0.0
            for side in range(-1, 2, 2):
                power = 0.0
                for j in range(n):
                    x[j] = q[k * n + j] + side * near * x_t[j]
                total_force(m, t[k], x, x_t, f)
                for j in range(n):
                    power += x_t[j] * f[j]
                change += side * power
            mass(m, t[k], x, x_t, M)
            for j in range(n):
                for i_q in range(n):
                    kinetic += 0.5 * M[j * n + i_q] * x_t[j] * x_t[i_q]
            most = max(most, abs(change) / (4.0 * near * kinetic)) if kinetic > 0.0 else most
    return most


@cython.ccall
def at_most(m: Model) -> tuple[float, float]:
    """Bounds of the largest eigenvalues of M^-1 K and M^-1 C of a linear system [1/s^2, 1/s]."""
    inverse = largest_row(m.M_inverse, m.n_q)
    return inverse * largest_row(m.K, m.n_q), inverse * largest_row(m.C, m.n_q)


def largest_row(A: Doubles, n: int) -> float:
    """The largest sum of magnitudes of a row of a matrix (n, n)."""
    most = 0.0
    for i in range(n):
        total = 0.0
        for j in range(n):
            total += abs(A[i * n + j])
        most = max(most, total)
    return most


def all_finite(x: Any) -> bool:
    """Whether no number of a contiguous array is infinite or not-a-number."""
    return bool(four_at_once(doubles(x), x.size))


@cython.cfunc
def four_at_once(x: Doubles, n: int) -> bool:
    """Kernel of `all_finite`: sums that do not wait for each other."""
    a, b, c, d, whole_fours = 0.0, 0.0, 0.0, 0.0, n - n % 4
    with cython.nogil:
        for i in range(0, whole_fours, 4):
            a += x[i] - x[i]
            b += x[i + 1] - x[i + 1]
            c += x[i + 2] - x[i + 2]
            d += x[i + 3] - x[i + 3]
    return a + b + c + d == 0.0 and finite(after(x, whole_fours), n - whole_fours)
