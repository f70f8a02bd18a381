"""Many event-driven runs over many periods of the forcing, in one call of a kernel.

For systems whose smooth motion is known in closed form a period takes microseconds, and all that Python does per
run would cost more than the run. Each period starts afresh at the time of the section, so that equal states have
equal images to the last bit, and following n periods is iterating the stroboscopic map n times.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import compiled
from lcpstep.dense import assign
from lcpstep.events import EventDriven, flight
from lcpstep.events import run as loop
from lcpstep.events.closed_form import flight_of, numbers, oscillator_of
from lcpstep.events.flight import find_corners, free, rebase
from lcpstep.events.single import ON_THE_SURFACE, run
from lcpstep.model import model
from lcpstep.recording import Kept, Recorder
from lcpstep.trajectory import Kind, Status

IMPACT, ACCUMULATION, STICK = int(Kind.IMPACT), int(Kind.ACCUMULATION), int(Kind.STICK)
FINISHED, BUFFER_FULL = loop.FINISHED, loop.BUFFER_FULL
EVENT, MAX_EVENTS = loop.EVENT, loop.MAX_EVENTS
CONTACT, NOW, T_END = flight.CONTACT, flight.NOW, flight.T_END
PERIODS_OF_SPAN = 4  # of the span that the scan for events is made for
NO_LIMIT = 2**62
UNREACHED = -1
INSIDE = -1  # among the codes: a start inside of the obstacle
IMPACTS, ENDS = 0, 1  # places in the counts of a period: impacts, chattering sequences or landings


class Task(NamedTuple):
    """What to follow, how far, and where the answers go; m runs, `kept` periods of each."""

    t_start: float
    t_end: float  # one period later
    drop: int  # periods before the kept ones
    periods: int  # in all
    starts: Any  # (m, 2 n_q) states (q, v) at t_start
    targets: Any  # (k, 2 n_q) a run ends where it comes near one of these
    radius: Any  # (k,) how near, in units of `scale`
    scale: Any  # (2 n_q,)
    states: Any  # (m, kept, 2 n_q) after each kept period
    impacts: Any  # (m, kept, most, 3) time and gap velocities before and after; the first ones of each period
    counts: Any  # (m, kept, 2) see IMPACTS, ENDS
    reached: Any  # (m,) the target that was reached, or UNREACHED
    taken: Any  # (m,) periods taken
    final: Any  # (m, 2 n_q) the last state
    codes: Any  # (m,) why the loop over events returned
    strict: bool  # a start inside of the obstacle ends its run


def follow(s: Any, fresh: Any, record: Any, count: Any, task: Any) -> None:
    """Kernel: every run in turn. fresh: the numbers of a flight that has not begun."""
    for i in range(len(task.starts)):
        s.q[0], s.v[0] = task.starts[i, 0], task.starts[i, 1]
        code, k = FINISHED, 0
        if task.strict and not admissible(s, fresh, task.t_start):
            code = INSIDE
        while k < task.periods and code == FINISHED and task.reached[i] == UNREACHED:
            code = one_period(s, fresh, record, count, task, i, k - task.drop)
            k += 1
            if code == FINISHED and k > task.drop:
                task.states[i, k - 1 - task.drop, 0] = s.q[0]
                task.states[i, k - 1 - task.drop, 1] = s.v[0]
            if code == FINISHED and len(task.targets) > 0:
                task.reached[i] = near(task, s)
        task.final[i, 0], task.final[i, 1] = s.q[0], s.v[0]
        task.codes[i], task.taken[i] = code, k


def admissible(s: Any, fresh: Any, t: float) -> bool:
    """Kernel: whether the state s.q, s.v lies outside of the obstacle, up to rounding."""
    if fresh[CONTACT] == 0.0:
        return True
    q, v = s.q[0], s.v[0]
    assign(s.x, fresh)
    find_corners(s, t)
    rebase(s, t)
    g, _, _ = free(s, 0.0)
    s.q[0], s.v[0] = q, v
    return bool(g >= -ON_THE_SURFACE * max(1.0, abs(q)))


def one_period(s: Any, fresh: Any, record: Any, count: Any, task: Any, i: int, k: int) -> int:
    """Kernel: the state s.q, s.v one period later; its events noted if k >= 0."""
    assign(s.x, fresh)
    most = count[MAX_EVENTS]
    for j in range(len(count)):
        count[j] = 0
    count[MAX_EVENTS] = most
    code = BUFFER_FULL
    while code == BUFFER_FULL:
        code = run(s, record, count, NO_LIMIT)
        if k >= 0:
            note_events(record, count, task, i, k)
        count[EVENT] = 0
    return code


def note_events(record: Any, count: Any, task: Any, i: int, k: int) -> None:
    """Kernel: impacts of the k-th kept period of run i, the first ones in full and all by their number."""
    for e in range(count[EVENT]):
        kind = int(record.events[e, 5])
        if kind == IMPACT:
            place = task.counts[i, k, IMPACTS]
            if place < task.impacts.shape[2]:
                task.impacts[i, k, place, 0] = record.events[e, 0]
                task.impacts[i, k, place, 1] = record.events[e, 2]
                task.impacts[i, k, place, 2] = record.events[e, 3]
            task.counts[i, k, IMPACTS] += 1
        elif kind == STICK:
            task.counts[i, k, ENDS] += 1


def near(task: Any, s: Any) -> int:
    """Kernel: the first target within its radius of the state, or UNREACHED."""
    for k in range(len(task.targets)):
        distance = abs(s.q[0] - task.targets[k, 0]) / task.scale[0]
        distance = max(distance, abs(s.v[0] - task.targets[k, 1]) / task.scale[1])
        if distance <= task.radius[k]:
            return k
    return UNREACHED


CODES = {
    loop.FINISHED: Status.DONE,
    loop.NOT_FINITE: Status.NOT_FINITE,
    loop.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    loop.STEP_TOO_SMALL: Status.STEP_TOO_SMALL,
}


class Follower:
    """A scene made ready for `follow`: its model, and work space. One thread at a time may use it."""

    def __init__(self, scene: Scene, method: EventDriven, t_start: float) -> None:
        self.scene, self.method = scene, method
        self.model, self.fast = model(scene)
        oscillator = oscillator_of(scene, self.model)
        self.usable = oscillator is not None  # in closed form; other systems take the general way
        if oscillator is not None:
            long = (scene.t_span[0], scene.t_span[0] + PERIODS_OF_SPAN * scene.period)
            self.fresh = numbers(replace(scene, t_span=long), self.model, oscillator, method)
            self.fresh[NOW], self.fresh[T_END] = t_start, t_start + scene.period

    def run(self, task: Task, strict: bool) -> None:
        """Fill in the answers of the task; unless strict, a start inside of the obstacle is taken as one on it."""
        scene = self.scene
        record = Recorder(scene.n_q, scene.n_c, Kept(0, True, np.zeros(0)), 2 * loop.SLACK).buffers
        record = record._replace(on_events=False)
        count = np.zeros(loop.N_COUNTERS, dtype=np.int64)
        count[MAX_EVENTS] = self.method.max_events
        kernel = compiled(follow) if self.fast else follow
        s = flight_of(scene, self.model, self.fresh.copy())
        kernel(s, self.fresh, record, count, task._replace(strict=strict))
