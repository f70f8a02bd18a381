"""Many runs of one scene over many periods of its forcing, by either integrator: states, impacts, how each ended.

The one door to the fast ways: event-driven runs with closed-form flow (`follow`) and time-stepping in lockstep
(`lockstep`), and to systems with modes (`modes`); all other systems are simulated one run after another.
"""

from __future__ import annotations

import math
from copy import copy
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.errors import SimulationError
from lcpstep.events import EventDriven
from lcpstep.maps import follow, lockstep, modes
from lcpstep.maps.task import (
    INSIDE as INSIDE,
)  # in place of a `Status`: the start lies inside of the obstacle
from lcpstep.maps.task import UNREACHED, Task
from lcpstep.pace import counted
from lcpstep.simulation import Method, simulate
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Kind, Status

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
IMPACTS_KEPT = 64  # of each period; their number is known beyond
ROUNDING = 64 * np.finfo(float).eps
LONGEST = 64  # periods in one run


@dataclass(frozen=True, eq=False)
class Periods:
    """What became of m runs; `kept` periods of each were looked at.

    Of a system with modes states are x (n_x,), and its switches stand for impacts: before and after are the rates of
    the guard, `landed` the times at which sliding begins.

    Attributes
    ----------
    states : (m, kept, 2 n_q)   (q, v) at the end of each kept period
    time, before, after : (m, kept, most)   time [s] and gap velocities [m/s] of the first impacts in each period,
        nan where there were fewer
    landed : (m, kept, most)   times at which the contact closed for good in each period [s], the first ones: ends of
        chattering sequences (their accumulation points), and impacts without rebound
    impacts, ends : (m, kept)   number of impacts, and of these landings, in each period
    tangents : (m, kept, d, d)   derivative of the state at the end of each kept period by that at its start;
        (m, 0, d, d) where it was not asked for, or is not known in closed form
    reached : (m,)   number of the target a run came near to, -1 for none
    taken : (m,)   periods taken
    final : (m, 2 n_q)   last state
    status : (m,)   a `Status`, or INSIDE for a start inside of the obstacle
    """

    states: Array
    time: Array
    before: Array
    after: Array
    landed: Array
    impacts: Ints
    ends: Ints
    tangents: Array
    reached: Ints
    taken: Ints
    final: Array
    status: Ints


@dataclass(frozen=True, eq=False)
class Targets:
    """Where a run may end: points (k, 2 n_q), radii (k,) in units of `scale` (2 n_q,)."""

    points: Array
    radius: Array
    scale: Array


def periodic(scene: Scene | HybridScene, what: str = "stroboscopic map") -> None:
    """Refuse a scene without a period, and say what would give it one; TypeError for what is no scene."""
    if not isinstance(scene, (Scene, HybridScene)):
        raise TypeError(f"scene: expected a lagrangian.Scene or HybridScene, got {scene!r}")
    if math.isfinite(scene.period):
        return
    drive = scene.parameters.get("amplitude")
    hint = "; it is driven where its parameter amplitude is not zero" if drive == 0.0 else ""
    if isinstance(scene, HybridScene):
        hint += "; lcpstep.maps.SwitchMap (lcpstep orbit --mode) takes returns to a mode"
    elif scene.n_c:
        hint += "; lcpstep.maps.EventMap (lcpstep orbit --event) takes returns to an event of a contact"
    raise ValueError(f"scene: {scene.name!r} has no period, and so no {what}{hint}")


def periods(
    scene: Scene | HybridScene,
    method: Method,
    starts: ArrayLike,
    n: int,
    *,
    drop: int = 0,
    phase: float = 0.0,
    most: int = IMPACTS_KEPT,
    targets: Targets | None = None,
    strict: bool = True,
    tangents: bool = False,
) -> Periods:
    """Follow runs over n periods of the scene's forcing, and keep what happens after the first `drop` of them.

    Parameters
    ----------
    scene : lagrangian.Scene, or HybridScene, with a period
    method : lcpstep.EventDriven or lcpstep.Moreau; EventDriven for a system with modes
    starts : (m, 2 n_q) or (2 n_q,)   states (q, v), or (m, n_x), at the time phase x period
    n, drop : number of periods, and how many of them are dropped
    phase : of the section, as a share of the period in [0, 1)
    most : impacts kept of each period, and landings; the first ones, where there are more
    targets : a run ends early, after a whole period, where it comes near one of these
    strict : a start inside of the obstacle ends its run at once; states that time-stepping has computed may lie
        there a little, and go on where this is False
    tangents : also derivatives, where the motion between impacts is known in closed form: along the events of
        `EventDriven`, and from the recorded impacts of other methods, to their accuracy

    Raises
    ------
    ValueError   the scene has no period, or a number is out of range
    LcpStepError   what the method itself raises for this scene
    """
    periodic(scene)
    n = checks.count("n", n)
    if not 0 <= drop <= n:
        raise ValueError(f"drop: expected 0 <= drop <= n = {n}, got {drop}")
    task = _task(scene, starts, n, drop, section(phase) * scene.period, most, targets)
    if isinstance(scene, HybridScene):
        return _answer(modes.run_all(scene, method, task, tangents))
    fast = _fast(scene, method, targets)
    if fast is not None:
        if tangents and isinstance(fast, follow.Follower):
            task = task._replace(tangents=np.full((len(task.starts), n - drop, 2, 2), np.nan))
        fast.run(task, strict)
    else:
        one_by_one(scene, method, task, strict)
    if tangents and not task.tangents.shape[1]:
        task = task._replace(tangents=_from_logs(scene, task))
    return _answer(task)


def at_once(scene: Scene | HybridScene, method: Method, targets: Targets | None) -> bool:
    """Whether a kernel follows many runs, each in microseconds a period; others take hundreds."""
    return isinstance(scene, HybridScene) or _fast(scene, method, targets) is not None


def _fast(
    scene: Scene, method: Method, targets: Targets | None
) -> follow.Follower | lockstep.Lockstep | None:
    fast: follow.Follower | lockstep.Lockstep | None = None
    if isinstance(method, EventDriven) and scene.n_c <= 1:
        fast = follow.Follower(scene, method)
    elif isinstance(method, Moreau) and targets is None:
        fast = lockstep.Lockstep(scene, method)
    return fast if fast is not None and fast.usable else None


def _answer(task: Task) -> Periods:
    return Periods(
        states=task.states, time=task.impacts[..., 0], before=task.impacts[..., 1], after=task.impacts[..., 2],
        landed=task.landings, impacts=task.counts[..., 0], ends=task.counts[..., 1],
        tangents=task.tangents, reached=task.reached, taken=task.taken, final=task.final, status=task.codes,
    )  # fmt: skip


def _from_logs(scene: Scene, task: Task) -> Array:
    """Derivatives of the kept periods from their impacts, where the motion between these is known in closed form."""
    exact = follow.Follower(scene, EventDriven()) if scene.n_c <= 1 else None
    if exact is None or not exact.usable:
        return task.tangents
    log = np.ascontiguousarray(task.impacts[..., :2])
    return np.asarray(exact.tangents_of(log, task.counts, task.t_start))


def section(phase: float) -> float:
    """The phase of a section, checked."""
    phase = checks.number("phase", phase, least=0.0, most=1.0)
    if phase == 1.0:
        raise ValueError("phase: expected a share of the period in [0, 1), got 1")
    return phase


def _task(
    scene: Scene | HybridScene,
    starts: ArrayLike,
    n: int,
    drop: int,
    t: float,
    most: int,
    targets: Targets | None,
) -> Task:
    d = scene.n_x
    x = np.array(starts, dtype=float, order="C", ndmin=2)
    if x.ndim != 2 or x.shape[1] != d or len(x) == 0:
        names = ", ".join(label.split(" [")[0] for label in scene.labels)
        raise ValueError(f"starts: expected states ({names}) of shape (m, {d}), got shape {np.shape(starts)}")
    if not np.all(np.isfinite(x)):
        raise ValueError("starts: expected finite numbers")
    m, kept = len(x), n - drop
    none = Targets(np.zeros((0, d)), np.zeros(0), np.ones(d))
    to = none if targets is None else targets
    return Task(
        t_start=t, t_end=t + scene.period, drop=drop, periods=n, starts=x,
        targets=np.ascontiguousarray(to.points), radius=np.ascontiguousarray(to.radius),
        scale=np.ascontiguousarray(to.scale),
        states=np.full((m, kept, d), np.nan), impacts=np.full((m, kept, most, 3), np.nan),
        landings=np.full((m, kept, most), np.nan),
        counts=np.zeros((m, kept, 2), dtype=np.intp), reached=np.full(m, UNREACHED, dtype=np.intp),
        tangents=np.zeros((m, 0, d, d)), taken=np.zeros(m, dtype=np.intp),
        final=x.copy(), codes=np.zeros(m, dtype=np.intp), strict=True,
    )  # fmt: skip


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
    shown = ends[: task.landings.shape[2]]
    task.landings[i, k, : len(shown)] = time[shown]
    task.counts[i, k] = len(impacts), len(ends)


def continued(scene: Scene, x: Array, t_span: tuple[float, float]) -> Scene:
    """The scene from another state on, unchecked: time-stepping may have left it inside of the obstacle."""
    result = copy(scene)
    state = {"q0": x[: scene.n_q].copy(), "v0": x[scene.n_q :].copy(), "t_span": t_span}
    for name, value in state.items():
        object.__setattr__(result, name, value)
    return result
