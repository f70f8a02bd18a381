"""How far what is pressed turns within steps of a finished run; see `lcpstep.doubts.turned`.

The steps are divided into so many parts, one after the other, and the fastest that fits is looked at of each.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.acceleration import factor_mass
from lcpstep.kernels.dynamics import gap_rates
from lcpstep.kernels.linear import solve_definite
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy, product
from lcpstep.pointers import Doubles, after


@cython.ccall
def farthest_turn(
    m: Model, t: Any, q: Any, v: Any, impulse: Any, held: Any, longest: float, parts: int
) -> Any:
    """Which row turns farthest in steps no longer than that at both of whose ends it is pressed, and where.

    impulse : (n, n_c)   of every row since the state before; None where all are pressed always, as joints are
    held : (n, n_c)   the same without that of rows which were open until then; of no use without impulses

    Returns
    -------
    cosine of the angle, the number of the state before the step, and the row; 1, 0 and 0 where there is none
    """
    n, steps, always, found = m.n_q, len(t) - 1, impulse is None, np.array([1.0, 0.0, 0.0])
    space = np.zeros((2 * m.n_q + 1) * m.n_c + (m.n_q + 1) * m.n_q)
    at, x, rates, work, out = doubles(t), doubles(q), doubles(v), doubles(space), doubles(found)
    pushed, kept = (work, work) if always else (doubles(impulse), doubles(held))
    with cython.nogil:
        for i in range(parts):
            fastest, best, x_t = -1.0, -1, after(rates, i * steps // parts * n)
            speed = product(x_t, x_t, 0, n)
            for k in range(i * steps // parts, (i + 1) * steps // parts):
                x_t, before = after(rates, (k + 1) * n), speed
                speed = product(x_t, x_t, 0, n)
                if before + speed > fastest and 0.0 < at[k + 1] - at[k] <= longest:
                    for c in range(m.n_c):
                        if always or pressed(pushed, kept, k * m.n_c + c, m.n_c):
                            fastest, best = before + speed, k
            if best >= 0:
                look(m, best, at, x, rates, pushed, kept, always, work, out)
    return found


def pressed(impulse: Doubles, held: Doubles, i: int, n_c: int) -> bool:
    """Whether a row presses at both ends of a step; i : of its impulse at the start."""
    return impulse[i] > 0.0 and held[i + n_c] > 0.0


def look(
    m: Model,
    k: int,
    t: Doubles,
    q: Doubles,
    v: Doubles,
    impulse: Doubles,
    held: Doubles,
    always: bool,
    work: Doubles,
    out: Doubles,
) -> None:
    """The step after the state k, into `out` where a row turns farther in it than in those before."""
    n, n_c, x, x_t = m.n_q, m.n_c, after(q, k * m.n_q), after(v, k * m.n_q)
    start, end, M = work, after(work, n_c * n), after(work, 2 * n_c * n)
    y, rates = after(M, n * n), after(M, n * n + n)
    gap_rates(m, t[k], x, x_t, start, rates)
    gap_rates(m, t[k + 1], after(x, n), after(x_t, n), end, rates)
    if not factor_mass(m, t[k], x, x_t, M):
        return
    for c in range(n_c):
        if always or pressed(impulse, held, k * n_c + c, n_c):
            before, later = after(start, c * n), after(end, c * n)
            size = sqrt(form(m, M, y, before, before)) * sqrt(form(m, M, y, later, later))
            along = form(m, M, y, before, later)
            if along < out[0] * size:
                out[0], out[1], out[2] = along / size, k, c


def form(m: Model, M: Doubles, y: Doubles, a: Doubles, b: Doubles) -> float:
    """A M^-1 b, with few terms where a has few; M: factor of a mass matrix that changes, y (n_q,): work space."""
    total = 0.0
    if m.mass.given:
        copy(y, b, m.n_q)
        solve_definite(M, y, m.n_q)
        return product(a, y, 0, m.n_q)
    for i in range(m.n_q):
        if a[i] != 0.0:
            total += a[i] * product(m.M_inverse, b, i, m.n_q)
    return total
