"""A period divided into leaves, in each of which the curve of what moves by itself changes little.

A window is halved until the bounds of its curve differ by no more than a share of what the curve is nearby (in the
window 16 times as long around it), or the place cannot leave its straight way by more than NOTHING. So a burr is
found however narrow it is, where bounds are enclosures. Neighbouring leaves that are alike are put together again.
Of what is steady it is by how much the curve differs nearby that counts, in a window 64 times as long.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.turns.source import Source

Array = NDArray[np.float64]
CHANGE = 0.25  # of the curve nearby
GENERATIONS = 5  # of windows that are nearby: the own one, and four that contain it
GENERATIONS_STEADY = 7  # enclosures of a difference may be far wider than it is
NOTHING = 1e-7  # of the range of places
NOTHING_STEADY = 1e-9  # of the way that what is steady goes
DEEPEST = 28  # halvings of the whole
MOST = 4096  # windows of one size
MUCH, FAST = 0.25, 1 / 32  # share of the time that turns fast, and how fast: then all of it does
ROOTS = 4  # between two ends
MUST = 2.0  # times what samples of the curve tell: what speeds may differ by
JUMP = 1e-6  # of the speed: what changes by more within a window of the last size jumps
HALVINGS = 40  # of the shortest windows, down to roundings of the whole
LITTLE = 1e-9  # of the largest speed: no jump
APART = 1e-13  # of the times: so far windows stay off their ends, where a corner belongs to none


class Leaves(NamedTuple):
    """Windows [a, b] in the order of time: bounds of their curve (n, rows), what it is nearby, whether it jumps."""

    a: Array
    b: Array
    lo: Array
    hi: Array
    near: Array
    jumps: NDArray[np.bool_]

    def chosen(self, which: Any) -> Leaves:
        """Some of them."""
        parts: list[Any] = [x[which] for x in self]
        return Leaves(*parts)


def leaves(source: Source, ends: Array, base: float) -> Leaves | None:
    """The leaves between the first and the last of `ends`, which all end one.

    None where more than a share MUCH of the time turns within less than FAST of the length `base`.
    """
    shares = np.arange(ROOTS) / ROOTS
    a = (ends[:-1, None] + np.diff(ends)[:, None] * shares).ravel()
    b = np.append(a[1:], ends[-1])
    near, kept = np.zeros((len(a), 0, source.rows, 2)), []
    least, most = np.full(source.rows, np.inf), np.full(source.rows, -np.inf)
    whole, fastest = ends[-1] - ends[0], 0.0
    while len(a):
        shrink = APART * np.maximum(whole, np.abs(b)) * (b - a > 1e-11 * whole)
        seen = source.bounds(a + shrink, b - shrink)
        times = np.column_stack([a + shrink, 0.5 * (a + b), b - shrink])
        looks = source.values(times.ravel()).reshape(len(a), 3, source.rows, 3)
        least = np.minimum(least, looks[..., 0].min(axis=(0, 1)))
        most = np.maximum(most, looks[..., 0].max(axis=(0, 1)))
        fastest = max(fastest, float(np.abs(looks[..., 1]).max()))
        range_ = np.maximum(most - least, _extent(seen.lo[..., 0], seen.hi[..., 0]))
        if source.steady:
            range_ *= whole * NOTHING_STEADY / NOTHING
        near, size = _nearby(source, near, looks[..., 2])
        lo, hi = seen.lo[..., 2], seen.hi[..., 2]
        even = alike(lo, hi, size, b - a, source.order, range_)
        if source.sampled:
            even &= ~_unaccounted(seen.lo, seen.hi, b - a)
        done = even & ~seen.branched
        last = b - a <= whole * 2.0**-DEEPEST
        jumps = last & (~even | _jumps(seen.lo[..., 1], seen.hi[..., 1]))
        end = done | last
        kept.append(Leaves(a, b, lo, hi, size, jumps & ~done).chosen(end))
        a, b, near = a[~end], b[~end], near[~end]
        if len(a) > MOST or (np.sum(b - a) > MUCH * whole and np.max(b - a) < FAST * base):
            return None
        middle = 0.5 * (a + b)
        a, b, near = np.concatenate([a, middle]), np.concatenate([middle, b]), np.vstack([near, near])
    joined = Leaves(*[np.concatenate(x) for x in zip(*kept, strict=True)])
    found = with_jumps_between(joined.chosen(np.argsort(joined.a)), source, ends, LITTLE / JUMP * fastest)
    return together(found, ends, source.order, range_)


def _nearby(source: Source, before: Array, curve: Array) -> tuple[Array, Array]:
    """Least and largest looks at the curve in windows and those around them (n, generations, rows, 2); its size.

    before : of the windows around;  curve : looks, (n, looks, rows)
    """
    own = np.stack([curve.min(axis=1), curve.max(axis=1)], axis=2)[:, None]
    near = np.concatenate([own, before], axis=1)[:, : GENERATIONS_STEADY if source.steady else GENERATIONS]
    least, most = near[..., 0].min(axis=1), near[..., 1].max(axis=1)
    size = most - least if source.steady else np.maximum(np.abs(least), np.abs(most))
    return near, size.max(axis=1)


def _extent(lo: Array, hi: Array) -> Array:
    """From the lowest to the highest of the bounds that are known, (rows,)."""
    lo, hi = np.where(np.isfinite(lo), lo, np.inf), np.where(np.isfinite(hi), hi, -np.inf)
    return np.maximum(hi.max(axis=0) - lo.min(axis=0), 0.0)


def _jumps(lo: Array, hi: Array) -> NDArray[np.bool_]:
    """Whether a speed jumps, in windows of the last size."""
    return np.asarray((hi - lo > JUMP * np.maximum(np.abs(lo), np.abs(hi))).any(axis=1))


def _unaccounted(lo: Array, hi: Array, h: Array) -> NDArray[np.bool_]:
    """Whether speeds of samples differ by more than the curves of these make of them in windows of the lengths h.

    Enclosures tell of a jump themselves.
    """
    most = np.maximum(np.abs(lo), np.abs(hi))
    told = MUST * h[:, None] * most[..., 2] + JUMP * most[..., 1]
    return np.asarray((hi[..., 1] - lo[..., 1] > told).any(axis=1))


def jump_times(source: Source, a: Array, b: Array, least: float = 0.0) -> tuple[NDArray[np.bool_], Array]:
    """In which windows [a, b] a speed jumps, and the times just after, which halving finds to rounding.

    least : speed beside which what one changes by is nothing
    """
    if not len(a):
        return np.zeros(0, dtype=bool), np.zeros(0)
    first, last = source.values(a)[..., 1], source.values(b)[..., 1]
    row = np.argmax(np.abs(last - first), axis=1)
    first, last = first[np.arange(len(a)), row], last[np.arange(len(a)), row]
    whole, size = np.abs(last - first), np.maximum(np.abs(first), np.abs(last))
    jumps = whole > JUMP * np.maximum(size, least)
    row = row[jumps]
    a, b, first, last, whole = (x[jumps] for x in (a, b, first, last, whole))
    start, end, between = first, last, np.ones(len(a), dtype=bool)
    for _ in range(HALVINGS if len(a) else 0):
        middle = 0.5 * (a + b)
        at = source.values_told(middle)[np.arange(len(a)), row, 1]
        between &= np.maximum(np.abs(at - start), np.abs(at - end)) <= 1.5 * whole  # or it is a pulse
        early = np.abs(at - first) < np.abs(at - last)
        a, first = np.where(early, middle, a), np.where(early, at, first)
        b, last = np.where(early, b, middle), np.where(early, last, at)
    at_once = between & (np.abs(last - first) >= 0.5 * whole)
    jumps[jumps] = at_once
    return jumps, b[at_once]


def with_jumps_between(found: Leaves, source: Source, ends: Array, least: float) -> Leaves:
    """The leaves, in order, with one of its own for each border of two, but for `ends`, at which a speed jumps.

    There none of the two shows it, as windows stay off their ends.
    """
    whole, border = ends[-1] - ends[0], found.b[:-1]
    beside = 2.0 * APART * np.maximum(whole, np.abs(border))
    jumps, _ = jump_times(source, border - beside, border + beside, least)
    k = np.flatnonzero(jumps & ~np.isin(border, ends))
    if not len(k):
        return found
    parts: list[Any] = [np.insert(x, k + 1, x[k], axis=0) for x in found]
    made = Leaves(*parts)
    own = k + 1 + np.arange(len(k))
    made.a[own], made.b[own], made.jumps[own] = (border - beside)[k], (border + beside)[k], True
    made.b[own - 1], made.a[own + 1] = made.a[own], made.b[own]
    return made


def alike(lo: Array, hi: Array, near: Array, h: Array, order: int, range_: Array) -> NDArray[np.bool_]:
    """Whether a curve between these bounds changes little in windows of the lengths h."""
    width = hi - lo
    straight = width * (h**order)[:, None] / 8.0 <= NOTHING * range_
    return np.asarray(((width <= CHANGE * near[:, None]) | straight).all(axis=1))


def together(found: Leaves, ends: Array, order: int, range_: Array) -> Leaves:
    """Neighbours that are alike put together, but not across one of the ends.

    What the curve is nearby is the least of theirs: what little it is where a jerk begins is much beside the rest.
    """
    made: list[tuple[float, float, Array, Array, float, bool]] = []
    borders = set(ends.tolist())
    for row in zip(*found, strict=True):
        a, b, lo, hi, near, jumps = row
        if made and a not in borders and not jumps and not made[-1][5]:
            before = made[-1]
            least, most, less = np.minimum(before[2], lo), np.maximum(before[3], hi), min(before[4], near)
            h = np.array([b - before[0]])
            if alike(least[None], most[None], np.array([less]), h, order, range_)[0]:
                made[-1] = before[0], b, least, most, less, False
                continue
        made.append((a, b, lo, hi, near, bool(jumps)))
    a, b, lo, hi, near, jumps = zip(*made, strict=True)
    return Leaves(np.array(a), np.array(b), np.array(lo), np.array(hi), np.array(near), np.array(jumps))
