"""Free flight and rest of one linear degree of freedom above a flat obstacle, in closed form, as kernels.

    y'' + 2 delta y' + w2 y = f0 + fc cos(Omega t) + fs sin(Omega t),   y = q + c(t),   g = offset + G q - s(t)

A flight starts at the base time T0 and can be asked for the gap, its velocity and its acceleration at any time tau
after it. On the obstacle, alpha is the acceleration that the gap would have without the contact force: the contact
lasts while alpha <= 0. Source: `oscillator`; G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.5 and 3.16.

All numbers of a flight lie in one array x: what a kernel is handed is then short, and a million flights are the rows
of a matrix.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call, inline
from lcpstep.events.clock import HIGH, T0, find_corners, inside, start_at
from lcpstep.events.contact import CLOSED, MODE, N_CONTACT, ON_SURFACE, SPEED0
from lcpstep.events.flight.oscillator import fundamental
from lcpstep.model import ABSENT

# Places in x after those of clock and contact. Constants of the scene:
DELTA, W2, F0, X, Y, OMEGA, FC, FS, G, OFFSET, R, RESPONSE, CONTACT = range(N_CONTACT, N_CONTACT + 13)
SCAN, RTOL, ATOL, T_END = range(N_CONTACT + 13, N_CONTACT + 17)
# Above the first, G times the absolute position is clear of the obstacle at all times; the second bounds the part of
# the gap acceleration that comes from frame and obstacle
CLEAR, BEND = range(N_CONTACT + 17, N_CONTACT + 19)
# The flight at hand: the absolute state at its base less the steady oscillation; the state at its base; its largest
# gap acceleration so far
Z0, DZ0, Q0, V0, PEAK = range(N_CONTACT + 19, N_CONTACT + 24)
# The time after the base last asked for, and the absolute motion there
TAU, Y_TAU, W_TAU, A_TAU = range(N_CONTACT + 24, N_CONTACT + 28)
# How large the positions are of which the gap is the difference, and the velocities of what moves by itself; the gap
# at the base, where that is known better than by a difference; the cubic of the acceleration, see `near`
SIZE, RATE, GAP0, C1, C2, C3 = range(N_CONTACT + 28, N_CONTACT + 34)
N_NUMBERS = N_CONTACT + 34


@by_address
class Flight(NamedTuple):
    """One linear degree of freedom and its obstacle, as kernels see them."""

    x: Any  # (N_NUMBERS,) see above
    frame: Any  # callback or its address: c, c', c''
    motion: Any  # callback or its address: s, s', s''
    p: Any
    corners: Any  # (m,) in [0, period)
    now: Any  # (1, 3), work space of the callbacks
    q: Any  # (1,) the state last asked for
    v: Any


@inline
def steady(x: Any, t: float) -> tuple[float, float]:
    """The steady oscillation and its velocity."""
    if x[OMEGA] == 0.0:
        return 0.0, 0.0
    cosine, sine = math.cos(x[OMEGA] * t), math.sin(x[OMEGA] * t)
    return x[X] * cosine + x[Y] * sine, x[OMEGA] * (x[Y] * cosine - x[X] * sine)


@inline
def absolute(x: Any, tau: float) -> None:
    """Position, velocity and acceleration of the free motion at tau after the base, into x[Y_TAU .. A_TAU].

    Those last asked for are still there: on the two sides of a corner they are the same.
    """
    if tau == x[TAU]:
        return
    S, dS, P = fundamental(x[DELTA], x[W2], tau)
    z = x[Z0] * (dS + 2.0 * x[DELTA] * S) + x[DZ0] * S + x[F0] * P
    dz = -x[W2] * x[Z0] * S + x[DZ0] * dS + x[F0] * S
    y, dy = steady(x, x[T0] + tau)
    x[TAU], x[Y_TAU], x[W_TAU] = tau, z + y, dz + dy
    x[A_TAU] = x[F0] - 2.0 * x[DELTA] * dz - x[W2] * z - x[OMEGA] * x[OMEGA] * y


@inline
def moved(s: Any, f: Any, t: float) -> tuple[float, float, float]:
    """Displacement of the frame or of the obstacle at time t with its derivatives, from its side of a corner."""
    side = inside(s.x, t)
    call(f, side, s.q, s.v, s.p, s.now)
    beyond = t - side
    return s.now[0, 0] + s.now[0, 1] * beyond, s.now[0, 1] + s.now[0, 2] * beyond, s.now[0, 2]


@inline
def free(s: Any, tau: float) -> tuple[float, float, float]:
    """Gap, gap velocity and gap acceleration at tau after the base of the flight; the state into s.q, s.v."""
    x = s.x
    t = x[T0] + tau
    absolute(x, tau)
    q, v, a = x[Y_TAU], x[W_TAU], x[A_TAU]
    if s.frame != ABSENT:
        c, dc, ddc = moved(s, s.frame, t)
        q, v, a = q - c, v - dc, a - ddc
    s.q[0], s.v[0] = q, v
    g, u, alpha = x[OFFSET] + x[G] * q, x[G] * v, x[G] * a
    if s.motion != ABSENT:
        c, dc, ddc = moved(s, s.motion, t)
        g, u, alpha = g - c, u - dc, alpha - ddc
    return g, u, alpha


def on_obstacle(s: Any, t: float, u: float) -> tuple[float, float, float]:
    """Absolute position and velocity on the obstacle when the gap velocity is u, and the gap acceleration alpha.

    The state relative to the frame goes into s.q, s.v.
    """
    x = s.x
    q, v, bias = -x[OFFSET] / x[G], u / x[G], 0.0
    if s.motion != ABSENT:
        c, dc, ddc = moved(s, s.motion, t)
        q, v, bias = q + c / x[G], v + dc / x[G], bias - ddc
    s.q[0], s.v[0] = q, v
    if s.frame != ABSENT:
        c, dc, ddc = moved(s, s.frame, t)
        q, v, bias = q + c, v + dc, bias - x[G] * ddc
    a = x[F0] - 2.0 * x[DELTA] * v - x[W2] * q
    if x[OMEGA] != 0.0:
        side = inside(x, t)
        a += x[FC] * math.cos(x[OMEGA] * side) + x[FS] * math.sin(x[OMEGA] * side)
    return q, v, x[G] * a + bias


def leave_from(s: Any, t: float, y: float, w: float) -> None:
    """Begin a flight at time t with the absolute state y, w."""
    x = s.x
    rest, rest_velocity = steady(x, t)
    x[Z0], x[DZ0] = y - rest, w - rest_velocity
    start_at(x, t)
    x[ON_SURFACE], x[SPEED0], x[GAP0] = 0.0, 0.0, 0.0
    x[TAU] = math.nan


def rebase(s: Any, t: float) -> None:
    """Begin a flight at time t with the state s.q, s.v."""
    y, w = s.q[0], s.v[0]
    s.x[Q0], s.x[V0] = y, w
    if s.frame != ABSENT:
        c, dc, _ = moved(s, s.frame, t)
        y += c
        w += dc
    leave_from(s, t, y, w)


def state_at(s: Any, t: float) -> None:
    """The state at time t of the flight or rest at hand, into s.q, s.v."""
    if t > s.x[HIGH]:
        find_corners(s, t)
    if s.x[MODE] == CLOSED:
        on_obstacle(s, t, 0.0)
    else:
        free(s, t - s.x[T0])
