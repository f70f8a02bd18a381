"""Rods that fall on a rough floor: by all methods in one place, within what a tolerance asks for."""

import numpy as np
import pytest

from lcpstep import EventDriven, Located, Moreau, Status, simulate
from tests.marks import slow
from tests.random_rods import METHODS, rods


@pytest.mark.parametrize("seed", range(12))
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
