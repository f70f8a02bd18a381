"""The state of a system with contacts that may stick and slide, under the names of mechanics, and its work space.

R v + rate are the velocities of joints, of gaps and of sliding, R a + bias their accelerations, W = R M^-1 R^T.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.events.codes import ENTERED
from lcpstep.events.hybrid.roots import SAMPLES, Scan
from lcpstep.events.rows.contacts import Contacts
from lcpstep.kernels.coefficients import Coefficients
from lcpstep.kernels.dop853 import ALL
from lcpstep.kernels.rungekutta import RungeKutta
from lcpstep.kernels.status import NOT_FINITE
from lcpstep.pointers import after, max
from lcpstep.shelf import IndexShelf, Shelf

# Of the interval looked at: stretches of motion this short take no time, nor do roundings of it
NO_TIME = 2.0**-50
# Of a contact: its gap or normal force; its sliding velocity, or the two edges of its friction cone
GUARDS = 3


class Rubbing(RungeKutta):
    """A motion under way; its field, that of the modes at hand, is given by `smooth`.

    rows, model                  the contacts as rows, which are the clock as well; the system
    scan, scan_length            the polynomials of guards; longest interval between looks at them
    constant                     M, the rows and coefficients of friction never change
    plain                        no function of the user's is in it
    n_t                          tangents: n_c, or none without friction
    a, a_free, force, R, MR, W, rate, bias, gap, velocity, multiplier, effect, impulse, change, dv, problem, mu,
    mu_s, terms, instant, before, direction, mode, was_mode, tried, loaded, may_stick, touches, parting
                                 of `rows`; W is D
    q, v : (n_q,)                state at the base time, of which `rows` knows too
    slip : (n_c,)                sliding velocities that coefficients of friction depend on
    tangential : (n_c,)          restitution on the tangent
    yields, jams                 sliding that jams ends in an impact without collision; how often it did
    in_turn                      impacts are integrated, one contact after the other: see `kernels.energetic`
    new_mode, new_direction, new_loaded : (n_c,)   as decided, but not yet obeyed
    jumped : (n_c,)              by how much its gap velocity has just jumped, of what is on its surface at a corner
    paces : (n_r + 1,)           the step to be tried next when so many rows were last held;  paced   so many now
    effects : (n_q + n_r, n_q + n_r)   what each force and bias does alone, where rows and masses never change
    loads : (16, n_r)            multipliers at the stages of the step last made
    counted, total : (n_r,)      impulses of this step that have been counted; all of it
    value, band : (3 n_c,)       guards, each acts where it falls through zero; rounding of them
    armed : (3 n_c,)             whether each has been above its band since the modes began
    hops, height, rise, bend : (n_c,)   a hop begins, or is under way, at the base; its gap, velocity, acceleration
    lands, hopping               when it lands, see `hops`; whether there are any
    carried, speed : (n_c,)      `height` is known better than by q at the base to come; the velocity there
    bracket                      in which times are sought: that of `scan`
    flying                       no contact is closed: their gaps tell all
    watch                        what looks at the guards of modes, see `switching`; None where the system has none
    since_look                   at these LOOKED; or since then a mode has begun (ENTERED), or velocities JUMPED
    loose, stray : (n_c,)        how many contacts have a row at rest that is not held; how large an acceleration of
        such a row has been, see `loose`
    leader, sharing              whose tangent is held for that of each contact at rest, where some stand for others
    risen                        the guard found has been above its band before it falls through zero
    unsure : (n_r,)              accelerations of rows that are not known where modes are sought, see `balance`
    guard, found, slope          the guard that acts, when, and how fast it falls;  seen, samples    scratch
    kept_to, shown, delay        up to when a row that is not held has stayed at rest, where it has left that, both as
        fractions of the step, and how much later than it is `found` that is

    Parameters
    ----------
    rows : Contacts;  coefficients : Coefficients;  tangential : (n_c,);  in_turn, yields : bool
    scan_length : float
    """

    watch: Any

    def __init__(
        self,
        rows: Contacts,
        coefficients: Coefficients,
        tangential: Any,
        in_turn: bool,
        yields: bool,
        scan_length: float,
    ) -> None:
        contacts = rows.model
        n, n_c, n_j, r = rows.n_q, rows.n_c, rows.n_j, rows.n_r
        RungeKutta.__init__(self, 2 * n, n, rows.rtol, rows.atol)
        self.rows, self.model = rows, contacts
        self.n_q, self.n_c, self.n_j, self.n_t, self.n_r = n, n_c, n_j, rows.n_t, r
        self.scan_length = scan_length
        self.constant = rows.fixed and not coefficients.varies
        ours = contacts.linear and not (contacts.force.given or contacts.frame.given or contacts.moded)
        self.plain = ours and self.constant and not rows.moving
        self.in_turn, self.yields, self.jams = in_turn, yields, 0
        self.scan, self.coefficients, self.problem = Scan(), coefficients, rows.problem
        self.coefficients.use(self.problem.mu)
        self.guard, self.found, self.slope = -1, -1.0, 0.0
        self.risen = self.sharing = False
        self.kept_to, self.shown, self.delay = 0.0, 2.0, 0.0
        self.table = np.zeros(4 * n + (4 + ALL) * r + 1 + (n + r) ** 2 + 9 * n_c)
        self.marks, self.arms = np.zeros(5 * n_c, dtype=np.intp), np.zeros(GUARDS * n_c, dtype=np.intp)
        self.looks, self.given = np.zeros(GUARDS * n_c * (SAMPLES + 2)), np.array(tangential, dtype=float)
        self.tangential, self.armed = doubles(self.given), indices(self.arms)
        self.share_rows()
        self.place_numbers(Shelf(self.table))
        self.place_guards(Shelf(self.looks))
        self.place_marks(IndexShelf(self.marks))
        self.paced, self.loose = 0, 0
        self.bracket, self.hopping = self.scan.bracket, False
        self.watch, self.since_look = None, ENTERED
        self.flying = False

    def share_rows(self) -> None:
        """What the rows know of the motion, and the motion of its rows."""
        self.rows.q, self.rows.v, self.rows.rough = self.y, after(self.y, self.n_q), self.coefficients.rough
        self.rows.mu, self.rows.mu_s = self.coefficients.sliding, self.coefficients.sticking
        self.q, self.v, self.mu, self.mu_s = self.rows.q, self.rows.v, self.rows.mu, self.rows.mu_s
        self.a_free, self.a = self.rows.a_free, self.rows.a
        self.force, self.dv = self.rows.force, self.rows.dv
        self.R, self.MR, self.W = self.rows.R, self.rows.MR, self.rows.D
        self.rate, self.bias, self.shifted_rate = self.rows.rate, self.rows.bias, self.rows.near
        self.change, self.multiplier, self.effect = self.rows.change, self.rows.multiplier, self.rows.effect
        self.gap, self.velocity, self.terms = self.rows.gap, self.rows.velocity, self.rows.terms
        self.impulse, self.instant, self.before = self.rows.impulse, self.rows.instant, self.rows.before
        self.direction, self.mode, self.was_mode = self.rows.direction, self.rows.mode, self.rows.was_mode
        self.tried, self.loaded = self.rows.tried, self.rows.loaded
        self.may_stick, self.touches, self.parting = self.rows.may_stick, self.rows.touches, self.rows.parting

    def place_numbers(self, x: Shelf) -> None:
        """Numbers of states, rows and contacts."""
        n, r, c = self.n_q, self.n_r, self.n_c
        self.dy, self.seen, self.paces = x.take(2 * n), x.take(2 * n), x.take(r + 1)
        self.counted, self.total, self.loads, self.unsure = x.take(r), x.take(r), x.take(ALL * r), x.take(r)
        self.effects = x.take((n + r) * (n + r))
        self.new_direction, self.slip, self.lands, self.height = x.take(c), x.take(c), x.take(c), x.take(c)
        self.rise, self.bend, self.speed, self.jumped = x.take(c), x.take(c), x.take(c), x.take(c)
        self.stray = x.take(c)

    def place_guards(self, x: Shelf) -> None:
        """Numbers of guards."""
        n = GUARDS * self.n_c
        self.value, self.band, self.samples = x.take(n), x.take(n), x.take(n * SAMPLES)

    def place_marks(self, x: IndexShelf) -> None:
        """Whole numbers per contact."""
        n = self.n_c
        self.new_mode, self.new_loaded, self.hops = x.take(n), x.take(n), x.take(n)
        self.carried, self.leader = x.take(n), x.take(n)

    def proceed(self) -> int:
        """Go on up to the first event, no further than a step; a status. Every way to step has its own."""
        return NOT_FINITE

    def no_time(self) -> float:
        """How short a stretch of motion from the base on is no time; at time zero nothing is rounding of it."""
        return float(max(NO_TIME * self.scan_length, self.rows.untold(0.0)))

    def straying_at(self, place: float, h: float, level: float) -> int:
        """`loose.straying` at that fraction of the step of size h; -1 where a state is not finite. As `proceed`."""
        return -1

    @cython.ccall
    def coefficient(self, c: int) -> float:
        """The coefficient of friction with which contact c slides."""
        return float(self.mu[c])

    @cython.ccall
    def critical_friction(self, c: int) -> float:
        """The coefficient of friction beyond which contact c, sliding as it does, jams; 0 where none does."""
        i = self.n_j + c
        coupling = self.direction[c] * self.W[i * self.n_r + i + self.n_c]
        return self.W[i * self.n_r + i] / coupling if coupling > 0.0 else 0.0
