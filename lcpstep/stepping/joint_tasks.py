"""What joints do to accelerations, mobilities, positions and velocities at one state: one kernel for all of it.

    P = M^-1 - M^-1 J^T S^-1 J M^-1,     S = J M^-1 J^T
    acceleration  a = P f - M^-1 J^T S^-1 bias,      mobility of a contact  P G_c^T

and the smallest changes of position and velocity, in the metric of the mass, that put them back onto the joints
g_J(t, q) = 0 and J v + dg_J/dt = 0. Kernels of `Located` reach this one by its address, so it is compiled once and
not with every place that needs it. Redundant joints: see `joints`. Source: F. Pfeiffer, C. Glocker, Multibody
Dynamics with Unilateral Contacts (Wiley 1996), chapter 4.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import by_address
from lcpstep.dynamics import bias, gap_rates, gaps, product
from lcpstep.model import ABSENT, Model
from lcpstep.stepping.joints import Elimination, factorise_joints, solve_joints
from lcpstep.stepping.located_work import ROUNDING
from lcpstep.stepping.projection import divide_by_mass

PROJECTIONS = 50  # of Newton
HELPS = 0.25  # of a joint's gap: what an iteration may leave of it without a new Jacobian
STALLED = 1e4  # of the slack: how much rounding in the joints' own arithmetic may leave
CONTRADICTION = 1e-9  # of the terms of a joint's rate: what may be left of it

TAKE, ACCELERATE, REDUCE, PUT, TURN = range(5)  # what to do
# Places in Joints.order: what to do, for which contact, which joint does not hold, the kind of `joints.Elimination`;
# its pivots follow
WHAT, CONTACT, CULPRIT, KIND, N_ORDER = range(5)
SHARED, SHIFTED = 0, 1  # rows of Joints.vec
TIME, SLACK = 0, 1  # places in Joints.number
HOLD, CONTRADICT, APART = range(3)  # how it went
# Rows of Joints.num: dg/dt, gap and bias; multipliers without contact forces and with them, at the base; impulses of
# the piece at hand and since the last kept state; answers of the problem at hand, and those that moved the position;
# vectors of `joints.Elimination`
TURNING, STRETCH, CURVATURE, FREE, LOAD, PIECE, IMPULSE, ANSWER, PUSH, VALUES, SCALE, X, Y, R, D = range(15)
N_NUM = 15


@by_address
class Rows(NamedTuple):
    """The part of a model that its gaps are evaluated with; see `model.Model`."""

    flat: bool
    G: Any
    offset: Any
    motion: Any
    gap: Any
    jacobian: Any
    gap_t: Any
    bias: Any
    p: Any
    motion_now: Any
    frame: Any
    carried: bool
    frame_now: Any


@by_address
class Joints(NamedTuple):
    """Joints at the state last looked at, and work space; few arrays, for every kernel of a step carries them."""

    rows: Rows
    M_inverse: Any  # (n_q, n_q) of a constant mass matrix
    constant: bool  # the mass matrix is
    order: Any  # (N_ORDER + n_j,) whole numbers
    number: Any  # (2,)
    num: Any  # (N_NUM, n_j)
    vec: Any  # (2, n_q)
    wide: Any  # (3, n_j, n_q)
    square: Any  # (4, n_j, n_j)
    share: Any  # (n_c, n_j) multipliers of the joints for a unit force of each contact


def joints_of(scene: Scene, m: Model, rows: Model) -> Joints:
    """Work space for the joints of a scene, `rows` being the model of their gaps."""
    n_q, n_j = scene.n_q, scene.n_j
    return Joints(
        rows=Rows(*(getattr(rows, name) for name in Rows._fields)), M_inverse=m.M_inverse, constant=m.mass == ABSENT,
        order=np.zeros(N_ORDER + n_j, dtype=np.int64), number=np.zeros(2), num=np.zeros((N_NUM, n_j)),
        vec=np.zeros((2, n_q)), wide=np.zeros((3, n_j, n_q)), square=np.zeros((4, n_j, n_j)),
        share=np.zeros((scene.n_c, n_j)),
    )  # fmt: skip


@by_address
class Task(NamedTuple):
    """The arrays of `Joints` by their names."""

    rows: Rows
    M_inverse: Any
    constant: bool
    culprit: Any  # (1,)
    num: Any
    x: Any  # (n_q,) acceleration or mobility, in and out
    shifted: Any  # (n_q,)
    J: Any  # (n_j, n_q)
    J_try: Any
    MJ: Any  # (n_j, n_q) rows M^-1 J^T
    S: Any  # (n_j, n_j)
    tools: Elimination


def serve(M: Any, q: Any, v: Any, a: Joints) -> int:
    """Do what a.order says at time, position and velocity, M being the factor of a mass matrix that changes."""
    tools = Elimination(
        a.square[1], a.square[2], a.square[3], a.num[VALUES], a.num[SCALE], a.order[N_ORDER:],
        a.order[KIND : KIND + 1], a.num[X], a.num[Y], a.num[R], a.num[D], a.square[0],
    )  # fmt: skip
    j = Task(
        a.rows, a.M_inverse, a.constant, a.order[CULPRIT : CULPRIT + 1], a.num, a.vec[SHARED], a.vec[SHIFTED],
        a.wide[0], a.wide[1], a.wide[2], a.square[0], tools,
    )  # fmt: skip
    what, t = a.order[WHAT], a.number[TIME]
    if what == PUT:
        return put(M, t, q, v, a.number[SLACK], j)
    if what == TURN:
        return turn(v, j)
    if what == REDUCE:
        reduce(j, a.share[a.order[CONTACT]])
        return HOLD
    take(M, t, q, v, j)
    if what == ACCELERATE:
        bias(j.rows, t, q, v, j.shifted, j.J_try, j.num[STRETCH], j.num[CURVATURE])
        answer(j, j.x, j.num[CURVATURE], j.num[FREE])
    return HOLD


def take(M: Any, t: float, q: Any, v: Any, j: Task) -> None:
    """Jacobian of the joints and their Delassus matrix."""
    gap_rates(j.rows, t, q, v, j.J, j.num[TURNING])
    for k in range(len(j.J)):
        divide_by_mass(j.constant, j.M_inverse, M, j.J[k], j.MJ[k])
        for i in range(len(j.J)):
            j.S[i, k] = product(j.J, j.MJ[k], i)
    factorise_joints(j.tools, j.S, 0)


def answer(j: Task, x: Any, rate: Any, out: Any) -> None:
    """Multipliers that make J x + rate zero, into `out`, and x with them."""
    for k in range(len(j.J)):
        j.tools.y[k] = -product(j.J, x, k) - rate[k]
    solve_joints(j.tools, out)
    follow(j, out, x)


def follow(j: Task, multipliers: Any, x: Any) -> None:
    """X + M^-1 J^T times the multipliers."""
    for i in range(len(x)):
        for k in range(len(j.J)):
            x[i] += j.MJ[k, i] * multipliers[k]


def reduce(j: Task, share: Any) -> None:
    """Take from M^-1 G_c^T, in j.x, what the joints hold back; nothing but rounding is nothing."""
    for k in range(len(j.J)):
        j.tools.y[k] = -product(j.J, j.x, k)
    solve_joints(j.tools, share)
    for i in range(len(j.x)):
        size = abs(j.x[i])
        for k in range(len(j.J)):
            j.x[i] += j.MJ[k, i] * share[k]
            size += abs(j.MJ[k, i] * share[k])
        if abs(j.x[i]) <= ROUNDING * size:
            j.x[i] = 0.0


def put(M: Any, t: float, q: Any, v: Any, slack: float, j: Task) -> int:
    """Q onto the joints by Newton's method, with Jacobian and directions of the state last taken while that helps."""
    before = math.inf
    for k in range(len(j.J)):
        j.num[PUSH, k] = 0.0
    for _ in range(PROJECTIONS):
        gaps(j.rows, t, q, v, j.num[STRETCH])
        worst = 0.0
        for k in range(len(j.J)):
            if not abs(j.num[STRETCH, k]) <= worst:
                worst, j.culprit[0] = abs(j.num[STRETCH, k]), k
        if worst <= slack or 0.5 * before < worst <= STALLED * slack:
            return HOLD
        if not worst < math.inf:
            return APART
        if worst > HELPS * before:
            take(M, t, q, v, j)
        before = worst
        for k in range(len(j.J)):
            j.tools.y[k] = -j.num[STRETCH, k]
        solve_joints(j.tools, j.num[ANSWER])
        follow(j, j.num[ANSWER], q)
        for k in range(len(j.J)):
            j.num[PUSH, k] += j.num[ANSWER, k]
    return APART


def turn(v: Any, j: Task) -> int:
    """V onto the rates of the joints at the state last taken; the impulses for that into the row ANSWER."""
    largest = 0.0
    for i in range(len(v)):
        largest = max(largest, abs(v[i]))
    answer(j, v, j.num[TURNING], j.num[ANSWER])
    for k in range(len(j.J)):
        rate, size = product(j.J, v, k) + j.num[TURNING, k], abs(j.num[TURNING, k])
        for i in range(len(v)):
            speed = max(largest, abs(v[i]))
            for n in range(len(j.J)):
                speed = max(speed, abs(j.MJ[n, i] * j.num[ANSWER, n]))
            size += abs(j.J[k, i]) * speed
        if abs(rate) > CONTRADICTION * size:
            j.culprit[0] = k
            return CONTRADICT
    return HOLD
