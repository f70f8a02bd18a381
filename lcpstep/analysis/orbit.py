"""A periodic orbit of a scene: by shooting, with its impacts and multipliers, and on other sections.

An orbit O(n, m) closes after n periods of the forcing and has m impacts on the way; of a system with modes, m
switches. Source: G. Osorio, Complex Behavior in Impacting Systems, sections 2.8.2 and 3.3.2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.fixed_points import image_and_derivative, multipliers, periodic_point
from lcpstep.analysis.variation import IMPACTS, PeriodMap
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.maps.modes import started
from lcpstep.simulation import Method, fitted, simulate

Array = NDArray[np.float64]
SAMPLES = 64  # of the gap per period, between impacts
CLOSED = 1e-12  # a gap below this, relative to the motion, is closed


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
        return simulate(started(self.scene, self.x[0], span), self.method)

    def clearance(self) -> float:
        """Smallest gap that the free motion turns back from without a contact [m]; infinite where there is none."""
        if isinstance(self.scene, HybridScene):
            return np.inf
        run = self.run()
        start, end = run.scene.t_span
        times = np.linspace(start, end, SAMPLES * self.periods + 1)
        gaps = np.array([run.scene.gap(t, q, v)[0] for t, q, v in zip(times, *run.at(times), strict=True)])
        struck = [run.impacts.time[run.impacts.contact == i] for i in range(run.scene.n_c)]
        return min(
            (self._least_gap(run.at, i, a, b) for i, a, b in _lows(times, gaps, struck)), default=np.inf
        )

    def _least_gap(
        self, at: Callable[[float], tuple[Array, Array]], contact: int, a: float, b: float
    ) -> float:
        from scipy.optimize import minimize_scalar

        def gap(t: float) -> float:
            return float(cast(Scene, self.scene).gap(t, *at(t))[0][contact])

        return float(
            minimize_scalar(gap, bounds=(a, b), method="bounded", options={"xatol": 1e-9 * (b - a)}).fun
        )


def _lows(times: Array, gaps: Array, struck: list[Array]) -> list[tuple[int, float, float]]:
    """Contact, and times between which its gap turns back without an impact; the motion is periodic."""
    last, found = len(times) - 1, []
    for i, gap in enumerate(gaps.T):
        lower = (gap < np.append(gap[-2], gap[:-1])) & (gap <= np.append(gap[1:], gap[1]))
        hit = np.unique(
            np.searchsorted(times, struck[i]).clip(1, last)
        )  # numbers of the intervals with impacts
        for k in np.flatnonzero(lower):
            beside = {k or last, k % last + 1}  # the intervals before and after
            if not beside & set(hit.tolist()):
                found.append((i, float(times[max(k - 1, 0)]), float(times[min(k + 1, last)])))
    return found


def periodic_orbit(
    scene: Scene | HybridScene, x: ArrayLike, n: int = 1, *, method: Method | None = None, phase: float = 0.0
) -> PeriodicOrbit:
    """The periodic orbit near a guess, stable or not, by Newton's method on the stroboscopic map.

    Parameters
    ----------
    scene : lagrangian.Scene or HybridScene, with a period
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
    return described(P, periodic_point(P, x, n).points)


def described(P: PeriodMap, points: Array) -> PeriodicOrbit:
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


def quiet_phase(orbit: PeriodicOrbit) -> float:
    """The phase that is farthest from every impact of the orbit, in flight: a good place for a section."""
    phases = orbit.phases
    rests = orbit.sticks and isinstance(orbit.scene, Scene)
    run = orbit.run() if rests else None
    if run is not None:  # a state on the obstacle is inside of it at other values of a parameter
        phases = np.append(phases, run.impacts.time / orbit.scene.period % 1.0)
    phases = np.unique(phases)
    if len(phases) == 0:
        return orbit.phase
    pauses = np.diff(np.append(phases, phases[0] + 1.0))
    middles = (phases + 0.5 * pauses) % 1.0
    if run is not None:
        flies = [_flies(run, (middle - orbit.phase) % 1.0 * orbit.scene.period) for middle in middles]
        pauses = np.where(flies, pauses, 0.0) if np.any(flies) else pauses
    return float(middles[int(np.argmax(pauses))])


def _flies(run: Any, later: float) -> bool:
    """Whether no contact is closed so much later than the start of a run."""
    t = run.t[0] + later
    q, v = run.at(t)
    return bool(np.all(run.scene.gap(t, q, v)[0] > CLOSED * max(1.0, float(np.max(np.abs(run.q))))))


def moved(orbit: PeriodicOrbit, phase: float) -> PeriodicOrbit:
    """The same orbit seen on a section at another phase."""
    T = orbit.scene.period
    t = orbit.phase * T
    span = (t, t + (phase - orbit.phase) % 1.0 * T)
    if span[1] <= span[0]:
        return orbit
    run = simulate(started(orbit.scene, orbit.x[0], span), fitted(orbit.method, span), keep=[span[1]])
    x = run.x[-1] if isinstance(run, HybridTrajectory) else np.concatenate([run.q[-1], run.v[-1]])
    return periodic_orbit(orbit.scene, x, orbit.periods, method=orbit.method, phase=phase)
