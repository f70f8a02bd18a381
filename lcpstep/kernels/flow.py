"""A smooth motion from one time to another, by steps of Runge-Kutta, as a kernel."""

from __future__ import annotations

import cython

from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.status import DONE
from lcpstep.kernels.vectors import copy


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
