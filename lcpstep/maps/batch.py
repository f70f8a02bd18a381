"""Many runs of one scene over many periods of its forcing, by either integrator: states, impacts, how each ended.

The one door to the fast ways: event-driven runs with closed-form flow (`follow`) and time-stepping in lockstep
(`lockstep`), and to systems with modes (`modes`); all other systems are simulated one run after another.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.events import EventDriven
from lcpstep.maps import follow, lockstep, modes
from lcpstep.maps.one_by_one import one_by_one
from lcpstep.maps.repeating import check_period
from lcpstep.maps.task import (
    INSIDE as INSIDE,
)  # in place of a `Status`: the start lies inside of the obstacle
from lcpstep.maps.task import UNREACHED, Task
from lcpstep.simulation import Method
from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
# Fields of `Periods` that have an entry for each kept period
PER_PERIOD = "states", "time", "before", "after", "struck", "landed", "resting", "impacts", "ends", "tangents"
IMPACTS_KEPT = 64  # of each period; their number is known beyond


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
    struck, resting : (m, kept, most)   contact of each impact, and of each landing; 0 of a system with modes
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
    struck: Ints
    landed: Array
    resting: Ints
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
    """Refuse a scene with a wrong period, or none, and say what would give it one; TypeError for what is no scene."""
    if not isinstance(scene, (Scene, HybridScene)):
        raise TypeError(f"scene: expected a lagrangian.Scene or HybridScene, got {scene!r}")
    if math.isfinite(scene.period):
        if isinstance(scene, Scene):
            check_period(scene)
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
    ValueError   the scene has no period, or a wrong one, or a number is out of range
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
        struck=task.struck, landed=task.landings, resting=task.resting,
        impacts=task.counts[..., 0], ends=task.counts[..., 1], tangents=task.tangents,
        reached=task.reached, taken=task.taken, final=task.final, status=task.codes,
    )  # fmt: skip


def _from_logs(scene: Scene, task: Task) -> Array:
    """Derivatives of the kept periods from their impacts, where the motion between these is known in closed form."""
    exact = follow.Follower(scene, EventDriven()) if scene.n_c <= 1 else None
    if exact is None or not exact.usable:
        return task.tangents
    log = np.ascontiguousarray(task.impacts[..., :2])
    result = np.asarray(exact.tangents_of(log, task.counts, task.t_start))
    # Without an impact a motion flies or rests all the time; an event-driven run from its start tells
    before = np.concatenate([np.full_like(task.states[:, :1], np.nan), task.states[:, :-1]], axis=1)
    if task.drop == 0:
        before[:, 0] = task.starts
    quiet = np.all(task.counts == 0, axis=2) & np.all(np.isfinite(before), axis=2)
    if np.any(quiet):
        phase = task.t_start / scene.period
        found = periods(scene, EventDriven(), before[quiet], 1, phase=phase, strict=False, tangents=True)
        result[quiet] *= np.any(found.tangents, axis=(2, 3))[..., None]
    return result


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
    x = checks.matrix("starts", starts).copy()
    if x.shape[1] != d:
        names = ", ".join(label.split(" [")[0] for label in scene.labels)
        raise ValueError(f"starts: expected states ({names}) of shape (m, {d}), got shape {np.shape(starts)}")
    m, kept = len(x), n - drop
    none = Targets(np.zeros((0, d)), np.zeros(0), np.ones(d))
    to = none if targets is None else targets
    return Task(
        t_start=t, t_end=t + scene.period, drop=drop, periods=n, starts=x,
        targets=np.ascontiguousarray(to.points), radius=np.ascontiguousarray(to.radius),
        scale=np.ascontiguousarray(to.scale),
        states=np.full((m, kept, d), np.nan), impacts=np.full((m, kept, most, 3), np.nan),
        struck=np.zeros((m, kept, most), dtype=np.intp), resting=np.zeros((m, kept, most), dtype=np.intp),
        landings=np.full((m, kept, most), np.nan),
        counts=np.zeros((m, kept, 2), dtype=np.intp), reached=np.full(m, UNREACHED, dtype=np.intp),
        tangents=np.zeros((m, 0, d, d)), taken=np.zeros(m, dtype=np.intp),
        final=x.copy(), codes=np.zeros(m, dtype=np.intp), strict=True,
    )  # fmt: skip
