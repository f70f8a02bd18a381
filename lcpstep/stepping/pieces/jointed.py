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
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.vectors import add, clear, copy, distance, largest, product
    from lcpstep.pointers import Doubles, abs, after, max, min
    from lcpstep.stepping.pieces.codes import CLOSED, PROJECTION_FAILED, ROUNDING
    from lcpstep.stepping.pieces.joints import bend, put_on_joints, take, turn_onto_joints
    from lcpstep.stepping.pieces.magnitudes import speed_terms
    from lcpstep.stepping.pieces.state import Plan, Work

NEARLY = 0.03  # of a row: what joints leave of it
DIFFERENCED = 1e-6  # of the terms of a gap's acceleration: what differences of its velocity may make
UNTOLD = 1e-9  # of the terms of its velocity: what is left of it where joints leave nothing of its row
ASTRAY = 1e6  # times what counts as closed: where a closed contact is not held

# --- at one state ---------------------------------------------------------------------------------------------


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
    put_on_joints(w.joints, w.M, t, w.q, w.v, slack)
    gaps(m, t, w.q, w.v, w.gap_try)
    for c in range(w.n_c):
        if w.status[c] == CLOSED and not abs(w.gap_try[c]) <= ASTRAY * slack:
            w.joints.failed = PROJECTION_FAILED


def turn_with_joints(w: Work, t: float) -> None:
    """The velocity onto joints that begin to move otherwise at time t, and the impulses which that takes."""
    take(w.joints, w.M, t, w.q, w.v)
    turn_onto_joints(w.joints, w.v)
    add(after(w.impulse, w.n_c), 1.0, w.joints.answer, w.n_j)


def turn_accelerations(w: Work, t: float) -> None:
    """Accelerations of gaps that joints which turn nearly hold, by what these leave of their rows.

    Forces of joints are those of the velocity that a step comes with, from before it is put back onto the joints; a
    gap's own acceleration would show the difference, and no force could answer it. What the joints hold altogether
    has none.
    """
    if not nearly_held(w):
        return
    bend(w.joints, t, w.low, w.high, w.q, w.v)
    for c in range(w.n_c):
        left = left_of(w, c)
        if left <= NEARLY:
            terms = abs(w.bias[c])
            w.alpha[c] = product(w.joints.P, w.free, c, w.n_q) + w.bias[c]
            for k in range(w.n_j):
                term = w.joints.share[c * w.n_j + k] * w.joints.curvature[k]
                w.alpha[c] += term
                terms += abs(term)
            if left == 0.0 and abs(w.alpha[c]) <= DIFFERENCED * terms:
                w.alpha[c] = 0.0


def rate_left(plan: Plan, w: Work, c: int) -> float:
    """The velocity of a gap; of one that joints hold altogether none but what contradicts them."""
    u = product(w.G, w.v, c, w.n_q) + w.gap_t[c]
    held = w.joined and not w.joints.rows.flat and left_of(w, c) == 0.0
    return 0.0 if held and abs(u) <= UNTOLD * speed_terms(plan, w, c) else u


def nearly_held(w: Work) -> bool:
    """Whether joints that turn leave next to nothing of some contact's row."""
    some = False
    for c in range(0 if w.joints.rows.flat else w.n_c):
        some = some or left_of(w, c) <= NEARLY
    return some


def left_of(w: Work, c: int) -> float:
    """What joints leave of a contact's row, relative to it."""
    size = largest(after(w.G, c * w.n_q), 0.0, w.n_q)
    return largest(after(w.joints.P, c * w.n_q), 0.0, w.n_q) / size if size > 0.0 else 0.0


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
    put_on_joints(w.joints, w.M, t, w.q, w.v, slack)
    if distance(w.q, w.joints.before, w.n_q) <= ROUNDING * largest(w.q, 0.0, w.n_q):
        return
    piece, push = w.joints.piece, w.joints.push
    for k in range(w.n_j):
        piece[k] += push[k] / tau
    for i in range(w.n_q):
        w.v[i] += (w.q[i] - w.joints.before[i]) / tau


def meet_joints(w: Work, tau: float) -> None:
    """The velocity at the end of a piece back onto the joints; their impulses but for those of closed contacts."""
    turn_onto_joints(w.joints, w.v)
    piece, load, free, answer = w.joints.piece, w.joints.load, w.joints.free, w.joints.answer
    for k in range(w.n_j):
        piece[k] += 0.5 * tau * (load[k] + free[k]) + answer[k]


def answer_contact(w: Work, c: int, p: float, impulses: Doubles) -> None:
    """Impulses of the joints that answer the impulse p of contact c, added to others."""
    add(impulses, p, after(w.joints.share, c * w.n_j), w.n_j)


# --- what is kept ---------------------------------------------------------------------------------------------


def share_out(w: Work, record: Record, first: int, now: float, tau: float) -> None:
    """The joints' impulses of a piece among the rows kept within it, from row `first` on.

    Up to the time s in the piece they are load s + (piece - load tau) (s / tau)^2: a force linear in time.
    """
    if tau <= 0.0:
        return
    for k in range(w.n_j):
        load, given = w.joints.load[k], 0.0
        rest = w.joints.piece[k] - load * tau
        for r in range(first, record.row):
            s = min(max(record.t[r] - now, 0.0), tau)
            total = load * s + rest * (s / tau) * (s / tau)
            record.impulse[r * record.n_c + w.n_c + k] += total - given
            given = total
        w.impulse[w.n_c + k] += w.joints.piece[k] - given
