"""Bounds over windows of time of what flat contacts meet: sigma(t) = s(t), and G c(t) of a moving frame as well.

    gap = offset + G y - sigma

Functions of the user are evaluated on intervals. Where there are many windows, bounds are first taken from cells that
divide the span, or a period of a ready scene, by the smallest and largest of those that a window meets.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.audit.cells import Cells
from lcpstep.audit.motion import Bounds
from lcpstep.intervals import Interval, enclose
from lcpstep.intervals.callbacks import plain
from lcpstep.kernels.model import Model
from lcpstep.turns.source import OURS

Array = NDArray[np.float64]
MANY = 2048  # windows, beyond which cells are worth it
LEAST_CELLS, CELLS, MOST_CELLS = 64, 512, 1 << 14
LEVELS, FINER = 6, 8  # how often cells beside releases are divided, and in how many parts
APART = 1e-9  # of the table: releases that are as good as one
PORTION = 1 << 15  # windows at a time
WIDER = 1e-13  # of the times: by how much windows are wider than meant
BESIDE = 1e-11  # of the table: how wide the cells are at both sides of a corner
KICK = 4.0  # times the range of speeds in a cell: to its mean, and on from there, and what is off meanwhile


class Obstacle:
    """What moves by itself, seen by every contact.

    Parameters
    ----------
    scene : Scene;  m : Model;  with_frame : bool   whether the frame's motion is part of it
    cuts : (k,)   times at which it may turn by a corner, in a period or in the span
    """

    def __init__(self, scene: Scene, m: Model, with_frame: bool, cuts: Array) -> None:
        self.scene, self.m, self.n_c, self.G = scene, m, scene.n_c, m.arrays["G"]
        system, contacts = scene.system, scene.contacts
        frame = getattr(system, "frame", None) if with_frame else None
        motion = getattr(contacts, "motion", None)
        self.parts = [(f, name) for f, name in ((frame, "frame"), (motion, "motion")) if f is not None]
        ours = all(f"{getattr(plain(f), '__module__', '')}.".startswith(OURS) for f, _ in self.parts)
        self.period = scene.period if ours and math.isfinite(scene.period) else math.inf
        self.cuts = cuts
        self.table: Table | None = None
        self.state = [np.array(x) for x in (scene.q0, scene.v0, scene.p)]

    @property
    def moves(self) -> bool:
        """Whether there is anything to be bounded."""
        return bool(self.parts)

    def values(self, c: Any, t: Array) -> Array:
        """Sigma of contacts c at times t, each (n,)."""
        total = np.zeros(len(t))
        for _, name in self.parts:
            f = getattr(self.m, name)
            out = np.zeros((len(t), self.n_c if name == "motion" else 1, 3))
            f.sample(np.ascontiguousarray(t), self.state[0], self.state[1], out)
            total += out[np.arange(len(t)), c, 0] if name == "motion" else self.G[c, 0] * out[:, 0, 0]
        return total

    def bounds(self, c: Any, a: Array, b: Array, *, rough: bool) -> tuple[Bounds, NDArray[np.bool_]]:
        """Bounds of sigma of contacts c, and in which windows it need not be smooth; rough: from cells."""
        if math.isfinite(self.period):
            turn = np.floor((0.5 * (a + b)) / self.period) * self.period
            a, b = a - turn, b - turn
        wide = WIDER * np.maximum(np.abs(a), np.abs(b)) if not self.cuts.size else 0.0
        if rough and self.table is not None and len(a) > MANY:
            return self.table.bounds(c, a, b)
        lo, hi, branched = self._direct(a - wide, b + wide)
        rows = np.arange(len(a))
        return _bounds(lo[rows, c], hi[rows, c]), branched

    def cells(self, windows: int) -> Cells:
        """The same for kernels, in cells that are fine enough for so many windows of the span."""
        if self.moves and self.table is None:
            self.table = self._in_cells(self._ends(windows))
        return Cells(self.table, self.n_c, self.period)

    def _direct(self, a: Array, b: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Bounds for every contact, (n, n_c, 3)."""
        lo, hi = np.zeros((2, len(a), self.n_c, 3))
        branched = np.zeros(len(a), dtype=bool)
        for first in range(0, len(a), PORTION):
            at = slice(first, first + PORTION)
            self._add(a[at], b[at], lo[at], hi[at], branched[at])
        return lo, hi, branched

    def _add(self, a: Array, b: Array, lo: Array, hi: Array, branched: Any) -> None:
        q, v, p = self.state
        boxes = [[Interval(np.full(len(a), x), np.full(len(a), x)) for x in y] for y in (q, v)]
        for f, name in self.parts:
            rows = self.n_c if name == "motion" else 1
            found = enclose(f, Interval(a, b), boxes[0], boxes[1], p, (rows, 3))
            branched |= found.branched
            if name == "motion":
                lo += found.lo
                hi += found.hi
            else:
                g = self.G[:, :1]
                scaled = [g * found.lo[:, :1], g * found.hi[:, :1]]
                lo += np.minimum(*scaled)
                hi += np.maximum(*scaled)

    def _ends(self, windows: int) -> Array:
        start, end = (0.0, self.period) if math.isfinite(self.period) else self.scene.t_span
        n = min(CELLS if math.isfinite(self.period) else MOST_CELLS, max(windows // 16, LEAST_CELLS))
        beside = BESIDE * (end - start)
        corners = np.append(self.cuts, (start, end)) if math.isfinite(self.period) else self.cuts
        ends = np.concatenate([np.linspace(start, end, n + 1), corners, corners - beside, corners + beside])
        ends = np.unique(ends)
        return np.asarray(ends[(ends >= start) & (ends <= end)])

    def refine(self, t: Array, windows: int) -> None:
        """Cells that are finer and finer towards these times, unless that makes too many."""
        ends = self._ends(windows)
        if math.isfinite(self.period):
            t = t - np.floor(t / self.period) * self.period
        t = t[np.unique(np.rint(t / (APART * (ends[-1] - ends[0]))), return_index=True)[1]]
        for _ in range(LEVELS):
            met = np.zeros(len(ends) + 1, dtype=bool)  # a cell more at both sides
            met[np.searchsorted(ends[1:-1], t, side="right") + 1] = True
            cells = np.flatnonzero(met[1:-1] | met[2:] | met[:-2])
            if len(ends) + len(cells) * FINER > MOST_CELLS:
                break
            inner = ends[cells, None] + np.diff(ends)[cells, None] * np.arange(1, FINER) / FINER
            ends = np.unique(np.concatenate([ends, inner.ravel()]))
        self.table = self._in_cells(ends)

    def _in_cells(self, ends: Array) -> Table:
        """Where a branch makes no difference to the speed, the motion is smooth: the dwell of a cam."""
        lo, hi, branched = self._direct(ends[:-1], ends[1:])
        branched &= np.any(hi[..., 1] > lo[..., 1], axis=1)
        return Table(ends, lo, hi, branched, self._corners(ends))

    def _corners(self, ends: Array) -> NDArray[np.bool_]:
        """At which ends of cells there may be a corner; those of a period are one, beyond the span there is none."""
        found = np.isin(ends, self.cuts)
        found[0] = found[-1] = math.isfinite(self.period)
        return found


class Table:
    """Bounds in cells, with those of 2, 4, 8, ... neighbours.

    Between its ends e, f the motion may be far from smooth in a cell that holds a branch, or has an end that may be a
    corner. It is off by no more than K min(t - e, f - t) from that with its mean speed there, K being the range of
    speeds, to and from which speeds jump by 2 K in all: in a window [a, b] that is no more than a kick of 4 K, which
    bends by 4 K (t - a) (b - t) / (b - a) at most.

    kicks : (n, n_c)   4 K, or 0 of cells in which the motion is smooth

    Parameters
    ----------
    ends : (n + 1,)   of the cells;  lo, hi : (n, n_c, 3);  branched : (n,);  corners : (n + 1,)   of the ends
    """

    def __init__(
        self, ends: Array, lo: Array, hi: Array, branched: NDArray[np.bool_], corners: NDArray[np.bool_]
    ) -> None:
        self.ends, at = ends, np.flatnonzero(corners)
        self.kicks = KICK * np.where(branched[:, None], hi[..., 1] - lo[..., 1], 0.0)
        left, right = at - 1, at % len(lo)  # before the first end lies the last cell
        jump = KICK * (np.maximum(hi[left], hi[right])[..., 1] - np.minimum(lo[left], lo[right])[..., 1])
        np.maximum.at(self.kicks, left, jump)
        np.maximum.at(self.kicks, right, jump)
        self.own = lo, hi, branched

    @functools.cached_property
    def levels(self) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Bounds of 1, 2, 4, ... neighbours together."""
        levels = [self.own]
        while len(self.own[0]) >= 2 ** len(levels):
            step = 2 ** (len(levels) - 1)
            lo, hi, branched = levels[-1]
            later = np.minimum(np.arange(len(lo)) + step, len(lo) - 1)
            levels.append((np.minimum(lo, lo[later]), np.maximum(hi, hi[later]), branched | branched[later]))
        lo, hi, branched = (np.stack(x) for x in zip(*levels, strict=True))
        return lo, hi, branched

    def bounds(self, c: Any, a: Array, b: Array) -> tuple[Bounds, NDArray[np.bool_]]:
        """Bounds over windows, from the cells that they meet."""
        last = len(self.ends) - 2
        i = np.clip(np.searchsorted(self.ends, a, side="right") - 1, 0, last)
        j = np.clip(np.searchsorted(self.ends, b, side="left") - 1, i, last)
        level = np.frexp((j - i + 1).astype(float))[1] - 1
        k = j - 2**level + 1
        lo, hi, branched = self.levels
        return _bounds(
            np.minimum(lo[level, i, c], lo[level, k, c]), np.maximum(hi[level, i, c], hi[level, k, c])
        ), branched[level, i] | branched[level, k]


def _bounds(lo: Array, hi: Array) -> Bounds:
    return Bounds(*[Interval(lo[:, i], hi[:, i]) for i in range(3)])
