"""How near to an attractor a motion must come to be sure to stay: balls around its points, judged by probes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, Scene
from lcpstep.analysis.attractor import Attractor
from lcpstep.analysis.cells import UNKNOWN
from lcpstep.analysis.starts import outside
from lcpstep.maps.batch import Targets, periods
from lcpstep.simulation import Method

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
RADII = np.geomspace(1e-1, 1e-6, 26)  # candidates for the radius of a ball, of the attractor's size
PROBES = 64  # states on whose fate a radius is judged
FEW = 4  # of these that are followed first: most radii that are too large fail by them


def neighbourhoods(
    scene: Scene | HybridScene,
    method: Method,
    found: tuple[Attractor, ...],
    phase: float,
    longest: int,
    seed: int,
) -> tuple[Targets, Ints]:
    """Balls around the points of attractors that go there, judged by probes on them; and whose they are."""
    if not found:
        return Targets(np.zeros((0, 2)), np.zeros(0), np.ones(2)), np.zeros(0, dtype=np.int64)
    centre, owner, scale = _points(found)
    periodic = np.array([a.periods > 0 for a in found])[owner]
    sure, owner_of_sure = smallest(found)
    direction = np.random.default_rng([seed, 1]).uniform(-1.0, 1.0, (PROBES, 2))
    direction /= np.max(np.abs(direction), axis=1, keepdims=True)

    def fate(probes: Array) -> Ints:
        probes = outside(scene, probes, phase)
        if len(probes) == 0 or len(owner_of_sure) == 0:  # nothing to go to
            return np.full(len(probes), UNKNOWN)
        went = periods(scene, method, probes, longest, drop=longest, phase=phase, targets=sure).reached
        return np.append(owner_of_sure, UNKNOWN)[went]

    def go_to(home: int, probes: Array) -> bool:
        some, others = fate(probes[:FEW]), np.zeros(0)
        if np.all(some == home):
            others = fate(probes[FEW:])
        return len(some) + len(others) > 0 and bool(np.all(some == home) and np.all(others == home))

    radius = np.full(len(centre), RADII[-1])
    for k in np.flatnonzero(periodic):
        for r in RADII[:-1]:
            if go_to(owner[k], centre[k] + r * scale * direction):
                radius[k] = 0.5 * r
                break
    for a in set(owner[~periodic].tolist()):
        cloud = centre[owner == a]
        some = cloud[np.linspace(0, len(cloud) - 1, PROBES).astype(int)]
        r = spacing(cloud / scale)
        while r > RADII[-1] and np.any(fate(some + 2.0 * r * scale * direction) >= 0):
            r *= 0.5
        radius[owner == a] = r
    return Targets(centre, radius, scale), owner


def smallest(found: tuple[Attractor, ...]) -> tuple[Targets, Ints]:
    """The smallest balls around the points of the periodic attractors alone, and whose they are."""
    centre, owner, scale = _points(found)
    periodic = np.array([a.periods > 0 for a in found], dtype=bool)[owner]
    return Targets(centre[periodic], np.full(int(np.sum(periodic)), RADII[-1]), scale), owner[periodic]


def _points(found: tuple[Attractor, ...]) -> tuple[Array, Ints, Array]:
    """Points of all attractors, whose they are, and the units of the coordinates."""
    if not found:
        return np.zeros((0, 2)), np.zeros(0, dtype=np.int64), np.ones(2)
    centre = np.concatenate([a.points for a in found])
    owner = np.repeat(np.arange(len(found)), [len(a.points) for a in found])
    scale = np.maximum(np.max(np.abs(centre), axis=0), 1e-9 * float(np.max(np.abs(centre))) or 1.0)
    return centre, owner, scale


def spacing(points: Array) -> float:
    """Median distance of the points of a cloud (k, 2) to their nearest neighbours."""
    from scipy.spatial import cKDTree

    return float(np.median(np.asarray(cKDTree(points).query(points, k=2)[0])[:, 1]))
