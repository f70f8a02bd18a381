"""What the kernels of `Located` work with: constants of a run, the piece of smooth motion at hand, work space."""

from __future__ import annotations

from typing import Any, NamedTuple

from lcpstep.compiled import by_address

# Why the loop returned
FINISHED, BUFFER_FULL, NOT_FINITE, LCP_FAILED, TOO_MANY_EVENTS, JOINTS_FAILED, NO_POSITION, STOPPED = range(8)
# Places in the array of counters; the last: events still allowed, stretches of motion cut short by one plastic
# impact, contacts of the last problem of several, rounds of the loop that found no event
STEP, ROW, EVENT, LCP_CALLS, FORCES, NEXT_TIME, EVENTS_LEFT, CUT, MEMBERS, IDLE = range(10)
N_COUNTERS = 10
# Places in the array of the loop's numbers: time since the start of the step, end of the smooth interval in the
# step, the interval of time without corners, events in this step, whether a step is under way,
# how many contacts are closed, whether the gaps have the accelerations of the piece before, the place of the matrices
# that the piece was made with, whether an open contact may touch at rest, the stretch of time that events without end
# are settled over (0: there are none), how often that has been done in this step, the time from the base of a piece
# at which its contact forces were decided; what steps by a tolerance ask for: 1 to stop after an event, how far a
# single piece goes in which events are not looked for (0: they are), and the time at the end of the step
SIGMA, END, LOW, HIGH, EVENTS, UNDER_WAY, CLOSED_NOW, UNCHANGED, MADE_WITH = range(9)
TOUCHING, STALLED, SETTLED, AHEAD, PAUSING, BLIND, GOAL = range(9, 16)
N_NUMBERS = 16
# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)
OPEN, CLOSED = 0, 1
GROUND, LEFT = (
    1,
    2,
)  # values of GROUNDED: the piece begins at gap zero; and the contact has just lost its force
NOBODY, CORNER = -1, -2  # in the place of a contact: none; all whose velocity jumps at a corner
WHOLE, REST = 0, 1  # places of the matrices for a whole step and for the rest of one;
INERTIA = 2  # in their place: M alone

EPS = 2.0**-52
SAME_TIME = 8 * EPS  # relative: an impact as little after the end of a step belongs to it
LATE = 1e-9  # of a step: what rounding may take from the last one's end
ROUNDING = 64 * EPS  # of sums of a few terms, relative to their size

# Rows of Work.vec: the state at the base of the piece, accelerations and forces there, work space
Q = 0  # state at the base of the piece
V = 1
FREE = 2  # acceleration without contact forces
A = 3  # acceleration with them
FORCE = 4  # F(t) of linear systems at the base, and at the end of the smooth interval
NEXT_FORCE = 5
Q_BASE = 6
Q_TRY = 7
V_TRY = 8
A_TRY = 9
JOLT = 10  # change by the impulses or forces of several contacts
Q_FROM = 11  # state, acceleration at the base of a piece within which states are kept
V_FROM = 12
A_FROM = 13
Q_TIME = 14  # time since the start of the step up to which a coordinate has been moved on
SWING = 15  # largest sum of the terms of a velocity at the impacts of this step
V_STRUCK = 16  # velocity just before the event after which the loop stopped
N_VEC = 17
# Rows of Work.num, a number per contact
GAP = 0  # g
RATE = 1  # u
HALF = 2  # half the gap acceleration
ALPHA = 3  # gap acceleration without contact forces
BEND = 4  # what the mean acceleration lacks for the position, of moving flat obstacles
BIAS = 5  # gap acceleration at v' = 0
GAP_TRY = 6
GAP_T = 7
GAP_T_TRY = 8
END_S = 9  # s'' of the obstacles at the end of the smooth interval
LAST = 10  # time of the last impact since the start of the step
FORCE_NOW = 11  # contact force
OLDER = 12  # the last positive contact force, and when
OLDER_TIME = 13
IMPULSE = 14  # since the last kept state
P = 15  # impulses of the event at hand
B = 16  # of the complementarity problem at hand, and its solution
Z = 17
RESIDUAL = 18  # what the solution leaves, its correction, and the relative error of factors
CHANGE = 19
DOUBT = 20
BEFORE = 21  # gap velocity just before a corner
IMPULSE_FROM = 22  # impulses at the base of a piece within which states are kept
SINCE = 23  # time since the start of the step to which gap and gap velocity belong, and of the next zero
NEXT_ZERO = 24
TURNED = (
    25  # time since the start of the step at which a contact last struck, closed or opened, and how often
)
TURNS = 26  # it has done so with hardly any time between,
HOPS = 27  # or with little time between, beside contacts that are closed, and hardly moving
FALL = (
    28  # speed at which a gap that falls freely from its last impact will close; 0: something else acts on it
)
N_NUM = 29
# Rows of Work.mark, a whole number per contact
STATUS = 0  # OPEN or CLOSED
GROUNDED = 1  # 0, GROUND or LEFT
HITS = 2  # impacts in this step
CLOSE_HITS = 3  # the latest of them that came at hardly any distance
PLASTIC = 4  # restitution of the event at hand is zero
CHOSEN = 5  # contacts of the problem at hand
HELD = 6  # those of them that carry an impulse or a force, and their places in the list
PLACE = 7
FIRST_COORDINATE = 8  # range of the coordinates that an impulse changes, if constant, and of the gaps
LAST_COORDINATE = 9
FIRST_CONTACT = 10
LAST_CONTACT = 11
N_MARK = 12
# Rows of Polynomial.vec (after Q and V) and of Polynomial.num
Q_STAGE = 2
V_STAGE = 3
V_END = 4
Q_END = 5
N_PIECE_VEC = 6
GAP_FROM = 0
RATE_FROM = 1
GAP_TO = 2
RATE_TO = 3
RATE_NOW = 4
N_PIECE_NUM = 5


@by_address
class Plan(NamedTuple):
    """Constants of a run."""

    h: float
    made_for: float  # length of pieces that the matrices in the places WHOLE are made for: h, but in parts of a step
    trapezoidal: bool  # a linear system without joints, which moves by the trapezoidal rule
    joined: bool  # there are joints
    stiff: bool  # C or K is not zero
    steady: bool  # the acceleration without contact never changes
    plain: bool  # flat contacts at rest: gaps follow from their own quadratics
    constant: bool  # M and the gap Jacobian are constant
    small: bool  # few coordinates: matrices for the rest of a step are made anew
    slack: float  # gaps up to here count as zero
    per_step: int  # events in one step
    many: int  # impacts of a contact in one step after which hops are taken as one if they end within it
    exact: bool  # pieces are Taylor polynomials; else, where pieces are polynomials, Runge-Kutta
    longest: float  # piece of motion
    corners: Any  # (m,) in [0, period)
    period: float
    margin: float  # by which times are moved off a corner
    A_inverse: Any  # (2, n_q, n_q) (M + h/2 C + h^2/4 K)^-1, for WHOLE and REST
    A: Any  # (n_q, n_q) work space
    unit: Any  # (n_q,) work space
    pivots: Any


@by_address
class Work(NamedTuple):
    """The piece of motion that began at the last event or step, and work space.

    Over the piece q(tau) = q + v tau + a tau^2 / 2, and open gaps are g + u tau + half tau^2. Vectors and numbers
    of one kind lie in one array, whose rows have names.
    """

    vec: Any  # (N_VEC, n_q)
    num: Any  # (N_NUM, n_c)
    mark: Any  # (N_MARK, n_c)
    G: Any  # (n_c, n_q)
    G_try: Any
    MG: Any  # (n_c, n_q)  (M^-1 G^T)^T
    W: Any  # (n_c, n_c)  G M^-1 G^T
    AG: Any  # (2, n_c, n_q)  (A^-1 G^T)^T
    WA: Any  # (2, n_c, n_c)  G A^-1 G^T
    M: Any  # (n_q, n_q)
    problem: Any  # (n_c * n_c,)
    pivots: Any  # (n_c + 1,)
    solver: Any
    lcp: Any
    joints: Any  # `located_joints.Joined`, or None


@by_address
class Polynomial(NamedTuple):
    """A piece of motion q(tau) = sum_k T_k (tau / scale)^k, and work space for making it and finding its events."""

    T: Any  # (DEGREE + 1, n_q)
    scale: Any  # (1,)
    a: Any  # (5, n_q) accelerations of the stages
    vec: Any  # (N_PIECE_VEC, n_q) state last asked for, stages
    num: Any  # (N_PIECE_NUM, n_c) gaps and their velocities at both ends of an interval of the scan


DEGREE = 22  # of the Taylor polynomials
