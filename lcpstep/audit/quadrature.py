"""Where forces along pieces of the computed motion lead, by quadrature, as kernels: see `missed`."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, small_numbers
from lcpstep.kernels.acceleration import free_acceleration
from lcpstep.kernels.model import Model
from lcpstep.pointers import Doubles, abs, after, max, nan


@cython.ccall
def errors(
    m: Model, t: Any, B: Any, v: Any, jumps: Any, weights: Any, nodes: Any, noise: float, place: Any, speed: Any,
    within: Any,
) -> None:  # fmt: skip
    """What free pieces err by in position and velocity, and in between, (m, n_q) each; called from Python.

    Parameters
    ----------
    t : (m + 1,);  B : (m, degree + 1, n_q)   Bernstein's coefficients;  v : (m + 1, n_q)
    jumps : (m + 1,) uint8   states at which the velocity may have jumped
    weights : (3, 3, degree + 1)   of every node: of the coefficients in q, h v and h^2 a
    nodes : (2, 3)   places of the nodes, and weights of the quadrature
    noise : of the positions: what h^2 a may be off by
    """
    n, width, n_q = len(place), B.shape[1], B.shape[2]
    space = np.zeros((m.n_q + 7) * m.n_q)
    times, control, speeds, jump = doubles(t), doubles(B), doubles(v), small_numbers(jumps)
    x, rule, work = doubles(weights), doubles(nodes), doubles(space)
    one, two, off = doubles(place), doubles(speed), doubles(within)
    with cython.nogil:
        for k in range(n):
            h, i = times[k + 1] - times[k], k * n_q
            if not h > 0.0:
                continue
            b = after(control, k * width * n_q)
            lead(m, times[k], h, b, width, x, rule, noise, work, after(one, i), after(two, i), after(off, i))
            for j in range(n_q):
                start = speeds[i + j]
                one[i + j] = abs(b[(width - 1) * n_q + j] - b[j] - h * (start + one[i + j]))
                two[i + j] = abs(speeds[i + n_q + j] - start - two[i + j]) if jump[k + 1] == 0 else 0.0


def lead(
    m: Model, t: float, h: float, b: Doubles, width: int, x: Doubles, rule: Doubles, noise: float, work: Doubles,
    place: Doubles, speed: Doubles, within: Doubles,
) -> None:  # fmt: skip
    """h int (1 - s) f, h int f, and h^2 / 8 of the largest f - p'' of one piece, (n_q,) each, which begin at zero."""
    n = m.n_q
    q, v, a, f, space = work, after(work, n), after(work, 2 * n), after(work, 3 * n), after(work, 4 * n)
    for node in range(3):
        for j in range(n):
            q[j] = v[j] = a[j] = size = 0.0
            for i in range(width):
                c = b[i * n + j]
                q[j] += x[(3 * node) * width + i] * c
                v[j] += x[(3 * node + 1) * width + i] * c
                a[j] += x[(3 * node + 2) * width + i] * c
                size = max(size, abs(c))
            v[j], a[j] = v[j] / h, a[j] / (h * h)
            space[j] = noise * size / (h * h)
        good = free_acceleration(m, t + h * rule[node], q, v, after(space, 2 * n), after(space, n), f)
        for j in range(n):
            force = f[j] if good else nan
            place[j] += h * rule[3 + node] * (1.0 - rule[node]) * force
            speed[j] += h * rule[3 + node] * force
            within[j] = max(within[j], 0.125 * h * h * (abs(force - a[j]) - space[j]))
