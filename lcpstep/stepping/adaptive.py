"""Steps of `Located` chosen by an error estimate: one step of h is compared with two of h/2, which are kept.

A step is accepted where the difference, as large as tolerance * (1 + size of the motion) allows over the whole span,
takes no more than its share h / span of that. So errors of the whole motion are proportional to the tolerance, up to
what the motion itself magnifies. Steps are h_max / 2^k at multiples of themselves: few sizes, whose matrices are made
once, and an end of the span that is met exactly. Velocities count where both runs had the same events: an impact
that one of them sees just after the end of the step is no error. Source: E. Hairer, S. P. Norsett, G. Wanner, Solving
Ordinary Differential Equations I (1993), section II.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.stepping import located_work as work
from lcpstep.stepping.steps import RESOLUTION, WHOLE
from lcpstep.trajectory import Status

LEVELS = 30  # halvings of the longest step
SAFE = 0.1  # of what is allowed: twice the step, eight times the error, may then be accepted
LEAST_SHARE = 1e-3  # of the span, in steps with events: they are few, and releases are not smooth
LOOK = 256  # steps between two looks at the outside world


class State:
    """A copy of all that steps change."""

    def __init__(self, run: Any) -> None:
        w = run.work
        self.arrays = [w.vec, w.num, w.mark, w.G, w.MG, w.W, w.M, run.x, run.count]
        self.saved = [a.copy() for a in self.arrays]
        self.where = run.plan, run.t0, run.first

    def restore(self, run: Any) -> None:
        """Go back there; work that was done stays counted."""
        done = [int(run.count[i]) for i in (work.LCP_CALLS, work.FORCES)]
        for a, saved in zip(self.arrays, self.saved, strict=True):
            a[...] = saved
        run.count[work.LCP_CALLS], run.count[work.FORCES] = done
        run.plan, run.t0, run.first = self.where


class Ladder:
    """Steps of h_max / 2^k, taken from the present state."""

    def __init__(self, run: Any, h_max: float, t_start: float) -> None:
        self.run, self.h_max, self.t_start = run, h_max, t_start
        self.plans: dict[int, work.Plan] = {}

    def h(self, level: int) -> float:
        """Step of a level [s]."""
        return math.ldexp(self.h_max, -level)

    def take(self, level: int, steps: int, t: float) -> int:
        """Steps of one size from time t; the code of the loop."""
        run = self.run
        if level not in self.plans:
            run.prepare(self.h(level))
            self.plans[level] = run.plan
        run.use(self.plans[level])
        run.t0, run.first = t, int(run.count[work.STEP])
        run.x[work.UNCHANGED] = 0.0
        return int(run.steps(run.recorder.buffers, t, run.first, run.first + steps))


def advance(run: Any, tolerance: float, progress: Callable[[float], None]) -> Status:
    """The whole span of a run in steps that meet the tolerance."""
    t_start, t_end = run.scene.t_span
    span = t_end - t_start
    coarse = max(1, math.ceil(span / run.method.h - WHOLE))
    ladder = Ladder(run, span / coarse, t_start)
    finest = LEVELS
    while finest > 0 and ladder.h(finest + 1) < 8.0 * RESOLUTION * max(abs(t_start), abs(t_end)):
        finest -= 1
    position, end, level, tried = 0, coarse << LEVELS, 0, 0
    size = sizes(run)
    while position < end:
        t = t_start + math.ldexp(ladder.h_max * position, -LEVELS)
        code, error, size_now = attempt(run, ladder, level, t, span, size)
        if code != work.FINISHED or not error <= tolerance:
            if level < finest:
                level += 1
                continue
            return FAILED.get(code, Status.STEP_TOO_SMALL)
        position += 1 << (LEVELS - level)
        size = np.maximum(size, size_now)
        tried += 1
        if filled(run) or tried % LOOK == 0 or position == end:
            run.empty()
            progress(run.now)
        if error <= SAFE * tolerance and level > 0 and position % (1 << (LEVELS - level + 1)) == 0:
            level -= 1
    return Status.DONE


def attempt(
    run: Any, ladder: Ladder, level: int, t: float, span: float, size: NDArray[np.float64]
) -> tuple[int, float, NDArray[np.float64]]:
    """One step of a level in two halves, its error relative to its share; the state from before where one fails."""
    before = State(run)
    try:
        code = ladder.take(level, 1, t)
        one, events = run.work.vec[[work.Q, work.V]].copy(), happened(run, before)
        before.restore(run)
        if code == work.FINISHED:
            code = ladder.take(level + 1, 2, t)
        two, events_two = run.work.vec[[work.Q, work.V]], happened(run, before)
        size_now = sizes(run)
        difference = np.max(np.abs(one - two), axis=1) / (1.0 + np.maximum(size, size_now))
        error = float(difference[0] if events != events_two else np.max(difference))
        h = ladder.h(level)
        error /= max(h / span, LEAST_SHARE if events or events_two else 0.0)
    except BaseException:
        before.restore(run)
        raise
    if code != work.FINISHED or not error <= run.method.tolerance:
        before.restore(run)
    return code, error, size_now


def sizes(run: Any) -> NDArray[np.float64]:
    """Largest coordinate and largest velocity."""
    largest: NDArray[np.float64] = np.max(np.abs(run.work.vec[[work.Q, work.V]]), axis=1)
    return largest


def happened(run: Any, before: State) -> list[tuple[float, float]]:
    """Contact and kind of each event since then."""
    first, last = int(before.saved[-1][work.EVENT]), int(run.count[work.EVENT])
    return [(e[1], e[5]) for e in run.recorder.buffers.events[first:last].tolist()]


def filled(run: Any) -> bool:
    """Whether the buffers are half full."""
    b = run.recorder.buffers
    return bool(2 * run.count[work.ROW] > len(b.rows) or 2 * run.count[work.EVENT] > len(b.events))


FAILED = {
    work.NOT_FINITE: Status.NOT_FINITE,
    work.LCP_FAILED: Status.LCP_FAILED,
    work.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
}
