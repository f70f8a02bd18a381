"""The state of a system with contacts that may stick and slide, under the names of mechanics, and its work space.

R v + rate are the velocities of joints, of gaps and of sliding, R a + bias their accelerations, W = R M^-1 R^T.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.events.contacts.codes import BEGIN, ENTERED
from lcpstep.kernels.dop853 import ALL
from lcpstep.kernels.status import NOT_FINITE

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.events.hybrid.roots import CHECKS, DEGREE, Scan
    from lcpstep.events.rows.state import Rows
    from lcpstep.kernels.bracket import Bracket
    from lcpstep.kernels.coefficients import Coefficients
    from lcpstep.kernels.coulomb import ContactProblem
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.rungekutta import RungeKutta
    from lcpstep.kernels.tally import Tally
    from lcpstep.pointers import after, indices_after, inf

# Of a contact: its gap or normal force; its sliding velocity, or the two edges of its friction cone
GUARDS = 3


class Rubbing(RungeKutta):
    """A motion under way; its field, that of the modes at hand, is given by `smooth`.

    rows, clock, model           the rows of joints, contacts and tangents, which are the clock as well; the system
    t_end, scan, scan_length     end of the span; the polynomials of guards; longest interval between looks at them
    constant                     M, the rows and coefficients of friction never change
    plain                        no function of the user's is in it
    next                         what comes next: BEGIN, MOVE, JUMP, SETTLE or OBEY
    n_t                          tangents: n_c, or none without friction
    q, v : (n_q,)                state at the base time
    a : (n_q,)                   acceleration with constraints
    a_free, force, R, MR, W, rate, bias   of `rows`, of which W is the Delassus matrix D;  S, change   of `rows`
    gap, velocity : (n_r,)       of rows at the state last measured
    mu, mu_s : (n_c,)            coefficients of friction of what slides and of what sticks, from `coefficients`
    slip : (n_c,)                sliding velocities that these depend on
    tangential : (n_c,)          restitution on the tangent
    yields                       sliding that jams ends in an impact without collision
    in_turn                      impacts are integrated, one contact after the other: see `kernels.energetic`
    mode, was_mode, new_mode : (n_c,)    OPEN, STICKS, SLIDES; as last told; as decided, but not yet obeyed
    direction, was_direction, new_direction : (n_c,)   sign of the sliding velocity
    loaded, new_loaded, free, touches : (n_c,)   carries a force; as decided; slides in no direction; gap zero
    parting : (n_c,)             opened by the forces between impacts of one instant
    tried : (n_c,)               modes, while others are tried
    thrown : (n_c,)              closed, and the velocity of its obstacle has just jumped
    terms : (2 n_c,)             rounding of gap and sliding velocities, at the impacts of one instant
    owed : (2 n_c,)              impulses of normals and tangents that the end of chattering has taken on account
    paces : (n_r + 1,)           the step to be tried next when so many rows were last held;  paced   so many now
    effect : (n_q + n_r,)        `a`, and `multiplier` : (n_r,) by row, under forces and biases, where rows and masses
        never change;  effects : (n_q + n_r, n_q + n_r)   what each of these does alone;  mapped   whether it is known
    impulse : (n_r,)             contacts, tangents, joints, since the last kept state
    loads : (16, n_r)            multipliers at the stages of the step last made
    counted, total : (n_r,)      impulses of this step that have been counted; all of it
    value, band : (3 n_c,)       guards, each acts where it falls through zero; rounding of them
    armed : (3 n_c,)             whether each has been above its band since the modes began
    hops, height, rise, bend : (n_c,)   a hop begins, or is under way, at the base; its gap, velocity, acceleration
    lands, hopping               when it lands, see `hops`; whether there are any
    carried, speed : (n_c,)      `height` is known better than by q at the base to come; the velocity there
    struck, since : (n_c,)       time of the last impact, since the one before
    left, chatter_end : (n_c,)   how long the sequence that is summed up lasts, or -1; when it ends
    curve : (n_c,)               accelerations of gaps, where chattering is looked at
    bracket                      in which a landing is sought
    flying                       no contact is closed: their gaps tell all
    watch, watched               what looks at the guards of modes, see `switching`; whether the system has any
    guards                       LOOKED, or since then a mode has begun (ENTERED), or velocities have jumped (JUMPED)
    loose, stray : (n_c,)        how many contacts have a row at rest that is not held; how large an acceleration of
        such a row has been, see `loose`
    risen                        the guard found has been above its band before it falls through zero
    jams                         how often it did
    rounds, stalled              problems of impacts at this instant; events at one time before it
    problem                      the complementarity problem at hand, of an impact or of forces
    turn_velocity, turn_impulse : (n_r,)   velocities some impacts ago;  `impulse` since then, whatever is kept
    before : (n_c,)              gap velocities before the impact at hand, 0 of what is closed
    doubt : (n_r,)               accelerations of rows that are not known where modes are sought, see `balance`
    instant : (n_r,)             `impulse` since this instant has begun, whatever is kept
    guard, found, slope          the guard that acts, when, and how fast it falls;  dv, seen, samples    scratch
    kept_to, shown, delay        up to when a row that is not held has stayed at rest, where it has left that, both as
        fractions of the step, and how much later than it is `found` that is
    culprit                      contact or joint that a failure is about, or -1

    Parameters
    ----------
    rows : Rows;  coefficients : Coefficients;  tangential : (n_c,);  in_turn, yields : bool
    t_end, scan_length : float;  nodes, weights : quadrature on [0, 1]
    """

    watch: Any

    def __init__(
        self,
        rows: Rows,
        coefficients: Coefficients,
        tangential: Any,
        in_turn: bool,
        yields: bool,
        t_end: float,
        scan_length: float,
        nodes: Any,
        weights: Any,
    ) -> None:
        contacts = rows.model
        n, n_c, n_j, r = rows.n_q, rows.n_c, rows.n_j, rows.n_r
        RungeKutta.__init__(self, 2 * n, n, rows.rtol, rows.atol)
        self.rows, self.clock, self.model = rows, rows, contacts
        self.n_q, self.n_c, self.n_j, self.n_t, self.n_r = n, n_c, n_j, rows.n_t, r
        self.t_end, self.scan_length, self.next = t_end, scan_length, BEGIN
        self.constant = rows.fixed and not coefficients.varies
        ours = contacts.linear and not (contacts.force.given or contacts.frame.given or contacts.moded)
        self.plain = ours and self.constant and not rows.moving
        self.mapped = False
        self.in_turn, self.yields, self.jams, self.rounds, self.stalled = in_turn, yields, 0, 0, 0
        self.scan, self.problem = Scan(), ContactProblem(np.zeros(n_c), True, r, False)
        self.coefficients = coefficients
        self.coefficients.use(self.problem.mu)
        self.culprit, self.guard, self.found, self.slope = -1, -1, -1.0, 0.0
        self.risen = False
        self.kept_to, self.shown, self.delay = 0.0, 2.0, 0.0
        self.rule = np.array([nodes, weights])
        self.n_nodes, self.nodes = len(nodes), doubles(self.rule)
        self.weights = after(self.nodes, self.n_nodes)
        self.table = np.zeros(8 * n + (9 + ALL) * r + 1 + (n + r) ** 2)
        self.q, self.v = self.y, after(self.y, n)
        self.a_free, self.force = self.rows.a_free, self.rows.force
        self.R, self.MR, self.W = self.rows.R, self.rows.MR, self.rows.D
        self.rate, self.bias, self.shifted_rate = self.rows.rate, self.rows.bias, self.rows.near
        self.change, self.S = self.rows.change, self.rows.S
        self.a = doubles(self.table)
        self.dy = after(self.a, n)
        self.seen = after(self.dy, 2 * n)
        self.dv = after(self.seen, 2 * n)
        self.gap = after(self.dv, 2 * n)
        self.velocity = after(self.gap, r)
        self.impulse = after(self.velocity, r)
        self.instant = after(self.impulse, r)
        self.paces, self.paced = after(self.instant, r), 0
        self.counted = after(self.paces, r + 1)
        self.total = after(self.counted, r)
        self.loads = after(self.total, r)
        self.doubt = after(self.loads, ALL * r)
        self.effect = after(self.doubt, r)
        self.multiplier = after(self.effect, n)
        self.effects = after(self.multiplier, r)
        self.per_contact = np.zeros(20 * n_c)
        self.given = np.array(tangential, dtype=float)
        self.mu, self.mu_s = self.coefficients.sliding, self.coefficients.sticking
        self.tangential = doubles(self.given)
        self.direction = doubles(self.per_contact)
        self.was_direction = after(self.direction, n_c)
        self.new_direction = after(self.direction, 2 * n_c)
        self.terms = after(self.direction, 3 * n_c)
        self.before = after(self.direction, 5 * n_c)
        self.owed = after(self.direction, 6 * n_c)
        self.slip = after(self.direction, 8 * n_c)
        self.lands = after(self.direction, 9 * n_c)
        self.height = after(self.direction, 10 * n_c)
        self.rise = after(self.direction, 11 * n_c)
        self.bend = after(self.direction, 12 * n_c)
        self.speed = after(self.direction, 13 * n_c)
        self.struck = after(self.direction, 14 * n_c)
        self.since = after(self.direction, 15 * n_c)
        self.chatter_end = after(self.direction, 16 * n_c)
        self.left = after(self.direction, 17 * n_c)
        self.curve = after(self.direction, 18 * n_c)
        self.stray, self.loose = after(self.direction, 19 * n_c), 0
        self.bracket, self.hopping = Bracket(), False
        self.watch, self.watched, self.guards = None, False, ENTERED
        self.flying = False
        self.marks = np.zeros(12 * n_c, dtype=np.intp)
        self.mode = indices(self.marks)
        self.was_mode = indices_after(self.mode, n_c)
        self.new_mode = indices_after(self.mode, 2 * n_c)
        self.loaded = indices_after(self.mode, 3 * n_c)
        self.free = indices_after(self.mode, 4 * n_c)
        self.touches = indices_after(self.mode, 5 * n_c)
        self.new_loaded = indices_after(self.mode, 6 * n_c)
        self.parting = indices_after(self.mode, 7 * n_c)
        self.thrown = indices_after(self.mode, 8 * n_c)
        self.tried = indices_after(self.mode, 9 * n_c)
        self.hops = indices_after(self.mode, 10 * n_c)
        self.carried = indices_after(self.mode, 11 * n_c)
        for c in range(n_c):
            self.struck[c] = self.chatter_end[c] = -inf
        samples = DEGREE + 1 + CHECKS
        self.looks = np.zeros(GUARDS * n_c * (samples + 2))
        self.value = doubles(self.looks)
        self.band = after(self.value, GUARDS * n_c)
        self.samples = after(self.band, GUARDS * n_c)
        self.turn = np.zeros(2 * r)
        self.turn_velocity = doubles(self.turn)
        self.turn_impulse = after(self.turn_velocity, r)
        self.arms = np.zeros(GUARDS * n_c, dtype=np.intp)
        self.armed = indices(self.arms)

    def watch_modes(self, watch: Any) -> None:
        """Look at the guards of a system with modes along the motion."""
        watch.share(self)
        self.watch, self.watched = watch, True

    def proceed(self, record: Record, tally: Tally) -> int:
        """Go on up to the first event, no further than a step; a status. Every way to step has its own."""
        return NOT_FINITE

    def straying_at(self, place: float, h: float, level: float) -> int:
        """`loose.straying` at that fraction of the step of size h; -1 where a state is not finite. As `proceed`."""
        return -1

    def closed_ones(self) -> list[int]:
        """The contacts that are closed."""
        return [c for c in range(self.n_c) if self.mode[c] != 0]

    def coefficient(self, c: int) -> float:
        """The coefficient of friction with which contact c slides."""
        return float(self.mu[c])

    def critical_friction(self, c: int) -> float:
        """The coefficient of friction beyond which contact c, sliding as it does, jams; 0 where none does."""
        i = self.n_j + c
        coupling = self.direction[c] * self.W[i * self.n_r + i + self.n_c]
        return self.W[i * self.n_r + i] / coupling if coupling > 0.0 else 0.0
