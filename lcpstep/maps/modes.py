"""Runs of a system with modes over many periods of its forcing, with derivatives: what `batch.periods` asks of it.

Its events are switches: their times, and the rate of the guard just before and after each, as the gap velocity is
that of a gap. Where sliding begins, `landed` says when. The kernel is `lcpstep.maps.mode_periods`.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian.hybrid import HybridScene
from lcpstep.callbacks.faults import cause, forget
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.field import Machine
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.run import prepared
from lcpstep.kernels.status import BUFFER_FULL
from lcpstep.kernels.uncompiled import CalledBack
from lcpstep.maps.follow import Task
from lcpstep.maps.mode_periods import Follow, Placing, follow
from lcpstep.maps.saltation.switches import Tangent
from lcpstep.pace import Pace
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
SPAN = 4  # periods that the longest step is made for
LOG = 256  # switches of a period that there is room for at first
PORTION = 65536  # periods between two looks at the outside world, at most

ARRAYS = (
    "starts", "targets", "radius", "scale", "states", "impacts", "landings", "counts", "tangents", "reached", "taken",
    "final", "codes",
)  # fmt: skip


def check(scene: HybridScene, method: Any) -> None:
    """Refuse what has no map of states."""
    if not isinstance(method, EventDriven):
        raise LcpStepError(f"method: a system with modes is run by lcpstep.EventDriven, got {method!r}")
    if not scene.system.tells_modes:
        raise LcpStepError(
            f"scene: a state of {scene.name!r} does not tell its mode, so there is no map of states; give "
            f"HybridSystem(mode_of=...), and keep what the system remembers as a state that resets set"
        )


def told(code: int, scene: HybridScene, J: Array) -> Array:
    """The derivative, or the error that says why there is none."""
    if code == Status.NOT_TRANSVERSAL:
        raise LcpStepError(f"a guard of {scene.name!r} is not transversal: the motion has no derivative")
    if code != Status.DONE:
        raise LcpStepError(f"the variational flow of {scene.name!r} could not be integrated")
    return J.copy()


def run_all(scene: HybridScene, method: Any, task: Task, tangents: bool) -> Task:
    """The task of `batch.periods`, by the kernel."""
    check(scene, method)
    kept, n = task.periods - task.drop, scene.n_x
    if tangents:
        task = task._replace(tangents=np.full((len(task.starts), kept, n, n), np.nan))
    span = task.t_start, task.t_start + SPAN * (task.t_end - task.t_start)
    motion = prepared(replace(scene, t_span=span, exact=None), method, 0, LOG)
    motion.t_end = task.t_end
    f = Follow(
        motion, Tangent(motion.m), placing(scene, motion.m), task.t_start, task.t_end, task.drop, task.periods,
        {name: getattr(task, name) for name in ARRAYS},
    )  # fmt: skip
    forget()
    pace = Pace(PORTION, n, task.periods * len(task.starts))
    while f.run < f.runs:
        code = follow(f, pace.goal(f.taken))
        raised()
        if code == BUFFER_FULL:
            motion.make_room()
        elif code != Status.DONE:
            told(code, scene, f.tangent.derivative)
    return task


def placing(scene: HybridScene, m: Machine) -> Placing:
    """What tells the modes of states: the user's function, or the surface."""
    system = scene.system
    if system.mode_of is None:
        return Placing(m, None, np.array(scene.p), system.names.index(system.surfaces[0].sliding))

    def number(t: float, x: Array, p: Array, out: Array) -> None:
        out[0] = system.names.index(system.named_mode(t, x, p))

    return Placing(m, CalledBack(number, first_order=True), np.array(scene.p), 0)


def mode_at(scene: HybridScene, t: float, x: Array) -> str:
    """Name of the mode of a motion through x at the time t."""
    forget()
    mode = placing(scene, machine(scene)).mode_at(t, x)
    raised()
    return scene.system.names[mode]


def raised() -> None:
    """Raise what a function in Python has raised."""
    error = cause()
    if error is not None:
        raise error


def started(scene: Any, x: Array, span: tuple[float, float]) -> Any:
    """The scene, with modes or without, from another state and over another span."""
    if isinstance(scene, HybridScene):
        return scene.started(x, mode_at(scene, span[0], x), span)
    return replace(scene, q0=x[: scene.n_q], v0=x[scene.n_q :], t_span=span)
