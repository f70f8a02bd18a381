"""The state of a system with contacts and joints, under the names of mechanics, and its work space."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.events.rows.state import Rows
    from lcpstep.kernels.model import Model
    from lcpstep.lcp.workspace import Workspace
    from lcpstep.pointers import after, indices_after, inf

CONTACTS, MARKS = 12, 5  # numbers per contact besides those of `Pressed`, and marks of a contact
BEGIN, MOVE, JUMP, SETTLE = range(4)  # what comes next


class Pressed:
    """Contacts or joints at the state of the system; each is a row of the equations.

    gap, speed, curve : (n,)   gap, its velocity and acceleration;  multiplier : (n,)   force
    rate, bias, G     of their rows, see `Rows`
    impulse           since the last kept state
    turn_impulse      since a number of impacts ago, at one instant

    Parameters
    ----------
    n : int
    """

    def __init__(self, n: int) -> None:
        self.n, self.own = n, np.zeros(6 * n)
        self.gap = doubles(self.own)
        self.speed = after(self.gap, n)
        self.curve = after(self.speed, n)
        self.multiplier = after(self.curve, n)
        self.turn_impulse = after(self.multiplier, n)
        self.impulse = after(self.turn_impulse, n)

    def take_rows(self, s: Rows, first: int) -> None:
        """Theirs are the rows from the first on."""
        self.rate, self.bias = after(s.rate, first), after(s.bias, first)
        self.G = after(s.R, first * s.n_q)


class Contacts(Pressed):
    """Contacts, what has happened at each, and the problem of those that are closed, its members.

    struck, since     time of the last impact, since the one before
    chatter_end       when its chattering ends
    rest              how long the sequence that is summed up lasts; negative: none
    owed              impulse taken on account, for which later ones pay
    terms             size of the terms of a gap velocity, at the impacts of one instant
    before            speed before the impact at hand
    turn_speed        speed a number of impacts ago
    synchronous       whether gap and speed are those of q, v
    b, z, noise       by member: right-hand side and solution of the problem, rounding of b
    member            contacts of the problem
    closed, was_closed, loaded   lasting contact; so when last told; carries a force
    parting                      let go of by the forces between two impacts of one instant
    """

    def __init__(self, n: int) -> None:
        Pressed.__init__(self, n)
        self.history, self.marks = np.zeros(CONTACTS * n), np.zeros(MARKS * n, dtype=np.intp)
        self.struck = doubles(self.history)
        self.since = after(self.struck, n)
        self.chatter_end = after(self.since, n)
        self.rest = after(self.chatter_end, n)
        self.owed = after(self.rest, n)
        self.terms = after(self.owed, n)
        self.turn_speed = after(self.terms, n)
        self.synchronous = after(self.turn_speed, n)
        self.before = after(self.synchronous, n)
        self.b = after(self.before, n)
        self.z = after(self.b, n)
        self.noise = after(self.z, n)
        self.member = indices(self.marks)
        self.closed = indices_after(self.member, n)
        self.was_closed = indices_after(self.closed, n)
        self.loaded = indices_after(self.was_closed, n)
        self.parting = indices_after(self.loaded, n)
        for c in range(n):
            self.struck[c] = self.chatter_end[c] = -inf

    def members(self, n: int) -> list[int]:
        """The first n members of the problem."""
        return sorted([self.member[a] for a in range(n)])

    def latest(self) -> list[int]:
        """The contacts that have struck last."""
        times = [self.struck[c] for c in range(self.n)]
        return [c for c in range(self.n) if times[c] == sorted(times)[-1]]


class Mechanism(Rows):
    """A system with contacts and joints: its equations, its state, and work space.

    t_end             end of the span
    length            duration of the last flight
    bare              whether the acceleration is that without contacts
    next              what comes next: BEGIN, MOVE, JUMP or SETTLE
    state             q0, v0 as Python sees them;  evaluations   of forces, none
    q0, v0            state at the base time;  q, v  state last asked for;  a  acceleration
    contact, joint    rows at q, v
    W                 matrix of the problem of the n_members members of it
    culprit           joint that contradicts others, or -1

    Parameters
    ----------
    model, joints : Model;  n_j : how many joints;  tolerances : rtol, atol;  t_span : (start, end)
    """

    def __init__(
        self, model: Model, joints: Model, n_j: int, tolerances: tuple[float, float], t_span: tuple[float, float]
    ) -> None:  # fmt: skip
        Rows.__init__(self, model, joints, n_j, model, 0, tolerances, t_span, (), inf)
        n, n_c, r = self.n_q, self.n_c, self.n_r
        self.t_end, self.next = t_span[1], BEGIN
        self.length, self.bare, self.n_members, self.culprit = 0.0, False, 0, -1
        self.state, self.evaluations = np.zeros(2 * n), 0
        self.numbers = np.zeros(4 * n + r + n_c * n_c)
        self.q0 = doubles(self.state)
        self.v0 = after(self.q0, n)
        self.q = doubles(self.numbers)
        self.v = after(self.q, n)
        self.a = after(self.v, n)
        self.trial = after(self.a, n)
        self.impulse = after(self.trial, n)
        self.W = after(self.impulse, r)
        self.contact, self.joint = Contacts(n_c), Pressed(n_j)
        self.lcp = Workspace(n_c)
        self.joint.take_rows(self, 0)
        self.contact.take_rows(self, n_j)
        self.contact.impulse, self.joint.impulse = self.impulse, after(self.impulse, n_c)

    def start(self, q: Any, v: Any) -> None:
        """Begin with the state q, v (n_q,)."""
        self.state[: self.n_q], self.state[self.n_q :] = q, v
        for i in range(2 * self.n_q):
            self.q[i] = self.q0[i]

    def closed_ones(self) -> list[int]:
        """The contacts that are closed."""
        return [c for c in range(self.n_c) if self.contact.closed[c] == 1]
