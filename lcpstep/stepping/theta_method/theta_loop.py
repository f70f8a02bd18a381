"""The loop of the Moreau theta-method over steps of one size, and what it begins on; one step: `theta_step`."""

from __future__ import annotations

import cython

from lcpstep.kernels.acceleration import divide_by_mass
from lcpstep.kernels.course import AHEAD, ARRIVED, Stepwise
from lcpstep.kernels.dynamics import external_force, gap_velocities, gaps, harmonic_terms, total_force
from lcpstep.kernels.model import Model
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE
from lcpstep.kernels.vectors import copy, finite, largest
from lcpstep.pointers import abs, inf, max, min
from lcpstep.stepping.steps import LATE, TOUCHING
from lcpstep.stepping.theta_method.moving import Plan, Rows, State
from lcpstep.stepping.theta_method.one_contact import in_registers
from lcpstep.stepping.theta_method.theta_step import take_step


class Steps(Stepwise):
    """The loop over steps.

    Parameters
    ----------
    m : Model;  plan : Plan;  s : State, which has the record of the run;  rows : Rows
    """

    def __init__(self, m: Model, plan: Plan, s: State, rows: Rows) -> None:
        super().__init__()
        self.m, self.plan, self.s, self.rows = m, plan, s, rows
        self.rows.blows.begin(self.s, self.rows)
        single = m.linear and m.flat and s.n_c == 1 and s.n_q == 1
        self.single = single and rows.n == 1 and not rows.projected

    @cython.ccall
    def begin(self, t: float, side: float, of_one_size: bool) -> None:
        """Forces and gaps of the initial state, which is kept where states are; side: see `steps.start_side`.

        of_one_size : steps are as long as the plan says
        """
        look(self.m, self.s, self.rows, side)
        if of_one_size:
            note_touching(self.m, self.plan, self.s, side)
        if self.s.record.n_times == 0:
            self.s.record.keep(t, 0.0, self.s.q, self.s.v, self.s.impulse)
        elif self.s.record.times[0] == t:
            self.s.record.keep_awaited(self.s.q, self.s.v, self.s.impulse)

    def stage(self, goal: int) -> int:
        """Whether there are steps to be taken."""
        return AHEAD if self.s.steps < goal else ARRIVED

    def move(self) -> int:
        """A step, after those that are taken in registers; says why no more can be taken."""
        if self.s.record.full(2 * self.s.n_c):
            return BUFFER_FULL
        if self.single and not self.rows.solved:
            end = self.s.record.untimed_until(self.plan.h, self.t0, self.first, self.last)
            in_registers(self.m, self.plan, self.s, self.rows, self.t0, self.first, end)
            if not (finite(self.s.g, 1) and finite(self.s.u, 1)):
                return NOT_FINITE
            if self.s.steps >= self.last:
                return DONE
            if self.s.record.full(2):
                return BUFFER_FULL
        k, events = self.s.steps - self.first, self.s.record.event
        t, t_next = self.t0 + self.plan.h * k, self.t0 + self.plan.h * (k + 1)
        code = take_step(self.m, self.plan, self.s, self.rows, t, t_next)
        if code != DONE:
            return code
        return end_step(self.m, self.plan, self.s, self.rows, t, t_next, events)


def look(m: Model, s: State, c: Rows, t: float) -> None:
    """Forces, gaps and gap velocities of the current state, as a time has them."""
    if m.linear:
        external_force(m, t, s.q, s.v, s.force)
    else:
        total_force(m, t, s.q, s.v, s.force)
    s.forces += 1
    measure(m, s, c, t)


def end_step(m: Model, plan: Plan, s: State, c: Rows, t: float, t_next: float, events: int) -> int:
    """The step is taken over, and kept where that is asked for; it began after so many events. Does the run go on?"""
    if s.record.next_time < s.record.n_times:
        keep_times(plan.h, s, t, t_next)
    copy(s.q, s.next_q, s.n_q)
    copy(s.v, s.next_v, s.n_q)
    copy(s.force, s.next_force, s.n_q)
    measure(m, s, c, t_next)
    s.steps += 1
    if not (finite(s.g, s.n_c) and finite(s.u, s.n_c)):
        return NOT_FINITE
    if s.record.is_due(s.steps) or (s.record.on_events and s.record.event > events):
        s.record.keep(t_next, 0.0, s.q, s.v, s.impulse)
    return DONE


def measure(m: Model, s: State, c: Rows, t: float) -> None:
    """Gaps and gap velocities of the current state."""
    if s.n_c == 0:
        return
    gaps(m, t, s.q, s.v, s.g)
    gap_velocities(m, t, s.q, s.v, c.H, c.H_t, s.u)


def keep_times(h: float, s: State, t: float, t_next: float) -> None:
    """Keep the states asked for within the step, q and v interpolated linearly."""
    while s.record.awaited() <= t_next + LATE * h:
        share = min(1.0, (s.record.awaited() - t) / (t_next - t))
        for i in range(s.n_q):
            s.q_between[i] = (1.0 - share) * s.q[i] + share * s.next_q[i]
            s.v_between[i] = (1.0 - share) * s.v[i] + share * s.next_v[i]
        s.record.keep_awaited(s.q_between, s.v_between, s.impulse)


def note_touching(m: Model, plan: Plan, s: State, t: float) -> None:
    """Contacts that begin at rest at next to no gap are closed up to a share of the way that forces push in a step.

    Such gaps are rounding of a motion before: all lengths may be zero, or rounding themselves.
    """
    near = TOUCHING * plan.h * pushed(m, plan, s, t)
    if not near < inf:
        return
    for i in range(s.n_c):
        if abs(s.g[i]) <= near and plan.h * abs(s.u[i]) <= near:
            s.slack[i] = max(s.slack[i], near)


def pushed(m: Model, plan: Plan, s: State, t: float) -> float:
    """The largest change of a velocity by the forces of a step, whose terms do not cancel; harmonic ones at most."""
    n = s.n_q
    if not m.linear:
        copy(s.try_v, s.force, n)
        known = divide_by_mass(m, t, s.q, s.v, s.A, s.R, s.try_v)
        return plan.h * largest(s.try_v, 0.0, n) if known else 0.0
    for j in range(n):
        s.try_f[j] = max(abs(s.force[j]), harmonic_terms(m, j))
    most = 0.0
    for i in range(n):
        total = 0.0
        for j in range(n):
            k = i * n + j
            total += abs(plan.A_f[k]) * s.try_f[j] + abs(plan.A_q[k] * s.q[j]) + abs(plan.A_v[k] * s.v[j])
        most = max(most, total)
    return most
