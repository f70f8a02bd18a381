"""Impacts of two runs, matched contact by contact in their order, and the first one on which they disagree.

Impacts of a contact that follow each other faster than the runs resolve count as one blow. Two blows in the same
place of the order are partners if they are nearer to each other than half the way to their neighbours. A blow that
has none is a different event, unless it is weak; partners whose velocity jumps are not alike are different events too
(contacts struck in another order, or at once and one after another).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.errorbar.blows import matched
from lcpstep.errorbar.layout import ANOTHER, OF_COMPANION, OF_RUN
from lcpstep.errorbar.matching import Log, summary
from lcpstep.errorbar.pairs import LATE, MARGIN, Array, Pairs, middle, one_to_one
from lcpstep.trajectory import Kind

Alike = Callable[[Array, Array], Array]
Apart = Callable[[Array, Array], NDArray[np.bool_]]
WORDS = {
    ANOTHER: "an impact of another strength",
    OF_RUN: "an impact of the run without partner",
    OF_COMPANION: "an impact of the companion without partner",
}
WEAK = 0.02  # of the largest jump: the error of the motion shows what a weaker impact without partner does


class Suspect(NamedTuple):
    """An event that may be another one in the other run: its time [s], jump [m/s], and what is wrong with it.

    since : when the contact did something else in one of the runs, shortly before; its time where it did not [s]
    """

    time: float
    jump: float
    reason: str
    since: float = math.inf


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
        differing = [Suspect(time, jump, WORDS[int(kind)]) for time, jump, kind in doubts.tolist()] + alone
        margin = MARGIN * float(np.max(found.time, initial=resolution))
        for x in differing:
            if x.time < end - margin:
                since = _since(x.time, (one, other), contact, found.stop, margin)
                suspects.append(x._replace(reason=f"{x.reason} at contact {contact}", since=since))
            else:
                windows.append(np.array([[x.time, end]]))
        if chatters:
            windows.append(_tails((one, other), contact, found.start, struck, end))
        pairs.append(found)
    all_pairs = Pairs(*(np.concatenate(x) for x in zip(*pairs, strict=True)))
    first, harmless = _first(suspects, alike)
    windows += [all_pairs.windows(resolution), harmless]
    return Partners(all_pairs, np.concatenate(windows), first.time, first.reason)


def _credible(pairs: Pairs, resolution: float, apart: Apart | None) -> tuple[Pairs, list[Suspect]]:
    """Pairs without those that are no partners, and these impacts: between partners one run alone has struck.

    Where velocities are alike between two impacts far from each other, each belongs to one that the other run logged
    at another contact: walls that meet, or two of one surface, may be named in either way.
    """
    if apart is None or not len(pairs.time):
        return pairs, []
    late = np.flatnonzero((pairs.time > LATE * middle(pairs.time)) & (pairs.time > resolution))
    if not len(late):
        return pairs, []
    good = np.ones(len(pairs.time), dtype=bool)
    good[late] = apart((pairs.start + 0.5 * pairs.time)[late], pairs.jump[late])
    lost, words = pairs.of(~good), "an impact without partner"
    alone = [
        Suspect(float(t), float(jump), words)
        for x in (lost.start, lost.start + lost.time)
        for t, jump in zip(x, lost.jump, strict=True)
    ]
    return pairs.of(good), alone


def _since(time: float, logs: tuple[Log, Log], contact: int, stops: Array, margin: float) -> float:
    """When a contact did something before an event without partner, and after its last impact that has one.

    One run may rest where the other strikes once more: their velocities differ from when the first has come to rest.
    """
    after = max(float(np.max(stops[stops < time], initial=-math.inf)), time - margin)
    near = [x.times[(x.contacts == contact) & (x.times > after) & (x.times <= time)] for x in logs]
    return float(min(np.min(x, initial=time) for x in near))


def _first(suspects: list[Suspect], alike: Alike | None) -> tuple[Suspect, Array]:
    """The first of the events after which the motions differ, and the times from others to where they are alike."""
    if not suspects:
        return Suspect(math.inf, 0.0, ""), np.zeros((0, 2))
    suspects = sorted(suspects, key=lambda x: x.time)
    again = np.full(len(suspects), math.nan)
    if alike is not None:
        again = alike(*(np.array([getattr(x, name) for x in suspects]) for name in ("time", "jump")))
    harmful = [x for x, time in zip(suspects, again, strict=True) if not math.isfinite(time)]
    harmless = [(x.since, time) for x, time in zip(suspects, again, strict=True) if math.isfinite(time)]
    first = harmful[0] if harmful else Suspect(math.inf, 0.0, "")
    return first, np.array(harmless).reshape(-1, 2)


def _tails(logs: tuple[Log, Log], contact: int, last: Array, struck: Array, end: float) -> Array:
    """From the first impacts of chattering sequences without partner to where the sequences end in both runs.

    A sequence begins after the contact has closed, opened or come to rest before.
    """
    found = []
    for log in logs:
        own = log.contacts == contact
        turns = log.times[own & (log.kinds != Kind.IMPACT)]
        for stop in log.times[own & (log.kinds == Kind.ACCUMULATION)]:
            since = max(np.max(x, initial=-math.inf) for x in (last[last <= stop], turns[turns < stop]))
            found.append((np.min(struck[(struck > since) & (struck <= stop)], initial=stop), min(stop, end)))
    return np.array(found).reshape(-1, 2)
