"""Many short runs of one system with modes: where each goes, its switches and no more."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian.hybrid import HybridScene
from lcpstep import compiled
from lcpstep.events.hybrid import loop
from lcpstep.events.hybrid import state as at
from lcpstep.events.hybrid.run import STATUS, prepared
from lcpstep.pace import Pace
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
PORTION = 65536  # steps between two looks at the outside world, at most


@dataclass(frozen=True, eq=False)
class End:
    """Where a run ended.

    Attributes
    ----------
    status : Status   DONE at the end of the span, TOO_MANY_EVENTS after the last switch allowed
    t, x, mode : the end; the mode by name
    times, modes, before, after : of the switches: (m,), (m,) names entered, (m, n_x) states
    """

    status: Status
    t: float
    x: Array
    mode: str
    times: Array
    modes: list[str]
    before: Array
    after: Array


class Follower:
    """Runs one system from any state for a time or a number of switches, whichever ends first."""

    def __init__(self, scene: HybridScene, method: Any, duration: float, switches: int) -> None:
        from dataclasses import replace

        self.scene = replace(scene, t_span=(0.0, duration), exact=None)
        self.names = scene.system.names
        s, fast = prepared(self.scene, method, 0, switches + loop.MAX_STALLED + 2)
        self.loop = s._replace(flow=s.flow._replace(max_events=switches))
        self.kernel = compiled.compiled(loop.run) if fast else loop.run

    def __call__(self, x0: ArrayLike, mode: str) -> End:
        """The end of the run from x0 (n_x,) in a mode."""
        s = self.loop
        s.count[:], s.x[:] = 0, 0.0
        s.count[at.MODE] = self.names.index(mode)
        s.x[at.LAST_SWITCH], s.x[at.NEXT] = -math.inf, 1e-3 * s.flow.longest
        s.w.y[:] = x0
        pace, code = Pace(PORTION, len(s.w.y)), at.FINISHED
        while code == at.FINISHED and s.x[at.NOW] < s.flow.t_end:
            code = self.kernel(s, pace.goal(int(s.count[at.STEP])))
        n, log = len(s.w.y), s.memory.log[: s.count[at.SWITCH]].copy()
        lead = at.SWITCH_LEAD
        return End(
            STATUS[int(code)], float(s.x[at.NOW]), s.w.y.copy(), self.names[s.count[at.MODE]],
            log[:, 0], [self.names[int(k)] for k in log[:, 2]], log[:, lead : lead + n], log[:, lead + n :],
        )  # fmt: skip
