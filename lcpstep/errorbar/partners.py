"""Impacts of two runs, matched contact by contact in their order, and the first one on which they disagree.

Impacts of a contact that follow each other faster than the runs resolve count as one blow. Two blows in the same
place of the order are partners if they are nearer to each other than half the way to their neighbours. A blow that
has none is a different event, unless it is weak; partners whose velocity jumps are not alike are different events too
(contacts struck in another order, or at once and one after another).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.errorbar.blows import matched
from lcpstep.errorbar.layout import ALONE, ANOTHER, OF_COMPANION, OF_RUN
from lcpstep.errorbar.matching import Log, summary
from lcpstep.errorbar.pairs import LATE, MARGIN, Array, Pairs, middle, one_to_one
from lcpstep.trajectory import Kind

Alike = Callable[[Array, Array], Array]
Apart = Callable[[Array, Array], NDArray[np.bool_]]
WORDS = {
    ANOTHER: "an impact of another strength",
    OF_RUN: "an impact of the run without partner",
    OF_COMPANION: "an impact of the companion without partner",
    ALONE: "an impact without partner",
}
WEAK = 0.02  # of the largest jump: the error of the motion shows what a weaker impact without partner does
TIME, HARD, WHAT, CONTACT, SINCE = range(5)
"""Numbers of an event that may be another one in the other run: its time [s], jump [m/s], what is wrong, its contact;
when the contact did something else in one of the runs, shortly before, or its time [s]."""


class Partners(NamedTuple):
    """Pairs of blows, and the first different event.

    Attributes
    ----------
    pairs : all pairs, those after the first different event too
    windows : (l, 2)   times in which velocities of the two runs cannot be compared [s]
    differs : time of the first different event, infinite where there is none [s]
    reason : what differs, in words
    """

    pairs: Pairs
    windows: Array
    differs: float
    reason: str


def partners(
    a: Any, b: Any, end: float, resolution: float, still: float = 0.0, alike: Alike | None = None,
    apart: Apart | None = None,
) -> Partners:  # fmt: skip
    """Match two impact logs.

    Parameters
    ----------
    end : up to this time [s]
    resolution : impacts of a contact that are nearer to each other are one [s]
    still : jumps below it are rounding [m/s]
    alike : from when on two runs move alike again after events, given by their times and jumps (k,); nan where they
        do not. Such events do not count as different
    apart : whether two runs have other velocities at times (k,), by more than a share of jumps (k,)
    """
    one, other = Log(a, end), Log(b, end)
    most, largest, chatters = summary(one, other)
    weak = max(WEAK * largest, still)
    plain, contacts = one_to_one(one, other, most, weak, resolution)
    if not len(contacts):
        return Partners(plain, plain.windows(resolution), math.inf, "")
    pairs, suspects, windows = [plain], [], []
    for contact in contacts:
        numbers, many, rows, doubts, struck = matched(one, other, contact, weak, resolution)
        found, alone = _credible(Pairs.told(numbers, rows, many, weak), resolution, apart)
        differing = np.concatenate([doubts, alone])
        margin = MARGIN * float(np.max(found.time, initial=resolution))
        late = differing[:, TIME] >= end - margin
        windows.append(np.column_stack([differing[late, TIME], np.full(np.count_nonzero(late), end)]))
        times, logs = differing[~late, TIME], [_of_contact(x, contact) for x in (one, other)]
        since = _since(times, [t for t, _ in logs], found.stop, margin)
        suspects.append(np.column_stack([differing[~late], np.full(len(times), contact), since]))
        if chatters:
            windows += [_tails(*x, found.start, np.sort(struck), end) for x in logs]
        pairs.append(found)
    all_pairs = Pairs(*(np.concatenate(x) for x in zip(*pairs, strict=True)))
    first, harmless = _first(np.concatenate(suspects), alike)
    windows += [all_pairs.windows(resolution), harmless]
    reason = f"{WORDS[int(first[WHAT])]} at contact {int(first[CONTACT])}" if len(first) else ""
    return Partners(all_pairs, np.concatenate(windows), first[TIME] if len(first) else math.inf, reason)


def _credible(pairs: Pairs, resolution: float, apart: Apart | None) -> tuple[Pairs, Array]:
    """Pairs without those that are no partners, and these impacts (l, 3): between partners one run alone has struck.

    Where velocities are alike between two impacts far from each other, each belongs to one that the other run logged
    at another contact: walls that meet, or two of one surface, may be named in either way.
    """
    nobody = np.zeros((0, 3))
    if apart is None or not len(pairs.time):
        return pairs, nobody
    late = np.flatnonzero((pairs.time > LATE * middle(pairs.time)) & (pairs.time > resolution))
    if not len(late):
        return pairs, nobody
    good = np.ones(len(pairs.time), dtype=bool)
    good[late] = apart((pairs.start + 0.5 * pairs.time)[late], pairs.jump[late])
    if good.all():
        return pairs, nobody
    lost = pairs.of(~good)
    both = np.concatenate([lost.start, lost.start + lost.time])
    return pairs.of(good), np.column_stack([both, np.tile(lost.jump, 2), np.full(len(both), ALONE)])


def _of_contact(log: Log, contact: int) -> tuple[Array, NDArray[np.intp]]:
    """Times and kinds of the lines of one contact."""
    own = log.contacts == contact
    return log.times[own], log.kinds[own]


def _last(x: Array, t: Array, side: Literal["left", "right"]) -> Array:
    """The last of the sorted numbers x before times t; `right`: or at them."""
    return np.append(-math.inf, x)[np.searchsorted(x, t, side)]


def _next(x: Array, t: Array) -> Array:
    """The first of the sorted numbers x after times t."""
    return np.append(x, math.inf)[np.searchsorted(x, t, "right")]


def _since(time: Array, logs: list[Array], stops: Array, margin: float) -> Array:
    """When a contact did something before events without partner, and after its last impact that has one.

    One run may rest where the other strikes once more: their velocities differ from when the first has come to rest.
    """
    after = np.maximum(_last(stops, time, "left"), time - margin)
    return np.minimum(time, np.minimum(*(_next(x, after) for x in logs)))


def _first(suspects: Array, alike: Alike | None) -> tuple[Array, Array]:
    """The first of the events after which the motions differ, and the times from others to where they are alike."""
    suspects = suspects[np.argsort(suspects[:, TIME], kind="stable")]
    again = np.full(len(suspects), math.nan)
    if alike is not None and len(suspects):
        again = alike(np.ascontiguousarray(suspects[:, TIME]), np.ascontiguousarray(suspects[:, HARD]))
    harmless = np.isfinite(again)
    first = suspects[~harmless][:1]
    return first.reshape(-1), np.column_stack([suspects[harmless, SINCE], again[harmless]])


def _tails(times: Array, kinds: NDArray[np.intp], last: Array, struck: Array, end: float) -> Array:
    """From the first impacts of chattering sequences without partner to where the sequences end in one of the runs.

    A sequence begins after the contact has closed, opened or come to rest before.
    """
    stops = times[kinds == Kind.ACCUMULATION]
    since = np.maximum(_last(last, stops, "right"), _last(times[kinds != Kind.IMPACT], stops, "left"))
    return np.column_stack([np.minimum(_next(struck, since), stops), np.minimum(stops, end)])
