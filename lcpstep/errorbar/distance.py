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

from lagrangian.labels import units
from lcpstep.errorbar.bars import Bar
from lcpstep.errorbar.breaks import with_nodes
from lcpstep.errorbar.curves import curves, looked_into, merged, within
from lcpstep.errorbar.looks import MANY, Looks, at, brief, event_times
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
        apart = np.abs(roughly(run, t)[1] - (roughly(other, t) if whole else other.dense(t))[1])
        return np.asarray(np.max(apart, axis=1, initial=0.0) > SAME * jump)

    return differ


def roughly(run: Trajectory, t: Array) -> tuple[Array, Array]:
    """States of a run with all its steps, by parabolas within them where it would be run again for those."""
    if getattr(run.dense, "dear", False) and len(run.t) > 1:
        return Parabolic(run.t, run.q, run.v, True)(t)
    return run.dense(t)


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
    t, n_q, nothing = look.t, runs[0].scene.n_q, np.zeros(0)
    length, times = float(t[-1] - t[0]), with_nodes(t) if look.nodes else t
    one, other = (at(x, times, kept) for x, kept in zip(runs, look.kept, strict=True))
    energies = [states.energy(m, times, *x) for x in (one, other)]
    left_out = merged(np.concatenate([windows, brief(*runs, length)]), around)
    covered = nothing.view(np.uint8)
    if look.jumps:
        covered = within(_hidden(left_out, times, look.kept[0]), times)
        if look.kept[0]:
            covered |= within(merged(np.repeat(runs[1].impacts["time"][:, None], 2, axis=1), around), times)
    largest, integral, floor, size = curves(
        t, times, (*one, energies[0]), (*other, energies[1]), within(left_out, times), covered,
        nothing if look.even is None else look.even,
    )  # fmt: skip
    if look.jumps:
        between = merged(np.column_stack([pairs.start, pairs.start + pairs.time]), 0.0)
        integral[:, n_q:] += _of_jumps(m, runs, look, _hidden(between, times, look.kept[0]), around)
    elif not look.nodes and len(windows):
        integral[:, n_q:] = math.nan  # where impacts fall between kept states
    q, v, energy = units(runs[0].scene.labels)
    columns = ((slice(0, n_q), q), (slice(n_q, 2 * n_q), v), (slice(2 * n_q, None), energy))
    position, velocity, power = (Bar(largest[:, c], integral[:, c], unit) for c, unit in columns)
    least = AT_REST * falls * length + STILL * float(floor[:n_q].max())
    return Distance(position, velocity, power, left_out, max(size, least))


def _hidden(intervals: Array, times: Array, alone: bool) -> Array:
    """Intervals that looks do not resolve; at kept states alone none tells how long it lasts."""
    if alone:
        return intervals[np.diff(intervals)[:, 0] < HIDDEN * (times[-1] - times[0]) / len(times)]
    return np.asarray(intervals[~looked_into(intervals, times, HIDDEN)])


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
    return np.column_stack([v, states.energy(m, t, q, v)])


def fall(m: Model, run: Trajectory) -> float:
    """The speed that the forces at the start would give it over the run, if nothing held it [m/s]."""
    n = run.scene.n_q
    slow = np.eye(n) * SLOW
    kinetic, power = states.power(m, np.full(n, run.t[0]), np.repeat(run.q[:1], n, axis=0), slow)
    return float(np.max(np.abs(power) / (2.0 * kinetic) * SLOW, initial=0.0)) * float(run.t[-1] - run.t[0])
