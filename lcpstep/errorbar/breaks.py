"""Times at which runs are looked at, as kernels; `looks` says what for."""

from __future__ import annotations

import math
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.gauss import gauss
from lcpstep.pointers import Doubles

EARLIER, LATER = float(gauss(2)[0][0]), float(gauss(2)[0][1])  # nodes in an interval (0, 1)
NODES = 2


def increasing(*parts: Any, low: float = -math.inf, high: float = math.inf) -> Any:
    """The times of all parts within bounds, each once, in their order."""
    found = np.concatenate(parts)
    found.sort(kind="stable")  # which merges parts that are in order
    count, times = len(found), doubles(found)
    return found[: keep_once(count, times, low, high)]


@cython.cfunc
def keep_once(count: int, times: Doubles, low: float, high: float) -> int:
    """Move different times within bounds to the front, of times in their order: how many there are."""
    with cython.nogil:
        n = 0
        for k in range(count):
            x = times[k]
            if low <= x <= high and (n == 0 or x != times[n - 1]):
                times[n] = x
                n += 1
    return n


def spread(start: float, end: float, n: int, some: Any, halvings: int) -> Any:
    """Times at n even distances from start to end; and between each of `some` (k,) and the next one.

    The latter are the nearer to each other the sooner after it: the interval is halved so often towards it.
    """
    ends = len(some)
    found = np.empty(n + (ends - 1) * halvings)
    out, given = doubles(found), doubles(some)
    fill(start, end, n, given, ends, halvings, out)
    return found


@cython.cfunc
def fill(start: float, end: float, n: int, some: Doubles, ends: int, halvings: int, out: Doubles) -> None:
    """Kernel of `spread`."""
    with cython.nogil:
        for k in range(n):
            out[k] = k * ((end - start) / (n - 1.0)) + start
        out[n - 1] = end
        place = n
        for k in range(ends - 1):
            length = some[k + 1] - some[k]
            for _ in range(halvings):
                length *= 0.5
                out[place] = some[k] + length
                place += 1


def with_nodes(t: Any) -> Any:
    """Times (n,), and after each but the last the nodes between it and the next."""
    n = len(t)
    found = np.empty((1 + NODES) * (n - 1) + 1)
    times, out = doubles(t), doubles(found)
    put_nodes(n, times, out)
    return found


@cython.cfunc
def put_nodes(n: int, t: Doubles, out: Doubles) -> None:
    """Kernel of `with_nodes`."""
    with cython.nogil:
        for k in range(n - 1):
            length = t[k + 1] - t[k]
            out[3 * k], out[3 * k + 1], out[3 * k + 2] = t[k], t[k] + length * EARLIER, t[k] + length * LATER
        out[3 * (n - 1)] = t[n - 1]


def close(t: Any, least: float) -> Any:
    """Intervals between times that follow each other sooner than this, (k, 2)."""
    n, found = len(t), np.empty((len(t), 2))
    times, out = doubles(t), doubles(found)
    return found[: find_close(n, times, least, out)]


@cython.cfunc
def find_close(n: int, t: Doubles, least: float, out: Doubles) -> int:
    """Kernel of `close`."""
    with cython.nogil:
        count = 0
        for k in range(n - 1):
            if t[k + 1] - t[k] < least:
                out[2 * count], out[2 * count + 1] = t[k], t[k + 1]
                count += 1
    return count
