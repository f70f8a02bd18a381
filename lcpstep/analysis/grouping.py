"""Which motions have settled to one attractor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
OVERLAP = 0.5  # of two clouds of points that are one attractor
MOSTLY = 0.8  # of the states of a motion that is on a periodic one but for slips
NEIGHBOURS = 5.0  # typical distances between points of a cloud, within which another is taken as part of it


@dataclass(frozen=True, eq=False)
class Settled:
    """A run that has settled.

    number : of the run;  states : (k, d) on the section;  scale : units of the coordinates;  tolerance : in these
    units, within which states are the same;  periods : after which it returns, 0 for never
    """

    number: int
    states: Array
    scale: Array
    tolerance: float
    periods: int


def grouped(runs: Sequence[Settled]) -> list[list[int]]:
    """Places in `runs` of those that have settled to one attractor, attractor by attractor."""
    groups: list[list[int]] = []
    for i in range(len(runs)):
        home = next((members for members in groups if same(runs[members[0]], runs[i])), None)
        if home is None:
            groups.append([i])
        else:
            home.append(i)
    return merged(groups, runs)


def merged(groups: list[list[int]], runs: Sequence[Settled]) -> list[list[int]]:
    """The same with aperiodic groups put to those that all their runs, but no two alone, show them to be."""
    result = [list(members) for members in groups if runs[members[0]].periods]
    clouds = [np.concatenate([runs[i].states[-runs[i].periods :] for i in members]) for members in result]
    for members in groups:
        first = runs[members[0]]
        if first.periods:
            continue
        cloud = np.concatenate([runs[i].states for i in members])
        home = next(
            (k for k, other in enumerate(result) if _belongs(cloud, first, clouds[k], runs[other[0]])), -1
        )
        if home < 0:
            result.append(list(members))
            clouds.append(cloud)
            continue
        result[home].extend(members)
        if not runs[result[home][0]].periods:
            clouds[home] = np.concatenate([clouds[home], cloud])
    return result


def _belongs(cloud: Array, a: Settled, other: Array, b: Settled) -> bool:
    """Whether an aperiodic cloud is of another group: of a periodic one where it slips along it now and then."""
    if not b.periods:
        return overlap(cloud, other)
    from scipy.spatial import cKDTree

    away = cKDTree(other / b.scale).query(cloud / b.scale, p=np.inf)[0]
    return bool(np.mean(np.asarray(away) <= max(a.tolerance, b.tolerance)) >= MOSTLY)


def same(a: Settled, b: Settled) -> bool:
    """Whether two runs have settled to one attractor."""
    if bool(a.periods) != bool(b.periods):
        return False
    if not a.periods:
        return overlap(a.states, b.states)
    return near(a.states[-a.periods :], b.states[-b.periods :], a.scale, max(a.tolerance, b.tolerance))


def near(a: Array, b: Array, scale: Array, tolerance: float) -> bool:
    """Whether every point of either set has one of the other within the tolerance."""
    one, other = a / scale, b / scale
    distance = np.max(np.abs(one[:, None, :] - other[None, :, :]), axis=-1)
    return bool(max(np.max(np.min(distance, axis=0)), np.max(np.min(distance, axis=1))) <= tolerance)


def overlap(a: Array, b: Array) -> bool:
    """Whether two clouds of points are of one attractor: most of the smaller lies in the gaps of the larger."""
    from scipy.spatial import cKDTree

    scale = np.maximum(np.ptp(np.concatenate([a, b]), axis=0), 1e-300)
    # A cycle that rounding has closed repeats its points, and says nothing of the distance between points
    x, y = sorted((np.unique(x / scale, axis=0) for x in (a, b)), key=len, reverse=True)
    tree = cKDTree(x)
    own = float(np.median(np.asarray(tree.query(x, k=2)[0])[:, 1])) if len(x) > 1 else 0.0
    return bool(np.mean(np.asarray(tree.query(y)[0]) <= NEIGHBOURS * own) >= OVERLAP)
