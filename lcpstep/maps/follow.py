"""Many event-driven runs over many periods of the forcing, in one call of a kernel.

For systems whose smooth motion is known in closed form a period takes microseconds, and all that Python does per
run would cost more than the run. Each period starts afresh at the time of the section, so that equal states have
equal images to the last bit, and following n periods is iterating the stroboscopic map n times.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from lagrangian import Scene
from lcpstep.compiled import compiled
from lcpstep.dynamics import gaps
from lcpstep.events import EventDriven, dop853
from lcpstep.events import integrator as loop
from lcpstep.events.driven import NEVER_CLOSED_FORM, flow, piece
from lcpstep.events.flow import FREE, MODE, SCALE
from lcpstep.events.integrator import ON_THE_SURFACE, run
from lcpstep.model import model
from lcpstep.recording import Kept, Recorder
from lcpstep.trajectory import Kind, Status

IMPACT, ACCUMULATION, STICK = int(Kind.IMPACT), int(Kind.ACCUMULATION), int(Kind.STICK)
FINISHED, BUFFER_FULL = loop.FINISHED, loop.BUFFER_FULL
STEP, ROW, EVENT = loop.STEP, loop.ROW, loop.EVENT
NOW, LAST_EVENT, HOLD = loop.NOW, loop.LAST_EVENT, loop.HOLD
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


def follow(
    model: Any, flow: Any, piece: Any, tab: Any, w: Any, record: Any, count: Any, x: Any, task: Any
) -> None:
    """Kernel: every run in turn."""
    n = len(piece.q)
    for i in range(len(task.starts)):
        for j in range(n):
            piece.q[j], piece.v[j] = task.starts[i, j], task.starts[i, n + j]
        code, k = FINISHED, 0
        if task.strict and not admissible(model, flow, piece, task.t_start):
            code = INSIDE
        while k < task.periods and code == FINISHED and task.reached[i] == UNREACHED:
            code = one_period(model, flow, piece, tab, w, record, count, x, task, i, k - task.drop)
            k += 1
            if code == FINISHED and k > task.drop:
                for j in range(n):
                    task.states[i, k - 1 - task.drop, j] = piece.q[j]
                    task.states[i, k - 1 - task.drop, n + j] = piece.v[j]
            if code == FINISHED and len(task.targets) > 0:
                task.reached[i] = near(task, piece, n)
        for j in range(n):
            task.final[i, j], task.final[i, n + j] = piece.q[j], piece.v[j]
        task.codes[i], task.taken[i] = code, k


def admissible(model: Any, flow: Any, piece: Any, t: float) -> bool:
    """Kernel: whether the state piece.q, piece.v lies outside of the obstacle, up to rounding."""
    if not flow.contact:
        return True
    gaps(model, t, piece.q, piece.v, piece.g)
    size = 1.0
    for j in range(len(piece.q)):
        size = max(size, abs(piece.q[j]))
    return piece.g[0] >= -ON_THE_SURFACE * size


def one_period(
    model: Any,
    flow: Any,
    piece: Any,
    tab: Any,
    w: Any,
    record: Any,
    count: Any,
    x: Any,
    task: Any,
    i: int,
    k: int,
) -> int:
    """Kernel: the state piece.q, piece.v one period later; its events noted if k >= 0."""
    scale = piece.x[SCALE]
    for j in range(len(piece.x)):
        piece.x[j] = 0.0
    piece.x[MODE], piece.x[SCALE] = FREE, scale
    for j in range(len(count)):
        count[j] = 0
    for j in range(len(x)):
        x[j] = 0.0
    x[NOW], x[LAST_EVENT], x[HOLD] = task.t_start, -math.inf, -math.inf
    for j in range(len(piece.q)):
        piece.q0[j], piece.v0[j] = piece.q[j], piece.v[j]
    code = BUFFER_FULL
    while code == BUFFER_FULL:
        code = run(model, flow, piece, tab, w, record, count, x, NO_LIMIT)
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


def near(task: Any, piece: Any, n: int) -> int:
    """Kernel: the first target within its radius of the state, or UNREACHED."""
    for k in range(len(task.targets)):
        distance = 0.0
        for j in range(n):
            distance = max(distance, abs(piece.q[j] - task.targets[k, j]) / task.scale[j])
            distance = max(distance, abs(piece.v[j] - task.targets[k, n + j]) / task.scale[n + j])
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
        self.scene = scene
        self.model, self.fast = model(scene)
        long = (scene.t_span[0], scene.t_span[0] + PERIODS_OF_SPAN * scene.period)
        prepared = flow(replace(scene, t_span=long), self.model, method)
        self.flow = prepared._replace(t_end=t_start + scene.period)

    @property
    def usable(self) -> bool:
        """Whether the motion is known in closed form; other systems take the general way."""
        return bool(self.flow.closed_form)

    def run(self, task: Task, strict: bool) -> None:
        """Fill in the answers of the task; unless strict, a start inside of the obstacle is taken as one on it."""
        scene = self.scene
        record = Recorder(scene.n_q, scene.n_c, Kept(0, True, np.zeros(0)), 2 * loop.SLACK).buffers
        record = record._replace(on_events=False)
        count, x = np.zeros(loop.N_COUNTERS, dtype=np.int64), np.zeros(loop.N_NUMBERS)
        kernel = compiled(follow, NEVER_CLOSED_FORM) if self.fast else follow
        work = dop853.work(2 * scene.n_q)
        kernel(
            self.model, self.flow, piece(scene, self.model), dop853.tableau(), work, record, count, x,
            task._replace(strict=strict),
        )  # fmt: skip
