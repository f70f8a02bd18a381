"""Random scenes of points on slopes with friction; see `tests.random_slopes`, which looks at any number of them."""

import numpy as np
import pytest

from lcpstep import EventDriven, Located, simulate
from tests.marks import shared, slow
from tests.random_slopes import complaints, draw

PER_TEST = 40


@pytest.mark.parametrize("first", shared(range(0, 1200, PER_TEST), 30))
def test_runs_end_in_one_place(first):
    for seed in range(first, first + PER_TEST):
        assert not complaints(seed), f"scene {seed}"


@pytest.mark.parametrize("seed", slow([53, 431, 1811, 1892], 1811))
def test_what_others_keep_hopping_comes_to_rest(seed):
    assert not complaints(seed)


@pytest.mark.parametrize("seed", [3526, 15020, 17771])
def test_a_blow_finds_closed_what_others_have_brought_to_rest_near_its_surface(seed):
    assert not complaints(seed)


@pytest.mark.parametrize("seed", [9055, 11300])
def test_sliding_that_has_died_away_keeps_no_blow_from_an_answer(seed):
    assert not complaints(seed)


def test_a_hop_that_begins_as_another_contact_stops_lands():
    """Too low to be told by its gap; found late, it struck 30 times as fast, and kept a chattering going for ever."""
    assert not complaints(15256)


@pytest.mark.parametrize("seed", [1475, 16219, 20167])
def test_sliding_that_dies_away_with_hops_ends_where_steps_cannot_tell_it(seed):
    assert not complaints(seed)


@pytest.mark.parametrize("seed", slow([26215, 26743, 30036, 30470, 31340], 31340))
def test_hops_that_rounding_hides_are_followed_and_not_left_out(seed):
    """Closed at once, while another contact struck, they fed its hops for ever; steps lost their heights."""
    assert not complaints(seed)


def test_hops_in_a_wedge_end_alike_by_any_tolerance_or_step():
    scene = draw(30470)
    methods = EventDriven(), EventDriven(1e-12, 1e-13), Located(5e-3, order=4), Located(1.3e-2, order=4)
    ends = [simulate(scene, method, keep=[scene.t_span[1]]).q[-1] for method in methods]
    assert np.max(np.ptp(ends, axis=0)) < 1e-6


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 0.8])
def test_a_wedge_that_comes_to_rest_stops_no_body_beside_it(share):
    """The first point touches no other: it slides on down its slope as the closed form says.

    How the hops in the wedge end depends on the tolerance; where they ended with a stop of all, it was metres off.
    """
    scene = draw(30120)
    run = simulate(scene, EventDriven(1e-12, 1e-13 * 10**share), keep=[1.0, scene.t_span[1]])
    (t0, t1), normal = run.t, scene.contacts.G[0, :2]
    tangent = np.array([normal[1], -normal[0]])
    force, speed = scene.system.force.constant[:2], run.v[0, :2] @ tangent
    rubbing = scene.contacts.friction.mu[0] * (force @ normal) * np.sign(speed)
    pull = (force @ tangent + rubbing) / scene.system.M[0, 0]
    way = speed * (t1 - t0) + 0.5 * pull * (t1 - t0) ** 2
    assert (run.q[1, :2] - run.q[0, :2]) @ tangent == pytest.approx(way, abs=1e-9)
