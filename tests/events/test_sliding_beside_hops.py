"""Hops that die away beside contacts that slide, against closed forms: how the motion goes on from their end."""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate
from tests.events.rough import block

METHODS = [EventDriven(), EventDriven(1e-9, 1e-9), Located(1e-2, order=4)]


@pytest.mark.parametrize("method", METHODS, ids=str)
def test_what_is_struck_stops_before_the_next_blow(method):
    """A block on rough ground is struck by another one that is pulled back, and brushes along it across.

    The ground stops the block each time, and the other one, ahead of it no more, comes up to it: what is left of its
    speed is the same share of that before. It leaves when all of it is gone.
    """
    m, M, r, pull, back, across, mu = 1.0, 2.0, 0.5, 10.0, 1.0, 2.0, 0.3
    struck, left = (
        (1.0 + r) * M / (m + M),
        (M - m * r) / (m + M),
    )  # speeds of both after the first blow, of 1 m/s
    way = struck**2 / (2.0 * pull)
    ratio = np.sqrt(left**2 - 2.0 * back * way)
    between = (left - ratio) / back
    assert between > struck / pull  # it has stopped
    end, whole_way, impulse = between / (1.0 - ratio), way / (1.0 - ratio**2), m * struck / (1.0 - ratio)
    rubbing = Coulomb([pull / 10.0, mu], [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    contacts = LinearContacts([[0.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0]], 0.0, [0.0, r], friction=rubbing)
    system = LinearSystem(np.diag([m, m, M, M]), force=[0.0, -10.0 * m, M * back, 0.0])
    run = simulate(Scene(system, np.zeros(4), [0.0, 0.0, -1.0, across], (0.0, 1.0), contacts), method)
    later = run.t[-1] - end
    np.testing.assert_allclose(run.q[-1, [0, 2]], [-whole_way, 0.5 * back * later**2 - whole_way], atol=1e-8)
    np.testing.assert_allclose(run.v[-1], [0.0, 0.0, back * later, across - mu * impulse / M], atol=1e-8)


@pytest.mark.parametrize("room", [0.02, 0.05, 0.1, 0.2])
@pytest.mark.parametrize("method", METHODS, ids=str)
def test_sliding_that_dies_away_with_hops_leaves_what_sticks(method, room):
    """A block slides down a slope, towards a wall, against a small body between, which hops to and fro and falls.

    Each blow turns its sliding, and all speeds shrink in proportion, to rest; there mu_s holds it, and mu would not.
    """
    normal, tangent = [0.4, 0.9165], [0.9165, -0.4]
    rows = [[*normal, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [-1.0, 0.0, 1.0, 0.0]]
    tangents = [[*tangent, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.0, -1.0, 0.0, 1.0]]
    mu = np.array([0.19, 0.319, 0.14])
    rubbing = Coulomb(mu, tangents, mu_s=1.3 * mu)
    contacts = LinearContacts(rows, [0.0, 0.0, room], [0.067, 0.67, 0.58], friction=rubbing)
    masses = np.array([5.375, 5.375, 0.436, 0.436])
    system = LinearSystem(np.diag(masses), force=-9.81 * masses * [0.0, 1.0, 0.0, 1.0])
    v0 = [0.7 * tangent[0], 0.7 * tangent[1], -1.7, 0.45]
    run = simulate(Scene(system, np.zeros(4), v0, (0.0, 2.0), contacts), method)
    assert run.status is Status.DONE, run.message
    np.testing.assert_allclose(run.v[-1], 0.0, atol=1e-12)
    np.testing.assert_allclose(run.q[-1], run.at(1.0)[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("seed", [314, 869, 1063, 1323, 1770, 1817, 2924])
@pytest.mark.parametrize("tolerance", [1e-12, 1e-11, 1e-9])
def test_a_block_that_rocks_and_slides_comes_to_rest_on_its_feet(tolerance, seed):
    # the hops of one foot end while the other one is as far above the floor as they leave it, and stop its sliding
    scene = block(seed)
    method = EventDriven(tolerance, tolerance, max_events=2000)
    run, fine = simulate(scene, method), simulate(scene, EventDriven(1e-13, 1e-13, max_events=2000))
    assert run.status is Status.DONE, run.message
    np.testing.assert_allclose(run.q[-1], fine.q[-1], rtol=0, atol=1e-6)
