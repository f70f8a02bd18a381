"""What flat contacts meet, bounded in cells of time, as a kernel: a window has the bounds of the cells it meets."""

from __future__ import annotations

from math import floor
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles, indices
from lcpstep.pointers import Doubles, after, inf, max, min, whole

BINS = 4  # parts of the table for each of its cells, by which a time finds its own
NEXT = 4  # cells in a row that are looked at first
KINDS = 7  # numbers of a cell, see `packed`
SLACK = 1e-13  # of the table's length: a window that is longer meets all of it


class Cells:
    """Bounds of what flat contacts meet, in cells of time: see `obstacle.Table`; what repeats is there twice.

    bottom, top     the lowest and highest place found for the window last asked for
    slow            its lowest speed;  low, high : its acceleration, but where its speed jumps
    kick            what jumps of its speed come to, see `obstacle.Table`; infinite of windows longer than the table
    rough           whether there may be any but at corners
    whole_top, whole_low, whole_high, whole_fast, whole_kick   the same of all times, and the largest speed
    whole_bottom, whole_size, whole_rough   of all times: the lowest place, the largest without its sign, and `rough`

    Parameters
    ----------
    table : obstacle.Table, or None where nothing moves;  n_c : contacts;  period : of the table, or infinite
    """

    def __init__(self, table: Any, n_c: int, period: float) -> None:
        self.given, self.n_c, self.period = table is not None, n_c, period
        own = packed(table) if self.given else np.zeros((1, n_c, KINDS))
        ends = table.ends if self.given else np.array([-inf, inf])
        self.length = float(ends[-1] - ends[0])
        bottom, slow, low, top, high, rough, kick = np.moveaxis(own, 2, 0)
        fast = np.maximum(slow, table.own[1][..., 1] if self.given else 0.0)
        self.bounds = np.concatenate(
            [top.max(axis=0), -low.max(axis=0), high.max(axis=0), fast.max(axis=0), -bottom.max(axis=0),
             np.maximum(bottom, top).max(axis=0), kick.sum(axis=0)]
        )  # fmt: skip
        self.whole_top = doubles(self.bounds)
        self.whole_low, self.whole_high = after(self.whole_top, n_c), after(self.whole_top, 2 * n_c)
        self.whole_fast = after(self.whole_top, 3 * n_c)
        self.whole_bottom, self.whole_size = after(self.whole_top, 4 * n_c), after(self.whole_top, 5 * n_c)
        self.whole_kick, self.whole_rough = after(self.whole_top, 6 * n_c), bool(np.any(rough))
        if period < inf:
            ends, own = np.append(ends, ends[1:] + self.length), np.concatenate([own, own])
        self.arrays = np.ascontiguousarray(ends), together(own)
        self.ends, self.levels, self.n = doubles(self.arrays[0]), doubles(self.arrays[1]), len(own)
        self.n_bins = BINS * self.n
        self.per = self.n_bins / (ends[-1] - ends[0]) if self.given else 0.0
        self.starts = first_cells(ends, self.per, self.n_bins)
        self.bins = indices(self.starts)
        self.bottom = self.top = self.slow = self.low = self.high = self.kick = self.turn = 0.0
        self.rough, self.here = False, 0  # the latter: the cell last found

    def find(self, c: int, a: float, b: float) -> None:
        """Bounds over the window [a, b] for contact c."""
        if not self.given:
            return
        if not b - a <= (1.0 + SLACK) * self.length:
            self.top, self.low, self.high = self.whole_top[c], self.whole_low[c], self.whole_high[c]
            self.bottom, self.slow = self.whole_bottom[c], -inf
            self.kick, self.rough = inf, True
            return
        if self.period < inf:
            if not self.turn <= a < self.turn + self.period:
                self.turn = floor(a / self.period) * self.period
            a -= self.turn
            b -= self.turn
        i = self.here = self.cell(a, self.here)
        j = self.cell(b, i)
        if j > i and self.ends[j] >= b:
            j -= 1
        level, size = 0, 1
        while 2 * size <= j - i + 1:
            level += 1
            size *= 2
        x = after(self.levels, KINDS * ((level * self.n + i) * self.n_c + c))
        self.bottom, self.slow, self.low = -x[0], -x[1], -x[2]
        self.top, self.high, self.rough, self.kick = x[3], x[4], x[5] != 0.0, x[6]
        if j - size + 1 > i:
            x = after(self.levels, KINDS * ((level * self.n + j - size + 1) * self.n_c + c))
            self.bottom, self.top = min(self.bottom, -x[0]), max(self.top, x[3])
            self.slow, self.low = min(self.slow, -x[1]), min(self.low, -x[2])
            self.high, self.kick = max(self.high, x[4]), self.kick + x[6]
            self.rough = self.rough or x[5] != 0.0

    def cell(self, t: float, i: int) -> int:
        """The cell in which a time lies, or the next one to it; sought from the cell i on."""
        if self.ends[i] <= t:
            for _ in range(NEXT):
                if i == self.n - 1 or t < self.ends[i + 1]:
                    return i
                i += 1
        k = whole(min(max((t - self.ends[0]) * self.per, 0.0), self.n_bins - 1.0))
        low, high = self.bins[k], self.bins[k + 1]
        while low < high:
            middle = (low + high + 1) // 2
            if self.ends[middle] <= t:
                low = middle
            else:
                high = middle - 1
        return low


def packed(table: Any) -> Any:
    """Of every cell the lowest place, speed and acceleration times -1, the highest place and acceleration, whether
    it is rough, and its kick, (n, n_c, KINDS).

    Where there is a kick, accelerations may as well be zero.
    """
    lo, hi, branched = table.own
    kicks = table.kicks
    low = np.where(kicks > 0.0, np.minimum(lo[..., 2], 0.0), lo[..., 2])
    high = np.where(kicks > 0.0, np.maximum(hi[..., 2], 0.0), hi[..., 2])
    rough = np.broadcast_to(branched[:, None], kicks.shape)
    return np.stack([-lo[..., 0], -lo[..., 1], -low, hi[..., 0], high, rough, kicks], axis=2)


@cython.cfunc
def together(own: Any) -> Any:
    """The same of 1, 2, 4, ... neighbours: the largest of all but the kicks, and the sums of these."""
    found = np.empty((len(own).bit_length(), *own.shape))
    found[0] = own
    n, row, levels, x = len(own), own.shape[1] * KINDS, len(found), doubles(found)
    with cython.nogil:
        for level in range(1, levels):
            fill_level(after(x, (level - 1) * n * row), after(x, level * n * row), n, row, 1 << (level - 1))
    return found


def fill_level(x: Doubles, y: Doubles, n: int, row: int, step: int) -> None:
    """Unite every cell of a level x with that which is a step further."""
    for i in range((n - step) * row):
        y[i] = x[i] + x[i + step * row] if i % KINDS == KINDS - 1 else max(x[i], x[i + step * row])
    for i in range((n - step) * row, n * row):  # no window asks for these
        y[i] = x[i]


def first_cells(ends: Any, per: float, n_bins: int) -> Any:
    """The first cell that each of many equal parts of the table may meet, (n_bins + 1,)."""
    if per == 0.0:
        return np.zeros(n_bins + 1, dtype=np.intp)
    parts = (ends[1:-1] - ends[0]) * per  # as `cell` finds its own, so that rounding is the same
    inner = np.clip(parts.astype(np.intp), 0, n_bins - 1)
    return np.searchsorted(inner, np.arange(n_bins + 1)).astype(np.intp)
