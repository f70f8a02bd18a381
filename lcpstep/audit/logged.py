"""What the log says of kept states and the pieces between them, as kernels: both are in the order of time."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, small_numbers
from lcpstep.pointers import Doubles, Flags, inf, min, whole
from lcpstep.trajectory import Kind

IMPACT, STICK = float(Kind.IMPACT), float(Kind.STICK)
ACCUMULATION, RELEASE = float(Kind.ACCUMULATION), float(Kind.RELEASE)


@cython.ccall
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


@cython.ccall
def close(t: Any, time: Any, contact: Any, kind: Any, rate: Any, closed: Any) -> None:
    """Mark pieces (m, n_c) in which a contact is closed: from sticking, or the last impact of a series, to a release.

    Arguments as of `mark`; rate : (n,)   of the gap after the event;  called from Python
    """
    n, n_events, n_c = len(t) - 1, len(time), closed.shape[1]
    space = np.zeros((2, n_c))
    at, when, which, what, opens = doubles(t), doubles(time), doubles(contact), doubles(kind), doubles(rate)
    since, last, marks = doubles(space[0]), doubles(space[1]), small_numbers(closed)
    with cython.nogil:
        for c in range(n_c):
            since[c], last[c] = inf, at[0]
        for i in range(n_events):
            c = whole(which[i])
            if what[i] == ACCUMULATION:
                since[c] = min(since[c], last[c])
            elif what[i] == STICK:
                since[c] = min(since[c], when[i])
            elif what[i] == RELEASE or (what[i] == IMPACT and opens[i] > 0.0):
                between(at, n, n_c, c, since[c], when[i], marks)
                since[c] = inf
            if what[i] == IMPACT:
                last[c] = when[i]
        for c in range(n_c):
            between(at, n, n_c, c, since[c], inf, marks)


def between(t: Doubles, n: int, n_c: int, c: int, start: float, end: float, marks: Flags) -> None:
    """Mark the pieces of contact c whose middles lie between two times, and that in which the contact opens: steps
    hold it to their end.
    """
    if not start < inf:
        return
    low, high = 0, n
    while low < high:
        middle = (low + high) // 2
        if 0.5 * (t[middle] + t[middle + 1]) < start:
            low = middle + 1
        else:
            high = middle
    while low < n and t[low] < end:
        marks[low * n_c + c] = 1
        low += 1
