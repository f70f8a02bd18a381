"""Arcs of one coordinate that sticks to a belt or slides on it under constant friction, in closed form, as kernels.

    slides:  z'' + 2 delta z' + w2 z = f(t) - direction pull        ends where direction (z' + slip) falls to zero
    sticks:  z' = -slip(t),  friction phi = z'' + 2 delta z' + w2 z - f(t)    ends where |phi| rises to `most`

f and slip are constant and harmonic. Sliding velocity and friction rise from the base of an arc on by

    D(tau) = line tau + P1, Q1 terms of the belt + P2, Q2 terms of the force + a S - w2 z0' P

(the last two of what slides; S, P as in `flight.oscillator`), without loss of digits at small tau.
"""

from __future__ import annotations

from math import cos, hypot, sin
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.events.flight.oscillator import envelope, fundamental
from lcpstep.kernels.clock import Clock
from lcpstep.kernels.roundings import NOISE
from lcpstep.pointers import abs, after, inf


class Arc(Clock):
    """One coordinate under way.

    delta, w2, f0, X, Y, Omega, fc, fs    of the equation of motion without friction, see `flight.oscillator`
    slip, slip_cosine, slip_sine, belt    sliding velocity of what is at rest, and its frequency
    pull, most, normal, mass              see `line.Line`
    direction       of sliding; 0 where it sticks
    z, dz           state at the base time
    phi, noise      friction there, over the mass; its rounding, and that of `most`
    end             time after the base at which the arc ends, infinite where it does not within the span
    side            of that end: the direction in which what has stuck will slide
    now             time reached
    stride          longest step between states that are kept by steps
    paid, friction  time after the base up to which impulses are counted; integral of the friction up to there
    place, way : (2,);  q, v : (2,)   q = place + way z;  the state last asked for
    impulse : (2,)  of normal and tangent since the last kept state

    Parameters
    ----------
    line : `line.Line`;  t_span : (start, end);  stride, rtol, atol : float
    record, tally : what is kept of the motion, and counted; none for an arc that is only asked
    """

    def __init__(
        self,
        line: Any,
        t_span: tuple[float, float],
        stride: float,
        rtol: float,
        atol: float,
        record: Any = None,
        tally: Any = None,
    ) -> None:
        Clock.__init__(self, t_span, [], inf)
        o = line.oscillator
        self.delta, self.w2, self.f0 = o.delta, o.w2, o.f0
        self.X, self.Y, self.Omega, self.fc, self.fs = o.X, o.Y, o.Omega, line.fc, line.fs
        self.slip, self.slip_cosine, self.slip_sine, self.belt = line.slip
        self.pull, self.most, self.normal, self.mass = line.pull, line.most, line.normal, line.mass
        self.z, self.dz, self.direction = line.z, line.dz, 0.0
        self.now, self.stride, self.rtol, self.atol = t_span[0], stride, rtol, atol
        self.record, self.tally, self.begun = record, tally, False
        self.end, self.side, self.paid, self.friction = inf, 0.0, 0.0, 0.0
        self.noise = self.phi = self.a = self.line = self.room = self.spring = self.dzeta = 0.0
        self.P1 = self.Q1 = self.P2 = self.Q2 = 0.0
        self.cos1 = self.cos2 = 1.0
        self.sin1 = self.sin2 = 0.0
        self.state, self.space = np.zeros((2, 2)), np.array([*line.place, *line.way, 0.0, 0.0])
        self.q, self.v = doubles(self.state[0]), doubles(self.state[1])
        self.place = doubles(self.space)
        self.way, self.impulse = after(self.place, 2), after(self.place, 4)
        look(self, self.z, self.dz)


def turned(c: float, s: float, half: float) -> tuple[float, float]:
    """By how much cosine and sine of an angle, c and s, change when it grows by twice this half."""
    sine, cosine = sin(half), cos(half)
    return -2.0 * sine * (s * cosine + c * sine), 2.0 * sine * (c * cosine - s * sine)


def look(s: Arc, z: float, dz: float) -> None:
    """The state q, v that has this coordinate and velocity."""
    for j in range(2):
        s.q[j], s.v[j] = s.place[j] + s.way[j] * z, s.way[j] * dz


def rebase(s: Arc, t: float) -> None:
    """The angles of belt and force at time t, where an arc begins, and the friction that would make it stick."""
    s.start_at(t)
    s.paid = s.friction = 0.0
    if s.belt != 0.0:
        s.cos1, s.sin1 = cos(s.belt * t), sin(s.belt * t)
    if s.Omega != 0.0:
        s.cos2, s.sin2 = cos(s.Omega * t), sin(s.Omega * t)
    rate = s.belt * (s.slip_sine * s.cos1 - s.slip_cosine * s.sin1)
    force = s.f0 + s.fc * s.cos2 + s.fs * s.sin2
    damping, spring = 2.0 * s.delta * belt_slip(s), s.w2 * s.z
    s.phi = -rate - damping + spring - force
    terms = abs(s.f0) + abs(s.fc) + abs(s.fs) + abs(rate) + abs(damping) + abs(spring)
    s.noise = NOISE * (s.most + terms)


def belt_slip(s: Arc) -> float:
    """Sliding velocity of what is at rest, at the base time."""
    return s.slip + s.slip_cosine * s.cos1 + s.slip_sine * s.sin1


def set_out(s: Arc, slides: bool) -> None:
    """Coefficients of D for the arc that begins at the base with the direction at hand.

    slides : whether it has a sliding velocity; otherwise that is zero, and rounding of it is left out
    """
    if s.direction == 0.0:
        s.line, s.room, s.a = -s.w2 * s.slip, 0.0, 0.0
        s.P2, s.Q2, over = -s.fc, -s.fs, s.w2 / s.belt - s.belt if s.belt != 0.0 else 0.0
        s.P1 = over * s.slip_sine - 2.0 * s.delta * s.slip_cosine
        s.Q1 = -over * s.slip_cosine - 2.0 * s.delta * s.slip_sine
    else:
        s.line, s.P1, s.Q1 = 0.0, s.slip_cosine, s.slip_sine
        s.P2, s.Q2 = s.Omega * s.Y, -s.Omega * s.X
        zeta = s.z - s.X * s.cos2 - s.Y * s.sin2
        s.dzeta = s.dz - s.P2 * s.cos2 - s.Q2 * s.sin2
        s.spring = s.f0 - s.direction * s.pull - s.w2 * zeta
        s.a = s.spring - 2.0 * s.delta * s.dzeta
        s.room = s.direction * (s.dz + belt_slip(s)) if slides else 0.0


def rise(s: Arc, tau: float) -> tuple[float, float]:
    """D and its rate at tau after the base."""
    D, rate = s.line * tau, s.line
    if s.direction != 0.0:
        S, dS, P = fundamental(s.delta, s.w2, tau)
        D = s.a * S - s.w2 * s.dzeta * P
        rate = s.a * dS - s.w2 * s.dzeta * S
    if s.belt != 0.0:
        c, sn = turned(s.cos1, s.sin1, 0.5 * s.belt * tau)
        D += s.P1 * c + s.Q1 * sn
        rate += s.belt * (s.Q1 * (s.cos1 + c) - s.P1 * (s.sin1 + sn))
    if s.Omega != 0.0:
        c, sn = turned(s.cos2, s.sin2, 0.5 * s.Omega * tau)
        D += s.P2 * c + s.Q2 * sn
        rate += s.Omega * (s.Q2 * (s.cos2 + c) - s.P2 * (s.sin2 + sn))
    return D, rate


def bends(s: Arc) -> tuple[float, float, float, float, float]:
    """D'' and D''' at the base, and what |D''|, |D'''| and |D''''| never exceed on the arc.

    The free motion obeys its own equation in every derivative.
    """
    b, o = abs(s.belt), abs(s.Omega)
    b2, o2 = b * b, o * o
    belt, force = b2 * hypot(s.P1, s.Q1), o2 * hypot(s.P2, s.Q2)
    here = -b2 * (s.P1 * s.cos1 + s.Q1 * s.sin1) - o2 * (s.P2 * s.cos2 + s.Q2 * s.sin2)
    jerk = b2 * s.belt * (s.P1 * s.sin1 - s.Q1 * s.cos1) + o2 * s.Omega * (s.P2 * s.sin2 - s.Q2 * s.cos2)
    second, third, fourth = belt + force, b * belt + o * force, b2 * belt + o2 * force
    if s.direction != 0.0 and s.w2 > s.delta * s.delta:
        x = -2.0 * s.delta * s.a - s.w2 * s.dzeta
        y = -2.0 * s.delta * x - s.w2 * s.a
        z = -2.0 * s.delta * y - s.w2 * x
        here += x
        jerk += y
        second += envelope(s.delta, s.w2, x, y)
        third += envelope(s.delta, s.w2, y, z)
        fourth += envelope(s.delta, s.w2, z, -2.0 * s.delta * z - s.w2 * y)
    return here, jerk, second, third, fourth


def bend_at(s: Arc, tau: float) -> float:
    """D'' of what slides, at tau after the base."""
    S, dS, P = fundamental(s.delta, s.w2, tau)
    w, rate = s.dzeta + s.a * S - s.w2 * s.dzeta * P, s.a * dS - s.w2 * s.dzeta * S
    bend = -2.0 * s.delta * rate - s.w2 * w
    if s.belt != 0.0:
        c, sn = turned(s.cos1, s.sin1, 0.5 * s.belt * tau)
        bend -= s.belt * s.belt * (s.P1 * (s.cos1 + c) + s.Q1 * (s.sin1 + sn))
    if s.Omega != 0.0:
        c, sn = turned(s.cos2, s.sin2, 0.5 * s.Omega * tau)
        bend -= s.Omega * s.Omega * (s.P2 * (s.cos2 + c) + s.Q2 * (s.sin2 + sn))
    return bend


@cython.ccall
@cython.nogil
def state_at(s: Arc, tau: float) -> tuple[float, float]:
    """Z and z' at tau after the base; the state into q, v."""
    z, dz = s.z, s.dz
    if s.direction != 0.0:
        S, _, P = fundamental(s.delta, s.w2, tau)
        z += s.dzeta * S + s.spring * P
        dz += s.a * S - s.w2 * s.dzeta * P
        if s.Omega != 0.0:
            c, sn = turned(s.cos2, s.sin2, 0.5 * s.Omega * tau)
            z += s.X * c + s.Y * sn
            dz += s.P2 * c + s.Q2 * sn
    else:
        z -= s.slip * tau
        dz = -belt_slip(s)
        if s.belt != 0.0:
            c, sn = turned(s.cos1, s.sin1, 0.5 * s.belt * tau)
            z += (s.slip_sine * c - s.slip_cosine * sn) / s.belt
            dz -= s.slip_cosine * c + s.slip_sine * sn
    look(s, z, dz)
    return z, dz


def friction_until(s: Arc, tau: float) -> float:
    """Integral of the friction from the base to tau after it, over the mass."""
    if s.direction != 0.0:
        return -s.direction * s.pull * tau
    total = (s.phi + 0.5 * s.line * tau) * tau
    if s.belt != 0.0:
        c, sn = turned(s.cos1, s.sin1, 0.5 * s.belt * tau)
        total += (s.P1 * sn - s.Q1 * c) / s.belt - (s.P1 * s.cos1 + s.Q1 * s.sin1) * tau
    if s.Omega != 0.0:
        c, sn = turned(s.cos2, s.sin2, 0.5 * s.Omega * tau)
        total += (s.P2 * sn - s.Q2 * c) / s.Omega - (s.P2 * s.cos2 + s.Q2 * s.sin2) * tau
    return total


def pay(s: Arc, tau: float) -> None:
    """Count the impulses up to tau after the base."""
    total = friction_until(s, tau)
    s.impulse[0] += s.normal * (tau - s.paid)
    s.impulse[1] += s.mass * (total - s.friction)
    s.paid, s.friction = tau, total
