"""Runs of systems with modes (`lagrangian.HybridScene`) by the event-driven method."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian.hybrid import HybridScene
from lcpstep.callbacks.culprits import hybrid_culprit
from lcpstep.errors import LcpStepError
from lcpstep.events.hybrid.field import Machine
from lcpstep.events.hybrid.kinds import LEAD, LENGTH, ROW_MODE, SWITCH_LEAD, TIME
from lcpstep.events.hybrid.loop import Switching
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.state import Motion
from lcpstep.events.hybrid.trajectory import HybridTrajectory, Pieces
from lcpstep.pace import Pace
from lcpstep.recording import Kept
from lcpstep.refusals import refused
from lcpstep.running import Portions
from lcpstep.trajectory import Counts, Status

Array = NDArray[np.float64]
ROWS, SWITCHES = 4096, 4096
PORTION = 2048  # steps between two looks at the outside world, at most
PER_PERIOD, PER_SPAN = 16, 50


def prepared(scene: HybridScene, method: Any, rows: int, switches: int) -> Motion:
    """The motion of a scene at the start of its span.

    The buffers have this many rows and lines of the switch log; rows = 0 where nothing but switches is kept.
    """
    if scene.contacts is not None:
        raise refused("modes-maps", scene)
    span = scene.t_span[1] - scene.t_span[0]
    longest = min(scene.period / PER_PERIOD, span / PER_SPAN)
    motion = Motion(
        machine(scene), scene.t_span[1], method.rtol, method.atol, longest, method.max_events, rows, switches
    )
    motion.start(scene.t_span[0], scene.x0, scene.system.names.index(scene.mode))
    return motion


class HybridRun(Portions):
    """One run: the kernel's arrays, and what has been taken out of them."""

    def __init__(self, method: Any, scene: HybridScene, kept: Kept) -> None:
        super().__init__(method, scene, kept, Pace(PORTION, scene.system.n_x))
        self.motion = prepared(scene, method, ROWS, SWITCHES)
        self.course = Switching(self.motion)
        _check_start(scene, self.motion.m)
        self.parts: list[tuple[Array, Array, Array]] = []

    @property
    def done(self) -> int:
        """Steps taken."""
        return int(self.motion.steps)

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.motion.now)

    def empty(self) -> None:
        """Take over what the kernel has written."""
        self.parts.append(self.motion.take())

    def trajectory(self, code: int) -> HybridTrajectory:
        """Everything computed so far."""
        n, motion, status = self.scene.system.n_x, self.motion, Status(code)
        last = np.concatenate([[self.now, 0.0, motion.mode], motion.state])[None]
        self.empty()
        of_rows, dense, logs = zip(*self.parts, strict=True)
        rows = np.concatenate([*of_rows, last])
        pieces = Pieces(
            t=np.ascontiguousarray(rows[:, TIME]), h=rows[:, LENGTH],
            mode=rows[:, ROW_MODE].astype(np.int64), x=np.ascontiguousarray(rows[:, LEAD :]),
            dense=np.concatenate([*dense, np.zeros((1, 7, n))]),
        )  # fmt: skip
        log = np.concatenate(logs)
        whole = HybridTrajectory(
            scene=self.scene, method=self.method, t=pieces.t, x=pieces.x,
            mode=np.array(self.scene.system.names)[pieces.mode], switches=switch_log(self.scene, log), status=status,
            message=self._message(status, log),
            counts=Counts(
                steps=motion.steps, force_evaluations=motion.evaluations, events=motion.events,
            ),
            pieces=pieces,
        )  # fmt: skip
        return chosen(whole, self.kept)

    def _message(self, status: Status, log: Array) -> str:
        t, mode = f"t = {self.now:.12g}", self.scene.system.names[self.motion.mode]
        if status in (Status.ENDLESS_SWITCHING, Status.NOT_TRANSVERSAL):
            return undecided(self.scene, self.motion, status, log)
        return {
            Status.DONE: "ran to the end of the span",
            Status.INTERRUPTED: f"interrupted at {t}",
            Status.NOT_FINITE: f"after {t} {hybrid_culprit(self.scene, mode)}",
            Status.TOO_MANY_EVENTS: f"{self.motion.events} switches up to {t}: more than max_events allows",
            Status.STEP_TOO_SMALL: f"at {t} in mode {mode!r} the tolerance cannot be met by any step",
        }[status]


def undecided(scene: HybridScene, motion: Motion, status: Status, log: Array) -> str:
    """Why no mode follows, in words."""
    names, t = scene.system.names, f"t = {motion.now:.12g}"
    if status == Status.ENDLESS_SWITCHING:
        chain = list(dict.fromkeys(names[int(k)] for k in log[-12:, 2]))
        if len(chain) == 1 and chain[0] in scene.system.modes:
            return (
                f"at {t} mode {chain[0]!r} follows itself for ever at one instant, or ever faster: what comes to "
                f"rest there asks for a mode of its own, or for unilateral `contacts` in the place of guard and reset"
            )
        if len(chain) == 1:
            return (
                f"at {t} the motion slides in mode {chain[0]!r} over the edge of its surface, where another one "
                f"crosses it: no surface parts what lies beyond; describe it, or give the mode a guard there"
            )
        return (
            f"at {t} the modes {' -> '.join([*chain, chain[0]])} follow one another for ever at one instant, or "
            f"ever faster; where two fields point at each other, describe the switching as a lagrangian.Surface"
        )
    return (
        f"at {t} the motion in mode {names[motion.mode]!r} touches the guard towards "
        f"{names[motion.m.target_of(motion.due)]!r} and turns back within the tolerance: the guard is not "
        f"transversal there, and whether it acts is undecided"
    )


def switch_log(scene: HybridScene, log: Array) -> Any:
    """The switches that kernels have written, as a record array."""
    n, names = scene.system.n_x, np.array(scene.system.names)
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
    result["before"] = log[:, SWITCH_LEAD : SWITCH_LEAD + n]
    result["after"] = log[:, SWITCH_LEAD + n :]
    return result.view(np.recarray)


def chosen(whole: HybridTrajectory, kept: Kept) -> HybridTrajectory:
    """The trajectory with the states that were asked for."""
    from dataclasses import replace

    t = whole.pieces.t
    if kept.all:
        return whole
    if kept.on_events:
        t = np.unique(np.concatenate([t[:1], whole.switches.time, t[-1:]]))
    elif kept.every:
        t = np.unique(np.concatenate([t[:: kept.every], t[-1:]]))
    else:
        t = kept.times[kept.times <= t[-1]]
    return replace(whole, t=t, x=whole.at(t), mode=whole.mode_at(t))


def _check_start(scene: HybridScene, m: Machine) -> None:
    """A motion can start sliding only where both fields point at the surface."""
    for surface in scene.system.surfaces:
        if scene.mode != surface.sliding:
            continue
        t, x, k = scene.t_span[0], np.array(scene.x0), scene.system.names.index(scene.mode)
        H, L1, L2 = m.surface_at(k, t, x)
        if abs(H) > 1e-9 * max(1.0, float(np.max(np.abs(x)))):
            raise LcpStepError(f"x0: mode {scene.mode!r} starts on its surface, but H = {H:.6g} there")
        if not (L1 >= 0.0 >= L2):
            raise LcpStepError(
                f"mode: {scene.mode!r} needs both fields to point at the surface (L1 >= 0 >= L2), but at x0 "
                f"L1 = {L1:.6g} and L2 = {L2:.6g}; start on one of its sides"
            )
