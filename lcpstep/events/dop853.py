"""One step of the Runge-Kutta method DOP853 with dense output, as a kernel.

Order 8 with error estimates of orders 5 and 3 and a dense output of order 7. Source: E. Hairer, S. Norsett,
G. Wanner, Solving Ordinary Differential Equations I (Springer 1993), section II.10; the coefficients are those
that `scipy.integrate.DOP853` publishes.
"""

from __future__ import annotations

import functools
import math
from typing import Any, NamedTuple

import numpy as np

from lcpstep.compiled import by_address

STAGES = 12
EXTRA_STAGES = 3  # of the dense output
UNDERFLOW = 1e-200  # squares of errors below it have lost their digits
SAFETY, LEAST, MOST = 0.9, 0.2, 6.0  # of the change of step
# Steps refused within a stretch of the scan: the right-hand side has no derivatives that a step could resolve
HOPELESS, STRETCH = 2000, 1e-3
DENSE = 3.0  # tolerances within which the dense output must be
LOOK, DEFECT = 0.7, 7.0  # where it is looked at, and what one sees there
UNLIKE = 0.01  # of the tolerance: what two evaluations at one state may differ by over a step
REFUSED, STRETCH_END = range(2)


@by_address
class Tableau(NamedTuple):
    """Coefficients; A covers the stages of the step, its last one and the extra ones of the dense output."""

    A: Any  # (16, 16)
    B: Any  # (12,)
    C: Any  # (16,)
    E3: Any  # (13,)
    E5: Any  # (13,)
    D: Any  # (4, 16)


@by_address
class Work(NamedTuple):
    """Stages of a step from y to y_new, m = len(y), and its dense output."""

    K: Any  # (16, m)
    y: Any  # (m,)
    y_new: Any  # (m,)
    y_stage: Any  # (m,)
    F: Any  # (7, m) dense output
    first: Any  # (m,) the first stage of the last attempt
    control: Any  # (2,) steps refused; the time up to which they are counted
    tab: Any  # the coefficients


@functools.cache
def tableau() -> Tableau:
    """The coefficients, from SciPy."""
    from scipy.integrate import DOP853

    A = np.zeros((16, 16))
    A[:STAGES, :STAGES] = DOP853.A
    A[STAGES, :STAGES] = DOP853.B
    A[STAGES + 1 :] = DOP853.A_EXTRA
    C = np.concatenate([DOP853.C, [1.0], DOP853.C_EXTRA])
    return Tableau(
        *(np.ascontiguousarray(x, dtype=float) for x in (A, DOP853.B, C, DOP853.E3, DOP853.E5, DOP853.D))
    )


def work(m: int) -> Work:
    """Work space for m equations."""
    vectors = np.zeros((4, m))
    return Work(
        K=np.zeros((16, m)), y=vectors[0], y_new=vectors[1], y_stage=vectors[2], F=np.zeros((7, m)),
        first=vectors[3], control=np.array([0.0, -math.inf]), tab=tableau(),
    )  # fmt: skip


def combine(w: Any, h: float, stage: int) -> None:
    """y_stage = y + h sum_j A[stage, j] K[j]."""
    for i in range(len(w.y)):
        total = 0.0
        for j in range(stage):
            total += w.tab.A[stage, j] * w.K[j, i]
        w.y_stage[i] = w.y[i] + h * total


def error_norm(w: Any, h: float, rtol: float, atol: float) -> float:
    """Estimated error of y_new over the tolerance; the step is good below one."""
    m = len(w.y)
    err5 = err3 = 0.0
    for i in range(m):
        scale = atol + rtol * max(abs(w.y[i]), abs(w.y_new[i]))
        e5 = e3 = 0.0
        for j in range(STAGES + 1):
            e5 += w.tab.E5[j] * w.K[j, i]
            e3 += w.tab.E3[j] * w.K[j, i]
        err5 += (e5 / scale) ** 2
        err3 += (e3 / scale) ** 2
    if err5 + 0.01 * err3 <= UNDERFLOW:
        return 0.0
    return abs(h) * err5 / math.sqrt((err5 + 0.01 * err3) * m)


def factor(error: float) -> float:
    """By how much to change the step after an error of this size."""
    if error == 0.0:
        return MOST
    return min(MOST, max(LEAST, SAFETY * error ** (-0.125)))


def refuse(w: Any, t: float, scan: float) -> bool:
    """Take note of a step from t that is refused; False where so many are that shorter ones will not help."""
    if not w.control[STRETCH_END] - STRETCH * scan <= t <= w.control[STRETCH_END]:
        w.control[REFUSED], w.control[STRETCH_END] = 0.0, t + STRETCH * scan
    w.control[REFUSED] += 1.0
    for i in range(len(w.first)):
        w.first[i] = w.K[0, i]
    return bool(w.control[REFUSED] <= HOPELESS)


def repeats(w: Any, h: float, rtol: float, atol: float) -> bool:
    """Whether the first stage, evaluated again after a refused step, is the same as far as the tolerance can tell."""
    same = True
    for i in range(len(w.first)):
        same = same and abs(h * (w.K[0, i] - w.first[i])) <= UNLIKE * (atol + rtol * abs(w.y[i]))
    return same


def interpolant(w: Any, h: float) -> None:
    """Dense output of the step, into F; needs all 16 stages."""
    for i in range(len(w.y)):
        delta = w.y_new[i] - w.y[i]
        w.F[0, i] = delta
        w.F[1, i] = h * w.K[0, i] - delta
        w.F[2, i] = 2.0 * delta - h * (w.K[STAGES, i] + w.K[0, i])
        for k in range(4):
            total = 0.0
            for j in range(16):
                total += w.tab.D[k, j] * w.K[j, i]
            w.F[3 + k, i] = h * total


def dense_error(w: Any, h: float, rtol: float, atol: float) -> float:
    """Estimated error of the dense output of positions over DENSE tolerances, where y = (q, v) and q' = v.

    The derivative of q's polynomial and v's polynomial part by an error whose shape over the step is always the same:
    its largest value over that at the place LOOK is DEFECT. No evaluation is needed.
    """
    n, worst = len(w.y) // 2, 0.0
    for i in range(n):
        value = slope = speed = 0.0
        for k in range(7):
            value += w.F[6 - k, i]
            speed += w.F[6 - k, n + i]
            x, dx = (LOOK, 1.0) if k % 2 == 0 else (1.0 - LOOK, -1.0)
            slope = slope * x + value * dx
            value *= x
            speed *= x
        defect = abs(slope - h * (w.y[n + i] + speed))
        worst = max(worst, defect / (atol + rtol * max(abs(w.y[i]), abs(w.y_new[i]))))
    return worst / (DEFECT * DENSE)


def interpolate(F: Any, y: Any, x: float, out: Any) -> None:
    """State at the fraction x of a step from y, by its dense output."""
    for i in range(len(out)):
        total = 0.0
        for k in range(7):
            total += F[6 - k, i]
            total *= x if k % 2 == 0 else 1.0 - x
        out[i] = y[i] + total
