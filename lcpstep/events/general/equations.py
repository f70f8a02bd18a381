"""Contacts and joints at one state, as kernels: gaps, Jacobians, biases and the Delassus matrix.

With the rows R of joints (first) and contacts (after them), the rate of row i is R_i v + rate_i and its acceleration
R_i a + bias_i; D = R M^-1 R^T is the Delassus matrix. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth
Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.general.state import Mechanism, Rows
    from lcpstep.kernels.acceleration import divide_by_mass, response
    from lcpstep.kernels.dynamics import bias, gap_rates, gaps, total_force
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import Doubles, abs, after


JUMPS = 1e-9  # of velocities: a rate of a gap that changes by less at a corner does so by rounding
BENDS = 8.0  # times what it changes by just beside the corner: neither is that a jump


def measure(s: Mechanism, t: float) -> bool:
    """Everything at the state q, v and time t: gaps, speeds, R, D, free acceleration; False where M is singular."""
    q, v, a = s.q, s.v, s.a_free
    n_j, n_c = s.n_j, s.n_c
    side = s.inside(t)
    total_force(s.model, side, q, v, s.force)
    copy(a, s.force, s.n_q)
    if not divide_by_mass(s.model, side, q, v, s.M, s.work, a):
        return False
    if n_c > 0:
        gaps(s.model, t, q, v, s.contact.gap)
    if n_j > 0:
        gaps(s.joints, t, q, v, s.joint.gap)
    biases(s, s.model, s.contact, side, q, v)
    biases(s, s.joints, s.joint, side, q, v)
    constraint_rows(s, t, q, v)
    for i in range(n_j + n_c):
        response(s.model, s.M, s.work, after(s.R, i * s.n_q), after(s.MR, i * s.n_q))
        for j in range(i + 1):
            s.D[i * s.n_r + j] = s.D[j * s.n_r + i] = product(s.R, after(s.MR, i * s.n_q), j, s.n_q)
    for i in range(n_j):
        s.joint.speed[i] = product(s.R, v, i, s.n_q) + s.joint.rate[i]
    for i in range(n_c):
        s.contact.speed[i] = product(s.R, v, n_j + i, s.n_q) + s.contact.rate[i]
        size = s.contact.speed[i] + s.contact.gap[i] + s.contact.bias[i]
        if size - size != 0.0:
            return False
    return True


def measure_on(s: Mechanism, t: float) -> bool:
    """`measure`, with the gaps and speeds of closed contacts exactly zero."""
    if not measure(s, t):
        return False
    for c in range(s.n_c):
        if s.contact.closed[c] == 1:
            s.contact.gap[c] = s.contact.speed[c] = 0.0
    return True


def measure_again(s: Mechanism, t: float) -> bool:
    """`measure`, keeping the gaps and speeds that are known better."""
    for c in range(s.n_c):
        s.left.gap[c], s.left.speed[c] = s.contact.gap[c], s.contact.speed[c]
    if not measure(s, t):
        return False
    for c in range(s.n_c):
        s.contact.gap[c], s.contact.speed[c] = s.left.gap[c], s.left.speed[c]
    return True


def constraint_rows(s: Mechanism, t: float, q: Doubles, v: Doubles) -> None:
    """Jacobians of joints and contacts into R, and their rates at rest, on their side of a corner."""
    if s.n_j > 0:
        rates_on_side(s, s.joints, s.joint, t, q, v)
    if s.n_c > 0:
        rates_on_side(s, s.model, s.contact, t, q, v)


def rates_on_side(s: Mechanism, model: Model, now: Rows, t: float, q: Doubles, v: Doubles) -> None:
    """The same of one model. A callback tells on a corner of either side; where that is the other one, the rates here
    are those of the straight line through two times inside, for there is no digit to lose: contacts may be at rest.
    """
    side = s.inside(t)
    if side != t:
        gap_rates(model, side, q, v, now.G, now.near)
        gap_rates(model, 2.0 * side - t, q, v, now.G, now.shifted)
    gap_rates(model, t, q, v, now.G, now.rate)
    for i in range(now.n if side != t else 0):
        jump, size = abs(now.near[i] - now.rate[i]), abs(now.near[i]) + abs(now.rate[i])
        if jump > JUMPS * size + BENDS * abs(now.shifted[i] - now.near[i]):
            now.rate[i] = 2.0 * now.near[i] - now.shifted[i]


def biases(s: Mechanism, model: Model, now: Rows, t: float, q: Doubles, v: Doubles) -> None:
    """(dG/dt) v + d(rate)/dt along the motion, for all rows of a model; G is overwritten."""
    if now.n > 0:
        bias(model, t, s.low, s.high, q, v, s.work, now.G, now.shifted, now.bias)


def bias_of(s: Mechanism, i: int) -> float:
    """Bias of a row."""
    n_j = s.n_j
    return s.joint.bias[i] if i < n_j else s.contact.bias[i - n_j]
