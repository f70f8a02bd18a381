"""Attractors of a periodically forced scene: which there are, and what each is.

Runs from many states are followed until they have settled. A motion that comes back after n periods, with m impacts
on the way, is an O(n, m); where infinitely many impacts (complete chattering) belong to it, that is said in place
of m. Of a system with modes the m events are its switches. One that does not come back is aperiodic: chaotic if its
largest Lyapunov exponent is positive beyond its standard error, and beyond growth in proportion to time. Where it
is negative beyond its standard error, neighbours come together, and so to a periodic motion: one that was not waited
for long enough, which is said in place of a name. The same is said where sampled motions have become periodic
meanwhile.
Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.2.3.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.attractor import Attractor as Attractor
from lcpstep.analysis.attractor import Attractors as Attractors
from lcpstep.analysis.grid_error import APART, spread, wandered
from lcpstep.analysis.grouping import Settled, grouped, near, overlap
from lcpstep.analysis.returns import TOLERANCE as TOLERANCE
from lcpstep.analysis.returns import periods_to_settle, return_time, return_times, run_away, sizes, survive
from lcpstep.analysis.sampled import POINTS as POINTS
from lcpstep.analysis.sampled import STARTS, described
from lcpstep.analysis.starts import random_starts as random_starts
from lcpstep.analysis.variation import PeriodMap
from lcpstep.events import EventDriven
from lcpstep.maps.batch import INSIDE, Periods, periods
from lcpstep.maps.stroboscopic import StroboscopicMap
from lcpstep.simulation import Method
from lcpstep.trajectory import Status
from lcpstep.warned import warn

Array = NDArray[np.float64]
AT_SECTION = 1e-9  # of the period: rounding decides on which side of the section such an impact is


class NoneSettled(UserWarning):
    """No run has come to an attractor."""


def attractors(
    scene: Scene | HybridScene,
    method: Method,
    starts: ArrayLike,
    *,
    transient: int = 500,
    window: int = 240,
    longest: int = 60,
    phase: float = 0.0,
    tolerance: float | None = None,
    points: int = POINTS,
) -> Attractors:
    """Attractors that runs from the given states go to.

    Parameters
    ----------
    scene : lagrangian.Scene, or HybridScene, with a period
    method : lcpstep.EventDriven or lcpstep.Moreau; EventDriven for a system with modes
    starts : (s, 2 n_q)   states (q, v), or (s, n_x), at the section; see `random_starts`
    transient, window : periods dropped, and looked at
    longest : longest period n, in periods of the forcing, that is recognised; at most a half of the window
    phase : of the section, as a share of the period in [0, 1)
    tolerance : of a return, relative to the size of the motion; where not given 1e-6 for `EventDriven`, and for other
        methods what their grid does to the motion (see `grid_error`)
    points : periods that an aperiodic attractor is sampled over, at the least

    Raises
    ------
    ValueError   a number is out of range, or the scene has no period
    """
    window, longest = checks.count("window", window), checks.count("longest", longest)
    if 2 * longest > window:
        raise ValueError(f"longest: expected at most half of window = {window}, got {longest}")
    points = checks.count("points", points)
    transient = int(checks.number("transient", transient, least=0))
    if tolerance is not None:
        checks.positive("tolerance", tolerance)
    runs = periods(
        scene, method, starts, transient + window, drop=transient, phase=phase, most=0, strict=True
    )
    first = np.array(starts, dtype=float, ndmin=2)
    done = np.flatnonzero((runs.status == Status.DONE) & ~run_away(runs.states, first))
    settled = _settled(scene, method, runs, done, longest, phase, tolerance, transient)
    groups = sorted(grouped(settled), key=len, reverse=True)
    label = np.full(len(runs.status), -1)
    found = []
    P = PeriodMap(scene, method, phase)
    for k, members in enumerate(groups):
        numbers = [settled[i].number for i in members]
        label[numbers] = k
        returning = [settled[i].periods for i in members if settled[i].periods]
        n = int(np.bincount(returning).argmax()) if returning else 0
        typical = [settled[i].number for i in members if settled[i].periods == n]
        one = described(P, runs, typical, n, points, len(members) / len(label))
        found.append(replace(one, unsettled=unsettled(P, one, runs.states[typical[0]], transient, longest)))
    settings = {
        "transient": transient, "window": window, "longest": longest, "phase": phase,
        "tolerance": TOLERANCE if tolerance is None else tolerance,
    }  # fmt: skip
    early = np.flatnonzero((runs.status != Status.DONE) & (runs.status != INSIDE))
    if not found and len(early):
        why = StroboscopicMap(scene, method, phase).why(runs.final[early[0]], Status(runs.status[early[0]]))
        start = first[early[0]].tolist()
        warn(f"{scene.name!r}: no run has settled; that from x = {start} ended early: {why}", NoneSettled)
    return Attractors(tuple(found), first, label, settings)


def _settled(
    scene: Any, method: Method, runs: Periods, done: NDArray[np.int64], longest: int, phase: float,
    tolerance: float | None, transient: int,
) -> list[Settled]:  # fmt: skip
    """What each run that got to its end has settled to; what counts as a return the method's grid decides."""
    if isinstance(method, EventDriven) or tolerance is not None or len(done) == 0:
        allowed = TOLERANCE if tolerance is None else tolerance
        states = runs.states[done]
        size = sizes(scene, method, states, phase)
        n = return_times(states, longest, allowed * size)
        if isinstance(method, EventDriven):
            n[~survive(scene, method, states, n, phase, allowed * size)] = 0
        return [
            Settled(int(i), states[k], np.full(states.shape[2], size[k]), allowed, int(n[k]))
            for k, i in enumerate(done)
        ]
    moved = spread(scene, method, runs.final[done], phase)
    within = np.maximum(APART * moved.radius, TOLERANCE)
    returns = [
        return_time(runs.states[i] / moved.scale[k], longest, float(within[k])) if moved.forgets[k] else 0
        for k, i in enumerate(done)
    ]
    # On its own grid an aperiodic motion may be caught by a cycle that only this grid has
    restless = np.flatnonzero(np.array(returns) == 0)
    paths = [runs.states[i] for i in done]
    if len(restless):
        later = wandered(scene, method, runs.final[done[restless]], transient, phase)
        for k, path in zip(restless, spread(scene, method, later, phase).paths, strict=True):
            paths[k] = path
    return [
        Settled(int(i), paths[k], moved.scale[k], float(within[k]), returns[k]) for k, i in enumerate(done)
    ]


def unsettled(P: PeriodMap, found: Attractor, states: Array, transient: int, longest: int) -> str:
    """Why a motion that must be periodic in the end has not been seen to be, or nothing.

    states : (window, d)   of a run on it
    """
    if found.periods or not isinstance(P.method, EventDriven):
        return ""  # time-stepping scatters what it repeats
    if found.lyapunov.chaotic:
        return _later(P, found, longest)
    more = periods_to_settle(states, longest)
    if more:
        return f"still on its way to a periodic motion: take a transient of some {transient + more} periods"
    rate = found.lyapunov.largest
    if not -math.inf < rate < -found.lyapunov.least:
        return _later(P, found, longest)
    away = np.abs((found.impact_phase - P.phase + 0.5) % 1.0 - 0.5)
    if np.any(away < AT_SECTION):
        return "an impact falls on the section, now before it and now after it: take another phase"
    return (
        f"neighbours come together (exponent {rate:.3g} per period), so it ends in a periodic motion, but does "
        f"not repeat within {longest} periods: take a larger longest, or a longer transient"
    )


def _later(P: PeriodMap, found: Attractor, longest: int) -> str:
    """Whether motions from an attractor that seems aperiodic have left it for periodic ones when it was sampled.

    Transient chaos has a positive exponent as long as it lasts.
    """
    paths = found.points.reshape(STARTS, -1, found.points.shape[1])[:, -2 * longest :]
    allowed = TOLERANCE * sizes(P.scene, P.method, paths, P.phase)
    n = return_times(paths, longest, allowed)
    left = int(np.sum(survive(P.scene, P.method, paths, n, P.phase, allowed)))
    return (
        f"{left} of {STARTS} motions from there on have become periodic: take a longer transient"
        if left
        else ""
    )


def with_new(known: Attractors, more: Attractors) -> Attractors:
    """The known attractors, and those of another search that are not among them; shares are of each search."""
    tolerance = known.settings["tolerance"]

    def is_known(a: Attractor) -> bool:
        scale = np.full(a.points.shape[1], max(float(np.max(np.abs(a.points))), 1e-300))
        alike = [b for b in known.found if b.periods == a.periods]
        if not a.periods:
            return any(overlap(a.points, b.points) for b in alike)
        return any(near(a.points, b.points, scale, tolerance) for b in alike)

    new = [a for a in more.found if not is_known(a)]
    return replace(known, found=(*known.found, *new))
