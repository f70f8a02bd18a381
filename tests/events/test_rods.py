"""Rods that fall on a rough floor: by all methods in one place, within what a tolerance asks for."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.coupled.rods import G, gaps, link_rows, links, normals, rods, tangents
from lagrangian import Contacts, Coulomb, Joints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.events.test_heaps import METHODS
from tests.marks import slow

MU, PULL = 0.3, 10.0  # N/s


@pytest.mark.parametrize("seed", slow(range(12), 2))
def test_rods_come_to_rest_by_every_method_alike(seed):
    true = simulate(rods(seed), METHODS[0])
    for method in METHODS[1:]:
        run = simulate(rods(seed), method)
        assert run.status == true.status == Status.DONE
        np.testing.assert_allclose(run.q[-1], true.q[-1], rtol=0, atol=3e-5)


@pytest.mark.parametrize("h", [4e-3, 1e-2])
def test_a_rod_slips_when_it_does_and_not_when_others_are_looked_at(h):
    """Three lie flat, and share their loads by rounding; a fourth slipped when that was looked into, 30 ms early."""
    true = simulate(rods(55), EventDriven(1e-12, 1e-12))
    for tolerance in (1e-5, 1e-6, 1e-8):
        run = simulate(rods(55), Located(h, order=4, tolerance=tolerance))
        assert np.max(np.abs(run.q[-1] - true.q[-1])) < 2.0 * tolerance


def test_rods_whose_friction_others_bear_rest_though_rounding_pulls_at_them():
    """One of three flat rods was held for all: what its force left of the others' none was taken for their slipping.

    By steps by a tolerance, which came to no end of it.
    """
    true = simulate(rods(89), EventDriven(1e-12, 1e-12), keep=[1.0])
    for tolerance in (1e-5, 1e-6):
        run = simulate(rods(89), Located(4e-3, order=4, tolerance=tolerance, max_events=10_000), keep=[1.0])
        np.testing.assert_allclose(run.q[-1], true.q[-1], rtol=0, atol=tolerance)


@pytest.mark.parametrize("seed", [0, 1])
def test_no_end_sinks_in_while_its_double_beside_a_joint_is_rounding(seed):
    """Of two ends at one joint one was left open in a gap of 1e-15 m, which is rounding of the joint, not its own.

    Where that came to zero was sought through all of the step, and another end had come 5 mm into the floor by then.
    """
    q0 = rods(122).q0 + 1e-13 * np.resize([*np.random.default_rng(seed).normal(size=2), 0.0], 12)
    run, g = simulate(replace(rods(122), q0=q0), EventDriven(1e-12, 1e-12)), np.zeros(8)
    for q in run.at(np.linspace(0.98, 0.99, 21))[0]:
        gaps(0.0, q, None, None, g)
        assert np.min(g) > -1e-9


@pytest.mark.parametrize("seed", slow([2, 3, 17, 25, 51, 73, 104, 122], 2, 3, 17, 73))
def test_ends_at_one_place_do_not_hand_their_load_over_without_end(seed):
    """Two ends that a joint links touch the floor together: Newton's iteration went to and fro between them.

    Or, of 73, no impulses were found: rows of six ends and their tangents say nearly the same.
    """
    true = simulate(rods(seed), METHODS[0], keep=[1.0])
    coarse, fine = (simulate(rods(seed), Moreau(h), keep=[1.0]) for h in (1e-3, 1e-4))
    assert coarse.status == fine.status == Status.DONE
    errors = [np.max(np.abs(run.q[-1] - true.q[-1])) for run in (coarse, fine)]
    assert errors[1] < max(0.2 * errors[0], 1e-3)


def test_impulses_that_can_be_shared_in_many_ways_stay_what_they_were():
    """Three ends in a corner share a blow: Newton's iteration took another share of it each time, 3e-9 m/s apart."""
    true = simulate(rods((11, 15)), METHODS[0], keep=[1.0])
    coarse, fine = (simulate(rods((11, 15)), Moreau(h), keep=[1.0]) for h in (5e-4, 1e-4))
    assert coarse.status == fine.status == Status.DONE
    errors = [np.max(np.abs(run.q[-1] - true.q[-1])) for run in (coarse, fine)]
    assert errors[1] < 0.5 * errors[0] < 1e-2


def test_ends_that_share_a_direction_stick_with_the_friction_of_all():
    """Three ends stick, two of them at one place; one has all the friction, at the edge of its cone.

    Its force left the cone at once, its neighbour was asked, and asked back, 10^5 times at one time.
    """
    run, true = (
        simulate(rods((18, 57)), Located(0.23 * 5e-4, 4), keep=[1.0]),
        simulate(rods((18, 57)), METHODS[0]),
    )
    assert run.status == true.status == Status.DONE
    np.testing.assert_allclose(run.q[-1], true.q[-1], rtol=0, atol=3e-6)


def pulled(t, q, v, p, out):
    """Rods of 1 kg, the first of them pulled along the floor."""
    out[:] = 0.0
    out[1::3] = -G
    out[0] = PULL * t


@pytest.mark.parametrize("method", [*METHODS, Moreau(1e-3)], ids=["events", "2", "4", "tolerance", "moreau"])
@pytest.mark.parametrize("n", [1, 2, 3, 4])
def test_flat_rods_that_are_linked_slip_when_the_friction_of_all_their_ends_is_used_up(n, method):
    """At t = mu n g / pull, then x = pull (t - ..)^3 / 6 n; of five ends and more the first held for ever.

    Two ends lie at each joint, whose forces are known in sum alone: those that bear none of the forces found were
    held first, took the load of all, left their cones by that, and were not watched any more.
    """
    q0 = np.column_stack([0.5 + np.arange(n), np.zeros((n, 2))]).ravel()
    slips = MU * n * G / PULL
    scene = Scene(
        LinearSystem(np.diag(np.tile([1.0, 1.0, 1.0 / 12.0], n)), force=pulled),
        q0, np.zeros(3 * n), (0.0, slips + 0.5),
        contacts=Contacts(2 * n, gaps, normals, friction=Coulomb(MU, tangents)),
        joints=Joints(2 * (n - 1), links, link_rows) if n > 1 else None,
    )  # fmt: skip
    run = simulate(scene, method)
    assert run.status == Status.DONE
    error = 1e-3 if isinstance(method, Moreau) else 1e-6
    np.testing.assert_allclose(run.q[-1] - q0, np.tile([PULL * 0.5**3 / (6.0 * n), 0.0, 0.0], n), atol=error)
