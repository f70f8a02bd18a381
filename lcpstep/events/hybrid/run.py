"""Runs of systems with modes (`lagrangian.HybridScene`) by the event-driven method."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian.hybrid import HybridScene
from lcpstep import compiled
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.events import dop853
from lcpstep.events.hybrid import loop
from lcpstep.events.hybrid import state as at
from lcpstep.events.hybrid.field import approaches, scalar
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.roots import CHECKS, DEGREE, scan
from lcpstep.events.hybrid.trajectory import HybridTrajectory, Pieces
from lcpstep.model import hybrid_culprit
from lcpstep.pace import Pace
from lcpstep.recording import Kept
from lcpstep.trajectory import Counts, Status

Array = NDArray[np.float64]
ROWS, SWITCHES = 4096, 4096
PORTION = 2048  # steps between two looks at the outside world, at most
PER_PERIOD, PER_SPAN = 16, 50
STATUS = {
    at.FINISHED: Status.DONE,
    at.NOT_FINITE: Status.NOT_FINITE,
    at.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    at.STEP_TOO_SMALL: Status.STEP_TOO_SMALL,
    at.ENDLESS: Status.ENDLESS_SWITCHING,
    at.NOT_TRANSVERSAL: Status.NOT_TRANSVERSAL,
}


def memory(n: int, guards: int, rows: int, switches: int) -> at.Memory:
    """Buffers of a run; rows = 0 where nothing but switches is kept."""
    return at.Memory(
        armed=np.zeros(guards, dtype=np.int64), band=np.zeros(guards), states=np.zeros((DEGREE + 1 + CHECKS, n)),
        rows=np.zeros((rows, at.LEAD + n)), dense=np.zeros((rows, 7, n)),
        log=np.zeros((switches, at.SWITCH_LEAD + 2 * n)),
    )  # fmt: skip


def prepared(scene: HybridScene, method: Any, rows: int, switches: int) -> tuple[at.Loop, bool]:
    """What the loop is handed, at the start of the span, and whether the system's functions are compiled.

    The buffers have this many rows and lines of the switch log; rows = 0 where nothing but switches is kept.
    """
    m, fast = machine(scene)
    n, span = scene.system.n_x, scene.t_span[1] - scene.t_span[0]
    longest = min(scene.period / PER_PERIOD, span / PER_SPAN)
    s = at.Loop(
        m=m, flow=at.Flow(scene.t_span[1], method.rtol, method.atol, longest, method.max_events),
        memory=memory(n, len(m.kind), rows, switches), scan=scan(), w=dop853.work(n),
        count=np.zeros(at.N_COUNTERS, dtype=np.int64), x=np.zeros(at.N_NUMBERS),
    )  # fmt: skip
    s.count[at.MODE] = scene.system.names.index(scene.mode)
    s.x[at.NOW], s.x[at.LAST_SWITCH] = scene.t_span[0], -math.inf
    s.w.y[:] = scene.x0
    return s, fast


class HybridRun:
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: Any, scene: HybridScene) -> None:
        _check_start(scene)
        self.method, self.scene = method, scene
        self.loop, fast = prepared(scene, method, ROWS, SWITCHES)
        self.kernel = compiled.compiled(loop.run) if fast else loop.run
        self.count, self.memory = self.loop.count, self.loop.memory
        self.loop.x[at.NEXT] = 0.1 * self.loop.flow.longest
        self.pace = Pace(PORTION, scene.system.n_x)
        self.parts: dict[str, list[Array]] = {"rows": [], "dense": [], "log": []}

    def finish(self, kept: Kept, progress: Callable[[float], None]) -> HybridTrajectory:
        """Run to the end of the span, or to where it cannot go on."""
        code, t_end = at.FINISHED, self.scene.t_span[1]
        try:
            while True:
                goal = self.pace.goal(int(self.count[at.STEP]))
                try:
                    code = int(self.kernel(self.loop, goal))
                except Exception as error:  # a function in plain Python; compiled code raises nothing
                    result = self.trajectory(Status.NOT_FINITE, kept)
                    raise SimulationError(result.message, result) from error
                self._empty()
                progress(self.now)
                if code not in (at.FINISHED, at.BUFFER_FULL) or (code == at.FINISHED and self.now >= t_end):
                    break
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED, kept)) from None
        result = self.trajectory(STATUS[code], kept)
        if result.status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    @property
    def now(self) -> float:
        """Time reached."""
        return float(self.loop.x[at.NOW])

    def _empty(self) -> None:
        rows, switches = int(self.count[at.ROW]), int(self.count[at.SWITCH])
        self.parts["rows"].append(self.memory.rows[:rows].copy())
        self.parts["dense"].append(self.memory.dense[:rows].copy())
        self.parts["log"].append(self.memory.log[:switches].copy())
        self.count[at.ROW] = self.count[at.SWITCH] = 0

    def trajectory(self, status: Status, kept: Kept) -> HybridTrajectory:
        """Everything computed so far."""
        n, mode = self.scene.system.n_x, int(self.count[at.MODE])
        last = np.concatenate([[self.now, 0.0, mode], self.loop.w.y])[None]
        rows = np.concatenate([*self.parts["rows"], last])
        pieces = Pieces(
            t=np.ascontiguousarray(rows[:, at.TIME]), h=rows[:, at.LENGTH],
            mode=rows[:, at.ROW_MODE].astype(np.int64), x=np.ascontiguousarray(rows[:, at.LEAD :]),
            dense=np.concatenate([*self.parts["dense"], np.zeros((1, 7, n))]),
        )  # fmt: skip
        log = np.concatenate([np.zeros((0, at.SWITCH_LEAD + 2 * n)), *self.parts["log"]])
        whole = HybridTrajectory(
            scene=self.scene, method=self.method, t=pieces.t, x=pieces.x,
            mode=np.array(self.scene.system.names)[pieces.mode], switches=self._switches(log), status=status,
            message=self._message(status, log),
            counts=Counts(
                steps=int(self.count[at.STEP]), force_evaluations=int(self.count[at.FORCES]),
                events=int(self.count[at.EVENTS]),
            ),
            pieces=pieces,
        )  # fmt: skip
        return chosen(whole, kept)

    def _switches(self, log: Array) -> Any:
        n, names = self.scene.system.n_x, np.array(self.scene.system.names)
        kind = f"U{max(map(len, names))}"
        dtype = [
            ("time", "f8"),
            ("source", kind),
            ("target", kind),
            ("guard", "i8"),
            ("before", "f8", (n,)),
            ("after", "f8", (n,)),
        ]
        result = np.zeros(len(log), dtype=dtype)
        result["time"] = log[:, 0]
        result["source"], result["target"] = names[log[:, 1].astype(int)], names[log[:, 2].astype(int)]
        result["guard"] = log[:, 3]
        result["before"] = log[:, at.SWITCH_LEAD : at.SWITCH_LEAD + n]
        result["after"] = log[:, at.SWITCH_LEAD + n :]
        return result.view(np.recarray)

    def _message(self, status: Status, log: Array) -> str:
        names, t = self.scene.system.names, f"t = {self.now:.12g}"
        mode = names[int(self.count[at.MODE])]
        if status == Status.ENDLESS_SWITCHING:
            chain = list(dict.fromkeys(names[int(k)] for k in log[-12:, 2]))
            return (
                f"at {t} the modes {' -> '.join([*chain, chain[0]])} follow one another for ever at one instant, or "
                f"ever faster; where two fields point at each other, describe the switching as a lagrangian.Surface"
            )
        if status == Status.NOT_TRANSVERSAL:
            return (
                f"at {t} the motion in mode {mode!r} touches the guard towards {self._target()!r} and turns back "
                f"within the tolerance: the guard is not transversal there, and whether it acts is undecided"
            )
        return {
            Status.DONE: "ran to the end of the span",
            Status.INTERRUPTED: f"interrupted at {t}",
            Status.NOT_FINITE: f"after {t} {hybrid_culprit(self.scene, mode)}",
            Status.TOO_MANY_EVENTS: f"{self.count[at.EVENTS]} switches up to {t}: more than max_events allows",
            Status.STEP_TOO_SMALL: f"at {t} in mode {mode!r} the tolerance cannot be met by any step",
        }[status]

    def _target(self) -> str:
        return self.scene.system.names[int(self.loop.m.target[self.count[at.CULPRIT]])]


def chosen(whole: HybridTrajectory, kept: Kept) -> HybridTrajectory:
    """The trajectory with the states that were asked for."""
    from dataclasses import replace

    t = whole.pieces.t
    if kept.all:
        return whole
    if kept.on_events:
        t = np.unique(np.concatenate([t[:1], whole.switches.time, t[-1:]]))
    elif kept.every:
        t = t[:: kept.every]
    else:
        t = kept.times[kept.times <= t[-1]]
    return replace(whole, t=t, x=whole.at(t), mode=whole.mode_at(t))


def _check_start(scene: HybridScene) -> None:
    """A motion can start sliding only where both fields point at the surface."""
    for surface in scene.system.surfaces:
        if scene.mode != surface.sliding:
            continue
        (m, _), t = machine(scene, plain=True), scene.t_span[0]
        x, k = np.array(scene.x0), scene.system.names.index(scene.mode)
        L1, L2 = approaches(m, k, t, x)
        H = scalar(surface.value, m, t, x)
        if abs(H) > 1e-9 * max(1.0, float(np.max(np.abs(x)))):
            raise LcpStepError(f"x0: mode {scene.mode!r} starts on its surface, but H = {H:.6g} there")
        if not (L1 >= 0.0 >= L2):
            raise LcpStepError(
                f"mode: {scene.mode!r} needs both fields to point at the surface (L1 >= 0 >= L2), but at x0 "
                f"L1 = {L1:.6g} and L2 = {L2:.6g}; start on one of its sides"
            )
