"""What flat contacts meet, bounded in cells of time, as a kernel: a window has the bounds of the cells it meets."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from math import floor

    from lcpstep.arrays import doubles, indices, small_numbers
    from lcpstep.pointers import after, inf, max, min, whole

BINS = 4  # parts of the table for each of its cells, by which a time finds its own
SLACK = 1e-13  # of the table's length: a window that is longer meets all of it


class Cells:
    """Bounds of what flat contacts meet, in cells of time: see `obstacle.Table`.

    bottom, top     the lowest and highest place found for the window last asked for
    slow            its lowest speed;  low, high : its acceleration
    rough           whether it need not have one
    whole_top, whole_low, whole_high, whole_fast, whole_rough   the same of all times, and the largest speed
    whole_bottom, whole_size   of all times: the lowest place, and the largest without its sign

    Parameters
    ----------
    table : obstacle.Table, or None where nothing moves;  n_c : contacts;  period : of the table, or infinite
    """

    def __init__(self, table: Any, n_c: int, period: float) -> None:
        self.given, self.n_c, self.period = table is not None, n_c, period
        nothing = np.zeros((1, 1, n_c, 3))
        self.arrays = (
            (np.ascontiguousarray(table.ends), table.lo, table.hi, table.branched.astype(np.uint8))
            if self.given
            else (np.array([-inf, inf]), nothing, nothing, np.zeros((1, 1), dtype=np.uint8))
        )
        self.n = len(self.arrays[0]) - 1
        self.ends, self.lo = doubles(self.arrays[0]), doubles(self.arrays[1])
        self.hi, self.branched = doubles(self.arrays[2]), small_numbers(self.arrays[3])
        self.n_bins = BINS * self.n
        self.per = self.n_bins / (self.arrays[0][-1] - self.arrays[0][0]) if self.given else 0.0
        self.starts = self.first_cells()
        self.bins = indices(self.starts)
        bottom = self.arrays[1][0, ..., 0].min(axis=0)
        self.bounds = np.concatenate(
            [self.arrays[2][0, ..., 0].max(axis=0), self.arrays[1][0, ..., 2].min(axis=0),
             self.arrays[2][0, ..., 2].max(axis=0),
             np.maximum(-self.arrays[1][0, ..., 1].min(axis=0), self.arrays[2][0, ..., 1].max(axis=0)),
             bottom, np.maximum(-bottom, self.arrays[2][0, ..., 0].max(axis=0))]
        )  # fmt: skip
        self.whole_top = doubles(self.bounds)
        self.whole_low, self.whole_high = after(self.whole_top, n_c), after(self.whole_top, 2 * n_c)
        self.whole_fast = after(self.whole_top, 3 * n_c)
        self.whole_bottom, self.whole_size = after(self.whole_top, 4 * n_c), after(self.whole_top, 5 * n_c)
        self.whole_rough = bool(np.any(self.arrays[3]))
        self.bottom = self.top = self.slow = self.low = self.high = 0.0
        self.rough = False
        self.here = 0  # the cell last found

    def first_cells(self) -> Any:
        """The first cell that each of many equal parts of the table may meet, (n_bins + 1,)."""
        ends = self.arrays[0]
        if not self.given:
            return np.zeros(self.n_bins + 1, dtype=np.intp)
        parts = (ends[1:-1] - ends[0]) * self.per  # as `cell` finds its own, so that rounding is the same
        inner = np.clip(parts.astype(np.intp), 0, self.n_bins - 1)
        return np.searchsorted(inner, np.arange(self.n_bins + 1)).astype(np.intp)

    def find(self, c: int, a: float, b: float) -> None:
        """Bounds over the window [a, b] for contact c."""
        if not self.given:
            return
        if self.period < inf:
            turn = floor(0.5 * (a + b) / self.period) * self.period
            a -= turn
            b -= turn
        n, ends = self.n, self.ends
        if b - a > (1.0 + SLACK) * (ends[n] - ends[0]):
            self.top, self.low, self.high = self.whole_top[c], self.whole_low[c], self.whole_high[c]
            self.bottom, self.slow = self.whole_bottom[c], -inf
            self.rough = True
            return
        i, j = self.cell(a), self.cell(b)
        if j > i and ends[j] >= b:
            j -= 1
        level, size = 0, 1
        while 2 * size <= j - i + 1:
            level += 1
            size *= 2
        k = j - size + 1
        first, second = (level * n + i) * self.n_c + c, (level * n + k) * self.n_c + c
        self.bottom, self.top = (
            min(self.lo[3 * first], self.lo[3 * second]),
            max(self.hi[3 * first], self.hi[3 * second]),
        )
        self.slow = min(self.lo[3 * first + 1], self.lo[3 * second + 1])
        self.low = min(self.lo[3 * first + 2], self.lo[3 * second + 2])
        self.high = max(self.hi[3 * first + 2], self.hi[3 * second + 2])
        self.rough = self.branched[level * n + i] != 0 or self.branched[level * n + k] != 0

    def cell(self, t: float) -> int:
        """The cell in which a time lies, or the next one to it."""
        i = self.here
        if self.ends[i] <= t:
            if i < self.n - 1 and self.ends[i + 1] > t:
                return i
            if i < self.n - 2 and self.ends[i + 2] > t:
                self.here = i + 1
                return i + 1
        i = whole(min(max((t - self.ends[0]) * self.per, 0.0), self.n_bins - 1.0))
        low, high = self.bins[i], self.bins[i + 1]
        while low < high:
            middle = (low + high + 1) // 2
            if self.ends[middle] <= t:
                low = middle
            else:
                high = middle - 1
        self.here = low
        return low
