"""States between kept ones where only the run itself knows them: by running it once more.

Steps of order four and those by a tolerance may be long: what interpolates between their ends may be of a lower order
than they are, and knows nothing of where an obstacle goes in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errors import SimulationError, SimulationInterrupted
from lcpstep.recording import Kept

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Again:
    """States at any time, by another run that keeps them; one that ends early, ends in the state q_end, v_end.

    dear : it takes as long as the run
    """

    dear: ClassVar[bool] = True
    method: Any
    scene: Scene
    q_end: Array
    v_end: Array

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times, each (m, n_q)."""
        if len(times) == 0:
            return np.zeros((0, len(self.q_end))), np.zeros((0, len(self.q_end)))
        unique, place = np.unique(times, return_inverse=True)
        past = False

        def look(now: float) -> None:
            nonlocal past
            past = bool(now > unique[-1])
            if past:
                raise KeyboardInterrupt  # nobody asks for what comes

        try:
            m = self.method.run(self.scene, Kept.parse(unique, self.scene.t_span), look)
        except SimulationInterrupted as stopped:
            if not past:
                raise
            m = stopped.trajectory
        except SimulationError as stopped:
            m = stopped.trajectory
        n = len(unique) - len(m.t)  # times as late as the end to rounding, which the run no longer passes
        q = np.vstack([m.q, np.tile(self.q_end, (n, 1))])
        v = np.vstack([m.v, np.tile(self.v_end, (n, 1))])
        return q[place], v[place]
