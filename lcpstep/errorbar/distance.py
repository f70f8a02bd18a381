"""How far a run is from its companion, as functions of time.

    largest(t) = sup over s <= t of |x(s) - y(s)|,        integral(t) = integral up to t of |x - y|

for positions, velocities and energy. Between an impact and its partner in the other run one of the two velocities has
jumped and the other not: there the pointwise distance of velocities and energies is as large as the jump however
near the two motions are. Their `largest` leaves these times out. The integrals take all: by Gauss' rule with two
points between breaks, where every event of either run is one. Else they go on between breaks as if nothing jumped,
and what events do is added: for each pair the jump times the time between the two.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lcpstep.errorbar.bars import Bar
from lcpstep.errorbar.looks import GAUSS, MANY, Looks, at, brief, event_times, with_nodes
from lcpstep.errorbar.partners import Alike, Apart, Pairs
from lcpstep.kernels import states
from lcpstep.kernels.model import Model
from lcpstep.stepping.interpolation import Parabolic
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
HIDDEN = 3  # looks within an interval between partners, that do not tell what happens there
FURTHER = 3  # gaps between events after one that differs, in which motions may be alike again
SAME = 0.1  # of a jump, by which velocities of motions may differ that are alike
AT_REST = 1e-6  # of the length that forces would move it by
STILL = 1e4  # times rounding: a motion that is no larger stands still
SLOW = 1e-6  # the velocity with which forces and masses are asked for [m/s]
ROUNDING = 4.0  # last digits of what a number is made of
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Distance:
    """Distances of two runs, one `Bar` for each quantity, none below what rounding makes of its numbers."""

    position: Bar
    velocity: Bar
    energy: Bar
    left_out: Array
    size: float  # half the range of the coordinate that moves most, or what is no motion but rounding


def alike(run: Trajectory, other: Trajectory, resolution: float, apart: Apart) -> Alike:
    """From when on two runs move alike again after an event of one of them, nan where they do not.

    Looked at after the event and those of other contacts at the same time, or after one or two more, in a state that
    was kept where there is one. Balls that touch may hand an impulse on in one problem or in several, and part alike.
    """

    def again(time: Array, jump: Array) -> Array:
        events = event_times(run, other)
        last = np.append(
            np.flatnonzero(np.diff(events) > resolution), len(events) - 1
        )  # of those at one time
        following = np.append(events[1:], math.inf)
        first = last[np.searchsorted(last, np.searchsorted(events, time))]
        end = np.minimum(first + np.arange(FURTHER)[:, None], len(events) - 1)  # (FURTHER, k)
        until = np.minimum(following[end], min(run.t[-1], other.t[-1]))
        k = np.minimum(np.searchsorted(run.t, events[end], side="right"), len(run.t) - 1)
        kept = (run.t[k] > events[end]) & (run.t[k] < until)
        after = np.where(kept, run.t[k], 0.5 * (events[end] + until))
        told = until > events[end]
        found = np.full(end.shape, math.inf)
        differ = apart(after[told], np.broadcast_to(jump, end.shape)[told])
        found[told] = np.where(differ, math.inf, after[told])
        soonest = np.min(found, axis=0)
        return np.where(np.isfinite(soonest), soonest, math.nan)

    return again


def moving_apart(run: Trajectory, other: Trajectory, whole: bool) -> Apart:
    """Whether velocities differ at times by more than a share of jumps; `whole`: the other has all its steps."""

    def differ(t: Array, jump: Array) -> NDArray[np.bool_]:
        times, place = np.unique(t, return_inverse=True)
        apart = np.abs(roughly(run, times)[1] - (roughly(other, times) if whole else other.at(times))[1])
        return np.asarray(np.max(apart, axis=1, initial=0.0)[place] > SAME * jump)

    return differ


def roughly(run: Trajectory, t: Array) -> tuple[Array, Array]:
    """States of a run with all its steps, by parabolas within them where it would be run again for those."""
    if getattr(run.dense, "dear", False) and len(run.t) > 1:
        return Parabolic(run.t, run.q, run.v, True)(t)
    return run.at(t)


def distance(
    m: Model,
    runs: tuple[Trajectory, Trajectory],
    look: Looks,
    pairs: Pairs,
    windows: Array,
    around: float,
    falls: float,
) -> Distance:
    """Distances of two runs as they are looked at; the largest of velocities without windows and what is `around`.

    falls : see `fall` [m/s]
    """
    t, n_q = look.t, runs[0].scene.n_q
    length, times = float(t[-1] - t[0]), with_nodes(t) if look.nodes else t
    one, other = (at(x, times, kept) for x, kept in zip(runs, look.kept, strict=True))
    energies = [energy(m, times, *x) for x in (one, other)]
    apart = np.abs(np.column_stack([one[0] - other[0], one[1] - other[1], energies[0] - energies[1]]))
    far, fast = (np.abs(x).max(axis=0) for x in one)
    floor = ROUNDING * EPS * np.array([*(far + np.abs(t).max() * fast), *fast, np.abs(energies[0]).max()])
    left_out = merged(np.concatenate([windows, brief(*runs, length)]), around)
    between = merged(np.column_stack([pairs.start, pairs.start + pairs.time]), 0.0)
    between, hidden = (_hidden(x, times, look.kept[0]) for x in (between, left_out))
    out = within(left_out, times)
    struck = _near(times, runs[1], around) if look.kept[0] else False
    jumping = apart[:, n_q:].copy()
    apart[out, n_q:] = 0.0
    largest = np.maximum.accumulate(apart)[:: 1 + len(GAUSS) * look.nodes] + floor
    apart[:, n_q:] = jumping[_before(within(hidden, times) | struck)] if look.jumps else jumping
    integral = _integral(t, apart, look.nodes)
    if look.even is not None:
        integral = _evened(t, apart, integral, look.even)
    integral = integral + floor * (t - t[0])[:, None]
    if look.jumps:
        integral[:, n_q:] += _of_jumps(m, runs, look, between, around)
    elif not look.nodes and len(windows):
        integral[:, n_q:] = math.nan  # where impacts fall between kept states
    columns = ((slice(0, n_q), "m"), (slice(n_q, 2 * n_q), "m/s"), (slice(2 * n_q, None), "J"))
    position, velocity, power = (Bar(largest[:, c], integral[:, c], unit) for c, unit in columns)
    least = AT_REST * falls * length + STILL * float(floor[:n_q].max())
    size = 0.5 * float(np.ptp(one[0], axis=0).max())
    return Distance(position, velocity, power, left_out, max(size, least))


def _hidden(intervals: Array, times: Array, alone: bool) -> Array:
    """Intervals that looks do not resolve; at kept states alone none tells how long it lasts."""
    if alone:
        return intervals[np.diff(intervals)[:, 0] < HIDDEN * (times[-1] - times[0]) / len(times)]
    return intervals[np.diff(np.searchsorted(times, intervals))[:, 0] <= HIDDEN]


def _near(times: Array, run: Trajectory, around: float) -> NDArray[np.bool_]:
    """Times so near to an event of a run that whether it has passed is rounding."""
    events = np.concatenate([[-math.inf], run.impacts["time"], [math.inf]])
    k = np.searchsorted(events, times)
    return np.asarray(np.minimum(times - events[k - 1], events[k] - times) <= around)


def _before(out: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Places of the last times before each that are not left out; of the first one where there is none."""
    last = np.maximum.accumulate(np.where(out, -1, np.arange(len(out))))
    return np.asarray(np.where(last < 0, np.argmin(out), last))


def _of_jumps(m: Model, runs: tuple[Trajectory, Trajectory], look: Looks, own: Array, around: float) -> Array:
    """What intervals between partners add to the integrals of velocities and energy up to all looks, (n, n_q + 1)."""
    t, run = look.t, runs[0]
    own = own[(own[:, 1] > own[:, 0]) & (own[:, 1] < t[-1])]
    some = own[:: 1 + len(own) // MANY]  # of many a part tells
    added = np.zeros((len(t), run.scene.n_q + 1))
    if len(some):
        between = 0.5 * (some[:, 0] + some[:, 1])
        if look.kept[1]:  # the other run is not known there: nor what one jumps by while it waits
            both_sides = np.repeat(some, 2, axis=1) + around * np.array([-1, 1, -1, 1])
            speeds = _speeds(m, run, np.clip(both_sides, run.t[0], run.t[-1]).ravel())
            sides = speeds.reshape(len(some), 4, -1)
            apart = np.abs(sides[:, 1::2] - sides[:, ::2]).max(axis=1)
        else:
            apart = np.abs(_speeds(m, run, between) - _speeds(m, runs[1], between))
        np.add.at(added, np.searchsorted(t, some[:, 1]), apart * np.diff(some))
    return np.cumsum(added, axis=0) * (len(own) / max(len(some), 1))


def _speeds(m: Model, run: Trajectory, t: Array) -> Array:
    """Velocities and energy (n, n_q + 1)."""
    q, v = roughly(run, t)
    return np.column_stack([v, energy(m, t, q, v)])


def _integral(t: Array, x: Array, nodes: bool) -> Array:
    """Integral up to each time, by the nodes between times, or by the times where there are none."""
    means = 0.5 * (x[1::3] + x[2::3] if nodes else x[1:] + x[:-1])
    return np.concatenate([np.zeros((1, x.shape[1])), np.cumsum(np.diff(t)[:, None] * means, axis=0)])


def _evened(t: Array, x: Array, integral: Array, even: Array) -> Array:
    """The integral over the intervals between even times: by all times there, or by these alone where that is more.

    Errors at the ends of steps may be smaller than within.
    """
    k = np.searchsorted(t, even)
    alone = 0.5 * np.diff(even)[:, None] * (x[k[1:]] + x[k[:-1]])
    more = np.cumsum(np.maximum(alone - np.diff(integral[k], axis=0), 0.0), axis=0)
    added = np.concatenate([np.zeros((1, x.shape[1])), more])
    return integral + added[np.maximum(np.searchsorted(even, t, side="right") - 1, 0)]


def merged(windows: Array, around: float) -> Array:
    """Intervals with what is around them, those that overlap as one, in their order (k, 2)."""
    if not len(windows):
        return windows
    windows = windows[np.argsort(windows[:, 0])]
    ends = np.maximum.accumulate(windows[:, 1]) + around
    first = np.append(True, windows[1:, 0] - around > ends[:-1])
    return np.column_stack([windows[first, 0] - around, ends[np.append(first[1:], True)]])


def within(intervals: Array, t: Array) -> NDArray[np.bool_]:
    """Whether times lie in intervals that do not overlap."""
    return np.asarray(np.searchsorted(intervals[:, 0], t, side="right") > np.searchsorted(intervals[:, 1], t))


def energy(m: Model, t: Array, q: Array, v: Array) -> Array:
    """Kinetic energy and that of constant stiffness and forces, (n, 1) [J]."""
    return np.asarray(states.energy(m, *map(np.ascontiguousarray, (t, q, v))))[:, None]


def fall(m: Model, run: Trajectory) -> float:
    """The speed that the forces at the start would give it over the run, if nothing held it [m/s]."""
    n = run.scene.n_q
    slow = np.eye(n) * SLOW
    kinetic, power = states.power(m, np.full(n, run.t[0]), np.repeat(run.q[:1], n, axis=0), slow)
    return float(np.max(np.abs(power) / (2.0 * kinetic) * SLOW, initial=0.0)) * float(run.t[-1] - run.t[0])
