"""Motions that are polynomials between kept states: bounds over windows of time, from Bernstein's basis.

The coefficients of a polynomial in the basis of a window enclose it there, and their differences its derivatives.
Source: R. Farouki, The Bernstein polynomial basis: a centennial retrospective, Computer Aided Geometric Design 29
(2012).
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.curves import interpolate
from lcpstep.audit.limits import TIMES
from lcpstep.audit.motion import Bounds
from lcpstep.intervals import Interval

Array = NDArray[np.float64]
ROUNDING = 1e-13  # of the numbers that a polynomial is made of
LAST_DIGIT = 4.5e-16  # two of the positions, by which a step may be off
TURN = 6.0  # what its second derivative makes of them


@functools.cache
def _nodes(degree: int) -> tuple[Array, Array]:
    """Places in [0, 1], and the matrix from values there to Bernstein's coefficients."""
    x = np.arange(degree + 1) / degree
    return x, np.asarray(np.linalg.inv(basis(x, degree)), dtype=float)


def basis(x: Array, degree: int) -> Array:
    """Bernstein's polynomials at x, (..., degree + 1)."""
    x = np.asarray(x, dtype=float)
    values = np.empty((*x.shape, degree + 1))
    power = np.ones(x.shape)
    for k in range(degree + 1):
        values[..., k] = math.comb(degree, k) * power
        power = power * x
    power = np.ones(x.shape)
    for k in range(degree, -1, -1):
        values[..., k] *= power
        power = power * (1.0 - x)
    return values


class Polynomials:
    """A motion that is a polynomial between kept states.

    Parameters
    ----------
    t : (m + 1,)   times of the states
    B : (m, degree + 1, n_q)   Bernstein's coefficients of the pieces between them
    steps : (moves, length)   the same less the states at the starts, and how long the steps (m,) are that pieces are
        parts of: so derivatives in short pieces do not drown in the rounding of positions
    absolute : of the coordinate in which a frame rests, not of that which the scene means
    """

    def __init__(
        self, t: Array, B: Array, steps: tuple[Array, Array] | None = None, *, absolute: bool = False
    ) -> None:
        self.t, self.B, self.degree, self.steps, self.absolute = t, B, B.shape[1] - 1, steps, absolute

    def windows(self, k: Any, a: Array, b: Array) -> Array:
        """Bernstein's coefficients (n, degree + 1, n_q) over the windows [a, b] in the pieces k."""
        x = self._moves(k, a, b)
        return self.B[k, :1] + x if self.steps else x

    def _moves(self, k: Any, a: Array, b: Array) -> Array:
        """The same, where steps are known less the states at their starts."""
        x, inverse = _nodes(self.degree)
        start, length = self.t[k], self.t[k + 1] - self.t[k]
        first, last = (a - start) / length, (b - start) / length
        # evenly between them, whatever rounding makes of short windows
        places = first[:, None] + (last - first)[:, None] * x
        B = self.steps[0] if self.steps else self.B
        return np.asarray(np.matmul(inverse, np.matmul(basis(places, self.degree), B[k])))

    def bounds(self, x: Array, start: Array, G: Array, k: Any, h: Array) -> Bounds:
        """Bounds of G q for a row G (n, n_q) of every window of length h, from coefficients of G q - start."""
        found = derivatives(x, h)
        if self.steps is None:
            return found
        off, length = self.size(G, k), self.steps[1][k]
        place = wider(Interval(found.place.lo + start, found.place.hi + start), ROUNDING * off)
        off = LAST_DIGIT * off
        return Bounds(
            place, wider(found.speed, 2.0 * off / length), wider(found.curve, TURN * off / (length * length))
        )

    def size(self, G: Array, k: Any) -> Array:
        """How large the numbers are that make up G q in the pieces k."""
        return np.asarray(np.sum(np.abs(G) * np.max(np.abs(self.B[k]), axis=1), axis=1))

    def along(self, G: Array, k: Any, a: Array, b: Array) -> tuple[Bounds, Array, Array]:
        """Bounds of G q for a row G (n, n_q) of every window, and its values at a and b."""
        x = np.matmul(self._moves(k, a, b), G[:, :, None])[:, :, 0]
        start = np.sum(G * self.B[k, 0], axis=1) if self.steps else np.zeros(len(x))
        return self.bounds(x, start, G, k, b - a), start + x[:, 0], start + x[:, -1]

    def place(self, G: Array, k: Any, t: Array) -> Array:
        """G q at times in the pieces k."""
        return np.asarray(np.sum(self.windows(k, t, t)[:, 0] * G, axis=1))

    def fastest(self, k: Any) -> Array:
        """How fast the coordinates are in the pieces k, at most, (n, n_q)."""
        moves, h = np.abs(np.diff(self.B[k], axis=1)), self.t[k + 1] - self.t[k]
        return np.asarray(self.degree * np.max(moves, axis=1) / h[:, None])

    def boxes(self, k: Any, a: Array, b: Array) -> tuple[list[Bounds], Array, Array]:
        """Bounds of every coordinate, and the states at a and b, (n, n_q)."""
        x = self._moves(k, a, b)
        rows = [np.broadcast_to(row, (len(x), len(row))) for row in np.eye(x.shape[2])]
        start = self.B[k, 0] if self.steps else np.zeros((len(x), x.shape[2]))
        found = [self.bounds(x[:, :, i], start[:, i], row, k, b - a) for i, row in enumerate(rows)]
        return found, start + x[:, 0], start + x[:, -1]


def wider(x: Interval, by: Array) -> Interval:
    """An interval with so much more on both sides."""
    return Interval(x.lo - by, x.hi + by)


def derivatives(x: Array, h: Array) -> Bounds:
    """Bounds of a polynomial and two derivatives from its coefficients (n, degree + 1) over windows of length h."""
    degree = x.shape[1] - 1
    x, found = np.ascontiguousarray(x.T), []  # long rows are gone through fast
    for order in range(3):
        lo, hi = x.min(axis=0), x.max(axis=0)
        slack = ROUNDING * np.maximum(np.abs(lo), np.abs(hi))
        found.append(Interval(lo - slack, hi + slack))
        x = (degree - order) * (x[1:] - x[:-1]) / h if len(x) > 1 else 0.0 * x
    return Bounds(*found)


def by_steps(t: Array, q: Array, F: Array, length: Array) -> Polynomials:
    """The dense output of Runge-Kutta steps, see `rungekutta.RungeKutta.at`; F (m, 7, 2 n_q) after each state."""
    n, degree = q.shape[1], F.shape[1]
    h, step = np.diff(t), np.where(length > 0.0, length, 1.0)
    moves = np.matmul(_whole(degree), F[:, :, :n])
    cut = np.flatnonzero(np.abs(h - step) > TIMES * np.abs(t[1:]))  # by an event
    if len(cut):
        moves[cut] = np.matmul(_parts(h[cut] / step[cut], degree), F[cut, :, :n])
    return Polynomials(t, q[:-1, None] + moves, (moves, step))


@functools.cache
def _whole(degree: int) -> Array:
    """From the coefficients of a whole step's dense output to Bernstein's, (degree + 1, degree)."""
    return _parts(np.ones(1), degree)[0]


def _parts(shares: Array, degree: int) -> Array:
    """The same of these first shares of steps, (m, degree + 1, degree)."""
    x, inverse = _nodes(degree)
    share, terms = x * shares[:, None], np.empty((len(shares), degree + 1, degree))
    factor = np.ones(share.shape)
    for k in range(degree):
        factor = factor * (share if k % 2 == 0 else 1.0 - share)
        terms[:, :, k] = factor
    return np.asarray(np.matmul(inverse, terms))


def parabolas(t: Array, q: Array, v: Array, a: Array) -> Polynomials:
    """Under constant accelerations (m, n_q), from the states at the start of each piece."""
    h = np.diff(t)[:, None]
    middle = q[:-1] + 0.5 * h * v[:-1]
    end = q[:-1] + h * (v[:-1] + 0.5 * h * a)
    return Polynomials(t, np.stack([q[:-1], middle, end], axis=1))


def through(t: Array, q: Array, v: Array, inner: Array) -> Polynomials:
    """Through the state at the start of each piece, positions at equal shares of it (m, k, n_q), and the next one."""
    k = inner.shape[1]
    degree = k + 2
    shares = np.arange(1, k + 2) / (k + 1)
    M = basis(shares, degree)
    B = np.empty((len(inner), degree + 1, q.shape[1]))
    t, q, v, inner, begin = (np.ascontiguousarray(x) for x in (t, q, v, inner, M[:, :2]))
    interpolate(t, q, v, inner, begin, np.linalg.inv(M[:, 2:]), B)
    return Polynomials(t, B)
