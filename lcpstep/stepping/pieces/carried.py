"""Linear scenes in a moving frame, as `Located` steps them: in coordinates q + c(t), in which the frame rests."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.model import Model
from lcpstep.kernels.record import Record
from lcpstep.pointers import after

# In place of the duration, which rows of `Located` do not have: the row is in the scene's coordinates
PUT_BACK = 1.0


def put_kept_back(m: Model, record: Record, first: int, end: int) -> None:
    """The kept states from the first on, up to before the end, in the coordinates of the scene."""
    n, c = m.n_q, m.frame_now
    for k in range(first, end):
        if record.length[k] == PUT_BACK:
            record.length[k] = 0.0
            continue
        q, v = after(record.q, k * n), after(record.v, k * n)
        m.frame.fill(record.t[k], q, v, c)
        for i in range(n):
            q[i] -= c[3 * i]
            v[i] -= c[3 * i + 1]


@cython.ccall
def displaced(m: Model, t: float) -> tuple[Any, Any]:
    """How far those coordinates are from the scene's at time t, and how fast they part; zero if not carried."""
    found, still = np.zeros((m.n_q, 3)), np.zeros(m.n_q)
    if m.carried:
        m.frame.fill(t, doubles(still), doubles(still), doubles(found))
    return found[:, 0], found[:, 1]
