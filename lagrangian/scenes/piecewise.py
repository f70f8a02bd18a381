"""Motion of one degree of freedom above an obstacle, put together from pieces in closed form.

    y'' + 2 delta y' + kappa y = f0 + C cos(Omega t) + S sin(Omega t),   y >= s(t),   u+ = -r u-,  u = y' - s'

Between impacts y is a sum of exponentials (or a parabola) and a steady oscillation, so every state is exact and
only the times of impacts and releases are roots, found to rounding. This is the answer that integrators are
measured against: plain, slow, and written without any of them. Source of the formulas: L. Meirovitch, Fundamentals
of Vibrations, chapters 2 and 3; of the modes: G. Osorio, Complex Behavior in Impacting Systems, eq. 3.16.

A hop is solved for from the gap acceleration alone, g/tau = u + tau int_0^1 (1 - x) (y'' - s'')(x tau) dx, in which
nothing cancels; so chattering is followed until its hops are shorter than the rounding of time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field

import numpy as np

from lagrangian.checks import Array
from lagrangian.scenes.free import Free

EPS = 2.0**-52
PER_PERIOD = 128  # scan intervals in the shortest period
SHORT = 0.5  # of a scan interval: shorter hops are solved for from the acceleration
PROBES = 4  # samples of the contact force per scan interval
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
NODES, WEIGHTS = 0.5 * (1.0 + NODES), 0.5 * WEIGHTS
SIDE = 2.0**-49  # relative: how far from a corner its sides are looked at


def _nowhere(t: float) -> tuple[float, float, float]:
    return 0.0, 0.0, 0.0


@dataclass
class Piecewise:
    """The motion from `start`, worked out as far as it is asked for.

    Parameters
    ----------
    free : Free
    restitution : of the obstacle
    start : (t, y, y')
    obstacle : s(t) as (s, s', s''); where s' or s'' jumps, its two sides are found a rounding apart
    corners, period : times in [0, period) at which s' or s'' jumps [s]
    scan : longest interval on which the gap acceleration turns only once [s]

    Attributes
    ----------
    impacts : list of (t, u-), all impacts worked out so far
    sticks, releases : times at which the contact closed and opened
    """

    free: Free
    restitution: float
    start: tuple[float, float, float]
    obstacle: Callable[[float], tuple[float, float, float]] = _nowhere
    corners: Iterable[float] = ()
    period: float = math.inf
    scan: float = math.inf
    impacts: list[tuple[float, float]] = field(default_factory=list)
    sticks: list[float] = field(default_factory=list)
    releases: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.corners = sorted(self.corners)
        rate = max(math.sqrt(abs(self.free.kappa)), self.free.delta, abs(self.free.omega))
        self.scan = min(self.scan, self.period / PER_PERIOD)
        if rate > 0.0:
            self.scan = min(self.scan, 2.0 * math.pi / rate / PER_PERIOD)
        if not math.isfinite(self.scan):
            raise ValueError("scan: expected a time, where the system has none of its own")
        t, y, v = self.start
        self._pieces: list[tuple[float, float, float, bool]] = []  # time, y, y', closed
        s, ds, _ = self._side(t, +1)
        self._now = self._high = t
        self._leaving: tuple[float, float] | None = None
        if y - s > 0.0:
            self._go_on(t, y, v)
        elif v - ds < 0.0:
            self._strike(t, v - ds)
        else:
            self._leave(t, v - ds)

    def state(self, t: float) -> tuple[float, float]:
        """y and y' (right limit) at a time not before the start."""
        y, v = self(np.array([t]))
        return float(y[0, 0]), float(v[0, 0])

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """The same for times (m,), in arrays of shape (m, 1)."""
        t = np.asarray(times, dtype=float)
        self._reach(float(np.max(t, initial=self.start[0])))
        begins = np.array([piece[0] for piece in self._pieces])
        of = np.maximum(np.searchsorted(begins, t, side="right") - 1, 0)
        t0, y0, v0, closed = np.array(self._pieces)[of].T
        states, flies = np.empty((2, len(t))), closed == 0.0
        states[:, flies] = self.free.at(t0[flies], y0[flies], v0[flies], t[flies], np)[:2]
        for k in np.flatnonzero(closed):
            states[:, k] = self._side(float(t[k]), +1)[:2]
        return states[0][:, None], states[1][:, None]

    def _reach(self, t: float) -> None:
        """Work the motion out up to t, and what begins there."""
        while self._now < t or (self._now == t and self._pieces[-1][0] < t):
            self._advance()

    def _advance(self) -> None:
        """To the next event, or over one scan interval without one."""
        t0, _, _, closed = self._pieces[-1]
        a, b = self._now, min(self._now + self.scan, self._high)
        if closed:
            t = self._release_time(a, b)
            if t is not None:
                self.releases.append(t)
                self._leave(t, 0.0, released=True)
                return
        else:
            hop = self._hop() if a == t0 and self._leaving is not None else None
            if hop == 0.0:
                self._stick(t0)
                return
            if hop is not None:
                self._strike(t0 + hop, self._relative(hop)[1])
                return
            t = self._contact_time(a, b)
            if t is not None:
                _, u, _ = self._gap(t, -1 if t == self._high else 0)
                self._strike(t, u)
                return
        self._now = b
        if b == self._high:
            self._turn_corner(b)

    # --- events

    def _strike(self, t: float, u: float) -> None:
        """Impact with the gap velocity u, which at a corner is that before it."""
        if u < 0.0:
            self.impacts.append((t, u))
        self._leave(t, -self.restitution * min(u, 0.0))

    def _leave(self, t: float, u: float, released: bool = False) -> None:
        """On the surface at t with gap velocity u >= 0: contact, or flight."""
        s, ds, _ = self._side(t, +1)
        self._go_on(t, s, ds + u)
        alpha = self._gap(t, +1)[2]
        if u == 0.0 and alpha <= 0.0 and not released:
            self._stick(t)
            return
        self._leaving = (u, alpha) if alpha < 0.0 and u > 0.0 else None

    def _stick(self, t: float) -> None:
        self.sticks.append(t)
        s, ds, _ = self._side(t, +1)
        self._go_on(t, s, ds, closed=True)

    def _go_on(self, t: float, y: float, v: float, closed: bool = False) -> None:
        self._pieces.append((t, y, v, closed))
        self._now, self._leaving = t, None
        _, self._high = self._smooth_interval(t)

    def _turn_corner(self, t: float) -> None:
        """Into the next smooth interval; an obstacle whose velocity jumps takes a closed contact along, or goes."""
        *_, closed = self._pieces[-1]
        if closed:
            jump = self._side(t, -1)[1] - self._side(t, +1)[1]
            if jump > 0.0 or self._alpha_closed(t, +1) > 0.0:
                self.releases.append(t)
                self._leave(t, max(jump, 0.0), released=True)
        else:
            g, u, _ = self._gap(t, -1)
            if u < 0.0 and g <= -2.0 * u * self._resolution(t):  # it strikes within rounding of the corner
                self._strike(t, u)
        _, self._high = self._smooth_interval(t)

    # --- where they are

    def _contact_time(self, a: float, b: float) -> float | None:
        """First time in (a, b] at which the gap closes, or None."""
        left, right = self._gap(a, +1), self._gap(b, -1)
        times, gaps = [a, b], [left, right]
        for level in (2, 1):  # split where the acceleration, then the velocity, changes its sign
            fine_times, fine_gaps = [times[0]], [gaps[0]]
            for k in range(1, len(times)):
                if gaps[k - 1][level] * gaps[k][level] < 0.0:
                    t = self._root(times[k - 1], times[k], level)
                    fine_times.append(t)
                    fine_gaps.append(self._gap(t))
                fine_times.append(times[k])
                fine_gaps.append(gaps[k])
            times, gaps = fine_times, fine_gaps
        for k in range(1, len(times)):
            if gaps[k][0] <= 0.0 and gaps[k][1] <= 0.0 and times[k] > a:
                if gaps[k - 1][0] > 0.0:
                    return self._root(times[k - 1], times[k], 0)
                return times[k]
            if gaps[k][0] <= 0.0 and gaps[k - 1][0] > 0.0:
                return self._root(times[k - 1], times[k], 0)
        return None

    def _release_time(self, a: float, b: float) -> float | None:
        """First time in (a, b] at which the contact force vanishes, or None."""
        left, f_left = a, self._alpha_closed(a, +1)
        for k in range(1, PROBES + 1):
            right = b if k == PROBES else a + k * (b - a) / PROBES
            f_right = self._alpha_closed(right, -1)
            if f_right > 0.0:
                return left if f_left >= 0.0 else _bisect(lambda t: self._alpha_closed(t, 0), left, right)
            left, f_left = right, f_right
        return None

    def _hop(self) -> float | None:
        """Duration of a short hop that has just begun; 0 where it is below rounding, None where it is long."""
        t0 = self._pieces[-1][0]
        u, alpha = self._leaving or (0.0, -1.0)
        tau = -2.0 * u / alpha
        if tau <= 4.0 * EPS * max(abs(t0), self.scan):
            return 0.0
        longest = min(SHORT * self.scan, self._high - t0)
        if tau > longest:
            return None
        for _ in range(60):
            f, u_end = self._relative(tau)
            step = -f * tau / (u_end - f)  # Newton's method for g/tau = 0
            tau += step
            if not 0.0 < tau <= longest:
                return None
            if abs(step) <= 2.0 * EPS * tau:
                return tau
        return tau

    def _relative(self, tau: float) -> tuple[float, float]:
        """g/tau and u at tau after leaving the surface, from the gap acceleration alone."""
        t0, u = self._pieces[-1][0], (self._leaving or (0.0, 0.0))[0]
        alpha = np.array([self._gap(t0 + x * tau)[2] for x in NODES])
        return u + tau * float(WEIGHTS @ ((1.0 - NODES) * alpha)), u + tau * float(WEIGHTS @ alpha)

    def _root(self, a: float, b: float, level: int) -> float:
        return _bisect(lambda t: self._gap(t, +1 if t == a else (-1 if t == b else 0))[level], a, b)

    # --- gap, and its sides at corners

    def _gap(self, t: float, side: int = 0) -> tuple[float, float, float]:
        """Gap, its velocity and acceleration of the free flight at hand."""
        t0, y0, v0, _ = self._pieces[-1]
        y, v, a = self.free.at(t0, y0, v0, t)
        s, ds, dds = self._side(t, side)
        return y - s, v - ds, a - dds

    def _alpha_closed(self, t: float, side: int) -> float:
        """Gap acceleration that the free motion would have from the obstacle at t."""
        s, ds, dds = self._side(t, side)
        return self.free.at(t, s, ds, t)[2] - dds

    def _side(self, t: float, side: int) -> tuple[float, float, float]:
        """The obstacle at t, as seen from before (-1) or after (+1) where t is a corner."""
        if side == 0 or not self._at_corner(t):
            return self.obstacle(t)
        _, ds, dds = self.obstacle(t + side * self._resolution(t))
        return self.obstacle(t)[0], ds, dds

    def _resolution(self, t: float) -> float:
        return SIDE * max(abs(t), self.scan)

    def _at_corner(self, t: float) -> bool:
        low, _ = self._smooth_interval(t)
        return abs(t - low) <= 2.0 * self._resolution(t)

    def _smooth_interval(self, t: float) -> tuple[float, float]:
        """Corner at or before t (within rounding), and the next one."""
        low, high, near = -math.inf, math.inf, t + self._resolution(t)
        turn = math.floor(near / self.period) if math.isfinite(self.period) else 0
        for k in (-1, 0, 1) if math.isfinite(self.period) else (0,):
            for corner in self.corners:
                c = corner + (turn + k) * self.period if math.isfinite(self.period) else corner
                low, high = (max(low, c), high) if c <= near else (low, min(high, c))
        return low, high


def _bisect(f: Callable[[float], float], a: float, b: float) -> float:
    """Sign change of f between a and b to rounding; Ridders' method would gain little on 50 halvings."""
    positive = f(a) > 0.0
    while True:
        middle = 0.5 * (a + b)
        if not a < middle < b:
            return b
        if (f(middle) > 0.0) == positive:
            a = middle
        else:
            b = middle
