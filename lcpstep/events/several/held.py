"""Rows of contacts and joints that are held at zero, as kernels: their multipliers x.

    M a = f + R^T x,      R a + bias = 0,      D = R M^-1 R^T  (Delassus matrix)

Rows that depend on others before them are left out; an answer is refined with the residual of M a = f + R^T x itself,
for D has lost the digits of large mass ratios. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth
Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

from typing import Any

from lcpstep.dense import grow_factor, largest, solve_factored
from lcpstep.dynamics import gaps, product, total_force
from lcpstep.events.acceleration import free_acceleration, inverse_mass
from lcpstep.events.clock import RESOLUTION, inside
from lcpstep.events.several.equations import bias_of, biases, constraint_rows, delassus
from lcpstep.events.several.state import (
    BIAS,
    CLOSED,
    CURVE,
    FORCE,
    FREE_ACCELERATION,
    GAP,
    HELD_JOINTS,
    HELD_ROWS,
    LOADED,
    MULTIPLIER,
    RATE,
    Q,
    V,
)

REFINEMENTS = 6
PARTED = 1e3  # tolerances by which joints that say the same may differ
DISAGREEMENT = 1e-8  # relative acceleration that joints may not agree about


def hold(s: Any, i: int) -> None:
    """Add row i to the rows held, unless it depends on them as far as rounding lets tell. Factor by Cholesky."""
    k = s.number[HELD_ROWS]
    s.row[k] = i
    if grow_factor(s.D, s.L, s.row, s.doubt, k):
        s.number[HELD_ROWS] = k + 1


def hold_joints(s: Any) -> None:
    """Hold the independent joints, and nothing else."""
    s.number[HELD_ROWS] = 0
    for i in range(len(s.J)):
        hold(s, i)
    s.number[HELD_JOINTS] = s.number[HELD_ROWS]


def hold_contacts(s: Any) -> None:
    """Hold the joints and the closed contacts, those that carry a force first."""
    n_j = len(s.J)
    hold_joints(s)
    for loaded in (1, 0):
        for c in range(len(s.G)):
            if s.mode[CLOSED, c] == 1 and s.mode[LOADED, c] == loaded:
                hold(s, n_j + c)


def hold_again(s: Any, t: float, q: Any, v: Any) -> bool:
    """Jacobians and factor of the same rows at another state; False where they have become dependent."""
    biases(s, s.model, s.G, s.contact, t, q, v)
    biases(s, s.joints, s.J, s.joint, t, q, v)
    constraint_rows(s, t, q, v)
    count = s.number[HELD_ROWS]
    s.number[HELD_ROWS] = 0
    for m in range(count):
        i = s.row[m]
        delassus(s, i)
        for k in range(m + 1):
            j = s.row[k]
            s.D[i, j] = s.D[j, i] = product(s.R, s.MR[i], j)
        hold(s, i)
        if s.number[HELD_ROWS] != m + 1:
            s.number[HELD_ROWS] = count
            return False
    return True


def solve_held(s: Any, k: int, x: Any) -> None:
    """X <- (L L^T)^-1 x for the k rows held."""
    solve_factored(s.L, k, x)


def constrain(s: Any, a: Any) -> None:
    """The acceleration a = M^-1 (f + R^T x) that keeps the rows held; multipliers into `held`.

    `a` comes as M^-1 f, f lies in the state's FORCE.
    """
    k, n = s.number[HELD_ROWS], len(a)
    for m in range(k):
        s.held[m] = 0.0
    for _ in range(REFINEMENTS):
        for m in range(k):
            i = s.row[m]
            s.change[m] = -bias_of(s, i) - product(s.R, a, i)
        solve_held(s, k, s.change)
        if largest(s.change[:k], 0.0) <= 4.0 * RESOLUTION * largest(s.held[:k], 0.0):
            break
        for m in range(k):
            s.held[m] += s.change[m]
        for j in range(n):
            a[j] = 0.0
            for m in range(k):
                a[j] += s.R[s.row[m], j] * s.held[m]
            a[j] += s.state[FORCE, j]
        inverse_mass(s, a)
    # what rounding of large multipliers leaves is taken out of the acceleration, which must stay on the surface
    for m in range(k):
        i = s.row[m]
        s.change[m] = -bias_of(s, i) - product(s.R, a, i)
    solve_held(s, k, s.change)
    for m in range(k):
        for j in range(n):
            a[j] += s.MR[s.row[m], j] * s.change[m]


def note(s: Any, a: Any) -> None:
    """Multipliers of the rows held, and the gap accelerations of all contacts."""
    n_j, n_c = len(s.J), len(s.G)
    for i in range(n_j):
        s.joint[MULTIPLIER, i] = 0.0
    for c in range(n_c):
        s.contact[MULTIPLIER, c] = 0.0
        s.contact[CURVE, c] = product(s.R, a, n_j + c) + bias_of(s, n_j + c)
    for m in range(s.number[HELD_ROWS]):
        i = s.row[m]
        if i < n_j:
            s.joint[MULTIPLIER, i] = s.held[m]
        else:
            s.contact[MULTIPLIER, i - n_j] = s.held[m]
            s.contact[CURVE, i - n_j] = 0.0
    for c in range(n_c):
        if s.mode[CLOSED, c] == 1:
            s.contact[CURVE, c] = 0.0


def right_hand_side(s: Any, t: float, y: Any, dy: Any) -> bool:
    """dy = (v, v') with the rows held; False where it is not finite or the rows have become dependent."""
    n = len(dy) // 2
    q, v, a = y[:n], y[n:], dy[n:]
    t = inside(s.x, t)
    if not free_acceleration(s, t, q, v, a):
        return False
    if s.number[HELD_ROWS] > 0:
        total_force(s.model, t, q, v, s.state[FORCE])
        if not hold_again(s, t, q, v):
            return False
        constrain(s, a)
    for i in range(n):
        dy[i] = v[i]
    return True


def project(s: Any, t: float) -> None:
    """Put Q, V onto the rows held, against the drift of the integration: gaps and rates zero."""
    k, n_j, n = s.number[HELD_ROWS], len(s.J), s.state.shape[1]
    q, v = s.state[Q], s.state[V]
    for level in (0, 0, 1):
        if len(s.G) > 0:
            gaps(s.model, t, q, v, s.contact[GAP])
        if n_j > 0:
            gaps(s.joints, t, q, v, s.joint[GAP])
        if not hold_again(s, t, q, v):
            return
        for m in range(k):
            i = s.row[m]
            if level == 0:
                s.change[m] = -(s.joint[GAP, i] if i < n_j else s.contact[GAP, i - n_j])
            else:
                rate = s.joint[RATE, i] if i < n_j else s.contact[RATE, i - n_j]
                s.change[m] = -product(s.R, v, i) - rate
        solve_held(s, k, s.change)
        for m in range(k):
            for j in range(n):
                s.state[Q if level == 0 else V, j] += s.MR[s.row[m], j] * s.change[m]


def is_held(s: Any, i: int) -> bool:
    """Whether joint i is among the rows held."""
    found = False
    for m in range(s.number[HELD_JOINTS]):
        found = found or s.row[m] == i
    return found


def contradiction(s: Any, a: Any) -> int:
    """The first joint left out whose acceleration is not zero under the others, or -1."""
    for i in range(len(s.J)):
        if not is_held(s, i):
            size = abs(s.joint[BIAS, i])
            for j in range(len(a)):
                size += abs(s.R[i, j]) * (abs(a[j]) + abs(s.state[FREE_ACCELERATION, j]))
            if abs(product(s.R, a, i) + s.joint[BIAS, i]) > DISAGREEMENT * size:
                return i
    return -1


def parted(s: Any) -> int:
    """The first joint left out that the others have not kept closed, or -1; its gap and row those of the state."""
    if s.number[HELD_JOINTS] == len(s.J):
        return -1
    for i in range(len(s.J)):
        size = 0.0
        for j in range(s.state.shape[1]):
            size += abs(s.R[i, j] * s.state[Q, j])
        if not is_held(s, i) and abs(s.joint[GAP, i]) > PARTED * (s.plan.atol + s.plan.rtol * size):
            return i
    return -1
