"""Bounds of the computed motion over windows of time.

Between two kept states a motion is a polynomial, whose coefficients in Bernstein's basis of a window enclose it
there, or, for one linear degree of freedom in closed form, a decaying oscillation and a steady one,

    y = rest + exp(-delta tau) R cos(w tau - phi) + S cos(Omega t - psi)

whose derivatives have the same form. Source: R. Farouki, The Bernstein polynomial basis: a centennial retrospective,
Computer Aided Geometric Design 29 (2012).
"""

from __future__ import annotations

import functools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.curves import interpolate
from lcpstep.intervals import Interval

Array = NDArray[np.float64]
ROUNDING = 1e-13  # of the numbers that a polynomial is made of
LAST_DIGIT, TURN = (
    4.5e-16,
    6.0,
)  # two of the positions, by which a step may be off, and what its turn makes of them


class Bounds(NamedTuple):
    """Of a quantity x over windows: x, x' and x''."""

    place: Interval
    speed: Interval
    curve: Interval


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
    """

    absolute = False  # q is what the scene means by it

    def __init__(self, t: Array, B: Array, steps: tuple[Array, Array] | None = None) -> None:
        self.t, self.B, self.degree, self.steps = t, B, B.shape[1] - 1, steps

    def windows(self, k: Any, a: Array, b: Array) -> Array:
        """Bernstein's coefficients (n, degree + 1, n_q) over the windows [a, b] in the pieces k."""
        return self._within(self.B, k, a, b)

    def _within(self, B: Array, k: Any, a: Array, b: Array) -> Array:
        x, inverse = _nodes(self.degree)
        start, length = self.t[k], self.t[k + 1] - self.t[k]
        first, last = (
            (a - start) / length,
            (b - start) / length,
        )  # places between them: evenly, whatever rounding
        places = first[:, None] + (last - first)[:, None] * x
        values = np.matmul(basis(places, self.degree), B[k])
        return np.asarray(np.matmul(inverse, values))

    def bounds(self, x: Array, G: Array, k: Any, a: Array, b: Array) -> Bounds:
        """Bounds of G q for a row G (n, n_q) of every window, of which x (n, degree + 1) are the coefficients."""
        found = derivatives(x, b - a)
        if self.steps is None:
            return found
        moves, length = self.steps
        exact = derivatives(np.matmul(self._within(moves, k, a, b), G[:, :, None])[:, :, 0], b - a)
        off, h = LAST_DIGIT * self.size(G, k), length[k]
        return Bounds(
            found.place, wider(exact.speed, 2.0 * off / h), wider(exact.curve, TURN * off / (h * h))
        )

    def size(self, G: Array, k: Any) -> Array:
        """How large the numbers are that make up G q in the pieces k."""
        return np.asarray(np.sum(np.abs(G) * np.max(np.abs(self.B[k]), axis=1), axis=1))

    def along(self, G: Array, k: Any, a: Array, b: Array) -> tuple[Bounds, Array, Array]:
        """Bounds of G q for a row G (n, n_q) of every window, and its values at a and b."""
        x = np.matmul(self.windows(k, a, b), G[:, :, None])[:, :, 0]
        return self.bounds(x, G, k, a, b), x[:, 0], x[:, -1]

    def place(self, G: Array, k: Any, t: Array) -> Array:
        """G q at times in the pieces k."""
        return np.asarray(np.sum(self.windows(k, t, t)[:, 0] * G, axis=1))

    def fastest(self, k: Any) -> Array:
        """How fast the coordinates are in the pieces k, at most, (n, n_q)."""
        moves, h = np.abs(np.diff(self.B[k], axis=1)), self.t[k + 1] - self.t[k]
        return np.asarray(self.degree * np.max(moves, axis=1) / h[:, None])

    def boxes(self, k: Any, a: Array, b: Array) -> tuple[list[Bounds], Array, Array]:
        """Bounds of every coordinate, and the states at a and b, (n, n_q)."""
        x = self.windows(k, a, b)
        rows = [np.broadcast_to(row, (len(x), len(row))) for row in np.eye(x.shape[2])]
        return [self.bounds(x[:, :, i], row, k, a, b) for i, row in enumerate(rows)], x[:, 0], x[:, -1]


def wider(x: Interval, by: Array) -> Interval:
    """An interval with so much more on both sides."""
    return Interval(x.lo - by, x.hi + by)


def derivatives(x: Array, h: Array) -> Bounds:
    """Bounds of a polynomial and two derivatives from its coefficients (n, degree + 1) over windows of length h."""
    degree = x.shape[1] - 1
    slack = ROUNDING * np.max(np.abs(x), axis=1)
    found = []
    for order in range(3):
        found.append(Interval(x.min(axis=1) - slack, x.max(axis=1) + slack))
        x = (degree - order) * np.diff(x, axis=1) / h[:, None] if x.shape[1] > 1 else 0.0 * x
        slack = ROUNDING * np.max(np.abs(x), axis=1)
    return Bounds(*found)


def by_steps(t: Array, q: Array, F: Array, length: Array) -> Polynomials:
    """The dense output of Runge-Kutta steps, see `rungekutta.RungeKutta.at`; F (m, 7, 2 n_q) after each state."""
    n, degree = q.shape[1], F.shape[1]
    h, step = np.diff(t), np.where(length > 0.0, length, 1.0)
    moves = np.matmul(_whole(degree), F[:, :, :n])
    cut = np.flatnonzero(h != step)  # by an event
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


class Oscillation:
    """One linear degree of freedom in closed form, in the coordinate y in which its frame rests.

    Parameters
    ----------
    o : Oscillator;  t : (m + 1,) times;  y, w : (m,) state at the start of each piece
    """

    absolute = True

    def __init__(self, o: Any, t: Array, y: Array, w: Array) -> None:
        self.o, self.t, self.y, self.w = o, t, y, w

    def remainder(self, k: Any) -> tuple[Array, Array]:
        """The motion less the steady oscillation at the start of the pieces k, and its velocity."""
        steady, rate = self.steady(self.t[k])
        return self.y[k] - steady, self.w[k] - rate

    def size(self, G: Array, k: Any) -> Array:
        """How large the numbers are that make up G y in the pieces k."""
        steady = math.hypot(self.o.X, self.o.Y)
        return np.asarray(np.abs(G[:, 0]) * (np.abs(self.y[k]) + 2.0 * steady))

    def steady(self, t: Array) -> tuple[Array, Array]:
        """The steady oscillation and its velocity."""
        o = self.o
        if o.Omega == 0.0:
            return np.zeros(len(t)), np.zeros(len(t))
        c, s = np.cos(o.Omega * t), np.sin(o.Omega * t)
        return o.X * c + o.Y * s, o.Omega * (o.Y * c - o.X * s)

    def along(self, G: Array, k: Any, a: Array, b: Array) -> tuple[Bounds, Array, Array]:
        """Bounds of G y for a number G (n, 1) of every window, and its values at a and b."""
        tau = Interval(a - self.t[k], b - self.t[k])
        free, at_a, at_b = self.free(*self.remainder(k), tau)
        if self.o.Omega != 0.0 and (self.o.X != 0.0 or self.o.Y != 0.0):
            at_a, at_b = at_a + self.steady(a)[0], at_b + self.steady(b)[0]
            free = Bounds(*[x + y for x, y in zip(free, self.forced(Interval(a, b)), strict=True)])
        g = G[:, 0]
        return Bounds(*[x * Interval(g, g) for x in free]), g * at_a, g * at_b

    def place(self, G: Array, k: Any, t: Array) -> Array:
        """G y at times in the pieces k."""
        return self.along(G, k, t, t)[1]

    def forced(self, t: Interval) -> Bounds:
        """Bounds of the steady oscillation."""
        o = self.o
        size, phase = math.hypot(o.X, o.Y), math.atan2(o.Y, o.X)
        angle = o.Omega * t - phase
        place = size * angle.cos()
        return Bounds(place, (-size * o.Omega) * angle.sin(), (-o.Omega * o.Omega) * place)

    def free(self, z: Array, dz: Array, tau: Interval) -> tuple[Bounds, Array, Array]:
        """Bounds of the remainder, and its values at both ends."""
        delta, w2, f0 = self.o.delta, self.o.w2, self.o.f0
        if delta == 0.0 and w2 == 0.0:
            line = Bounds(
                Interval(z, z) + tau * (Interval(dz, dz) + tau * (0.5 * f0)),
                Interval(dz, dz) + tau * f0,
                Interval(np.full(len(z), f0), np.full(len(z), f0)),
            )
            return line, *[z + x * (dz + 0.5 * f0 * x) for x in (tau.lo, tau.hi)]
        rest = f0 / w2 if w2 != 0.0 else 0.0
        z = z - rest
        if w2 > delta * delta:
            return self.swinging(z, dz, rest, tau)
        return self.creeping(z, dz, rest, tau)

    def swinging(self, z: Array, dz: Array, rest: float, tau: Interval) -> tuple[Bounds, Array, Array]:
        """Exp(-delta tau) (A cos w tau + B sin w tau)."""
        delta = self.o.delta
        w = math.sqrt(self.o.w2 - delta * delta)
        A, B = z, (dz + delta * z) / w
        angle, found = w * tau, []
        decay = (-delta * tau).exp() if delta != 0.0 else Interval(1.0, 1.0)
        ends = [rest + np.exp(-delta * x) * (A * np.cos(w * x) + B * np.sin(w * x)) for x in (tau.lo, tau.hi)]
        for _ in range(3):
            size, phase = np.hypot(A, B), np.arctan2(B, A)
            wave = (angle - Interval(phase - 1e-15, phase + 1e-15)).cos()
            found.append(Interval(size, size) * wave * decay if delta != 0.0 else Interval(size, size) * wave)
            A, B = w * B - delta * A, -w * A - delta * B
        return Bounds(found[0] + rest, found[1], found[2]), ends[0], ends[1]

    def creeping(self, z: Array, dz: Array, rest: float, tau: Interval) -> tuple[Bounds, Array, Array]:
        """Taylor's polynomial; the third derivative is below K N, N = max(|y2|, fast |y1|) of the other two.

        N grows at most like exp(max(K, fast) tau).
        """
        delta, w2, f0 = self.o.delta, self.o.w2, self.o.f0
        h = tau.hi - tau.lo
        y, dy = self.at(z, dz, tau.lo)
        y_b, _ = self.at(z, dz, tau.hi)
        a = (f0 if w2 == 0.0 else 0.0) - 2.0 * delta * dy - w2 * y
        fast = abs(delta) + math.sqrt(max(delta * delta - w2, 0.0))
        K = 2.0 * abs(delta) + abs(w2) / fast
        size = np.maximum(np.abs(a), fast * np.abs(dy)) * np.exp(np.minimum(max(K, fast) * h, 700.0))
        curve = Interval(a - K * size * h, a + K * size * h)
        step = Interval(np.zeros(len(h)), h)
        speed = Interval(dy, dy) + step * curve
        place = Interval(y, y) + step * speed
        return Bounds(place + rest, speed, curve), y + rest, y_b + rest

    def at(self, z: Array, dz: Array, x: Array) -> tuple[Array, Array]:
        """Position less rest, and velocity, of a motion that does not swing."""
        delta, w2, f0 = self.o.delta, self.o.w2, self.o.f0
        decay, root = np.exp(-delta * x), math.sqrt(max(delta * delta - w2, 0.0))
        if w2 == 0.0:
            S = -np.expm1(-2.0 * delta * x) / (2.0 * delta)
            dS, P = 1.0 - 2.0 * delta * S, (x - S) / (2.0 * delta)
            return z + dz * S + f0 * P, dz * dS + f0 * S
        S = decay * (np.sinh(root * x) / root if root > 0.0 else x)
        dS = decay * np.cosh(root * x) - delta * S
        return z * (dS + 2.0 * delta * S) + dz * S, -w2 * z * S + dz * dS
