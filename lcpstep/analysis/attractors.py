"""Attractors of a periodically forced scene: which there are, and what each is.

Runs from many states are followed until they have settled. A motion that comes back after n periods, with m impacts
on the way, is an O(n, m); where infinitely many impacts (complete chattering) belong to it, that is said in place
of m. Of a system with modes the m events are its switches. One that does not come back is aperiodic: chaotic if its
largest Lyapunov exponent is positive beyond its standard error. Where that is negative beyond it, neighbours come
together, and so to a periodic motion: one that was not waited for long enough, which is said in place of a name.
Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.2.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.fixed_points import image_and_derivative, multipliers
from lcpstep.analysis.grid_error import APART, finer_method, on_other_grids, spread, wandered
from lcpstep.analysis.grouping import Settled, grouped, near, overlap
from lcpstep.analysis.listed import listed
from lcpstep.analysis.lyapunov import Lyapunov, growth_of_runs, lyapunov
from lcpstep.analysis.starts import random_starts as random_starts
from lcpstep.analysis.variation import PeriodMap
from lcpstep.events import EventDriven
from lcpstep.maps.batch import Periods, periods
from lcpstep.simulate import Method
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
TOLERANCE = 1e-6  # of a return, relative to the size of the motion
LYAPUNOV_PERIODS = 400
POINTS, CLOUD = 8000, 2000  # periods that an aperiodic attractor, and one of time-stepping, are sampled over
STARTS, FORGET, KICK = 32, 60, 1e-9  # of these samples: runs, periods until they have parted, by what kick
# Exponents of periodic motions by time-stepping: shares of h, runs on each, turns averaged over, and before
GRIDS, RUNS, AVERAGED, FORGOTTEN = (1.0, 0.9, 0.8, 0.71, 0.6, 0.5), 2, 60, 40
UNSURE = 0.5  # of an exponent: an error beyond which it is not told
QUARTERS, FALLEN = (
    4,
    0.5,
)  # of the window; what a change falls to at least, from the first to the last of them
MOST, MOST_OF_MANY = 512, 64  # impacts of a period that are kept, of a periodic motion and of others


@dataclass(frozen=True, eq=False)
class Attractor:
    """One attractor.

    Attributes
    ----------
    periods : n of an O(n, m), 0 where the motion is aperiodic
    impacts : m, impacts in n periods; their mean per period where the motion is aperiodic
    landings : how often in n periods the contact closes for good, after complete chattering or an impact without
        rebound; in one period, on the average, where the motion is aperiodic. Of a system with modes: how often
        sliding begins
    points : (k, 2 n_q)   states (q, v), or (k, n_x), on the section: n of them, or many where the motion is aperiodic
    cloud : (j, 2 n_q)   the same, but many for every motion by time-stepping, whose grid scatters them; for an
        aperiodic one each period is taken with a step of its own, between 0.9 h and h, for on one grid all runs come
        to a cycle that only the grid has
    impact_phase, impact_before, impact_after : (m,)   impacts: phase in [0, 1), gap velocities [m/s]
    impact_number : (m,)   the number of each in its period, from 1
    lyapunov : largest Lyapunov exponent, per period of the forcing
    share : of the starts that went there
    modes : whether the scene is one with modes, so that `impacts` are its switches and landings begin to slide
    unsettled : why the motion has no name although it must be periodic in the end; empty for all others
    """

    periods: int
    impacts: float
    landings: float
    points: Array
    impact_phase: Array
    impact_before: Array
    impact_after: Array
    impact_number: NDArray[np.int64]
    cloud: Array
    lyapunov: Lyapunov
    share: float = 1.0
    modes: bool = False
    unsettled: str = ""

    @property
    def name(self) -> str:
        """O(n, m), O(n, chattering), chaotic, aperiodic where chaos is not certain, or unsettled."""
        if self.periods:
            endless = self.landings and not self.modes
            return f"O({self.periods}, {'chattering' if endless else round(self.impacts)})"
        if self.unsettled:
            return "unsettled"
        return "chaotic" if self.lyapunov.chaotic else "aperiodic"


@dataclass(frozen=True, eq=False)
class Attractors:
    """Attractors found from a number of starts.

    Attributes
    ----------
    found : the attractors, the one with the largest share first
    starts : (s, 2 n_q)   where the runs started
    label : (s,)   number of the attractor each run went to; -1 for runs that ended early or started inside
    settings : what they were looked for with
    """

    found: tuple[Attractor, ...]
    starts: Array
    label: NDArray[np.int64]
    settings: dict[str, Any]


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
    points : periods that an aperiodic attractor is sampled over

    Raises
    ------
    ValueError   a number is out of range, or the scene has no period
    """
    window, longest = checks.count("window", window), checks.count("longest", longest)
    if 2 * longest > window:
        raise ValueError(f"longest: expected at most half of window = {window}, got {longest}")
    transient = int(checks.number("transient", transient, least=0))
    if tolerance is not None:
        checks.positive("tolerance", tolerance)
    runs = periods(
        scene, method, starts, transient + window, drop=transient, phase=phase, most=0, strict=True
    )
    done = np.flatnonzero(runs.status == Status.DONE)
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
    first = np.array(starts, dtype=float, ndmin=2)
    return Attractors(tuple(found), first, label, settings)


def _settled(
    scene: Any, method: Method, runs: Periods, done: NDArray[np.int64], longest: int, phase: float,
    tolerance: float | None, transient: int,
) -> list[Settled]:  # fmt: skip
    """What each run that got to its end has settled to; what counts as a return the method's grid decides."""
    if isinstance(method, EventDriven) or tolerance is not None or len(done) == 0:
        allowed = TOLERANCE if tolerance is None else tolerance
        result = []
        for i in done:
            size = max(float(np.max(np.abs(runs.states[i]))), 1e-300)
            n = return_time(runs.states[i], longest, allowed * size)
            result.append(Settled(int(i), runs.states[i], np.full(runs.final.shape[1], size), allowed, n))
        return result
    moved = spread(scene, method, runs.final[done], phase)
    within = np.maximum(APART * moved.radius, TOLERANCE)
    returns = [
        return_time(runs.states[i] / moved.scale[k], longest, float(within[k])) if moved.forgets[k] else 0
        for k, i in enumerate(done)
    ]
    # On its own grid an aperiodic motion may be caught by a cycle that only this grid has
    restless = np.flatnonzero(np.array(returns) == 0)
    states = [runs.states[i] for i in done]
    if len(restless):
        later = wandered(scene, method, runs.final[done[restless]], transient, phase)
        for k, path in zip(restless, spread(scene, method, later, phase).paths, strict=True):
            states[k] = path
    return [
        Settled(int(i), states[k], moved.scale[k], float(within[k]), returns[k]) for k, i in enumerate(done)
    ]


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


def return_time(states: Array, longest: int, tolerance: float) -> int:
    """Smallest n with states[k + n] = states[k] within the tolerance for all k, or 0 where there is none."""
    for n in range(1, min(longest, len(states) // 2) + 1):
        if np.max(np.abs(states[n:] - states[:-n])) <= tolerance:
            return n
    return 0


def described(
    P: PeriodMap, runs: Periods, members: list[int], n: int, points: int, share: float
) -> Attractor:
    """What these runs have settled to; it returns after n periods if n > 0."""
    x = runs.states[members[0], -1]
    if n and isinstance(P.method, EventDriven):
        sample = P.many(x, n, most=MOST)
    else:
        sample = _sampled(P, runs, members, n, points)
    kept = sample.impacts.size
    per = n if n else 1
    found = listed(sample, P.scene.period, 0)
    return Attractor(
        periods=n,
        impacts=_whole(float(np.sum(sample.impacts)) / kept * per, n),
        landings=_whole(float(np.sum(sample.ends)) / kept * per, n),
        points=sample.states[0][-n:] if n else sample.states.reshape(-1, sample.states.shape[-1]),
        impact_phase=found["impact_phase"],
        impact_before=found["impact_before"],
        impact_after=found["impact_after"],
        impact_number=found["impact_number"],
        cloud=sample.states.reshape(-1, sample.states.shape[-1]),
        lyapunov=_growth(P, sample, x, n),
        share=share,
        modes=isinstance(P.scene, HybridScene),
    )


def unsettled(P: PeriodMap, found: Attractor, states: Array, transient: int, longest: int) -> str:
    """Why a motion that must be periodic in the end has not been seen to be, or nothing.

    states : (window, d)   of a run on it
    """
    if found.periods or found.lyapunov.chaotic or not isinstance(P.method, EventDriven):
        return ""  # time-stepping scatters what it repeats
    more = periods_to_settle(states, longest)
    if more:
        return f"still on its way to a periodic motion: take a transient of some {transient + more} periods"
    rate, error = found.lyapunov.largest, found.lyapunov.error
    if not -math.inf < rate < -3.0 * error:
        return ""
    return (
        f"neighbours come together (exponent {rate:.3g} per period), so it ends in a periodic motion, but does "
        f"not repeat within {longest} periods: take a larger longest, or a longer transient"
    )


def periods_to_settle(states: Array, longest: int) -> int:
    """After how many periods a motion (window, d) will come back within TOLERANCE; 0 where it does not approach.

    It approaches where the largest change over n periods falls from each quarter of the window to the next, for the
    n <= longest that it changes least over.
    """
    size, best = max(float(np.max(np.abs(states))), 1e-300), np.full(QUARTERS, math.inf)
    for n in range(1, min(longest, len(states) // 2) + 1):
        change = np.max(np.abs(states[n:] - states[:-n]), axis=1)
        largest = np.array([np.max(quarter) for quarter in np.array_split(change, QUARTERS)])
        best = largest if largest[-1] < best[-1] else best
    falling = np.all(np.diff(best) < 0.0) and best[-1] < FALLEN * best[0]
    if not falling or best[-1] <= 0.0:
        return 0
    rate = math.log(best[-1] / best[0]) / ((QUARTERS - 1) / QUARTERS * len(states))
    return max(1, math.ceil(math.log(TOLERANCE * size / best[0]) / rate))


def _whole(number: float, n: int) -> float:
    return float(round(number)) if n else number


def _sampled(P: PeriodMap, runs: Periods, members: list[int], n: int, points: int) -> Periods:
    """Many short runs on one attractor.

    A single long one will not do: where an aperiodic motion sticks now and then, rounding alone closes a cycle.
    """
    many = STARTS if not n else min(STARTS, len(members))
    starts = runs.final[np.resize(np.array(members), many)]
    if not n:
        kicks = np.random.default_rng(0).uniform(-KICK, KICK, starts.shape)
        starts = starts + kicks * np.max(np.abs(runs.states[members]), axis=(0, 1))
    each = max(1, -(-points // many)) if not n else max(n, -(-CLOUD // (many * n)) * n)
    drop = FORGET if not n else 0
    if not n and not isinstance(P.method, EventDriven):
        return on_other_grids(P, starts, each + drop, drop, MOST_OF_MANY)
    return P.many(starts, each + drop, drop, most=MOST if n else MOST_OF_MANY)


def _growth(P: PeriodMap, sample: Periods, x: Array, n: int) -> Lyapunov:
    """Largest Lyapunov exponent per period: from the multipliers of a periodic motion, or along an aperiodic one."""
    if not sample.tangents.shape[1]:  # no closed form
        if not isinstance(P.method, EventDriven):
            return Lyapunov(
                math.nan, math.nan, reason="differences across the impacts of time-stepping say nothing"
            )
        if not n:
            return lyapunov(P, x, LYAPUNOV_PERIODS)
        return _of_multipliers(image_and_derivative(P, x, n)[1], n)
    if n and isinstance(P.method, EventDriven):
        J = np.eye(len(x))
        for factor in sample.tangents[0]:
            J = factor @ J
        return _of_multipliers(J, n)
    if n:
        return _of_scattered(P, sample.final[:RUNS], n)
    return growth_of_runs(sample.tangents)


def _of_scattered(P: PeriodMap, starts: Array, n: int) -> Lyapunov:
    """Of a periodic motion by time-stepping, from motions with steps of h/2 to h.

    Each grid scatters the impacts, and moves their mean; the derivative is that along the mean impacts of a run. What
    the exponents on the grids differ by is their error. Where that is as large as a good part of the exponent the
    motion has left the orbit too far for its derivative to be that of the orbit, and nothing is told.
    """
    parts = []
    for share in GRIDS:
        finer = replace(P, method=finer_method(P.method, share))
        run = finer.many(starts, (AVERAGED + FORGOTTEN) * n, FORGOTTEN * n, most=MOST)
        for i in range(len(starts)):
            log, counts = mean_impacts(run, i, n)
            J = np.eye(2)
            for factor in P.from_impacts(log[None], counts[None])[0]:
                J = factor @ J
            parts.append(_of_multipliers(J, n).largest)
    if -math.inf in parts:
        return Lyapunov(-math.inf, 0.0)
    largest = float(np.median(parts))
    error = float(np.max(np.abs(np.array(parts) - largest)))
    if error > UNSURE * abs(largest):
        reason = (
            f"from {min(parts):.3g} to {max(parts):.3g} with steps of h/2 to h; the motion by time-stepping lies too "
            f"far from the orbit: take a smaller h"
        )
        return Lyapunov(math.nan, error, reason=reason)
    return Lyapunov(largest, error)


def mean_impacts(sample: Periods, i: int, n: int) -> tuple[Array, NDArray[np.int64]]:
    """Time and velocity of the impacts of run i, (n, most, 2), averaged over its turns of n periods; their numbers.

    Of turns with another number of impacts than most have nothing is taken.
    """
    most = sample.time.shape[2]
    log, counts = np.full((n, most, 2), np.nan), np.zeros((n, 2), dtype=np.int64)
    for j in range(n):
        numbers, ends = sample.impacts[i, j::n], sample.ends[i, j::n]
        usual = int(np.bincount(numbers).argmax())
        alike = numbers == usual
        counts[j] = usual, int(np.median(ends[alike]))
        shown = min(usual, most)
        log[j, :shown, 0] = np.mean(sample.time[i, j::n][alike][:, :shown], axis=0)
        log[j, :shown, 1] = np.mean(sample.before[i, j::n][alike][:, :shown], axis=0)
    return log, counts


def _of_multipliers(J: Array, n: int) -> Lyapunov:
    largest = float(abs(multipliers(J)[0]))
    return Lyapunov(math.log(largest) / n if largest > 0.0 else -math.inf, 0.0)
