"""Steps chosen by an error estimate: one step of h is compared with two of h/2, which are kept.

A step is accepted where its error, relative to 1 + the size of the motion, takes no more than its share h / span of
the tolerance. So errors of the whole motion are proportional to the tolerance, up to what the motion itself
magnifies. Steps with events, and those that hold a jump of the forces, are few, and their errors fall no faster than
h: they may take a share of their own. A jump shows as an error that halving the step hardly makes smaller.

Steps are h_max / 2^k at multiples of themselves: few sizes, whose matrices are made once, an end of the span that is
met exactly, and a bisection for whatever asks for short steps. A method that stops at an event goes on from there to
the next multiple. The first step is short and steps grow by doubling, so that no oscillation of the forces is stepped
over whole: both runs would sample it at equal phases, and agree. This file decides; the loops of the methods
(`adaptive_moreau`, `adaptive_located`) take the steps and measure their errors. Source: E. Hairer, S. P. Norsett,
G. Wanner, Solving Ordinary Differential Equations I (1993), section II.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import by_address, inline
from lcpstep.faults import cause
from lcpstep.model import failing
from lcpstep.pace import Pace
from lcpstep.recording import TIME
from lcpstep.stepping.steps import RESOLUTION, WHOLE

# Why a loop returned, besides its method's own reasons: to have its buffers emptied, and for good
REACHED, PAUSED, TOO_SMALL, WANTED = 0, -1, -2, -3
ACCEPTED, AGAIN, GIVEN_UP = range(3)  # verdicts
LEVELS = 52  # halvings of the longest step, at most
LEAST_SHARE = 1e-3  # of the tolerance, in steps with events
FLAT = 3.0  # an error that half the step makes smaller by less than this comes from a jump
NOISE = 8 * RESOLUTION  # relative differences that are rounding
PLENTY = 0.8  # of the share, that twice the step is expected to take where it is tried
FIRST = 1e-6  # of the span: the first step
LOOK = 4096  # steps between two looks at the outside world, at most
LOOKS_AHEAD = 17  # at the callbacks where no step is short enough
# Places in Control.whole: start of the step, in finest steps; level of the step; end of the span; finest level;
# attempts so far, and their number at the next look at the outside world
POSITION, LEVEL, END, FINEST, TRIED, UNTIL = range(6)
# Places in Control.real; the last two: error of the attempt before, if that failed at the same place; how far beyond
# POSITION an event has cut the step
START, STOP, SPAN, H_MAX, TOLERANCE, ENOUGH, SIZE_Q, SIZE_V, LAST, INTO = range(10)


@by_address
class Control(NamedTuple):
    """Where the run is, and what it allows."""

    whole: Any  # (6,)
    real: Any  # (10,)


class Steps(Protocol):
    """What a method gives to `advance`."""

    def attempts(self) -> int:
        """Take steps until the loop returns; say why."""

    def undo(self) -> None:
        """Go back to the start of the step that was interrupted."""


def control(span: tuple[float, float], h: float, tolerance: float, order: int) -> Control:
    """For steps of at most h over a span, by a method of the given order."""
    start, end = span
    coarse = max(1, math.ceil((end - start) / h - WHOLE))
    h_max = (end - start) / coarse
    least = 8.0 * RESOLUTION * max(abs(start), abs(end))
    finest = min(LEVELS, 62 - coarse.bit_length())
    if least > 0.0:
        finest = max(0, min(finest, math.floor(math.log2(h_max / least)) - 1))
    first = max(0, min(finest, math.ceil(math.log2(h_max / (FIRST * (end - start))))))
    whole = np.array([0, first, coarse << finest, finest, 0, 0], dtype=np.int64)
    enough = PLENTY * 0.5**order
    real = np.array([start, end, end - start, h_max, tolerance, enough, 0.0, 0.0, np.inf, 0.0])
    return Control(whole, real)


def sizes(span: tuple[float, float], h: float) -> tuple[float, int, int, int]:
    """The longest step, at most h; the end of the span in finest steps; the finest level, and the first."""
    start, end = span
    coarse = max(1, math.ceil((end - start) / h - WHOLE))
    h_max = (end - start) / coarse
    least = 8.0 * RESOLUTION * max(abs(start), abs(end))
    finest = min(LEVELS, 62 - coarse.bit_length())
    if least > 0.0:
        finest = max(0, min(finest, math.floor(math.log2(h_max / least)) - 1))
    first = max(0, min(finest, math.ceil(math.log2(h_max / (FIRST * (end - start))))))
    return h_max, coarse << finest, finest, first


def run(control: Any, numbers: int, arrive: Callable[[], None], progress: Callable[[float], None]) -> int:
    """The whole span; 0, or why it could not be reached. `arrive` is called where the loop has returned to Python.

    control : a `step_control.Control`;  numbers : that a step computes with
    """
    pace = Pace(LOOK, numbers)
    while True:
        try:
            control.until = pace.goal(control.tried)
            code = control.advance()
            cause()
        finally:
            arrive()
        if code == WANTED:
            control.prepare()
            continue
        progress(control.time)
        if code != PAUSED:
            return int(code)


def advance(steps: Steps, c: Control, arrive: Callable[[], None], progress: Callable[[float], None]) -> int:
    """The whole span; 0, or why it could not be reached. `arrive` is called where the loop has returned to Python."""
    pace = Pace(LOOK)
    while True:
        try:
            c.whole[UNTIL] = pace.goal(int(c.whole[TRIED]))
            code = steps.attempts()
        except BaseException:
            steps.undo()
            arrive()
            raise
        arrive()
        progress(now(c))
        if code != PAUSED:
            return code


@inline
def step_size(c: Any, level: int) -> float:
    """Step of a level [s]."""
    return c.real[H_MAX] * 0.5**level


@inline
def base(c: Any) -> float:
    """The multiple of the step from which times are counted until the next one is reached [s]."""
    return place(c, c.whole[POSITION])


@inline
def now(c: Any) -> float:
    """Time at which the step begins [s]."""
    return base(c) + c.real[INTO]


@inline
def goal(c: Any) -> float:
    """Time at which it ends unless an event cuts it [s]."""
    return place(c, c.whole[POSITION] + (1 << (c.whole[FINEST] - c.whole[LEVEL])))


@inline
def place(c: Any, position: int) -> float:
    """Time of a number of finest steps; the end of the span to the bit [s]."""
    if position >= c.whole[END]:
        return c.real[STOP]
    return min(c.real[STOP], c.real[START] + c.real[H_MAX] * (position * 0.5 ** c.whole[FINEST]))


def stamp(record: Any, row: int, rows: int, event: int, events: int, late: float, t: float) -> None:
    """Kernel: what a step has kept and noted at `late` or after belongs to its end t, with which the next begins."""
    for k in range(row, rows):
        if record.rows[k, TIME] >= late:
            record.rows[k, TIME] = t
    for k in range(event, events):
        if record.events[k, 0] >= late:
            record.events[k, 0] = t


@inline
def over(c: Any) -> bool:
    """Whether the end of the span is reached."""
    return c.whole[POSITION] >= c.whole[END]


@inline
def resolved(c: Any, place: int) -> float:
    """Error that a step with events may make, of positions (place SIZE_Q) or velocities (SIZE_V)."""
    return LEAST_SHARE * c.real[TOLERANCE] * (1.0 + c.real[place])


def judge(
    c: Any, failed: bool, apart_q: float, apart_v: float, q: Any, v: Any, event: bool, cut: float
) -> int:
    """Whether a step to q, v whose errors are apart_q, apart_v is accepted; sets the next one's place and level.

    `cut`: the time since its base at which it stopped, infinite where it went to the next multiple.
    """
    level, x = c.whole[LEVEL], c.real
    size_q, size_v = max(x[SIZE_Q], largest(q)), max(x[SIZE_V], largest(v))
    noise = min(NOISE, LEAST_SHARE * x[TOLERANCE])
    error = max(apart_q / (1.0 + size_q), apart_v / (1.0 + size_v)) - noise
    allowed = step_size(c, level) / x[SPAN]
    if event or FLAT * error > x[LAST]:
        allowed = max(allowed, LEAST_SHARE)
    allowed *= x[TOLERANCE]
    if x[TOLERANCE] < NOISE:  # no step is that good
        return GIVEN_UP
    if failed or not error <= allowed:
        x[LAST] = math.inf if failed else error
        if level >= c.whole[FINEST]:
            return GIVEN_UP
        c.whole[LEVEL] = level + 1
        go_on(c, 0.0)
        return AGAIN
    x[SIZE_Q], x[SIZE_V], x[LAST] = size_q, size_v, math.inf
    if go_on(c, cut):
        return ACCEPTED
    fits = level > 0 and c.whole[POSITION] % (1 << (c.whole[FINEST] - level + 1)) == 0
    if fits and error <= x[ENOUGH] * allowed:
        c.whole[LEVEL] = level - 1
    return ACCEPTED


@inline
def go_on(c: Any, time: float) -> bool:
    """Go on to a time since the base, at most to the next multiple of the step; whether it lies still ahead."""
    x, level = c.real, c.whole[LEVEL]
    h = step_size(c, level)
    rounding = NOISE * (abs(now(c)) + h)
    x[INTO] = max(x[INTO], min(time, h))
    if x[INTO] < h - rounding:
        return True
    c.whole[POSITION] += 1 << (c.whole[FINEST] - level)
    x[INTO] = x[INTO] - h if x[INTO] - h > rounding else 0.0
    return False


@inline
def largest(x: Any) -> float:
    """Largest entry, in magnitude."""
    most = 0.0
    for i in range(len(x)):
        most = max(most, abs(x[i]))
    return most


@inline
def distance(x: Any, y: Any) -> float:
    """Largest difference of two vectors."""
    most = 0.0
    for i in range(len(x)):
        most = max(most, abs(x[i] - y[i]))
    return most


def too_small(method: Any, scene: Scene, t: float, q: Any, v: Any, where: str) -> str:
    """A tolerance that no step meets, in words; and the callback that fails ahead in a straight line, if one does."""
    text = f"the tolerance {method.tolerance:g} cannot be met by any step {where}"
    ahead = np.linspace(t, max(t, min(t + method.h, scene.t_span[1])), LOOKS_AHEAD)
    found = failing(scene, ahead, q, v)
    return f"{text}; ahead of it {found.rstrip(';')}" if found else f"{text}; expected a larger one"
