"""The search for windows of a run that could hold an unnoticed event.

Every flight is divided into windows; those in which the bounds of the gap leave no room for a zero are done, the
others are halved, down to a size at which they are reported. A window with a gap below zero holds an event that the
run has missed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.first import look
from lcpstep.audit.flat import Flat
from lcpstep.audit.limits import AT_EVENT, BESIDE, ERRORS, NEGLIGIBLE
from lcpstep.audit.motion import Oscillation
from lcpstep.audit.pieces import Pieces
from lcpstep.audit.result import Audit, Found, Window
from lcpstep.audit.sampled import sampled
from lcpstep.audit.windows import Seen, Windows, joined, judged
from lcpstep.intervals import NotEnclosed
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
PORTION = 1 << 15  # windows at a time
SMALLEST = 1e-10  # of the scale of times: windows are not halved any more
COARSE = 1e-4  # of it: nor are those that hold nothing below zero and have an end without a certificate
MOST = 16  # windows that one becomes, at most, on average
LEAST = 20_000  # windows that any portion may become
SOON = 500  # windows more than a few of every piece, after which forces are asked how large errors are
CLOSER = 10  # halvings of the window of an event that is to be taken
UNKNOWN = "an impact lies between two kept states, so that the motion between them is not known"
NARROW = "the gap is as small as the error of the motion"
EDGE = "a force of a closed contact, or how fast it slides, is as near to its limit as its error"
FORCE = "the force of a closed contact is looked at by the run alone"
TOO_MANY = "bounds are too wide, and windows would be too many"


@dataclass
class Tally:
    """What has been found so far."""

    certified: float = 0.0
    windows: list[tuple[Windows, Array, str, bool]] = field(default_factory=list)
    found: list[Found] = field(default_factory=list)


def audit(run: Trajectory) -> Audit:
    """What can be shown of a run that has kept every step."""
    if run.scene.n_c == 0 or len(run.t) < 2:
        return Audit(1.0, 0, 0, ())
    p, tally = Pieces(run), Tally()
    clear, whole = look(p), run.scene.n_c * (p.t[-1] - p.t[0])
    if clear.all():
        return Audit(1.0, (count := counted(p, tally)[0]), count, ())
    h = np.diff(p.t)
    k, c = np.nonzero(~clear)
    tally.certified = whole - float(np.sum(h[k]))
    k, c = k[h[k] > 0.0], c[h[k] > 0.0]
    for first in range(0, len(k), PORTION):
        part = slice(first, first + PORTION)
        examine(p, divided(p, k[part], c[part]), tally)
    flights, bad = counted(p, tally)
    windows = tuple(sorted(reported(tally), key=lambda x: (x.start, x.contact)))
    missed = tuple(sorted(set(tally.found), key=lambda x: (x.time, x.contact, x.start)))
    if missed:
        missed = (closer(p, missed[0]), *missed[1:])
    return Audit(min(1.0, tally.certified / whole), flights, flights - bad, windows, missed=missed)


def closer(p: Pieces, x: Found) -> Found:
    """The same event, with its window halved towards where the gap falls to zero."""
    k = min(int(np.searchsorted(p.t, x.start, side="right")) - 1, len(p.t) - 2)
    a, b = x.start, x.time
    if not p.t[k] <= a < b <= p.t[k + 1] or p.closed[k, x.contact]:
        return x
    for _ in range(CLOSER):
        middle = 0.5 * (a + b)
        if p.problem.looked(np.array([k]), np.array([x.contact]), np.array([middle]))[0][0] > 0.0:
            a = middle
        else:
            b = middle
    return Found(b, x.contact, a)


def divided(p: Pieces, rows: NDArray[np.intp], c: NDArray[np.intp]) -> Windows:
    """Windows of these contacts in these pieces, which end at the cuts."""
    a, b = p.t[rows], p.t[rows + 1]
    low = np.searchsorted(p.cuts, a, side="right")
    parts = np.maximum(np.searchsorted(p.cuts, b, side="left") - low, 0) + 1
    k, c = np.repeat(rows, parts), np.repeat(c, parts)
    number = np.arange(len(k)) - np.repeat(np.cumsum(parts) - parts, parts)
    cuts = np.append(p.cuts, np.inf)
    place = np.repeat(low, parts) + number
    is_first, is_last = number == 0, number == np.repeat(parts, parts) - 1
    start = np.where(is_first, p.t[k], cuts[np.maximum(place - 1, 0)])
    end = np.where(is_last, p.t[k + 1], cuts[np.minimum(place, len(cuts) - 1)])
    touched = p.touched
    return Windows(k, c, start, end, is_first & touched[k, c], is_last & touched[k + 1, c], p.closed[k, c])


def examine(p: Pieces, w: Windows, tally: Tally) -> None:
    """All windows, those of closed contacts apart."""
    unknown = p.unknown[w.k]
    if np.any(unknown):
        lost = w.chosen(unknown)
        tally.windows.append((lost, np.full(len(lost.a), -np.inf), UNKNOWN, False))
        w = w.chosen(~unknown)
    closed = w.chosen(w.closed)
    if len(closed.a):
        if p.certain:
            tally.certified += float(np.sum(closed.b - closed.a))
        elif isinstance(p.motion, Oscillation) and not p.problem.why:
            halve(p, closed, tally, p.problem)
        elif p.cones is not None:
            halve(p, closed, tally, p.cones)
        else:
            tally.windows.append((closed, np.zeros(len(closed.a)), FORCE, False))
    flying = w.chosen(~w.closed)
    if len(flying.a):
        halve(p, flying, tally, p.problem)


def halve(p: Pieces, w: Windows, tally: Tally, problem: Any) -> None:
    """Windows, which are halved until they are certified or too small or too many."""
    most, soon, rough = MOST * len(w.a) + LEAST, 4 * len(w.a) + SOON, True
    looked = 0
    while len(w.a):
        looked += len(w.a)
        try:
            s = problem.seen(w, rough=rough)
        except NotEnclosed as error:
            problem.why = str(error)
        if problem.why:
            look_at_samples(p, w, tally)
            return
        small = np.minimum(s.own, NEGLIGIBLE * p.largest)
        if rough:  # a touch need not be an event
            w = w._replace(
                first=w.first | ((w.a == p.t[w.k]) & (np.abs(s.at_a) <= small)),
                last=w.last | ((w.b == p.t[w.k + 1]) & (np.abs(s.at_b) <= small)),
            )
        rough = False
        good, lower = (s.gap >= -s.error, s.gap) if np.all(w.closed) else judged(w, s)
        wrong = ((s.at_b < -s.own) & ~w.last) | ((s.at_a < -s.own) & ~w.first)
        if problem is not p.problem:  # of a run that has its modes from other forces: only said, not taken
            vain, wrong = wrong, np.zeros(len(w.a), dtype=bool)
        h = w.b - w.a
        with np.errstate(invalid="ignore"):  # neither is known where a gradient has no bound
            drifted = np.maximum(s.error - s.own, 0.0)  # beside an event the motion counts as it was computed
        if not good.all():
            good |= at_event(p, w, lower + drifted > -ERRORS * small)
        tally.certified += float(np.sum(h[good]))
        for i in np.flatnonzero(wrong):
            inside = float(w.a[i] if s.at_a[i] < -s.own[i] and not w.first[i] else w.b[i])
            tally.found.append(Found(inside, int(w.c[i]), float(w.a[i])))
        left = ~(good | wrong)
        if problem is p.problem:  # others than flat ones: errors shrink
            vain = left & False
            if isinstance(problem, Flat) and left.any():
                vain = in_vain(p, w, s, lower)
        vain = vain & left
        end = left & ((h < SMALLEST * p.scale) | (looked > most) | vain)
        if (np.any(end) or looked > soon) and problem is p.problem and p.sharpen():
            w = w.chosen(left)
            continue
        if np.any(end):
            narrow = vain | (looked <= most) | ((s.own < s.error) & (np.minimum(s.at_a, s.at_b) <= s.error))
            near = NARROW if problem is p.problem else EDGE
            for which, why in (end & narrow, near), (end & ~narrow, TOO_MANY):
                if np.any(which):
                    tally.windows.append((w.chosen(which), lower[which], why, False))
        w = w.chosen(left & ~end).halved()


def at_event(p: Pieces, w: Windows, shallow: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which windows belong to an event of the run: at once by time, and a while where the gap is as good as zero."""
    before = np.where(p.touched[w.k, w.c] | w.first, w.b - p.t[w.k], np.inf)
    after = np.where(p.touched[w.k + 1, w.c] | w.last, p.t[w.k + 1] - w.a, np.inf)
    apart = np.minimum(before, after)
    near = np.minimum(apart, p.to_event(w)) if p.problem.drift is not None else apart
    return np.asarray((apart < AT_EVENT * p.scale) | (shallow & (near < BESIDE * p.scale)))


def in_vain(p: Pieces, w: Windows, s: Seen, lower: Array) -> NDArray[np.bool_]:
    """Windows that hold no gap below minus its error, and parts or ends of which no smaller one can certify."""
    h, small = w.b - w.a, np.minimum(s.own, NEGLIGIBLE * p.largest)
    with np.errstate(all="ignore"):
        most = np.maximum(s.at_a, s.at_b) + 0.125 * np.maximum(-s.least, 0.0) * h * h
        none_missed = s.smooth & (lower + s.error >= -s.own)
    lost = []
    for x, g in (w.a, s.at_a), (w.b, s.at_b):
        here = none_missed & (g <= s.error)
        if np.any(here):
            near = p.to_event(w._replace(a=x, b=x).chosen(here)) < BESIDE * p.scale
            here[here] = ~(near & (g - s.own > -ERRORS * small)[here])
        lost.append(here)
    return np.asarray(
        (lost[0] & lost[1] & (most <= s.error)) | ((lost[0] | lost[1]) & (h < COARSE * p.scale))
    )


def look_at_samples(p: Pieces, w: Windows, tally: Tally) -> None:
    """Windows of gaps that are known in samples alone."""
    least, found = sampled(p.problem, w)
    tally.windows.append((w, least, f"sampled: {p.problem.why}", True))
    tally.found.extend(found)


def counted(p: Pieces, tally: Tally) -> tuple[int, int]:
    """How many flights there are, and how many of them hold a window that is not certified, or an event missed."""
    fresh = p.touched[:-1].copy()
    fresh[1:] |= p.closed[:-1]
    fresh[0] = True
    fresh &= (p.t[1:] > p.t[:-1])[:, None]
    fresh &= ~p.closed
    count = int(np.count_nonzero(fresh))
    if not (tally.windows or tally.found):
        return count, 0
    ids, bad = np.cumsum(fresh, axis=0), set()
    for w, _, _, _ in tally.windows:
        flying = ~w.closed
        bad |= set(zip(w.c[flying].tolist(), ids[w.k[flying], w.c[flying]].tolist(), strict=True))
    for x in tally.found:
        k = min(int(np.searchsorted(p.t, x.start, side="right")) - 1, len(ids) - 1)
        bad.add((x.contact, int(ids[k, x.contact])))
    return count, min(len(bad), count)


def reported(tally: Tally) -> list[Window]:
    """The windows that are not certified, neighbours as one."""
    made: list[Window] = []
    by_reason: dict[tuple[str, bool], list[tuple[Windows, Array]]] = {}
    for w, lower, why, looked in tally.windows:
        by_reason.setdefault((why, looked), []).append((w, lower))
    for (why, looked), parts in by_reason.items():
        w, lower = joined([x for x, _ in parts]), np.concatenate([x for _, x in parts])
        order = np.lexsort((w.a, w.c))
        c, a, b, g = w.c[order], w.a[order], w.b[order], lower[order]
        new = np.append(True, (c[1:] != c[:-1]) | (a[1:] > b[:-1]))
        first = np.flatnonzero(new)
        last = np.append(first[1:], len(c)) - 1
        least = np.minimum.reduceat(g, first)
        made += [
            Window(float(a[i]), float(b[j]), int(c[i]), float(x), why, looked)
            for i, j, x in zip(first, last, least, strict=True)
        ]
    return made
