"""Joints in the steps of `Located`: what they add to each thing that a step does.

The joints take from every acceleration and from the mobility of every contact what they hold back (`joints`); with
these, impacts, contact forces and the return onto obstacles are found as without joints, and a contact force lambda
is answered by the joints' multipliers - S^-1 J M^-1 G^T lambda. A piece of motion ends as in RATTLE: forces along the
directions at its base put the position back onto the joints, others at its end the velocity. Without contacts energy
then oscillates and does not drift.

Only where a scene is `joined`. Sources: H. Andersen, Rattle, J. Comput. Phys. 52 (1983); E. Hairer, C. Lubich,
G. Wanner, Geometric Numerical Integration (Springer 2006), section VII.1.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.dynamics import gaps
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.record import LEAD, TIME, Record
    from lcpstep.kernels.vectors import add, clear, copy, distance, largest
    from lcpstep.pointers import Doubles, abs, after, max, min
    from lcpstep.stepping.pieces.codes import CLOSED, JOINTS_FAILED, PROJECTION_FAILED, ROUNDING
    from lcpstep.stepping.pieces.joints import put, take, turn
    from lcpstep.stepping.pieces.state import Work

ASTRAY = 1e6  # times what counts as closed: where a closed contact is not held

# --- at one state ---------------------------------------------------------------------------------------------


def put_on_joints(w: Work, t: float, slack: float, q: Doubles) -> None:
    """The position q onto the joints."""
    if not put(w.joints, w.M, t, q, w.v, slack):
        w.joints.failed = PROJECTION_FAILED


def stay_at_base(w: Work, t: float) -> None:
    """Jacobian and directions of the joints at the base of the piece, at t, where a look ahead has left others.

    How far a step is off the joints is put right along these: a gap is then one function of the time, and the motion
    that is taken ends where the look saw it.
    """
    if w.joints.moved:
        take(w.joints, w.M, t, w.q, w.v)


def meet_both(m: Model, w: Work, t: float, slack: float) -> None:
    """The position onto the joints; the run cannot go on where closed contacts are not met beside them.

    Past a position in which normals of joints and contacts are parallel there may be none that meets both.
    """
    put_on_joints(w, t, slack, w.q)
    gaps(m, t, w.q, w.v, w.gap_try)
    for c in range(w.n_c):
        if w.status[c] == CLOSED and not abs(w.gap_try[c]) <= ASTRAY * slack:
            w.joints.failed = PROJECTION_FAILED


def settle_velocity(w: Work, t: float) -> None:
    """A velocity within a piece, v_try, onto the joints at the position q."""
    take(w.joints, w.M, t, w.q, w.v_try)
    turn_onto_joints(w, w.v_try)


def turn_with_joints(w: Work, t: float) -> None:
    """The velocity onto joints that begin to move otherwise at time t, and the impulses which that takes."""
    take(w.joints, w.M, t, w.q, w.v)
    turn_onto_joints(w, w.v)
    add(after(w.impulse, w.n_c), 1.0, w.joints.answer, w.n_j)


def turn_onto_joints(w: Work, v: Doubles) -> None:
    """A velocity onto the rates of the joints at the state last taken."""
    if not turn(w.joints, v):
        w.joints.failed = JOINTS_FAILED


# --- a piece of motion ----------------------------------------------------------------------------------------


def load_joints(w: Work) -> None:
    """Forces of the joints at the base of the piece that begins."""
    load, share = w.joints.load, w.joints.share
    clear(w.joints.piece, w.n_j)
    copy(load, w.joints.free, w.n_j)
    for k in range(w.n_j):
        for c in range(w.n_c):
            if w.force_now[c] > 0.0:
                load[k] += share[c * w.n_j + k] * w.force_now[c]


def reach_joints(w: Work, t: float, tau: float, slack: float) -> None:
    """The position at the end of a piece onto the joints, by forces at its base, which act on the velocity too.

    But for what is only rounding of the position: over a piece as short as that it would be any velocity.
    """
    copy(w.joints.before, w.q, w.n_q)
    put_on_joints(w, t, slack, w.q)
    if distance(w.q, w.joints.before, w.n_q) <= ROUNDING * largest(w.q, 0.0, w.n_q):
        return
    piece, push = w.joints.piece, w.joints.push
    for k in range(w.n_j):
        piece[k] += push[k] / tau
    for i in range(w.n_q):
        w.v[i] += (w.q[i] - w.joints.before[i]) / tau


def meet_joints(w: Work, tau: float) -> None:
    """The velocity at the end of a piece back onto the joints; their impulses but for those of closed contacts."""
    turn_onto_joints(w, w.v)
    piece, load, free, answer = w.joints.piece, w.joints.load, w.joints.free, w.joints.answer
    for k in range(w.n_j):
        piece[k] += 0.5 * tau * (load[k] + free[k]) + answer[k]


def hold_joints(w: Work, span: float) -> None:
    """Impulses of the joints over a short stretch of time, those that answer contacts left aside."""
    add(after(w.impulse, w.n_c), span, w.joints.free, w.n_j)


def answer_impulse(w: Work, c: int, p: float) -> None:
    """Impulses of the joints that answer the impulse p of contact c at an impact."""
    add(after(w.impulse, w.n_c), p, after(w.joints.share, c * w.n_j), w.n_j)


def answer_force(w: Work, c: int, p: float) -> None:
    """Impulses of the joints that answer the impulse p of contact c over the piece at hand."""
    add(w.joints.piece, p, after(w.joints.share, c * w.n_j), w.n_j)


# --- what is kept ---------------------------------------------------------------------------------------------


def share_out(w: Work, record: Record, first: int, now: float, tau: float) -> None:
    """The joints' impulses of a piece among the rows kept within it, from row `first` on.

    Up to the time s in the piece they are load s + (piece - load tau) (s / tau)^2: a force linear in time.
    """
    if tau <= 0.0:
        return
    column = LEAD + 2 * w.n_q + w.n_c
    for k in range(w.n_j):
        load, given = w.joints.load[k], 0.0
        rest = w.joints.piece[k] - load * tau
        for r in range(first, record.row):
            row = after(record.rows, r * record.row_size)
            s = min(max(row[TIME] - now, 0.0), tau)
            total = load * s + rest * (s / tau) * (s / tau)
            row[column + k] += total - given
            given = total
        w.impulse[w.n_c + k] += w.joints.piece[k] - given
