"""Chattering sequences along a parameter, and where they meet the corners of the forcing.

A sequence begins where a closed contact opens (release), goes on with infinitely many impacts, and ends where they
accumulate and the contact is closed again. A motion that sticks forgets all but the parameter, so its release, its
j-th impacts and its accumulation point are functions of the parameter alone. Where one of them passes a corner of the
forcing the diagram of the motion has a kink or a jump (a "bubble"). Source: G. Osorio, Complex Behavior in Impacting
Systems, section 4.3.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.simulate import simulate
from lcpstep.trajectory import Kind, Status

Array = NDArray[np.float64]
Family = Callable[[float], Scene]
Phases = dict[tuple[int, str, int], float]
FORGOTTEN = 4  # periods after which a motion that sticks has forgotten its start
ROOT = 1e-12  # relative accuracy of a crossing
AT_CORNER = 1e-11  # of the period: an event this near to a corner lies on it
REACHED = 1e-7  # of the period: how near the event must come to the corner at the parameter found


@dataclass(frozen=True, eq=False)
class Sequence:
    """A chattering sequence; phases are shares of the period in [0, 1).

    Attributes
    ----------
    release : phase at which the contact opens
    impacts : (m,) phases of the impacts before the chatter map takes over
    speeds : (m,) gap velocities before these impacts [m/s]
    accumulation : phase at which the contact is closed again
    """

    release: float
    impacts: Array
    speeds: Array
    accumulation: float


class Crossing(NamedTuple):
    """An event of a sequence that lies on a corner.

    sequence : number of the sequence within the period, from 0;  event : "release", "impact" or "accumulation";
    number : which impact, from 1 (0 for the others);  corner : index in scene.corners;  p : the parameter
    """

    sequence: int
    event: str
    number: int
    corner: int
    p: float


def sequences(scene: Scene, method: EventDriven | None = None) -> list[Sequence]:
    """The chattering sequences that begin within one period of the motion that rests on the obstacle at first.

    Parameters
    ----------
    scene : lagrangian.Scene with one contact and a period, at whose start the contact is closed
    method : EventDriven() where not given

    Returns
    -------
    in the order of their releases; empty where the contact never opens, or never closes for good again

    Raises
    ------
    ValueError   the scene has not just one contact, or no period
    LcpStepError   the run ended early
    """
    if scene.n_c != 1 or not math.isfinite(scene.period):
        raise ValueError(f"scene: expected one contact and a period, {scene.name!r} has not both")
    T, t0 = scene.period, scene.t_span[0]
    span = (t0, t0 + (FORGOTTEN + 2) * T)
    run = simulate(replace(scene, t_span=span, exact=None), method or EventDriven(), keep=[span[1]])
    if run.status != Status.DONE:
        raise LcpStepError(f"the motion ended early: {run.message}")
    log = run.impacts
    found = []
    for k in np.flatnonzero(log.kind == Kind.RELEASE):
        if not t0 + FORGOTTEN * T <= log.time[k] < t0 + (FORGOTTEN + 1) * T:
            continue
        ends = np.flatnonzero(log.kind[k:] == Kind.STICK)
        if len(ends) == 0:
            continue
        events = log[k : k + ends[0] + 1]
        hits = events[events.kind == Kind.IMPACT]
        found.append(
            Sequence(
                release=float(log.time[k] / T % 1.0), impacts=np.asarray(hits.time / T % 1.0),
                speeds=np.asarray(hits.before), accumulation=float(events.time[-1] / T % 1.0),
            )
        )  # fmt: skip
    return found


def corner_crossings(
    make: Family,
    p_range: tuple[float, float],
    *,
    points: int = 200,
    impacts: int = 12,
    method: EventDriven | None = None,
    progress: Callable[[float], None] | None = None,
) -> list[Crossing]:
    """Parameters at which a release, one of the first impacts, or an accumulation point lies on a corner.

    Parameters
    ----------
    make : p -> scene, at whose start the contact is closed
    p_range : (low, high)
    points : of the grid on which sign changes are looked for
    impacts : how many impacts of each sequence are followed
    progress : called with the parameter reached

    Returns
    -------
    crossings by increasing parameter, each located to 1e-12 of it; beyond it the event may be elsewhere, or the
    sequence without an end

    Raises
    ------
    ValueError   an empty or reversed range, or fewer than two points
    """
    low, high = (checks.number("p_range", end) for end in p_range)
    if not low < high:
        raise ValueError(f"p_range: expected low < high, got {p_range!r}")
    if checks.count("points", points) < 2:
        raise ValueError(f"points: expected at least 2, got {points}")
    followed = _Followed(make, impacts, method)
    found: list[Crossing] = []
    before: Phases = {}
    grid = [float(p) for p in np.linspace(low, high, points)]
    for k, p in enumerate(grid):
        now = followed.phases(p)
        if k > 0:
            found += followed.crossings(grid[k - 1], p, before, now)
            found += followed.ends(grid[k - 1], p, before, now) + followed.ends(p, grid[k - 1], now, before)
        before = now
        if progress is not None:
            progress(p)
    return sorted(found, key=lambda c: c.p)


@dataclass(frozen=True, eq=False)
class _Followed:
    """The chattering sequences of a family of scenes, and what is followed of them."""

    make: Family
    impacts: int
    method: EventDriven | None

    def phases(self, p: float) -> Phases:
        """Phase of each followed event, by sequence, kind and number."""
        found = {}
        for i, s in enumerate(sequences(self.make(p), self.method)):
            found[i, "release", 0] = s.release
            found[i, "accumulation", 0] = s.accumulation
            found |= {(i, "impact", j + 1): float(x) for j, x in enumerate(s.impacts[: self.impacts])}
        return found

    def corners(self, p: float) -> Array:
        """Phases of the corners."""
        scene = self.make(p)
        return np.asarray(scene.corners) / scene.period

    def crossings(self, a: float, b: float, at_a: Phases, at_b: Phases) -> list[Crossing]:
        """Events that are there at both ends of an interval, on the two sides of a corner."""
        found = []
        for event in at_a.keys() & at_b.keys():
            for c, (corner_a, corner_b) in enumerate(zip(self.corners(a), self.corners(b), strict=True)):
                start, end = _distance(at_a[event], corner_a), _distance(at_b[event], corner_b)
                if _off(start) * _off(end) <= 0.0 and abs(start - end) < 0.5 and _off(start) != _off(end):
                    p = self.located(event, c, a, b, start, end)
                    if p is not None:
                        found.append(Crossing(*event, c, p))
        return found

    def located(
        self, event: tuple[int, str, int], c: int, a: float, b: float, start: float, end: float
    ) -> float | None:
        """The parameter between a and b at which an event comes to corner c; None where it jumps across it.

        start, end : its distance at a and b
        """
        from scipy.optimize import brentq

        def distance(p: float) -> float:
            phase = self.phases(p).get(event)
            if phase is None:
                raise LcpStepError("lost")
            d = _distance(phase, self.corners(p)[c])
            return abs(d) - AT_CORNER if stays else d

        stays = _off(start) == 0.0 or _off(end) == 0.0
        try:
            p = float(brentq(distance, a, b, xtol=ROOT * abs(b), rtol=4.0 * np.finfo(float).eps))
            # Where it jumps once it has passed the corner, one side comes near
            near = min(abs(distance(min(max(p + k * ROOT * abs(b), a), b))) for k in (0, -2, 2))
        except LcpStepError:  # the event is not there all the way
            return None
        return p if near <= REACHED else None

    def ends(self, a: float, b: float, at_a: Phases, at_b: Phases) -> list[Crossing]:
        """Events on a corner where their sequence, which is there at a and not at b, ends to be."""
        found = []
        for i in {event[0] for event in at_a} - {event[0] for event in at_b}:
            there, gone, last = a, b, at_a
            while abs(there - gone) > ROOT * abs(b):
                p = 0.5 * (there + gone)
                now = self.phases(p)
                if (i, "release", 0) in now:
                    there, last = p, now
                else:
                    gone = p
            for event in (e for e in last if e[0] == i):
                for c, corner in enumerate(self.corners(there)):
                    near = abs(_distance(last[event], corner)) <= REACHED
                    if near and event[1] != "release":
                        found.append(Crossing(*event, c, 0.5 * (there + gone)))
        return found


def _distance(phase: float, corner: float) -> float:
    """From a corner to an event, as share of the period in [-1/2, 1/2)."""
    return float((phase - corner + 0.5) % 1.0 - 0.5)


def _off(distance: float) -> float:
    """A distance of which rounding is taken for zero: a release may stay on a corner over a range of parameters."""
    return 0.0 if abs(distance) <= AT_CORNER else distance
