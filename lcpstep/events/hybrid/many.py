"""Many short runs of one system with modes: where each goes, its switches and no more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian.hybrid import HybridScene
from lcpstep.events.hybrid.kinds import SWITCH_LEAD
from lcpstep.events.hybrid.loop import Switching
from lcpstep.events.hybrid.run import prepared
from lcpstep.kernels.status import BUFFER_FULL
from lcpstep.pace import Pace
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
SWITCHES = 256  # between two looks at the log
FIRST_STEP = 1e-3  # of the longest
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
        self.motion = prepared(self.scene, method, 0, SWITCHES)
        self.motion.max_events, self.course = switches, Switching(self.motion)

    def __call__(self, x0: ArrayLike, mode: str) -> End:
        """The end of the run from x0 (n_x,) in a mode."""
        s = self.motion
        s.start(0.0, x0, self.names.index(mode))
        s.next_step = FIRST_STEP * s.longest
        pace, logs, code, n = Pace(PORTION, s.n), [], BUFFER_FULL, s.n
        while code == BUFFER_FULL or (code == Status.DONE and s.now < s.t_end):
            code = self.course.advance(pace.goal(s.steps))
            logs.append(s.take()[2])
        log = np.concatenate(logs)
        return End(
            Status(code), s.now, s.state.copy(), self.names[s.mode], log[:, 0],
            [self.names[int(k)] for k in log[:, 2]], log[:, SWITCH_LEAD : SWITCH_LEAD + n], log[:, SWITCH_LEAD + n :],
        )  # fmt: skip
