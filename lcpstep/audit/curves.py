"""Certificates of motions that are polynomials between kept states, as kernels: flat contacts, linear coordinates.

The coefficients of G y in Bernstein's basis bound it, and so do those of its second derivative; see `motion`.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices, small_numbers
from lcpstep.audit.cells import Cells
from lcpstep.audit.clear import Gap, between_corners, late, open_between
from lcpstep.kernels.function import Function
from lcpstep.pointers import Doubles, Flags, Indices, abs, after, indices_after, inf, max, min

ROUNDING = 1.1e-13  # of the numbers that a gap is made of
SECOND = 1e-15  # of them, times how large the second differences' factor is


class Curve(Gap):
    """The gap of a flat contact while the motion is a polynomial.

    x, second : (degree + 1,)   coefficients of offset + G q and of its second derivative;  span : of the piece
    part     work space of the sums
    """

    def __init__(
        self, cells: Cells, motion: Function, frame: Function, G: Any, state: Any, limits: Any, degree: int
    ) -> None:
        Gap.__init__(self, cells, motion, frame, G, state, limits)
        self.degree, self.space = degree, np.zeros((3, degree + 1))
        self.x, self.second, self.part = (
            doubles(self.space[0]),
            doubles(self.space[1]),
            doubles(self.space[2]),
        )

    def at(self, tau: float) -> None:
        """Ask for the motion."""
        share = tau / self.length
        self.place = casteljau(self.x, self.degree, share, self.part)
        self.bend = casteljau(self.second, self.degree - 2, share, self.part)


def casteljau(x: Doubles, degree: int, share: float, part: Doubles) -> float:
    """The polynomial with these coefficients at a share of its interval."""
    for i in range(degree + 1):
        part[i] = x[i]
    for k in range(degree):
        for i in range(degree - k):
            part[i] += share * (part[i + 1] - part[i])
    return part[0]


def differences(g: Curve, size: float) -> None:
    """Coefficients of the second derivative, what rounding makes of them, and a bound of the fourth derivative."""
    d, h = g.degree, g.length
    factor = d * (d - 1.0) / (h * h)
    for i in range(d - 1):
        g.second[i] = factor * (g.x[i + 2] - 2.0 * g.x[i + 1] + g.x[i])
    g.loose = SECOND * factor * size
    g.fourth = 0.0
    if d > 3:
        factor = (d - 2.0) * (d - 3.0) / (h * h)
        for i in range(d - 3):
            g.fourth = max(g.fourth, factor * abs(g.second[i + 2] - 2.0 * g.second[i + 1] + g.second[i]))
        g.fourth += 4.0 * factor * g.loose


@cython.ccall
def clear_curves(
    g: Curve, t: Any, B: Any, G: Any, offset: Any, obstacle: Any, absolute: Any, relative: float,
    drift: Any, touched: Any, skipped: Any, cuts: Any, found: Any,
) -> None:  # fmt: skip
    """Which pieces are certified, (m, n_c), into `found`; called from Python.

    Parameters
    ----------
    t : (m + 1,);  B : (m, degree + 1, n_q)   the motion;  G, offset : of the contacts
    obstacle : (m + 1 or 1, n_c, 3)   s, s' and s'' at the states
    absolute : (m or 1, n_q), relative   errors of the positions
    drift : (m or 0, n_q)   how much of the first steps have added up
    touched : (m + 1, n_c) uint8   whether an event of the run lies there;  skipped : (m, n_c) uint8
    cuts : (k,)   times at which the obstacle may have a corner
    """
    n, n_c, n_q, n_cuts, degree = len(found), len(offset), B.shape[2], len(cuts), g.degree
    step = 3 * n_c if len(obstacle) > 1 else 0
    rows, drifts = 0 if len(absolute) == 1 else n_q, len(drift) > 0
    events = np.full((2, n_c), -np.inf)
    last, following, gone = doubles(events[0]), doubles(events[1]), doubles(drift)
    times, control, normal, height = doubles(t), doubles(B), doubles(G), doubles(offset)
    s, corner, off = doubles(obstacle), doubles(cuts), doubles(absolute)
    columns, counts = used(G)
    column, count = indices(columns), indices(counts)
    touch, left, out = small_numbers(touched), small_numbers(skipped), small_numbers(found)
    with cython.nogil:
        i = 0
        for k in range(n):
            for c in range(n_c):
                if touch[k * n_c + c] != 0:
                    last[c] = times[k]
            if not times[k + 1] > times[k]:
                for c in range(n_c):
                    out[k * n_c + c] = 1
                continue
            while i < n_cuts and corner[i] <= times[k]:
                i += 1
            whole = i == n_cuts or corner[i] >= times[k + 1]
            g.length = times[k + 1] - times[k]
            for c in range(n_c):
                if left[k * n_c + c] != 0:
                    continue
                own, normal_c = indices_after(column, c * n_q), after(normal, c * n_q)
                size = along(
                    g, after(control, k * (degree + 1) * n_q), normal_c, own, count[c], n_q, height[c]
                )
                g.error = relative * size
                for r in range(count[c]):
                    g.error += abs(normal_c[own[r]]) * off[k * rows + own[r]]
                g.own = g.error
                if drifts:
                    for r in range(count[c]):
                        g.own -= abs(normal_c[own[r]]) * gone[k * n_q + own[r]]
                g.first, g.last = touch[k * n_c + c] != 0, touch[(k + 1) * n_c + c] != 0
                good = at_once(
                    g, c, times[k + 1], size, s[step * k + 3 * c], s[step * (k + 1) + 3 * c], whole
                )
                if not good:
                    if drifts:
                        following[c] = later(times, touch, k + 1, n, n_c, c, following[c])
                        g.since, g.until = times[k] - last[c], following[c] - times[k + 1]
                    good = between_corners(g, c, times[k], corner, i, n_cuts)
                out[k * n_c + c] = 1 if good else 0


def later(t: Doubles, touched: Flags, k: int, n: int, n_c: int, c: int, found: float) -> float:
    """The time of the first event of contact c at state k or after it; infinite if there is none.

    found : what an earlier state was told
    """
    if found >= t[k]:
        return found
    while k <= n and touched[k * n_c + c] == 0:
        k += 1
    return t[k] if k <= n else inf


@cython.cfunc
def used(G: Any) -> tuple[Any, Any]:
    """The columns in which rows of G are not zero, (n_c, n_q) with the rest behind them, and how many, (n_c,)."""
    columns = np.argsort(G == 0.0, axis=1, kind="stable").astype(np.intp)
    return columns, np.count_nonzero(G, axis=1).astype(np.intp)


def along(g: Curve, B: Doubles, G: Doubles, used: Indices, n_used: int, n_q: int, offset: float) -> float:
    """Coefficients of offset + G q, and how large the numbers are that these are made of; used: columns of G."""
    size = 0.0
    for i in range(g.degree + 1):
        total, largest = offset, abs(offset)
        for r in range(n_used):
            part = G[used[r]] * B[i * n_q + used[r]]
            total += part
            largest += abs(part)
        g.x[i] = total
        size = max(size, largest)
    return size


def at_once(g: Curve, c: int, t: float, size: float, s: float, s_b: float, whole: bool) -> bool:
    """Whether a piece is certified by its coefficients, and by the obstacle at its ends and its bounds."""
    d = g.degree
    rounding = ROUNDING * (size + max(abs(s), abs(s_b))) + late(t, g.cells.whole_fast[c])
    g.error += rounding
    g.own += rounding
    g.small = min(g.own, g.negligible)
    least = g.x[0]
    for i in range(1, d + 1):
        least = min(least, g.x[i])
    if least - g.cells.whole_top[c] > g.error:
        return True
    differences(g, size)
    g_a, g_b = g.x[0] - s, g.x[d] - s_b
    g.first, g.last = g.first or abs(g_a) <= g.small, g.last or abs(g_b) <= g.small
    g.note_ends(g.x[0], g.x[d], g_a, g_b, g.second[0], g.second[d - 2])
    kick = 0.0 if whole and not g.cells.whole_rough else g.cells.whole_kick[c]
    if kick > 0.0 and g.length > g.cells.length:
        return False
    low = high = g.second[0]
    for i in range(1, d - 1):
        low, high = min(low, g.second[i]), max(high, g.second[i])
    low -= g.cells.whole_high[c] + g.loose
    high += g.loose - g.cells.whole_low[c]
    return open_between(g_a, g_b, g.length, low, high, kick, g.first, g.last, g.error)


@cython.ccall
def interpolate(t: Any, q: Any, v: Any, inner: Any, begin: Any, inverse: Any, B: Any) -> None:
    """Coefficients B (m, k + 3, n_q) through states t, q, v (m + 1, ..) and k inner positions: `polynomials.through`.

    begin : (k + 1, 2)   what the first two coefficients are worth at the places of the others' conditions
    inverse : (k + 1, k + 1)   from what is left there to the other coefficients
    """
    n, n_q, k = len(B), q.shape[1], inner.shape[1]
    times, places, speeds, within = doubles(t), doubles(q), doubles(v), doubles(inner)
    first, back, out = doubles(begin), doubles(inverse), doubles(B)
    space = np.zeros(k + 1)
    rest = doubles(space)
    with cython.nogil:
        for i in range(n):
            share = (times[i + 1] - times[i]) / (k + 2)
            for j in range(n_q):
                coefficients = after(out, i * (k + 3) * n_q + j)
                start = places[i * n_q + j]
                second = start + share * speeds[i * n_q + j]
                coefficients[0], coefficients[n_q] = start, second
                for r in range(k + 1):
                    x = within[(i * k + r) * n_q + j] if r < k else places[(i + 1) * n_q + j]
                    rest[r] = x - (first[2 * r] * start + first[2 * r + 1] * second)
                for r in range(k + 1):
                    x = 0.0
                    for p in range(k + 1):
                        x += back[r * (k + 1) + p] * rest[p]
                    coefficients[(r + 2) * n_q] = x


@cython.ccall
def hulls(B: Any, group: int, lo: Any, hi: Any) -> None:
    """The smallest and largest coefficients of groups of pieces, (groups, n_q): bounds of the motion there."""
    n, width, n_q = len(B), B.shape[1], B.shape[2]
    control, low, high = doubles(B), doubles(lo), doubles(hi)
    with cython.nogil:
        for i in range(n * width):
            k = i // (group * width) * n_q
            for j in range(n_q):
                x = control[i * n_q + j]
                low[k + j], high[k + j] = min(low[k + j], x), max(high[k + j], x)
