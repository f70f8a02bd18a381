"""Parts of a step of `Located` by a tolerance: a single piece and its halves, taken by the loop of the fixed steps.

A part ends at its first event. The state at the start of the step is kept, so that it can be gone back to.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.events.codes import RELEASE
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.status import DONE
from lcpstep.kernels.vectors import clear, copy, copy_indices, largest
from lcpstep.pointers import Doubles, after, inf, nan, whole
from lcpstep.stepping.by_tolerance.control import Control
from lcpstep.stepping.by_tolerance.sizes import OWN
from lcpstep.stepping.pieces.codes import CLOSED, STOPPED, WHOLE
from lcpstep.stepping.pieces.corners import find_corners
from lcpstep.stepping.pieces.keep import keep_now
from lcpstep.stepping.pieces.loop import Steps
from lcpstep.stepping.pieces.smooth import SMALL, invert
from lcpstep.stepping.pieces.state import MARKS, Work
from lcpstep.stepping.pieces.switches import COLLAPSE


class Led:
    """Where a run led.

    code, time      why it ended, and when, since the start of the step
    q, v            before an event there;  off   how far it was put there from where its piece had led
    gap, half       gaps, and halves of their accelerations over the piece
    status          OPEN or CLOSED
    force, impulse  over the piece, and since the start of the step, of contacts where some were closed
    """

    def __init__(self, n_q: int, n_c: int) -> None:
        self.kept = np.zeros(2 * n_q + 4 * n_c), np.zeros(n_c, dtype=np.intp)
        self.q, self.status = doubles(self.kept[0]), indices(self.kept[1])
        self.v, self.gap = after(self.q, n_q), after(self.q, 2 * n_q)
        self.half, self.force = after(self.gap, n_c), after(self.gap, 2 * n_c)
        self.impulse = after(self.gap, 3 * n_c)
        self.code, self.time, self.off = DONE, 0.0, 0.0

    def good(self) -> bool:
        """Whether it could be taken."""
        return self.code in (DONE, STOPPED)


def copy_state(to: Work, w: Work, n_numbers: int, n_marks: int, n_matrices: int) -> None:
    """All of a motion's state: so many numbers, marks, and numbers of matrices that change."""
    copy(to.q, w.q, n_numbers)
    copy_indices(to.status, w.status, n_marks)
    copy(to.G, w.G, n_matrices)
    to.sigma, to.end, to.low, to.high = w.sigma, w.end, w.low, w.high
    to.stalled, to.settled, to.ahead = w.stalled, w.settled, w.ahead
    to.under_way, to.touching, to.fresh = w.under_way, w.touching, w.fresh
    to.events, to.closed_now, to.made_with = w.events, w.closed_now, w.made_with
    to.steps, to.cut, to.idle = w.steps, w.cut, w.idle


class Parts(Control):
    """What a run of `Located` by a tolerance compares.

    way                     the loop, which takes the parts of a step
    m, plan, w              as it has them; the matrices of the plan are those of the part at hand
    saved, last_row         the state at the start of the step, and the last row, which an event at its time changes
    A_inverse, AG, WA       of every level, and last of a part as long as none
    rough                   gaps are no quadratics, as which they are looked at
    means                   forces of closed contacts are means over a piece
    alike                   a piece moves as a longer one does
    sized                   matrices are those of whole steps
    elapsed                 time that the last part has taken
    stuck                   instant of events without end in the last attempt that had them
    one, half, two          a single piece; the first of two halves; both

    Parameters
    ----------
    way : Steps
    make     the matrices of steps of a size
    span, h, tolerance, order    see `Control`
    """

    def __init__(
        self, way: Steps, make: Callable[[float], dict[str, Any]], span: tuple[float, float], h: float,
        tolerance: float, order: int,
    ) -> None:  # fmt: skip
        super().__init__(way.w.record, make, span, h, tolerance, order)
        plan, w = way.plan, way.w
        self.way, self.m, self.plan, self.w = way, way.m, plan, w
        self.saved, self.own_row = Work(w.n_q, w.n_c), np.zeros(way.w.record.row_size)
        self.last_row = doubles(self.own_row)
        self.n_numbers, self.n_marks = len(w.numbers), MARKS * w.n_c
        self.n_matrices = 0 if plan.constant else len(w.matrices)
        places = OWN + 1 if self.m.linear else 1
        self.matrices = {name: np.zeros((places, *x.shape)) for name, x in make(h).items()}
        self.A_inverse, self.AG = doubles(self.matrices["A_inverse"]), doubles(self.matrices["AG"])
        self.WA, self.own_made[:] = doubles(self.matrices["WA"]), not self.m.linear
        second = order == 2
        self.rough, self.means = second and not plan.plain, second and self.m.linear
        self.alike = second and not self.m.linear
        self.sized = self.means and plan.stiff and w.n_q > SMALL
        self.one, self.half, self.two = Led(w.n_q, w.n_c), Led(w.n_q, w.n_c), Led(w.n_q, w.n_c)
        self.elapsed, self.stuck = 0.0, -inf
        self.size_q, self.size_v = largest(self.w.q, 0.0, w.n_q), largest(self.w.v, 0.0, w.n_q)
        w.pausing = True
        for c in range(w.n_c):
            self.w.last[c] = -1.0

    def compare(self, start: float, end: float, entire: bool, until: float) -> None:
        """A single piece up to a time; from the same start a half, and both halves, at most to an event.

        `start`, `end`: since the base of the step, whose end this is where it is `entire`.
        """
        last = self.goal() if entire else self.base() + end
        even = entire and start == 0.0
        # It keeps no states: of thousands asked for ahead each would cost
        self.record.next_time = self.n_times
        code = self.part(start, end, last, even and until == inf, until, 0)
        self.led(self.one, code)
        self.restore()
        middle = start + 0.5 * (end - start)
        code = self.part(start, middle, self.base() + middle, even, 0.0, 1)
        self.led(self.half, code)
        if code != DONE:
            self.led(self.two, code)
            return
        code = self.part(middle, end, last, even, 0.0, 1)
        self.led(self.two, code)
        self.two.time = middle - start + self.two.time

    def ends(self) -> float:
        """Where the step ends that begins now, since its base: at the next multiple, or at a corner before it."""
        _low, corner = find_corners(self.plan, self.w, self.now())
        return corner - self.base() if corner < self.goal() - self.plan.margin else self.step_size(self.level)

    def part(self, start: float, end: float, last: float, even: bool, until: float, halved: int) -> int:
        """A part of a step, in a single piece up to a time if that is not 0; `even` where it is as long as a level's.

        Times are counted from the base of the step, so that what happens at one instant has one time whichever part
        it ends. `last`: the time at the end of the part.
        """
        level = self.level + halved if even else self.level
        if self.sized and not even:
            self.place(OWN, end - start)
            invert(self.m, self.plan, self.w, end - start, WHOLE)
        else:
            self.place(level, self.step_size(level))
        self.plan.h = end
        self.w.unchanged, self.w.blind, self.w.goal, self.w.off = False, until, last, 0.0
        self.carry_on(start, even and start == 0.0, COLLAPSE * end)
        code = self.way.take(self.base(), self.w.steps, self.w.steps + 1)
        if code == DONE:  # a contact's flight is followed without counting times
            self.w.sigma = end
        self.elapsed = self.w.sigma - start
        return code

    def place(self, level: int, made_for: float) -> None:
        """Matrices of a level."""
        n, n_c, k = self.w.n_q, self.w.n_c, level if self.m.linear else 0
        self.plan.made_for, self.plan.A_inverse = made_for, after(self.A_inverse, k * 2 * n * n)
        self.plan.AG, self.plan.WA = after(self.AG, k * 2 * n_c * n), after(self.WA, k * 2 * n_c * n_c)

    def carry_on(self, start: float, anew: bool, close: float) -> None:
        """Begin a part at an offset: a step `anew`; else what has just fired has done so now."""
        # After an event at its very beginning a step goes on: it is not forgotten
        self.w.under_way = not anew or self.w.sigma == 0.0
        if not self.w.under_way:
            return
        if self.w.sigma != start:
            for c in range(self.w.n_c):
                just = self.w.last[c] >= 0.0 and self.w.sigma - self.w.last[c] <= close
                self.w.last[c] = start if just else -1.0
                self.w.turned[c] = self.w.turned[c] + (start - self.w.sigma)
        self.w.sigma, self.w.end = start, 0.0

    def led(self, to: Led, code: int) -> None:
        """Where the part that has just been taken led."""
        to.code, to.time, to.off = code, self.elapsed, self.w.off
        copy(to.q, self.w.q, self.w.n_q)
        copy(to.v, self.w.v_struck if code == STOPPED and self.w.blind == 0.0 else self.w.v, self.w.n_q)
        for c in range(self.w.n_c):
            to.gap[c], to.half[c], to.status[c] = self.w.gap[c], self.w.half[c], self.w.status[c]
        if self.saved.closed_now > 0 and to.good():
            self.loads(to.force, to.impulse)

    def loads(self, force: Doubles, impulse: Doubles) -> None:
        """Forces that would keep the contacts closed, means over the last piece; their impulses since the step began.

        The force is unknown where a contact has opened at the end of the piece, with a velocity, and not at its
        beginning.
        """
        W = self.w.W
        if self.means and self.plan.constant:
            W = after(self.plan.WA, self.w.made_with * self.w.n_c * self.w.n_c)
        n = self.w.n_c
        for c in range(n):
            force[c] = self.w.force_now[c]
            if self.w.status[c] != CLOSED:
                pull = self.w.alpha[c]
                for d in range(n):
                    if self.w.status[d] == CLOSED:
                        pull += W[c * n + d] * self.w.force_now[d]
                force[c] = -pull / W[c * n + c] if W[c * n + c] > 0.0 else nan
            impulse[c] = self.w.pushed[c]
        for k in range(self.event, self.record.event):
            event = after(self.record.events, k * COLUMNS)
            if event[5] == RELEASE and event[3] > 0.0:
                force[whole(event[1])] = nan

    def store(self) -> None:
        """Keep the state at the start of a step, and the last row."""
        clear(self.w.pushed, self.w.n_c)
        copy_state(self.saved, self.w, self.n_numbers, self.n_marks, self.n_matrices)
        self.mark()
        self.record.read_last(self.last_row)

    def restore(self) -> None:
        """Go back to the start of the step; work that was done stays counted."""
        copy_state(self.w, self.saved, self.n_numbers, self.n_marks, self.n_matrices)
        if self.w.low < self.w.jump < self.w.high:  # a jump that has been found since then
            self.w.high = self.w.jump
        self.wind_back()
        self.record.write_last(self.last_row)

    def accept(self) -> None:
        """The step stands; an impact at the very end of the span comes before the state asked for there."""
        self.w.under_way = False
        if self.over():
            keep_now(self.w, self.stop)
