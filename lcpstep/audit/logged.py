"""Which kept states are events of the log, as a kernel: both in the order of time, passed through once."""

from __future__ import annotations

from typing import Any

import cython

from lcpstep.trajectory import Kind

if not cython.compiled:
    from lcpstep.arrays import doubles, small_numbers
    from lcpstep.pointers import whole

IMPACT = float(Kind.IMPACT)


def mark(t: Any, time: Any, contact: Any, kind: Any, touched: Any, between: Any) -> None:
    """Mark states (m + 1, n_c) at which a contact has an event, and pieces (m,) within which an impact lies.

    t : (m + 1,)   of the states;  time, contact, kind : (n,)   of the events, as float64;  called from Python
    """
    n, n_events, n_c = len(t), len(time), touched.shape[1]
    at, when, which, what = doubles(t), doubles(time), doubles(contact), doubles(kind)
    marks, unknown = small_numbers(touched), small_numbers(between)
    with cython.nogil:
        k = 0
        for i in range(n_events):
            while k < n and at[k] < when[i]:
                k += 1
            j = k
            while j < n and at[j] == when[i]:
                marks[j * n_c + whole(which[i])] = 1
                j += 1
            if j == k and what[i] == IMPACT:
                last = k - 1 if k > 0 else 0
                unknown[last if last < n - 2 else n - 2] = 1
