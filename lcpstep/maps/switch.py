"""The map from one entry into a mode to the next: of a system with modes, driven or not.

A point is the state just after the switch; where the scene has a period, the phase of the forcing in [0, 2 pi) and
the state. With J the derivative of the motion at a fixed time, the derivative of the map is

    DP = J + F+ t_x,      t_x = -(H_x / (H_x F- + H_t)) J-          (J- just before the switch, t_x of its time)

Modes that are left at the instant at which they are entered count for nothing. Source: G. Osorio, Complex Behavior in
Impacting Systems, sections 2.8.2 and 7.3; R. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical
Systems (Springer 2004), chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, checks
from lcpstep.errors import LcpStepError, UnknownName
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.kinds import SWITCH_LEAD
from lcpstep.events.hybrid.machine import machine
from lcpstep.events.hybrid.trajectory import HybridTrajectory, log_of
from lcpstep.maps.modes import told
from lcpstep.maps.phase import NoReturn, bounded, is_driven, limit_of, phase_of, time_of, waits, with_phase
from lcpstep.maps.saltation.switches import Tangent
from lcpstep.refusals import refused
from lcpstep.simulation import simulate
from lcpstep.trajectory import Status

Array = NDArray[np.float64]


class Return(NamedTuple):
    """Where a motion comes back: point, and time from the start on; first and last line of that switch in `log`."""

    point: Array
    duration: float
    run: HybridTrajectory
    log: Array
    first: int
    last: int


@dataclass(frozen=True, eq=False)
class SwitchMap:
    """x -> the point at which the same mode is entered next.

    Parameters
    ----------
    scene : lagrangian.HybridScene; its initial state does not matter
    method : lcpstep.EventDriven
    mode : name of the mode whose entries are looked at
    limit : time to wait for the next one; twenty lengths of the scene's span where not given

    Raises
    ------
    UnknownName   the scene has no such mode
    ValueError   the scene has no modes, or limit is not positive
    """

    scene: HybridScene
    method: EventDriven
    mode: str
    limit: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.scene, HybridScene):
            raise ValueError(
                "scene: expected a lagrangian.HybridScene; for a scene with contacts see ImpactMap"
            )
        if self.mode not in self.scene.system.names:
            raise UnknownName(f"mode of {self.scene.name}", self.mode, self.scene.system.names)
        object.__setattr__(self, "limit", limit_of(self.scene, self.limit))

    @property
    def driven(self) -> bool:
        """Whether points begin with the phase of the forcing."""
        return is_driven(self.scene)

    def __call__(self, x: ArrayLike) -> Array:
        """The next entry; NoReturn where there is none within the limit."""
        return self.next(x).point

    def duration(self, x: ArrayLike) -> float:
        """Time to the next entry: at a fixed point, the period of the orbit."""
        return self.next(x).duration

    def entry(self) -> Array:
        """The first entry into the mode of the scene's own motion: a point to start from."""
        return self._found(self.scene, float(self.scene.t_span[0])).point

    def next(self, x: ArrayLike) -> Return:
        """The next entry with the motion that leads there."""
        x = checks.array("x", x, (self.driven + self.scene.n_x,))
        t = time_of(x[0], self.scene) if self.driven else 0.0
        return self._found(self.scene.started(x[self.driven :], self.mode, (t, t + 1.0)), t)

    def _found(self, scene: HybridScene, t: float) -> Return:
        limit = float(self.limit or 0.0)
        first = min(self.scene.period, self.scene.t_span[1] - self.scene.t_span[0])
        for wait in waits(first, limit):
            one = scene.started(scene.x0, scene.mode, (t, t + wait))
            for method in bounded(self.method):
                run = simulate(one, method, keep="impacts")
                log, index = log_of(run), self.scene.system.names.index(self.mode)
                cut = run.status == Status.TOO_MANY_EVENTS
                for k in np.flatnonzero((log[:, 2] == index) & (log[:, 0] > t)):
                    if (k + 1 == len(log) and not cut) or (k + 1 < len(log) and log[k + 1, 0] > log[k, 0]):
                        return self._return(run, log, int(k), t)
                if not cut:
                    break
            if run.status != Status.DONE:
                raise LcpStepError(
                    f"the motion from x = {np.asarray(scene.x0).tolist()} ended early: {run.message}"
                )
        raise NoReturn(np.asarray(scene.x0), limit, f"entry into mode {self.mode!r}")

    def _return(self, run: HybridTrajectory, log: Array, last: int, t: float) -> Return:
        first = last
        while first > 0 and log[first - 1, 0] == log[last, 0]:
            first -= 1
        point = log[last, SWITCH_LEAD + self.scene.n_x :].copy()
        if self.driven:
            point = np.append(phase_of(log[last, 0], self.scene), point)
        return Return(point, float(log[last, 0] - t), run, log, first, last)

    def jacobian(self, x: ArrayLike) -> Array:
        """DP(x), (d, d)."""
        if self.scene.contacts is not None:
            raise refused("modes-maps", self.scene)
        back, scene, n = self.next(x), self.scene, self.scene.n_x
        t, time, start = (
            float(back.run.pieces.t[0]),
            float(back.log[back.last, 0]),
            np.array(back.run.scene.x0),
        )
        m = machine(back.run.scene)
        s, mode = Tangent(m), scene.system.names.index(self.mode)
        before, after = (
            told(s.along(back.log[:count], mode, t, start, time), scene, s.derivative)
            for count in (back.first, back.last + 1)
        )
        line, end = back.log[back.first], back.log[back.last]
        source, x = int(line[1]), line[SWITCH_LEAD : SWITCH_LEAD + n]
        H_x, H_t = m.guard_slope_at(source, int(line[3]), time, x)
        F, F_start = m.rates_at(source, time, x), m.rates_at(mode, t, start)
        F_after = m.rates_at(mode, time, end[SWITCH_LEAD + n :])
        t_x = -(H_x @ before) / (H_x @ F + H_t)
        DP = after + np.outer(F_after, t_x)
        if not self.driven:
            return np.asarray(DP)
        return with_phase(scene, DP, t_x, float(t_x @ F_start), DP @ F_start)
