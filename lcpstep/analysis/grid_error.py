"""How far the grid of a time-stepping method moves a motion: by how much two orbits must differ to be two.

Impacts fall on the grid of the steps, and so a periodic motion comes back only roughly, or after some multiple of its
period. What another grid makes of the same motion says how roughly: every period is taken again with a step drawn
between h/2 and h. The largest distance from the motion itself over some periods is its spread; the distance after a
single one is the error that the grid makes in each. A motion that forgets its errors spreads a few times as far as
that, a chaotic one over its whole attractor.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.analysis.variation import PeriodMap
from lcpstep.maps.batch import PER_PERIOD, Periods, periods
from lcpstep.maps.one_by_one import continued
from lcpstep.simulation import Method, simulate

Array = NDArray[np.float64]
COPIES, PERIODS = 5, 24  # other grids, and for how long each
FORGETFUL = 25.0  # errors of a period that a motion may be away which forgets them
APART = 2.0  # radii that two states of one periodic motion may be apart
WIDEST = 0.25  # of the motion's size: where they may be farther apart nothing is told from it


@dataclass(frozen=True, eq=False)
class Spread:
    """Of m motions, in units of the largest value of each coordinate along each.

    Attributes
    ----------
    scale : (m, d)   these units
    radius : (m,)   how far the grid moves each motion while that stays within what a motion may be that forgets
    forgets : (m,)   whether errors mostly stay as small as those of a few periods, and much smaller than the motion
    paths : (m, k, d)   states that the motion came to on other grids
    """

    scale: Array
    radius: Array
    forgets: NDArray[np.bool_]
    paths: Array


def spread(scene: Scene, method: Method, states: Array, phase: float, seed: int = 0) -> Spread:
    """How far the grid moves the motions from the given states (m, d) on the section."""
    random = np.random.default_rng(seed)
    m = len(states)
    own, others = states, np.tile(states, (COPIES, 1))
    scale = np.array([_size(scene, method, x, phase) for x in states])
    apart, errors, paths = [], [], []
    for _ in range(PERIODS):
        finer = finer_method(method, float(random.uniform(0.5, 1.0)))
        same = periods(scene, method, others, 1, phase=phase, most=0, strict=False).final
        others = periods(scene, finer, others, 1, phase=phase, most=0, strict=False).final
        own = periods(scene, method, own, 1, phase=phase, most=0, strict=False).final
        paths.append(others.reshape(COPIES, m, -1))
        apart.append(np.abs(paths[-1] - own))
        errors.append(np.abs(others - same).reshape(COPIES, m, -1))
    away = np.max(np.array(apart) / scale, axis=-1).reshape(-1, m)  # all times and grids
    error = np.median(np.max(np.array(errors) / scale, axis=-1).reshape(-1, m), axis=0)
    usual = np.minimum(FORGETFUL * error, WIDEST)
    radius = np.max(
        np.where(away <= usual, away, 0.0), axis=0
    )  # a motion may slip to another one now and then
    forgets = (np.median(away, axis=0) <= usual) & (APART * radius <= WIDEST)
    return Spread(scale, radius, forgets, np.concatenate(paths).transpose(1, 0, 2))


def wandered(scene: Scene, method: Method, states: Array, n: int, phase: float, seed: int = 1) -> Array:
    """Where the motions from the given states (m, d) have come to after n periods, each on a grid of its own.

    A cycle that only one grid has, on a saddle that motions leave, is left: what remains is an attractor.
    """
    random = np.random.default_rng(seed)
    for _ in range(n):
        finer = finer_method(method, float(random.uniform(0.5, 1.0)))
        states = periods(scene, finer, states, 1, phase=phase, most=0, strict=False).final
    return states


def on_other_grids(P: PeriodMap, starts: Array, n: int, drop: int, most: int, seed: int = 0) -> Periods:
    """Runs of n periods, each on a grid of its own; on one and the same grid all would come to one cycle of it."""
    random = np.random.default_rng(seed)
    x, kept = starts, []
    for k in range(n):
        finer = replace(P, method=finer_method(P.method, float(random.uniform(0.9, 1.0))))
        run = finer.many(x, 1, most=most if k >= drop else 0)
        x = run.final
        if k >= drop:
            kept.append(run)
    joined = {name: np.concatenate([getattr(run, name) for run in kept], axis=1) for name in PER_PERIOD}
    return replace(kept[-1], **joined)


def _size(scene: Scene, method: Method, x: Array, phase: float) -> Array:
    """Largest value of each coordinate and velocity within a period, for one may rest on the section."""
    t = phase * scene.period
    run = simulate(continued(scene, x, (t, t + scene.period)), method)
    largest = np.max(np.abs(np.concatenate([run.q, run.v], axis=1)), axis=0)
    return np.maximum(largest, 1e-300)


def finer_method(method: Any, share: float) -> Any:
    """The method on another grid: this share of its step, or of the tolerance that chooses its steps."""
    if getattr(method, "tolerance", None) is not None:
        return replace(method, tolerance=share * method.tolerance)
    return replace(method, h=share * method.h)
