"""When two runs are looked at, and their states then.

Where states between kept ones are cheap, runs are looked at between breaks, of which every event of either run is
one, as long as there are not too many. Where a run has to be run again for them (`Again`) its kept states are taken.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lcpstep.corner_times import corner_times
from lcpstep.errorbar.breaks import close, increasing, spread
from lcpstep.kernels.between import last_rows
from lcpstep.stepping.interpolation import Parabolic
from lcpstep.trajectory import Kind, Trajectory

Array = NDArray[np.float64]
LEAST, MOST, NUMBERS = 150, 300, 1800  # breaks besides the events, so many numbers between two bounds
EVEN = 3  # and one in so many at even times
CLOSE = 16  # times as many kept states are looked at for those that are chosen
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)  # multiples of it are all over (0, 1), and at no step of one size
MANY = 600  # events; where there are more, breaks are anywhere: between events of a period they tell of one phase
JUMP = 10.0  # times the mean change of velocity in a step: more is an impact, at which there is a break
TINY = float(np.finfo(float).tiny)
GRADES = 12  # times an interval after an event is halved towards it: that is where errors change fast
SHORT = 0.25  # of a step: less of it is a parabola
SOON = 0.01  # of a time in which one run alone has struck, after its end
BRIEF = 1e-6  # of the span: within intervals between events that short dense output knows no velocities
NOWHERE = np.zeros((0, 2))


class Looks(NamedTuple):
    """Breaks t (n,), and how runs are looked at there.

    kept : whether the states of the run, and of the other one, are kept ones
    nodes : whether integrals ask for states between the breaks
    jumps : whether events fall between breaks, so that integrals have to add what they do
    even : the breaks among them that lie anywhere in steps: kept states alone may be nearer to each other than others
    """

    t: Array
    kept: tuple[bool, bool]
    nodes: bool
    jumps: bool
    even: Array | None = None


def looks(
    run: Trajectory,
    other: Trajectory,
    every: bool,
    end: float,
    wide: Array | None = None,
    windows: Array = NOWHERE,
) -> Looks:
    """Breaks between which runs are compared: steps where they are few, events and between; or kept states alone.

    wide : times between its steps at which the run has kept states too
    windows : (k, 2) times in which one of the runs alone has struck, looked at just after where there are `wide` ones
    """
    if not every:
        t = increasing(_telling(run, end, CLOSE * MOST), _kept_in_hops(run, end))
        return Looks(t, (True, True), False, False)
    most = min(max(LEAST, NUMBERS // run.scene.n_q), MOST)
    if wide is not None:
        even = wide[wide <= end]
        late = _from_there(run, windows, end, most // EVEN)
        t = increasing(_telling(run, end, most), late, even)
        return Looks(t, (True, False), False, True, even)
    events, start = event_times(run, other), float(run.t[0])
    many = len(events) > MANY
    some = uneven(start, end, MANY) if many else events
    ends = np.concatenate([run.t[:1], some[:: 1 + len(some) // most], run.t[-1:]])
    after = spread(start, end, most // EVEN, ends, 1 + min(GRADES, most // len(ends)))
    corners = corner_times(run.scene, end, most)  # a run stops there, and keeps no state
    t = increasing(after, some, corners, _left_out(run, most), _telling(run, end, most), low=start, high=end)
    return Looks(t, (False, False), True, many)


def uneven(start: float, end: float, n: int) -> Array:
    """Times all over a span in the ratio of no period."""
    return start + (end - start) * np.sort(np.mod(GOLDEN * np.arange(1, n + 1), 1.0))


def seen(look: Looks, end: float) -> Looks:
    """Up to a time, where the other run has kept states at these times and nodes."""
    return Looks(look.t[look.t <= end], (False, True), True, True)


def fewer(run: Trajectory, look: Looks, end: float) -> Looks:
    """Up to a time, as many of the kept states as are to be looked at: the other run has no others."""
    k = np.searchsorted(run.t, look.t, side="right") - 1
    return look._replace(t=increasing(_chosen(run.t[k], run.v[k], end, MOST), _kept_in_hops(run, end)))


def _telling(run: Trajectory, end: float, most: int) -> Array:
    """Kept times, or as many as are to be looked at."""
    return _chosen(run.t, run.v, end, most)


def _chosen(t: Array, v: Array, end: float, most: int) -> Array:
    """Of times as many as are to be looked at, as near to each other as time, velocities and steps go on.

    By their number there are some where chattering ends: it is over soon, at small speeds, and its errors are large.
    """
    n = int(np.searchsorted(t, end, side="right"))
    if n <= most:
        return t[:n]
    last, some = t[n - 1], slice(0, n, 1 + n // (CLOSE * most))
    t, v = t[some], v[some]
    turns = np.abs(np.diff(v, axis=0)).sum(axis=1)
    share = np.minimum(turns, JUMP * turns.mean())
    going = np.cumsum(np.diff(t) / (t[-1] - t[0]) + share / max(share.sum(), TINY) + 1.0 / len(share))
    places = np.searchsorted(going, np.linspace(0.0, going[-1], most))
    return np.append(t[np.unique(np.minimum(places, len(t) - 2))], last)


def _from_there(run: Trajectory, windows: Array, end: float, most: int) -> Array:
    """Just after the longest times in which one run alone has struck: there velocities can be compared again.

    Those in a small part of a step, between impacts in quick succession, where a parabola tells the motion.
    """
    length = np.diff(windows)[:, 0]
    longest = np.argsort(-length, kind="stable")[:most]
    t = windows[longest, 1] + SOON * length[longest]
    t = t[t < end]
    k = np.minimum(last_rows(run.t, t, 0, len(run.t) - 1), len(run.t) - 2)
    return t[run.t[k + 1] - run.t[k] < SHORT * (run.t[-1] - run.t[0]) / max(run.counts.steps, 1)]


def _left_out(run: Trajectory, most: int) -> Array:
    """The middle of the hops that the run no longer follows where chattering ends: there they are highest."""
    log = np.asarray(run.impacts)
    ends, found = log["kind"] == Kind.ACCUMULATION, [np.zeros(0)]
    for c in np.unique(log["contact"][ends]) if ends.any() else ():
        own = log["contact"] == c
        time, here = log["time"][own], ends[own]
        places = np.flatnonzero(here[1:])
        found.append(0.5 * (time[places] + time[places + 1]))
    t = np.concatenate(found)
    return t[:: 1 + len(t) // most]


def _kept_in_hops(run: Trajectory, end: float) -> Array:
    """The kept times on either side of those middles: they may be the only ones in such a hop."""
    k = np.searchsorted(run.t, _left_out(run, MOST), side="right")
    t = run.t[np.clip(np.concatenate([k - 1, k]), 0, len(run.t) - 1)]
    return t[t <= end]


def event_times(run: Trajectory, other: Trajectory) -> Array:
    """When anything happened in either run."""
    logs = (np.asarray(x.impacts) for x in (run, other))  # record arrays look their fields up slowly
    return np.asarray(increasing(*(log["time"] for log in logs)))


def brief(run: Trajectory, other: Trajectory, span: float) -> Array:
    """Intervals between events so short that rounding of positions is much of a velocity between, (k, 2)."""
    return np.asarray(close(event_times(run, other), BRIEF * span))


def at(run: Trajectory, t: Array, kept: bool) -> tuple[Array, Array]:
    """States at times in their order, any of them; or kept ones, and between these what soon follows one."""
    if not kept:
        return run.dense(t)
    k = last_rows(run.t, t, 0, len(run.t) - 1)
    q, v = run.q[k], run.v[k]
    later = np.flatnonzero(run.t[k] < t)
    if len(later):
        q[later], v[later] = Parabolic(run.t, run.q, run.v, True)(t[later])
    return q, v
