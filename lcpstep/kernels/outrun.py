"""The kinetic energy that a step of a finished run may have by its start, forces and obstacles: `doubts.outrun`.

The steps are divided into so many parts, one after the other, and the one in which the velocities grow most is looked
at of each.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import gap_rates, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles, abs, after, max


@cython.ccall
def steepest(m: Model, t: Any, q: Any, v: Any, impulse: Any, longest: float, parts: int) -> Any:
    """Of steps no longer than that the one whose energy is the largest multiple of what it may be; masses constant.

    impulse : (n, n_c)   of every contact since the state before

    Returns
    -------
    energy at its end over what it may be, the number of the state before it, and the energies at both its ends
    """
    n, steps, space, found = m.n_q, len(t) - 1, np.zeros(m.n_c * (m.n_q + 2) + 3 * m.n_q), np.zeros(4)
    at, x, rates, pushes = doubles(t), doubles(q), doubles(v), doubles(impulse)
    work, out = doubles(space), doubles(found)
    with cython.nogil:
        fastest, top = 0.0, 0  # up to the state at hand
        for i in range(parts):
            most, best, until, x_t = 0.0, -1, 0, after(rates, i * steps // parts * n)
            speed = product(x_t, x_t, 0, n)
            for k in range(i * steps // parts, (i + 1) * steps // parts):
                if speed > fastest:
                    fastest, top = speed, k
                x_t, before = after(rates, (k + 1) * n), speed
                speed = product(x_t, x_t, 0, n)
                if not speed - before <= most and 0.0 < at[k + 1] - at[k] <= longest:
                    most, best, until = speed - before, k, top
            if best >= 0:
                rounding = NOISE * sqrt(form(m.M, after(rates, until * n), n))
                weigh(m, best, at, x, rates, pushes, rounding, work, out)
    return found


def weigh(
    m: Model,
    k: int,
    t: Doubles,
    q: Doubles,
    v: Doubles,
    impulse: Doubles,
    rounding: float,
    work: Doubles,
    out: Doubles,
) -> None:
    """The step after the state k, into `out` where its energy is a larger multiple of what it may be than before.

    rounding : speed sqrt(v^T M v) that is none beside the fastest until then, as of what an impact brought to rest
    """
    n, n_c, h, strongest, pushed = m.n_q, m.n_c, t[k + 1] - t[k], 0.0, 0.0
    G, rate, fastest = work, after(work, n_c * n), after(work, n_c * n + n_c)
    x, f = after(work, n_c * (n + 2)), after(work, n_c * (n + 2) + 2 * n)
    x_t = after(x, n)
    for c in range(n_c):
        fastest[c] = 0.0
    for i in range(3):
        share = 0.5 * i
        for j in range(n):
            x[j] = (1.0 - share) * q[k * n + j] + share * q[(k + 1) * n + j]
            x_t[j] = (1.0 - share) * v[k * n + j] + share * v[(k + 1) * n + j]
        total_force(m, t[k] + share * h, x, x_t, f)
        strongest = max(strongest, form(m.M_inverse, f, n))
        gap_rates(m, t[k] + share * h, x, x_t, G, rate)
        for c in range(n_c):
            fastest[c] = max(fastest[c], abs(rate[c]))
    for c in range(n_c):
        pushed += abs(impulse[(k + 1) * n_c + c]) * fastest[c]
    start, end = 0.5 * form(m.M, after(v, k * n), n), 0.5 * form(m.M, after(v, (k + 1) * n), n)
    speed = sqrt(2.0 * start) + h * sqrt(strongest) + rounding
    allowed = 0.5 * speed * speed + pushed
    if not end <= out[0] * allowed:
        out[0], out[1], out[2], out[3] = end / allowed, k, start, end


def form(A: Doubles, x: Doubles, n: int) -> float:
    """x^T A x."""
    total = 0.0
    for i in range(n):
        total += x[i] * product(A, x, i, n)
    return total
