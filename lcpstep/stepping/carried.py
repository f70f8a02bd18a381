"""Linear scenes in a moving frame, as `Located` steps them: in coordinates x = q + c(t), in which the frame rests.

There the frame puts no force on the system; the obstacles move with it instead, and where they are is known exactly
at any time, while the force -(M c'' + C c' + K c) within a step is not. On the cam-follower that is worth a factor
of twenty in the error.
"""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearSystem, Scene
from lcpstep.compiled import call
from lcpstep.model import ABSENT, Model
from lcpstep.recording import LEAD, TIME

Array = NDArray[np.float64]


def at_rest(m: Model, trapezoidal: bool) -> Model:
    """The model in the coordinates in which the frame rests, where its steps allow that."""
    return m._replace(carried=bool(trapezoidal and m.flat and m.frame != ABSENT))


def displaced(scene: Scene, m: Model, t: float) -> tuple[Array, Array]:
    """How far the kernels' coordinates are from the scene's at time t, and how fast they part."""
    out = np.zeros((scene.n_q, 3))
    if m.carried:
        zero, frame = np.zeros(scene.n_q), cast(LinearSystem, scene.system).frame
        assert frame is not None
        frame(t, zero, zero, np.array(scene.p), out)
    return out[:, 0], out[:, 1]


def put_back(m: Any, rows: Any, n: int) -> None:
    """Kernel: the first n kept states in the coordinates of the scene."""
    n_q = len(m.frame_now)
    for row in rows[:n]:
        q, v = row[LEAD : LEAD + n_q], row[LEAD + n_q : LEAD + 2 * n_q]
        call(m.frame, row[TIME], q, v, m.p, m.frame_now)
        for i in range(n_q):
            q[i] -= m.frame_now[i, 0]
            v[i] -= m.frame_now[i, 1]
