"""Impacts of two runs that belong together, and those of contacts that leave no question."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.trajectory import Kind

Array = NDArray[np.float64]
Places = NDArray[np.intp]
ALIKE = 0.5  # of the larger jump, by which those of partners may differ
NEAR = 0.5  # of the time to the next impact of the contact
LATE = 4.0  # times the median difference of partners' times: such partners are asked whether they are some
SLIGHT = 1e-3  # of the time over which impacts fall, that those of a weak pair may be apart to be left out
MARGIN = 4.0  # largest differences of partners' times, by which an impact may fall beyond the end of a run


@dataclass(frozen=True, eq=False)
class Blows:
    """Impacts of one contact, those without time between them as one.

    Attributes
    ----------
    first, last : (n,)   times of the first and the last impact of each [s]
    jump, impulse : (n,)   sums of the jumps of the gap velocity [m/s], and of the impulses [N s]
    rows : places of the impacts in the log, and `count` (n,) how many each has
    """

    first: Array
    last: Array
    jump: Array
    impulse: Array
    rows: Places
    count: Places


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
    def joined(cls, a: Blows, b: Blows, i: Places, j: Places, weak: float) -> Pairs:
        """The blows i of one run and j of the other."""
        chosen = np.isin(np.repeat(np.arange(len(a.count)), a.count), i)
        jump = np.maximum(a.jump[i], b.jump[j])
        return cls(
            np.minimum(a.first[i], b.first[j]), np.maximum(a.last[i], b.last[j]), np.abs(a.first[i] - b.first[j]),
            np.abs(a.impulse[i] - b.impulse[j]), jump, jump <= weak, a.rows[chosen], a.count[i],
        )  # fmt: skip

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
        usual = MARGIN * np.max(self.time[~self.weak], initial=resolution)
        near = self.time <= max(usual, SLIGHT * float(np.ptp(self.start)) if len(self.start) else 0.0)
        return np.column_stack([self.start - self.time, self.stop + self.time])[~self.weak | near]


def one_to_one(
    logs: tuple[Any, Any], struck: list[Places], jumps: list[Array], weak: float, resolution: float
) -> tuple[Pairs, Places]:
    """Pairs of contacts without a doubt, and the other contacts that strike.

    Such a contact strikes as often in both logs, near in time and alike; no impact follows another within the
    resolution, none is much later than most, and no chattering ends there.
    """
    contacts = [log["contact"][k] for log, k in zip(logs, struck, strict=True)]
    most = 1 + max(
        (int(c.max(initial=-1)) for c in (*contacts, *(log["contact"] for log in logs))), default=0
    )
    often = [np.bincount(c, minlength=most) for c in contacts]
    good = often[0] == often[1]
    for log in logs:
        good[log["contact"][log["kind"] == Kind.ACCUMULATION]] = False
    i, j = (k[good[c]] for k, c in zip(struck, contacts, strict=True))
    i, j = (k[np.argsort(log["contact"][k], kind="stable")] for log, k in zip(logs, (i, j), strict=True))
    contact, time, other = logs[0]["contact"][i], logs[0]["time"][i], logs[1]["time"][j]
    late, jump = np.abs(time - other), np.maximum(jumps[0][i], jumps[1][j])
    before, after = _room(contact, time, other)
    wrong = np.abs(jumps[0][i] - jumps[1][j]) > ALIKE * jump + weak
    wrong |= (late > NEAR * np.minimum(before, after) + resolution) | (before <= resolution)
    wrong |= late > max(LATE * middle(late), resolution)
    good[contact[wrong]] = False
    some = good[contact]
    i, j, time, other, late, jump = (x[some] for x in (i, j, time, other, late, jump))
    impulse = np.abs(logs[0]["impulse"][i] - logs[1]["impulse"][j])
    start, stop = np.minimum(time, other), np.maximum(time, other)
    found = Pairs(start, stop, late, impulse, jump, jump <= weak, i, np.ones(len(i), dtype=np.intp))
    return found, np.flatnonzero((often[0] + often[1] > 0) & ~good)


def _room(contact: Places, time: Array, other: Array) -> tuple[Array, Array]:
    """How long before and after each impact its contact strikes next, in either run."""
    between = np.minimum(time[1:] - time[:-1], other[1:] - other[:-1])
    between[contact[1:] != contact[:-1]] = math.inf
    nothing = np.full(min(len(time), 1), math.inf)
    return np.concatenate([nothing, between]), np.concatenate([between, nothing])


def middle(x: Array) -> float:
    """The median, or the larger of two."""
    return float(np.sort(x)[len(x) // 2]) if len(x) else 0.0
