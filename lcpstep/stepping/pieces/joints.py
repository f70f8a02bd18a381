"""What joints do to accelerations, mobilities, positions and velocities at one state.

    P = M^-1 - M^-1 J^T S^-1 J M^-1,     S = J M^-1 J^T
    acceleration  a = P f - M^-1 J^T S^-1 bias,      mobility of a contact  P G_c^T

and the smallest changes of position and velocity, in the metric of the mass, that put them back onto the joints
g_J(t, q) = 0 and J v + dg_J/dt = 0. Redundant joints: see `elimination`. Source: F. Pfeiffer, C. Glocker, Multibody
Dynamics with Unilateral Contacts (Wiley 1996), chapter 4.
"""

from __future__ import annotations

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles
    from lcpstep.kernels.acceleration import response
    from lcpstep.kernels.dynamics import bias, gap_rates, gaps
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.vectors import clear, largest, product
    from lcpstep.pointers import Doubles, abs, after, inf, max
    from lcpstep.stepping.constraints.directions import forget_rounding
    from lcpstep.stepping.constraints.joint_rows import (
        CONTRADICTION,
        Elimination,
        arrived,
        factorise_joints,
        leave,
        solve_joints,
    )
    from lcpstep.stepping.pieces.codes import JOINTS_FAILED, PROJECTION_FAILED

PROJECTIONS = 50  # of Newton
HELPS = 0.25  # of a joint's gap: what an iteration may leave of it without a new Jacobian
VECTORS = 8  # of a number for each joint


class Joints:
    """Joints of a scene at the state last looked at, and work space.

    n_j
    turning, stretch, curvature : (n_j,)   dg/dt, gap and bias
    free, load      multipliers without contact forces, and with them, at the base of a piece
    piece           impulses of the piece at hand
    answer, push    impulses of the problem at hand, and those that moved the position
    J, J_try, MJ : (n_j, n_q)   Jacobian, one to try, rows M^-1 J^T
    S : (n_j, n_j)              J M^-1 J^T, which `elimination` solves with
    share : (n_c, n_j)          multipliers for a unit force of each contact
    P : (n_c, n_q)              what the joints leave of its row
    before, shifted : (n_q,)
    failed          why the run cannot go on, or 0;
    culprit         is then the joint that does not hold
    moved           `put_on_joints` has left the state that was taken before it, for one on its way

    Parameters
    ----------
    system : Model  of the scene, with its contacts
    rows : Model    of its joints in the place of contacts
    """

    def __init__(self, system: Model, rows: Model) -> None:
        self.system = system
        self.rows, self.n_j, self.n_q = rows, rows.n_c, rows.n_q
        self.failed = self.culprit = 0
        self.moved = False
        n, n_q, n_c = self.n_j, self.n_q, system.n_c
        self.elimination = Elimination(n, 0, n_q)
        self.numbers = np.zeros((VECTORS + 3 * n_q + n + n_c) * n + (2 + n_c) * n_q)
        self.turning = doubles(self.numbers)
        self.stretch = after(self.turning, n)
        self.curvature = after(self.stretch, n)
        self.free = after(self.curvature, n)
        self.load = after(self.free, n)
        self.piece = after(self.load, n)
        self.answer = after(self.piece, n)
        self.push = after(self.answer, n)
        self.J = after(self.push, n)
        self.J_try = after(self.J, n * n_q)
        self.MJ = after(self.J_try, n * n_q)
        self.S = after(self.MJ, n * n_q)
        self.share = after(self.S, n * n)
        self.before = after(self.share, n_c * n)
        self.shifted = after(self.before, n_q)
        self.P = after(self.shifted, n_q)


def take(j: Joints, M: Doubles, t: float, q: Doubles, v: Doubles) -> None:
    """Jacobian of the joints and their Delassus matrix; M is Cholesky's factor of a mass matrix that changes."""
    n, n_q = j.n_j, j.n_q
    j.moved = False
    gap_rates(j.rows, t, q, v, j.J, j.turning)
    for k in range(n):
        response(j.system, M, j.shifted, after(j.J, k * n_q), after(j.MJ, k * n_q))
        for i in range(n):
            j.S[i * n + k] = product(j.J, after(j.MJ, k * n_q), i, n_q)
    factorise_joints(j.elimination, j.S, n, 0)


def accelerate(
    j: Joints, M: Doubles, t: float, low: float, high: float, q: Doubles, v: Doubles, a: Doubles
) -> None:
    """The acceleration with the forces of the joints, a being that without; t lies in a smooth interval."""
    take(j, M, t, q, v)
    bend(j, t, low, high, q, v)
    answer(j, a, j.curvature, j.free)


def bend(j: Joints, t: float, low: float, high: float, q: Doubles, v: Doubles) -> None:
    """What the joints turn by, into `curvature`; t lies in a smooth interval."""
    bias(j.rows, t, low, high, q, v, j.shifted, j.J_try, j.stretch, j.curvature)


def answer(j: Joints, x: Doubles, rate: Doubles, out: Doubles) -> None:
    """Multipliers that make J x + rate zero, into `out`, and x with them."""
    for k in range(j.n_j):
        j.elimination.y[k] = -product(j.J, x, k, j.n_q) - rate[k]
    solve_joints(j.elimination, out)
    follow(j, out, x)


def follow(j: Joints, multipliers: Doubles, x: Doubles) -> None:
    """X + M^-1 J^T times the multipliers."""
    n_q = j.n_q
    for i in range(n_q):
        for k in range(j.n_j):
            x[i] += j.MJ[k * n_q + i] * multipliers[k]


def reduce(j: Joints, M: Doubles, c: int, row: Doubles, x: Doubles) -> None:
    """Take from M^-1 G_c^T, in x, what the joints hold back, and from the row G_c itself; rounding is nothing.

    Where a normal is nearly that of a joint only the row that is left, P_c = G_c + sum share_cj J_j, keeps digits.
    """
    n_q, share, P = j.n_q, after(j.share, c * j.n_j), after(j.P, c * j.n_q)
    for k in range(j.n_j):
        j.elimination.y[k] = -product(j.J, x, k, n_q)
    solve_joints(j.elimination, share)
    leave(j.elimination, row, j.J, share, 1.0, n_q, P)
    if not j.rows.flat:
        forget_rounding(P, row, n_q)
    response(j.system, M, j.shifted, P, x)


def put_on_joints(j: Joints, M: Doubles, t: float, q: Doubles, v: Doubles, slack: float) -> None:
    """Q onto the joints by Newton's method, with Jacobian and directions of the state last taken while that helps."""
    before = inf
    clear(j.push, j.n_j)
    for _ in range(PROJECTIONS):
        gaps(j.rows, t, q, v, j.stretch)
        worst = 0.0
        for k in range(j.n_j):
            if not abs(j.stretch[k]) <= worst:
                worst, j.culprit = abs(j.stretch[k]), k
        if arrived(worst, before, slack, j.J, j.n_j, q, j.n_q):
            return
        if not worst < inf:
            break
        if worst > HELPS * before:
            take(j, M, t, q, v)
            j.moved = True
        before = worst
        for k in range(j.n_j):
            j.elimination.y[k] = -j.stretch[k]
        solve_joints(j.elimination, j.answer)
        follow(j, j.answer, q)
        for k in range(j.n_j):
            j.push[k] += j.answer[k]
    j.failed = PROJECTION_FAILED


def turn_onto_joints(j: Joints, v: Doubles) -> None:
    """V onto the rates of the joints at the state last taken; the impulses for that into `answer`."""
    n_q, fastest = j.n_q, largest(v, 0.0, j.n_q)
    answer(j, v, j.turning, j.answer)
    for k in range(j.n_j):
        rate, size = product(j.J, v, k, n_q) + j.turning[k], abs(j.turning[k])
        for i in range(n_q):
            speed = max(fastest, abs(v[i]))
            for n in range(j.n_j):
                speed = max(speed, abs(j.MJ[n * n_q + i] * j.answer[n]))
            size += abs(j.J[k * n_q + i]) * speed
        if abs(rate) > CONTRADICTION * size:
            j.culprit, j.failed = k, JOINTS_FAILED
            return
