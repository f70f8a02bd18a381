"""The impact map: from one impact to the next.

A point is the phase of the forcing in [0, 2 pi) and the gap velocity just before the impact; with several
coordinates the state that has it follows. Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.2.3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.maps.local import Local
from lcpstep.maps.phase import NoReturn, bounded, phase_of, time_of, waits
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
FIRST = 8.0  # periods that are waited at first, by a method that stops after some events


@dataclass(frozen=True, eq=False)
class ImpactMap:
    """x = (phase [rad], gap velocity before the impact [m/s]) -> the same at the next impact.

    Parameters
    ----------
    scene : lagrangian.Scene with a period and one contact
    method : lcpstep.EventDriven or lcpstep.Moreau
    limit : periods to wait for the next impact

    Raises
    ------
    ValueError   the scene has no period, or not just one contact, or limit is not positive

    Notes
    -----
    With more than one coordinate x = (phase, q, v), v just before the impact: 1 + 2 n_q numbers of which those of
    the contact (gap zero) are redundant.
    """

    scene: Scene
    method: Method
    limit: float = 10.0

    def __post_init__(self) -> None:
        if not isinstance(self.scene, Scene):
            raise ValueError(
                "scene: expected a lagrangian.Scene with a contact; for one with modes see SwitchMap"
            )
        if not math.isfinite(self.scene.period):
            raise ValueError(f"scene: {self.scene.name!r} has no period, and so no phase of an impact")
        if self.scene.n_c != 1:
            raise ValueError(f"scene: expected one contact, {self.scene.name!r} has {self.scene.n_c}")
        object.__setattr__(self, "limit", checks.positive("limit", self.limit))

    def __call__(self, x: ArrayLike) -> Array:
        """The next impact after the one at x; NoReturn where there is none within the limit."""
        n_q = self.scene.n_q
        x = checks.array("x", x, (2 if n_q == 1 else 1 + 2 * n_q,))
        t, q, v = self.state(x)
        if not self.scene.gap(t, q, v)[1][0] < 0.0:
            raise ValueError(f"x: expected an impact, a negative gap velocity, got {x.tolist()}")
        # The impact at x is the first event of the run; the one after it is looked for in growing spans. To prepare a
        # run costs more than a few periods of motion
        longest = self.limit * self.scene.period
        stops = isinstance(self.method, EventDriven)
        for wait in waits((FIRST if stops else 1.0) * self.scene.period, longest):
            scene = replace(self.scene, q0=q, v0=v, t_span=(t, t + wait))
            for method in bounded(self.method) if isinstance(self.method, EventDriven) else (self.method,):
                run = simulate(scene, method, keep="impacts")
                hits = np.flatnonzero(run.impacts.kind == Kind.IMPACT)
                cut = run.status == Status.TOO_MANY_EVENTS
                if len(hits) > 1 and not (cut and run.t[-1] <= run.impacts.time[hits[1]]):
                    return self._point(run, int(hits[1]))
                if not cut:
                    break
            if run.status != Status.DONE:
                raise LcpStepError(f"the motion from x = {x.tolist()} ended early: {run.message}")
        raise NoReturn(x, longest)

    def state(self, x: Array) -> tuple[float, Array, Array]:
        """Time [s], coordinates and velocities just before the impact at x."""
        t = time_of(x[0], self.scene)
        if self.scene.n_q > 1:
            return t, x[1 : 1 + self.scene.n_q], x[1 + self.scene.n_q :]
        q, slope = self._on_surface(t)
        _, u = self.scene.gap(t, q, np.zeros(1))
        return t, q, np.array([(x[1] - u[0]) / slope])

    def _on_surface(self, t: float) -> tuple[Array, float]:
        """The one coordinate at which the gap is zero, and the gap's slope there, by Newton's method."""
        from scipy.optimize import newton

        def gap(q: float) -> float:
            return float(self.scene.gap(t, np.array([q]), np.zeros(1))[0][0])

        def slope(q: float) -> float:
            rest, moving = (self.scene.gap(t, np.array([q]), np.array([v]))[1][0] for v in (0.0, 1.0))
            return float(moving - rest)

        guess = float(np.asarray(self.scene.q0)[0])
        q = newton(gap, guess, fprime=slope, tol=1e-15)
        return np.array([q]), slope(q)

    def _point(self, run: Trajectory, row: int) -> Array:
        event = run.impacts[row]
        phase = phase_of(event.time, self.scene)
        if self.scene.n_q == 1:
            return np.array([phase, event.before])
        kept = int(np.searchsorted(run.t, event.time))
        q, v = run.q[kept], run.v[kept]
        before = Local(self.scene).before_impact(event.time, q, v, event.impulse)
        return np.concatenate([[phase], q, before])
