"""Chattering sequences along a parameter, and where they meet the corners of the forcing.

A sequence begins where a closed contact opens (release), goes on with infinitely many impacts, and ends where they
accumulate and the contact is closed again. A motion that sticks forgets all but the parameter, so its release, its
j-th impacts and its accumulation point are functions of the parameter alone. Where one of them passes a corner of the
forcing the diagram of the motion has a kink or a jump (a "bubble"). Source: G. Osorio, Complex Behavior in Impacting
Systems, section 4.3.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
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
    crossings by increasing parameter, each located to 1e-12 of it

    Raises
    ------
    ValueError   an empty or reversed range, or fewer than two points
    """
    low, high = (checks.number("p_range", end) for end in p_range)
    if not low < high:
        raise ValueError(f"p_range: expected low < high, got {p_range!r}")
    if checks.count("points", points) < 2:
        raise ValueError(f"points: expected at least 2, got {points}")
    grid = np.linspace(low, high, points)
    before: dict[tuple[int, str, int, int], float] = {}
    found: list[Crossing] = []
    for k, p in enumerate(grid):
        now = _distances(make(float(p)), impacts, method)
        for key in before.keys() & now.keys():
            a, b = _off(before[key]), _off(now[key])
            if a * b <= 0.0 and abs(a - b) < 0.5 and (a, b) != (0.0, 0.0):
                root = _located(
                    make, key, float(grid[k - 1]), float(p), before[key], now[key], impacts, method
                )
                if root is not None:
                    found.append(Crossing(*key, root))
        before = now
        if progress is not None:
            progress(float(p))
    return sorted(found, key=lambda c: c.p)


def _distances(
    scene: Scene, impacts: int, method: EventDriven | None
) -> dict[tuple[int, str, int, int], float]:
    """From each corner to each followed event, as shares of the period in [-1/2, 1/2)."""
    corners = np.asarray(scene.corners) / scene.period

    def events(s: Sequence) -> Iterator[tuple[str, int, float]]:
        yield "release", 0, s.release
        for j, phase in enumerate(s.impacts[:impacts]):
            yield "impact", j + 1, float(phase)
        yield "accumulation", 0, s.accumulation

    return {
        (i, event, number, c): float((phase - corner + 0.5) % 1.0 - 0.5)
        for i, s in enumerate(sequences(scene, method))
        for event, number, phase in events(s)
        for c, corner in enumerate(corners)
    }


def _off(distance: float) -> float:
    """A distance of which rounding is taken for zero: a release may stay on a corner over a range of parameters."""
    return 0.0 if abs(distance) <= AT_CORNER else distance


def _located(
    make: Family,
    key: tuple[int, str, int, int],
    a: float,
    b: float,
    start: float,
    end: float,
    impacts: int,
    method: EventDriven | None,
) -> float | None:
    """The parameter between a and b at which an event comes to its corner; None where it jumps across it.

    start, end : its distance at a and b
    """
    from scipy.optimize import brentq

    def distance(p: float) -> float:
        found = _distances(make(p), impacts, method)
        if key not in found:
            raise LcpStepError("lost")
        return abs(found[key]) - AT_CORNER if stays else found[key]

    stays = _off(start) == 0.0 or _off(end) == 0.0
    try:
        p = float(brentq(distance, a, b, xtol=ROOT * abs(b), rtol=4.0 * np.finfo(float).eps))
        near = distance(p)
    except LcpStepError:  # the event is not there all the way
        return None
    return p if abs(near) <= REACHED else None
