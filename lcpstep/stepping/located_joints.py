"""Joints in the steps of `Located`: small kernels that its other kernels call in passing.

The joints take from every acceleration and from the mobility of every contact what they hold back (`joint_tasks`);
with these, impacts, contact forces and the return onto obstacles are found as without joints, and a contact force
lambda is answered by the joints' multipliers - S^-1 J M^-1 G^T lambda. A piece of motion ends as in RATTLE: forces
along the directions at its base put the position back onto the joints, others at its end the velocity. Without
contacts energy then oscillates and does not drift.

Each kernel does nothing where `Work.joints` is None, and runs without joints are compiled without them (`HOOKS`).
Sources: H. Andersen, Rattle, J. Comput. Phys. 52 (1983); E. Hairer, C. Lubich, G. Wanner, Geometric Numerical
Integration (Springer 2006), section VII.1.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import by_address, call_task, task_address
from lcpstep.dense import assign
from lcpstep.model import Model
from lcpstep.recording import LEAD
from lcpstep.recording import TIME as ROW_TIME
from lcpstep.stepping.joint_tasks import (
    ACCELERATE,
    ANSWER,
    CONTACT,
    FREE,
    HOLD,
    IMPULSE,
    LOAD,
    PIECE,
    PUSH,
    PUT,
    REDUCE,
    SHARED,
    SLACK,
    TAKE,
    TIME,
    TURN,
    WHAT,
    Joints,
    joints_of,
    serve,
)
from lcpstep.stepping.located_work import FINISHED, FORCE_NOW, JOINTS_FAILED, NO_POSITION, ROW, V_TRY, Q, V


@by_address
class Joined(NamedTuple):
    """The joints of a scene, and who does what is to be done with them."""

    serve: Any
    own: Joints
    failed: Any  # (1,) why the run cannot go on


def joined(scene: Scene, m: Model, rows: Model, fast: bool) -> Joined:
    """Joints of a scene, `rows` being the model of their gaps."""
    own = joints_of(scene, m, rows)
    return Joined(task_address(serve, own) if fast else serve, own, np.zeros(1, dtype=np.int64))


def ask(w: Any, what: int, t: float, q: Any, v: Any) -> None:
    """Have one of the joints' tasks done."""
    j = w.joints
    j.own.order[WHAT], j.own.number[TIME] = what, t
    how = call_task(j.serve, w.M, q, v, j.own)
    if how != HOLD:
        j.failed[0] = NO_POSITION if what == PUT else JOINTS_FAILED


# --- at one state ---------------------------------------------------------------------------------------------


def take_joints(w: Any, t: float) -> None:
    """What the joints are at the state Q, with the mass matrix at hand."""
    if w.joints is not None:
        ask(w, TAKE, t, w.vec[Q], w.vec[V])


def join_acceleration(w: Any, t: float, q: Any, v: Any, a: Any) -> None:
    """The acceleration with the forces of the joints, a being that without."""
    if w.joints is not None:
        assign(w.joints.own.vec[SHARED], a)
        ask(w, ACCELERATE, t, q, v)
        assign(a, w.joints.own.vec[SHARED])


def reduce_mobility(w: Any, c: int) -> None:
    """Take from w.MG[c] what the joints hold back."""
    if w.joints is not None:
        w.joints.own.order[CONTACT] = c
        assign(w.joints.own.vec[SHARED], w.MG[c])
        ask(w, REDUCE, 0.0, w.vec[Q], w.vec[V])
        assign(w.MG[c], w.joints.own.vec[SHARED])


def put_on_joints(w: Any, t: float, slack: float, q: Any) -> None:
    """The position q onto the joints."""
    if w.joints is not None:
        w.joints.own.number[SLACK] = slack
        ask(w, PUT, t, q, w.vec[V])


def settle_velocity(w: Any, t: float) -> None:
    """A velocity within a piece, V_TRY, onto the joints at the position Q."""
    if w.joints is not None:
        ask(w, TAKE, t, w.vec[Q], w.vec[V_TRY])
        ask(w, TURN, t, w.vec[Q], w.vec[V_TRY])


def turn_with_joints(w: Any, t: float) -> None:
    """The velocity onto joints that begin to move otherwise at time t, and the impulses which that takes."""
    if w.joints is not None:
        ask(w, TAKE, t, w.vec[Q], w.vec[V])
        ask(w, TURN, t, w.vec[Q], w.vec[V])
        num = w.joints.own.num
        for k in range(num.shape[1]):
            num[IMPULSE, k] += num[ANSWER, k]


def joints_failed(w: Any) -> int:
    """Why the joints end the run, or FINISHED."""
    return FINISHED if w.joints is None else int(w.joints.failed[0])


# --- a piece of motion ----------------------------------------------------------------------------------------


def load_joints(w: Any) -> None:
    """Forces of the joints at the base of the piece that begins."""
    if w.joints is None:
        return
    num, share = w.joints.own.num, w.joints.own.share
    for k in range(num.shape[1]):
        num[LOAD, k], num[PIECE, k] = num[FREE, k], 0.0
        for c in range(len(share)):
            if w.num[FORCE_NOW, c] > 0.0:
                num[LOAD, k] += share[c, k] * w.num[FORCE_NOW, c]


def reach_joints(w: Any, t: float, tau: float, slack: float) -> None:
    """The position at the end of a piece onto the joints, by forces at its base, which act on the velocity too."""
    if w.joints is None:
        return
    num, before = w.joints.own.num, w.joints.own.vec[SHARED]
    assign(before, w.vec[Q])
    put_on_joints(w, t, slack, w.vec[Q])
    for k in range(num.shape[1]):
        num[PIECE, k] += num[PUSH, k] / tau
    for i in range(len(before)):
        w.vec[V, i] += (w.vec[Q, i] - before[i]) / tau


def meet_joints(w: Any, t: float, tau: float) -> None:
    """The velocity at the end of a piece back onto the joints; their impulses but for those of closed contacts."""
    if w.joints is None:
        return
    ask(w, TURN, t, w.vec[Q], w.vec[V])
    num = w.joints.own.num
    for k in range(num.shape[1]):
        num[PIECE, k] += 0.5 * tau * (num[LOAD, k] + num[FREE, k]) + num[ANSWER, k]


def hold_joints(w: Any, span: float) -> None:
    """Impulses of the joints over a short stretch of time, those that answer contacts left aside."""
    if w.joints is not None:
        num = w.joints.own.num
        for k in range(num.shape[1]):
            num[IMPULSE, k] += span * num[FREE, k]


def pass_on(w: Any, c: int, p: float, row: int) -> None:
    """Impulses of the joints that answer the impulse p of contact c, into a row: PIECE, or IMPULSE at an impact."""
    if w.joints is not None:
        for k in range(w.joints.own.num.shape[1]):
            w.joints.own.num[row, k] += w.joints.own.share[c, k] * p


# --- what is kept ---------------------------------------------------------------------------------------------


def write_joints(w: Any, row: Any) -> None:
    """Impulses of the joints since the last kept state into the row of the next one."""
    if w.joints is not None:
        num, first = w.joints.own.num, LEAD + 2 * w.vec.shape[1] + w.num.shape[1]
        for k in range(num.shape[1]):
            row[first + k], num[IMPULSE, k] = num[IMPULSE, k], 0.0


def take_back(w: Any, row: Any) -> None:
    """Impulses of the joints out of a row that is written anew."""
    if w.joints is not None:
        num, first = w.joints.own.num, LEAD + 2 * w.vec.shape[1] + w.num.shape[1]
        for k in range(num.shape[1]):
            num[IMPULSE, k] += row[first + k]


def share_out(w: Any, record: Any, count: Any, first: int, now: float, tau: float) -> None:
    """The joints' impulses of a piece among the rows kept within it, from row `first` on.

    Up to the time s in the piece they are LOAD s + (PIECE - LOAD tau) (s / tau)^2: a force linear in time.
    """
    if w.joints is None or tau <= 0.0:
        return
    num, column = w.joints.own.num, LEAD + 2 * w.vec.shape[1] + w.num.shape[1]
    for k in range(num.shape[1]):
        load, given = num[LOAD, k], 0.0
        rest = num[PIECE, k] - load * tau
        for r in range(first, count[ROW]):
            s = min(max(record.rows[r, ROW_TIME] - now, 0.0), tau)
            total = load * s + rest * (s / tau) * (s / tau)
            record.rows[r, column + k] += total - given
            given = total
        num[IMPULSE, k] += num[PIECE, k] - given


HOOKS = (
    take_joints, join_acceleration, reduce_mobility, put_on_joints, settle_velocity, turn_with_joints, joints_failed,
    load_joints, reach_joints, meet_joints, hold_joints, pass_on, write_joints, take_back, share_out,
)  # fmt: skip
