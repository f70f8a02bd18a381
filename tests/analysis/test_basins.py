"""Basins of attraction: cells share labels only where they are right; known maps first, then the thesis."""

import numpy as np
import pytest

from lagrangian.scenes import cam_follower, impact_oscillator
from lcpstep import EventDriven
from lcpstep.analysis import basins as module
from lcpstep.analysis.basins import basins
from lcpstep.analysis.cells import OBSTACLE, UNKNOWN, Cells, Grid, homogeneous, spread
from lcpstep.maps import periods


def known_basins(f, size=256):
    """Cells of a map f on the square (-1, 1)^2 whose attractors are (1/2, 0) and (-1/2, 0)."""
    grid = Grid(np.array([-1.0, -1.0]), np.array([1.0, 1.0]), size, size)
    x = grid.centres(np.arange(size * size))
    label = np.full(len(x), -1)
    label[np.hypot(x[:, 0] - 0.5, x[:, 1]) < 0.2] = 0
    label[np.hypot(x[:, 0] + 0.5, x[:, 1]) < 0.2] = 1
    cells, image = np.arange(len(x)), f(x)
    spread(grid, cells, grid.cell(image)[:, None], label)
    return x, label


def test_cells_share_labels_only_where_they_are_right():
    # x -> x - (x^3 - x/4), y -> y/2: the sign of x decides
    x, label = known_basins(lambda x: np.stack([x[:, 0] * (1.25 - x[:, 0] ** 2), 0.5 * x[:, 1]], axis=1))
    labelled = label >= 0
    assert np.mean(labelled) > 0.9
    assert np.array_equal(label[labelled], (x[labelled, 0] < 0.0).astype(int))


def test_a_neighbourhood_is_homogeneous_only_if_all_of_it_is():
    label = np.zeros((5, 5), dtype=int)
    label[0, 0] = 1
    inner = homogeneous(label)
    assert inner[1, 1] == -1
    assert inner[2, 2] == inner[3, 3] == 0
    assert np.all(inner[0] == -1)


@pytest.mark.slow
def test_basins_agree_with_runs_followed_one_by_one_and_divide_into_any_parts(monkeypatch):
    scene, corners = cam_follower(rpm=358.5, coordinates="absolute"), ([0.05, -60.0], [1.6, 60.0])
    data = basins(scene, *corners, (60, 60), sample=600)
    assert data.attrs["unlabelled"] == 0.0
    shares = dict(zip(data["name"].values, data["share"].values, strict=True))
    assert shares["O(3, 8)"] == pytest.approx(0.7615, abs=0.02)  # of a grid of 1000 x 1000 cells
    assert sum(shares.values()) == pytest.approx(1.0)
    assert np.all(data["label"].sel(q=slice(None, 0.0999)) == OBSTACLE)
    assert data.attrs["wrong_labels_upper_bound"] < 0.01
    monkeypatch.setattr(module, "LEAST", 700)
    again = basins(scene, *corners, (60, 60), sample=600, jobs=1)
    assert np.array_equal(again["label"], data["label"])


@pytest.mark.slow
def test_all_cells_go_to_the_chaotic_attractor_where_there_is_no_other():
    data = basins(cam_follower(rpm=660.0), [0.01, -20.0], [1.0, 20.0], (24, 24), longest=400, sample=0)
    assert list(data["name"].values) == ["chaotic"]
    assert np.mean(data["label"].values == 0) > 0.99


def test_an_attractor_with_a_small_basin_is_found_from_the_cells_that_are_left():
    # The oscillator that never touches its stop, next to one that strikes it once a period
    scene = impact_oscillator(omega=1.3, amplitude=0.3, stop=0.5)
    data = basins(scene, [-1.5, -2.0], [0.6, 2.0], (60, 60), sample=200)
    shares = dict(zip(data["name"].values, data["share"].values, strict=True))
    assert set(shares) == {"O(1, 1)", "O(1, 0)"}
    assert 0.005 < shares["O(1, 0)"] < 0.05
    assert data.attrs["unlabelled"] == 0.0


def test_cells_wait_only_for_labels_that_will_come():
    """x -> x - (x^3 - x/4), y -> y/2 carries the square into two lines, and these into the two attractors."""
    cells = Cells(Grid(np.array([-1.0, -1.0]), np.array([1.0, 1.0]), 100, 100))
    x = cells.x.copy()
    image = np.stack([x[:, 0] * (1.25 - x[:, 0] ** 2), 0.5 * x[:, 1]], axis=1)
    cells.take(np.arange(len(x)), {"x": image, "landed": cells.grid.cell(image)})
    core = cells.core()
    assert len(core) < 0.06 * len(x)
    assert np.max(np.abs(x[core, 1])) < 0.08
    side = (x[:, 0] < 0.0).astype(int)
    cells.take(core, {"label": side[core]})
    cells.spread()
    while len(left := np.flatnonzero(cells.label == UNKNOWN)):
        stuck = left[cells.blocked(left)]
        assert len(stuck) > 0
        assert np.all(np.abs(image[stuck, 0]) < 0.041)  # two cells from the border at x = 0
        cells.take(stuck, {"label": side[stuck]})
        cells.spread()
    assert np.array_equal(cells.label, side)


def test_cells_that_are_coarser_than_the_basins_share_no_labels():
    scene = impact_oscillator(omega=2.6, amplitude=0.5, stop=0.0)
    data = basins(scene, [-1.5, -2.0], [0.2, 2.0], (40, 40), longest=300, sample=400)
    assert data.attrs["wrong_labels_upper_bound"] < 0.01
    orbits = {}  # whether those of a label repeat after one period, from the cells' centres
    for cell in np.flatnonzero(data["label"].values.ravel() != OBSTACLE)[::37]:
        x = [[float(data["q"][cell % 40]), float(data["v"][cell // 40])]]
        run = periods(scene, EventDriven(), x, 403, drop=400)
        repeats = np.max(np.abs(run.states[0, 1] - run.states[0, 0])) < 1e-6
        orbits.setdefault(int(data["label"].values[cell // 40, cell % 40]), set()).add(bool(repeats))
    assert orbits == {0: {True}, 1: {False}}  # O(1, 1) and O(3, 3)


def test_a_wrong_sample_is_refused_before_anything_is_computed(monkeypatch):
    monkeypatch.setattr(module, "search", None)  # what comes first
    with pytest.raises(ValueError, match=r"sample: expected a value in \[0, inf\], got -1"):
        basins(impact_oscillator(), [-1.5, -2.0], [0.0, 2.0], (4, 4), sample=-1)
