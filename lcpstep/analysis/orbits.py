"""Periodic orbits of a scene: by shooting, with their impacts, multipliers, and branches over a parameter.

An orbit O(n, m) closes after n periods of the forcing and has m impacts on the way; of a system with modes, m
switches. Along a branch the impacts
that pass a corner of the forcing are located, and so is the grazing contact at which a branch ends. Source:
G. Osorio, Complex Behavior in Impacting Systems, sections 2.8.2, 3.3.2 and 4.4.2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.continuation import Branch, Special, Steps, continue_point
from lcpstep.analysis.fixed_points import image_and_derivative, multipliers, periodic_point
from lcpstep.analysis.predictor import Progress
from lcpstep.analysis.variation import IMPACTS, PeriodMap
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.maps.batch import Periods
from lcpstep.maps.modes import mode_at
from lcpstep.simulate import Method, fitted, simulate

Array = NDArray[np.float64]
SAMPLES = 64  # of the gap per period, between impacts
REMEMBERED = 32  # maps and motions that are asked for again at once
GRAZING = 1e-2  # a branch that ends with a contact this soft, relative to the others, ends by grazing


@dataclass(frozen=True, eq=False)
class PeriodicOrbit:
    """A motion that repeats after n periods of the forcing.

    Attributes
    ----------
    scene, method, phase : the question; the section is at t = phase x period
    x : (n, 2 n_q)   states (q, v), or (n, n_x), on the section
    time, before, after : (m,)   the impacts: t within the n periods from the section's t on [s], gap velocities
        [m/s]; of a system with modes the switches, with the rates of their guards
    sticks : whether the contact closes for good on the way (chattering, or an impact without rebound); of a system
        with modes, whether it slides
    multipliers : (d,)   largest modulus first; one is zero where a system with modes slides
    residual : max |x after n periods - x|
    """

    scene: Scene | HybridScene
    method: Method
    phase: float
    x: Array
    time: Array
    before: Array
    after: Array
    sticks: bool
    multipliers: NDArray[np.complex128]
    residual: float

    @property
    def periods(self) -> int:
        """Periods of the forcing after which the motion repeats, n."""
        return len(self.x)

    @property
    def name(self) -> str:
        """O(n, m), or O(n, chattering) where infinitely many impacts belong to it."""
        endless = self.sticks and isinstance(self.scene, Scene)
        return f"O({self.periods}, {'chattering' if endless else len(self.time)})"

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return bool(np.all(np.abs(self.multipliers) < 1.0))

    @property
    def phases(self) -> Array:
        """(m,) phases of the impacts in [0, 1), as shares of the period."""
        return self.time / self.scene.period % 1.0

    def corner_distances(self) -> Array:
        """(m, corners) from each corner of the forcing to each impact, as shares of the period in [-1/2, 1/2)."""
        corners = np.asarray(self.scene.corners) / self.scene.period
        return (self.phases[:, None] - corners[None, :] + 0.5) % 1.0 - 0.5

    def run(self) -> Any:
        """The motion over its n periods, from the section on: a Trajectory, or a HybridTrajectory."""
        t_start = self.phase * self.scene.period
        span = (t_start, t_start + self.periods * self.scene.period)
        return simulate(_started(self.scene, self.x[0], span), self.method)

    def clearance(self) -> float:
        """Smallest gap that the free motion turns back from without a contact [m]; infinite where there is none."""
        if isinstance(self.scene, HybridScene):
            return np.inf
        run = self.run()
        start, end = run.scene.t_span
        times = np.linspace(start, end, SAMPLES * self.periods + 1)
        gaps = np.array(
            [self.scene.gap(t, q, v)[0][0] for t, q, v in zip(times, *run.at(times), strict=True)]
        )
        inner = np.flatnonzero((gaps[1:-1] < gaps[:-2]) & (gaps[1:-1] <= gaps[2:])) + 1
        free = [k for k in inner if not np.any((self.time > times[k - 1]) & (self.time < times[k + 1]))]
        return min((self._least_gap(run.at, times[k - 1], times[k + 1]) for k in free), default=np.inf)

    def _least_gap(self, at: Callable[[float], tuple[Array, Array]], a: float, b: float) -> float:
        from scipy.optimize import minimize_scalar

        def gap(t: float) -> float:
            return float(cast(Scene, self.scene).gap(t, *at(t))[0][0])

        return float(
            minimize_scalar(gap, bounds=(a, b), method="bounded", options={"xatol": 1e-9 * (b - a)}).fun
        )


def periodic_orbit(
    scene: Scene | HybridScene, x: ArrayLike, n: int = 1, *, method: Method | None = None, phase: float = 0.0
) -> PeriodicOrbit:
    """The periodic orbit near a guess, stable or not, by Newton's method on the stroboscopic map.

    Parameters
    ----------
    scene : lagrangian.Scene with a period and one contact, or HybridScene with a period
    x : (2 n_q,)   guess of the state (q, v), or (n_x,), at the time phase x period
    n : periods of the forcing after which it repeats
    method : EventDriven() where not given. With Moreau derivatives are made of its impacts where the
        motion between them is known in closed form, and differenced elsewhere.
    phase : of the section, as a share of the period in [0, 1)

    Raises
    ------
    ValueError   a wrong shape, a guess inside of the obstacle
    NotConverged   no orbit near the guess
    """
    P = PeriodMap(scene, method or EventDriven(), phase)
    x = checks.array("x", x, (scene.n_x,))
    return _described(P, periodic_point(P, x, n).points)


def _described(P: PeriodMap, points: Array) -> PeriodicOrbit:
    """The orbit through points that are known to be periodic."""
    n = len(points)
    run = P.follow(points[0], n, most=IMPACTS)
    J = image_and_derivative(P, points[0], n)[1]
    shown = np.isfinite(run.time[0])
    start = np.repeat(np.arange(n), run.time.shape[-1]).reshape(n, -1) * P.scene.period
    return PeriodicOrbit(
        scene=P.scene, method=P.method, phase=P.phase, x=points, time=(run.time[0] + start)[shown],
        before=run.before[0][shown], after=run.after[0][shown], sticks=bool(np.any(run.ends)),
        multipliers=multipliers(J), residual=float(np.max(np.abs(run.states[0, -1] - points[0]))),
    )  # fmt: skip


def _started(scene: Any, x: Array, span: tuple[float, float]) -> Any:
    if isinstance(scene, HybridScene):
        return scene.started(x, mode_at(scene, span[0], x), span)
    return replace(scene, q0=x[: scene.n_q], v0=x[scene.n_q :], t_span=span)


def quiet_phase(orbit: PeriodicOrbit) -> float:
    """The phase that is farthest from every impact of the orbit: a good place for a section."""
    phases = np.sort(orbit.phases)
    if len(phases) == 0:
        return orbit.phase
    pauses = np.diff(np.append(phases, phases[0] + 1.0))
    k = int(np.argmax(pauses))
    return float((phases[k] + 0.5 * pauses[k]) % 1.0)


def moved(orbit: PeriodicOrbit, phase: float) -> PeriodicOrbit:
    """The same orbit seen on a section at another phase."""
    T = orbit.scene.period
    t = orbit.phase * T
    span = (t, t + (phase - orbit.phase) % 1.0 * T)
    if span[1] <= span[0]:
        return orbit
    run = simulate(_started(orbit.scene, orbit.x[0], span), fitted(orbit.method, span), keep=[span[1]])
    x = run.x[-1] if isinstance(run, HybridTrajectory) else np.concatenate([run.q[-1], run.v[-1]])
    return periodic_orbit(orbit.scene, x, orbit.periods, method=orbit.method, phase=phase)


@dataclass(frozen=True, eq=False)
class OrbitBranch:
    """A branch of periodic orbits: the points of `points`, and the orbit at each.

    Attributes
    ----------
    points : Branch   parameter, states on the section, multipliers, special points
    phase : of the section
    orbits : the orbits, in the same order
    special : fold, flip, torus, branch point, jump; and "corner" (an impact at a corner of the forcing) and
        "grazing" (where the branch ends by it)
    """

    points: Branch
    phase: float
    orbits: tuple[PeriodicOrbit, ...]
    special: tuple[Special, ...]


def continue_orbit(
    make: Callable[[float], Scene | HybridScene],
    orbit: PeriodicOrbit,
    p: float,
    p_range: tuple[float, float],
    *,
    steps: Steps | None = None,
    forward: bool = True,
    progress: Progress | None = None,
) -> OrbitBranch:
    """Follow a periodic orbit as a parameter of its scene changes, through folds, stable or not.

    Parameters
    ----------
    make : p -> scene
    orbit : where to start, from `periodic_orbit` at the parameter p
    p, p_range : parameter of the orbit, and the range that the branch must not leave
    steps, forward, progress : see `continue_point`

    Raises
    ------
    ValueError   the range is empty or reversed, or p lies outside of it
    NotConverged   the orbit is none of make(p)

    Notes
    -----
    The section is put where the orbit is farthest from its impacts. A branch whose impacts wander that far that one
    reaches the section ends there.
    """
    start = moved(orbit, quiet_phase(orbit))
    n, method, phase = start.periods, start.method, start.phase

    @lru_cache(maxsize=REMEMBERED)
    def family(value: float) -> PeriodMap:
        return PeriodMap(make(value), method, phase)

    @lru_cache(maxsize=REMEMBERED)
    def followed(value: float, x: tuple[float, ...]) -> Periods:
        return family(value).follow(x, n)

    def monitor(value: float, x: Array) -> dict[str, float]:
        run, scene = followed(value, tuple(x)), family(value).scene
        times = run.time[0][np.isfinite(run.time[0])]
        if np.any(run.ends) or np.size(scene.corners) == 0:
            return {}
        distance = (times[:, None] - np.asarray(scene.corners)[None, :]) / scene.period
        distance = (distance + 0.5) % 1.0 - 0.5
        return {
            f"corner {len(times)} {i} {k}": float(d)
            for i, row in enumerate(distance)
            for k, d in enumerate(row)
        }

    def character(value: float, x: Array) -> int:
        run = followed(value, tuple(x))
        endless = np.any(run.ends) and isinstance(orbit.scene, Scene)
        return -1 if endless else int(np.sum(run.impacts))

    branch = continue_point(
        family,
        start.x[0],
        p,
        p_range,
        n=n,
        steps=steps,
        monitor=monitor,
        character=character,
        forward=forward,
        progress=progress,
    )
    orbits = tuple(
        _described(family(float(value)), followed(float(value), tuple(x)).states[0][np.arange(n) - 1])
        for value, x in zip(branch.p, branch.x, strict=True)
    )
    special = [
        s._replace(kind=s.kind.split(" ")[0] if s.kind.startswith("corner") else s.kind)
        for s in branch.special
    ]
    if branch.ended.startswith("no point") and _grazes(orbits[-1]):
        p_end = _grazing_parameter(orbits[-2:], branch.p[-2:])
        special.append(Special("grazing", p_end, branch.x[-1], branch.multipliers[-1]))
    return OrbitBranch(branch, phase, orbits, tuple(special))


def _grazing_parameter(orbits: tuple[PeriodicOrbit, ...], p: Array) -> float:
    """Where the contact becomes as soft as can be: the clearance, or the square of the lowest speed, is zero.

    Either is linear in the parameter there; continued from the last two orbits of the branch, of which the very
    last is within a smallest step.
    """
    if len(orbits) < 2 or len(orbits[0].time) != len(orbits[1].time):
        return float(p[-1])
    speeds = [float(np.min(np.abs(orbit.before), initial=np.inf)) ** 2 for orbit in orbits]
    first, second = speeds if _soft(orbits[1]) else [orbit.clearance() for orbit in orbits]
    if not (np.isfinite(first) and second < first):
        return float(p[-1])
    return float(p[1] + second * (p[1] - p[0]) / (first - second))


def _soft(orbit: PeriodicOrbit) -> bool:
    """Whether one impact is much softer than the others."""
    speeds = np.abs(orbit.before)
    hardest = float(np.max(speeds, initial=0.0))
    if len(speeds) == 1:  # against the speed of the motion itself
        hardest = float(np.max(np.abs(orbit.x[:, orbit.scene.n_x // 2 :])))
    return len(speeds) > 0 and float(np.min(speeds)) < GRAZING * hardest


def _grazes(orbit: PeriodicOrbit) -> bool:
    """Whether one contact of the orbit is much softer than the others, or is about to appear."""
    if isinstance(orbit.scene, HybridScene):
        return False
    height = float(np.ptp(orbit.x[:, 0])) + abs(float(orbit.x[0, 0]))
    return _soft(orbit) or orbit.clearance() < GRAZING**2 * max(height, 1e-300)
