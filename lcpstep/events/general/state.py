"""The state of a system with contacts and joints, under the names of mechanics, and its work space."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.events.hybrid.state import Motion
    from lcpstep.events.rows.state import Rows
    from lcpstep.kernels.bracket import Bracket
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.rungekutta import RungeKutta
    from lcpstep.kernels.turn import Turn
    from lcpstep.lcp.workspace import Workspace
    from lcpstep.pointers import after, indices_after, inf

CONTACTS, MARKS = 14, 6  # numbers per contact besides those of `Pressed`, and marks of a contact
BEGIN, MOVE, JUMP, SETTLE, OBEY, SWITCH = range(6)  # what comes next
LOOKED, ENTERED, JUMPED = range(3)  # whether guards wait to be looked at, and why


class Seen:
    """What is looked at of n contacts: gap, velocity and acceleration of the gap, force; all in one piece.

    gap, speed, curve, multiplier : (n,)
    """

    def __init__(self, n: int) -> None:
        self.n, self.seen = n, np.zeros(4 * n)
        self.gap = doubles(self.seen)
        self.speed = after(self.gap, n)
        self.curve = after(self.speed, n)
        self.multiplier = after(self.curve, n)


class Pressed(Seen):
    """Contacts or joints at the state of the system; each is a row of the equations.

    rate, bias, G     of their rows, see `Rows`
    impulse           since the last kept state
    turn_impulse      since a number of impacts ago, at one instant

    Parameters
    ----------
    n : int
    """

    def __init__(self, n: int) -> None:
        Seen.__init__(self, n)
        self.own = np.zeros(2 * n)
        self.turn_impulse = doubles(self.own)
        self.impulse = after(self.turn_impulse, n)

    def take_rows(self, s: Rows, first: int) -> None:
        """Theirs are the rows from the first on."""
        self.rate, self.bias = after(s.rate, first), after(s.bias, first)
        self.G = after(s.R, first * s.n_q)


class Contacts(Pressed):
    """Contacts, what has happened at each, and the problem of those that are closed, its members.

    struck, since     time of the last impact, since the one before
    held_until        no release before it
    chatter_end       when its chattering ends
    rest              how long the sequence that is summed up lasts; negative: none
    owed              impulse taken on account, for which later ones pay
    terms             size of the terms of a gap velocity, at the impacts of one instant
    turn_speed        speed a number of impacts ago
    synchronous       whether gap and speed are those of q, v
    thrown            by how much the gap velocity of a closed contact jumps, at a corner
    lands             when a short hop ends after the base time; see `hops`
    b, z, noise       by member: right-hand side and solution of the problem, rounding of b
    member            contacts of the problem
    closed, was_closed, loaded   lasting contact; so when last told; carries a force
    carried                      the gap at the base time is known better than by q
    parting                      let go of by the forces between two impacts of one instant
    """

    def __init__(self, n: int) -> None:
        Pressed.__init__(self, n)
        self.history, self.marks = np.zeros(CONTACTS * n), np.zeros(MARKS * n, dtype=np.intp)
        self.struck = doubles(self.history)
        self.since = after(self.struck, n)
        self.held_until = after(self.since, n)
        self.chatter_end = after(self.held_until, n)
        self.rest = after(self.chatter_end, n)
        self.owed = after(self.rest, n)
        self.terms = after(self.owed, n)
        self.turn_speed = after(self.terms, n)
        self.synchronous = after(self.turn_speed, n)
        self.lands = after(self.synchronous, n)
        self.thrown = after(self.lands, n)
        self.b = after(self.thrown, n)
        self.z = after(self.b, n)
        self.noise = after(self.z, n)
        self.member = indices(self.marks)
        self.closed = indices_after(self.member, n)
        self.was_closed = indices_after(self.closed, n)
        self.loaded = indices_after(self.was_closed, n)
        self.carried = indices_after(self.loaded, n)
        self.parting = indices_after(self.carried, n)
        for c in range(n):
            self.struck[c] = self.held_until[c] = self.chatter_end[c] = -inf

    def members(self, n: int) -> list[int]:
        """The first n members of the problem."""
        return sorted([self.member[a] for a in range(n)])

    def latest(self) -> list[int]:
        """The contacts that have struck last."""
        times = [self.struck[c] for c in range(self.n)]
        return [c for c in range(self.n) if times[c] == sorted(times)[-1]]


class Mechanism(Rows):
    """A system with contacts and joints: its equations, its state, and work space.

    constant          the acceleration is constant between events, and gaps are linear in q
    scan              longest interval of the scan for events
    t_end             end of the span
    nodes, weights    quadrature of the forces of contacts and joints, on [0, 1]
    length            duration of the step at hand
    found, seen_to    event within it, looked for up to here; which contact and what it does
    bare              whether the acceleration is that without contacts
    parallel          whether the rows held were dependent where forces were last asked for
    relieved          whether others hold the contact of the event in its place, or it in theirs, a look ahead
    next              what comes next: BEGIN, MOVE, JUMP, SETTLE, OBEY or SWITCH
    watch, watched    of a system with modes: `smooth` again, which watches its guards; whether there is one
    guards            LOOKED, or since then a mode has begun (ENTERED), or velocities have jumped (JUMPED)
    slope             of the guard found within the step
    q0, v0            state at the base time;  q, v  state last asked for;  a  acceleration there
    contact, joint    rows at q, v;  left, right  of contacts at the ends of an interval of the scan
    before            of contacts where the interval before it began
    start             of contacts at the base time of a step
    kept              rows held, while others are tried
    bracket, turn     in which a root, or a turn, is sought
    W                 matrix of the problem of the n_members members of it
    turned : (n_c, n_q)  Jacobian of the contacts beside the state
    culprit           joint that contradicts others, or -1

    Parameters
    ----------
    model, joints : Model;  n_j : how many joints;  constant : bool
    smooth : RungeKutta    the motion between events, from q0, v0
    scan, t_span, corners, period, nodes, weights   as above and in `Clock`
    """

    watch: Any

    def __init__(
        self,
        model: Model,
        joints: Model,
        n_j: int,
        constant: bool,
        smooth: RungeKutta,
        scan: float,
        t_span: tuple[float, float],
        corners: Any,
        period: float,
        nodes: Any,
        weights: Any,
    ) -> None:
        tolerances = smooth.rtol, smooth.atol
        Rows.__init__(self, model, joints, n_j, model, 0, tolerances, t_span, corners, period)
        n, n_c, r = self.n_q, self.n_c, self.n_r
        self.smooth, self.constant = smooth, constant
        self.scan, self.t_end = scan, t_span[1]
        self.rule = np.array([nodes, weights])
        self.n_nodes, self.nodes = len(nodes), doubles(self.rule)
        self.weights = after(self.nodes, self.n_nodes)
        self.length, self.found, self.seen_to, self.bare, self.next = 0.0, 0.0, 0.0, False, BEGIN
        self.parallel = self.relieved = False
        self.watched = isinstance(smooth, Motion)
        self.watch, self.guards, self.slope = smooth if self.watched else None, ENTERED, 0.0
        self.event_contact = self.event_kind = self.n_members = 0
        self.culprit = -1
        self.numbers = np.zeros(9 * n + r + n_c * n_c + n_c * n)
        self.q0 = self.smooth.y
        self.v0 = after(self.smooth.y, n)
        self.q = doubles(self.numbers)
        self.v = after(self.q, n)
        self.dy = after(self.v, n)
        self.a = after(self.dy, n)
        self.trial = after(self.a, n)
        self.impulse = after(self.trial, 4 * n)
        self.W = after(self.impulse, r)
        self.turned = after(self.W, n_c * n_c)
        self.lists = np.zeros(r, dtype=np.intp)
        self.kept = indices(self.lists)
        self.contact, self.joint = Contacts(n_c), Pressed(n_j)
        self.bracket, self.turn = Bracket(), Turn()
        self.start, self.before, self.left, self.right = Seen(n_c), Seen(n_c), Seen(n_c), Seen(n_c)
        self.lcp = Workspace(n_c)
        self.joint.take_rows(self, 0)
        self.contact.take_rows(self, n_j)
        self.contact.impulse, self.joint.impulse = self.impulse, after(self.impulse, n_c)
        for i in range(n):
            self.q[i], self.v[i] = self.q0[i], self.v0[i]

    def closed_ones(self) -> list[int]:
        """The contacts that are closed."""
        return [c for c in range(self.n_c) if self.contact.closed[c] == 1]
