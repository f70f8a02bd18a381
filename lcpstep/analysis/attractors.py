"""Attractors of a periodically forced scene: which there are, and what each is.

Runs from many states are followed until they have settled. A motion that comes back after n periods, with m impacts
on the way, is an O(n, m); where infinitely many impacts (complete chattering) belong to it, that is said in place
of m. One that does not come back is aperiodic: chaotic if its largest Lyapunov exponent is positive beyond its
standard error. Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.2.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import Scene, checks
from lcpstep.analysis.fixed_points import image_and_derivative, multipliers
from lcpstep.analysis.lyapunov import Lyapunov, lyapunov
from lcpstep.analysis.variation import PeriodMap
from lcpstep.events import EventDriven
from lcpstep.maps.batch import Periods, periods
from lcpstep.simulate import Method
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
TOLERANCE = 1e-6  # of a return, relative to the size of the motion
STEPS_APART = 30  # of time-stepping, by which a return may be missed: impacts are rounded to its grid
LYAPUNOV_PERIODS = 400
OVERLAP = 0.5  # of two clouds of points that are one attractor
NEIGHBOURS = 5.0  # typical distances between points of a cloud, within which another is taken as part of it


@dataclass(frozen=True, eq=False)
class Attractor:
    """One attractor.

    Attributes
    ----------
    periods : n of an O(n, m), 0 where the motion is aperiodic
    impacts : m, impacts in n periods; their mean per period where the motion is aperiodic
    landings : how often in n periods the contact closes for good, after complete chattering or an impact without
        rebound; in one period, on the average, where the motion is aperiodic
    points : (k, 2 n_q)   states (q, v) on the section: n of them, or many where the motion is aperiodic
    impact_phase, impact_before, impact_after : (m,)   impacts: phase in [0, 1), gap velocities [m/s]
    lyapunov : largest Lyapunov exponent, per period of the forcing
    share : of the starts that went there
    """

    periods: int
    impacts: float
    landings: float
    points: Array
    impact_phase: Array
    impact_before: Array
    impact_after: Array
    lyapunov: Lyapunov
    share: float = 1.0

    @property
    def name(self) -> str:
        """O(n, m), O(n, chattering), chaotic, or aperiodic where chaos is not certain."""
        if self.periods:
            return f"O({self.periods}, {'chattering' if self.landings else round(self.impacts)})"
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
    scene: Scene,
    method: Method,
    starts: ArrayLike,
    *,
    transient: int = 500,
    window: int = 240,
    longest: int = 60,
    phase: float = 0.0,
    tolerance: float | None = None,
) -> Attractors:
    """Attractors that runs from the given states go to.

    Parameters
    ----------
    scene : lagrangian.Scene with a period
    method : lcpstep.EventDriven or lcpstep.Moreau
    starts : (s, 2 n_q)   states (q, v) at the section; see `random_starts`
    transient, window : periods dropped, and looked at
    longest : longest period n, in periods of the forcing, that is recognised; at most a half of the window
    phase : of the section, as a share of the period in [0, 1)
    tolerance : of a return, relative to the size of the motion; 1e-6 where not given, and for time-stepping not
        less than 30 h / period, or 30 times its own tolerance

    Raises
    ------
    ValueError   a number is out of range, or the scene has no period
    """
    window, longest = checks.count("window", window), checks.count("longest", longest)
    if 2 * longest > window:
        raise ValueError(f"longest: expected at most half of window = {window}, got {longest}")
    transient = int(checks.number("transient", transient, least=0))
    if tolerance is None:
        tolerance = TOLERANCE
        if isinstance(method, Moreau):
            own = method.h / scene.period if method.tolerance is None else method.tolerance
            tolerance = max(tolerance, STEPS_APART * own)
    tolerance = checks.positive("tolerance", tolerance)
    runs = periods(scene, method, starts, transient + window, drop=transient, phase=phase, strict=True)
    P = PeriodMap(scene, method, phase)
    label = np.full(len(runs.status), -1)
    found: list[Attractor] = []
    for i in np.flatnonzero(runs.status == Status.DONE):
        states = runs.states[i]
        size = max(float(np.max(np.abs(states))), 1e-300)
        n = return_time(states, longest, tolerance * size)
        same = (k for k, known in enumerate(found) if _same(known, states, n, tolerance * size))
        label[i] = next(same, -1)
        if label[i] < 0:
            label[i] = len(found)
            found.append(_described(P, runs, int(i), n))
    counts = np.bincount(label[label >= 0], minlength=len(found))
    order = np.argsort(-counts, kind="stable")
    rank = np.argsort(order, kind="stable")
    shared = tuple(_with_share(found[k], float(counts[k]) / len(label)) for k in order)
    label = np.where(label >= 0, rank[label] if len(found) else -1, -1)
    settings = {
        "transient": transient,
        "window": window,
        "longest": longest,
        "phase": phase,
        "tolerance": tolerance,
    }
    first = np.array(starts, dtype=float, ndmin=2)
    return Attractors(shared, first, label, settings)


def with_new(known: Attractors, more: Attractors) -> Attractors:
    """The known attractors, and those of another search that are not among them; shares are of each search."""
    tolerance = known.settings["tolerance"]

    def is_known(a: Attractor) -> bool:
        size = max(float(np.max(np.abs(a.points))), 1e-300)
        return any(_same(b, a.points, a.periods, tolerance * size) for b in known.found)

    new = [a for a in more.found if not is_known(a)]
    return replace(known, found=(*known.found, *new))


def random_starts(box: ArrayLike, n: int, seed: int) -> Array:
    """N states drawn uniformly from a box (2, 2 n_q) of lowest and highest ones, (n, 2 n_q)."""
    box = np.asarray(box, dtype=float)
    if box.ndim != 2 or len(box) != 2 or not np.all(box[0] <= box[1]):
        raise ValueError(f"box: expected the lowest and the highest states, got {box.tolist()}")
    return np.random.default_rng(seed).uniform(box[0], box[1], (checks.count("n", n), box.shape[1]))


def return_time(states: Array, longest: int, tolerance: float) -> int:
    """Smallest n with states[k + n] = states[k] within the tolerance for all k, or 0 where there is none."""
    for n in range(1, min(longest, len(states) // 2) + 1):
        if np.max(np.abs(states[n:] - states[:-n])) <= tolerance:
            return n
    return 0


def _described(P: PeriodMap, runs: Periods, i: int, n: int) -> Attractor:
    """What the i-th run has settled to; it returns after n periods if n > 0."""
    states, kept = runs.states[i], n or len(runs.states[i])
    shown = np.isfinite(runs.time[i, -kept:])
    return Attractor(
        periods=n,
        impacts=float(np.sum(runs.impacts[i, -kept:])) / (1 if n else kept),
        landings=float(np.sum(runs.ends[i, -kept:])) / (1 if n else kept),
        points=states[-kept:],
        impact_phase=runs.time[i, -kept:][shown] / P.scene.period % 1.0,
        impact_before=runs.before[i, -kept:][shown],
        impact_after=runs.after[i, -kept:][shown],
        lyapunov=_growth(P, states, n),
    )


def _growth(P: PeriodMap, states: Array, n: int) -> Lyapunov:
    """Largest Lyapunov exponent per period: from the multipliers of a periodic motion, or along an aperiodic one."""
    if n == 0 and isinstance(P.method, EventDriven):
        return lyapunov(P, states[-1], LYAPUNOV_PERIODS)
    if n == 0:  # differences across the impacts of time-stepping say nothing
        return Lyapunov(math.nan, math.nan)
    if not isinstance(P.method, EventDriven):
        return Lyapunov(math.nan, math.nan)
    J = image_and_derivative(P, states[-1], n)[1]
    largest = float(abs(multipliers(J)[0]))
    return Lyapunov(math.log(largest) / n if largest > 0.0 else -math.inf, 0.0)


def _same(known: Attractor, states: Array, n: int, tolerance: float) -> bool:
    """Whether a run has settled to a known attractor."""
    from scipy.spatial import cKDTree

    if known.periods != n:
        return False
    if n:
        return bool(np.any(np.max(np.abs(known.points - states[-1]), axis=1) <= tolerance))
    scale = np.ptp(known.points, axis=0) + 1e-300
    tree = cKDTree(known.points / scale)
    own = np.median(np.asarray(tree.query(known.points / scale, k=2)[0])[:, 1])
    away = np.asarray(tree.query(states / scale)[0])
    return bool(np.mean(away <= NEIGHBOURS * own) >= OVERLAP)


def _with_share(attractor: Attractor, share: float) -> Attractor:
    return replace(attractor, share=share)
