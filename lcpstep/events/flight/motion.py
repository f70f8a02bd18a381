"""Free flight and rest of one linear degree of freedom above a flat obstacle, in closed form, as kernels.

    y'' + 2 delta y' + w2 y = f0 + fc cos(Omega t) + fs sin(Omega t),   y = q + c(t),   g = offset + G q - s(t)

A flight starts at the base time t0 and can be asked for the gap, its velocity and its acceleration at any time tau
after it. On the obstacle, alpha is the acceleration that the gap would have without the contact force: the contact
lasts while alpha <= 0. Source: `oscillator`; G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.5 and 3.16.
"""

from __future__ import annotations

from math import cos, sin
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.events.flight.contact import CLOSED, FREE
from lcpstep.events.flight.oscillator import Oscillator, fundamental
from lcpstep.kernels.bracket import Bracket
from lcpstep.kernels.clock import Clock
from lcpstep.kernels.function import Function
from lcpstep.kernels.model import Model
from lcpstep.kernels.turn import Turn
from lcpstep.pointers import inf, nan


class Flight(Clock):
    """One linear degree of freedom and its obstacle.

    delta, w2, f0, X, Y, Omega, fc, fs   of the equation of motion and of its steady oscillation, see `oscillator`
    contact, G, offset, r, response      whether there is an obstacle; its gap; restitution; G M^-1 G^T
    frame, motion                        functions: c, c', c'' and s, s', s''
    scan, rtol, atol                     longest interval of the scan; tolerances
    clear, bend     above the first, G times the absolute position is clear of the obstacle at all times; the second
        bounds the part of the gap acceleration that comes from frame and obstacle
    size, speed     how large the positions are of which the gap is the difference, and the velocities of what moves
        by itself
    now, begun      the time reached; whether the state there is known to be free, closed or struck
    mode            whether the contact is FREE or CLOSED
    g, u, alpha     gap, its velocity and acceleration there
    impulse : (n_c,)    since the last kept state
    hold            no release before it
    on_surface      whether the base of the flight lies on the surface; with g0, u0, alpha0: gap, its velocity and
        acceleration at the base, where these are known better than by a difference
    z0, dz0, q0, v0     the absolute state at the base less the steady oscillation; the state there
    peak            the largest gap acceleration of the flight so far
    tau, y_tau, w_tau, a_tau    the time after the base last asked for, and the absolute motion there
    c1, c2, c3      the cubic of the acceleration, see `near`
    bracket, turn   in which a root, or a turn, is sought
    q, v : (1,)     the state last asked for
    moving : (3,)   work space of the functions

    Parameters
    ----------
    t_span : (start, end);  corners, period : see `Clock`
    model : Model;  o : Oscillator
    given : scan, rtol, atol, clear, bend, size and speed by name
    record, tally : what is kept of the motion, and counted; none for a flight that is only asked
    """

    def __init__(
        self,
        t_span: tuple[float, float],
        corners: Any,
        period: float,
        model: Model,
        o: Oscillator,
        given: dict[str, float],
        record: Any = None,
        tally: Any = None,
    ) -> None:
        Clock.__init__(self, t_span, corners, period)
        self.model, self.record, self.tally = model, record, tally
        self.frame, self.motion = model.frame, model.motion
        mass = self.model.M[0]
        self.delta, self.w2, self.f0 = o.delta, o.w2, o.f0
        self.X, self.Y, self.Omega = o.X, o.Y, o.Omega
        self.fc, self.fs = self.model.cosine[0] / mass, self.model.sine[0] / mass
        self.contact = model.n_c == 1
        self.G = self.offset = self.r = self.response = 0.0
        if self.contact:
            self.G, self.offset = self.model.G[0], self.model.offset[0]
            self.r = self.model.restitution[0]
            self.response = self.G * self.G / mass
        self.scan, self.rtol, self.atol = given["scan"], given["rtol"], given["atol"]
        self.clear, self.bend = given["clear"], given["bend"]
        self.size, self.speed = given["size"], given["speed"]
        self.bracket, self.turn = Bracket(), Turn()
        self.state, self.space = np.zeros((2, 1)), np.zeros(4)
        self.q, self.v = doubles(self.state[0]), doubles(self.state[1])
        self.moving, self.impulse = doubles(self.space[:3]), doubles(self.space[3:])
        self.restart(t_span[0], t_span[1])

    def restart(self, t: float, t_end: float) -> None:
        """Nothing is known yet of the motion from time t to t_end but its state, self.q and self.v."""
        self.t0, self.t0_rest, self.rest, self.last_event = t, 0.0, 0.0, -inf
        self.low, self.high = inf, -inf
        self.now, self.t_end, self.mode, self.hold = t, t_end, FREE, -inf
        self.g = self.u = self.alpha = self.impulse[0] = 0.0
        self.begun = self.on_surface = False
        self.g0 = self.u0 = self.alpha0 = self.peak = 0.0
        self.z0 = self.dz0 = self.q0 = self.v0 = 0.0
        self.y_tau = self.w_tau = self.a_tau = self.c1 = self.c2 = self.c3 = 0.0
        self.tau = nan


def steady(s: Flight, t: float) -> tuple[float, float]:
    """The steady oscillation and its velocity."""
    if s.Omega == 0.0:
        return 0.0, 0.0
    cosine, sine = cos(s.Omega * t), sin(s.Omega * t)
    return s.X * cosine + s.Y * sine, s.Omega * (s.Y * cosine - s.X * sine)


def absolute(s: Flight, tau: float) -> None:
    """Position, velocity and acceleration of the free motion at tau after the base, into s.y_tau .. s.a_tau.

    Those last asked for are still there: on the two sides of a corner they are the same.
    """
    if tau == s.tau:
        return
    S, dS, P = fundamental(s.delta, s.w2, tau)
    z = s.z0 * (dS + 2.0 * s.delta * S) + s.dz0 * S + s.f0 * P
    dz = -s.w2 * s.z0 * S + s.dz0 * dS + s.f0 * S
    y, dy = steady(s, s.t0 + tau)
    s.tau, s.y_tau, s.w_tau = tau, z + y, dz + dy
    s.a_tau = s.f0 - 2.0 * s.delta * dz - s.w2 * z - s.Omega * s.Omega * y


def moved(s: Flight, f: Function, t: float) -> tuple[float, float, float]:
    """Displacement of the frame or of the obstacle at time t with its derivatives, from its side of a corner."""
    side = s.inside(t)
    f.fill(side, s.q, s.v, s.moving)
    beyond, rate, acceleration = t - side, s.moving[1], s.moving[2]
    return s.moving[0] + rate * beyond, rate + acceleration * beyond, acceleration


def free(s: Flight, tau: float) -> tuple[float, float, float]:
    """Gap, gap velocity and gap acceleration at tau after the base of the flight; the state into s.q, s.v."""
    t = s.t0 + tau
    absolute(s, tau)
    q, v, a = s.y_tau, s.w_tau, s.a_tau
    if s.frame.given:
        c, dc, ddc = moved(s, s.frame, t)
        q, v, a = q - c, v - dc, a - ddc
    s.q[0], s.v[0] = q, v
    g, u, alpha = s.offset + s.G * q, s.G * v, s.G * a
    if s.motion.given:
        c, dc, ddc = moved(s, s.motion, t)
        g, u, alpha = g - c, u - dc, alpha - ddc
    return g, u, alpha


def on_obstacle(s: Flight, t: float, u: float) -> tuple[float, float, float]:
    """Absolute position and velocity on the obstacle when the gap velocity is u, and the gap acceleration alpha.

    The state relative to the frame goes into s.q, s.v.
    """
    q, v, bias = -s.offset / s.G, u / s.G, 0.0
    if s.motion.given:
        c, dc, ddc = moved(s, s.motion, t)
        q, v, bias = q + c / s.G, v + dc / s.G, bias - ddc
    s.q[0], s.v[0] = q, v
    if s.frame.given:
        c, dc, ddc = moved(s, s.frame, t)
        q, v, bias = q + c, v + dc, bias - s.G * ddc
    a = s.f0 - 2.0 * s.delta * v - s.w2 * q
    if s.Omega != 0.0:
        side = s.inside(t)
        a += s.fc * cos(s.Omega * side) + s.fs * sin(s.Omega * side)
    return q, v, s.G * a + bias


def leave_from(s: Flight, t: float, y: float, w: float) -> None:
    """Begin a flight at time t with the absolute state y, w."""
    rest, rest_velocity = steady(s, t)
    s.z0, s.dz0 = y - rest, w - rest_velocity
    s.start_at(t)
    s.on_surface, s.u0, s.g0 = False, 0.0, 0.0
    s.tau = nan


def rebase(s: Flight, t: float) -> None:
    """Begin a flight at time t with the state s.q, s.v."""
    y, w = s.q[0], s.v[0]
    s.q0, s.v0 = y, w
    if s.frame.given:
        c, dc, _ = moved(s, s.frame, t)
        y += c
        w += dc
    leave_from(s, t, y, w)


def state_at(s: Flight, t: float) -> None:
    """The state at time t of the flight or rest at hand, into s.q, s.v."""
    if t > s.high:
        s.find_corners(t)
    if s.mode == CLOSED:
        on_obstacle(s, t, 0.0)
    else:
        free(s, t - s.t0)
