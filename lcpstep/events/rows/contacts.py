"""Contacts as rows: what is known of each, and what happens to it, as kernels; both loops share this.

    C_c = N_c - s mu T_c where contact c slides (sign s)

What the modes hold is held in turn: joints, what sticks, normals that slide (those that carry a force first), see
`held`. Without friction there are no tangents, and what is closed slides.
Source: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapters 5 and 6.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.events.codes import BEGIN, LEANS, OPEN, SLIDES, STICKS
from lcpstep.events.rows.equations import least_gap, least_speed, size_of
from lcpstep.events.rows.held import constrain, hold, hold_joints, is_held
from lcpstep.events.rows.loads import list_by_row
from lcpstep.events.rows.on_joints import can_bear
from lcpstep.events.rows.state import Rows
from lcpstep.kernels.coulomb import ContactProblem
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.together import gap_rounding
from lcpstep.kernels.vectors import add, product, size_of_product
from lcpstep.pointers import Doubles, abs, after, inf, max
from lcpstep.shelf import IndexShelf, Shelf

STILL = 100.0  # tolerances: a sliding velocity this small at the start, or at an event, is zero


class Contacts(Rows):
    """Rows whose contacts open and close, stick and slide, strike and chatter.

    next, culprit       what comes next: BEGIN, MOVE, ...; contact or joint that a failure is about, or -1
    rounds, stalled     problems of impacts at this instant; events at one time before it
    mapped              whether what forces do is known for the rows held, see `contacts.held`
    problem             the complementarity problem at hand, of an impact or of forces
    q, v, a : (n_q,)    state at hand, and acceleration with constraints;  multiplier : (n_r,)   forces by row
                        (impulses while a chattering is ended)
    dv, each : (n_q,), effect : (n_q + n_r,)   velocities on trial; accelerations by the forces, their signs left
                        aside; such an acceleration and its multipliers
    gap, velocity : (n_r,)   of rows at the state last measured;  curve : (n_c,)   gap accelerations
    impulse : (n_r,)    contacts, tangents, joints, since the last kept state
    turn_velocity, turn_impulse : (n_r,)   velocities some impacts of this instant ago; impulses since then
    before : (n_c,)     gap velocities before the impact at hand, 0 of what is closed
    terms : (2 n_c,)    rounding of gap and sliding velocities, at the impacts of one instant
    owed : (2 n_c,)     impulses of normals and tangents that the end of chattering has taken on account
    instant : (n_r,)    impulses since this instant has begun, whatever is kept
    struck, since : (n_c,)       time of the last impact, since the one before
    left, chatter_end : (n_c,)   how long the sequence that is summed up lasts, or -1; when it ends
    mu, mu_s, rough : (n_c,)     friction of what slides and of what sticks; whether there is any
    mode, was_mode, tried : (n_c,)      OPEN, STICKS, SLIDES, LEANS; as last told; while others are tried
    direction, was_direction : (n_c,)   sign of the sliding velocity
    loaded, may_stick, touches : (n_c,)      carries a force; slides in no direction; gap zero, whatever it measures
    parting : (n_c,)    opened by the forces between impacts of one instant
    given               as of `Rows`
    """

    def __init__(self, *given: Any) -> None:
        Rows.__init__(self, *given)
        n, n_c, r = self.n_q, self.n_c, self.n_r
        self.next, self.culprit, self.mapped, self.rounds, self.stalled = BEGIN, -1, False, 0, 0
        self.problem = ContactProblem(np.zeros(n_c), self.n_t > 0, r, False)
        self.contact_numbers = np.zeros(4 * n + 7 * r + 12 * n_c)
        x = Shelf(self.contact_numbers)
        self.a, self.dv, self.each = x.take(n), x.take(n), x.take(n)
        self.effect = x.take(n + r)
        self.multiplier, self.gap, self.velocity = after(self.effect, n), x.take(r), x.take(r)
        self.impulse, self.turn_impulse, self.turn_velocity, self.instant = (
            x.take(r),
            x.take(r),
            x.take(r),
            x.take(r),
        )
        self.terms, self.owed, self.before = x.take(2 * n_c), x.take(2 * n_c), x.take(n_c)
        self.curve, self.struck, self.since, self.left = x.take(n_c), x.take(n_c), x.take(n_c), x.take(n_c)
        self.chatter_end, self.direction, self.was_direction = x.take(n_c), x.take(n_c), x.take(n_c)
        self.marks = np.zeros(7 * n_c, dtype=np.intp)
        k = IndexShelf(self.marks)
        self.mode, self.was_mode, self.tried = k.take(n_c), k.take(n_c), k.take(n_c)
        self.loaded, self.may_stick, self.touches = k.take(n_c), k.take(n_c), k.take(n_c)
        self.parting = k.take(n_c)
        # Of their owner: the state, and friction, if there is any
        self.q, self.v = self.a, self.dv
        self.mu, self.mu_s, self.rough = self.before, self.before, self.may_stick
        for c in range(n_c):
            self.struck[c] = self.chatter_end[c] = -inf

    def noise(self, c: int) -> float:
        """Rounding of the gap velocity of contact c, that of the earlier impacts of the same instant included."""
        return self.terms[c]

    def rounding_of_gap(self, c: int) -> float:
        """Rounding of gap c at the state at hand, as far as its terms are known, and of joints that move it."""
        R, i = after(self.R, self.n_j * self.n_q), self.n_j + c
        size = abs(self.gap[i])
        for j in range(self.n_j):
            share = self.D[i * self.n_r + j]
            if share != 0.0:
                size += abs(share) / self.D[j * self.n_r + j] * size_of_product(self.R, self.q, j, self.n_q)
        return gap_rounding(self.model, R, self.q, c, size)

    def mode_closed(self, c: int) -> int:
        """The mode in which contact c would be closed: it slides on, if it does."""
        return STICKS if rubs(self, c) and has_stopped(self, c) else SLIDES

    def push(self, i: int, p: float) -> None:
        """Apply the impulse p on row i, and count it.

        What is taken from velocities again leaves rounding, and p is known as well as the velocity that asked for it.
        """
        known, own = NOISE * abs(p), self.D[i * self.n_r + i]
        if p != 0.0 and own > 0.0:
            known = max(known, NOISE * size_of(self, i, self.rate[i], self.v) / own)
        add(self.v, p, after(self.MR, i * self.n_q), self.n_q)
        for k in range(self.n_c + self.n_t):
            self.terms[k] = max(self.terms[k], abs(self.D[(self.n_j + k) * self.n_r + i]) * known)
        add_impulse(self, i, p)

    def stop(self) -> None:
        """Take their velocities from the closed contacts, or from joints alone where these cannot be held."""
        if not hold_modes(self):
            hold_joints(self)
        stop_rows(self)

    def closed_ones(self) -> list[int]:
        """The contacts that are closed."""
        return [c for c in range(self.n_c) if self.mode[c] != 0]


def gap_of(s: Contacts, c: int) -> float:
    """The gap of contact c, zero where it touches."""
    return 0.0 if s.touches[c] == 1 else s.gap[s.n_j + c]


def is_met(s: Contacts, c: int) -> bool:
    """Whether contact c is open and touches."""
    return s.mode[c] == OPEN and gap_of(s, c) == 0.0


def add_impulse(s: Contacts, i: int, p: float) -> None:
    """Count an impulse of row i: contacts are kept first, then tangents and joints."""
    k = i - s.n_j if i >= s.n_j else s.n_c + s.n_t + i
    s.impulse[k] = s.impulse[k] + p
    # Of their own: differences would depend on what has been kept
    s.turn_impulse[k], s.instant[k] = s.turn_impulse[k] + p, s.instant[k] + p


def measure_velocities(s: Contacts, v: Doubles) -> None:
    """Velocities R v + rate of all rows; `terms` of contacts and tangents grow to their rounding.

    Nor is more known of one than what forces make in a time that cannot be told, those of contacts among them: what
    is left at rest means nothing.
    """
    moment = s.untold(0.0)
    size_up(s)
    for i in range(s.n_r):
        s.velocity[i] = product(s.R, v, i, s.n_q) + s.rate[i]
    for i in range(s.n_c + s.n_t):
        k = s.n_j + i
        unknown = moment * size_of(s, k, 0.0, s.each)
        s.terms[i] = max(s.terms[i], NOISE * size_of(s, k, s.rate[k], v) + unknown)


def size_up(s: Contacts) -> None:
    """How large the accelerations are of which forces that balance each other are the sum, into `each`."""
    for j in range(s.n_q):
        s.each[j] = abs(s.a_free[j])
    for i in range(s.n_r):
        if s.multiplier[i] != 0.0:
            for j in range(s.n_q):
                s.each[j] += abs(s.MR[i * s.n_q + j] * s.multiplier[i])


def gap_tolerance(s: Contacts, c: int) -> float:
    """The gap of contact c that goes without moving a coordinate by more than its tolerance."""
    return least_gap(s, s.n_j + c, s.q)


def speed_tolerance(s: Contacts, i: int) -> float:
    """The velocity of row i that goes without changing a velocity by more than its tolerance."""
    return least_speed(s, i, s.v)


def still_below(s: Contacts, i: int) -> float:
    """The velocity of row i below which it is zero."""
    return NOISE * size_of(s, i, s.rate[i], s.v) + STILL * speed_tolerance(s, i)


def has_stopped(s: Contacts, c: int) -> bool:
    """Whether contact c has no sliding velocity, or none that can be told from zero."""
    return s.n_t == 0 or abs(sliding(s, c)) <= still_below(s, s.n_j + s.n_c + c)


def rubs(s: Contacts, c: int) -> bool:
    """Whether contact c may have friction: one whose normal the joints hold already bears nothing to rub with."""
    return s.n_t > 0 and s.rough[c] == 1 and can_bear(s, c)


def sliding(s: Contacts, c: int) -> float:
    """The sliding velocity of contact c as last measured; 0 without friction, where there are no tangents."""
    return s.velocity[s.n_j + s.n_c + c] if s.n_t > 0 else 0.0


def of_tangent(s: Contacts, x: Doubles, c: int) -> float:
    """Of impulses of contacts, then tangents, that of the tangent of contact c; 0 where there are none."""
    return x[s.n_c + c] if s.n_t > 0 else 0.0


def friction_ratio(s: Contacts, i: int) -> float:
    """How much of the `other` force of its contact comes with that of row i.

    -s mu of the tangent's with a normal that slides or leans; the inverse of the normal's where the tangent of a
    contact that leans is held.
    """
    c = i - s.n_j
    if 0 <= c < s.n_c and s.mode[c] >= SLIDES:
        return -s.direction[c] * (s.mu[c] if s.mode[c] == SLIDES else s.mu_s[c])
    c -= s.n_c
    return -s.direction[c] / s.mu_s[c] if c >= 0 and s.mode[c] == LEANS else 0.0


def hold_row(s: Contacts, i: int) -> bool:
    """Add row i to the rows held, unless it depends on them; False where sliding takes its force away.

    Of what leans on others the sign tells nothing: it does not slide.
    """
    if s.n_t > 0:
        leans = i >= s.n_j and s.mode[(i - s.n_j) % s.n_c] == LEANS
        s.share[i], s.either[i] = friction_ratio(s, i), 1 if leans else 0
    return hold(s, i)


def hold_modes(s: Contacts) -> bool:
    """Hold what the modes hold; False where a sliding contact has no force that would (`culprit`).

    What sticks comes first: it may carry what a contact that leans on it, or slides beside it, could not by itself.
    """
    s.mapped = False
    hold_joints(s)
    for tangent in range(2 if s.n_t > 0 else 0):
        for c in range(s.n_c):
            if s.mode[c] == STICKS:
                hold_row(s, s.n_j + tangent * s.n_c + c)
    for unloaded in range(2):
        for c in range(s.n_c):
            if s.mode[c] >= SLIDES and s.loaded[c] == 1 - unloaded and not hold_row(s, s.n_j + c):
                s.culprit = c
                return False
        if unloaded == 0 and s.n_t > 0:
            hold_leaning(s)
    return True


def hold_leaning(s: Contacts) -> None:
    """The tangents of loaded contacts that lean, whose normals depend on the rows held.

    Three feet on a line share two normals and one tangent: their forces are known from these three rows.
    """
    for c in range(s.n_c):
        if s.mode[c] == LEANS and s.loaded[c] == 1 and not is_held(s, s.n_j + c):
            hold_row(s, s.n_j + c + s.n_c)


def list_multipliers(s: Contacts) -> None:
    """Forces by row from those of the rows held."""
    list_by_row(s, s.held, s.multiplier)


def stop_joints(s: Contacts) -> None:
    """Take their velocities from the joints."""
    hold_joints(s)
    stop_rows(s)


def stop_rows(s: Contacts) -> None:
    """Impulses on the rows held, sliding friction included, that take their velocities; all velocities after them."""
    constrain(s, s.v, s.rate)
    count_impulses(s, s.held)
    measure_velocities(s, s.v)


def count_impulses(s: Contacts, x: Doubles) -> None:
    """Count impulses of the rows held."""
    list_by_row(s, x, s.near)
    for i in range(s.n_r):
        add_impulse(s, i, s.near[i])
