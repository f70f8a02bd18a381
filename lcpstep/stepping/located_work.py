"""What the kernels of `Located` work with: constants of a run, the piece of smooth motion at hand, work space."""

from __future__ import annotations

from typing import Any, NamedTuple

# Why the loop returned
FINISHED, BUFFER_FULL, NOT_FINITE, LCP_FAILED = range(4)
# Places in the array of counters
STEP, ROW, EVENT, LCP_CALLS, FORCES, NEXT_TIME = range(6)
N_COUNTERS = 6
# Places in the array of the loop's numbers: time since the start of the step, end of the smooth interval in the
# step, the interval of time without corners, events in this step, whether a step is under way,
# how many contacts are closed, whether the gaps have the accelerations of the piece before
SIGMA, END, LOW, HIGH, EVENTS, UNDER_WAY, CLOSED_NOW, UNCHANGED = range(8)
N_NUMBERS = 8
# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)
OPEN, CLOSED = 0, 1
WHOLE, REST = 0, 1  # places of the matrices for a whole step and for the rest of one

EPS = 2.0**-52
ROUNDING = 64 * EPS  # of sums of a few terms, relative to their size


class Plan(NamedTuple):
    """Constants of a run."""

    h: float
    stiff: bool  # C or K is not zero
    steady: bool  # the acceleration without contact never changes
    plain: bool  # flat contacts at rest: gaps follow from their own quadratics
    constant: bool  # M and the gap Jacobian are constant
    small: bool  # few coordinates: matrices for the rest of a step are made anew
    slack: float  # gaps up to here count as zero
    max_events: int  # in one step
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


class Work(NamedTuple):
    """The piece of motion that began at the last event or step, and work space.

    Over the piece q(tau) = q + v tau + a tau^2 / 2, and open gaps are g + u tau + half tau^2.
    """

    q: Any  # (n_q,) state at the base of the piece
    v: Any
    free: Any  # acceleration without contact forces
    a: Any  # acceleration with them
    force: Any  # F(t) of linear systems at the base, and at the end of the smooth interval
    next_force: Any
    q_base: Any
    q_try: Any
    v_try: Any
    a_try: Any
    g: Any  # (n_c,)
    u: Any
    half: Any
    alpha: Any  # gap acceleration without contact forces
    bend: Any  # what the mean acceleration lacks for the position, of moving flat obstacles
    bias: Any  # gap acceleration at v' = 0
    g_try: Any
    g_t: Any
    end_s: Any  # s'' of the obstacles at the end of the smooth interval
    status: Any  # (n_c,) OPEN or CLOSED
    grounded: Any  # (n_c,) the piece began at gap zero
    hits: Any  # (n_c,) impacts in this step
    close_hits: Any  # (n_c,) the latest of them that came at hardly any distance
    last: Any  # (n_c,) time since the start of the step of the last one
    multiplier: Any  # (n_c,) contact force
    older: Any  # (n_c,) the one before, and when
    older_time: Any
    impulse: Any  # (n_c,) since the last kept state
    p: Any  # (n_c,) of the event at hand
    plastic: Any  # (n_c,) restitution of the event at hand is zero
    chosen: Any  # (n_c,) contacts of the problem at hand
    G: Any  # (n_c, n_q)
    G_try: Any
    g_t_try: Any
    MG: Any  # (n_c, n_q)  (M^-1 G^T)^T
    W: Any  # (n_c, n_c)  G M^-1 G^T
    AG: Any  # (2, n_c, n_q)  (A^-1 G^T)^T
    WA: Any  # (2, n_c, n_c)  G A^-1 G^T
    M: Any  # (n_q, n_q)
    problem: Any  # (n_c * n_c,)
    pivots: Any  # (n_c + 1,)
    b: Any
    z: Any
    solver: Any
    lcp: Any


class Polynomial(NamedTuple):
    """A piece of motion q(tau) = sum_k T_k (tau / scale)^k, and work space for making it and finding its events."""

    T: Any  # (DEGREE + 1, n_q)
    scale: Any  # (1,)
    q: Any  # (n_q,) state last asked for
    v: Any
    q_stage: Any
    v_stage: Any
    a: Any  # (5, n_q) accelerations of the stages
    v_end: Any
    q_end: Any
    g_from: Any  # (n_c,) gaps and their velocities at both ends of an interval of the scan
    u_from: Any
    g_to: Any
    u_to: Any
    u_now: Any


DEGREE = 22  # of the Taylor polynomials
