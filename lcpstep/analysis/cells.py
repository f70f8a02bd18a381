"""Cells of a grid of states, and what the images of their centres say about them.

A cell's image is settled where the cell that it lies in has one label with all its eight neighbours; so labels spread
from cell to cell. What they can spread from is the core: the images of all cells, their images, and so on, as long as
they become fewer. Once the core has its labels, a cell either gets one, or waits for one that will come, or is
blocked for good: its image lies between basins, or at the edge of the grid. Source of the idea: C. S. Hsu,
Cell-to-Cell Mapping (Springer 1987).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
UNKNOWN, OBSTACLE = -1, -2  # labels: no attractor was reached; the cell's centre lies inside of the obstacle
SHRINKING = 0.98  # of the cells that images fall into, from one image to the next, while they become fewer


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells of equal size; cell (i, k) has the number i + n_q k."""

    low: Array
    high: Array
    n_q: int
    n_v: int

    def centres(self, cells: Ints) -> Array:
        """(m, 2) states."""
        share = np.stack([(cells % self.n_q + 0.5) / self.n_q, (cells // self.n_q + 0.5) / self.n_v], axis=1)
        return self.low + share * (self.high - self.low)

    def cell(self, x: Array) -> Ints:
        """Numbers of the cells that states (m, 2) lie in, -1 outside of the grid."""
        place = np.floor((x - self.low) / (self.high - self.low) * (self.n_q, self.n_v))
        within = np.all((place >= 0) & (place < (self.n_q, self.n_v)), axis=1)
        place = np.where(within[:, None], place, 0).astype(np.int64)
        return np.where(within, place[:, 0] + self.n_q * place[:, 1], -1)


def spread(grid: Grid, cells: Ints, landed: NDArray[np.integer[Any]], label: Ints) -> None:
    """Label cells by images that fall into homogeneous neighbourhoods, until nothing changes; label in place.

    landed : (m, k)   numbers of the cells that k images of each of the cells (m,) lie in, -1 outside of the grid
    """
    unlabelled = label[cells] == UNKNOWN
    cells, landed = cells[unlabelled], landed[unlabelled]
    small = label.astype(np.int16)  # a quarter of what has to be read again and again
    while len(cells):
        inner = np.append(homogeneous(small.reshape(grid.n_v, grid.n_q)).ravel(), np.int16(UNKNOWN))
        fate = inner[landed[:, 0]]
        for k in range(1, landed.shape[1]):  # where several images are settled, they are on one attractor
            np.maximum(fate, inner[landed[:, k]], out=fate)
        settled = fate >= 0
        if not np.any(settled):
            return
        label[cells[settled]] = small[cells[settled]] = fate[settled]
        cells, landed = cells[~settled], landed[~settled]


def homogeneous(label: NDArray[Any]) -> NDArray[Any]:
    """The label of cells that share it with their eight neighbours, UNKNOWN elsewhere and at the edge."""
    result = np.full_like(label, UNKNOWN)
    level = (label[:, 1:-1] == label[:, :-2]) & (label[:, 1:-1] == label[:, 2:])
    upright = label[1:-1, 1:-1]
    same = level[1:-1] & level[:-2] & level[2:]
    same &= (upright == label[:-2, 1:-1]) & (upright == label[2:, 1:-1]) & (upright >= 0)
    result[1:-1, 1:-1][same] = upright[same]
    return result


class Cells:
    """All cells of a grid.

    label : (n,)   of each;  x : (n, 2)   last state of a motion from its centre;  landed : (n,)   number of the cell
    that this state lies in, -1 outside of the grid
    """

    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        n = grid.n_q * grid.n_v
        self.label, self.landed = np.full(n, UNKNOWN), np.full(n, -1, dtype=np.int32)
        self.x = grid.centres(np.arange(n))

    def take(self, some: Ints, found: dict[str, Any]) -> None:
        """What has been found of some cells, by the names above; labels alone are those of motions at their end."""
        for name, values in found.items():
            getattr(self, name)[some] = values

    def spread(self) -> None:
        """Label all cells that images settle."""
        left = np.flatnonzero(self.label == UNKNOWN)
        spread(self.grid, left, self.landed[left, None], self.label)

    def core(self) -> Ints:
        """The cells without label that images of images fall into, and neighbours: all that labels depend on."""
        unlabelled = self.label == UNKNOWN
        found, before = np.flatnonzero(unlabelled), np.inf
        while len(found) < SHRINKING * before:
            before, hit = len(found), np.zeros(len(unlabelled) + 1, dtype=bool)
            hit[self.landed[found]] = True
            found = np.flatnonzero(around(self._square(hit[:-1]), np.logical_or).ravel() & unlabelled)
        return found

    def blocked(self, some: Ints) -> Bools:
        """Which of some cells can never be settled: their images lie between basins, or at the edge of the grid."""
        square = self._square(self.label.astype(np.int16))
        beyond = np.iinfo(np.int16).max  # all labels
        lowest = around(np.where(square == UNKNOWN, beyond, square), np.minimum)
        never = (lowest < around(square, np.maximum)) & (lowest < beyond)
        never[[0, -1]] = never[:, [0, -1]] = True
        return np.append(never.ravel(), True)[self.landed[some]]

    def _square(self, x: NDArray[Any]) -> NDArray[Any]:
        return x.reshape(self.grid.n_v, self.grid.n_q)


def around(x: NDArray[Any], merge: Any) -> NDArray[Any]:
    """Each entry of a matrix merged with its eight neighbours."""
    upright = x.copy()
    upright[1:] = merge(upright[1:], x[:-1])
    upright[:-1] = merge(upright[:-1], x[1:])
    result = upright.copy()
    result[:, 1:] = merge(result[:, 1:], upright[:, :-1])
    result[:, :-1] = merge(result[:, :-1], upright[:, 1:])
    return result
