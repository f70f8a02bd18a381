"""Steps of `Located` chosen by a tolerance: what one step and its two halves do.

A step stops at its first event, and at a corner; what comes after is compared anew. So both runs are smooth: the
one is a single piece without a look at contacts, up to the time at which the halves have met an event, and
positions and velocities are compared just before it. What the forces of closed contacts hide from that, see
`hidden_forces`. The loop of the fixed steps takes each part.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import IMPACT
from lcpstep.kernels.dynamics import gaps
from lcpstep.kernels.layout import COLUMNS
from lcpstep.kernels.status import BUFFER_FULL, DONE, TOO_MANY_EVENTS
from lcpstep.kernels.vectors import distance, largest
from lcpstep.pointers import abs, after, inf, max, min, whole
from lcpstep.stepping.by_tolerance.control import stamp
from lcpstep.stepping.by_tolerance.hidden_forces import hidden, late
from lcpstep.stepping.by_tolerance.located_parts import Parts
from lcpstep.stepping.by_tolerance.sizes import NEAR
from lcpstep.stepping.pieces.codes import CLOSED, SAME_TIME, STOPPED
from lcpstep.stepping.pieces.times import driven_by

EARLY = 1.0 / 32.0  # of a step: an event before it leaves nothing to compare
TRIALS = 4  # of a step whose event comes at another time


class Attempts(Parts):
    """A run of `Located` by a tolerance; its parameters are those of its `Parts`."""

    def attempt(self) -> int:
        """One step, then two halves of it, both up to the first event; the last code of the loop."""
        h = self.step_size(self.level)
        start, end, until = self.into, self.ends(), inf
        entire, agreed = end == h, False
        for trial in range(TRIALS):
            before = self.w.jump
            self.compare(start, end, entire, until)
            if self.w.jump != before:  # a velocity jumps within the step, which ends there then
                self.restore()
                end, until = self.ends(), inf
                entire = end == h
                continue
            agreed = self.two.code != STOPPED or self.two.time == until or self.two.time == 0.0
            if agreed:
                break
            self.restore()
            until = self.two.time
            early = trial < TRIALS - 2 and (self.alike or self.saved.closed_now > 0)
            if early and EARLY * (end - start) < until < 0.5 * (end - start):
                end, entire, until = start + until, False, inf
        # Nothing of a step comes after the multiple that it ends at, or before what was kept, by rounding
        stamp(self.record, self.row, self.event, self.goal(), self.goal())
        for k in range(self.row if self.row > 0 else 1, self.record.row):
            self.record.t[k] = max(self.record.t[k], self.record.t[k - 1])
        self.full = self.two.code == BUFFER_FULL and self.event + self.row > 0
        if not self.full:
            self.weigh(end - start)
        # About the time of the event: the motion is back at its start
        self.failed = self.failed or not agreed
        self.cut = inf if entire and self.two.code == DONE else self.w.sigma
        return DONE if self.two.good() else self.two.code

    def weigh(self, length: float) -> None:
        """Errors of what the single piece and the halves have led to, both known."""
        event_first = self.two.time == 0.0  # before anything moved
        wrong_q, wrong_v = 0.0, 0.0
        self.failed = not self.two.good()
        self.hopeless = self.two.code == TOO_MANY_EVENTS and self.comes_again()
        if not event_first:
            self.failed = self.failed or not self.one.good()
            if not self.failed:
                wrong_q, wrong_v = max(self.depth(), self.astray()), self.wrong(length)
            wrong_q = max(wrong_q, distance(self.one.q, self.two.q, self.w.n_q))
            wrong_v = max(wrong_v, distance(self.one.v, self.two.v, self.w.n_q))
        self.apart_q, self.apart_v = wrong_q, wrong_v
        self.far_q, self.far_v = largest(self.two.q, 0.0, self.w.n_q), largest(self.two.v, 0.0, self.w.n_q)
        if self.two.time > 0.0:
            self.acceleration = distance(self.two.v, self.saved.v, self.w.n_q) / self.two.time
        self.happened = self.two.code == STOPPED or self.record.event > self.event

    def comes_again(self) -> bool:
        """Keep the instant of events without end; whether they came there before, whatever the step."""
        before, self.stuck = self.stuck, self.base() + self.w.sigma
        return abs(self.stuck - before) <= SAME_TIME * abs(self.stuck)

    def depth(self) -> float:
        """How deep a gap may have been below zero unseen: what its quadratic is wrong by, if it comes that near.

        By what the start lay within obstacles, which both runs take it out of, it is not; nor by what an obstacle
        goes in the rounding of a time.
        """
        deepest, t = 0.0, self.half.time
        if not self.rough:
            return deepest
        sunk = self.sunk()
        for c in range(self.w.n_c):
            if self.one.status[c] == CLOSED:
                continue
            g, u, a = self.saved.gap[c], self.saved.velocity[c], self.one.half[c]
            begins = g if g != 0.0 else self.w.gap_try[c]
            lifted = sunk * largest(after(self.w.G, c * self.w.n_q), 0.0, self.w.n_q)
            lifted += driven_by(self.w, c, self.now())
            error = max(0.0, abs(begins + t * (u + t * a) - self.half.gap[c]) - lifted)
            lowest = min(min(g, self.one.gap[c]), self.half.gap[c])
            if a > 0.0 > u > -4.0 * a * t:  # it is lowest within the step
                lowest = min(lowest, g - 0.25 * u * u / a)
            if lowest < NEAR * error:
                deepest = max(deepest, error)
        return deepest

    def sunk(self) -> float:
        """How far, along a coordinate, the start lay within what has struck, see `astray`; gaps into w.gap_try.

        What has struck may have been closed by it, while another contact there was thrown off.
        """
        furthest, struck = 0.0, False
        for c in range(self.w.n_c):
            struck = struck or (self.one.status[c] != CLOSED and self.saved.gap[c] == 0.0)
        if struck:
            gaps(self.m, self.now(), self.saved.q, self.saved.v, self.w.gap_try)
        for c in range(self.w.n_c if struck else 0):
            steep = largest(after(self.w.G, c * self.w.n_q), 0.0, self.w.n_q)
            if (self.saved.status[c] == CLOSED or self.saved.gap[c] == 0.0) and steep > 0.0:
                furthest = max(furthest, -self.w.gap_try[c] / steep)
        return furthest

    def astray(self) -> float:
        """How far off an impact was found, along a coordinate: states before it lie on closed contacts' obstacles.

        Both runs are put there, and out of the obstacle that is struck, and agree on it. What they have been put by
        tells, and how far from its obstacle what has struck is then.
        """
        if self.two.code != STOPPED:
            return 0.0
        furthest, first = self.two.off, after(self.record.events, self.event * COLUMNS)
        if self.saved.closed_now == 0 or self.record.event == self.event:
            return furthest
        # All that has happened came at one instant
        gaps(self.m, first[0], self.two.q, self.two.v, self.w.gap_try)
        for k in range(self.record.event - self.event):
            c, steep = whole(first[k * COLUMNS + 1]), 0.0
            if first[k * COLUMNS + 5] == IMPACT:
                steep = largest(after(self.w.G, c * self.w.n_q), 0.0, self.w.n_q)
            if steep > 0.0:
                furthest = max(furthest, abs(self.w.gap_try[c]) / steep)
        return furthest

    def wrong(self, length: float) -> float:
        """Error of the velocity by contacts that were closed, see `hidden_forces`."""
        worst = 0.0
        if self.saved.closed_now == 0:
            return worst
        for c in range(self.w.n_c):
            if self.saved.status[c] != CLOSED:
                continue
            p, lasts = 0.0, self.half.status[c] == CLOSED and self.two.status[c] == CLOSED
            lasts = lasts and self.one.status[c] == CLOSED and self.two.code == DONE
            if lasts:
                p = hidden(self.one.impulse[c], self.two.impulse[c])
                if self.means or self.alike:
                    p = max(p, self.held_on(c, length))
            elif self.means:
                end = self.two.time
                opened = end if self.two.status[c] == CLOSED else min(0.5 * length, end)
                if self.half.status[c] != CLOSED:
                    opened = 0.0
                p = late(self.one.force[c], self.half.force[c], self.two.force[c], length, opened, end)
            worst = max(worst, p * largest(after(self.w.MG, c * self.w.n_q), 0.0, self.w.n_q))
        return worst

    def held_on(self, c: int, length: float) -> float:
        """Impulse by which a contact is wrong that both runs keep closed, by means of its force over the parts."""
        one, first, two = self.one.impulse[c], self.half.impulse[c], self.two.impulse[c]
        return late(one / length, 2.0 * first / length, 2.0 * (two - first) / length, length, length, length)
