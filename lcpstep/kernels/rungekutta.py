"""Steps of the Runge-Kutta method DOP853, their control and dense output, for any field.

Order 8, errors by orders 5 and 3, dense output of order 7; a class of fields inherits `RungeKutta`, with its `rates`.
Source: E. Hairer, S. Norsett, G. Wanner, Solving Ordinary Differential Equations I (Springer 1993), section II.10.
"""

from __future__ import annotations

from math import pow, sqrt

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.dop853 import (
    ALL,
    DENSE,
    ERROR_3,
    ERROR_5,
    EXTRA_STAGES,
    NEEDED,
    NEEDED_LATER,
    STAGES,
    TIMES,
    WEIGHTS,
    table,
)
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import DONE, NOT_FINITE, STEP_TOO_SMALL
from lcpstep.kernels.vectors import copy, finite
from lcpstep.pointers import Doubles, abs, after, inf, max, min

UNDERFLOW = 1e-200  # squares of errors below it have lost their digits
SAFETY, LEAST, MOST = 0.9, 0.2, 6.0  # of the change of step
# Steps refused within a stretch of the scan: the right-hand side has no derivatives that a step could resolve
HOPELESS, STRETCH = 2000, 1e-3
TOLERANCES = 3.0  # within which the dense output must be
LOOK, DEFECT = 0.7, 7.0  # where it is looked at, and what one sees there
UNLIKE = 0.01  # of the tolerance: what two evaluations at one state may differ by over a step
UNSEEN = 1e-3  # of the motion within a step: an error by which it is not resolved, however small it is
FALLS = 0.7  # an error that a shorter step has no less of, beside its length, is rounding
LATE = 1e4 * RESOLUTION  # of a time: what a field makes of its rounding is no motion, however short the step
FAR = 1e4  # scans from t = 0: what times are rounded by is no small part of a tolerance
SHORT = 1e-8  # of the scan: shorter steps resolve any motion
ROUNDINGS = 16.0  # of the state, in the error of a step
POLYNOMIALS = 7  # of the dense output, each a number for every component
COEFFICIENTS = np.concatenate([*table([*WEIGHTS, *DENSE, ERROR_3, ERROR_5]), TIMES])


class RungeKutta:
    """A step y' = f(t, y) from y to y_new: its stages, its dense output, and the control of its size.

    n, positions : numbers in y; the rates of the first `positions` are the following ones
    dense        whether `take_step` makes the dense output, and holds that of positions to the tolerance as well
    rtol, atol   tolerances
    y, y_new : (n,);  y_stage : (n,)   start and end of the step; work space, free between calls
    K : (16, n)   rates at the stages, and numbers beyond that may be read
    F : (7, n)    dense output
    length       of the step last completed
    next_step    the size to be tried next
    stage        whose rates are asked for
    evaluations  of the field
    state : (n,) array   y as Python sees it

    Parameters
    ----------
    n, positions, rtol, atol, dense   as above
    """

    def __init__(self, n: int, positions: int, rtol: float, atol: float, dense: bool = True) -> None:
        self.n, self.positions, self.dense, self.rtol, self.atol = n, positions, dense, rtol, atol
        self.length, self.evaluations, self.refused, self.stage = 0.0, 0, 0, 0
        self.next_step, self.stretch_end = inf, -inf
        self.tables = COEFFICIENTS, np.array(NEEDED, dtype=np.intp)
        self.A, self.needed = doubles(self.tables[0]), indices(self.tables[1])
        self.D = after(self.A, ALL * ALL)
        self.E3 = after(self.D, len(DENSE) * ALL)
        self.E5 = after(self.E3, ALL)
        self.C = after(self.E5, ALL)
        self.state, self.numbers = np.zeros(n), np.zeros((3 + ALL + POLYNOMIALS, n))
        self.y = doubles(self.state)
        self.y_new = doubles(self.numbers)
        self.y_stage = after(self.y_new, n)
        self.first = after(self.y_stage, n)
        self.K = after(self.first, n)
        self.F = after(self.K, ALL * n)

    def rates(self, t: float, y: Doubles, dy: Doubles) -> bool:
        """Dy = f(t, y); False where it is not finite or cannot be evaluated. Every field has its own."""
        return False

    def rate_terms(self) -> float:
        """Size of terms that may cancel in the rates last asked for; a field may have its own."""
        return 0.0

    def begin(self, next_step: float) -> None:
        """Another motion begins, with a step of this size."""
        self.next_step, self.stretch_end = next_step, -inf
        self.length, self.evaluations, self.refused = 0.0, 0, 0

    def take_step(self, t: float, longest: float, scan: float) -> int:
        """Step from t no longer than `longest` that meets the tolerance, of size `length`; a status.

        scan : the longest step that makes sense
        """
        h = min(self.next_step, longest)
        truncated, again, before = h < self.next_step, False, inf
        while True:
            h = (t + h) - t if abs(t) > FAR * scan and 0.0 < (t + h) - t < longest else h
            good = self.step(t, h)
            self.evaluations += STAGES + 1
            if good and again and not self.repeats(h):
                return STEP_TOO_SMALL
            error = self.error_norm(h) if good else inf
            if error <= 1.0 and self.dense:
                if not self.complete(t, h):
                    return NOT_FINITE
                self.evaluations += EXTRA_STAGES
                error = max(error, self.dense_error(h))
            if error <= 1.0:
                share = self.unresolved(h, error)
                if share <= 1.0 or error > FALLS * before * h or h < max(SHORT * scan, LATE * abs(t)):
                    error = max(error, share) if share <= 1.0 else error
                    break
                before, error = error / h, share
            known, truncated, again = error < inf, False, good  # a shorter step may reach what is finite
            h *= max(LEAST, factor(error)) if known else LEAST
            if not self.refuse(t, scan) or h <= 4.0 * RESOLUTION * max(abs(t), scan):
                return STEP_TOO_SMALL if good and known else NOT_FINITE
        self.next_step = max(h * factor(error), self.next_step if truncated else 0.0)
        self.length = h
        return DONE

    def step(self, t: float, h: float) -> bool:
        """A step of size h from y at t to y_new; False where it is not finite."""
        n, self.stage = self.n, 0
        if not self.rates(t, self.y, self.K):
            return False
        if not self.stages(t, h, 1, STAGES):
            return False
        self.combine(h, STAGES)
        copy(self.y_new, self.y_stage, n)
        self.stage = STAGES
        return self.rates(t + h, self.y_new, after(self.K, STAGES * n)) and finite(self.y_new, n)

    def meet(self, t: float, tau: float, most: float, far: float, tries: int) -> float:
        """The length of a step from t that ends at an event, which is near tau and no later than `most`.

        The step is made again, longer by what `miss` says of its own end, until that is no better known, or farther
        off than `far`, as where another one is met. What is returned is the length of the step made last.
        """
        self.step(t, tau)
        for _ in range(tries):
            longer = self.miss(t, tau)
            new = min(max(tau + longer, 0.0), most)
            if new == tau or not abs(longer) <= far:
                break
            tau = new
            self.step(t, tau)
        return tau

    def miss(self, t: float, tau: float) -> float:
        """How much longer the step just made from t should have been to end at the event; 0 where it does.

        Whoever calls `meet` has its own.
        """
        return 0.0

    def complete(self, t: float, h: float) -> bool:
        """Dense output of the step that `step` has just made; False where it is not finite."""
        if not self.stages(t, h, STAGES + 1, ALL):
            return False
        self.interpolant(h)
        self.length = h
        return True

    def stages(self, t: float, h: float, first: int, end: int) -> bool:
        """Stages first .. end - 1 of a step."""
        for stage in range(first, end):
            self.combine(h, stage)
            self.stage = stage
            if not self.rates(t + self.C[stage] * h, self.y_stage, after(self.K, stage * self.n)):
                return False
        return True

    def combine(self, h: float, stage: int) -> None:
        """y_stage = y + h sum_j A[stage, j] K[j]."""
        n, A, first = self.n, after(self.A, stage * ALL), self.needed[stage]
        for i in range(0, n - 1, 2):
            a, b = weigh(A, after(self.K, i), n, first, stage)
            self.y_stage[i], self.y_stage[i + 1] = self.y[i] + h * a, self.y[i + 1] + h * b
        if n % 2 == 1:
            a, b = weigh(A, after(self.K, n - 1), n, first, stage)
            self.y_stage[n - 1] = self.y[n - 1] + h * a

    def error_norm(self, h: float) -> float:
        """Estimated error of y_new over the tolerance; the step is good where it is not above one."""
        n, K, E3, E5 = self.n, self.K, self.E3, self.E5
        err5, err3 = 0.0, 0.0
        for i in range(n):
            scale = self.atol + self.rtol * max(abs(self.y[i]), abs(self.y_new[i]))
            e5, e3 = E5[0] * K[i], E3[0] * K[i]
            for j in range(NEEDED_LATER, STAGES + 1):
                e5 += E5[j] * K[j * n + i]
                e3 += E3[j] * K[j * n + i]
            err5 += (e5 / scale) * (e5 / scale)
            err3 += (e3 / scale) * (e3 / scale)
        if err5 + 0.01 * err3 <= UNDERFLOW:
            return 0.0
        return abs(h) * err5 / sqrt((err5 + 0.01 * err3) * n)

    def unresolved(self, h: float, error: float) -> float:
        """An error of the step, over the tolerance, as a share of what a step may have that resolves the motion.

        Below the tolerance one longer than the periods of a motion makes it grow; rounding of state or rates is none.
        """
        K, moved, numbers = self.K, 0.0, h * self.rate_terms() / self.atol
        for i in range(self.n):
            y = max(abs(self.y[i]), abs(self.y_new[i]))
            scale = self.atol + self.rtol * y
            moved = max(moved, max(abs(K[i]), abs(K[STAGES * self.n + i])) / scale)
            numbers = max(numbers, y / scale)
        allowed = max(UNSEEN * h * moved, ROUNDINGS * RESOLUTION * numbers)
        return error / allowed if allowed > 0.0 else 0.0

    def refuse(self, t: float, scan: float) -> bool:
        """Take note of a step from t that is refused; False where so many are that shorter ones will not help."""
        if not self.stretch_end - STRETCH * scan <= t <= self.stretch_end:
            self.refused, self.stretch_end = 0, t + STRETCH * scan
        self.refused += 1
        copy(self.first, self.K, self.n)
        return self.refused <= HOPELESS

    def repeats(self, h: float) -> bool:
        """Whether the first stage, evaluated again after a refused step, is the same as far as one can tell."""
        for i in range(self.n):
            unlike = abs(h * (self.K[i] - self.first[i]))
            if not unlike <= UNLIKE * (self.atol + self.rtol * abs(self.y[i])):
                return False
        return True

    def interpolant(self, h: float) -> None:
        """Dense output of the step, into F; needs all stages."""
        n, K, F = self.n, self.K, self.F
        for i in range(n):
            delta = self.y_new[i] - self.y[i]
            F[i] = delta
            F[n + i] = h * K[i] - delta
            F[2 * n + i] = 2.0 * delta - h * (K[STAGES * n + i] + K[i])
        for k in range(4):
            D, later = after(self.D, k * ALL), after(F, (3 + k) * n)
            for i in range(0, n - 1, 2):
                a, b = weigh(D, after(K, i), n, NEEDED_LATER, ALL)
                later[i], later[i + 1] = h * a, h * b
            if n % 2 == 1:
                a, b = weigh(D, after(K, n - 1), n, NEEDED_LATER, ALL)
                later[n - 1] = h * a

    def dense_error(self, h: float) -> float:
        """Estimated error of the dense output of positions over TOLERANCES tolerances.

        The derivative of a position's polynomial and its rate's polynomial part by an error whose shape over the step
        is always the same: its largest value over that at the place LOOK is DEFECT. No evaluation is needed.
        """
        n, m, F, worst = self.n, self.positions, self.F, 0.0
        for i in range(m):
            value, slope, speed = 0.0, 0.0, 0.0
            for k in range(POLYNOMIALS):
                value += F[(6 - k) * n + i]
                speed += F[(6 - k) * n + m + i]
                x, dx = (LOOK, 1.0) if k % 2 == 0 else (1.0 - LOOK, -1.0)
                slope = slope * x + value * dx
                value *= x
                speed *= x
            defect = abs(slope - h * (self.y[m + i] + speed))
            worst = max(worst, defect / (self.atol + self.rtol * max(abs(self.y[i]), abs(self.y_new[i]))))
        return worst / (DEFECT * TOLERANCES)

    def at(self, x: float, out: Doubles) -> None:
        """State at the fraction x of the step, by its dense output."""
        n, F, z = self.n, self.F, 1.0 - x
        for i in range(n):
            late = F[3 * n + i] + x * (F[4 * n + i] + z * (F[5 * n + i] + x * F[6 * n + i]))
            out[i] = self.y[i] + x * (F[i] + z * (F[n + i] + x * (F[2 * n + i] + z * late)))


def weigh(w: Doubles, K: Doubles, n: int, first: int, end: int) -> tuple[float, float]:
    """Weighted sums of the rates of two components side by side: of the start, and of the stages first .. end - 1."""
    a, b = w[0] * K[0], w[0] * K[1]
    for j in range(first, end):
        a += w[j] * K[j * n]
        b += w[j] * K[j * n + 1]
    return a, b


def factor(error: float) -> float:
    """By how much to change the step after an error of this size."""
    if error == 0.0:
        return MOST
    return min(MOST, max(LEAST, SAFETY * pow(error, -0.125)))
