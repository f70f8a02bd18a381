"""Steps of `Moreau` chosen by a tolerance: what one step and its two halves do, as kernels.

Beside the difference of the two runs these count as errors, for both may agree on what is wrong:

    h |v+ - v|       position, in steps with an impact: its place in the step is not known
    |v_free - v|     velocity, in these steps: what the forces do from the start of the step to the impact
    depth            by which a contact without impulse has gone below its obstacle, or has been below in between: an
                     impact that is still to come, so that it takes no more than a step with an event may, however
                     long the step (up to there velocities are wrong by all of their jump)
    height           by which a gap has opened above a contact that is pressed and does not strike: its obstacle has
                     gone away within the step, and is still again

and what releases, friction (`hidden_switches`) and edges of obstacles (`hidden_edges`) hide.
Their velocities are not compared: an impact that one run sees and the other just after the end is no error. So the
step before an impact is halved until it is short, which costs the logarithm of its length. A contact that closes
slower than the tolerance resolves is closed without rebound, so that chattering ends; one that lasts stays active
while its gap is below the tolerance, for steps above what curves or shakes open it by their own error.

A step ends at a corner of the scene, on its near side, and the next one begins on its far side, where forces and
obstacles' velocities are other ones. What rests on an obstacle is taken along without rebound, or left behind, as by
the event-driven integrator: u in the law of the blow is that before the corner. What does not rest has the new one.
Steps up to a corner, and from it to the next multiple, are of sizes of their own.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.kernels.clock import Clock
from lcpstep.kernels.status import BUFFER_FULL, DONE
from lcpstep.kernels.vectors import clear, copy, copy_indices, distance, largest
from lcpstep.pointers import abs, after, inf, max, min
from lcpstep.stepping.by_tolerance.control import Control, stamp
from lcpstep.stepping.by_tolerance.hidden_edges import Edges, dip
from lcpstep.stepping.by_tolerance.hidden_switches import Switches
from lcpstep.stepping.by_tolerance.sizes import LEAST_SHARE, OWN
from lcpstep.stepping.steps import LATE
from lcpstep.stepping.theta_method.responses import refit
from lcpstep.stepping.theta_method.theta_loop import Steps, look


class Attempts(Control):
    """A run of `Moreau` by a tolerance.

    way                         the loop, which takes the parts of a step
    m, plan, s, rows            as it has them; the matrices of the plan are those of the part at hand
    times                       states asked for, which are kept here and not by the loop
    begin, closed, steps_before   the state at the start of the step: numbers, marks, and how many steps it is after
    begin_v; one_q, one_v       velocities there; where the one step led
    part_q, part_v, part_g, part_u        the state at the start of the part at hand, its numbers in the same order
    between_q, between_v        a state within it
    struck                      whether anything was, in the step or one of its halves
    share                       of the error allowed, in those that a step with an event may make; at least 1
    switches, edges             contacts that open, and friction; obstacles with edges
    A_q, A_v, A_f, X, W         of every level, where the system is linear
    clock                       knows the corners: the next one is at its `high`
    ends                        time at which the step at hand ends; that of a corner where it ends there
    at_corner, even             whether it does, and whether it is as long as those of its level
    blow                        whether an obstacle, whose velocity has jumped, strikes what rests on it at its start

    Parameters
    ----------
    way : Steps
    make     the matrices of steps of a size
    clock : Clock
    span, h, tolerance, order    see `Control`
    """

    def __init__(
        self, way: Steps, make: Callable[[float], dict[str, Any]], clock: Clock, span: tuple[float, float],
        h: float, tolerance: float, order: int,
    ) -> None:  # fmt: skip
        super().__init__(way.s.record, make, span, h, tolerance, order)
        m, plan, s, rows = way.m, way.plan, way.s, way.rows
        self.way, self.m, self.plan, self.s, self.rows = way, m, plan, s, rows
        self.times, self.record.n_times = self.record.times, 0
        self.switches, self.edges = Switches(s.n_q, s.n_c, rows.n_c + rows.n_t, rows.n), Edges(s.n_c)
        self.struck, self.share = False, 1.0
        places = OWN + 2 if m.linear else 1
        self.matrices = {name: np.zeros((places, *x.shape)) for name, x in plan.matrices.items()}
        self.own_made[:] = not m.linear
        self.A_q, self.A_v = doubles(self.matrices["A_q"]), doubles(self.matrices["A_v"])
        self.A_f, self.X = doubles(self.matrices["A_f"]), doubles(self.matrices["X"])
        self.W = doubles(self.matrices["W"])
        n_q, n_c, n = s.n_q, s.n_c, s.n_moving
        self.kept, self.steps_before = (np.zeros(2 * n + 4 * n_q), np.zeros(2 * n_c, dtype=np.intp)), 0
        self.begin, self.closed = doubles(self.kept[0]), indices(self.kept[1])
        self.part_q, self.one_q = after(self.begin, n), after(self.begin, 2 * n)
        self.part_v, self.part_g = after(self.part_q, n_q), after(self.part_q, 3 * n_q)
        self.part_u, self.one_v = after(self.part_g, n_c), after(self.one_q, n_q)
        self.between_q, self.between_v = after(self.one_q, 2 * n_q), after(self.one_q, 3 * n_q)
        self.begin_v = after(self.begin, n_q)
        self.clock, self.ends = clock, span[1]
        self.at_corner, self.even, self.blow = False, True, False
        self.look_ahead(span[0])
        self.size_q, self.size_v = largest(self.s.q, 0.0, s.n_q), largest(self.s.v, 0.0, s.n_q)

    def attempt(self) -> int:
        """One step, then two halves of it. The halves are left out where they cannot help."""
        n = self.s.n_q
        slow, h, t = self.resolved(self.size_v), self.ahead(), self.now()
        self.struck, self.share = False, max(1.0, h / (self.span * LEAST_SHARE))
        self.switches.begin(self.s, slow)
        code = self.part(0, t, h, slow)
        if code == DONE:
            if max(self.apart_q / self.resolved(self.size_q), self.apart_v / slow) > 2.0 * self.share:
                self.apart_q = inf
            else:
                copy(self.one_q, self.s.q, n)
                copy(self.one_v, self.s.v, n)
                self.restore()
                self.apart_q = self.apart_v = 0.0
                code = self.halves(t, h, slow)
        self.full = code == BUFFER_FULL and self.event > 0
        self.failed = code != DONE
        if not self.struck and h > 0.0:
            self.acceleration = distance(self.s.v, self.begin_v, n) / h
        self.far_q, self.far_v = largest(self.s.q, 0.0, n), largest(self.s.v, 0.0, n)
        return code

    def halves(self, t: float, h: float, slow: float) -> int:
        """Two steps of half the size, and what they differ by from the one."""
        code = self.part(1, t, 0.5 * h, slow)
        if code == DONE:
            code = self.part(2, t + 0.5 * h, 0.5 * h, slow)
        if code != DONE:
            return code
        if self.record.event > self.event:
            self.happened = True
        self.apart_q = max(self.apart_q, distance(self.one_q, self.s.q, self.s.n_q))
        if not self.m.flat:
            self.look_for_edges(h, slow)
        if not self.struck:
            apart = distance(self.one_v, self.s.v, self.s.n_q)
            apart = max(apart, self.switches.unseen(h, self.plan, self.s, self.rows))
            self.apart_v = max(self.apart_v, apart - self.switches.creep)
        return DONE

    def look_for_edges(self, h: float, slow: float) -> None:
        """Errors where obstacles have edges: what lasts is struck there, or leaves, at a time that is not known."""
        self.edges.find(self.switches.held, slow)
        self.happened = self.happened or self.edges.passed or self.edges.depth > 0.0
        self.apart_q = max(self.apart_q, self.edges.depth)
        if self.edges.passed and not self.struck:
            self.struck = True
            self.apart_q = max(self.apart_q, h * distance(self.s.v, self.begin_v, self.s.n_q))
            self.apart_v = max(self.apart_v, 2.0 * distance(self.s.v_free, self.part_v, self.s.n_q))

    def part(self, part: int, start: float, h: float, slow: float) -> int:
        """The step (part 0), or a half of it, taken from `start`; errors at its contacts."""
        row, event = self.record.row, self.record.event
        self.before(slow)
        level = self.level if self.even else OWN
        self.place(level if part == 0 else level + 1, h)
        if self.m.linear and not self.even and part < 2:
            refit(self.m, self.plan, self.s, self.rows, start)
        k = self.s.steps
        code = self.way.take(start, k, k + 1)
        if code != DONE:
            return code
        self.after_part(h, slow)
        if part > 0 and not self.m.flat:
            self.edges.note(part - 1, h, self.s, self.rows, self.part_v, self.part_g, self.part_u)
        self.switches.note(part, self.plan, self.s, self.rows, self.part_u, slow)
        end = start + h
        if part == 2 and end != self.ends:
            stamp(self.record, row, event, end, self.ends)
            end = self.ends
        if part > 0:
            self.keep_times(start, end)
        return DONE

    def ahead(self) -> float:
        """Length of the step at hand: to the next multiple, or to a corner before it, whose near side it ends on."""
        self.ends = self.goal()
        self.at_corner = self.clock.high < inf and self.clock.inside(self.clock.high) < self.ends
        self.even = not self.at_corner and self.into == 0.0
        if self.even:
            return self.step_size(self.level)
        if not self.at_corner:
            return self.ends - self.now()
        self.ends = self.clock.high
        near = self.clock.inside(self.ends)
        self.cut = self.ends + (self.ends - near) - self.base()  # where the run goes on
        return near - self.now()

    def look_ahead(self, t: float) -> None:
        """Find the next corner after a time."""
        self.clock.find_corners(t)
        while self.clock.high < inf and self.clock.inside(self.clock.high) <= t:
            self.clock.find_corners(self.clock.high)

    def accept(self) -> None:
        """The step stands; after a corner, forces and gap velocities are those of its far side."""
        self.blow = False
        if not self.at_corner:
            return
        slow = self.resolved(self.size_v)
        self.look_ahead(self.clock.high + (self.clock.high - self.clock.inside(self.clock.high)))
        copy(self.part_u, self.s.u, self.s.n_c)
        look(self.m, self.s, self.rows, self.clock.inside(self.clock.low))
        for i in range(self.s.n_c):
            before = self.part_u[i]
            if self.s.closed[i] > 0 and abs(before) <= slow and self.s.u[i] <= before + slow:
                if self.s.u[i] < before - slow:  # however far rounding has opened it
                    self.blow, self.s.g[i] = True, min(0.0, self.s.g[i])
                self.s.u[i] = before

    def place(self, level: int, h: float) -> None:
        """What a step of a level multiplies with."""
        n, rows, k = self.s.n_q, self.rows.n, level if self.m.linear else 0
        self.plan.h = h
        self.plan.A_q, self.plan.A_v = after(self.A_q, k * n * n), after(self.A_v, k * n * n)
        self.plan.A_f, self.plan.X = after(self.A_f, k * n * n), after(self.X, k * rows * n)
        self.plan.W = after(self.W, k * rows * rows)

    def before(self, slow: float) -> None:
        """Remember where a part begins; contacts slower than `slow` have no restitution in it."""
        copy(self.part_q, self.s.q, self.s.n_moving)
        self.rows.blows.least = slow
        self.s.opened = self.tolerance * (1.0 + self.size_q)
        clear(self.rows.p, self.s.n_c)

    def after_part(self, h: float, slow: float) -> None:
        """Errors of a part at its contacts."""
        deeper, struck = 0.0, self.blow
        v, v_before = self.s.v, self.part_v
        forced = distance(self.s.v_free, v_before, self.s.n_q)
        thrown = distance(v, v_before, self.s.n_q) > slow + forced
        for i in range(self.s.n_c):
            g = self.s.g[i]
            if self.rows.projected and self.s.closed[i] < 2:
                g = self.rows.entered[i]  # as it was noticed; what has lasted is repaired for good
            gained = max(0.0, -g) - max(0.0, -self.part_g[i])
            if self.rows.p[i] > 0.0:
                # normals that are nearly parallel, or other units, make of a slow approach a jump of velocities
                closes = abs(self.s.u[i] - self.part_u[i]) > slow or (thrown and self.s.closed[i] == 1)
                struck = struck or closes
                if not closes and not self.blow:  # gaps begin on their obstacles there
                    gained = max(gained, g - max(0.0, self.part_g[i]))
            else:
                gained = max(gained, dip(self.part_g[i], self.part_u[i], self.s.u[i], h))
                if gained > 0.0:
                    self.happened = True
                    gained *= self.share
            deeper = max(deeper, gained)
        self.apart_q = max(self.apart_q, deeper)
        if struck:
            self.happened = self.struck = True
            self.apart_q = max(self.apart_q, h * distance(v, v_before, self.s.n_q))
            self.apart_v = max(self.apart_v, forced)

    def keep_times(self, t: float, t_next: float) -> None:
        """Keep the states asked for within a part: velocities linear, positions as `between` would have them."""
        h = t_next - t
        bend = 1.0 if self.plan.theta == 0.5 else 0.0
        while self.record.next_time < self.n_times and self.times[self.record.next_time] <= t_next + LATE * h:
            x = min(1.0, (self.times[self.record.next_time] - t) / h)
            for i in range(self.s.n_q):
                q, v = self.part_q[i], self.part_v[i]
                curve = 0.5 * bend * h * (self.s.v[i] - v)
                self.between_q[i] = q + x * (self.s.q[i] - q) - x * (1.0 - x) * curve
                self.between_v[i] = v + x * (self.s.v[i] - v)
            self.record.keep(
                self.times[self.record.next_time], 0.0, self.between_q, self.between_v, self.s.impulse
            )
            self.record.next_time = self.record.next_time + 1

    def store(self) -> None:
        """Keep the state at the start of a step."""
        copy(self.begin, self.s.q, self.s.n_moving)
        copy_indices(self.closed, self.s.closed, 2 * self.s.n_c)
        self.steps_before = self.s.steps
        self.mark()

    def restore(self) -> None:
        """Go back there; work that was done stays counted, and whether anything happened known."""
        if self.record.event > self.event:
            self.happened = True
        copy(self.s.q, self.begin, self.s.n_moving)
        copy_indices(self.s.closed, self.closed, 2 * self.s.n_c)
        self.s.steps, self.s.iteration = self.steps_before, 0
        self.wind_back()
