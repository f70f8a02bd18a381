"""A kept state of one coordinate with one impulse, `Record.keep`, which the compiler merges into loops over steps.

A call in such a loop would send the motion from the registers to memory.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.record import Record
from lcpstep.pointers import Doubles


def keep_one(record: Record, t: float, length: float, q: float, v: float, impulse: Doubles) -> None:
    """Keep it; length: of the step that follows, 0 where that is not known."""
    k = record.row
    record.t[k], record.q[k], record.v[k] = t, q, v
    if length != 0.0:
        record.length[k] = length
    if impulse[0] != 0.0:
        record.impulse[k], impulse[0] = impulse[0], 0.0
    record.row = k + 1
