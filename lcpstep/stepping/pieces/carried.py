"""Linear scenes in a moving frame, as `Located` steps them: in coordinates q + c(t), in which the frame rests."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.record import LEAD, LENGTH, TIME, Record
    from lcpstep.pointers import after

# In place of the duration, which rows of `Located` do not have: the row is in the scene's coordinates
PUT_BACK = 1.0


def put_kept_back(m: Model, record: Record) -> None:
    """The kept states in the coordinates of the scene."""
    n, c = m.n_q, m.frame_now
    for k in range(record.row):
        row = after(record.rows, k * record.row_size)
        if row[LENGTH] == PUT_BACK:
            row[LENGTH] = 0.0
            continue
        q, v = after(row, LEAD), after(row, LEAD + n)
        m.frame.fill(row[TIME], q, v, c)
        for i in range(n):
            q[i] -= c[3 * i]
            v[i] -= c[3 * i + 1]
