"""First root of a guard within a step, none missed, as kernels: sign changes of Bernstein coefficients.

A guard along the dense output is a polynomial in the fraction s of the step (of degree 7 for a linear guard), or as
near to one as the step is cut into parts. In Bernstein form, coefficients without a sign change have no root between
them, and one sign change is exactly one root; otherwise the interval is halved (de Casteljau). So roots that come in
pairs inside a step are found, too. Source: T. Sederberg, Computer Aided Geometric Design, chapter 9; G. Farin,
Curves and Surfaces for CAGD (Morgan Kaufmann 2002), section 5.3.
"""

from __future__ import annotations

import math
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.bracket import Bracket
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import Doubles, abs, after, max

DEGREE = 9
DEPTH = 42  # halvings at most
NONE = -1.0  # in place of a root
CHECKS = 2  # further samples, which say whether the polynomial is the guard
SAMPLES = DEGREE + 1 + CHECKS


def bernstein(s: Any) -> Any:
    """The Bernstein polynomials at the points s, a column each."""
    basis = [math.comb(DEGREE, j) for j in range(DEGREE + 1)]
    return np.stack([b * s**j * (1.0 - s) ** (DEGREE - j) for j, b in enumerate(basis)], axis=1)


NODES = 0.5 - 0.5 * np.cos(np.pi * np.arange(DEGREE + 1) / DEGREE)
AT_CHECKS = np.array([0.3819, 0.8137])
FROM_NODES, FROM_CHECKS = np.linalg.inv(bernstein(NODES)), bernstein(AT_CHECKS)


class Scan:
    """Sample points, conversion to Bernstein form, and work space; N = DEGREE + 1.

    points, sample : (N + CHECKS,)   where the guard is sampled, in [0, 1]; its values there
    to_bernstein : (N, N);  at_checks : (CHECKS, N)
    c, half : (N,)   Bernstein coefficients of the guard; work space
    bracket          in which a single root is sought
    stack : (DEPTH + 3, N);  low, high : (DEPTH + 3,)   polynomials on parts of the interval, and their ends
    """

    def __init__(self) -> None:
        n = DEGREE + 1
        self.bracket = Bracket()
        self.arrays = [
            np.concatenate([NODES, AT_CHECKS]),
            np.ascontiguousarray(FROM_NODES),
            np.ascontiguousarray(FROM_CHECKS),
            np.zeros(n + CHECKS),
            np.zeros((2, n)),
            np.zeros((DEPTH + 3, n + 2)),
        ]
        self.points, self.to_bernstein = doubles(self.arrays[0]), doubles(self.arrays[1])
        self.at_checks, self.sample = doubles(self.arrays[2]), doubles(self.arrays[3])
        self.c, self.stack = doubles(self.arrays[4]), doubles(self.arrays[5])
        self.half, self.low = after(self.c, n), after(self.stack, (DEPTH + 3) * n)
        self.high = after(self.low, DEPTH + 3)


def convert(scan: Scan) -> float:
    """Bernstein coefficients of the samples; how far the polynomial is from the further samples."""
    n = DEGREE + 1
    for j in range(n):
        scan.c[j] = 0.0
        for i in range(n):
            scan.c[j] += scan.to_bernstein[j * n + i] * scan.sample[i]
    worst = 0.0
    for k in range(CHECKS):
        value = 0.0
        for j in range(n):
            value += scan.at_checks[k * n + j] * scan.c[j]
        worst = max(worst, abs(value - scan.sample[n + k]))
    return worst


def taylor(d: Doubles, s: float, work: Doubles) -> tuple[float, float, float]:
    """Value, first and second derivative of a polynomial in Bernstein form."""
    copy(work, d, DEGREE + 1)
    n, slope, curvature = DEGREE, 0.0, 0.0
    for i in range(n):
        if i == n - 2:
            curvature = n * (n - 1) * (work[2] - 2.0 * work[1] + work[0])
        if i == n - 1:
            slope = n * (work[1] - work[0])
        for j in range(n - i):
            work[j] = (1.0 - s) * work[j] + s * work[j + 1]
    return work[0], slope, curvature


def first_rise(scan: Scan, sign: float, level: float, start: float) -> float:
    """First s in (start, 1] where sign times the polynomial rises through the level, or NONE."""
    n = DEGREE + 1
    for j in range(n):
        scan.stack[j] = sign * scan.c[j] - level
    scan.low[0], scan.high[0] = 0.0, 1.0
    top = 1
    while top > 0:
        top -= 1
        d, a, b = after(scan.stack, top * n), scan.low[top], scan.high[top]
        if b <= start:
            continue
        changes = 0
        for j in range(DEGREE):
            changes += (d[j] < 0.0) != (d[j + 1] < 0.0)
        if changes == 0 or (changes == 1 and d[0] >= 0.0):
            continue
        if changes == 1:
            s = a + (b - a) * single_root(scan.bracket, d, scan.half)
            if s > start:
                return s
            continue
        if top >= DEPTH:
            if d[0] < 0.0 <= d[DEGREE]:
                return b
            continue
        left = after(scan.stack, (top + 1) * n)
        for i in range(n):
            left[i] = d[0]
            for j in range(DEGREE - i):
                d[j] = 0.5 * (d[j] + d[j + 1])
        middle = 0.5 * (a + b)
        scan.low[top], scan.high[top] = middle, b
        scan.low[top + 1], scan.high[top + 1] = a, middle
        top += 2
    return NONE


def single_root(r: Bracket, d: Doubles, work: Doubles) -> float:
    """The root in [0, 1] of a polynomial that rises through zero once."""
    r.begin(0.0, 1.0, False, d[0] / (d[0] - d[DEGREE]))
    while r.seek(RESOLUTION):
        f, slope, _curvature = taylor(d, r.x, work)
        r.newton(f, slope)
    return r.x
