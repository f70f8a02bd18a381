"""One linear degree of freedom above a fixed flat obstacle, by conservative advancement, as a kernel.

    g'' + 2 delta g' + w2 g = F0 + Fc cos(Omega t) + Fs sin(Omega t),   0 <= delta < w,   w2 = w^2

in free flight, which is g = s0 + X cos + Y sin + exp(-delta tau) (A cos(w_d tau) + B sin(w_d tau)), and for short
times Taylor's series, that tells low hops to all digits. As |g''| <= b over a flight, its gap stays open for

    d = (u + sqrt(u^2 + 2 b g)) / b

from wherever it has the velocity u: steps of that length pass no impact, and end at the first one as Newton's method
does. Source: B. Mirtich, Impulse-based dynamic simulation of rigid body systems, thesis, Berkeley (1996).
"""

from __future__ import annotations

from math import acos, atan2, cos, exp, floor, hypot, pi, sin, sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.status import BUFFER_FULL, DONE, STEP_TOO_SMALL
from lcpstep.pointers import inf, max, min
from lcpstep.trajectory import Kind

IMPACT, ACCUMULATION = int(Kind.IMPACT), int(Kind.ACCUMULATION)
STICK, RELEASE = int(Kind.STICK), int(Kind.RELEASE)
DEGREE, SHORT = 16, 0.5  # of the series, and the phase up to which it is taken
BEGIN = 1e-3  # phase of a flight without a velocity, after which its gap is looked at first
LOW, SOON = 1e-14, 1e-5  # height of a hop [size], and phase of all that follow: then these are summed up
TOUCH = 2e-16  # [size] what falls deeper by so little and rises again has touched the obstacle, to rounding
MOST = 2000  # steps of a flight
EPS, TINY = 2.220446049250313e-16, 1e-300
ROUNDING = 1e-9  # of a phase


class Advance:
    """Where the motion is: at the time t + late with gap g and its velocity u, flying or at rest.

    delta, w2, F0, Fc, Fs, Omega    of the equation;  s0, X, Y  of its steady oscillation
    fast, bound     the larger of both frequencies; of the gap acceleration of the flight at hand
    r, push         restitution, and the impulse for a change of velocity
    A, B, x, y, T   of the flight that began at t0 + late0, as above; its forced part; its series (DEGREE + 1,)
    n, next         times asked for, and the first that is to come;  rows  of the log

    Parameters
    ----------
    numbers : dict   those above by name, and t, g, u at the start, t_end, size (of gaps)
    times : (n,);  states : (n, 2)   when gap and gap velocity are asked for, and they
    log : (k, COLUMNS)   of events
    """

    def __init__(self, numbers: dict[str, float], times: Any, states: Any, log: Any) -> None:
        self.delta, self.w2, self.r, self.push = [numbers[x] for x in ("delta", "w2", "r", "push")]
        self.F0, self.Fc, self.Fs, self.Omega = [numbers[x] for x in ("F0", "Fc", "Fs", "Omega")]
        self.X, self.Y, self.t_end, self.size = [numbers[x] for x in ("X", "Y", "t_end", "size")]
        self.t, self.g, self.u = numbers["t"], numbers["g"], numbers["u"]
        self.s0, self.w_d = self.F0 / self.w2, sqrt(self.w2 - self.delta * self.delta)
        self.fast = max(sqrt(self.w2), self.Omega)
        self.forced = self.Omega * self.Omega * hypot(self.X, self.Y)
        self.kept, self.resting, self.begun, self.series = (times, states, log), False, False, False
        self.series_of = np.zeros(DEGREE + 1)
        self.times, self.states, self.log = doubles(times), doubles(states), doubles(log)
        self.T, self.n, self.most = doubles(self.series_of), len(times), len(log)
        self.next = self.rows = self.events = self.steps = 0
        self.t0 = self.late0 = self.late = self.A = self.B = self.x = self.y = self.bound = 0.0

    @cython.ccall
    def go_on(self) -> int:
        """Events up to the end of the span, or until the log is full; called from Python."""
        self.rows = 0
        with cython.nogil:
            code = self.follow()
        return code  # noqa: RET504  what is Python's begins here

    def follow(self) -> int:
        """The same as a kernel."""
        if not self.begun:
            self.begun = True
            if self.g <= 0.0 and self.u < 0.0:
                self.strike()
            elif self.g <= 0.0 and self.u == 0.0:
                self.rest()
        while self.t < self.t_end:
            if self.rows + 2 > self.most:
                return BUFFER_FULL
            if self.resting:
                self.wait()
            elif not self.fly():
                return STEP_TOO_SMALL
        self.tell(inf)
        return DONE

    def force(self, t: float) -> float:
        """The acceleration of a gap that is closed."""
        return self.F0 + self.Fc * cos(self.Omega * t) + self.Fs * sin(self.Omega * t)

    def leave(self) -> None:
        """A flight begins: its oscillation and the bound of its acceleration."""
        c, s = cos(self.Omega * self.t), sin(self.Omega * self.t)
        self.t0, self.late0, self.series = self.t, self.late, False
        self.x, self.y = self.X * c + self.Y * s, self.Y * c - self.X * s
        self.A = self.g - self.s0 - self.x
        self.B = (self.u - self.Omega * self.y + self.delta * self.A) / self.w_d
        self.bound = self.w2 * hypot(self.A, self.B) + self.forced + TINY
        self.T[0], self.T[1] = self.g, self.u

    def at(self, tau: float) -> None:
        """Gap and velocity at tau after the beginning of the flight."""
        if tau * self.fast < SHORT:
            self.by_series(tau)
            return
        decay, f_c, f_s = exp(-self.delta * tau), cos(self.Omega * tau), sin(self.Omega * tau)
        c, s = decay * cos(self.w_d * tau), decay * sin(self.w_d * tau)
        z, z_t = self.A * c + self.B * s, self.w_d * (self.B * c - self.A * s)
        self.g = self.s0 + z + (self.x * f_c + self.y * f_s)
        self.u = z_t - self.delta * z + self.Omega * (self.y * f_c - self.x * f_s)

    def by_series(self, tau: float) -> None:
        """The same, soon after it."""
        T = self.T
        if not self.series:
            self.series = True
            c, s = cos(self.Omega * self.t0), sin(self.Omega * self.t0)
            for k in range(DEGREE - 1):
                f = self.Fc * c + self.Fs * s + (self.F0 if k == 0 else 0.0)
                f -= 2.0 * self.delta * (k + 1) * T[k + 1] + self.w2 * T[k]
                T[k + 2] = f / ((k + 1) * (k + 2))
                c, s = -self.Omega * s / (k + 1), self.Omega * c / (k + 1)
        g, u = T[DEGREE], 0.0
        for k in range(DEGREE - 1, -1, -1):
            u = u * tau + g
            g = g * tau + T[k]
        self.g, self.u = g, u

    def fly(self) -> bool:
        """Up to the next impact, or the end of the span; False where a flight does not come on."""
        self.leave()
        end, tau, d = self.t_end - self.t0 - self.late0, 0.0, inf
        if self.g <= 0.0 and self.u <= 0.0:
            tau = BEGIN / self.fast
            self.at(tau)
            if not (self.g > 0.0 and self.u > 0.0):
                return False
        for _ in range(MOST):
            self.steps += 1
            g, u = max(self.g, 0.0), self.u
            root = sqrt(u * u + 2.0 * self.bound * g)
            d = (u + root) / self.bound if u >= 0.0 else 2.0 * g / (root - u)
            if tau + d > end:
                self.tell(inf)
                self.t = self.t_end
                return True
            tau += d
            self.at(tau)
            if u < 0.0 and (self.g <= 0.0 or d <= EPS * tau):
                a = self.force(self.t0 + tau) - 2.0 * self.delta * self.u
                if self.u * self.u > 2.0 * a * TOUCH * self.size:
                    self.land(tau)
                    return True
                tau -= 2.0 * self.u / a
                self.at(tau)
        return False

    def land(self, tau: float) -> None:
        """The flight ends with an impact."""
        u = self.u
        self.go_to(tau)
        self.tell(self.t)
        self.u = u
        self.strike()

    def go_to(self, tau: float) -> None:
        """To tau after the beginning of the flight: the time, and what its last digit leaves out."""
        tau += self.late0
        self.t = self.t0 + tau
        rounded = self.t - self.t0
        self.late = (self.t0 - (self.t - rounded)) + (tau - rounded)

    def strike(self) -> None:
        """An impact, with all that follow where they are low and soon over."""
        before, self.u = self.u, -self.r * self.u
        self.g, self.events = 0.0, self.events + 1
        a = self.force(self.t) - 2.0 * self.delta * self.u
        if a < 0.0 and self.r < 1.0:
            left = 2.0 * self.u / (-a * (1.0 - self.r))
            if self.u == 0.0 or (self.u * self.u < -2.0 * a * LOW * self.size and left * self.fast < SOON):
                push = -(1.0 + self.r) / (1.0 - self.r) * before * self.push
                self.t, self.late = min(self.t + left, self.t_end), 0.0
                self.note(before, 0.0, push, IMPACT if self.r == 0.0 else ACCUMULATION)
                self.rest()
                return
        self.note(before, self.u, (self.u - before) * self.push, IMPACT)

    def rest(self) -> None:
        """The contact stays closed, if the forces press on it."""
        self.g, self.u = 0.0, 0.0
        self.resting = self.force(self.t) <= 0.0
        if self.resting:
            self.note(0.0, 0.0, 0.0, STICK)

    def wait(self) -> None:
        """At rest until the force F0 + R cos(Omega t - phi) has risen to zero, or to the end."""
        R, until = hypot(self.Fc, self.Fs), self.t_end
        if self.Omega > 0.0 and self.F0 + R > 0.0:
            phase = -acos(max(-self.F0 / R, -1.0)) - (self.Omega * self.t - atan2(self.Fs, self.Fc))
            phase -= 2.0 * pi * floor(phase / (2.0 * pi))
            until = self.t + (phase if phase < 2.0 * pi - ROUNDING else 0.0) / self.Omega
            c, s = cos(self.Omega * until), sin(self.Omega * until)
            rises = self.Omega * (self.Fs * c - self.Fc * s)
            if rises > 0.0:
                until = max(self.t, until - (self.F0 + self.Fc * c + self.Fs * s) / rises)
        if until >= self.t_end:
            self.tell(inf)
            self.t = self.t_end
            return
        self.tell(until)
        self.t, self.late, self.resting = until, 0.0, False
        self.note(0.0, 0.0, 0.0, RELEASE)

    def tell(self, until: float) -> None:
        """The states asked for before a time of the flight or rest at hand."""
        while self.next < self.n and self.times[self.next] < until:
            if self.resting or self.times[self.next] <= self.t0:
                self.g, self.u = (0.0, 0.0) if self.resting else (self.T[0], self.T[1])
            else:
                self.at(self.times[self.next] - self.t0 - self.late0)
            self.states[2 * self.next], self.states[2 * self.next + 1] = self.g, self.u
            self.next += 1

    def note(self, before: float, following: float, impulse: float, kind: int) -> None:
        """A row of the log."""
        k = self.rows * COLUMNS
        self.log[k], self.log[k + 1], self.log[k + 2] = self.t, 0.0, before
        self.log[k + 3], self.log[k + 4], self.log[k + 5] = following, impulse, kind
        self.rows += 1
