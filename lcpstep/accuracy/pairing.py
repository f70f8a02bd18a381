"""The recursion of `matching`: the best pairing of two increasing sequences of times, as a kernel."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices, small_numbers
from lcpstep.pointers import Doubles, Flags, Indices, abs

NEITHER, PAIR, SKIP = 0, 1, 2  # where a cell's value comes from: drop a's last, pair both, drop b's last


def pair_up(a: Any, b: Any, within: float, low: Any, high: Any, cells: Any) -> Any:
    """Index of the partner in b of every time of a, -1 for none.

    a, b : (n,), (m,) increasing;  low, high : (n,) partners of a[i] lie in b[low[i]:high[i]], at most `within` away
    cells : (n + 1,) where the cells of each row of the table begin
    """
    n, m = len(a), len(b)
    origin = np.zeros(cells[n], dtype=np.uint8)
    row, before, partner = np.zeros(m + 1), np.zeros(m + 1), np.full(n, -1, dtype=np.intp)
    fill_partners(
        doubles(a), n, doubles(b), m, within, indices(low), indices(high), indices(cells), small_numbers(origin),
        doubles(row), doubles(before), indices(partner),
    )  # fmt: skip
    return partner


def fill_partners(
    a: Doubles,
    n: int,
    b: Doubles,
    m: int,
    within: float,
    low: Indices,
    high: Indices,
    cells: Indices,
    origin: Flags,
    row: Doubles,
    before: Doubles,
    partner: Indices,
) -> None:
    """Best pairing of a[:i + 1] with b[:j] for low[i] <= j <= high[i], then back along the best path."""
    end = 0  # beyond this j the row before has one value
    for i in range(n):
        for j in range(low[i], high[i] + 1):
            # dropping a[i], pairing it with b[j - 1], or dropping b[j - 1]
            best, choice = before[j if j < end else end], NEITHER
            if j > low[i]:
                paired = before[j - 1 if j - 1 < end else end] + within - abs(a[i] - b[j - 1])
                if paired > best:
                    best, choice = paired, PAIR
                if row[j - 1] > best:
                    best, choice = row[j - 1], SKIP
            row[j] = best
            origin[cells[i] + j - low[i]] = choice
        for j in range(low[i], high[i] + 1):
            before[j] = row[j]
        end = high[i]
    j = m
    for i in range(n - 1, -1, -1):
        j = j if j < high[i] else high[i]
        while j >= low[i] and origin[cells[i] + j - low[i]] == SKIP:
            j -= 1
        if j >= low[i] and origin[cells[i] + j - low[i]] == PAIR:
            partner[i] = j - 1
            j -= 1
