"""Distances of two runs at many times: the largest one until each, and the integral up to it; as a kernel.

Rows are of one time each: n_q positions, n_q velocities and the energy. Times are increasing.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, small_numbers
from lcpstep.pointers import Doubles, Flags, abs, after, inf, max, min

ROUNDING = 4.0  # last digits of what a number is made of
EPS = 2.220446049250313e-16


def curves(
    t: Any, times: Any, one: Any, other: Any, out: Any, covered: Any, even: Any
) -> tuple[Any, Any, Any, float]:
    """Largest distances, integrals (n, 2 n_q + 1) at breaks; their floor (2 n_q + 1,); half the range of positions.

    Parameters
    ----------
    t, times : (n,), (m,)   breaks, and the times at which both runs are known: these, or with two nodes after each
    one, other : q, v (m, n_q) and energies (m,)
    out : (m,) bytes   at which times velocities and energies do not count for the largest ones
    covered : (m,) bytes   where integrals take the velocities and energies of the last time before; (0,) for nowhere
    even : (k,)   breaks between which integrals are at least what these alone tell, for errors at the ends of steps
        may be smaller than within; (0,) for none
    """
    (q, v, e), (q2, v2, e2) = one, other
    n, count, n_q, some = len(t), len(times), q.shape[1], len(covered) > 0
    size, stride, n_even = 2 * n_q + 1, 3 if count > n else 1, len(even)
    apart, largest, integral = np.empty((count, size)), np.empty((n, size)), np.empty((n, size))
    floor, work = np.zeros(size), np.zeros(2 * size)
    a, x, x_t, energy = doubles(apart), doubles(q), doubles(v), doubles(e)
    y, y_t, energy2 = doubles(q2), doubles(v2), doubles(e2)
    at, most, total, least, room = (
        doubles(t),
        doubles(largest),
        doubles(integral),
        doubles(floor),
        doubles(work),
    )
    left_out, hidden, places = small_numbers(out), small_numbers(covered), doubles(even)
    find_differences(n_q, count, x, x_t, energy, y, y_t, energy2, a)
    width = find_floor(n_q, count, x, x_t, energy, max(abs(at[0]), abs(at[n - 1])), room, least)
    find_largest(n_q, count, stride, a, left_out, least, room, most)
    if some:
        cover(n_q, count, hidden, a)
    integrate(n, size, stride, at, a, total)
    if n_even > 1:
        even_out(n, size, stride, at, a, n_even, places, room, total)
    add_floor(n, size, at, least, total)
    return largest, integral, floor, 0.5 * width


@cython.cfunc
def find_differences(
    n: int, count: int, q: Doubles, v: Doubles, e: Doubles, q2: Doubles, v2: Doubles, e2: Doubles, out: Doubles
) -> None:  # fmt: skip
    """How far the runs are apart at each time."""
    with cython.nogil:
        for k in range(count):
            row = after(out, k * (2 * n + 1))
            for i in range(n):
                row[i], row[n + i] = abs(q[k * n + i] - q2[k * n + i]), abs(v[k * n + i] - v2[k * n + i])
            row[2 * n] = abs(e[k] - e2[k])


@cython.cfunc
def find_floor(
    n: int, count: int, q: Doubles, v: Doubles, e: Doubles, latest: float, work: Doubles, out: Doubles
) -> float:
    """Rounding of what the numbers are made of; the range of the coordinate that moves most."""
    widest = 0.0
    with cython.nogil:
        low, high = work, after(work, n)
        for i in range(n):
            low[i], high[i] = inf, -inf
        for k in range(count):
            for i in range(n):
                low[i], high[i] = min(low[i], q[k * n + i]), max(high[i], q[k * n + i])
                out[n + i] = max(out[n + i], abs(v[k * n + i]))
            out[2 * n] = max(out[2 * n], abs(e[k]))
        for i in range(n):
            widest = max(widest, high[i] - low[i])
            out[i] = max(abs(low[i]), abs(high[i])) + latest * out[n + i]
        for i in range(2 * n + 1):
            out[i] *= ROUNDING * EPS
    return widest


def find_largest(
    n: int, count: int, stride: int, apart: Doubles, left_out: Flags, floor: Doubles, most: Doubles, out: Doubles
) -> None:  # fmt: skip
    """The largest distance until each break, no lower than the floor."""
    with cython.nogil:
        size = 2 * n + 1
        for i in range(size):
            most[i] = 0.0
        for k in range(count):
            row = after(apart, k * size)
            for i in range(n if left_out[k] else size):
                if not row[i] <= most[i] and most[i] == most[i]:  # what is not a number stays
                    most[i] = row[i]
            if k % stride == 0:
                for i in range(size):
                    out[k // stride * size + i] = most[i] + floor[i]


def cover(n: int, count: int, hidden: Flags, apart: Doubles) -> None:
    """Velocities and energies of hidden times become those of the last time before; of the first, at the start."""
    with cython.nogil:
        size, last = 2 * n + 1, 0
        while last < count and hidden[last]:
            last += 1
        if last == count:
            last = 0
        for k in range(count):
            if not hidden[k]:
                last = k
            else:
                for i in range(n, size):
                    apart[k * size + i] = apart[last * size + i]


@cython.cfunc
def integrate(n: int, size: int, stride: int, t: Doubles, apart: Doubles, out: Doubles) -> None:
    """Integrals up to each break: by the two nodes before it, or by the breaks where there are none."""
    with cython.nogil:
        first = 1 if stride == 3 else 0
        for i in range(size):
            out[i] = 0.0
        for k in range(n - 1):
            a, b = after(apart, (k * stride + first) * size), after(apart, (k * stride + first + 1) * size)
            for i in range(size):
                out[(k + 1) * size + i] = out[k * size + i] + (t[k + 1] - t[k]) * (0.5 * (a[i] + b[i]))


@cython.cfunc
def even_out(
    n: int, size: int, stride: int, t: Doubles, apart: Doubles, n_even: int, even: Doubles, work: Doubles,
    out: Doubles,
) -> None:  # fmt: skip
    """Add from each even break to the next what these two alone tell more than all breaks between them."""
    with cython.nogil:
        begin, added = work, after(work, size)
        last, e = 0, 0
        for i in range(size):
            added[i] = 0.0
        for k in range(n):
            if e < n_even and t[k] >= even[e]:
                here, there = after(apart, k * stride * size), after(apart, last * stride * size)
                for i in range(size):
                    if e > 0:
                        alone = 0.5 * (even[e] - even[e - 1]) * (here[i] + there[i])
                        added[i] += max(alone - (out[k * size + i] - begin[i]), 0.0)
                    begin[i] = out[k * size + i]
                last, e = k, e + 1
            for i in range(size):
                out[k * size + i] += added[i]


@cython.cfunc
def add_floor(n: int, size: int, t: Doubles, floor: Doubles, out: Doubles) -> None:
    """No integral is below that of the floor."""
    with cython.nogil:
        for k in range(n):
            for i in range(size):
                out[k * size + i] += floor[i] * (t[k] - t[0])


def merged(windows: Any, around: float) -> Any:
    """Intervals with what is around them, those that overlap as one, in their order (k, 2)."""
    found = np.ascontiguousarray(windows[windows[:, 0].argsort(kind="stable")])
    count, some = len(found), doubles(found)
    return found[: merge(count, some, around)]


@cython.cfunc
def merge(count: int, windows: Doubles, around: float) -> int:
    """Kernel of `merged`, in place: how many are left."""
    with cython.nogil:
        n, end = 0, -inf
        for k in range(count):
            start, stop = windows[2 * k] - around, windows[2 * k + 1]
            if k == 0 or start > end + around:
                windows[2 * n] = start
                n += 1
            end = max(end, stop)
            windows[2 * n - 1] = end + around
    return n


def within(intervals: Any, t: Any) -> Any:
    """Whether times lie in intervals (k, 2) that do not overlap, in their order; (m,) of bool."""
    count, n, found = len(intervals), len(t), np.zeros(len(t), dtype=bool)
    some, times, out = doubles(intervals), doubles(t), small_numbers(found)
    find_within(count, some, n, times, out)
    return found


def find_within(count: int, intervals: Doubles, n: int, t: Doubles, out: Flags) -> None:
    """Kernel of `within`."""
    with cython.nogil:
        k = 0
        for j in range(n):
            while k < count and intervals[2 * k + 1] < t[j]:
                k += 1
            out[j] = k < count and intervals[2 * k] <= t[j]


def looked_into(intervals: Any, times: Any, most: int) -> Any:
    """Whether intervals as above have more than so many times in them, (k,) of bool."""
    count, n, found = len(intervals), len(times), np.zeros(len(intervals), dtype=bool)
    some, t, out = doubles(intervals), doubles(times), small_numbers(found)
    find_looks(count, some, n, t, most, out)
    return found


def find_looks(count: int, intervals: Doubles, n: int, t: Doubles, most: int, out: Flags) -> None:
    """Kernel of `looked_into`: times from a beginning on, before the end."""
    with cython.nogil:
        first = 0
        for k in range(count):
            while first < n and t[first] < intervals[2 * k]:
                first += 1
            last = first + most
            out[k] = last < n and t[last] < intervals[2 * k + 1]
