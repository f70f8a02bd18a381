"""Looks at a finished run that tell, in one pass, whether there is anything to say of it.

`lies_inside` and `highest` hold wherever `lcpstep.room`, `lcpstep.depth` or `lcpstep.resolution` have something to
say, at the very states that these look at; `turning` is what `lcpstep.fast_gaps` says. A run is kept at times t (n,)
in states q, v (n, n_q), contiguous.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import gap_rates, gaps, mass, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy, finite, size_of_product
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


def turning(
    m: Model, t: Any, q: Any, v: Any, steps: int, looks: int, golden: float, places: Any, limits: Any
) -> tuple[int, int]:
    """The first of so many looks, spread by the golden ratio, where a gap turns within a step, and which gap.

    places : (k,)   between which it leaves its straight line, in steps after a look
    limits : NEAR, FASTER, PLAIN, LEAST_SHARE and ROUNDING of `lcpstep.fast_gaps`

    Returns
    -------
    look and contact; -1 and 0 where there is none
    """
    count, work = len(t), np.zeros((2 * looks + 6) * m.n_c + m.n_q * (m.n_c + m.n_q + 2))
    at, x, x_t = doubles(t), doubles(q), doubles(v)
    others, bounds, own = doubles(places), doubles(limits), doubles(work)
    found = find_turn(m, count, at, x, x_t, steps, looks, golden, others, len(places), bounds, own)
    return (found // m.n_c, found % m.n_c) if found >= 0 else (-1, 0)


@cython.cfunc
def find_turn(
    m: Model,
    count: int,
    t: Doubles,
    q: Doubles,
    v: Doubles,
    steps: int,
    looks: int,
    golden: float,
    places: Doubles,
    n_places: int,
    limits: Doubles,
    work: Doubles,
) -> int:
    """Kernel of `turning`."""
    n, n_q, found = m.n_c, m.n_q, -1
    near, faster, plain, least, rounding = limits[0], limits[1], limits[2], limits[3], limits[4]
    before, later, largest, x = work, after(work, n), after(work, 5 * n), after(work, 6 * n)
    start, end, other = after(work, 2 * n), after(work, 3 * n), after(work, 4 * n)
    G, g = after(x, n_q), after(x, n_q * (n + 1))
    bent, force = after(g, looks * n), after(g, 2 * looks * n)
    with cython.nogil:
        first, last = t[0], t[count - 1]
        mean = (last - first) / steps
        for i in range(looks):
            at = spread(i, looks, golden) * (count - 1)
            k = whole(at)
            share, h, own, v_own = at - k, min(t[k + 1] - t[k], mean), after(q, k * n_q), after(v, k * n_q)
            ahead(m, t[k], first, last, own, v_own, (share - near) * h, x, before)
            ahead(m, t[k], first, last, own, v_own, share * h, x, after(g, i * n))
            ahead(m, t[k], first, last, own, v_own, (share + near) * h, x, later)
            for c in range(n):
                here = g[i * n + c]
                bent[i * n + c] = abs(before[c] - 2.0 * here + later[c]) / (8.0 * near * near)
                largest[c] = max(largest[c], abs(here))
        for j in range(looks * n):
            i, c = j // n, j % n
            if found >= 0 or not bent[j] > faster * least * largest[c]:
                continue
            at = spread(i, looks, golden) * (count - 1)
            k = whole(at)
            share, h, own, v_own = at - k, min(t[k + 1] - t[k], mean), after(q, k * n_q), after(v, k * n_q)
            ahead(m, t[k], first, last, own, v_own, 0.0, x, start)
            ahead(m, t[k], first, last, own, v_own, h, x, end)
            slope = end[c] - start[c]
            left = abs(g[j] - start[c] - share * slope)
            most = max(least * largest[c], plain * min(abs(start[c]), abs(end[c])))
            if not (left > most and bent[j] > faster * left):
                continue
            gap_rates(m, t[k], own, v_own, G, other)
            size = abs(other[c] * t[k]) + size_of_product(G, own, c, n_q)
            # At rest near zero the coordinates are themselves rounding, of what forces that cancel make in a step
            if left > rounding * (size + h * h * pushed(m, t[k], own, v_own, after(G, c * n_q), force)):
                found = j
            for i_p in range(n_places):
                if found == j:
                    ahead(m, t[k], first, last, own, v_own, places[i_p] * h, x, other)
                    if not bent[j] > faster * abs(other[c] - start[c] - places[i_p] * slope):
                        found = -1
    return found


def pushed(m: Model, t: float, q: Doubles, v: Doubles, G: Doubles, work: Doubles) -> float:
    """Size of the acceleration of a gap by all forces, as if no coordinate moved another one."""
    n, size, M = m.n_q, 0.0, after(work, m.n_q)
    total_force(m, t, q, v, work)
    mass(m, t, q, v, M)
    for j in range(n):
        size += abs(G[j] * work[j] / M[j * n + j])
    return size


def spread(i: int, looks: int, golden: float) -> float:
    """Where the look i of so many lies, between 0 and 1: one in each part, at a place of its own."""
    part = i * golden
    return (i + (part - whole(part))) / (looks + 1)


def ahead(
    m: Model,
    t: float,
    first: float,
    last: float,
    q: Doubles,
    v: Doubles,
    length: float,
    x: Doubles,
    g: Doubles,
) -> None:
    """Every gap on the straight line from a state, so much later; its times stay within the run."""
    for j in range(m.n_q):
        x[j] = q[j] + length * v[j]
    gaps(m, min(max(t + length, first), last), x, v, g)
