"""Times at which a run stops to look, because an obstacle or a frame turns fast there.

A scan for events that is as fine as the motion flies through a burr on a cam. Where what moves by itself is known as
a function of time, the places where it turns fast are found once, before the run (`refine`), and the scan is divided
there: a run takes these times as it takes corners. Elsewhere it costs nothing.
"""

from __future__ import annotations

import functools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.intervals import NotEnclosed
from lcpstep.turns.refine import APART, JUMP, LITTLE, MUCH, Leaves, jump_times, leaves
from lcpstep.turns.source import FRAME, Source, belts, frame_of, sources
from lcpstep.warned import warn

Array = NDArray[np.float64]
PER_PERIOD, PER_SPAN = 16, 50  # intervals of the scan in a period, or in a span without one
SHORT = 0.25  # of them: leaves that are shorter are looked at by themselves
EVEN = 0.5  # of the largest curve: by how much it may change where no look is needed
NEAR = 1e-12  # of the period: stops that are one
ROUNDING = 1e-15  # of a corner: it is where its function jumps, which may be just after it
SPEEDS = 1024  # samples that tell how fast a frame is
KEPT = 256  # scenes whose stops are remembered


NOWHERE: Array = np.zeros((0, 2))
NEVER: Array = np.zeros(0)
NOWHERE.flags.writeable = NEVER.flags.writeable = False


class FastTurn(UserWarning):
    """Something turns faster than the scan for events, and how fast is known from samples alone."""


class Turns(NamedTuple):
    """Where what moves by itself turns fast.

    stops : (m,)     times to look at, in [0, period), or in the span where nothing repeats; with the scene's corners
    fast : (k, 2)    stretches between them, with as much on both sides, apart from each other
    sampled          what is known from samples alone, and turns fast, and why; ""
    jolts : (j,)     where the velocity of the frame jumps
    """

    stops: Array
    fast: Array
    sampled: str
    jolts: Array

    def elsewhere(self, times: Array, period: float) -> NDArray[np.bool_]:
        """Which times lie in none of the stretches."""
        if not len(self.fast):
            return np.ones(len(times), dtype=bool)
        t = times if math.isinf(period) else np.mod(times, period)
        k = np.searchsorted(self.fast[:, 0], t, side="right") - 1
        return np.asarray(np.append(self.fast[:, 1], -np.inf)[k] < t)


def turns(scene: Scene, with_belts: bool = False) -> Turns:
    """Where what moves by itself in a scene turns fast; one warning per scene where samples alone tell.

    with_belts : also where a belt does
    """
    corners = np.asarray(scene.corners, dtype=float)
    found = sources(scene) + (belts(scene) if with_belts else []) if scene.n_c else []
    if not found:
        return Turns(corners, NOWHERE, "", NEVER)
    result = _remembered(tuple(Key(x) for x in found), _whole(scene), scene.period, tuple(corners.tolist()))
    if result.sampled:
        warn(f"{scene.name!r}: {result.sampled}", FastTurn)
    return result


def jolts(scene: Scene) -> Array:
    """Times in [0, period), or in the span, at which the velocity of the frame jumps."""
    frame, ready = frame_of(scene)
    corners = np.asarray(scene.corners, dtype=float)
    if frame is None:
        return NEVER
    if ready:
        every = sample_speeds(frame, _whole(scene))
        return np.asarray(corners[jumps_beside(frame, corners, _whole(scene), every)[0]])
    return _remembered((Key(frame),), _whole(scene), scene.period, tuple(corners.tolist())).jolts


def sample_speeds(source: Source, span: tuple[float, float]) -> float:
    """The largest speed of some samples."""
    return float(np.max(np.abs(source.values(np.linspace(*span, SPEEDS))[..., 1])))


def _whole(scene: Scene) -> tuple[float, float]:
    """A period, or the span where nothing repeats."""
    return (0.0, scene.period) if math.isfinite(scene.period) else scene.t_span


class Key:
    """A source that is the same as another one that gives the same answers."""

    def __init__(self, source: Source) -> None:
        self.source, self.key = source, source.key

    def __hash__(self) -> int:
        return hash(self.key)

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Key) and self.key == other.key


@functools.lru_cache(maxsize=KEPT)
def _remembered(
    keys: tuple[Key, ...], span: tuple[float, float], period: float, corners: tuple[float, ...]
) -> Turns:
    """The same, of all that moves."""
    per = PER_PERIOD if math.isfinite(period) else PER_SPAN
    base = (span[1] - span[0]) / per
    named = np.array(corners)
    inside = (span[0] < named) & (named < span[1])
    for key in keys:
        named[inside] = at_jumps(key.source, named[inside], span)
    own = named[inside]
    ends = np.unique(np.concatenate([[span[0]], own, [span[1]]]))
    stops, exact, stretches, words, jolts = [named], [own], [np.zeros((0, 2))], [], [NEVER]
    for key in keys:
        source, found = _divided(key.source, ends, base)
        if found is None:  # all of it turns fast, as samples show as well
            continue
        short = fast(found, SHORT * usual(found, base), ends, source.steady)
        stops += [corners_between(source, found), jump_at(source, found, ends)]
        jumps, times = jump_times(source, found.a[found.jumps], found.b[found.jumps])
        if source.name == FRAME:
            at, fastest = np.concatenate([times, stops[-1], own]), sample_speeds(source, span)
            jolts.append(at[jumps_beside(source, at, span, fastest)[0]])
        turned = short.copy()
        turned[found.jumps] = ~jumps
        stops.append(np.concatenate([found.a[turned], found.b[turned]]))
        exact.append(times)
        stretches.append(np.column_stack([found.a[short], found.b[short]]))
        if source.sampled and np.any(turned):
            shortest = np.min((found.b - found.a)[turned])
            words.append(
                f"{source.name} turns within {shortest:.3g} s, as samples show, which need not show everything: it "
                f"cannot be evaluated on intervals ({source.sampled}); give the times at which it turns as `corners`"
            )
    if math.isfinite(period):  # the ends of a period are one time
        stops, exact = [x[x < period] for x in stops], [x[x < period] for x in exact]
    return Turns(
        _apart(np.unique(np.concatenate(stops)), span[1] - span[0], np.unique(np.concatenate(exact))),
        _widened(np.concatenate(stretches)),
        "; ".join(words),
        np.sort(np.concatenate(jolts)),
    )


def corners_between(source: Source, found: Leaves) -> Array:
    """Ends of leaves at which the curve jumps: elsewhere enclosures of neighbours have a number in common."""
    if source.sampled:
        return np.zeros(0)
    size = JUMP * np.maximum(found.near[1:], found.near[:-1])[:, None]
    apart = np.maximum(found.lo[1:] - found.hi[:-1], found.lo[:-1] - found.hi[1:])
    return np.asarray(found.b[:-1][np.any(apart > size, axis=1)])


def jump_at(source: Source, found: Leaves, ends: Array) -> Array:
    """The first of the ends where a speed jumps there, which no leaf shows: differences would look across it."""
    fastest = float(np.max(np.abs(source.values(found.a)[..., 1])))
    jumps, _ = jumps_beside(source, ends[:1], (ends[0], ends[-1]), LITTLE / JUMP * fastest)
    return ends[:1][jumps]


def at_jumps(source: Source, corners: Array, span: tuple[float, float]) -> Array:
    """The corners, those that only the rounding of a sum tells from a jump of a speed at the jump itself.

    Beyond a corner that is early, be it by ten roundings, what rests on an obstacle would go along through its jump.
    """
    jumps, times = jumps_beside(source, corners, span)
    moved = corners.copy()
    moved[jumps] = times
    return np.where(np.abs(moved - corners) > ROUNDING * np.abs(corners), moved, corners)


def jumps_beside(
    source: Source, times: Array, span: tuple[float, float], least: float = 0.0
) -> tuple[NDArray[np.bool_], Array]:
    """At which times a speed jumps, but for some roundings, and when it does: see `jump_times`."""
    beside = 2.0 * APART * np.maximum(span[1] - span[0], np.abs(times))
    return jump_times(source, times - beside, times + beside, least)


def _divided(source: Source, ends: Array, base: float) -> tuple[Source, Leaves | None]:
    """The leaves by the first way of the source that tells them."""
    for way in source.ways():
        try:
            found = leaves(way, ends, base)
        except NotEnclosed:
            continue
        if found is not None:
            return way, found
    return source, None


def _widened(stretches: Array) -> Array:
    """The stretches put together where they meet, and as much on both sides of each: a burr has its tails there."""
    whole = _merged(stretches)
    length = whole[:, 1:] - whole[:, :1]
    return _merged(whole + length * np.array([[-1.0, 1.0]]))


def _merged(stretches: Array) -> Array:
    """Stretches in order, those that meet or overlap as one."""
    made: list[list[float]] = []
    for a, b in stretches[np.argsort(stretches[:, 0])]:
        if made and a <= made[-1][1]:
            made[-1][1] = max(made[-1][1], float(b))
        else:
            made.append([float(a), float(b)])
    return np.array(made).reshape(-1, 2)


def usual(found: Leaves, base: float) -> float:
    """Length that all but a share of the time is divided into leaves of; at most `base`."""
    length = found.b - found.a
    order = np.argsort(length)
    share = np.cumsum(length[order]) / np.sum(length)
    k = min(int(np.searchsorted(share, MUCH)), len(order) - 1)
    return float(min(base, length[order[k]]))


def _apart(stops: Array, whole: float, exact: Array) -> Array:
    """The stops without those that only rounding tells from others; the scene's corners stay, and times of jumps."""
    stops = stops[np.diff(stops, prepend=-np.inf) >= NEAR * whole]
    if len(exact):
        k = np.clip(np.searchsorted(exact, stops), 1, len(exact)) - 1
        after = exact[np.minimum(k + 1, len(exact) - 1)]
        stops = stops[np.minimum(np.abs(stops - exact[k]), np.abs(after - stops)) >= NEAR * whole]
    return np.union1d(stops, exact)


def fast(found: Leaves, least: float, borders: Array, steady: bool) -> NDArray[np.bool_]:
    """Which leaves are shorter than `least`, and not because a corner ends them, or hold a jump.

    Leaves side by side, between two borders, whose curve hardly changes over all of them need no look of their own.
    steady : whether what they hardly change by is small beside the changes nearby, and not beside the curve
    """
    short = (found.b - found.a < least) | found.jumps
    starts = ~np.append(False, short[:-1]) | np.isin(found.a, borders)
    group = np.cumsum(starts & short) * short
    for k in range(1, int(group.max(initial=0)) + 1):
        own = group == k
        lo, hi = found.lo[own].min(axis=0), found.hi[own].max(axis=0)
        size = np.max(found.near[own]) if steady else np.maximum(np.abs(lo), np.abs(hi))
        if np.all(hi - lo <= EVEN * size) and not np.any(found.jumps[own]):
            short[own] = False
    return short
