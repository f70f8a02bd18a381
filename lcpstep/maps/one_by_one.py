"""Runs over many periods where no kernel follows them: simulated one after another, several periods in one run."""

from __future__ import annotations

import math
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import SimulationError
from lcpstep.events import EventDriven
from lcpstep.maps.task import INSIDE, UNREACHED, Task
from lcpstep.pace import counted
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Kind, Status

Array = NDArray[np.float64]
ROUNDING = 64 * np.finfo(float).eps
LONGEST = 64  # periods in one run


def one_by_one(scene: Scene, method: Method, task: Task, strict: bool) -> None:
    """The task by `simulate`, one run after another."""
    for i in counted(range(len(task.starts))):
        q = task.starts[i, : scene.n_q]
        g, _ = scene.gap(task.t_start, q, task.starts[i, scene.n_q :])
        if strict and np.any(g < -ROUNDING * max(1.0, float(np.max(np.abs(q))))):
            task.codes[i] = INSIDE
        else:
            _follow(scene, method, task, i)


def _follow(scene: Scene, method: Method, task: Task, i: int) -> None:
    """Run i, over ever more periods at a time as long as these go well.

    By methods whose steps need not end with a period; by others, and from where a run over several ends early, one
    period at a time.
    """
    x, k, n, most = task.starts[i].copy(), 0, 1, LONGEST if isinstance(method, EventDriven) else 1
    while k < task.periods and task.codes[i] == Status.DONE and task.reached[i] == UNREACHED:
        n = min(n, task.periods - k)
        run, code = _several_periods(scene, method, task, x, n)
        if run is None and n > 1:
            n = most = 1
            continue
        task.codes[i], task.taken[i] = code, k + 1
        for j in range(0 if run is None else n):
            before, x, k = x, np.concatenate([run.q[j], run.v[j]]), k + 1
            task.taken[i] = k
            if k > task.drop:
                task.states[i, k - 1 - task.drop] = x
                _record(task, i, k - 1 - task.drop, run, j, before)
            if len(task.targets):
                hits = np.flatnonzero(np.max(np.abs(task.targets - x) / task.scale, axis=1) <= task.radius)
                task.reached[i] = hits[0] if len(hits) else UNREACHED
                if len(hits):
                    break
        n = min(2 * n, most)
    task.final[i] = x


def _several_periods(scene: Scene, method: Method, task: Task, x: Array, n: int) -> tuple[Any, int]:
    """A run over n periods, its states those at their ends, or None; a `Status`."""
    ends = np.append(task.t_end, task.t_start + np.arange(2, n + 1) * (task.t_end - task.t_start))
    one = continued(scene, x, (task.t_start, float(ends[-1])))
    try:
        run = simulate(one, method, keep=ends)
    except SimulationError as error:
        if error.trajectory.status == Status.DONE:  # no motion fails: a derivative of the scene is wrong
            raise
        return None, int(error.trajectory.status)
    return (run if run.status == Status.DONE else None), int(run.status)


def _record(task: Task, i: int, k: int, run: Any, j: int, start: Array) -> None:
    """What happened in the kept period k of run i, the j-th of these of `_several_periods`, from its start on."""
    log = np.asarray(run.impacts)
    if len(log) == 0:
        return
    first, end = np.searchsorted(log["time"], [run.t[j - 1] if j else -math.inf, run.t[j]], side="right")
    log = log[first:end]
    time = np.minimum(log["time"] - j * (task.t_end - task.t_start), task.t_end)
    # A contact closed at the section is no impact, and no landing
    later, least = time > task.t_start, ROUNDING * max(1.0, float(np.max(np.abs(start))))
    impacts = np.flatnonzero((log["kind"] == Kind.IMPACT) & (later | (np.abs(log["before"]) > least)))
    ends = np.flatnonzero((log["kind"] == Kind.STICK) & later)
    shown = impacts[: task.impacts.shape[2]]
    what = time[shown], log["before"][shown], log["after"][shown]
    task.impacts[i, k, : len(shown)] = np.stack(what, axis=1)
    task.struck[i, k, : len(shown)] = log["contact"][shown]
    shown = ends[: task.landings.shape[2]]
    task.landings[i, k, : len(shown)] = time[shown]
    task.resting[i, k, : len(shown)] = log["contact"][shown]
    task.counts[i, k] = len(impacts), len(ends)


def continued(scene: Scene, x: Array, t_span: tuple[float, float]) -> Scene:
    """The scene from another state on, unchecked: time-stepping may have left it inside of the obstacle."""
    result = copy(scene)
    state = {"q0": x[: scene.n_q].copy(), "v0": x[scene.n_q :].copy(), "t_span": t_span}
    for name, value in state.items():
        object.__setattr__(result, name, value)
    return result
