"""The floor: Moreau's theta-method written by hand for one scene each, theta = 1/2, everything a scalar.

No library code, no callback, no work arrays, no general contact: what a patient person would write for this one
scene and nothing else. A general library is measured by how little it adds to these. The kernels make the same
steps as `lcpstep.Moreau(h, theta=0.5)` on the scenes' default parameters, to rounding.

Every kernel runs `n` steps from t = 0 and returns (q, v, number of impacts, time of the first impact). States
t, q, v, p go into the four columns of `out` where it has n + 1 rows; with no rows nothing is stored.
"""

from __future__ import annotations

import math

import numba
import numpy as np

OPTIONS = {"error_model": "numpy", "nogil": True}

# Cam-follower: mass, stiffness, restitution, and the arcs of the cam (angle, centre, radius) [kg, N/m, m, rad]
MASS, STIFFNESS, R = 1.221, 1430.8, 0.8
BASE, TOP = 0.40 - 0.3, 0.55393320723821 - 0.3
FLANK_KAPPA, FLANK_RHO = 0.45, 0.85
NOSE_KAPPA, NOSE_RHO, NOSE_PHI = 0.40393320723821, 0.15, math.pi / 9
LIFT = math.pi / 2
NOSE, DWELL = LIFT + 1.050328174371336, LIFT + 1.22173047639603
TWO_PI = 2.0 * math.pi
# Bouncing ball and impact oscillator
GRAVITY = 9.81
ZETA, OMEGA, AMPLITUDE = 0.05, 2.0, 1.0


@numba.njit(**OPTIONS)
def cam_force(t, omega, period):
    """-(m c'' + k c) of the cam at time t, the derivative by time."""
    beta = omega * (t - period * math.floor(t / period)) + LIFT
    if beta > TWO_PI:
        beta -= TWO_PI
    if beta > math.pi:
        beta = TWO_PI - beta
    if beta < LIFT:  # a motion that begins at the corner goes on beyond it
        return -STIFFNESS * BASE
    if beta <= NOSE:
        a, b, rho2 = -FLANK_KAPPA * math.sin(beta), FLANK_KAPPA * math.cos(beta), FLANK_RHO * FLANK_RHO
    elif beta <= DWELL:
        a, b = -NOSE_KAPPA * math.cos(beta + NOSE_PHI), -NOSE_KAPPA * math.sin(beta + NOSE_PHI)
        rho2 = NOSE_RHO * NOSE_RHO
    else:
        return -STIFFNESS * TOP
    root2 = rho2 - b * b
    root = math.sqrt(root2)
    lift = a + root - 0.3
    second = -a - ((a * a - b * b) * root2 + (a * b) ** 2) / (root * root2)
    return -(MASS * omega * omega * second + STIFFNESS * lift)


@numba.njit(**OPTIONS)
def cam_follower(h, n, out, rpm=358.0):
    omega, period = TWO_PI * rpm / 60.0, 60.0 / rpm
    inverse = 1.0 / (MASS + 0.25 * h * h * STIFFNESS)
    A_q, A_v, A_f = inverse * h * STIFFNESS, inverse * 0.5 * h * h * STIFFNESS, 0.5 * h * inverse
    q, v, force, impacts, first, store = 0.4, 0.4, cam_force(0.0, omega, period), 0, math.nan, len(out) > 0
    for i in range(n):
        next_force = cam_force(h * (i + 1), omega, period)
        v_next, p = v + A_f * (force + next_force) - A_q * q - A_v * v, 0.0
        if q + 0.5 * h * v <= 0.0 and v_next < -R * v:
            p = -(v_next + R * v) / inverse
            v_next += inverse * p
            first = h * (i + 1) if impacts == 0 else first
            impacts += 1
        q += 0.5 * h * (v + v_next)
        v, force = v_next, next_force
        if store:
            out[i + 1, 0], out[i + 1, 1], out[i + 1, 2], out[i + 1, 3] = h * (i + 1), q, v, p
    return q, v, impacts, first


@numba.njit(**OPTIONS)
def bouncing_ball(h, n, out, h0=1.0):
    q, v, impacts, first, store = h0, 0.0, 0, math.nan, len(out) > 0
    for i in range(n):
        v_next, p = v - h * GRAVITY, 0.0
        if q + 0.5 * h * v <= 0.0 and v_next < -R * v:
            p = -(v_next + R * v)
            v_next += p
            first = h * (i + 1) if impacts == 0 else first
            impacts += 1
        q += 0.5 * h * (v + v_next)
        v = v_next
        if store:
            out[i + 1, 0], out[i + 1, 1], out[i + 1, 2], out[i + 1, 3] = h * (i + 1), q, v, p
    return q, v, impacts, first


@numba.njit(**OPTIONS)
def impact_oscillator(h, n, out):
    inverse = 1.0 / (1.0 + h * ZETA + 0.25 * h * h)
    A_q, A_v, A_f = inverse * h, inverse * (2.0 * h * ZETA + 0.5 * h * h), 0.5 * h * inverse * AMPLITUDE
    q, v, force, impacts, first, store = -0.5, 0.0, 1.0, 0, math.nan, len(out) > 0
    for i in range(n):
        next_force = math.cos(OMEGA * (h * (i + 1)))
        v_next, p = v + A_f * (force + next_force) - A_q * q - A_v * v, 0.0
        if -q - 0.5 * h * v <= 0.0 and v_next > -R * v:
            p = (v_next + R * v) / inverse
            v_next -= inverse * p
            first = h * (i + 1) if impacts == 0 else first
            impacts += 1
        q += 0.5 * h * (v + v_next)
        v, force = v_next, next_force
        if store:
            out[i + 1, 0], out[i + 1, 1], out[i + 1, 2], out[i + 1, 3] = h * (i + 1), q, v, p
    return q, v, impacts, first


KERNELS = {
    "bouncing-ball": bouncing_ball,
    "impact-oscillator": impact_oscillator,
    "cam-follower": cam_follower,
}
NOTHING = np.zeros((0, 4))


def stored(name: str, h: float, n: int) -> np.ndarray:
    """The motion (t, q, v, p) of n steps, its first row the initial state."""
    out = np.empty((n + 1, 4))
    start = {"bouncing-ball": (1.0, 0.0), "impact-oscillator": (-0.5, 0.0), "cam-follower": (0.4, 0.4)}
    out[0] = 0.0, *start[name], 0.0
    KERNELS[name](h, n, out)
    return out
