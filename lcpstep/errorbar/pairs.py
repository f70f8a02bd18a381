"""Impacts of two runs that belong together, and those of contacts that leave no question."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.errorbar.matching import Log, paired, without_doubt

Array = NDArray[np.float64]
Places = NDArray[np.intp]
LATE = 4.0  # times the median difference of partners' times: such partners are asked whether they are some
SLIGHT = 1e-3  # of the time over which impacts fall, that those of a weak pair may be apart to be left out
MARGIN = 4.0  # largest differences of partners' times, by which an impact may fall beyond the end of a run


class Pairs(NamedTuple):
    """Pairs of blows (k,): from the first to the last impact, differences of time and impulse, jumps; whether weak.

    rows : places of their impacts in the first log, and `many` (k,) how many belong to each
    """

    start: Array
    stop: Array
    time: Array
    impulse: Array
    jump: Array
    weak: NDArray[np.bool_]
    rows: Places
    many: Places

    @classmethod
    def none(cls) -> Pairs:
        """No pairs."""
        numbers, places = np.zeros(0), np.zeros(0, dtype=np.intp)
        return cls(numbers, numbers, numbers, numbers, numbers, np.zeros(0, dtype=bool), places, places)

    @classmethod
    def told(cls, numbers: Array, rows: Places, many: Places, weak: float) -> Pairs:
        """From the numbers (k, 5) that kernels tell; jumps up to `weak` are weak."""
        start, stop, time, impulse, jump = np.ascontiguousarray(numbers.T)
        return cls(start, stop, time, impulse, jump, jump <= weak, rows, many)

    @property
    def of_row(self) -> Places:
        """The pair that each of the rows belongs to."""
        return np.repeat(np.arange(len(self.many)), self.many)

    def of(self, chosen: NDArray[np.bool_]) -> Pairs:
        """Some of them."""
        of_row = chosen[self.of_row]
        columns = [x[of_row] if name == "rows" else x[chosen] for name, x in self._asdict().items()]
        return Pairs(*columns)

    def windows(self, resolution: float) -> Array:
        """Times in which one run has struck and the other has not, with as much before and after, (l, 2) [s]."""
        if not len(self.time):
            return np.zeros((0, 2))
        usual = MARGIN * np.max(self.time[~self.weak], initial=resolution)
        near = self.time <= max(usual, SLIGHT * float(np.ptp(self.start)))
        return np.column_stack([self.start - self.time, self.stop + self.time])[~self.weak | near]


def one_to_one(a: Log, b: Log, most: int, weak: float, resolution: float) -> tuple[Pairs, Places]:
    """Pairs of contacts without a doubt, and the other contacts that strike; their numbers are below `most`.

    Such a contact strikes as often in both logs, near in time and alike; no impact follows another within the
    resolution, none is much later than most, and no chattering ends there.
    """
    both, good, late = paired(a, b, most)
    numbers, rows, left = without_doubt(a, b, both, good, LATE * middle(late), weak, resolution)
    return Pairs.told(numbers, rows, np.ones(len(rows), dtype=np.intp), weak), left


def middle(x: Array) -> float:
    """The median, or the larger of two."""
    return float(np.partition(x, len(x) // 2)[len(x) // 2]) if len(x) else 0.0
