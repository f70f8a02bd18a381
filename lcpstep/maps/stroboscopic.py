"""The stroboscopic map: the state one period of the forcing later.

    P(q, v) = state at t_s + T of the motion that has (q, v) at t_s,     t_s = phase T

Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.2.3.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.errors import LcpStepError, SimulationError
from lcpstep.maps.batch import IMPACTS_KEPT, INSIDE, Periods, periodic, periods, section
from lcpstep.maps.one_by_one import continued
from lcpstep.simulation import Method, simulate
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Status

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class StroboscopicMap:
    """x = (q, v) -> its image one period later; of a system with modes, x (n_x,).

    Parameters
    ----------
    scene : lagrangian.Scene, or HybridScene, with a period; its initial state and span do not matter
    method : lcpstep.EventDriven or lcpstep.Moreau. The time grid of the latter starts at the section, and its last
        step is shortened where h does not divide the period.
    phase : of the section, as a share of the period in [0, 1)

    Raises
    ------
    ValueError   the scene has no period, or a wrong one, or phase is out of range

    Examples
    --------
    >>> from lagrangian import scenes
    >>> from lcpstep import EventDriven
    >>> from lcpstep.maps import StroboscopicMap, iterate
    >>> P = StroboscopicMap(scenes.cam_follower(rpm=700.0), EventDriven())
    >>> orbit = iterate(P, [0.4, 0.4], 200)
    """

    scene: Scene | HybridScene
    method: Method
    phase: float = 0.0

    def __post_init__(self) -> None:
        periodic(self.scene)
        object.__setattr__(self, "phase", section(self.phase))

    @property
    def time(self) -> float:
        """Time of the section [s]."""
        return self.phase * self.scene.period

    def __call__(self, x: ArrayLike) -> Array:
        """The image of the state x = (q, v), (2 n_q,); LcpStepError where the motion ends early."""
        return np.asarray(self.follow(x, 1).states[0, -1])

    def follow(
        self, x: ArrayLike, n: int, drop: int = 0, *, most: int = IMPACTS_KEPT, tangents: bool = False
    ) -> Periods:
        """One run of n periods, in full; its states are those of n iterations of the map.

        Raises
        ------
        ValueError   x lies inside of the obstacle, or a number is out of range
        LcpStepError   the motion ended early
        """
        x = checks.array("x", x, (self.scene.n_x,))
        stepped = isinstance(self.method, Moreau)
        run = periods(
            self.scene, self.method, x, n, drop=drop, phase=self.phase, most=most, strict=not stepped,
            tangents=tangents,
        )  # fmt: skip
        if run.status[0] == INSIDE:
            raise ValueError(f"x: {x.tolist()} lies inside of the obstacle at t = {self.time:g} s")
        if run.status[0] != Status.DONE:
            why = self.why(run.final[0], Status(run.status[0]))
            raise LcpStepError(f"the motion from x = {x.tolist()} at t = {self.time:g} s ended early: {why}")
        return run

    def why(self, last: Array, status: Status) -> str:
        """What a run says of the period from the last state on that has ended like this; else how it has."""
        if isinstance(self.scene, HybridScene):
            return status.name
        span = self.time, self.time + self.scene.period
        try:
            run = simulate(continued(self.scene, last, span), self.method, keep=[span[1]])
        except SimulationError as error:
            run = error.trajectory
        return f"{status.name}, {run.message}" if run.status == status else status.name
