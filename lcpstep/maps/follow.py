"""Many event-driven runs over many periods of the forcing, in one call of a kernel.

For systems whose smooth motion is known in closed form a period takes microseconds, and all that Python does per
run would cost more than the run. Each period starts afresh at the time of the section, so that equal states have
equal images to the last bit, and following n periods is iterating the stroboscopic map n times.

A state that recurs exactly during the periods to be dropped has shown its whole future, and whole cycles of it are
skipped. But where a motion sticks, forgets, and then amplifies rounding errors to its own size before it sticks
again, rounding alone can close a cycle. So the cycle must first survive small kicks, one in every period of it: a
stable orbit forgets them.
"""

from __future__ import annotations

from copy import copy
from typing import Any, NamedTuple

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import by_address, call, compiled
from lcpstep.events import EventDriven
from lcpstep.events.bookkeeping import (
    BUFFER_FULL,
    EVENT,
    FINISHED,
    IMPACT,
    MAX_EVENTS,
    N_COUNTERS,
    SLACK,
    STICK,
)
from lcpstep.events.contact import NOW, ON_THE_SURFACE
from lcpstep.events.flight.loop import run
from lcpstep.events.flight.motion import CONTACT, OFFSET, T_END, G
from lcpstep.events.flight.run import flight_of, numbers, oscillator_of
from lcpstep.events.run import STATUS
from lcpstep.maps.tangent import along_events, along_logs, begin_tangent, carry
from lcpstep.model import ABSENT, model
from lcpstep.pace import Pace
from lcpstep.recording import Kept, Recorder

CODES = STATUS
PERIODS_OF_SPAN = 4  # of the span that the scan for events is made for
NO_LIMIT = 2**62
KICKS, KICK = 3, 1e-10  # rounds of a cycle on which it is tried, and with what share of the motion's size
UNREACHED = -1
INSIDE = -1  # among the codes: a start inside of the obstacle
IMPACTS, ENDS = 0, 1  # places in the counts of a period: impacts, chattering sequences or landings
# Places in Place.whole: the run at hand, whether it has begun, its next period, the search for a cycle; periods taken
RUN, RUN_BEGUN, PERIOD, AGE, POWER, KICKED, NOISY, TAKEN, N_WHOLE = range(9)
PORTION = 65536  # periods between two looks at the outside world, at most


@by_address
class Task(NamedTuple):
    """What to follow, how far, and where the answers go; m runs, `kept` periods of each."""

    t_start: float
    t_end: float  # one period later
    drop: int  # periods before the kept ones
    periods: int  # in all
    starts: Any  # (m, 2) states (q, v) at t_start
    targets: Any  # (k, 2) a run ends where it comes near one of these
    radius: Any  # (k,) how near, in units of `scale`
    scale: Any  # (2,)
    states: Any  # (m, kept, 2) after each kept period
    impacts: Any  # (m, kept, most, 3) time and gap velocities before and after; the first ones of each period
    landings: Any  # (m, kept, most) time of each landing in it; the first ones
    counts: Any  # (m, kept, 2) see IMPACTS, ENDS
    tangents: Any  # (m, kept, 2, 2) derivative of each kept period's end by its start; (m, 0, 2, 2) for none
    last: Any  # (1,) work space of it
    reached: Any  # (m,) the target that was reached, or UNREACHED
    taken: Any  # (m,) periods taken
    final: Any  # (m, 2) the last state
    codes: Any  # (m,) why the loop over events returned
    strict: bool  # a start inside of the obstacle ends its run


@by_address
class Place(NamedTuple):
    """Where the kernel is, when it has returned before the end."""

    whole: Any  # (N_WHOLE,)
    real: Any  # (4,) old q and v; largest |q| and |v|


def follow(s: Any, aside: Any, x0: Any, record: Any, count: Any, task: Any, place: Any, until: int) -> bool:
    """Kernel: every run in turn; whether all are done, or so many periods have been taken.

    aside : a flight to ask
    x0 : constants and first numbers of a flight
    """
    q, v, whole, real = s.q, s.v, place.whole, place.real
    for i in range(whole[RUN], len(task.starts)):
        if whole[RUN_BEGUN] == 0:
            q[0], v[0] = task.starts[i, 0], task.starts[i, 1]
            code, k, age, power, kicks, noisy, length, speed = FINISHED, 0, 0, 1, 0, 0, 0.0, 0.0
            if task.strict and not admissible(s, x0, task.t_start):
                code = INSIDE
            old_q, old_v = q[0], v[0]
        else:
            code, k, age, power = FINISHED, whole[PERIOD], whole[AGE], whole[POWER]
            kicks, noisy = whole[KICKED], whole[NOISY]
            old_q, old_v, length, speed = real[0], real[1], real[2], real[3]
        whole[RUN_BEGUN] = 0
        while k < task.periods and code == FINISHED and task.reached[i] == UNREACHED:
            if whole[TAKEN] >= until:
                whole[RUN], whole[RUN_BEGUN], whole[PERIOD], whole[AGE], whole[POWER] = i, 1, k, age, power
                whole[KICKED], whole[NOISY] = kicks, noisy
                real[0], real[1], real[2], real[3] = old_q, old_v, length, speed
                return False
            code = one_period(s, aside, x0, record, count, task, i, k - task.drop)
            whole[TAKEN] += 1
            k += 1
            age += 1
            length, speed = max(length, abs(q[0])), max(speed, abs(v[0]))
            if k < task.drop and noisy > 0:
                q[0] += KICK * length
                v[0] += KICK * speed
                noisy -= 1
                old_q, old_v, age, power = q[0], v[0], 0, 1
            elif (
                k < task.drop and age > 0 and q[0] == old_q and v[0] == old_v
            ):  # R. Brent's search for a cycle
                if kicks < KICKS:
                    kicks, noisy = kicks + 1, age
                else:
                    k += (task.drop - k) // age * age
                    age = -NO_LIMIT
            elif age == power:
                old_q, old_v, age, power = q[0], v[0], 0, 2 * power
            if code == FINISHED and k > task.drop:
                task.states[i, k - 1 - task.drop, 0] = q[0]
                task.states[i, k - 1 - task.drop, 1] = v[0]
            if code == FINISHED and len(task.targets) > 0:
                task.reached[i] = near(task, q[0], v[0])
        task.final[i, 0], task.final[i, 1] = q[0], v[0]
        task.codes[i], task.taken[i] = code, k
    return True


def admissible(s: Any, x0: Any, t: float) -> bool:
    """Kernel: whether the state s.q, s.v lies outside of the obstacle, up to rounding."""
    if x0[CONTACT] == 0.0:
        return True
    gap = x0[OFFSET] + x0[G] * s.q[0]
    if s.motion != ABSENT:
        call(s.motion, t, s.q, s.v, s.p, s.now)
        gap -= s.now[0, 0]
    return bool(gap >= -ON_THE_SURFACE * max(1.0, abs(s.q[0])))


def one_period(s: Any, aside: Any, x0: Any, record: Any, count: Any, task: Any, i: int, k: int) -> int:
    """Kernel: the state s.q, s.v one period later; its events noted if k >= 0."""
    for j in range(len(x0)):
        s.x[j] = x0[j]
    s.x[NOW], s.x[T_END] = task.t_start, task.t_end
    most = count[MAX_EVENTS]
    for j in range(len(count)):
        count[j] = 0
    count[MAX_EVENTS] = most
    code, tangent = BUFFER_FULL, k >= 0 and task.tangents.shape[1] > 0
    if tangent:
        begin_tangent(task.tangents[i, k], task.last, task.t_start)
    while code == BUFFER_FULL:
        code = run(s, record, count, NO_LIMIT)
        if k >= 0:
            note_events(record, count, task, i, k)
        if tangent:
            along_events(aside, record, count[EVENT], task.tangents[i, k], task.last)
        count[EVENT] = 0
    if tangent:
        carry(aside, task.tangents[i, k], task.last, task.t_end)
    return code


def note_events(record: Any, count: Any, task: Any, i: int, k: int) -> None:
    """Kernel: impacts and landings of the k-th kept period of run i, the first ones in full, all by their number."""
    for e in range(count[EVENT]):
        kind = int(record.events[e, 5])
        if kind == IMPACT:
            place = task.counts[i, k, IMPACTS]
            if place < task.impacts.shape[2]:
                task.impacts[i, k, place, 0] = record.events[e, 0]
                task.impacts[i, k, place, 1] = record.events[e, 2]
                task.impacts[i, k, place, 2] = record.events[e, 3]
            task.counts[i, k, IMPACTS] += 1
        elif kind == STICK and record.events[e, 0] > task.t_start:
            place = task.counts[i, k, ENDS]
            if place < task.landings.shape[2]:
                task.landings[i, k, place] = record.events[e, 0]
            task.counts[i, k, ENDS] += 1


def near(task: Any, q: float, v: float) -> int:
    """Kernel: the first target within its radius of the state, or UNREACHED."""
    for k in range(len(task.targets)):
        along = abs(q - task.targets[k, 0]) / task.scale[0]
        across = abs(v - task.targets[k, 1]) / task.scale[1]
        if max(along, across) <= task.radius[k]:
            return k
    return UNREACHED


class Follower:
    """A scene made ready for `follow`: its model, and work space. One thread at a time may use it."""

    def __init__(self, scene: Scene, method: EventDriven) -> None:
        self.scene, self.method = scene, method
        self.model, self.fast = model(scene)
        self.oscillator = oscillator_of(scene, self.model)

    @property
    def usable(self) -> bool:
        """Whether the motion is known in closed form; other systems take the general way."""
        return self.oscillator is not None

    def run(self, task: Task, strict: bool) -> None:
        """Fill in the answers of the task; unless strict, a start inside of the obstacle is taken as one on it."""
        scene, x0 = self.scene, self.constants()
        record = Recorder(1, scene.n_c, Kept(0, False, np.zeros(0)), 2 * SLACK).buffers
        count = np.zeros(N_COUNTERS, dtype=np.int64)
        count[MAX_EVENTS] = self.method.max_events
        kernel = compiled(follow) if self.fast else follow
        under_way, aside = (flight_of(scene, self.model, x0.copy()) for _ in range(2))
        task, place = task._replace(strict=strict), Place(np.zeros(N_WHOLE, dtype=np.int64), np.zeros(4))
        pace, over = Pace(PORTION), False
        while not over:
            until = pace.goal(int(place.whole[TAKEN]))
            over = kernel(under_way, aside, x0, record, count, task, place, until)

    def constants(self) -> Any:
        """Constants and first numbers of a flight."""
        scene = self.scene
        spanned = copy(scene)  # a checked scene needs no further check
        object.__setattr__(
            spanned, "t_span", (scene.t_span[0], scene.t_span[0] + PERIODS_OF_SPAN * scene.period)
        )
        return numbers(spanned, self.model, self.oscillator, self.method)  # type: ignore[arg-type]

    def tangents_of(self, log: Any, counts: Any, t_start: float) -> Any:
        """Derivatives of periods from their impacts, as recorded by any method; see `tangent.along_logs`."""
        out = np.zeros((*counts.shape[:2], 2, 2))
        kernel = compiled(along_logs) if self.fast else along_logs
        flight = flight_of(self.scene, self.model, self.constants())
        kernel(flight, log, counts, t_start, t_start + self.scene.period, out, np.zeros(1))
        return out
