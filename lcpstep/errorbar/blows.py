"""Impacts of one contact in two logs matched in their order, as a kernel; see `partners`.

A blow is the impacts of a contact without time between them; all numbers of a blow, or of a pair, are a row.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.errorbar.layout import (
    ANOTHER,
    FIRST,
    HARD,
    IMPULSE,
    JUMP,
    LAST,
    LATE_BY,
    OF_BLOW,
    OF_COMPANION,
    OF_PAIR,
    OF_RUN,
    PUSH,
    START,
    STOP,
)
from lcpstep.errorbar.matching import ALIKE, NEAR, Log
from lcpstep.pointers import Doubles, Indices, abs, inf, max, min


def matched(a: Log, b: Log, contact: int, weak: float, resolution: float) -> tuple[Any, Any, Any, Any, Any]:
    """Blows of one contact matched in their order: nearer to each other than half the way to their neighbours.

    Returns
    -------
    numbers (k, OF_PAIR) of the pairs, how many rows of the first log each has (k,), and these rows; time, jump and
    kind (l, 3) of suspects, among which no weak blows are; times of all blows
    """
    blows, others = np.empty((a.n, OF_BLOW)), np.empty((b.n, OF_BLOW))
    found, begun, pairs, left = [np.empty(n, np.intp) for n in (a.n, a.n + 1, a.n + b.n, a.n + b.n)]
    own, of_other, row, begin = doubles(blows), doubles(others), indices(found), indices(begun)
    pair, alone = indices(pairs), indices(left)
    n = join(a, contact, resolution, own, True, row, begin)
    m = join(b, contact, resolution, of_other, False, row, begin)
    k = pair_blows(n, own, m, of_other, resolution, pair, alone)
    numbers, many, doubts = np.empty((k, OF_PAIR)), np.empty(k, np.intp), np.empty((n + m - k, 3))
    number, count, doubt = doubles(numbers), indices(many), doubles(doubts)
    rows = write_matched(k, own, of_other, pair, number, row, begin, count)
    n_doubts = suspect(k, number, own, of_other, pair, n + m - 2 * k, alone, weak, doubt)
    return (
        numbers,
        many,
        found[:rows],
        doubts[:n_doubts],
        np.concatenate([blows[:n, FIRST], others[:m, FIRST]]),
    )


@cython.cfunc
def join(
    log: Log, contact: int, resolution: float, blows: Doubles, noted: bool, rows: Indices, begins: Indices
) -> int:
    """The blows of a contact; `noted`: and the rows of each, from its beginning to that of the next."""
    with cython.nogil:
        n, count, before = 0, 0, -inf
        for k in range(log.n):
            if log.contact[k] != contact or not log.strikes(k):
                continue
            if log.time[k] - before > resolution:
                p = n * OF_BLOW
                blows[p + FIRST], blows[p + HARD], blows[p + PUSH] = log.time[k], 0.0, 0.0
                if noted:
                    begins[n] = count
                n += 1
            p = (n - 1) * OF_BLOW
            before = log.time[k]
            blows[p + LAST] = before
            blows[p + HARD] += log.jump[k]
            blows[p + PUSH] += log.impulse[k]
            if noted:
                rows[count] = k
            count += 1
        if noted:
            begins[n] = count
    return n


def room(n: int, blows: Doubles, k: int, resolution: float) -> float:
    """How far the partner of a blow may be."""
    before = blows[k * OF_BLOW] - blows[(k - 1) * OF_BLOW] if k > 0 else inf
    following = blows[(k + 1) * OF_BLOW] - blows[k * OF_BLOW] if k + 1 < n else inf
    return NEAR * min(before, following) + resolution


@cython.cfunc
def pair_blows(
    n: int, a: Doubles, m: int, b: Doubles, resolution: float, pairs: Indices, alone: Indices
) -> int:
    """Pairs of places, and places of blows that are alone: k in the first log, -1 - k in the other."""
    with cython.nogil:
        i, j, count, left = 0, 0, 0, 0
        while i < n or j < m:
            apart = a[i * OF_BLOW] - b[j * OF_BLOW] if i < n and j < m else 0.0
            both = i < n and j < m
            if both and abs(apart) <= min(room(n, a, i, resolution), room(m, b, j, resolution)):
                pairs[2 * count], pairs[2 * count + 1] = i, j
                count, i, j = count + 1, i + 1, j + 1
            elif j == m or (both and apart < 0.0):
                alone[left] = i
                left, i = left + 1, i + 1
            else:
                alone[left] = -1 - j
                left, j = left + 1, j + 1
    return count


@cython.cfunc
def write_matched(
    k: int, a: Doubles, b: Doubles, pairs: Indices, numbers: Doubles, rows: Indices, begins: Indices, many: Indices
) -> int:  # fmt: skip
    """The numbers of pairs of blows; their rows move to the front, and are counted."""
    with cython.nogil:
        count = 0
        for p in range(k):
            i, j, first = pairs[2 * p] * OF_BLOW, pairs[2 * p + 1] * OF_BLOW, begins[pairs[2 * p]]
            numbers[p * OF_PAIR + START] = min(a[i + FIRST], b[j + FIRST])
            numbers[p * OF_PAIR + STOP] = max(a[i + LAST], b[j + LAST])
            numbers[p * OF_PAIR + LATE_BY] = abs(a[i + FIRST] - b[j + FIRST])
            numbers[p * OF_PAIR + IMPULSE] = abs(a[i + PUSH] - b[j + PUSH])
            numbers[p * OF_PAIR + JUMP] = max(a[i + HARD], b[j + HARD])
            many[p] = begins[pairs[2 * p] + 1] - first
            for r in range(many[p]):
                rows[count + r] = rows[first + r]
            count += many[p]
    return count


@cython.cfunc
def suspect(
    k: int, numbers: Doubles, a: Doubles, b: Doubles, pairs: Indices, left: int, alone: Indices, weak: float,
    doubts: Doubles,
) -> int:  # fmt: skip
    """Pairs that are not alike, and blows that are alone and not weak."""
    with cython.nogil:
        n = 0
        for p in range(k):
            apart = abs(a[pairs[2 * p] * OF_BLOW + HARD] - b[pairs[2 * p + 1] * OF_BLOW + HARD])
            jump = numbers[p * OF_PAIR + JUMP]
            if apart > ALIKE * jump + weak:
                doubts[3 * n], doubts[3 * n + 1], doubts[3 * n + 2] = (
                    numbers[p * OF_PAIR + START],
                    jump,
                    ANOTHER,
                )
                n += 1
        for p in range(left):
            own = alone[p] >= 0
            i = (alone[p] if own else -1 - alone[p]) * OF_BLOW
            time, jump = a[i + FIRST] if own else b[i + FIRST], a[i + HARD] if own else b[i + HARD]
            if jump > weak:
                doubts[3 * n], doubts[3 * n + 1] = time, jump
                doubts[3 * n + 2] = OF_RUN if own else OF_COMPANION
                n += 1
    return n
