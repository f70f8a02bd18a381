"""The tableau against linear algebra: what it holds after any number of pivots, and the answer read off it."""

import numpy as np
import pytest

from lcpstep.lcp import Status, residual
from tests.uncompiled import kernels

plain = kernels()  # in plain Python, where all that the kernels work on can be looked at
LARGE, correct, pivot_tableau = plain.tableau.LARGE, plain.tableau.correct, plain.tableau.pivot_tableau
subtract_errors = plain.tableau.subtract_errors
equilibrate, workspace = plain.scaling.equilibrate, plain.workspace.Workspace

SIZES = (7, LARGE + 3)  # changes made at once, and put off


def problem(n, rank, seed):
    """Semidefinite, and degenerate where rank < n; a solution is planted."""
    rng = np.random.default_rng(seed)
    G = rng.normal(size=(n, rank))
    z = np.maximum(rng.normal(size=n), 0.0)
    W = G @ G.T
    return W, np.where(z > 0.0, 0.0, rng.random(n)) - W @ z


@pytest.mark.parametrize("n", SIZES)
def test_the_answer_is_right_to_rounding(n):
    work = workspace(n)
    for seed in range(20):
        W, b = problem(n, n - seed % 3, seed)
        z = np.zeros(n)
        equilibrate(W.reshape(-1), b, len(b), work)
        assert pivot_tableau(n, 1000, work) == Status.SOLVED
        assert correct(W.reshape(-1), b, z, n, 1e-13, work) <= 1e-13
        assert residual(W, b, z) <= 1e-13


@pytest.mark.parametrize("n", SIZES)
def test_the_tableau_is_the_solution_of_the_equations_for_its_basis(n):
    """y = q + T x with w = W z + b + e z_0, after every number of pivots up to the end."""
    W, b = problem(n, n, 0)
    work = workspace(n)
    for limit in (1, 2, 3, 5, 1000):
        equilibrate(W.reshape(-1), b, len(b), work)
        A, q0 = work.columns[: n * n].reshape(n, n).T.copy(), work.scaled_b[:n].copy()
        ended = pivot_tableau(n, limit, work)
        M = np.hstack((A, np.ones((n, 1)), -np.eye(n)))  # of (z, z_0, w): M v = -b
        basic, nonbasic = work.basic[:n], work.nonbasic[: n + 1]
        assert sorted([*basic, *nonbasic]) == list(range(2 * n + 1))
        q = np.linalg.solve(M[:, basic], -q0)
        assert work.scaled_b[:n] == pytest.approx(q, rel=1e-9, abs=1e-9)
        errors = np.random.default_rng(limit).normal(size=n)
        added = np.where(nonbasic > n, (errors * work.row_scale[:n])[np.maximum(nonbasic - n - 1, 0)], 0.0)
        T = np.linalg.solve(M[:, basic], -M[:, nonbasic])
        corrected = work.scaled_b[:n].copy()
        subtract_errors(corrected, errors, n, work)
        assert corrected == pytest.approx(q - T @ added, rel=1e-8, abs=1e-8)
        plain.tableau.change_all(n, work)
        np.testing.assert_allclose(work.columns[: (n + 1) * n].reshape(n + 1, n).T, T, rtol=1e-8, atol=1e-8)
    assert ended == Status.SOLVED


def test_changes_are_all_made_when_the_list_is_full(monkeypatch):
    n, most = LARGE + 4, (LARGE + 4) // 4
    monkeypatch.setattr(plain.tableau, "MOST", most / n)
    work, z = workspace(n), np.zeros(n)
    for seed in range(5):
        W, b = problem(n, n - seed % 3, seed)
        equilibrate(W.reshape(-1), b, n, work)
        work.iterations = 0
        assert pivot_tableau(n, 1000, work) == Status.SOLVED
        assert work.iterations > most > work.waiting
        assert correct(W.reshape(-1), b, z, n, 1e-13, work) <= 1e-13
        assert residual(W, b, z) <= 1e-13


def test_four_changes_together_are_those_one_by_one():
    """Also where two of them are of one row, and where a column is zero in all their rows."""
    n, random = 9, np.random.default_rng(1)
    for rows in ([1, 4, 2, 7], [1, 4, 1, 4], [3, 3, 3, 3], [0, 5, 5, 8]):
        work = workspace(n)
        for k, p in enumerate(rows):
            work.changes[k * n : (k + 1) * n] = random.normal(size=n)
            work.changes[k * n + p], work.row[k], work.reciprocal[k] = 0.0, p, random.normal()
        for column in (random.normal(size=n), np.where(np.isin(np.arange(n), rows), 0.0, 1.0)):
            one, four = column.copy(), column.copy()
            for k in range(4):
                plain.tableau.make(one, k, n, work)
            plain.tableau.make_four(four, 0, n, work)
            np.testing.assert_allclose(four, one, rtol=1e-12, atol=1e-12)


def test_a_ray_is_not_a_solution():
    work = workspace(3)
    equilibrate(-np.eye(3).reshape(-1), -np.ones(3), 3, work)
    assert pivot_tableau(3, 100, work) == Status.RAY


@pytest.mark.parametrize("n", SIZES)
def test_ties_everywhere_end(n):
    """Every contact twice, or b = 0: the rows tie in pairs, or all of them."""
    G = np.repeat(np.random.default_rng(n).normal(size=((n + 1) // 2, n)), 2, axis=0)[:n]
    W, z, work = G @ G.T, np.zeros(n), workspace(n)
    for b in (np.repeat(-G[::2] @ G[::2].sum(axis=0), 2)[:n], np.zeros(n)):
        equilibrate(W.reshape(-1), b, len(b), work)
        assert pivot_tableau(n, 1000, work) == Status.SOLVED
        assert correct(W.reshape(-1), b, z, n, 1e-13, work) <= 1e-13


@pytest.mark.parametrize("n", SIZES)
def test_what_the_work_arrays_held_before_does_not_matter(n):
    """A path that depended on it would break ties by it, and the same problem would have many answers."""
    G = np.repeat(np.random.default_rng(n).normal(size=((n + 1) // 2, n)), 2, axis=0)[:n]
    W, b = G @ G.T, np.repeat(-G[::2] @ G[::2].sum(axis=0), 2)[:n]
    fresh, used = workspace(n), workspace(n)
    used.numbers[:], used.lists[:] = 3.0, n - 1
    answers = []
    for work in (fresh, used):
        z = np.zeros(n)
        equilibrate(W.reshape(-1), b, len(b), work)
        assert pivot_tableau(n, 1000, work) == Status.SOLVED
        correct(W.reshape(-1), b, z, n, 1e-13, work)
        answers.append(z)
    assert np.array_equal(*answers)
