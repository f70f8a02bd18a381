"""Bounds of the computed motion over windows of time.

Between two kept states a motion is a polynomial (`polynomials`), or, for one linear degree of freedom in closed form,
a decaying oscillation and a steady one,

    y = rest + exp(-delta tau) R cos(w tau - phi) + S cos(Omega t - psi)

whose derivatives have the same form.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.intervals import Interval

Array = NDArray[np.float64]


class Bounds(NamedTuple):
    """Of a quantity x over windows: x, x' and x''."""

    place: Interval
    speed: Interval
    curve: Interval


class Oscillation:
    """One linear degree of freedom in closed form, in the coordinate y in which its frame rests.

    Parameters
    ----------
    o : Oscillator;  t : (m + 1,) times;  q, v : (m + 1,) states, relative to the frame;  frame : Function
    """

    absolute = True

    def __init__(self, o: Any, t: Array, q: Array, v: Array, frame: Any) -> None:
        self.o, self.t, self.q, self.v, self.frame = o, t, q, v, frame

    def states(self, k: Any) -> tuple[Array, Array]:
        """The absolute states at the start of the pieces k."""
        if not self.frame.given:
            return self.q[k], self.v[k]
        c, still = np.zeros((len(k), 1, 3)), np.zeros(1)
        self.frame.sample(np.ascontiguousarray(self.t[k]), still, still, c)
        return self.q[k] + c[:, 0, 0], self.v[k] + c[:, 0, 1]

    def remainder(self, k: Any) -> tuple[Array, Array]:
        """The motion less the steady oscillation at the start of the pieces k, and its velocity."""
        (y, w), (steady, rate) = self.states(k), self.steady(self.t[k])
        return y - steady, w - rate

    def size(self, G: Array, k: Any) -> Array:
        """How large the numbers are that make up G y in the pieces k."""
        steady = math.hypot(self.o.X, self.o.Y)
        return np.asarray(np.abs(G[:, 0]) * (np.abs(self.states(k)[0]) + 2.0 * steady))

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
