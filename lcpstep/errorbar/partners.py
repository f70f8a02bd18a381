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

from lcpstep.errorbar.pairs import ALIKE, LATE, MARGIN, NEAR, Array, Blows, Pairs, Places, middle, one_to_one
from lcpstep.trajectory import Kind

Alike = Callable[[Array, Array], Array]
Apart = Callable[[Array, Array], NDArray[np.bool_]]
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
    a, b = (np.asarray(log) for log in (a, b))  # record arrays look their fields up slowly
    struck = [np.flatnonzero((log["kind"] == Kind.IMPACT) & (log["time"] <= end)) for log in (a, b)]
    jumps = [np.abs(log["after"] - log["before"]) for log in (a, b)]
    largest = max(float(np.max(jump[k], initial=0.0)) for jump, k in zip(jumps, struck, strict=True))
    weak = max(WEAK * largest, still)
    plain, contacts = one_to_one((a, b), struck, jumps, weak, resolution)
    pairs, suspects, windows = [plain], [], [np.zeros((0, 2))]
    for contact in contacts:
        one, other = (
            blows(log, jump, k[log["contact"][k] == contact], resolution)
            for log, jump, k in zip((a, b), jumps, struck, strict=True)
        )
        i, j, differing = matched(one, other, weak, resolution)
        found, alone = _credible(Pairs.joined(one, other, i, j, weak), resolution, apart)
        margin = MARGIN * float(np.max(found.time, initial=resolution))
        times = np.concatenate([log["time"][log["contact"] == contact] for log in (a, b)])
        for x in differing + alone:
            if x.time < end - margin:
                since = _since(x.time, times, found.stop, margin)
                suspects.append(x._replace(reason=f"{x.reason} at contact {contact}", since=since))
            else:
                windows.append(np.array([[x.time, end]]))
        windows.append(_tails((a, b), contact, found.start, (one, other), end))
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


def _since(time: float, times: Array, stops: Array, margin: float) -> float:
    """When a contact did something before an event without partner, and after its last impact that has one.

    One run may rest where the other strikes once more: their velocities differ from when the first has come to rest.
    """
    after = float(np.max(stops[stops < time], initial=-math.inf))
    return float(np.min(times[(times > max(after, time - margin)) & (times <= time)], initial=time))


def _first(suspects: list[Suspect], alike: Alike | None) -> tuple[Suspect, Array]:
    """The first of the events after which the motions differ, and the times from others to where they are alike."""
    suspects = sorted(suspects, key=lambda x: x.time)
    again = np.full(len(suspects), math.nan)
    if suspects and alike is not None:
        again = alike(*(np.array([getattr(x, name) for x in suspects]) for name in ("time", "jump")))
    harmful = [x for x, time in zip(suspects, again, strict=True) if not math.isfinite(time)]
    harmless = [(x.since, time) for x, time in zip(suspects, again, strict=True) if math.isfinite(time)]
    first = harmful[0] if harmful else Suspect(math.inf, 0.0, "")
    return first, np.array(harmless).reshape(-1, 2)


def blows(log: Any, jumps: Array, rows: Places, resolution: float) -> Blows:
    """The impacts of a contact, in these rows of a log, joined where they follow each other within the resolution."""
    time = log["time"][rows]
    begins = np.flatnonzero(np.diff(time, prepend=-math.inf) > resolution)
    count = np.diff(begins, append=len(rows))
    if not len(rows):
        return Blows(time, time, time, time, rows, count)
    jump, impulse = (np.add.reduceat(x[rows], begins) for x in (jumps, log["impulse"]))
    return Blows(time[begins], time[begins + count - 1], jump, impulse, rows, count)


def matched(a: Blows, b: Blows, weak: float, resolution: float) -> tuple[Places, Places, list[Suspect]]:
    """Partners of one contact (k,), (k,), and the events that differ."""
    room_a, room_b = (_room(x.first, resolution) for x in (a, b))
    n = min(len(a.first), len(b.first))
    near = np.abs(a.first[:n] - b.first[:n]) <= np.minimum(room_a[:n], room_b[:n])
    i = j = int(np.argmin(np.append(near, False)))
    one, other, alone = list(range(i)), list(range(j)), []
    while i < len(a.first) and j < len(b.first):
        own = a.first[i] < b.first[j]
        if abs(a.first[i] - b.first[j]) <= min(room_a[i], room_b[j]):
            one.append(i)
            other.append(j)
            i, j = i + 1, j + 1
        elif own:
            alone.append((a, i))
            i += 1
        else:
            alone.append((b, j))
            j += 1
    alone += [(a, k) for k in range(i, len(a.first))] + [(b, k) for k in range(j, len(b.first))]
    left, right = (np.array(x, dtype=np.intp) for x in (one, other))
    apart, larger = np.abs(a.jump[left] - b.jump[right]), np.maximum(a.jump[left], b.jump[right])
    times, words = np.minimum(a.first[left], b.first[right]), "an impact of another strength"
    suspects = [
        Suspect(float(times[k]), float(larger[k]), words)
        for k in np.flatnonzero(apart > ALIKE * larger + weak)
    ]
    for x, k in alone:
        if x.jump[k] > weak:
            words = f"an impact of the {'run' if x is a else 'companion'} without partner"
            suspects.append(Suspect(float(x.first[k]), float(x.jump[k]), words))
    return left, right, suspects


def _room(time: Array, resolution: float) -> Array:
    """How far the partner of each impact may be."""
    between = np.diff(time, prepend=-math.inf, append=math.inf)
    return np.asarray(NEAR * np.minimum(between[:-1], between[1:]) + resolution)


def _tails(logs: tuple[Any, Any], contact: int, last: Array, both: tuple[Blows, Blows], end: float) -> Array:
    """From the first impacts of chattering sequences without partner to where the sequences end in both runs.

    A sequence begins after the contact has closed, opened or come to rest before.
    """
    struck, found = np.concatenate([x.first for x in both]), []
    for log in logs:
        own = log[log["contact"] == contact]
        turns = own["time"][own["kind"] != Kind.IMPACT]
        for stop in own["time"][own["kind"] == Kind.ACCUMULATION]:
            since = max(np.max(x, initial=-math.inf) for x in (last[last <= stop], turns[turns < stop]))
            found.append((np.min(struck[(struck > since) & (struck <= stop)], initial=stop), min(stop, end)))
    return np.array(found).reshape(-1, 2)
