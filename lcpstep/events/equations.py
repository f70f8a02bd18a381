"""Several contacts and joints at one state, as kernels: Jacobians, accelerations, constraint forces.

With the rows R of joints (first) and contacts (after them), the rate of row i is R_i v + rate_i and its acceleration
R_i a + bias_i. Rows that are held at zero bring the multipliers x of

    M a = f + R^T x,      R a + bias = 0,      D = R M^-1 R^T  (Delassus matrix)

Rows that depend on others before them are left out; an answer is refined with the residual of M a = f + R^T x
itself, for D has lost the digits of large mass ratios. Source: V. Acary, B. Brogliato, Numerical Methods for
Nonsmooth Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address, call
from lcpstep.dense import assign, grow_factor, solve_definite, solve_factored
from lcpstep.dynamics import gap_rates, gaps, product, total_force
from lcpstep.events.flow import DIFFERENCE, free_acceleration, inside
from lcpstep.model import ABSENT

# Rows of Several.state
Q0, V0, Q, V, ACCELERATION, FREE_ACCELERATION, FORCE, WORK = range(8)
N_STATE = 8
# Rows of Several.contact and, the first five, of Several.joint
GAP, SPEED, CURVE, MULTIPLIER, RATE, BIAS, IMPULSE, SHIFTED = range(8)  # CURVE: the gap acceleration
LEFT_GAP, LEFT_SPEED, LEFT_CURVE, LEFT_MULTIPLIER = range(8, 12)  # at the left end of an interval
STRUCK, SINCE, HELD = range(12, 15)  # time of the last impact, since the one before; no release before HELD
LCP_B, LCP_Z, SYNCHRONOUS, CHATTERS = range(
    15, 19
)  # SYNCHRONOUS: gap and speed are those of Q, V; CHATTERS: until this time
N_CONTACT = 19
# Rows of Several.mode
CLOSED, WAS_CLOSED, LOADED = range(3)  # lasting contact; so when last told; carries a force
N_MODE = 3
# Places in Several.number
HELD_ROWS, HELD_JOINTS, CULPRIT, MEMBERS, NEXT, SOUGHT = range(6)  # MEMBERS: contacts of the last problem
N_NUMBER = 6

REFINEMENTS = 6
RESOLUTION = 2.0**-52
NOISE = 64 * RESOLUTION
PARTED = 1e3  # tolerances by which joints that say the same may differ
CONTRADICTION = 1e-8  # relative acceleration that joints may not agree about


@by_address
class Several(NamedTuple):
    """State, Jacobians and multipliers of a system with several contacts and joints, and work space."""

    x: Any  # numbers, the first of them those of `flow`
    state: Any  # (N_STATE, n_q)
    contact: Any  # (N_CONTACT, n_c)
    joint: Any  # (SHIFTED + 1, n_j)
    y: Any  # (2 n_q,)
    M: Any  # (n_q, n_q)
    G: Any  # (n_c, n_q)
    J: Any  # (n_j, n_q)
    R: Any  # (n_j + n_c, n_q) both
    MR: Any  # (n_j + n_c, n_q) rows M^-1 R^T
    D: Any  # (n_j + n_c, n_j + n_c) Delassus matrix
    L: Any  # (n_j + n_c, n_j + n_c) Cholesky factor of the rows held
    row: Any  # (n_j + n_c,) rows held
    held: Any  # (n_j + n_c,) their multipliers
    change: Any  # (n_j + n_c,)
    mode: Any  # (N_MODE, n_c)
    number: Any  # integers
    W: Any  # (n_c^2,)
    member: Any  # (n_c,) contacts of the problem at hand
    kept: Any  # (n_j + n_c,) rows held, while others are tried
    doubt: Any  # (n_j + n_c,) relative error of the diagonal of L, in units of rounding


def constraint_rows(model: Any, joints: Any, s: Any, t: float, q: Any, v: Any) -> None:
    """Jacobians of joints and contacts into R, and their rates at rest."""
    n_j, n_c = len(s.J), len(s.G)
    if n_j > 0:
        gap_rates(joints, t, q, v, s.J, s.joint[RATE])
        for i in range(n_j):
            for k in range(len(q)):
                s.R[i, k] = s.J[i, k]
    if n_c > 0:
        gap_rates(model, t, q, v, s.G, s.contact[RATE])
        for i in range(n_c):
            for k in range(len(q)):
                s.R[n_j + i, k] = s.G[i, k]


def biases(model: Any, s: Any, G: Any, now: Any, t: float, q: Any, v: Any) -> None:
    """(dG/dt) v + d(rate)/dt along the motion, for all rows of a model; G is overwritten."""
    n = len(G)
    if n == 0:
        return
    out = now[BIAS]
    for i in range(n):
        out[i] = 0.0
    if model.flat:
        if model.motion != ABSENT:
            call(model.motion, t, q, v, model.p, model.motion_now)
            for i in range(n):
                out[i] = -model.motion_now[i, 2]
    elif model.bias != ABSENT:
        call(model.bias, t, q, v, model.p, out)
    else:
        size = 1.0
        for k in range(len(q)):
            size = max(size, abs(v[k]))
        d = DIFFERENCE / size
        shifted = s.state[WORK]
        for step in (-2, -1, 1, 2):
            for k in range(len(q)):
                shifted[k] = q[k] + step * d * v[k]
            gap_rates(model, t + step * d, shifted, v, G, now[SHIFTED])
            weight = (8.0 if abs(step) == 1 else -1.0) * (1.0 if step > 0 else -1.0) / (12.0 * d)
            for i in range(n):
                out[i] += weight * (product(G, v, i) + now[SHIFTED, i])


def inverse_mass(model: Any, s: Any, x: Any) -> None:
    """x <- M^-1 x, M being that of the last `free_acceleration`."""
    if model.mass != ABSENT:
        solve_definite(s.M, x)
        return
    n = len(x)
    for i in range(n):
        s.y[i] = x[i]
    for i in range(n):
        x[i] = 0.0
        for j in range(n):
            x[i] += model.M_inverse[i, j] * s.y[j]


def delassus(model: Any, s: Any, i: int) -> None:
    """Row i of M^-1 R^T."""
    MR = s.MR[i]
    assign(MR, s.R[i])
    inverse_mass(model, s, MR)


def measure(model: Any, joints: Any, s: Any, t: float) -> bool:
    """Everything at the state Q, V and time t: gaps, speeds, R, D, free acceleration; False where M is singular."""
    q, v, a = s.state[Q], s.state[V], s.state[FREE_ACCELERATION]
    n_j, n_c = len(s.J), len(s.G)
    side = inside(s, t)
    total_force(model, side, q, v, s.state[FORCE])
    if not free_acceleration(model, s, side, q, v, a):
        return False
    if n_c > 0:
        gaps(model, t, q, v, s.contact[GAP])
    if n_j > 0:
        gaps(joints, t, q, v, s.joint[GAP])
    biases(model, s, s.G, s.contact, side, q, v)
    biases(joints, s, s.J, s.joint, side, q, v)
    constraint_rows(model, joints, s, t, q, v)
    for i in range(n_j + n_c):
        delassus(model, s, i)
        for j in range(i + 1):
            s.D[i, j] = s.D[j, i] = product(s.R, s.MR[i], j)
    for i in range(n_j):
        s.joint[SPEED, i] = product(s.R, v, i) + s.joint[RATE, i]
    for i in range(n_c):
        s.contact[SPEED, i] = product(s.R, v, n_j + i) + s.contact[RATE, i]
        if not math.isfinite(s.contact[SPEED, i] + s.contact[GAP, i] + s.contact[BIAS, i]):
            return False
    return True


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


def solve_held(s: Any, k: int, x: Any) -> None:
    """X <- (L L^T)^-1 x for the k rows held."""
    solve_factored(s.L, k, x)


def bias_of(s: Any, i: int) -> float:
    """Bias of a row."""
    n_j = len(s.J)
    return s.joint[BIAS, i] if i < n_j else s.contact[BIAS, i - n_j]


def constrain(model: Any, s: Any, a: Any) -> None:
    """The acceleration a = M^-1 (f + R^T x) that keeps the rows held; multipliers into `held`.

    `a` comes as M^-1 f, f lies in the state's FORCE.
    """
    k, n = s.number[HELD_ROWS], len(a)
    for m in range(k):
        s.held[m] = 0.0
    for _ in range(REFINEMENTS):
        largest = correction = 0.0
        for m in range(k):
            i = s.row[m]
            s.change[m] = -bias_of(s, i) - product(s.R, a, i)
        solve_held(s, k, s.change)
        for m in range(k):
            largest, correction = max(largest, abs(s.held[m])), max(correction, abs(s.change[m]))
        if correction <= 4.0 * RESOLUTION * largest:
            break
        for m in range(k):
            s.held[m] += s.change[m]
        for j in range(n):
            a[j] = 0.0
            for m in range(k):
                a[j] += s.R[s.row[m], j] * s.held[m]
            a[j] += s.state[FORCE, j]
        inverse_mass(model, s, a)
    # what rounding of large multipliers leaves is taken out of the acceleration, which must stay on the surface
    for m in range(k):
        i = s.row[m]
        s.change[m] = -bias_of(s, i) - product(s.R, a, i)
    solve_held(s, k, s.change)
    for m in range(k):
        for j in range(n):
            a[j] += s.MR[s.row[m], j] * s.change[m]


def contradiction(s: Any, a: Any) -> int:
    """The first joint left out whose acceleration is not zero under the others, or -1."""
    for i in range(len(s.J)):
        kept = False
        for m in range(s.number[HELD_JOINTS]):
            kept = kept or s.row[m] == i
        if not kept:
            size = abs(s.joint[BIAS, i])
            for j in range(len(a)):
                size += abs(s.R[i, j]) * (abs(a[j]) + abs(s.state[FREE_ACCELERATION, j]))
            if abs(product(s.R, a, i) + s.joint[BIAS, i]) > CONTRADICTION * size:
                return i
    return -1


def parted(s: Any, rtol: float, atol: float) -> int:
    """The first joint left out that the others have not kept closed, or -1; its gap and row those of the state."""
    if s.number[HELD_JOINTS] == len(s.J):
        return -1
    for i in range(len(s.J)):
        held = False
        for m in range(s.number[HELD_JOINTS]):
            held = held or s.row[m] == i
        size = 0.0
        for j in range(s.state.shape[1]):
            size += abs(s.R[i, j] * s.state[Q, j])
        if not held and abs(s.joint[GAP, i]) > PARTED * (atol + rtol * size):
            return i
    return -1


def right_hand_side(model: Any, joints: Any, s: Any, t: float, y: Any, dy: Any) -> bool:
    """dy = (v, v') with the rows held; False where it is not finite or the rows have become dependent."""
    n = len(dy) // 2
    q, v, a = y[:n], y[n:], dy[n:]
    t = inside(s, t)
    if not free_acceleration(model, s, t, q, v, a):
        return False
    if s.number[HELD_ROWS] > 0:
        total_force(model, t, q, v, s.state[FORCE])
        if not hold_again(model, joints, s, t, q, v):
            return False
        constrain(model, s, a)
    for i in range(n):
        dy[i] = v[i]
    return True


def hold_again(model: Any, joints: Any, s: Any, t: float, q: Any, v: Any) -> bool:
    """Jacobians and factor of the same rows at another state; False where they have become dependent."""
    biases(model, s, s.G, s.contact, t, q, v)
    biases(joints, s, s.J, s.joint, t, q, v)
    constraint_rows(model, joints, s, t, q, v)
    count = s.number[HELD_ROWS]
    s.number[HELD_ROWS] = 0
    for m in range(count):
        i = s.row[m]
        delassus(model, s, i)
        for k in range(m + 1):
            j = s.row[k]
            s.D[i, j] = s.D[j, i] = product(s.R, s.MR[i], j)
        hold(s, i)
        if s.number[HELD_ROWS] != m + 1:
            s.number[HELD_ROWS] = count
            return False
    return True


def project(model: Any, joints: Any, s: Any, t: float) -> None:
    """Put Q, V onto the rows held, against the drift of the integration: gaps and rates zero."""
    k, n_j, n = s.number[HELD_ROWS], len(s.J), s.state.shape[1]
    q, v = s.state[Q], s.state[V]
    for level in (0, 0, 1):
        if len(s.G) > 0:
            gaps(model, t, q, v, s.contact[GAP])
        if n_j > 0:
            gaps(joints, t, q, v, s.joint[GAP])
        if not hold_again(model, joints, s, t, q, v):
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
