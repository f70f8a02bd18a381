"""Whether the steps of a finished run are short enough for the forces that it has met.

    (h omega)^2 = h^2 |v^T (f(q + e v) - f(q - e v))| / (2 e v^T M v) <= 4

The quotient of Rayleigh along the motion is never above the highest frequency there, so what exceeds the bound of
velocity Verlet (of Runge-Kutta's steps 2.8^2) exceeds it for certain: explicit steps gain energy then, and implicit
ones skip what the motion does. Steps by a tolerance are not asked; those that take linear forces implicitly are
asked for the oscillations that these carry (`periods.py`). What passes is asked for the balance of its energy too
(`balance.py`).
Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section I.5.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from lcpstep.callbacks.faults import cause, forget
from lcpstep.doubts.balance import unbalanced
from lcpstep.doubts.depth import fixed_step
from lcpstep.doubts.periods import overleapt
from lcpstep.trajectory import Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.kernels.model import Model

LOOKS = 8  # states that are looked at
NEAR = 1.0 / 64.0  # of a step: of the differences
VERLET, RUNGE_KUTTA = 2.0, 2.8  # highest frequency times h


def unresolved(run: Trajectory) -> str:
    """Where a step is too long for the forces, in words; "" where none is that was looked at."""
    implicit = overleapt(run)
    if implicit is not None:
        return implicit
    h, bound = _explicit(run)
    if h == 0.0 or run.status != Status.DONE or len(run.t) == 0:
        return ""
    # Not before it is asked for: that loads what compiles callbacks
    from lcpstep.kernels.looks import highest
    from lcpstep.model import looked_at

    m = looked_at(run.scene)
    square = highest(m, run.t, run.q, run.v, LOOKS, NEAR * h)
    cause()  # a callback that fails beside the motion, where the run has not asked it
    forget()
    words = _too_fast(run, m, h, bound) if h * math.sqrt(square) > bound else ""
    words = words or unbalanced(run, m, h)
    cause()
    forget()
    return words


def _too_fast(run: Trajectory, m: Model, h: float, bound: float) -> str:
    """At which of the states that were looked at the forces change too fast, in words."""
    from lcpstep.kernels.states import power

    last = len(run.t) - 1
    k = np.unique(((np.arange(LOOKS) + 1) * (last / LOOKS)).astype(int))
    t, q, v, near = run.t[k], run.q[k], run.v[k], NEAR * h
    with np.errstate(all="ignore"):
        kinetic, after = power(m, t, q + near * v, v)
        _, before = power(m, t, q - near * v, v)
        angle = h * np.sqrt(np.abs(after - before) / (4.0 * near * kinetic))
    told = np.flatnonzero(angle > bound)
    if not len(told):
        return ""
    i = told[0]
    return (
        f"the forces along the motion change too fast for its steps at t = {t[i]:.9g} s, "
        f"with the frequency {angle[i] / h:.3g} rad/s, which needs steps below {bound / angle[i] * h:.3g} s"
    )


def _explicit(run: Trajectory) -> tuple[float, float]:
    """The step h, or 0 where forces cannot change too fast for the method, and the bound of h omega."""
    order = getattr(run.method, "order", None)
    h = 0.0 if order == "exact" else fixed_step(run.method)
    return h, RUNGE_KUTTA if order == 4 else VERLET
