"""Several contacts and joints at one state, as kernels: gaps, Jacobians, biases and the Delassus matrix.

With the rows R of joints (first) and contacts (after them), the rate of row i is R_i v + rate_i and its acceleration
R_i a + bias_i; D = R M^-1 R^T is the Delassus matrix. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth
Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import assign
from lcpstep.dynamics import bias, gap_rates, gaps, product, total_force
from lcpstep.events.acceleration import free_acceleration, inverse_mass
from lcpstep.events.clock import inside
from lcpstep.events.several.state import (
    BIAS,
    CLOSED,
    FORCE,
    FREE_ACCELERATION,
    GAP,
    LEFT_GAP,
    LEFT_SPEED,
    RATE,
    SHIFTED,
    SPEED,
    WORK,
    Q,
    V,
)


def measure(s: Any, t: float) -> bool:
    """Everything at the state Q, V and time t: gaps, speeds, R, D, free acceleration; False where M is singular."""
    q, v, a = s.state[Q], s.state[V], s.state[FREE_ACCELERATION]
    n_j, n_c = len(s.J), len(s.G)
    side = inside(s.x, t)
    total_force(s.model, side, q, v, s.state[FORCE])
    if not free_acceleration(s, side, q, v, a):
        return False
    if n_c > 0:
        gaps(s.model, t, q, v, s.contact[GAP])
    if n_j > 0:
        gaps(s.joints, t, q, v, s.joint[GAP])
    biases(s, s.model, s.G, s.contact, side, q, v)
    biases(s, s.joints, s.J, s.joint, side, q, v)
    constraint_rows(s, t, q, v)
    for i in range(n_j + n_c):
        delassus(s, i)
        for j in range(i + 1):
            s.D[i, j] = s.D[j, i] = product(s.R, s.MR[i], j)
    for i in range(n_j):
        s.joint[SPEED, i] = product(s.R, v, i) + s.joint[RATE, i]
    for i in range(n_c):
        s.contact[SPEED, i] = product(s.R, v, n_j + i) + s.contact[RATE, i]
        if not math.isfinite(s.contact[SPEED, i] + s.contact[GAP, i] + s.contact[BIAS, i]):
            return False
    return True


def measure_on(s: Any, t: float) -> bool:
    """`measure`, with the gaps and speeds of closed contacts exactly zero."""
    if not measure(s, t):
        return False
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 1:
            s.contact[GAP, c] = s.contact[SPEED, c] = 0.0
    return True


def measure_again(s: Any, t: float) -> bool:
    """`measure`, keeping the gaps and speeds that are known better."""
    for c in range(len(s.G)):
        s.contact[LEFT_GAP, c], s.contact[LEFT_SPEED, c] = s.contact[GAP, c], s.contact[SPEED, c]
    if not measure(s, t):
        return False
    for c in range(len(s.G)):
        s.contact[GAP, c], s.contact[SPEED, c] = s.contact[LEFT_GAP, c], s.contact[LEFT_SPEED, c]
    return True


def constraint_rows(s: Any, t: float, q: Any, v: Any) -> None:
    """Jacobians of joints and contacts into R, and their rates at rest."""
    n_j, n_c = len(s.J), len(s.G)
    if n_j > 0:
        gap_rates(s.joints, t, q, v, s.J, s.joint[RATE])
        for i in range(n_j):
            for k in range(len(q)):
                s.R[i, k] = s.J[i, k]
    if n_c > 0:
        gap_rates(s.model, t, q, v, s.G, s.contact[RATE])
        for i in range(n_c):
            for k in range(len(q)):
                s.R[n_j + i, k] = s.G[i, k]


def biases(s: Any, model: Any, G: Any, now: Any, t: float, q: Any, v: Any) -> None:
    """(dG/dt) v + d(rate)/dt along the motion, for all rows of a model; G is overwritten."""
    if len(G) > 0:
        bias(model, t, q, v, s.state[WORK], G, now[SHIFTED], now[BIAS])


def bias_of(s: Any, i: int) -> float:
    """Bias of a row."""
    n_j = len(s.J)
    return s.joint[BIAS, i] if i < n_j else s.contact[BIAS, i - n_j]


def delassus(s: Any, i: int) -> None:
    """Row i of M^-1 R^T."""
    MR = s.MR[i]
    assign(MR, s.R[i])
    inverse_mass(s, MR)
