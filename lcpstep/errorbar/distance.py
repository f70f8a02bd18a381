"""How far a run is from its companion, as functions of time.

    largest(t) = sup over s <= t of |x(s) - y(s)|,        integral(t) = integral up to t of |x - y|

for positions, velocities and energy. Between an impact and its partner in the other run one of the two velocities has
jumped and the other not: there the pointwise distance of velocities and energies is as large as the jump however
near the two motions are. Their `largest` leaves these times out; the integral takes them by quadrature.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.errorbar.bars import Bar
from lcpstep.errorbar.partners import Alike, Partners
from lcpstep.kernels import states
from lcpstep.kernels.model import Model
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
LEAST, MOST = 199, 997  # instants looked at
SAME = 0.1  # of a jump, by which velocities of motions may differ that are alike
AT_REST = 1e-6  # of the length that forces would move it by
STILL = 1e4  # times rounding: a motion that is no larger stands still
SLOW = 1e-6  # the velocity with which forces and masses are asked for [m/s]
ROUNDING = 4.0  # last digits of what a number is made of
WITHIN = np.array([0.21, 0.79])  # where in a step it is looked at, where there are few
NODES = np.array(
    [0.069431844202974, 0.330009478207572, 0.669990521792428, 0.930568155797026]
)  # Gauss, 4 points
WEIGHTS = np.array([0.173927422568727, 0.326072577431273, 0.326072577431273, 0.173927422568727])
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Distance:
    """Distances of two runs, one `Bar` for each quantity, none below what rounding makes of its numbers."""

    position: Bar
    velocity: Bar
    energy: Bar
    size: float  # half the range of the coordinate that moves most, or what is no motion but rounding


def looks(run: Trajectory, other: Trajectory, every: bool, end: float) -> Array:
    """Times at which runs are compared: within steps, at events and between them; or at states that were kept."""
    wanted = np.linspace(float(run.t[0]), end, LEAST if len(run.t) < LEAST else MOST)
    if not every:
        kept = run.t[run.t <= end]
        return kept if len(kept) <= MOST else kept[np.unique(np.searchsorted(kept, wanted, side="right") - 1)]
    events = event_times(run, other)
    events = events[:: 1 + len(events) // MOST]
    some = run.t[:: 1 + len(run.t) // MOST]
    steps = (some[:-1, None] + np.diff(some)[:, None] * WITHIN).ravel()
    t = np.unique(np.concatenate([wanted, events, 0.5 * (events[1:] + events[:-1]), steps]))
    return t[(t >= run.t[0]) & (t <= end)]


def event_times(run: Trajectory, other: Trajectory) -> Array:
    """When anything happened in either run."""
    return np.unique(np.concatenate([x.impacts["time"] for x in (run, other)]))


def at(run: Trajectory, t: Array) -> tuple[Array, Array]:
    """States at times in any order, asked for once: some runs are run again for those between kept ones."""
    times, place = np.unique(t, return_inverse=True)
    k = np.searchsorted(run.t, times, side="right") - 1
    q, v = (run.q[k], run.v[k]) if np.array_equal(run.t[k], times) else run.at(times)
    return q[place], v[place]


def alike(run: Trajectory, other: Trajectory, resolution: float) -> Alike:
    """From when on two runs move alike again after an event of one of them, nan where they do not.

    Looked at after the event and those of other contacts at the same time, before the next one, in a state that was
    kept where there is one. Balls that touch may hand an impulse on in one problem or in several, and part alike.
    """
    events = event_times(run, other)
    last = np.append(np.flatnonzero(np.diff(events) > resolution), len(events) - 1)  # of those at one time
    following = np.append(events[1:], math.inf)

    def again(time: Array, jump: Array) -> Array:
        end = last[np.searchsorted(last, np.searchsorted(events, time))]
        k = np.minimum(np.searchsorted(run.t, events[end], side="right"), len(run.t) - 1)
        until = np.minimum(following[end], min(run.t[-1], other.t[-1]))
        kept = (run.t[k] > events[end]) & (run.t[k] < until)
        after = np.where(kept, run.t[k], 0.5 * (events[end] + until))
        told = until > events[end]
        found = np.full(len(time), math.nan)
        apart = np.max(np.abs(at(run, after[told])[1] - at(other, after[told])[1]), axis=1)
        found[told] = np.where(apart <= SAME * jump[told], after[told], math.nan)
        return found

    return again


def distance(
    m: Model, runs: tuple[Trajectory, Trajectory], every: bool, t: Array, pairs: Partners, around: float,
    factor: float,
) -> Distance:  # fmt: skip
    """Distances of two runs times a factor; of velocities without the time `around` each pair of impacts [s]."""
    start, end = merged(pairs.windows[:, 0] - around, pairs.windows[:, 1] + around, t)
    between = np.searchsorted(start, t, side="right") > np.searchsorted(end, t, side="left")
    start, end = split(start, end, event_times(*runs))
    nodes = (start[:, None] + (end - start)[:, None] * NODES).ravel() if every else t[:0]
    times, n = np.concatenate([t, nodes]), len(t)
    states_of = [at(x, times) for x in runs]
    E = [energy(m, times, *x) for x in states_of]
    q, v = states_of[0][0][:n], states_of[0][1][:n]
    far, fast = np.max(np.abs(q), axis=0), np.max(np.abs(v), axis=0)
    rounding = ROUNDING * EPS * np.array([*far, *fast, np.max(np.abs(E[0]))])
    rounding[: len(far)] += ROUNDING * EPS * np.max(np.abs(t)) * fast
    apart = factor * np.abs(np.column_stack([*(x - y for x, y in zip(*states_of, strict=True)), E[0] - E[1]]))
    k, found = len(far), []
    for columns, unit in ((slice(0, k), "m"), (slice(k, 2 * k), "m/s"), (slice(2 * k, None), "J")):
        x, floor, continuous = apart[:, columns], rounding[columns], unit == "m"
        if continuous:
            largest, integral = (
                np.maximum.accumulate(x[:n]),
                _integral(t, x[:n], between & False, t[:0], t[:0]),
            )
        else:
            largest = np.maximum.accumulate(np.where(between[:, None], 0.0, x[:n]))
            integral = _integral(t, x[:n], between, start, end) + _within(t, start, end, x[n:], every)
        found.append(Bar(largest + floor, integral + floor * (t - t[0])[:, None], unit))
    position, velocity, power = found
    size = 0.5 * float(np.max(np.ptp(q, axis=0), initial=0.0))
    still = STILL * float(np.max(rounding[:k], initial=0.0)) + AT_REST * fall(m, runs[0]) * float(
        t[-1] - t[0]
    )
    return Distance(position, velocity, power, max(size, still))


def _integral(t: Array, x: Array, left_out: Any, start: Array, end: Array) -> Array:
    """Up to each time, of values x (m, k) without those left out, over the time outside of intervals."""
    seen = np.flatnonzero(~left_out)
    if len(seen) == 0:
        return np.zeros_like(x)
    smooth = np.column_stack([np.interp(t, t[seen], column[seen]) for column in x.T])
    inside = np.interp(t, *_edges(start, end, end - start)) if len(start) else np.zeros(len(t))
    steps = 0.5 * np.diff(t - inside)[:, None] * (smooth[1:] + smooth[:-1])
    return np.concatenate([np.zeros((1, x.shape[1])), np.cumsum(steps, axis=0)])


def _edges(start: Array, end: Array, each: Array) -> tuple[Array, Array]:
    """Ends of intervals, and what has been gathered up to each if an interval adds `each`."""
    after = np.repeat(np.cumsum(each), 2)
    after[0::2] -= each
    return np.column_stack([start, end]).ravel(), after


def _within(t: Array, start: Array, end: Array, x: Array, every: bool) -> Array:
    """Up to each time, what intervals add whose values at Gauss' nodes are x; not known where there are none."""
    if len(start) == 0:
        return np.zeros((len(t), 1))
    if not every:
        return np.full((len(t), 1), np.nan)
    each = (end - start)[:, None] * np.einsum("wnk,n->wk", x.reshape(len(start), len(NODES), -1), WEIGHTS)
    return np.column_stack([np.interp(t, *_edges(start, end, y)) for y in each.T])


def merged(start: Array, end: Array, t: Array) -> tuple[Array, Array]:
    """Intervals in order, those that meet as one, within the times t."""
    if len(start) == 0:
        return start, end
    order = np.argsort(start)
    start, end = np.clip(start[order], t[0], t[-1]), np.clip(np.maximum.accumulate(end[order]), t[0], t[-1])
    new = np.concatenate([[True], start[1:] > end[:-1]])
    last = np.concatenate([np.flatnonzero(new)[1:] - 1, [len(start) - 1]])
    return start[new], end[last]


def split(start: Array, end: Array, at: Array) -> tuple[Array, Array]:
    """Intervals that do not overlap, in order, cut in pieces at the times that lie within them."""
    place = np.searchsorted(start, at, side="right") - 1
    cuts = at[(place >= 0) & (at > start[place]) & (at < end[place])] if len(start) else at[:0]
    return np.sort(np.concatenate([start, cuts])), np.sort(np.concatenate([end, cuts]))


def energy(m: Model, t: Array, q: Array, v: Array) -> Array:
    """Kinetic energy and that of constant stiffness and forces, (n, 1) [J]."""
    return np.asarray(states.energy(m, *map(np.ascontiguousarray, (t, q, v))))[:, None]


def fall(m: Model, run: Trajectory) -> float:
    """The speed that the forces at the start would give it over the run, if nothing held it [m/s]."""
    n = run.scene.n_q
    slow = np.eye(n) * SLOW
    kinetic, power = states.power(m, np.full(n, run.t[0]), np.repeat(run.q[:1], n, axis=0), slow)
    return float(np.max(np.abs(power) / (2.0 * kinetic) * SLOW, initial=0.0)) * float(run.t[-1] - run.t[0])
