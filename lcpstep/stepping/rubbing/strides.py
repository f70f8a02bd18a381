"""The smooth motion of steps with friction, as kernels: of order two or four, and its dense output.

    2   q' = q + h v + h^2 a / 2,  v' = v + h (a + a') / 2          velocity Verlet, a' taken at v + h a
    4   Runge-Kutta's classical method

Each ends with the acceleration where it arrives, on the rows held, with which the next one begins. Impulses of
contacts are integrated along with the motion, by the same weights. Between its ends a step is the cubic that has
their values and slopes.

Sources: W. Swope et al., J. Chem. Phys. 76 (1982) 637; H. Andersen, Rattle, J. Comput. Phys. 52 (1983); E. Hairer,
S. Norsett, G. Wanner, Solving Ordinary Differential Equations I (Springer 1993), sections II.1 and II.6.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.events.contacts.smooth import Smooth
from lcpstep.events.contacts.state import GUARDS
from lcpstep.events.rows.loads import list_by_row
from lcpstep.events.rows.projection import push_onto_rows, put_on_rows, take_rows
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import add, clear, copy, distance, finite, largest
from lcpstep.pointers import Doubles, abs, after, min
from lcpstep.shelf import Shelf

ARRIVAL = 4  # place of the rates at the end of a step, after those at its stages


class Strides(Smooth):
    """A motion with friction or joints by steps, of one size or not.

    order                2 or 4
    h, t_start, n_steps  steps: their size, or the largest, when the first begins, how many there are of one size
    tolerance, span      0 for steps of one size; of time
    size_q, size_v       of the motion so far, where there is a tolerance
    tau                  from the base to the event of `guard`
    decided              up to when the modes have been looked at that followed when a force left its cone
    astray               of the rows held that no position is found on at the end of the last step the worst, or -1
    going                whether rates, forces, guards and their slopes at the base state are known
    leaving, arriving, middle : (n_r,)    forces of the rows at both ends of the step last made, and (order 4) between
    push : (n_r,)                         their impulses over it
    begin_value, begin_slope, end_value, end_slope, middle_value : (3 n_c,)    guards there, and their rates of change
    begin_bend, end_bend : (n_c,)       accelerations there of open gaps that have not left their bands
    arrival : (n,)       rates at the end of the step last made
    refined : (n,);  half_value, quarter_value, late_value : (3 n_c,)    where two steps of half the size lead, guards
                         between them, and those of the forces within each (order 4)
    pull : (n_q,)        of the velocity, that with which the end of a step has been put back (order 2)
    based                rows and masses at hand are those of the base state
    stored, stored_rates : (n,);  stored_forces : (n_r,)    the base state, its rates and forces meanwhile

    Parameters
    ----------
    given    as of `Rubbing`
    order, h, t_start, n_steps, tolerance   as above
    """

    def __init__(
        self, *given: Any, order: int, h: float, t_start: float, n_steps: int, tolerance: float
    ) -> None:
        super().__init__(*given)
        self.order, self.h, self.t_start, self.n_steps, self.tolerance = order, h, t_start, n_steps, tolerance
        self.tau, self.decided = 0.0, self.t_start
        self.going = self.based = False
        self.astray = -1
        self.span = self.rows.t_end - self.t_start
        self.size_q = self.size_v = 0.0
        r, n, g = self.n_r, self.n, GUARDS * self.n_c
        self.arrival = after(self.K, ARRIVAL * self.n)
        self.ends = np.zeros(5 * self.n_r + 8 * g + 2 * self.n_c + 3 * self.n + self.n_q)
        x = Shelf(self.ends)
        self.leaving, self.arriving, self.middle, self.push = x.take(r), x.take(r), x.take(r), x.take(r)
        self.begin_value, self.begin_slope, self.end_value = x.take(g), x.take(g), x.take(g)
        self.end_slope, self.middle_value, self.half_value = x.take(g), x.take(g), x.take(g)
        self.quarter_value, self.late_value, self.begin_bend = x.take(g), x.take(g), x.take(self.n_c)
        self.end_bend, self.refined, self.stored = x.take(self.n_c), x.take(n), x.take(n)
        self.stored_rates, self.stored_forces, self.pull = x.take(n), x.take(r), x.take(self.n_q)

    def step(self, t: float, h: float) -> bool:
        """A step of size h from y at t to y_new; False where it is not finite, or rows cannot be held."""
        return verlet(self, t, h) if self.order == 2 else classical(self, t, h)

    def complete(self, t: float, h: float) -> bool:
        """Dense output of the step that `step` has just made, in the form of the other Runge-Kutta method."""
        n = self.n
        clear(self.F, 7 * n)
        for i in range(n):
            delta = self.y_new[i] - self.y[i]
            self.F[i] = delta
            self.F[n + i] = h * self.K[i] - delta
            self.F[2 * n + i] = 2.0 * delta - h * (self.arrival[i] + self.K[i])
        self.length = h
        return True

    def pressed(self, i: int, x: float) -> float:
        """The impulse of row i up to the fraction x of the step: the same cubic."""
        h, all_ = self.length, self.push[i]
        out, in_ = h * self.leaving[i] - all_, 2.0 * all_ - h * (self.leaving[i] + self.arriving[i])
        return x * (all_ + (1.0 - x) * (out + x * in_))

    def goal(self, steps: int) -> float:
        """The time at which the step after so many ends, at the latest."""
        if self.tolerance > 0.0:
            return min(self.rows.t0 + min(self.h, self.scan_length), self.rows.t_end)
        if steps + 1 >= self.n_steps:
            return self.rows.t_end
        return min(self.t_start + self.h * (steps + 1), self.rows.t_end)


def verlet(s: Strides, t: float, h: float) -> bool:
    """A step of order two; of one size as RATTLE, whose push back onto the rows held acts on the velocity."""
    n, a = s.n_q, after(s.K, s.n_q)
    q_new, v_new = s.y_new, after(s.y_new, n)
    for i in range(n):
        q_new[i] = s.dv[i] = s.y[i] + h * (s.y[n + i] + 0.5 * h * a[i])
        v_new[i] = s.y[n + i] + h * a[i]
    clear(s.push, s.n_r)
    clear(s.pull, n)
    if s.rows.n_held > 0:
        if not s.based and not take_rows(s.rows, t, s.y):
            return False
        s.based = False
        if not stays_on_rows(s, t + h):
            return False
        if s.tolerance == 0.0:  # by short steps, in which errors are sought, rounding would be any velocity
            pull_back(s, h)
    if not s.rates(t + h, s.y_new, s.arrival):
        return False
    for i in range(n):
        v_new[i] = s.y[n + i] + 0.5 * h * (a[i] + s.arrival[n + i])
        s.arrival[i] = v_new[i]
    copy(s.arriving, s.multiplier, s.n_r)
    for i in range(s.n_r):
        s.push[i] += 0.5 * h * (s.leaving[i] + s.arriving[i])
    s.evaluations += 1
    return finite(s.y_new, s.n)


def pull_back(s: Strides, h: float) -> None:
    """Velocities and impulses that belong to how the position has been put back, from `dv`.

    But for its rounding, and for gaps that were left before: how far the step itself has left the surfaces is a part
    of the way h^2 a, and over a short step a gap within its tolerance would be any velocity.
    """
    off = distance(s.y_new, s.dv, s.n_q)
    own = h * h * largest(after(s.K, s.n_q), 0.0, s.n_q)
    if NOISE * largest(s.y_new, 0.0, s.n_q) < off <= own:
        for i in range(s.n_q):
            s.pull[i] = (s.y_new[i] - s.dv[i]) / h
        list_by_row(s.rows, s.rows.held, s.rows.near)
        add(s.push, 1.0 / h, s.rows.near, s.n_r)


def classical(s: Strides, t: float, h: float) -> bool:
    """A step of order four."""
    n, r = s.n, s.n_r
    clear(s.middle, r)
    clear(s.pull, s.n_q)
    for i in range(r):
        s.push[i] = h / 6.0 * s.leaving[i]
    for stage in range(1, 4):
        length = h if stage == 3 else 0.5 * h
        for i in range(n):
            s.y_stage[i] = s.y[i] + length * s.K[(stage - 1) * n + i]
        if not s.rates(t + length, s.y_stage, after(s.K, stage * n)):
            return False
        add(s.push, h / 6.0 if stage == 3 else h / 3.0, s.multiplier, r)
        if stage < 3:
            add(s.middle, 0.5, s.multiplier, r)
    for i in range(n):
        s.y_new[i] = s.y[i] + h / 6.0 * (s.K[i] + 2.0 * (s.K[n + i] + s.K[2 * n + i]) + s.K[3 * n + i])
    s.evaluations += 4
    if not (stays_on_rows(s, t + h) and s.rates(t + h, s.y_new, s.arrival)):
        return False
    copy(s.arriving, s.multiplier, s.n_r)
    return finite(s.y_new, n)


def push_end_back(s: Strides, v: Doubles) -> None:
    """Put v, the velocity at the end of the step just made, onto the rows held."""
    add(v, 1.0, s.pull, s.n_q)
    push_onto_rows(s.rows, v)


def go_on_with(s: Strides) -> None:
    """Rates and forces at the end of the step just made are those at the base, where its state lies by now."""
    copy(s.K, s.arrival, s.n)
    copy(s.K, s.v, s.n_q)
    copy(s.leaving, s.arriving, s.n_r)


def stays_on_rows(s: Strides, t: float) -> bool:
    """Put the position at the end of a step onto the rows held; False where none is found there (`astray`)."""
    s.astray = -1
    if s.rows.n_held > 0 and not put_on_rows(s.rows, t, s.y_new):
        s.astray = worst_row(s)
    return s.astray < 0


def worst_row(s: Strides) -> int:
    """The row held whose gap is largest, as last measured."""
    worst = 0
    for m in range(1, s.rows.n_held):
        worst = m if abs(s.rows.change[m]) > abs(s.rows.change[worst]) else worst
    return s.rows.row[worst]
