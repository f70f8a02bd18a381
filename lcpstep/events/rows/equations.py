"""Joints, contacts and tangents at one state, as kernels: Jacobians, rates, biases and the Delassus matrix.

A state is y = (q, v). The velocity of row i is R_i v + rate_i, its acceleration R_i a + bias_i; D = R M^-1 R^T is the
Delassus matrix.
Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.events.rows.state import Rows
from lcpstep.kernels.acceleration import divide_by_mass, response
from lcpstep.kernels.biases import bias
from lcpstep.kernels.dynamics import gap_rates, gaps, total_force
from lcpstep.kernels.linear import uncouple_two
from lcpstep.kernels.model import Model
from lcpstep.kernels.sudden import JUMP
from lcpstep.kernels.vectors import copy, filled, product, product_at
from lcpstep.pointers import Doubles, abs, after, min

BENDS = 8.0  # times what the rate of a gap changes by just beside a corner: that is no jump
BITS = 62  # of a whole number that kernels count by, its sign left aside


def free_motion(s: Rows, t: float, y: Doubles, a: Doubles) -> bool:
    """A <- M^-1 f, f into `force`; False where M is singular or f is not finite."""
    side, q, v = s.inside(t), y, after(y, s.n_q)
    total_force(s.model, side, q, v, s.force)
    copy(a, s.force, s.n_q)
    return divide_by_mass(s.model, side, q, v, s.M, s.work, a)


def measure_rates(s: Rows, t: float, y: Doubles) -> None:
    """Jacobians of all rows into R, and their rates at rest, unless these are known and never change."""
    if s.known and not s.moving:
        return
    if s.n_j > 0:
        rates_on_side(s, s.joints, 0, t, y, after(y, s.n_q))
    if s.n_c > 0:
        rates_on_side(s, s.model, s.n_j, t, y, after(y, s.n_q))
    if s.n_t > 0:
        rates_on_side(s, s.tangents, s.n_j + s.n_c, t, y, after(y, s.n_q))


def rates_on_side(s: Rows, model: Model, first: int, t: float, q: Doubles, v: Doubles) -> None:
    """The same of one model, from row `first` on, on the side of a corner that the motion is on.

    At the corner itself a callback may answer for the other side. Rates are those of the straight line through two
    times inside then: no digit is lost, contacts may rest.
    """
    side, R, rate = s.inside(t), after(s.R, first * s.n_q), after(s.rate, first)
    if side != t:
        gap_rates(model, side, q, v, R, s.near)
        gap_rates(model, 2.0 * side - t, q, v, R, s.further)
    gap_rates(model, t, q, v, R, rate)
    for i in range(model.n_c if side != t else 0):
        jump, size = abs(s.near[i] - rate[i]), abs(s.near[i]) + abs(rate[i])
        if jump > JUMP * size + BENDS * abs(s.further[i] - s.near[i]):
            rate[i] = 2.0 * s.near[i] - s.further[i]


def measure_biases(s: Rows, t: float, y: Doubles) -> None:
    """(dR/dt) v + d(rate)/dt along the motion, of all rows, unless these are known and never change."""
    if s.known and not s.moving:
        return
    s.on_joints = False
    if s.n_j > 0:
        biases_of(s, s.joints, 0, t, y, after(y, s.n_q))
    if s.n_c > 0:
        biases_of(s, s.model, s.n_j, t, y, after(y, s.n_q))
    if s.n_t > 0:
        biases_of(s, s.tangents, s.n_j + s.n_c, t, y, after(y, s.n_q))


def biases_of(s: Rows, model: Model, first: int, t: float, q: Doubles, v: Doubles) -> None:
    """The same of one model, from row `first` on."""
    bias(model, s.inside(t), s.low, s.high, q, v, s.shifted, s.G, s.near, after(s.bias, first))


def list_gaps(s: Rows, t: float, y: Doubles, gap: Doubles) -> None:
    """Gaps of joints and contacts."""
    if s.n_j > 0:
        gaps(s.joints, t, y, after(y, s.n_q), gap)
    if s.n_c > 0:
        gaps(s.model, t, y, after(y, s.n_q), after(gap, s.n_j))


def respond(s: Rows) -> None:
    """What an impulse on each row does, and the Delassus matrix; the mass matrix must be that of `free_motion`."""
    if s.known:
        return
    s.on_joints, s.known = False, s.fixed
    for i in range(s.n_r):
        respond_to(s, i)
        couple(s, i, i)
        s.reach[i] = reach_of(after(s.R, i * s.n_q), s.n_q)
        moved = reach_of(after(s.MR, i * s.n_q), s.n_q)
        for j in range(i):
            if s.reach[j] & moved == 0:
                s.D[i * s.n_r + j] = s.D[j * s.n_r + i] = 0.0
            else:
                couple(s, i, j)
                uncouple_two(s.D, s.R, s.MR, i, j, s.n_r, s.n_q)


def reach_of(x: Doubles, n: int) -> int:
    """The entries of x that are not zero, each a bit; of many coordinates one stands for several."""
    found, bit = 0, 1
    for j in range(n):
        if x[j] != 0.0:
            found |= bit << (j % BITS)
    return found


def respond_held(s: Rows) -> None:
    """The same of the rows held alone, and of those whose forces come with theirs."""
    for m in range(s.n_held):
        i = s.row[m]
        respond_to(s, i)
        for k in range(m + 1):
            couple(s, i, s.row[k])
    for m in range(s.n_held if s.n_t > 0 else 0):
        i = s.row[m]
        if s.share[i] != 0.0:
            respond_to(s, other(s, i))
            for k in range(s.n_held):
                couple(s, other(s, i), s.row[k])


def couple(s: Rows, i: int, j: int) -> None:
    """Entries i, j of the Delassus matrix, by what an impulse on row i does, that `respond_to` has just found."""
    does = after(s.MR, i * s.n_q)
    s.D[i * s.n_r + j] = s.D[j * s.n_r + i] = product_at(s.R, does, j, s.n_q, s.moved, s.n_moved)


def other(s: Rows, i: int) -> int:
    """The tangent of normal i, the normal of tangent i."""
    return i + s.n_c if i < s.n_j + s.n_c else i - s.n_c


def respond_to(s: Rows, i: int) -> None:
    """What an impulse on row i does."""
    response(s.model, s.M, s.work, after(s.R, i * s.n_q), after(s.MR, i * s.n_q))
    s.n_moved = filled(after(s.MR, i * s.n_q), s.n_q, s.moved)


def velocity_of(s: Rows, i: int, v: Doubles) -> float:
    """The velocity of row i under v."""
    return product(s.R, v, i, s.n_q) + s.rate[i]


def acceleration_of(s: Rows, i: int, a: Doubles) -> float:
    """The acceleration of row i under a."""
    return product(s.R, a, i, s.n_q) + s.bias[i]


def size_of(s: Rows, i: int, constant: float, x: Doubles) -> float:
    """Size of the terms of R_i x + constant, their signs left aside."""
    size = abs(constant)
    for j in range(s.n_q):
        size += abs(s.R[i * s.n_q + j] * x[j])
    return size


def size_of_acceleration(s: Rows, i: int, a: Doubles) -> float:
    """Size of the terms of row i's acceleration under a, and under the free one."""
    size = abs(s.bias[i])
    for j in range(s.n_q):
        size += abs(s.R[i * s.n_q + j]) * (abs(a[j]) + abs(s.a_free[j]))
    return size


def least_gap(s: Rows, i: int, q: Doubles) -> float:
    """What row i can change of itself without moving a coordinate by more than its tolerance."""
    return least_effect(s, i, q, s.far)


def least_speed(s: Rows, i: int, v: Doubles) -> float:
    """The same of its velocity."""
    return least_effect(s, i, v, s.fast)


def least_effect(s: Rows, i: int, x: Doubles, size: float) -> float:
    """What row i can change of itself without changing an x by more than its tolerance, in whatever unit it has.

    size : of all x in the metric of M, of which it moves none by more than rtol, where that is less than atol
    Zero where it depends on no coordinate, as in the middle of a bowl.
    """
    own, least = s.D[i * s.n_r + i], -1.0
    most = s.rtol * size * sqrt(own)
    for j in range(s.n_q):
        moved = abs(s.MR[i * s.n_q + j])
        if moved > 0.0:  # however little: a product with it might be zero
            here = min(s.atol * own / moved, most) + s.rtol * abs(x[j]) * own / moved
            least = here if least < 0.0 or here < least else least
    return least if least > 0.0 else 0.0
