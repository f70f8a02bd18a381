"""The state of a system with several contacts and joints, and the places of its numbers."""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address
from lcpstep.events.clock import N_CLOCK, RESOLUTION

# Places in Several.x after those of the clock: duration of the step at hand; size of the next; whether the
# acceleration is that without contacts; event in the step at hand, looked for up to SEEN
LENGTH, NEXT_STEP, BARE, FOUND, SEEN = range(N_CLOCK, N_CLOCK + 5)
N_NUMBERS = N_CLOCK + 5
# Rows of Several.state
Q0, V0, Q, V, ACCELERATION, FREE_ACCELERATION, FORCE, WORK = range(8)
N_STATE = 8
# Rows of Several.contact and, the first eight, of Several.joint
GAP, SPEED, CURVE, MULTIPLIER, RATE, BIAS, IMPULSE, SHIFTED = range(8)  # CURVE: the gap acceleration
LEFT_GAP, LEFT_SPEED, LEFT_CURVE, LEFT_MULTIPLIER = range(8, 12)  # at the left end of an interval
STRUCK, SINCE, HELD = range(12, 15)  # time of the last impact, since the one before; no release before HELD
# Right-hand side and solution of the contacts' problem; whether gap and speed are those of Q, V; end of chattering
LCP_B, LCP_Z, SYNCHRONOUS, CHATTERS = range(15, 19)
LCP_NOISE = 22  # rounding of the right-hand side
# Of the impacts at one instant: size of the terms of a speed; speed, and impulse since, a number of impacts ago
TERMS, CYCLE_SPEED, CYCLE_IMPULSE = range(19, 22)
# How long the sequence that is summed up lasts; impulse taken on account, and the time up to which forces pay for it
REST, OWED, OWED_UNTIL = range(23, 26)
N_CONTACT = 26
JOINT_CYCLE_IMPULSE = SHIFTED + 1  # the last row of Several.joint
N_JOINT = SHIFTED + 2
# Rows of Several.mode
CLOSED, WAS_CLOSED, LOADED = range(3)  # lasting contact; so when last told; carries a force
N_MODE = 3
# Places in Several.number
HELD_ROWS, HELD_JOINTS, CULPRIT, MEMBERS, NEXT, SOUGHT = range(6)  # MEMBERS: contacts of the last problem
N_NUMBER = 6
# Why the loop returned, beside the reasons of `bookkeeping`
NO_IMPULSES, NO_FORCES, JOINTS_DISAGREE = range(10, 13)
MOVE, JUMP, SETTLE, OBEY = range(4)  # what comes next
NOISE = 64 * RESOLUTION


@by_address
class Several(NamedTuple):
    """A system with several contacts and joints: what it is, its state, Jacobians and multipliers, and work space."""

    model: Any
    joints: Any  # the same for the joints
    plan: Any
    constant: bool  # the acceleration is constant between events, and gaps are linear in q
    corners: Any  # (m,) in [0, period)
    x: Any  # (N_NUMBERS,)
    state: Any  # (N_STATE, n_q)
    contact: Any  # (N_CONTACT, n_c)
    joint: Any  # (N_JOINT, n_j)
    mode: Any  # (N_MODE, n_c)
    number: Any  # (N_NUMBER,) integers
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
    kept: Any  # (n_j + n_c,) rows held, while others are tried
    doubt: Any  # (n_j + n_c,) relative error of the diagonal of L, in units of rounding
    member: Any  # (n_c,) contacts of the problem at hand
    W: Any  # (n_c^2,) its matrix
    lcp: Any  # work space of its solver
    solver: Any
    w: Any  # of the Runge-Kutta method
    dy: Any  # (2 n_q,)
    seen: Any  # (5, n_c), n_c >= 2
