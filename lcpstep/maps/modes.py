"""Runs of a system with modes over many periods of its forcing, with derivatives: what `batch.periods` asks of it.

A state on the section tells its mode (see `lagrangian.hybrid`): so the map of states is one, x -> P(x). Its events
are switches: their times, and the rate of the guard just before and after each, as the gap velocity is that of a gap.
Where sliding begins, `landed` says when. A switch at the very start of a period only puts the mode right.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian.hybrid import HybridScene
from lcpstep import compiled
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.events.hybrid import loop, tangent
from lcpstep.events.hybrid import state as at
from lcpstep.events.hybrid.field import (
    ARRIVE,
    NOT_SLIDING,
    approaches,
    field,
    guard_gradient,
    scalar,
)
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.run import STATUS, prepared
from lcpstep.maps.follow import UNREACHED, Task
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
SPAN = 4  # periods that the longest step is made for
LOG = 256  # switches between two looks at the log
GOAL = 2**62
ON_SURFACE = 1e-9  # |H|, relative to the state, that is zero: the same as for a scene that starts sliding
IMPACTS, ENDS = 0, 1  # places in the counts of a period


def check(scene: HybridScene, method: Any) -> None:
    """Refuse what has no map of states."""
    if not isinstance(method, EventDriven):
        raise LcpStepError(f"method: a system with modes is run by lcpstep.EventDriven, got {method!r}")
    if not scene.system.tells_modes:
        raise LcpStepError(
            f"scene: a state of {scene.name!r} does not tell its mode, so there is no map of states; give "
            f"HybridSystem(mode_of=...), and keep what the system remembers as a state that resets set"
        )


class Placing:
    """Tells the mode of a state."""

    def __init__(self, scene: HybridScene) -> None:
        self.scene, self.system = scene, scene.system
        self.p = np.array(scene.p)
        self.machine = machine(scene, plain=True)[0]

    def __call__(self, t: float, x: Array) -> str:
        """The mode of a motion through x at the time t."""
        if self.system.mode_of is not None:
            return self.system.named_mode(t, x, self.p)
        surface = self.system.surfaces[0]
        H = scalar(surface.value, self.machine, t, x)
        if abs(H) > ON_SURFACE * max(1.0, float(np.max(np.abs(x)))):
            return surface.below if H < 0.0 else surface.above
        L1, L2 = approaches(self.machine, len(self.system.modes), t, x)
        if L1 >= 0.0 >= L2:
            return surface.sliding
        return surface.below if L1 < 0.0 and L1 + L2 < 0.0 else surface.above


class Walk:
    """One system over one span of time: its runs, switches and derivatives."""

    def __init__(self, scene: HybridScene, method: EventDriven, span: tuple[float, float]) -> None:
        check(scene, method)
        self.scene, self.span, self.names = scene, span, scene.system.names
        self.placed = Placing(scene)
        n = scene.n_x
        start, end = span
        longer = replace(scene, t_span=(start, start + SPAN * (end - start)), exact=None)
        s, fast = prepared(longer, method, 0, LOG)
        self.loop = s._replace(flow=s.flow._replace(t_end=end))
        self.run = compiled.compiled(loop.run) if fast else loop.run
        self.tangent = tangent.tangent(s.m, n)
        self.walk = compiled.compiled(tangent.walk) if fast else tangent.walk
        self.plain = self.placed.machine

    def __call__(self, x: Array, mode: str) -> tuple[Status, Array, str, Array]:
        """How the run from x in a mode ended, the state and mode there, and the log of its switches."""
        s = self.loop
        s.count[:], s.x[:] = 0, 0.0
        s.count[at.MODE] = self.names.index(mode)
        s.x[at.NOW], s.x[at.LAST_SWITCH] = self.span[0], -np.inf
        s.x[at.NEXT] = 0.1 * s.flow.longest
        s.w.y[:] = x
        s.w.control[:] = 0.0, -np.inf
        logs = []
        while True:
            code = int(self.run(s, GOAL))
            logs.append(s.memory.log[: s.count[at.SWITCH]].copy())
            s.count[at.SWITCH] = 0
            if code != at.BUFFER_FULL:
                break
        return STATUS[code], s.w.y.copy(), self.names[int(s.count[at.MODE])], np.concatenate(logs)

    def derivative(self, x: Array, mode: str, log: Array, t_end: float | None = None) -> Array:
        """Of the end by the start of a run, (n_x, n_x)."""
        end = self.span[1] if t_end is None else t_end
        s = self.tangent
        code = self.walk(s, log, len(log), self.names.index(mode), self.span[0], np.ascontiguousarray(x), end)
        return told(code, self.scene, s.J)

    def events(self, log: Array) -> tuple[Array, Array]:
        """Time and rates of the guard before and after each switch (m, 3), and times at which sliding begins."""
        m, n, lead = self.plain, self.scene.n_x, at.SWITCH_LEAD
        log = log[log[:, 0] > self.span[0]]
        rows, out = np.zeros((len(log), 3)), np.zeros(n)
        for row, line in zip(rows, log, strict=True):
            t, source, target, guard = line[0], int(line[1]), int(line[2]), int(line[3])
            before, after = line[lead : lead + n], line[lead + n :]
            g_t = guard_gradient(m, source, guard, t, before)
            g_x = m.work.g_x.copy()
            row[0] = t
            for place, mode, state in ((1, source, before), (2, target, after)):
                field(m, mode, t, state, out)
                row[place] = g_t + g_x @ out
        slides = np.array([m.below[int(k)] != NOT_SLIDING for k in log[:, 2]], dtype=bool)
        arrives = np.array([m.kind[int(k)] == ARRIVE for k in log[:, 3]], dtype=bool)
        return rows, log[slides & arrives, 0]


def told(code: int, scene: HybridScene, J: Array) -> Array:
    """The derivative, or the error that says why there is none."""
    if code == tangent.NOT_TRANSVERSAL:
        raise LcpStepError(f"a guard of {scene.name!r} is not transversal: the motion has no derivative")
    if code != tangent.WALKED:
        raise LcpStepError(f"the variational flow of {scene.name!r} could not be integrated")
    return J.copy()


def run_all(scene: HybridScene, method: Any, task: Task, tangents: bool) -> Task:
    """The task of `batch.periods`, one run and one period at a time."""
    walk = Walk(scene, method, (task.t_start, task.t_end))
    kept, n = task.periods - task.drop, scene.n_x
    if tangents:
        task = task._replace(tangents=np.full((len(task.starts), kept, n, n), np.nan))
    for i in range(len(task.starts)):
        x, status, k = task.starts[i].copy(), Status.DONE, 0
        while k < task.periods and status == Status.DONE and task.reached[i] == UNREACHED:
            mode = walk.placed(task.t_start, x)
            status, image, _, log = walk(x, mode)
            if status == Status.DONE and k >= task.drop:
                note(walk, task, i, k - task.drop, x, image, mode, log)
            x, k = image, k + 1
            if status == Status.DONE and len(task.targets):
                near = np.max(np.abs(task.targets - x) / task.scale, axis=1) <= task.radius
                task.reached[i] = np.flatnonzero(near)[0] if np.any(near) else UNREACHED
        task.final[i], task.codes[i], task.taken[i] = x, int(status), k
    return task


def note(walk: Walk, task: Task, i: int, k: int, x: Array, image: Array, mode: str, log: Array) -> None:
    """What happened in the k-th kept period of run i."""
    task.states[i, k] = image
    if task.tangents.shape[1]:
        task.tangents[i, k] = walk.derivative(x, mode, log)
    task.counts[i, k, IMPACTS] = int(np.sum(log[:, 0] > task.t_start))
    if task.impacts.shape[2]:
        rows, landings = walk.events(log)
        shown = rows[: task.impacts.shape[2]]
        task.impacts[i, k, : len(shown)] = shown
        task.landings[i, k, : min(len(landings), task.landings.shape[2])] = landings[: task.landings.shape[2]]
        task.counts[i, k, ENDS] = len(landings)
