"""The search that basins begin with: the attractors of all starts, but few starts are followed for long."""

import math

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven
from lcpstep.analysis import basins as module
from lcpstep.analysis.attractors import attractors, random_starts
from lcpstep.analysis.search import FIRST, search
from lcpstep.maps import one_by_one


def between_walls(amplitude=3.0, w=2.8):
    """A mass that two walls hold: no closed form, two orbits that mirror each other, and one that strikes nothing."""
    block = LinearSystem(M=1.0, C=0.1, K=1.0, force=Harmonic(cosine=amplitude, omega=w))
    walls = LinearContacts(G=[[-1.0], [1.0]], offset=[0.5, 0.5], restitution=0.8)
    return Scene(block, 0.0, 0.0, (0.0, 10.0), contacts=walls, period=2.0 * math.pi / w)


@pytest.fixture
def simulated(monkeypatch):
    """Times that are simulated from now on [s]."""
    spans = []
    run = one_by_one.simulate
    monkeypatch.setattr(
        one_by_one,
        "simulate",
        lambda scene, *a, **k: spans.append(np.ptp(scene.t_span)) or run(scene, *a, **k),
    )
    return spans


def random(n):
    return random_starts([[-0.5, -2.0], [0.5, 2.0]], n, seed=0)


@pytest.mark.slow
def test_few_starts_are_followed_for_long(simulated):
    scene, starts, longest = between_walls(), random(40), 150
    found = search(scene, EventDriven(), starts, 0.0, longest)
    few = sum(simulated)
    simulated.clear()
    every = attractors(scene, EventDriven(), starts, transient=longest)
    assert few < 0.5 * sum(simulated)
    assert np.array_equal(found.label, every.label)
    assert [a.name for a in every.found] == [a.name for a in found.found] == ["O(1, 2)", "O(1, 2)"]


@pytest.mark.slow
def test_an_attractor_that_none_of_the_first_starts_goes_to_is_found():
    scene, longest = between_walls(), 150
    still = np.array([[-0.4363, -0.0190]]) + 1e-3 * random_starts([[-1, -1], [1, 1]], 4, seed=1)
    starts = np.concatenate([random(FIRST), still])
    found = search(scene, EventDriven(), starts, 0.0, longest)
    every = attractors(scene, EventDriven(), starts, transient=longest)
    assert [a.name for a in every.found] == ["O(1, 2)", "O(1, 2)", "O(1, 0)"]
    assert np.array_equal(found.label, every.label)
    assert np.all(found.label[:FIRST] != 2)
    assert [a.share for a in found.found] == pytest.approx([a.share for a in every.found])
    for a, b in zip(found.found, every.found, strict=True):
        assert a.points == pytest.approx(b.points, abs=1e-9)


@pytest.mark.slow
def test_what_is_slow_is_divided_into_parts_that_are_soon_done():
    counted = []
    data = module.basins(
        between_walls(), [-0.5, -2.0], [0.5, 2.0], (8, 8), longest=100, sample=32,
        progress=lambda done, total: counted.append(total),
    )  # fmt: skip
    assert max(counted) > 1
    assert data.attrs["unlabelled"] == 0.0
    assert sorted(data["name"].values)[-2:] == ["O(1, 2)", "O(1, 2)"]
