"""Modes of the contacts of a sparse problem along a path from a guess, which no number of wrong ones can mislead.

The problem of `coulomb` with proximal diagonal d is made one that the modes guessed do solve, by shifts s of
the impulses and e of the rates,

    0 <= R x + d p + b + tau e  complementary to  p_N >= 0,  |p_T| <= mu p_N  of  p + tau s

at tau = 1, and tau is followed down to zero. For given modes x and p are straight lines in tau; where one contact
comes to the end of its mode it takes the next one, and where the line then leads back tau may grow for a while:

    open, normal rate 0            slides the way its tangent moves
    slides, normal impulse 0       open
    slides, tangential rate 0      sticks
    sticks, at its limit           slides

This is Lemke's method begun from a guess, with about as many pivots as modes change; `updates` has the lines.
Shifts that differ from contact to contact keep two from changing at once.

Sources: C. E. Lemke, Management Science 11 (1965) 681; S. P. Dirkse, M. C. Ferris, Optim. Methods Softw. 5 (1995)
123, for the guess; `kernels.coulomb` for why a path exists.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lcpstep.lcp.factor import Singular
from lcpstep.stepping.sparse.updates import Lines
from lcpstep.turns.source import GOLDEN

if TYPE_CHECKING:
    from lcpstep.stepping.sparse.coulomb import Coupled, Problem

OPEN, STICK, FORWARDS, BACKWARDS = range(4)  # modes; the last two slide
SIGN = np.array([0.0, 0.0, 1.0, -1.0])  # of the sliding velocity
MARGIN = 1e-3  # of the largest rate: what the shifts leave each contact at the start
PIVOTS = 5  # granted per contact; up to 1.5 were seen to be needed
ENTERS, LEAVES, RIGHT, LEFT, TURNS = range(5)  # what ends a mode, in the order of the table above; two limits


class Path:
    """One path: modes (n_c,) and tau at its current point."""

    def __init__(self, coupled: Coupled, problem: Problem, modes: Any) -> None:
        self.coupled, self.problem, self.modes, self.tau = coupled, problem, modes.copy(), 1.0
        self.N = slice(coupled.n_j, coupled.n_j + coupled.n_c)
        self.T = slice(coupled.n_j + coupled.n_c, None)
        self.s, self.e = np.zeros(coupled.n_r), np.zeros(coupled.n_r)

    def shift(self) -> None:
        """Shifts that make the modes those of a solution at tau = 1."""
        c, mu = self.coupled, self.problem.mu
        p, rates = (values[0] for values in self.lines())
        least, slides = MARGIN * float(np.max(np.abs(self.problem.b), initial=0.0)) or 1.0, SIGN[self.modes]
        uneven = least * (1.0 + np.modf(np.arange(1.0, 2.0 * c.n_c + 1.0) * GOLDEN)[0])
        closed, normal, tangent = self.modes != OPEN, uneven[: c.n_c], uneven[c.n_c :]
        sticks = (self.modes == STICK) & (mu > 0.0)
        holds = np.divide(np.abs(p[self.T]), mu, out=np.zeros(c.n_c), where=sticks)
        missing = np.maximum(holds - p[self.N], 0.0) + normal / c.mobility[self.N]
        self.s[self.N] = np.where(closed, missing, 0.0)
        self.s[self.T] = -slides * mu * missing
        self.e[self.N] = np.where(closed, 0.0, np.maximum(-rates[self.N], 0.0) + normal)
        back = slides * (np.maximum(-slides * rates[self.T], 0.0) + tangent)
        self.e[self.T] = np.where(closed, back, np.where(np.arange(c.n_c) % 2, tangent, -tangent))

    def lines(self) -> tuple[Any, Any]:
        """Shifted impulses and rates of all rows, (2, n_r) each: at tau = 0, and what they change by with tau."""
        c, n = self.coupled, self.coupled.n_q
        held, slide = c.held(self.problem, self.modes), SIGN[self.modes] * self.problem.mu
        right = np.zeros((2, n + c.n_r))
        right[:, n:] = np.where(held, (-self.problem.b, -self.e), 0.0)
        right[1, n:][self.N] = np.where(self.modes == OPEN, -self.s[self.N], right[1, n:][self.N])
        apart = -self.s[self.T] - slide * self.s[self.N]
        right[1, n:][self.T] = np.where(held[self.T], right[1, n:][self.T], apart)
        solve = c.factor(self.problem, self.modes)
        u = solve(right.T)
        u = u + solve(right.T - self.times(u, held, slide))
        rates = (c.R @ u[:n]).T + c.proximal * u[n:].T + (self.problem.b, self.e)
        p = u[n:].T
        p[1] += self.s
        return p, rates

    def kinds(self) -> tuple[Any, Any]:
        """Of the contacts' rows: whether each holds its rate, and the share of the normal in it where it does not."""
        held = self.coupled.held(self.problem, self.modes)[self.coupled.n_j :]
        slide = np.append(np.zeros(self.coupled.n_c), SIGN[self.modes] * self.problem.mu)
        return held, slide

    def times(self, u: Any, held: Any, slide: Any) -> Any:
        """The matrix times u (n_q + n_r, 2)."""
        c, x, p = self.coupled, u[: self.coupled.n_q], u[self.coupled.n_q :]
        rows = np.where(held[:, None], c.R @ x + c.proximal[:, None] * p, p)
        rows[self.T] += slide[:, None] * p[self.N]
        return np.concatenate([c.L @ u, rows])

    def follow(self) -> Any:
        """The modes at tau = 0; None where the path leads nowhere."""
        try:
            with np.errstate(all="ignore"):  # slopes of zero
                self.shift()
                return self.pivots()
        except Singular:
            return None

    def pivots(self) -> Any:
        """See `follow`."""
        entered, lines = None, Lines(self)
        p, rates = lines.anew()
        for _ in range(PIVOTS * (self.coupled.n_c + 1)):
            at_zero, slope, watched = self.rooms(p, rates)
            down = entered is None or slope[entered] < 0.0
            if entered is not None:
                watched[entered] = False
            speed = slope if down else -slope
            room = np.maximum(at_zero + self.tau * slope, 0.0)
            reach = np.where(watched & (speed > 0.0), room / speed, np.inf)
            end = np.unravel_index(int(np.argmin(reach)), reach.shape)
            if down and reach[end] >= self.tau:
                return self.modes
            if not np.isfinite(reach[end]):
                return None
            self.tau += -reach[end] if down else reach[end]
            entered = self.change(int(end[0]), int(end[1]), rates)
            p, rates = lines.at(self.tau, entered[1])
        return None

    def rooms(self, p: Any, rates: Any) -> tuple[Any, Any, Any]:
        """What each kind of end has left (5, n_c) at tau = 0; its slope in tau; and which modes it may end."""
        mu, modes, n_c = self.problem.mu, self.modes, self.coupled.n_c
        normal, tangent, limit, slides = p[:, :n_c], p[:, n_c:], mu * p[:, :n_c], SIGN[modes]
        closes, turns = rates[:, :n_c], slides * rates[:, n_c:]
        rough = self.problem.rough
        sticks = (modes == STICK) & rough
        left = np.stack([closes, normal, limit - tangent, limit + tangent, turns], axis=1)
        open_ = (modes == OPEN) & self.problem.active
        watched = np.stack([open_, (modes != OPEN) & ~sticks, sticks, sticks, slides != 0.0])
        return left[0], left[1], watched

    def change(self, end: int, contact: int, rates: Any) -> tuple[int, int]:
        """Give the contact the mode behind this end of its own; the end of the new one that it stands at."""
        mode = self.modes[contact]
        if end == ENTERS:
            slip = rates[:, self.coupled.n_c + contact] @ (1.0, self.tau)
            slides = FORWARDS if slip > 0.0 else BACKWARDS
            new, stands = slides if self.problem.rough[contact] else STICK, LEAVES
        elif end == LEAVES:
            new, stands = OPEN, ENTERS
        elif end == TURNS:
            new, stands = STICK, LEFT if mode == FORWARDS else RIGHT
        else:
            new, stands = FORWARDS if end == LEFT else BACKWARDS, TURNS
        self.modes[contact] = new
        return stands, contact
