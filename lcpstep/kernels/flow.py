"""A smooth motion from one time to another, by steps of Runge-Kutta, and the rates of its derivative, as kernels."""

from __future__ import annotations

import cython

from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.status import DONE
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import Doubles


def follow(s: RungeKutta, a: float, b: float) -> int:
    """Steps from the state y at a to that at b; a status."""
    t, span = a, b - a
    s.begin(span)
    while t < b:
        code = s.take_step(t, b - t, span)
        if code != DONE:
            return code
        t = b if s.length >= b - t else t + s.length
        copy(s.y, s.y_new, s.n)
    return DONE


def derivative_rates(F_x: Doubles, J: Doubles, out: Doubles, n: int) -> None:
    """Rates F_x J, (n, n), of the derivative J by the initial state."""
    for i in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += F_x[i * n + k] * J[k * n + j]
            out[i * n + j] = total
