"""Energy that single steps gain beyond what the forces give:

    T(end) - T(start) - W,      W = integral of P = v^T f + v^T M' v / 2  over the step

by Simpson's rule on the cubic through the states at both ends, whose middle is

    q = (q0 + q1)/2 - h (v1 - v0)/8,    v = 3 (q1 - q0)/(2 h) - (v0 + v1)/4.

Steps with an impact have no such path: there it is the straight line between both ends at constant speed. To forces
of a potential all paths are one; what damping takes along the true one is more, so that no gain is seen for nothing.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import mass, total_force
from lcpstep.kernels.model import Model
from lcpstep.pointers import Doubles, abs, after, max


@cython.ccall
def surplus(m: Model, t: Any, q: Any, v: Any, near: float, struck: bool) -> Any:
    """Of steps whose ends lie one after the other in t (2 n,), q, v (2 n, n_q): five numbers.

    The sum of what they gain (of `struck` ones, with impacts, which take energy, of those alone that gain) and the
    sum of |W|; the largest of T, of f^T M^-1 f / 2 and of q^T M q / 2, the last two with the diagonal of M alone:
    sizes, which tell rounding. near : step of the differences of M(t, q) [s], which is constant in struck steps
    """
    n, count, sums, space = m.n_q, len(t) // 2, np.zeros(5), np.zeros(m.n_q * m.n_q + 3 * m.n_q)
    at, x, rates, work, out = doubles(t), doubles(q), doubles(v), doubles(space), doubles(sums)
    middle, rate = after(work, n * n + n), after(work, n * n + 2 * n)
    with cython.nogil:
        for k in range(count):
            q0, q1 = after(x, 2 * k * n), after(x, (2 * k + 1) * n)
            v0, v1 = after(rates, 2 * k * n), after(rates, (2 * k + 1) * n)
            t0, t1 = at[2 * k], at[2 * k + 1]
            h = t1 - t0
            T0, T1 = kinetic(m, t0, q0, v0, work), kinetic(m, t1, q1, v1, work)
            for i in range(n):
                middle[i] = 0.5 * (q0[i] + q1[i]) - (0.0 if struck else 0.125 * h * (v1[i] - v0[i]))
                rate[i] = (q1[i] - q0[i]) / h
                if not struck:
                    rate[i] = 1.5 * rate[i] - 0.25 * (v0[i] + v1[i])
            if struck:
                v0 = v1 = rate
            P0, P1 = power(m, t0, q0, v0, near, work, out), power(m, t1, q1, v1, near, work, out)
            P = power(m, t0 + 0.5 * h, middle, rate, near, work, out)
            gain = T1 - T0 - h * (P0 + 4.0 * P + P1) / 6.0
            out[0] += max(gain, 0.0) if struck else gain
            out[1] += h * (abs(P0) + 4.0 * abs(P) + abs(P1)) / 6.0
            out[2] = max(out[2], max(T0, T1))
    return sums


def kinetic(m: Model, t: float, q: Doubles, v: Doubles, M: Doubles) -> float:
    """v^T M v / 2; M (n_q, n_q) is room for the matrix."""
    mass(m, t, q, v, M)
    total = 0.0
    for i in range(m.n_q):
        for j in range(m.n_q):
            total += 0.5 * M[i * m.n_q + j] * v[i] * v[j]
    return total


def power(m: Model, t: float, q: Doubles, v: Doubles, near: float, work: Doubles, out: Doubles) -> float:
    """v^T f + v^T M' v / 2, and sizes into out; work : the last M, room for a force and for a place near by."""
    n = m.n_q
    own = after(work, n * n)
    total_force(m, t, q, v, own)
    total, pushed, placed = 0.0, 0.0, 0.0
    for i in range(n):
        total += v[i] * own[i]
        pushed += 0.5 * own[i] * own[i] / work[i * n + i]
        placed += 0.5 * q[i] * q[i] * work[i * n + i]
    out[3], out[4] = max(out[3], pushed), max(out[4], placed)
    if m.mass.given:
        for i in range(n):
            own[i] = q[i] + near * v[i]
        total += kinetic(m, t + near, own, v, work) / (2.0 * near)
        for i in range(n):
            own[i] = q[i] - near * v[i]
        total -= kinetic(m, t - near, own, v, work) / (2.0 * near)
    return total
