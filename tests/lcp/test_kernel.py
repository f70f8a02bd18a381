"""The entry for steppers: called from compiled code, on one set of work arrays, without allocation."""

import numpy as np
import pytest

from lcpstep.compiled import compiled
from lcpstep.lcp import Status, residual, solve_lcp
from lcpstep.lcp.kernel import solve_small, workspace


def repeat(W, b, z, status, work):
    """A kernel that solves one problem after the other."""
    for i in range(b.shape[0]):
        status[i] = solve_small(W[i], b[i], z[i], work)


def test_one_workspace_serves_every_smaller_size():
    work, rng = workspace(30), np.random.default_rng(0)
    for n in (30, 1, 7, 2, 3, 30):
        G = rng.normal(size=(20, n, n))
        W, b, z, status = G @ G.swapaxes(1, 2), rng.normal(size=(20, n)), np.zeros((20, n)), np.ones(20, int)
        before = W.copy(), b.copy()
        compiled(repeat)(W, b, z, status, work)
        assert not status.any()
        assert max(residual(*problem) for problem in zip(W, b, z, strict=True)) <= 1e-13
        assert np.array_equal(W, before[0])
        assert np.array_equal(b, before[1])


@pytest.mark.parametrize(
    ("W", "b", "z", "status"),
    [
        (2.0, -1.0, 0.5, Status.SOLVED),
        (2.0, 1.0, 0.0, Status.SOLVED),
        (-2.0, 1.0, 0.0, Status.SOLVED),
        (0.0, 0.0, 0.0, Status.SOLVED),
        (1e-300, -1e-300, 1.0, Status.SOLVED),
        (0.0, -1.0, 0.0, Status.INFEASIBLE),
        (-2.0, -1.0, 0.0, Status.INFEASIBLE),
    ],
)
def test_one_contact_has_a_closed_form(W, b, z, status):
    out = np.zeros(1)
    assert compiled(solve_small)(np.array([[W]]), np.array([b]), out, workspace(1)) == status
    assert out[0] == z


def test_not_a_number_is_not_solved():
    for n in (1, 2, 3, 9):
        W, b = np.eye(n), -np.ones(n)
        W[0, 0] = np.nan
        assert compiled(solve_small)(W, b, np.zeros(n), workspace(n)) != Status.SOLVED
        assert compiled(solve_small)(np.eye(n), b * np.nan, np.zeros(n), workspace(n)) != Status.SOLVED


def test_the_same_source_runs_as_plain_python():
    rng = np.random.default_rng(1)
    for n in (1, 2, 3, 6):
        G = rng.normal(size=(n, max(n - 1, 1)))
        W, b = G @ G.T, -G @ rng.random(max(n - 1, 1))
        plain, fast = np.zeros(n), np.zeros(n)
        work, other = workspace(n), workspace(n)
        assert solve_small(W, b, plain, work) == compiled(solve_small)(W, b, fast, other)
        assert plain == pytest.approx(fast, rel=1e-12, abs=1e-14)


def rounded_chain(n, b):
    """Bodies in a column of which some rows hold nothing but what rounding left there."""
    W = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    full = np.zeros(n)
    full[list(b)] = list(b.values())
    return W, full


@pytest.mark.parametrize(
    ("n", "b"),
    [
        (12, {0: -1.0, 1: 3.0, 7: -1e-15}),
        (18, {0: -0.01, 5: 0.33, 7: -1e-15, 9: 0.02, 10: 2e-11, 11: 2e-14, 13: 2e-8, 16: -0.044, 17: 4e-3}),
        (30, {3: -1.0, 5: 5.0, 20: -1e-300}),
    ],
)
def test_what_rounding_left_in_rows_of_its_own_is_solved_too(n, b):
    W, b = rounded_chain(n, b)
    W[0, 0] = 1.0
    solution = solve_lcp(W, b)
    assert solution.solved
    assert residual(W, b, solution.z) <= 1e-15
