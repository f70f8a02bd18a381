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
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.simulation import simulate
from lcpstep.trajectory import Kind, Status

Array = NDArray[np.float64]
Family = Callable[[float], Scene]
Phases = dict[tuple[int, str, int], float]
Places = tuple[Phases, Array]  # of the followed events, and of the corners
FORGOTTEN = 4  # periods after which a motion that sticks has forgotten its start
ROOT = 1e-12  # relative accuracy of a crossing
AT_CORNER = 1e-11  # of the period: a release this near to a corner lies on it
REACHED = 1e-7  # of the period: how near the event must come to the corner at the parameter found
APART = 1e-7  # of the parameter: crossings nearer to each other than this may be missed in pairs
TWICE, NEIGHBOURS = 1e-9, 64  # crossings of one event this near are one; among so many at about one parameter
GOLDEN = 0.5 * (3.0 - 5.0**0.5)
SAFE = 4.0  # by how much the bend of an event's way, seen at five places, is taken for larger between them


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
    checks.instance("scene", scene, Scene)
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
    impacts: int = 12,
    method: EventDriven | None = None,
    progress: Callable[[float], None] | None = None,
) -> list[Crossing]:
    """Parameters at which a release, one of the first impacts, or an accumulation point lies on a corner.

    The range is divided until over each part each event either keeps away from each corner by more than its way
    bends, or passes it once; kinks and jumps are closed in upon to 1e-7 of the parameter.

    Parameters
    ----------
    make : p -> scene, at whose start the contact is closed
    p_range : (low, high)
    impacts : how many impacts of each sequence are followed
    progress : called with the parameter reached

    Returns
    -------
    crossings by increasing parameter, each located to 1e-12 of it; beyond it the event may be elsewhere, or the
    sequence without an end

    Raises
    ------
    ValueError   an empty or reversed range
    """
    checks.function("make", make, "the parameter that makes a scene")
    low, high = (checks.number("p_range", end) for end in p_range)
    if not low < high:
        raise ValueError(f"p_range: expected low < high, got {p_range!r}")
    followed = _Followed(make, impacts, method)
    found: list[Crossing] = []
    # Divided by the golden section at first: a crossing in the middle of the range lies on no place that is looked at
    golden = low + GOLDEN * (high - low)
    grids = [[float(p) for p in np.linspace(*ends, 5)] for ends in ((golden, high), (low, golden))]
    waiting = [(grid, [followed.places(p) for p in grid]) for grid in grids]
    while waiting:
        p, at = waiting.pop()
        if p[-1] - p[0] > APART * abs(p[-1]) and not plain(at):
            middle = [0.5 * (a + b) for a, b in pairwise(p)]
            fine = sorted([*p, *middle])
            new = dict(zip(p, at, strict=True)) | {x: followed.places(x) for x in middle}
            for part in (fine[4:], fine[:5]):  # the lower half is taken first
                waiting.append((part, [new[x] for x in part]))
            continue
        for a, b, at_a, at_b in zip(p, p[1:], at, at[1:], strict=False):
            found += followed.crossings(a, b, at_a, at_b)
            found += followed.ends(a, b, at_a, at_b) + followed.ends(b, a, at_b, at_a)
        if progress is not None:
            progress(p[-1])
    return told_once(sorted(found, key=lambda c: c.p))


@dataclass(frozen=True, eq=False)
class _Followed:
    """The chattering sequences of a family of scenes, and what is followed of them."""

    make: Family
    impacts: int
    method: EventDriven | None

    def places(self, p: float) -> Places:
        """Phases of the followed events, by sequence, kind and number, and of the corners."""
        scene, found = self.make(p), {}
        for i, s in enumerate(sequences(scene, self.method)):
            found[i, "release", 0] = s.release
            found[i, "accumulation", 0] = s.accumulation
            found |= {(i, "impact", j + 1): float(x) for j, x in enumerate(s.impacts[: self.impacts])}
        return found, np.asarray(scene.corners) / scene.period

    def crossings(self, a: float, b: float, at_a: Places, at_b: Places) -> list[Crossing]:
        """Events that are there at both ends of an interval, on the two sides of a corner."""
        found = []
        for event in at_a[0].keys() & at_b[0].keys():
            for c, (corner_a, corner_b) in enumerate(zip(at_a[1], at_b[1], strict=True)):
                start, end = _distance(at_a[0][event], corner_a), _distance(at_b[0][event], corner_b)
                off = _off(event, start), _off(event, end)
                if off[0] * off[1] <= 0.0 and abs(start - end) < 0.5 and off[0] != off[1]:
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
            phases, corners = self.places(p)
            if event not in phases:
                raise LcpStepError("lost")
            d = _distance(phases[event], corners[c])
            return abs(d) - AT_CORNER if stays else d

        stays = 0.0 in (_off(event, start), _off(event, end))
        try:
            p = float(brentq(distance, a, b, xtol=ROOT * abs(b), rtol=4.0 * np.finfo(float).eps))
            # Where it jumps once it has passed the corner, one side comes near
            near = min(abs(distance(min(max(p + k * ROOT * abs(b), a), b))) for k in (0, -2, 2))
        except LcpStepError:  # the event is not there all the way
            return None
        return p if near <= REACHED else None

    def ends(self, a: float, b: float, at_a: Places, at_b: Places) -> list[Crossing]:
        """Events on a corner where their sequence, which is there at a and not at b, ends to be."""
        found = []
        for i in {event[0] for event in at_a[0]} - {event[0] for event in at_b[0]}:
            there, gone, last = a, b, at_a
            while abs(there - gone) > ROOT * abs(b):
                p = 0.5 * (there + gone)
                now = self.places(p)
                if (i, "release", 0) in now[0]:
                    there, last = p, now
                else:
                    gone = p
            for event in (e for e in last[0] if e[0] == i):
                for c, corner in enumerate(last[1]):
                    near = abs(_distance(last[0][event], corner)) <= REACHED
                    if near and event[1] != "release":
                        found.append(Crossing(*event, c, 0.5 * (there + gone)))
        return found


def told_once(found: list[Crossing]) -> list[Crossing]:
    """Without those told twice, by both neighbours of a parameter at which the event was seen on the corner."""
    kept: list[Crossing] = []
    for c in found:
        if not any(k[:4] == c[:4] and c.p - k.p <= TWICE * abs(c.p) for k in kept[-NEIGHBOURS:]):
            kept.append(c)
    return kept


def plain(at: list[Places]) -> bool:
    """Whether at five equally spaced parameters each event keeps to one side of each corner, or passes it once."""
    events = at[0][0].keys()
    if any(phases.keys() != events for phases, _ in at):
        return False
    if not events:
        return True
    phases = np.array([[found[event] for event in events] for found, _ in at])
    d = _distance(phases[:, :, None], np.array([corners for _, corners in at])[:, None, :])
    may_stay = np.array([event[1] == "release" for event in events])[:, None]
    d = np.where(may_stay & (np.abs(d) <= AT_CORNER), 0.0, d)
    steps = _distance(d[1:], d[:-1])
    bend = SAFE * np.max(np.abs(np.diff(steps, axis=0)), axis=0)
    away = (np.min(np.abs(d), axis=0) > bend) & ((np.min(d, axis=0) > 0.0) | (np.max(d, axis=0) < 0.0))
    far = (
        np.min(np.abs(d), axis=0) > np.max(np.abs(steps), axis=0) + bend
    )  # where the distance turns about, too
    once = np.min(np.abs(steps), axis=0) > bend
    stays = np.all(d == 0.0, axis=0)
    return bool(np.all(away | far | once | stays))


def _distance(phase: Any, corner: Any) -> Any:
    """From a corner to an event, as share of the period in [-1/2, 1/2)."""
    return (phase - corner + 0.5) % 1.0 - 0.5


def _off(event: tuple[int, str, int], distance: float) -> float:
    """A distance of which rounding is taken for zero: a release may stay on a corner over a range of parameters."""
    return 0.0 if event[1] == "release" and abs(distance) <= AT_CORNER else distance
