"""What the kernels of `Located` work with: constants of steps, the piece of smooth motion at hand, work space."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.bracket import Bracket
from lcpstep.kernels.sudden import Sudden
from lcpstep.lcp.workspace import Workspace
from lcpstep.pointers import inf
from lcpstep.shelf import IndexShelf, Shelf

VECTORS, NUMBERS, MARKS = 16, 31, 9  # of n_q numbers each; of n_c; of n_c whole numbers
LISTS = 3  # of n_c whole numbers more: contacts of the problem at hand
SEEN = ("first_coordinate", "last_coordinate", "first_contact", "last_contact")  # by Python, after the first


class Plan:
    """Constants of steps of one size.

    h
    made_for        length of pieces that the matrices in the place WHOLE are made for: h, but in parts of a step
    stiff           C or K is not zero; this, the next two and `constant` are asked of linear systems alone
    steady          the acceleration without contact never changes
    plain           flat contacts at rest, of a linear system: gaps of order 2 follow from their own quadratics
    constant        M and the gap Jacobian are constant
    slack           gaps up to here count as zero
    per_step        events in one step
    many            impacts of a contact in one step after which hops are taken as one if they end within it
    exact           pieces are Taylor polynomials; else, where pieces are polynomials, Runge-Kutta
    longest         piece of motion
    clock           which knows the corners that the scene names
    margin          by which times are moved off a corner of the scene
    A_inverse : (2, n_q, n_q)     (M + h/2 C + h^2/4 K)^-1, for WHOLE and REST
    AG : (2, n_c, n_q)            (A^-1 G^T)^T
    WA : (2, n_c, n_c)            G A^-1 G^T

    Parameters
    ----------
    fields : dict   these by name; A_inverse, AG and WA as arrays
    """

    def __init__(self, fields: dict[str, Any]) -> None:
        self.h = self.made_for = fields["h"]
        self.stiff, self.steady, self.exact = fields["stiff"], fields["steady"], fields["exact"]
        self.plain, self.constant = fields["plain"], fields["constant"]
        self.slack, self.longest, self.margin = fields["slack"], fields["longest"], fields["margin"]
        self.per_step, self.many, self.clock = fields["per_step"], fields["many"], fields["clock"]
        self.kept = fields["A_inverse"], fields["AG"], fields["WA"]  # which the next three point into
        self.A_inverse = doubles(self.kept[0])
        self.AG, self.WA = doubles(self.kept[1]), doubles(self.kept[2])


class Work:
    """The piece of motion that began at the last event or step, and work space.

    Over a piece of order 2 q(tau) = q + v tau + a tau^2 / 2, and open gaps are g + u tau + half tau^2.

    Vectors, a number per coordinate:
    q, v            state at the base of the piece
    a_free, a       acceleration without contact forces, and with them
    force, next_force    F(t) of linear systems at the base, and at the end of the smooth interval
    q_try, v_try, a_try    to try; of an impact v_try are the sizes of the terms of v
    jolt            change by the impulses or forces of several contacts
    q_from, v_from, a_from    state, acceleration at the base of a piece within which states are kept
    q_time          time since the start of the step up to which a coordinate has been moved on
    swing           largest sum of the terms of a velocity at the impacts of this step
    v_struck        velocity just before the event after which the loop stopped

    A number per contact:
    gap, velocity   g, u
    half            half the gap acceleration
    alpha           gap acceleration without contact forces
    bend            what the mean acceleration lacks for the position, of moving flat obstacles
    bias            gap acceleration at v' = 0
    gap_try, gap_t, gap_t_try
    end_u, end_s    s' and s'' of the obstacles at the end of the smooth interval
    last            time of the last impact since the start of the step, -1 before there was one
    force_now       contact force
    older, older_time    the last positive contact force, and when
    pushed          impulse of forces since the step began, strikes aside, that a tolerance looks at
    impulse         since the last kept state
    p               impulses of `race`, or forces of closed contacts, by contact
    b, z            of the complementarity problem at hand, and its solution
    residual, change, doubt    what the solution leaves, its correction, and the relative error of factors
    before          gap velocity before the impact or corner at hand, or where the piece begins in which it may jump
    impulse_from    impulses at the base of a piece within which states are kept
    since, next_zero     time since the start of the step to which gap and gap velocity belong, and of the next zero
    turned, turns   time since the start of the step at which a contact last struck, closed or opened, and how often
                    it has done so with hardly any time between
    hops            how often it has done so with little time between, hardly moving, beside closed contacts
    fall            speed at which a gap that falls freely from its last impact will close; 0: something else acts

    A whole number per contact:
    status          OPEN or CLOSED
    grounded        0, GROUND or LEFT
    hits            impacts in this step
    close_hits      the latest of them that came at hardly any distance
    plastic         restitution of the event at hand is zero
    first_coordinate, last_coordinate    range of the coordinates that an impulse changes, if constant,
    first_contact, last_contact          and of the gaps

    Lists, of the problem at hand alone: steps by a tolerance that go back leave them as they are
    chosen          its contacts
    held, place     those of them that carry an impulse or a force, and their places in the list; where contacts
                    are chosen `place` but marks them

    Matrices, row by row:
    G, G_try, MG : (n_c, n_q)   gap Jacobian, one to try, (M^-1 G^T)^T
    W : (n_c, n_c)              G M^-1 G^T
    M : (n_q, n_q)              factor of a mass matrix that changes
    moved : (n_q,)   coordinates that an impulse moves
    problem : (n_c, n_c);  lcp     work space of complementarity problems
    bracket         in which a root is sought;  sudden   in which a jump is

    The loop's numbers:
    t_step          time at which the step began,
    sigma           and since then: the base of the piece is at t_step + sigma
    end             of the smooth interval in the step
    low, high       the interval of time without corners
    jump            the corner found last that the scene does not name
    margin          by which times are moved off a corner: the plan's, or more where a jump takes some time
    events          in this step, rounds of the loop without one included
    under_way       whether a step is
    closed_now      how many contacts are closed
    n_held          how many of them the factor in `problem` has, in `held`; of polynomials alone
    unchanged       whether the gaps have the accelerations of the piece before
    made_with       the place of the matrices that the piece was made with
    touching        whether an open contact may touch at rest
    stalled         the stretch of time that events without end are settled over (0: there are none),
    settled         and how often that has been done in this step
    ahead           the time from the base of a piece at which its contact forces were decided

    What steps by a tolerance ask for:
    pausing         to stop after an event
    fresh           whether no smooth interval has begun yet
    off             how far the last piece was put from where it led, onto obstacles and out of them
    blind           how far a single piece goes in which events are not looked for (0: they are)
    goal            the time at the end of the step

    record          what is kept of the motion
    seen            arrays of some of these, by name, that Python reads and writes

    Counters:
    steps, lcp_calls, force_evaluations
    events_left     events still allowed
    cut             stretches of motion cut short by one plastic impact
    members         contacts of the last problem of several
    idle            rounds of the loop that found no event

    Parameters
    ----------
    n_q, n_c : int   coordinates, contacts
    """

    def __init__(self, n_q: int, n_c: int) -> None:
        self.n_q, self.n_c = n_q, n_c
        self.record: Any = None
        self.numbers = np.zeros(VECTORS * n_q + NUMBERS * n_c)
        self.marks = np.zeros((MARKS + LISTS) * n_c, dtype=np.intp)
        self.seen: dict[str, Any] = {name: self.marks[(k + 1) * n_c :][:n_c] for k, name in enumerate(SEEN)}
        self.seen |= {"q": self.numbers[:n_q], "v": self.numbers[n_q : 2 * n_q]}
        self.seen["chosen"] = self.marks[MARKS * n_c :][:n_c]
        self.seen["impulse"] = self.numbers[VECTORS * n_q :][:n_c]
        self.matrices = np.zeros(3 * n_c * n_q + n_q * n_q + 2 * n_c * n_c)
        self.places = np.zeros(n_q, dtype=np.intp)
        self.lcp, self.moved, self.bracket = Workspace(n_c), indices(self.places), Bracket()
        self.sudden, self.jump, self.margin = Sudden(), -inf, 0.0
        x = Shelf(self.numbers)
        self.place_vectors(x)
        self.place_numbers(x)
        self.place_marks(IndexShelf(self.marks))
        self.place_matrices(Shelf(self.matrices))
        self.t_step = self.sigma = self.end = self.low = self.high = self.stalled = self.settled = 0.0
        self.ahead = self.blind = self.goal = self.off = 0.0
        self.under_way = self.unchanged = self.touching = self.pausing = self.fresh = False
        self.events = self.closed_now = self.made_with = 0
        self.steps = self.lcp_calls = self.force_evaluations = self.events_left = 0
        self.cut = self.members = self.idle = self.n_held = 0
        for c in range(n_c):
            self.last_coordinate[c], self.last_contact[c] = n_q - 1, n_c - 1

    def place_vectors(self, x: Shelf) -> None:
        """Numbers per coordinate; the position comes first, then the velocity."""
        n = self.n_q
        self.q, self.v, self.a_free, self.a = x.take(n), x.take(n), x.take(n), x.take(n)
        self.force, self.next_force, self.q_try, self.v_try = x.take(n), x.take(n), x.take(n), x.take(n)
        self.a_try, self.jolt, self.q_from, self.v_from = x.take(n), x.take(n), x.take(n), x.take(n)
        self.a_from, self.q_time, self.swing, self.v_struck = x.take(n), x.take(n), x.take(n), x.take(n)

    def place_numbers(self, x: Shelf) -> None:
        """Numbers per contact; impulses come first."""
        n = self.n_c
        self.impulse, self.velocity, self.half, self.alpha = x.take(n), x.take(n), x.take(n), x.take(n)
        self.bend, self.bias, self.gap_try, self.gap_t = x.take(n), x.take(n), x.take(n), x.take(n)
        self.gap_t_try, self.end_s, self.last, self.force_now = x.take(n), x.take(n), x.take(n), x.take(n)
        self.older, self.older_time, self.p, self.b = x.take(n), x.take(n), x.take(n), x.take(n)
        self.z, self.residual, self.change, self.doubt = x.take(n), x.take(n), x.take(n), x.take(n)
        self.before, self.impulse_from = x.take(n), x.take(n)
        self.since, self.next_zero = x.take(n), x.take(n)
        self.turned, self.turns, self.hops, self.fall = x.take(n), x.take(n), x.take(n), x.take(n)
        self.pushed, self.end_u, self.gap = x.take(n), x.take(n), x.take(n)

    def place_marks(self, x: IndexShelf) -> None:
        """Whole numbers per contact: `status`, those of SEEN, others, and LISTS."""
        n = self.n_c
        self.status, self.first_coordinate, self.last_coordinate = x.take(n), x.take(n), x.take(n)
        self.first_contact, self.last_contact = x.take(n), x.take(n)
        self.hits, self.close_hits, self.plastic, self.grounded = x.take(n), x.take(n), x.take(n), x.take(n)
        self.chosen, self.held, self.place = x.take(n), x.take(n), x.take(n)

    def place_matrices(self, x: Shelf) -> None:
        """Matrices."""
        n, n_c = self.n_q, self.n_c
        self.G, self.G_try, self.MG, self.M = x.take(n_c * n), x.take(n_c * n), x.take(n_c * n), x.take(n * n)
        self.W, self.problem = x.take(n_c * n_c), x.take(n_c * n_c)
