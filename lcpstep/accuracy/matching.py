"""Impacts of two motions matched one to one, in their order.

Of all pairings that keep the order and join impacts of one contact at most `within` apart, the one is taken for
which the sum of (within - |time difference|) over its pairs is largest: as many pairs as near to each other as
possible. The textbook recursion over prefixes, restricted to the pairs that are near enough: D. Gusfield,
Algorithms on Strings, Trees, and Sequences (Cambridge 1997), chapter 11.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.accuracy.pairing import pair_up
from lcpstep.trajectory import Kind

Array = NDArray[np.float64]
MOST_CELLS = 200_000_000  # of the recursion's table, one byte each
SHARE = 0.1  # of the mean time between impacts: the default of `within`


@dataclass(frozen=True, eq=False)
class Matching:
    """Pairs of impacts, and how many have no partner.

    Attributes
    ----------
    pairs : (k, 2)   indices into the two impact logs
    time, impulse : (k,)   differences, first minus second [s], [N s]
    extra, missing : impacts of the first without partner, of the second without partner
    within : largest time difference of a pair that was allowed [s]
    """

    pairs: NDArray[np.intp]
    time: Array
    impulse: Array
    extra: int
    missing: int
    within: float

    @property
    def max_time(self) -> float:
        """Largest time difference of a pair; infinite where nothing could be paired, 0 without impacts [s]."""
        return self._largest(self.time)

    @property
    def max_impulse(self) -> float:
        """Largest difference of the impulses of a pair; infinite as above [N s]."""
        return self._largest(self.impulse)

    def _largest(self, x: Array) -> float:
        if len(x) == 0 and self.extra + self.missing > 0:
            return float("inf")
        return float(np.max(np.abs(x), initial=0.0))


def match_impacts(a: Any, b: Any, span: float, within: float | None = None, least: float = 0.0) -> Matching:
    """Match two impact logs.

    Parameters
    ----------
    a, b : impact logs, record arrays of `lcpstep.trajectory.IMPACT_DTYPE`; only impacts proper are looked at
    span : length of the motions [s]
    within : largest time difference of a pair [s]; default: a tenth of the mean time between impacts of b
    least : impacts of a smaller impulse are left out, as those of a chattering sequence that never ends [N s]

    Raises
    ------
    ValueError   `within` is so long that the possible pairs exceed the memory
    """
    chosen = [np.flatnonzero((log["kind"] == Kind.IMPACT) & (log["impulse"] >= least)) for log in (a, b)]
    if within is None:
        within = SHARE * span / max(len(chosen[1]), 1)
    pairs = [np.zeros((0, 2), dtype=np.intp)]
    for contact in np.union1d(a["contact"][chosen[0]], b["contact"][chosen[1]]):
        i, j = (k[log["contact"][k] == contact] for k, log in zip(chosen, (a, b), strict=True))
        found = _in_order(a["time"][i], b["time"][j], within)
        pairs.append(np.column_stack([i[found[:, 0]], j[found[:, 1]]]))
    joined = np.concatenate(pairs)
    i, j = joined[np.argsort(joined[:, 0])].T
    return Matching(
        pairs=np.column_stack([i, j]),
        time=np.asarray(a["time"][i] - b["time"][j]),
        impulse=np.asarray(a["impulse"][i] - b["impulse"][j]),
        extra=len(chosen[0]) - len(i),
        missing=len(chosen[1]) - len(j),
        within=within,
    )


def _in_order(a: Array, b: Array, within: float) -> NDArray[np.intp]:
    """Pairs of two increasing sequences of times, (k, 2)."""
    low = np.searchsorted(b, a - within, side="left")
    high = np.searchsorted(b, a + within, side="right")
    cells = np.concatenate([[0], np.cumsum(high - low + 1)])
    if cells[-1] > MOST_CELLS:
        raise ValueError(
            f"within: {within:g} s allows {cells[-1]} pairs of impacts, more than {MOST_CELLS}; take less"
        )
    partner = pair_up(np.ascontiguousarray(a), np.ascontiguousarray(b), within, low, high, cells)
    i = np.flatnonzero(partner >= 0)
    return np.column_stack([i, partner[i]])
