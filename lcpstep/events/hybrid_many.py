"""Many short runs of one system with modes: where each goes, its switches and no more."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian.hybrid import HybridScene
from lcpstep import compiled
from lcpstep.events import dop853
from lcpstep.events import hybrid_loop as loop
from lcpstep.events.hybrid import STATUS, flow, machine, memory, space
from lcpstep.events.hybrid_roots import scan
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
GOAL = 2**62


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
        self.machine, fast = machine(self.scene)
        self.flow = flow(self.scene, method)._replace(max_events=switches)
        n = scene.system.n_x
        self.space, self.scan, self.work, self.tableau = space(n), scan(), dop853.work(n), dop853.tableau()
        self.memory = memory(n, len(self.machine.kind), 0, switches + loop.MAX_STALLED + 2)
        self.count, self.x = np.zeros(loop.N_COUNTERS, dtype=np.int64), np.zeros(loop.N_NUMBERS)
        self.kernel = compiled.compiled(loop.run) if fast else loop.run

    def __call__(self, x0: ArrayLike, mode: str) -> End:
        """The end of the run from x0 (n_x,) in a mode."""
        self.count[:], self.x[:] = 0, 0.0
        self.count[loop.MODE] = self.names.index(mode)
        self.x[loop.LAST_SWITCH], self.x[loop.NEXT] = -math.inf, 1e-3 * self.flow.longest
        self.work.y[:] = x0
        code = self.kernel(
            self.machine, self.flow, self.space, self.scan, self.memory, self.tableau, self.work, self.count, self.x,
            GOAL,
        )  # fmt: skip
        n, log = len(self.work.y), self.memory.log[: self.count[loop.SWITCH]].copy()
        lead = loop.SWITCH_LEAD
        return End(
            STATUS[int(code)], float(self.x[loop.NOW]), self.work.y.copy(), self.names[self.count[loop.MODE]],
            log[:, 0], [self.names[int(k)] for k in log[:, 2]], log[:, lead : lead + n], log[:, lead + n :],
        )  # fmt: skip
