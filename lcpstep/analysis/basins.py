"""Basins of attraction on a grid of initial states, by cell mapping with exact trajectories.

1. Every cell's centre is carried through two periods; its images are exact states, not cells.
2. A cell is settled once an image lies near an attractor, or in a cell that is settled on the same attractor as
   all its eight neighbours. Repeated until nothing changes, the labels spread outwards from the attractors.
3. Cells left over, those between basins, are carried on from their last image, two periods a round, and the few of
   the last round until they come near an attractor themselves. Attractors are looked for once more from cells that
   then have no label.

So only the labels of homogeneous neighbourhoods are shared, and a label depends neither on the order of the cells
nor on how the work is divided. The share of an attractor is that of its cells; its uncertainty is that of a grid
estimate of an area (binomial, of the cells at a boundary alone) together with the share of wrong labels, bounded from
a random sample of cells that are followed to their end one by one. Source of the idea: C. S. Hsu, Cell-to-Cell
Mapping (Springer 1987).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.attractors import Attractor, Attractors, attractors, random_starts, with_new
from lcpstep.dataset import Progress, labelled, provenance
from lcpstep.events import EventDriven
from lcpstep.maps.batch import INSIDE, Targets, periodic, periods
from lcpstep.simulation import Method
from lcpstep.sweep import Arrays, sweep

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
UNKNOWN, OBSTACLE = -1, -2  # labels: no attractor was reached; the cell's centre lies inside of the obstacle
PARTS = 32  # of a stage, at most, for every part is a file
LEAST = 8192  # cells of a part
IMAGES = 2  # exact images of a cell in a round
ROUNDS, FEW = 24, 0.002  # of images and sharing; the share of cells left at which they end
STARTS = 200  # random states from which attractors are looked for
RADII = np.geomspace(
    1e-1, 1e-6, 26
)  # candidates for the neighbourhood of an attractor that goes to it, of its size
PROBES = 64  # states on whose fate a radius is judged
CONFIDENCE = 0.95


def basins(
    scene: Scene | HybridScene,
    lowest: ArrayLike,
    highest: ArrayLike,
    shape: tuple[int, int] = (200, 200),
    *,
    method: Method | None = None,
    known: Attractors | None = None,
    phase: float = 0.0,
    longest: int = 1000,
    sample: int = 2000,
    seed: int = 0,
    executor: Executor | None = None,
    jobs: int | None = None,
    out: Path | str | None = None,
    progress: Progress | None = None,
) -> Any:
    """Basins of attraction over a rectangle of states of one degree of freedom.

    Parameters
    ----------
    scene : lagrangian.Scene with a period and one coordinate, or HybridScene with a period and two states
    lowest, highest : (2,)   corners of the rectangle of states (q, v) at the section
    shape : number of cells along q and along v
    method : EventDriven() where not given
    known : attractors, from `attractors`; looked for from random states of the rectangle where not given
    phase : of the section, as a share of the period in [0, 1)
    longest : periods after which a motion that has reached no attractor is left unlabelled
    sample : number of cells followed one by one to judge the labels; 0 for none
    seed : of the random states and of the sample
    executor, jobs, out, progress : see `lcpstep.sweep.sweep`

    Returns
    -------
    xarray.Dataset   label on (v, q): number of the attractor, -1 for none, -2 for cells inside of the
        obstacle; and on (attractor): name, share of the admissible cells, share_error (half of its 95 % interval)

    Raises
    ------
    ValueError   an empty or reversed rectangle, a grid without cells, more than one coordinate
    SweepStopped   the executor died; finished parts are kept in `out`
    """
    if scene.n_x != 2:
        raise ValueError(
            f"scene: expected two states, {scene.name!r} has {scene.n_x}: {', '.join(scene.labels)}"
        )
    low, high = checks.array("lowest", lowest, (2,)), checks.array("highest", highest, (2,))
    if not np.all(low < high):
        raise ValueError(f"lowest, highest: expected an increasing range of q and of v, got {low} and {high}")
    n_q, n_v = (checks.count("shape", n) for n in shape)
    longest, method = checks.count("longest", longest), method or EventDriven()
    complete = known is None
    if known is None:
        starts = outside(scene, random_starts([low, high], STARTS, seed), phase)
        known = attractors(scene, method, starts, phase=phase, transient=longest)
    grid = Grid(low, high, n_q, n_v)
    targets = neighbourhoods(scene, method, known.found, phase, longest, seed)
    study = _Study(scene, method, grid, targets, phase, longest)
    inputs = study.inputs(known)
    label, x = np.full(n_q * n_v, UNKNOWN), grid.centres(np.arange(n_q * n_v))
    rest, landed = np.arange(n_q * n_v), np.zeros((n_q * n_v, 0), dtype=np.int64)

    def stage(name: str, work: Callable[..., Any], least: int) -> Arrays:
        size = max(least, -(-len(rest) // PARTS))
        chains = [[x[rest[i : i + size]]] for i in range(0, len(rest), size)]
        folder = None if out is None else Path(out) / name
        done = sweep(
            work,
            chains,
            inputs | {"stage": name, "cells_of_a_part": size},
            out=folder,
            executor=executor,
            jobs=jobs,
            progress=progress,
        )
        return {key: np.concatenate([chain[0][key] for chain in done]) for key in done[0][0]}

    for k in range(ROUNDS):
        found = stage(f"round-{k:02d}", study.images if k else study.first_images, LEAST)
        label[rest], x[rest] = found["label"], found["x"]
        landed = np.concatenate([landed, found["landed"]], axis=1)
        spread(grid, rest, landed, label)
        left = label[rest] == UNKNOWN
        rest, landed = rest[left], landed[left]
        if len(rest) <= FEW * len(label):
            break
    if len(rest):
        label[rest] = stage("rest", study.to_the_end, LEAST // 8)["label"]
    rest = np.flatnonzero(label == UNKNOWN)
    if len(rest) and complete:  # they may go to attractors that no random start went to
        some = rest[np.linspace(0, len(rest) - 1, min(len(rest), STARTS)).astype(int)]
        more = attractors(scene, method, grid.centres(some), phase=phase, transient=longest)
        known = with_new(known, more)
        study = replace(study, targets=neighbourhoods(scene, method, known.found, phase, longest, seed))
        label[rest] = stage("second-look", study.to_the_end, LEAST // 8)["label"]
    wrong = _wrong(study, label, sample, seed)
    return study.dataset(known, label, wrong, seed, sample)


@dataclass(frozen=True, eq=False)
class Grid:
    """Cells of equal size; cell (i, k) has the number i + n_q k."""

    low: Array
    high: Array
    n_q: int
    n_v: int

    def centres(self, cells: Ints) -> Array:
        """(m, 2) states."""
        share = np.stack([(cells % self.n_q + 0.5) / self.n_q, (cells // self.n_q + 0.5) / self.n_v], axis=1)
        return self.low + share * (self.high - self.low)

    def cell(self, x: Array) -> Ints:
        """Numbers of the cells that states (m, 2) lie in, -1 outside of the grid."""
        place = np.floor((x - self.low) / (self.high - self.low) * (self.n_q, self.n_v))
        within = np.all((place >= 0) & (place < (self.n_q, self.n_v)), axis=1)
        place = np.where(within[:, None], place, 0).astype(np.int64)
        return np.where(within, place[:, 0] + self.n_q * place[:, 1], -1)


def outside(scene: Scene | HybridScene, x: Array, phase: float) -> Array:
    """Those of the states (m, 2 n_q) that do not lie inside of the obstacle; all where there is none."""
    if isinstance(scene, HybridScene):
        return x
    periodic(scene)
    t = phase * scene.period
    n = scene.n_q
    return x[[bool(np.all(scene.gap(t, y[:n], y[n:])[0] >= 0.0)) for y in x]]


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
    centre = np.concatenate([a.points for a in found])
    owner = np.repeat(np.arange(len(found)), [len(a.points) for a in found])
    periodic = np.array([a.periods > 0 for a in found])[owner]
    scale = np.maximum(np.max(np.abs(centre), axis=0), 1e-9 * (1.0 + np.max(np.abs(centre))))
    few = int(np.sum(periodic))
    smallest = Targets(centre[periodic], np.full(few, RADII[-1]), scale)
    direction = np.random.default_rng([seed, 1]).uniform(-1.0, 1.0, (PROBES, 2))
    direction /= np.max(np.abs(direction), axis=1, keepdims=True)

    def fate(probes: Array) -> Ints:
        probes = outside(scene, probes, phase)
        if len(probes) == 0:
            return np.zeros(0, dtype=np.int64)
        went = periods(scene, method, probes, longest, drop=longest, phase=phase, targets=smallest).reached
        return np.append(owner[periodic], UNKNOWN)[went]

    radius = np.full(len(centre), RADII[-1])
    for k in np.flatnonzero(periodic):
        for r in RADII[:-1]:
            went = fate(centre[k] + r * scale * direction)
            if len(went) and np.all(went == owner[k]):
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


def spacing(points: Array) -> float:
    """Median distance of the points of a cloud (k, 2) to their nearest neighbours."""
    from scipy.spatial import cKDTree

    return float(np.median(np.asarray(cKDTree(points).query(points, k=2)[0])[:, 1]))


def spread(grid: Grid, cells: Ints, landed: Ints, label: Ints) -> None:
    """Label cells by images that fall into homogeneous neighbourhoods, until nothing changes; label in place.

    landed : (m, k)   numbers of the cells that k images of each of the cells (m,) lie in, -1 outside of the grid
    """
    unlabelled = label[cells] == UNKNOWN
    cells, landed = cells[unlabelled], landed[unlabelled]
    small = label.astype(np.int16)  # a quarter of what has to be read again and again
    while len(cells):
        inner = np.append(homogeneous(small.reshape(grid.n_v, grid.n_q)).ravel(), np.int16(UNKNOWN))
        fate = inner[landed[:, 0]]
        for k in range(1, landed.shape[1]):  # where several images are settled, they are on one attractor
            np.maximum(fate, inner[landed[:, k]], out=fate)
        settled = fate >= 0
        if not np.any(settled):
            return
        label[cells[settled]] = small[cells[settled]] = fate[settled]
        cells, landed = cells[~settled], landed[~settled]


def homogeneous(label: NDArray[Any]) -> NDArray[Any]:
    """The label of cells that share it with their eight neighbours, UNKNOWN elsewhere and at the edge."""
    result = np.full_like(label, UNKNOWN)
    level = (label[:, 1:-1] == label[:, :-2]) & (label[:, 1:-1] == label[:, 2:])
    upright = label[1:-1, 1:-1]
    same = level[1:-1] & level[:-2] & level[2:]
    same &= (upright == label[:-2, 1:-1]) & (upright == label[2:, 1:-1]) & (upright >= 0)
    result[1:-1, 1:-1][same] = upright[same]
    return result


@dataclass(frozen=True, eq=False)
class _Study:
    """What every part knows."""

    scene: Scene | HybridScene
    method: Method
    grid: Grid
    targets: tuple[Targets, Ints]
    phase: float
    longest: int

    def first_images(self, x: Array, handed: Arrays | None) -> tuple[Arrays, Arrays | None]:
        """The same of cells' centres, which may lie inside of the obstacle."""
        return self.images(x, handed, strict=True)

    def images(self, x: Array, handed: Arrays | None, strict: bool = False) -> tuple[Arrays, Arrays | None]:
        """Exact images of states, by their cells and the last in full; the labels of those near an attractor."""
        found = self.follow(x, IMAGES, 0, strict)
        landed = self.grid.cell(found.states.reshape(-1, 2)).reshape(len(x), -1)
        return {"landed": landed.astype(np.int32), "x": found.final, "label": self.label(found)}, None

    def to_the_end(self, x: Array, handed: Arrays | None) -> tuple[Arrays, Arrays | None]:
        """Labels of states that are followed until they are near an attractor."""
        return {"label": self.label(self.follow(x, self.longest, self.longest, True))}, None

    def follow(self, x: Array, n: int, drop: int, strict: bool) -> Any:
        """Runs that end near an attractor."""
        return periods(
            self.scene, self.method, x, n, drop=drop, phase=self.phase, most=0, targets=self.targets[0],
            strict=strict,
        )  # fmt: skip

    def label(self, found: Any) -> Ints:
        """Labels of runs."""
        owner = np.append(self.targets[1], UNKNOWN)
        return np.where(found.status == INSIDE, OBSTACLE, owner[found.reached]).astype(np.int16)

    def inputs(self, known: Attractors) -> dict[str, Any]:
        """What the result depends on."""
        g = self.grid
        return provenance(self.scene, self.method) | {
            "lowest": g.low.tolist(), "highest": g.high.tolist(), "shape": [g.n_q, g.n_v], "phase": self.phase,
            "longest": self.longest, "attractors": [a.name for a in known.found],
            "points": self.targets[0].points.tolist(),
        }  # fmt: skip

    def dataset(self, known: Attractors, label: Ints, wrong: float, seed: int, sample: int) -> Any:
        """Labels and shares."""
        g = self.grid
        names = [a.name for a in known.found] or ["none"]
        admissible = max(int(np.sum(label != OBSTACLE)), 1)
        share = np.array([np.sum(label == k) for k in range(len(names))]) / admissible
        error = np.array([self.error(label, k, admissible) for k in range(len(names))]) + wrong
        attributes = {k: v for k, v in self.inputs(known).items() if k not in ("points", "attractors")}
        attributes |= {
            "labels": list(self.scene.labels), "seed": seed, "sample": sample, "wrong_labels_upper_bound": wrong,
            "unlabelled": float(np.sum(label == UNKNOWN)) / admissible,
        }  # fmt: skip
        cells = np.arange(max(g.n_q, g.n_v))
        return labelled(
            {
                "label": (("v", "q"), label.reshape(g.n_v, g.n_q).astype(np.int16)),
                "share": (("attractor",), share),
                "share_error": (("attractor",), error),
                "name": (("attractor",), np.array(names)),
            },
            {"q": g.centres(cells[: g.n_q])[:, 0], "v": g.centres(cells[: g.n_v] * g.n_q)[:, 1]},
            attributes,
        )

    def error(self, label: Ints, k: int, admissible: int) -> float:
        """Half-width of the 95 % interval of a share: cells at the boundary fall on either side by chance."""
        mine = (label == k).reshape(self.grid.n_v, self.grid.n_q)
        edge = np.zeros(mine.shape, dtype=bool)
        for axis in (0, 1):
            for shift in (1, -1):
                edge |= mine != np.roll(mine, shift, axis)
        return 1.96 * 0.5 * math.sqrt(float(np.sum(edge))) / admissible


def _wrong(study: _Study, label: Ints, sample: int, seed: int) -> float:
    """Upper 95 % bound on the share of wrong labels, from cells followed one by one without sharing any."""
    from scipy.special import betaincinv  # its statistics take half a second to import

    candidates = np.flatnonzero(label != OBSTACLE)
    sample = min(int(checks.number("sample", sample, least=0)), len(candidates))
    if sample == 0:
        return math.nan
    cells = np.random.default_rng([seed, 2]).choice(candidates, sample, replace=False)
    truth, _ = study.to_the_end(study.grid.centres(cells), None)
    errors = int(np.sum(truth["label"] != label[cells]))
    # Clopper and Pearson's
    return float(betaincinv(errors + 1, sample - errors, 0.5 + 0.5 * CONFIDENCE)) if errors < sample else 1.0
