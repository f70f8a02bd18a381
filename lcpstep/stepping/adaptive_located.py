"""Steps of `Located` chosen by a tolerance: what one step and its two halves do.

A step stops at its first event, and at a corner; what comes after is compared anew. So both runs are smooth: the
one is a single piece without a look at contacts, up to the time at which the halves have met an event, and
positions and velocities are compared just before it. What the forces of closed contacts hide from that, see
`adaptive_forces`. The kernel of the fixed steps takes each part; what stands between is plain Python.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.compiled import compiled
from lcpstep.recording import LEAD, Record
from lcpstep.stepping.adaptive import (
    ACCEPTED,
    AGAIN,
    GIVEN_UP,
    INTO,
    LEVEL,
    PAUSED,
    SIZE_Q,
    SIZE_V,
    TOO_SMALL,
    TRIED,
    UNTIL,
    Control,
    base,
    distance,
    goal,
    judge,
    largest,
    now,
    over,
    stamp,
    step_size,
)
from lcpstep.stepping.adaptive_forces import hidden, late
from lcpstep.stepping.corners import find_corners
from lcpstep.stepping.impulses import COLLAPSE
from lcpstep.stepping.located_work import (
    ALPHA,
    BLIND,
    BUFFER_FULL,
    CLOSED,
    CLOSED_NOW,
    END,
    EVENT,
    FINISHED,
    FORCE_NOW,
    FORCES,
    GAP,
    GOAL,
    HALF,
    IMPULSE,
    LAST,
    LCP_CALLS,
    MADE_WITH,
    NEXT_TIME,
    PAUSING,
    RATE,
    RELEASE,
    ROW,
    SIGMA,
    STATUS,
    STOPPED,
    TURNED,
    UNCHANGED,
    UNDER_WAY,
    V_STRUCK,
    Plan,
    Q,
    V,
    Work,
)

Array = NDArray[np.float64]
Prepared = tuple[Plan, Work]
Offsets = tuple[float, float]  # from the base of a step to the beginning and the end of a part [s]
Step = Callable[[Plan, Work, float], int]  # one step from a time; the code of the loop
EARLY = 1 / 32  # of a step: an event before it leaves nothing to compare
NEAR = 3.0  # errors of a gap: from where on it may have closed
GOOD = (FINISHED, STOPPED)
NOTHING = np.zeros(0)


class Led(NamedTuple):
    """Where a run led: why it ended, and when; q, v before an event there."""

    code: int
    time: float
    q: Array
    v: Array
    gap: Array  # gaps, and halves of their accelerations over the piece, where it knows them but roughly
    half: Array
    closed: Array  # contacts that are closed; forces over the piece and impulses of all, where some were
    force: Array
    impulse: Array


def weigh(
    control: Any, failed: bool, one_q: Any, one_v: Any, q: Any, v: Any, wrong_q: float, wrong_v: float,
    happened: bool, cut: float,
) -> int:  # fmt: skip
    """Kernel: the verdict on a step that led to one_q, one_v in a single piece, and in two halves to q, v."""
    apart_q, apart_v = max(wrong_q, distance(one_q, q)), max(wrong_v, distance(one_v, v))
    return judge(control, failed, apart_q, apart_v, q, v, happened, cut)


def load(
    num: Any,
    mark: Any,
    W: Any,
    num_before: Any,
    rows: Any,
    row_before: Any,
    place: int,
    force: Any,
    impulse: Any,
) -> None:
    """Kernel: mean forces that would keep each contact closed over the last piece, impulses since the step began.

    `rows`: kept since, the first of them, which was `row_before`, before; impulses stand in them from `place` on.
    """
    for c in range(len(force)):
        force[c] = num[FORCE_NOW, c]
        if mark[STATUS, c] != CLOSED:
            pull = num[ALPHA, c]
            for d in range(len(force)):
                if mark[STATUS, d] == CLOSED:
                    pull += W[c, d] * num[FORCE_NOW, d]
            force[c] = -pull / W[c, c] if W[c, c] > 0.0 else math.nan
        impulse[c] = num[IMPULSE, c] - num_before[IMPULSE, c]
        if len(rows) > 0:
            impulse[c] -= row_before[place + c]
        for k in range(len(rows)):
            impulse[c] += rows[k, place + c]


class Attempts:
    """A run of `Located` as `adaptive.advance` wants it.

    `make(h)` gives what steps of size h need, `step` takes one of them; `second` tells the method of order two.
    """

    def __init__(
        self, make: Callable[[float], Prepared], step: Step, plan: Plan, w: Work, x: Array, record: Record,
        count: NDArray[np.int64], control: Control, second: bool, fast: bool,
    ) -> None:  # fmt: skip
        self.make, self.step, self.plan, self.w, self.x = make, step, plan, w, x
        self.record, self.count, self.control = record, count, control
        self.rough = second and not plan.plain  # gaps are no quadratics, as which they are looked at
        self.means = second and plan.trapezoidal  # forces of closed contacts are means over a piece
        self.alike = second and not plan.trapezoidal  # a piece moves as a longer one does
        self.sized = plan.trapezoidal and plan.stiff and not plan.small  # matrices are those of whole steps
        self.prepared: dict[int, Prepared] = {}
        self.taken = w  # the work space with the responses of the last part
        self.weigh: Callable[..., int] = compiled(weigh) if fast else weigh
        self.load: Callable[..., None] = compiled(load) if fast else load
        self.arrays = [w.vec, w.num, w.mark, x, count] + ([] if plan.constant else [w.G, w.MG, w.W, w.M])
        self.saved = [a.copy() for a in self.arrays]
        self.row, self.under_way = record.rows[0].copy(), False
        control.real[SIZE_Q], control.real[SIZE_V] = largest(w.vec[Q]), largest(w.vec[V])
        x[PAUSING], w.num[LAST] = 1.0, -1.0

    def attempts(self) -> int:
        """Take steps until the end of the span, full buffers, or a step that cannot be taken."""
        while self.control.whole[TRIED] < self.control.whole[UNTIL]:
            if over(self.control):
                return FINISHED
            left = len(self.record.rows) - self.count[ROW]
            if left < len(self.record.times) - self.count[NEXT_TIME] + 8:
                return PAUSED
            self.control.whole[TRIED] += 1
            self.store()
            code, verdict = self.attempt()
            full = code == BUFFER_FULL and self.saved[4][EVENT] + self.saved[4][ROW] > 0
            if verdict == ACCEPTED:
                self.x[UNDER_WAY] = 0.0
            else:
                self.undo()
            self.under_way = False
            if full:
                return PAUSED
            if verdict == GIVEN_UP:
                return TOO_SMALL if code in GOOD else code
        return PAUSED

    def attempt(self) -> tuple[int, int]:
        """One step, then two halves of it: the last code of the loop, and the verdict."""
        c = self.control
        self.base, self.goal, self.h = (
            float(base(c)),
            float(goal(c)),
            float(step_size(c, int(c.whole[LEVEL]))),
        )
        start, end = float(c.real[INTO]), self.end()
        until, entire = math.inf, end == self.h
        for _ in range(4):
            one, half, two = self.compare(start, end, entire, until)
            if two.code != STOPPED or two.time in (until, 0.0):
                break
            self.undo()
            until = two.time
            early = self.alike or self.saved[3][CLOSED_NOW] > 0.0
            if early and EARLY * (end - start) < until < 0.5 * (end - start):
                end, entire, until = start + until, False, math.inf
        self.in_time(entire)
        wrong_q = wrong_v = 0.0
        if two.time == 0.0:  # an event before anything moved
            one = two
        elif one.code in GOOD and two.code in GOOD:
            wrong_q = self.depth(one, half)
            wrong_v = self.wrong(one, half, two, end - start)
        if two.code == BUFFER_FULL and self.saved[4][EVENT] + self.saved[4][ROW] > 0:
            return two.code, AGAIN
        failed = one.code not in GOOD or two.code not in GOOD
        happened = two.code == STOPPED or self.count[EVENT] > self.saved[4][EVENT]
        cut = math.inf if entire and two.code == FINISHED else self.x[SIGMA]
        verdict = self.weigh(c, failed, one.q, one.v, two.q, two.v, wrong_q, wrong_v, happened, cut)
        return two.code, verdict

    def compare(self, start: float, end: float, entire: bool, until: float) -> tuple[Led, Led, Led]:
        """A single piece up to a time; from the same start a half, and both halves, at most to an event.

        `start`, `end`: since the base of the step, whose end this is where it is `entire`.
        """
        last, even = self.goal if entire else self.base + end, entire and start == 0.0
        one = self.led(self.part((start, end), last, even and until == math.inf, until, 0))
        self.undo()
        middle = start + 0.5 * (end - start)
        half = two = self.led(self.part((start, middle), self.base + middle, even, 0.0, 1))
        if half.code == FINISHED:
            two = self.led(self.part((middle, end), last, even, 0.0, 1))
            two = two._replace(time=middle - start + two.time)
        return one, half, two

    def end(self) -> float:
        """Where the step ends that begins now, since its base: at the next multiple, or at a corner before it."""
        if len(self.plan.corners) == 0:
            return self.h
        corner = find_corners(self.plan, now(self.control))[1]
        return float(corner - self.base) if corner < self.goal - self.plan.margin else self.h

    def part(self, offsets: Offsets, last: float, even: bool, until: float, halved: int) -> int:
        """A part of a step, in a single piece up to a time if that is not 0; `even` where it is as long as a level's.

        Times are counted from the base of the step, so that what happens at one instant has one time whichever part
        it ends. `last`: the time at the end of the part.
        """
        (start, end), x, level = offsets, self.x, int(self.control.whole[LEVEL]) + (halved if even else 0)
        if level not in self.prepared:
            self.prepared[level] = self.make(step_size(self.control, level))
        p, w = self.make(end - start) if self.sized and not even else self.prepared[level]
        if end != p.h:
            p = p._replace(h=end)
        self.taken = w
        x[UNCHANGED], x[BLIND], x[GOAL] = 0.0, until, last
        self.carry_on(start, even and start == 0.0, COLLAPSE * p.h)
        code = self.step(p, w, self.base)
        if code == FINISHED:  # a contact's flight is followed without counting times
            x[SIGMA] = end
        self.elapsed = x[SIGMA] - start
        return code

    def carry_on(self, start: float, anew: bool, close: float) -> None:
        """Begin a part at an offset: a step `anew`; else what has just fired has done so now."""
        x, last = self.x, self.w.num[LAST]
        anew = (
            anew and x[SIGMA] != 0.0
        )  # after an event at its very beginning a step goes on: it is not forgotten
        x[UNDER_WAY] = 0.0 if anew else 1.0
        if anew:
            return
        if x[SIGMA] != start:
            just = (last >= 0.0) & (x[SIGMA] - last <= close)
            last[:] = np.where(just, start, -1.0)
            self.w.num[TURNED] += start - x[SIGMA]
        x[SIGMA], x[END] = start, 0.0

    def in_time(self, entire: bool) -> None:
        """Nothing of a step comes after the multiple that it ends at, by rounding."""
        if entire and self.base + self.h > self.goal:
            rows, events = (int(self.saved[4][k]) for k in (ROW, EVENT))
            last = self.goal
            stamp(self.record, rows, int(self.count[ROW]), events, int(self.count[EVENT]), last, last)

    def led(self, code: int) -> Led:
        """Where the part that has just been taken led."""
        w = self.w
        gap = half = force = impulse = NOTHING
        if self.rough:
            gap, half = w.num[GAP].copy(), w.num[HALF].copy()
        if self.saved[3][CLOSED_NOW] > 0.0 and code in GOOD:
            force, impulse = self.loads()
        v = w.vec[V_STRUCK if code == STOPPED and self.x[BLIND] == 0.0 else V]
        closed = w.mark[STATUS] == CLOSED
        return Led(code, self.elapsed, w.vec[Q].copy(), v.copy(), gap, half, closed, force, impulse)

    def depth(self, one: Led, half: Led) -> float:
        """How deep a gap may have been below zero unseen: what its quadratic is wrong by, if it comes that near."""
        deepest, num, t = 0.0, self.saved[1], half.time
        for c in np.flatnonzero(np.logical_not(one.closed))[: len(one.gap)]:
            g, u, a = num[GAP, c], num[RATE, c], one.half[c]
            error = abs(g + t * (u + t * a) - half.gap[c])
            lowest = min(g, one.gap[c], half.gap[c])
            if a > 0.0 > u:
                lowest = min(lowest, g - 0.25 * u * u / a)
            if lowest < NEAR * error:
                deepest = max(deepest, error)
        return deepest

    def loads(self) -> tuple[Array, Array]:
        """Forces of the contacts over the last piece, unknown where one opens at its end; impulses of the step."""
        n_c, first, last = self.w.num.shape[1], max(int(self.saved[4][ROW]) - 1, 0), int(self.count[ROW])
        force, impulse = np.empty(n_c), np.empty(n_c)
        rows, place = self.record.rows[first:last], LEAD + 2 * self.w.vec.shape[1]
        self.load(
            self.w.num, self.w.mark, self.mobilities(), self.saved[1], rows, self.row, place, force, impulse
        )
        if self.count[EVENT] > self.saved[4][EVENT]:
            force[self.opened_at_end()] = math.nan
        return force, impulse

    def opened_at_end(self) -> list[int]:
        """Contacts that have opened at the end of a piece, with a velocity, and not at its beginning."""
        log = self.record.events[int(self.saved[4][EVENT]) : int(self.count[EVENT])]
        return [int(e[1]) for e in log if e[5] == RELEASE and e[3] > 0.0]

    def mobilities(self) -> Array:
        """How the contacts' accelerations answer their forces, over the last piece."""
        return self.taken.WA[int(self.x[MADE_WITH])] if self.means and self.plan.constant else self.w.W

    def wrong(self, one: Led, half: Led, two: Led, length: float) -> float:
        """Error of the velocity by contacts that were closed, see `adaptive_forces`."""
        if self.saved[3][CLOSED_NOW] == 0.0:
            return 0.0
        worst = 0.0
        for c in np.flatnonzero(self.saved[2][STATUS] == CLOSED):
            p = 0.0
            if self.means:
                end = two.time
                opened = 0.0 if not half.closed[c] else (end if two.closed[c] else min(0.5 * length, end))
                p = late(one.force[c], half.force[c], two.force[c], length, opened, end)
            if one.closed[c] and two.closed[c] and two.code == FINISHED:
                p = max(p, hidden(one.impulse[c], two.impulse[c]))
            worst = max(worst, p * largest(self.w.MG[c]))
        return worst

    def store(self) -> None:
        """Keep the state at the start of a step, and the last row, which an event at its time changes."""
        for saved, a in zip(self.saved, self.arrays, strict=True):
            np.copyto(saved, a)
        self.row.fill(0.0)
        if self.count[ROW] > 0:
            np.copyto(self.row, self.record.rows[self.count[ROW] - 1])
        self.under_way = True

    def undo(self) -> None:
        """Back to the start of the step, if one is under way; work that was done stays counted."""
        if not self.under_way:
            return
        done = self.saved[4]
        done[LCP_CALLS], done[FORCES] = self.count[LCP_CALLS], self.count[FORCES]
        for saved, a in zip(self.saved, self.arrays, strict=True):
            np.copyto(a, saved)
        if self.count[ROW] > 0:
            np.copyto(self.record.rows[self.count[ROW] - 1], self.row)
