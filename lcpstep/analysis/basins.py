"""Basins of attraction on a grid of initial states, by cell mapping with exact trajectories.

1. Every cell's centre is carried through a period; its image is an exact state, not a cell.
2. Where few cells are images of images (`Cells.core`), these are followed until they come near an attractor.
3. A cell is settled once an image lies near an attractor, or in a cell that is settled on the same attractor as
   all its eight neighbours. Repeated until nothing changes, the labels spread outwards.
4. Cells whose image can never be settled so, those between basins, are carried on by another period, or, where they
   are few, to their end; all that are left where there is no small core. Back to 3.
5. Attractors are looked for once more from cells that then have no label.
6. A random sample of cells is followed one by one; where that shows labels to be wrong, basins are finer than the
   cells, and all are followed so.

So only the labels of homogeneous neighbourhoods are shared, and a label depends neither on the order of the cells
nor on how the work is divided. The share of an attractor is that of its cells; its uncertainty is that of a grid
estimate of an area (binomial, of the cells at a boundary alone) together with a bound on the share of wrong labels
from the sample.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.attractors import Attractors, attractors, with_new
from lcpstep.analysis.cells import OBSTACLE, UNKNOWN, Cells, Grid
from lcpstep.analysis.neighbourhoods import neighbourhoods
from lcpstep.analysis.search import search
from lcpstep.analysis.starts import outside, random_starts
from lcpstep.dataset import Progress, labelled, provenance, units
from lcpstep.described import checksum
from lcpstep.events import EventDriven
from lcpstep.maps.batch import INSIDE, Targets, at_once, periodic, periods
from lcpstep.simulation import Method
from lcpstep.sweep import Arrays, sweep

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
PARTS = 32  # of a stage, at most, for every part is a file
LEAST, SHORT = 8192, 1024  # cells of a part that are followed over a period, and to their end
SLOW = 32  # the same of scenes whose runs are simulated one after another
CORE = 0.1  # the share of cells up to which images of images are followed to their end
ROUNDS, FEW = (
    48,
    0.01,
)  # of sharing and further images; the share of cells that is followed to the end instead
STARTS = 200  # random states from which attractors are looked for
CONFIDENCE = 0.95
WRONG = 0.01  # of the sample: where more labels are wrong, none are shared


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
    periodic(scene, "basins")
    if scene.n_x != 2:
        raise ValueError(
            f"scene: expected two states, {scene.name!r} has {scene.n_x}: {', '.join(scene.labels)}"
        )
    low, high = checks.array("lowest", lowest, (2,)), checks.array("highest", highest, (2,))
    if not np.all(low < high):
        raise ValueError(f"lowest, highest: expected an increasing range of q and of v, got {low} and {high}")
    if np.shape(shape) != (2,):
        raise ValueError(f"shape: expected two numbers of cells, along q and along v, got {shape!r}")
    n_q, n_v = (checks.count("shape", n) for n in shape)
    longest, method = checks.count("longest", longest), method or EventDriven()
    sample = int(checks.number("sample", sample, least=0))
    complete = known is None
    if known is not None:
        checks.instance("known", known, Attractors)
    else:
        starts = outside(scene, random_starts([low, high], STARTS, seed), phase)
        if len(starts) == 0:
            raise ValueError(
                "lowest, highest: the rectangle lies inside of the obstacle, as far as was looked"
            )
        known = search(scene, method, starts, phase, longest)
    grid = Grid(low, high, n_q, n_v)
    targets = neighbourhoods(scene, method, known.found, phase, longest, seed)
    study = _Study(scene, method, grid, targets, phase, longest)
    inputs = study.inputs(known) | {"scene_sha256": checksum(scene)}

    fast = at_once(scene, method, targets[0])

    def follow(name: str, work: Callable[..., Any], x: Array) -> Arrays:
        least = (SHORT if work == study.to_the_end else LEAST) if fast else SLOW
        size = max(least, -(-len(x) // PARTS))
        done = sweep(
            work,
            [[x[i : i + size]] for i in range(0, len(x), size)],
            inputs | {"stage": name, "cells_of_a_part": size},
            out=None if out is None else Path(out) / name,
            executor=executor,
            jobs=jobs,
            progress=progress,
        )
        return {key: np.concatenate([chain[0][key] for chain in done]) for key in done[0][0]}

    cells = _map_cells(study, follow)
    rest = np.flatnonzero(cells.label == UNKNOWN)
    if len(rest) and complete:  # they may go to attractors that no random start went to
        some = rest[np.linspace(0, len(rest) - 1, min(len(rest), STARTS)).astype(int)]
        more = attractors(scene, method, grid.centres(some), phase=phase, transient=longest)
        known = with_new(known, more)
        study = replace(study, targets=neighbourhoods(scene, method, known.found, phase, longest, seed))
        cells.take(rest, follow("second-look", study.to_the_end, cells.x[rest]))
    seen = _sample(cells.label, sample, seed)
    truth = follow("sample", study.to_the_end, grid.centres(seen))["label"] if len(seen) else np.zeros(0)
    if np.sum(truth != cells.label[seen]) > WRONG * len(seen):  # basins finer than the cells
        outer = np.flatnonzero(cells.label != OBSTACLE)
        cells.take(outer, follow("one-by-one", study.to_the_end, cells.x[outer]))
    wrong = _upper_bound(int(np.sum(truth != cells.label[seen])), len(seen))
    return study.dataset(known, cells.label, wrong, seed, sample)


def _map_cells(study: _Study, follow: Callable[[str, Any, Array], Arrays]) -> Cells:
    """All cells with their labels; `follow` has the work done on states, under a name that it has among the parts."""
    grid = study.grid
    n = grid.n_q * grid.n_v
    cells = Cells(grid)
    followed = np.zeros(n, dtype=bool)  # to the end

    def carry_on(name: str, some: Ints, work: Callable[..., Any]) -> None:
        cells.take(some, follow(name, work, cells.x[some]))
        followed[some] = work == study.to_the_end

    carry_on("images", np.arange(n), study.first_images)
    core = cells.core()
    contracts = len(core) <= CORE * n
    if contracts and len(core):
        carry_on("core", core, study.to_the_end)
    for k in range(ROUNDS + 1):
        cells.spread()
        left = np.flatnonzero((cells.label == UNKNOWN) & ~followed)
        if len(left) == 0:
            break
        blocked = left[cells.blocked(left)] if contracts else left
        some = blocked if len(blocked) and k < ROUNDS else left  # the others wait for these
        few = len(some) <= FEW * n or k == ROUNDS
        carry_on(f"round-{k:02d}", some, study.to_the_end if few else study.images)
    return cells


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
        """States a period later, and their cells; the labels of those near an attractor."""
        found = self.follow(x, 1, 0, strict)
        landed = self.grid.cell(found.states[:, 0]).astype(np.int32)
        return {"landed": landed, "x": found.final, "label": self.label(found)}, None

    def to_the_end(self, x: Array, handed: Arrays | None) -> tuple[Arrays, Arrays | None]:
        """Labels of states that are followed until they are near an attractor."""
        return {"label": self.label(self.follow(x, self.longest, self.longest, strict=False))}, None

    def follow(self, x: Array, n: int, drop: int, strict: bool) -> Any:
        """Runs that end near an attractor."""
        return periods(
            self.scene, self.method, x, n, drop=drop, phase=self.phase, most=0, targets=self.targets[0],
            strict=strict,
        )  # fmt: skip

    def label(self, found: Any) -> NDArray[np.int16]:
        """Labels of runs."""
        owner = np.append(self.targets[1], UNKNOWN)
        return np.where(found.status == INSIDE, OBSTACLE, owner[found.reached]).astype(np.int16)

    def inputs(self, known: Attractors) -> dict[str, Any]:
        """What the result depends on."""
        g = self.grid
        return provenance(self.scene, self.method) | {
            "lowest": g.low.tolist(), "highest": g.high.tolist(), "shape": [g.n_q, g.n_v], "phase": self.phase,
            "longest": self.longest, "attractors": [a.name for a in known.found],
            "points": hashlib.sha256(self.targets[0].points.tobytes()).hexdigest(),  # thousands where chaotic
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
            units(self.scene.labels),
        )

    def error(self, label: Ints, k: int, admissible: int) -> float:
        """Half-width of the 95 % interval of a share: cells at the boundary fall on either side by chance."""
        mine = (label == k).reshape(self.grid.n_v, self.grid.n_q)
        edge = np.zeros(mine.shape, dtype=bool)
        for axis in (0, 1):
            for shift in (1, -1):
                edge |= mine != np.roll(mine, shift, axis)
        return 1.96 * 0.5 * math.sqrt(float(np.sum(edge))) / admissible


def _sample(label: Ints, sample: int, seed: int) -> Ints:
    """The cells that are followed one by one to see how many labels are wrong."""
    candidates = np.flatnonzero(label != OBSTACLE)
    return np.random.default_rng([seed, 2]).choice(candidates, min(sample, len(candidates)), replace=False)


def _upper_bound(errors: int, sample: int) -> float:
    """Upper 95 % bound on the share of wrong labels, by Clopper and Pearson; nan where none were looked at."""
    from scipy.special import betaincinv  # its statistics take half a second to import

    if sample == 0:
        return math.nan
    return float(betaincinv(errors + 1, sample - errors, 0.5 + 0.5 * CONFIDENCE)) if errors < sample else 1.0
