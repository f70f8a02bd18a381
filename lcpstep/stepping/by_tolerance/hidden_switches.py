"""What the steps of `Moreau` by a tolerance do not show when contacts open and friction changes, as kernels.

Each row of a contact, its normal and then its tangent, has a force that keeps it closed or sticking, negative where
it would have to be pulled: for normals the impulse of a step over its length, or -(u+ - u) / (W h) where it has
none; for tangents mu p_N - |p_T - (u_T+ - u_T) / W|. See `hidden_forces` for the errors that follow.
"""

from __future__ import annotations

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.vectors import add, clear, largest, product
from lcpstep.pointers import Doubles, Indices, abs, after, indices_after, max, min
from lcpstep.stepping.by_tolerance.hidden_forces import gives_out, hidden, late
from lcpstep.stepping.steps import NO_APPROACH
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.row_impulses import size_of_rate

ONE, FIRST, SECOND = range(3)  # the step, its halves
SHARED = 4.0  # rows that do not depend on each other make together a quarter of what the impulse of one makes
SAME = 1e-10  # of a row's mobility: what is left of it while others are held, if these say the same
STICKS = 1.0 - 1e-9  # of its limit: friction below it; its speed does not tell, for sliding begins slowly


class Switches:
    """Rows of all contacts in the step and its halves: normals, and tangents where there is friction.

    force, impulse : (3, n)    mean forces that keep the row closed, or sticking; impulses
    holds : (3, n)             1 where it was kept to the end
    held : (n,)                1 where it was so at the start
    mobility : (n,)            when last in contact
    response : (n,)            largest velocity that an impulse makes
    creep                      by which velocities of what sticks may differ: its rounding is taken for rest
    turned : (n,)              impulse of friction with the wrong sign
    drop : (n_c,)              by which the force of friction falls where what sticks begins to slide
    apart : (n_q,)             what the impulses of all rows, joints too, make of the velocities in the step, less
                               what they make in its halves: nothing where rows that depend on each other share them

    held_W : (n_all, n_all)    see `shares`

    Parameters
    ----------
    n_q, n_c, n, n_all : int   coordinates; contacts; rows; rows with those of joints
    """

    def __init__(self, n_q: int, n_c: int, n: int, n_all: int) -> None:
        self.n_q, self.n_c, self.n, self.creep = n_q, n_c, n, 0.0
        self.kept = np.zeros(9 * n + n_q + n_c + n_all * n_all), np.zeros(4 * n, dtype=np.intp)
        self.force, self.holds = doubles(self.kept[0]), indices(self.kept[1])
        self.impulse, self.mobility = after(self.force, 3 * n), after(self.force, 6 * n)
        self.response, self.turned = after(self.force, 7 * n), after(self.force, 8 * n)
        self.apart, self.drop = after(self.force, 9 * n), after(self.force, 9 * n + n_q)
        self.held_W = after(self.drop, n_c)
        self.held = indices_after(self.holds, 3 * n)

    def begin(self, s: State, slow: float) -> None:
        """A step begins; which contacts have lasted."""
        for i in range(self.n_c):
            self.held[i] = 1 if s.closed[i] > 0 and abs(s.u[i]) <= slow else 0
        clear(self.turned, self.n)
        clear(self.apart, self.n_q)
        clear(self.drop, self.n_c)
        self.creep = 0.0

    def note(self, part: int, plan: Plan, s: State, rows: Rows, before: Doubles, slow: float) -> None:
        """Rows of a part that has been taken; `before`: gap velocities at its start."""
        first = part * self.n
        for i in range(self.n_c):
            p = rows.p[i]
            if p > 0.0:
                self.measure(i, plan, s, rows)
            self.impulse[first + i], self.holds[first + i] = p, 1 if p > 0.0 else 0
            self.force[first + i] = p / plan.h
            if p == 0.0 and self.mobility[i] > 0.0:  # others, not it, stop what separates
                self.force[first + i] = min(0.0, -(s.u[i] - before[i]) / (self.mobility[i] * plan.h))
        if rows.n_t > 0:
            self.note_friction(part, plan, s, rows, slow)
        for k in range(rows.n):
            if rows.p[k] != 0.0:
                sign = 1.0 if part == ONE else -1.0
                add(self.apart, sign * rows.p[k], after(plan.X, k * self.n_q), self.n_q)

    def measure(self, k: int, plan: Plan, s: State, rows: Rows) -> None:
        """How a row answers impulses."""
        X, n = after(plan.X, k * s.n_q), s.n_q
        self.mobility[k], self.response[k] = product(rows.H, X, k, n), largest(X, 0.0, n)

    def note_friction(self, part: int, plan: Plan, s: State, rows: Rows, slow: float) -> None:
        """The same of the tangents."""
        n, first = self.n_c, part * self.n
        for i in range(rows.n_t):
            k, mu, p, normal = n + i, rows.problem.mu[i], rows.p[n + i], rows.p[i]
            if mu == 0.0 or normal == 0.0:
                self.holds[first + k], self.held[k] = 0, 0
                continue
            self.measure(k, plan, s, rows)
            W, u, end = self.mobility[k], rows.sliding[i], product(rows.T, s.v, i, s.n_q) + rows.T_t[i]
            if part != SECOND:
                self.held[k] = 1 if abs(u) <= slow and self.held[i] > 0 else 0
            self.impulse[first + k] = p
            self.holds[first + k] = 1 if abs(p) < STICKS * mu * normal else 0
            kinetic = rows.coefficients.sliding[i]
            if W > 0.0 and self.holds[first + k] > 0 and self.holds[k] > 0:
                rounding = NO_APPROACH * size_of_rate(rows, s.v, k, s.n_q)
                self.creep = max(self.creep, 2.0 * rounding * self.response[k] / W)
            if self.held[k] > 0:
                mu = rows.coefficients.sticking[i]
                moves = self.holds[first + k] > 0 or abs(end) > slow  # at its limit others may hold it
                self.drop[i] = (mu - kinetic) * normal / plan.h if moves else 0.0
            needed = abs(p - (end - u) / W) if W > 0.0 else 0.0
            if W > 0.0:
                self.force[first + k] = (mu * normal - needed) / plan.h
            if part != ONE and min(u, end) < -slow and max(u, end) > slow:
                self.turned[k] = max(self.turned[k], 2.0 * abs(p) * abs(u) / (abs(u) + abs(end)))
            elif part != ONE and needed > mu * normal and abs(u) > slow and self.holds[first + k] > 0:
                self.turned[k] = max(self.turned[k], turned_at_rest(abs(u), W, needed, kinetic * normal))

    def unseen(self, h: float, plan: Plan, s: State, rows: Rows) -> float:
        """Error of the velocities after two halves of h/2."""
        worst, n, apart = 0.0, self.n, SHARED * largest(self.apart, 0.0, self.n_q)
        for k in range(n):
            p = self.turned[k]
            if self.held[k] > 0:
                p = max(p, self.let_go(k, h, apart, plan, s, rows))
            worst = max(worst, p * self.response[k])
        return worst

    def let_go(self, k: int, h: float, apart: float, plan: Plan, s: State, rows: Rows) -> float:
        """Impulse by which a row is wrong that was held at the start, for it is held too long, or not long enough.

        When friction falls within a part that begins to slide is not known: forces of what slides do not tell.
        """
        n, opened = self.n, h if self.holds[SECOND * self.n + k] > 0 else 0.5 * h
        if self.holds[FIRST * n + k] == 0:
            opened = 0.0
        drop = self.drop[k - self.n_c] if k >= self.n_c else 0.0
        early = 0.5 * h * drop if opened < h else 0.0
        one, first, second = self.force[k], self.force[n + k], self.force[2 * n + k]
        if plan.theta != 0.5:  # forces at the ends of the parts, not means of both ends: along a line
            one, first, second = first, 0.5 * (3.0 * first - one), 0.5 * (first + one)
        if opened == 0.0 and k >= self.n_c and min(min(one, first), second) > 0.0:
            return early  # slower than is resolved, but it slid before, and has yet to come to rest
        if self.apart_by(k) * self.response[k] > apart and self.shares(k, plan, s, rows):
            return early  # what one row has less, others have more: forces that nothing tells apart
        p = max(early, late(one, first, second, h, opened, h))
        if opened == h:
            p += drop * (h - gives_out(one, first, second, h, h))
            if self.holds[ONE * n + k] > 0:
                p = max(p, self.differ(k))
        return p

    def shares(self, k: int, plan: Plan, s: State, rows: Rows) -> bool:
        """Whether other rows can do what row k does: its mobility while they are held, by elimination, is none."""
        m, n, ids = s.active + rows.n_f + rows.n_j, rows.n, rows.problem.ids
        last = m - 1
        while last >= 0 and ids[last] != k:
            last -= 1
        if last < 0:
            return True
        for i in range(m):
            for j in range(m):
                self.held_W[i * m + j] = plan.W[moved(ids, i, last, m) * n + moved(ids, j, last, m)]
        for d in range(m - 1):
            pivot, own = self.held_W[d * m + d], moved(ids, d, last, m)
            if not pivot > SAME * plan.W[own * n + own]:
                continue
            for i in range(d + 1, m):
                share = self.held_W[i * m + d] / pivot
                for j in range(d + 1 if share != 0.0 else m, m):
                    self.held_W[i * m + j] -= share * self.held_W[d * m + j]
        return self.held_W[m * m - 1] <= SAME * plan.W[k * n + k]

    def differ(self, k: int) -> float:
        """By how much the step and its halves disagree about an impulse, as an error."""
        one, two = self.impulse[k], self.impulse[self.n + k] + self.impulse[2 * self.n + k]
        return hidden(one, two) if one > 0.0 and two > 0.0 else self.apart_by(k)

    def apart_by(self, k: int) -> float:
        """By how much they disagree about it."""
        return abs(self.impulse[k] - (self.impulse[self.n + k] + self.impulse[2 * self.n + k]))


def turned_at_rest(u: float, W: float, needed: float, friction: float) -> float:
    """Impulse missing where a part ends sliding at rest, though it turned about within.

    u : speed at its start;  needed, friction : impulses that would hold it at rest, and that it has while it slides
    """
    return (needed - friction) * max(0.0, 1.0 - u / (W * (needed + friction)))


def moved(ids: Indices, i: int, last: int, m: int) -> int:
    """Row of place i of m, if that of place `last` changes places with the one at the end."""
    if i == m - 1:
        return ids[last]
    return ids[m - 1] if i == last else ids[i]
