"""What the steps of `Moreau` by a tolerance do not show when contacts open and friction changes, as kernels.

Each row of a contact, its normal and then its tangent, has a force that keeps it closed or sticking, negative where
it would have to be pulled: for normals the impulse of a step over its length, or -(u+ - u) / (W h) where it has
none; for tangents mu p_N - |p_T - (u_T+ - u_T) / W|. See `hidden_forces` for the errors that follow.
"""

from __future__ import annotations

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.kernels.vectors import add, clear, largest, product
    from lcpstep.pointers import Doubles, abs, after, indices_after, max, min
    from lcpstep.stepping.hidden_forces import gives_out, hidden, late
    from lcpstep.stepping.theta_method.moving import Rows, State
    from lcpstep.stepping.theta_method.plan import Plan

ONE, FIRST, SECOND = range(3)  # the step, its halves
SHARED = 4.0  # rows that do not depend on each other make together a quarter of what the impulse of one makes
STICKS = 1.0 - 1e-9  # of its limit: friction below it; its speed does not tell, for sliding begins slowly


class Switches:
    """Rows of all contacts in the step and its halves: normals, and tangents where there is friction.

    force, impulse : (3, n)    mean forces that keep the row closed, or sticking; impulses
    holds : (3, n)             1 where it was kept to the end
    held : (n,)                1 where it was so at the start
    mobility : (n,)            when last in contact
    response : (n,)            largest velocity that an impulse makes
    turned : (n,)              impulse of friction with the wrong sign
    drop : (n_c,)              by which the force of friction falls where what sticks begins to slide
    apart : (n_q,)             what the impulses of all rows, joints too, make of the velocities in the step, less
                               what they make in its halves: nothing where rows that depend on each other share them

    Parameters
    ----------
    n_q, n_c, n : int   coordinates; contacts; rows
    """

    def __init__(self, n_q: int, n_c: int, n: int) -> None:
        self.n_q, self.n_c, self.n = n_q, n_c, n
        self.kept = np.zeros(9 * n + n_q + n_c), np.zeros(4 * n, dtype=np.intp)
        self.force, self.holds = doubles(self.kept[0]), indices(self.kept[1])
        self.impulse, self.mobility = after(self.force, 3 * n), after(self.force, 6 * n)
        self.response, self.turned = after(self.force, 7 * n), after(self.force, 8 * n)
        self.apart, self.drop = after(self.force, 9 * n), after(self.force, 9 * n + n_q)
        self.held = indices_after(self.holds, 3 * n)

    def begin(self, s: State, slow: float) -> None:
        """A step begins; which contacts have lasted."""
        for i in range(self.n_c):
            self.held[i] = 1 if s.closed[i] > 0 and abs(s.u[i]) <= slow else 0
        clear(self.turned, self.n)
        clear(self.apart, self.n_q)
        clear(self.drop, self.n_c)

    def note(self, part: int, plan: Plan, s: State, rows: Rows, before: Doubles, slow: float) -> None:
        """Rows of a part that has been taken; `before`: gap velocities at its start."""
        first = part * self.n
        for i in range(self.n_c):
            p = rows.p[i]
            if p > 0.0:
                self.measure(i, plan, s, rows)
            self.impulse[first + i], self.holds[first + i] = p, 1 if p > 0.0 else 0
            self.force[first + i] = p / plan.h
            if p == 0.0 and self.mobility[i] > 0.0:
                self.force[first + i] = -(s.u[i] - before[i]) / (self.mobility[i] * plan.h)
        if rows.n_t > 0:
            self.note_friction(part, plan, s, rows, slow)
        for k in range(rows.n):
            if rows.p[k] != 0.0:
                sign = 1.0 if part == ONE else -1.0
                add(self.apart, sign * rows.p[k], after(plan.X, k * self.n_q), self.n_q)

    def measure(self, k: int, plan: Plan, s: State, rows: Rows) -> None:
        """How a row answers impulses."""
        total, most, n = 0.0, 0.0, s.n_q
        for j in range(n):
            total += rows.H[k * n + j] * plan.X[k * n + j]
            most = max(most, abs(plan.X[k * n + j]))
        self.mobility[k], self.response[k] = total, most

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
            if self.held[k] > 0:
                mu = rows.coefficients.sticking[i]
                self.drop[i] = (mu - kinetic) * normal / plan.h
            needed = abs(p - (end - u) / W) if W > 0.0 else 0.0
            if W > 0.0:
                self.force[first + k] = (mu * normal - needed) / plan.h
            if part != ONE and min(u, end) < -slow and max(u, end) > slow:
                self.turned[k] = max(self.turned[k], 2.0 * abs(p) * abs(u) / (abs(u) + abs(end)))
            elif part != ONE and needed > mu * normal and abs(u) > slow and self.holds[first + k] > 0:
                self.turned[k] = max(self.turned[k], turned_at_rest(abs(u), W, needed, kinetic * normal))

    def unseen(self, h: float, even: bool) -> float:
        """Error of the velocities after two halves of h/2; `even` where impulses are means of both ends of a step."""
        worst, n, apart = 0.0, self.n, SHARED * largest(self.apart, 0.0, self.n_q)
        for k in range(n):
            p = self.turned[k]
            if self.held[k] > 0:
                opened = h if self.holds[SECOND * n + k] > 0 else 0.5 * h
                if self.holds[FIRST * n + k] == 0:
                    opened = 0.0
                one, first, second = self.force[k], self.force[n + k], self.force[2 * n + k]
                if not even:  # forces at the ends of the parts: along a line
                    one, first, second = first, 0.5 * (3.0 * first - one), 0.5 * (first + one)
                if opened == 0.0 and k >= self.n_c and min(min(one, first), second) > 0.0:
                    continue  # slower than is resolved, but it slid before, and has yet to come to rest
                if self.apart_by(k) * self.response[k] > apart:
                    continue  # what one row has less, others have more: forces that nothing tells apart
                p = max(p, late(one, first, second, h, opened, h))
                if k >= self.n_c and self.drop[k - self.n_c] > 0.0:
                    p += self.drop[k - self.n_c] * abs(gives_out(one, first, second, h, h) - opened)
                if self.holds[ONE * n + k] > 0 and opened == h:
                    p = max(p, self.differ(k))
            worst = max(worst, p * self.response[k])
        return worst

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
