"""Problems outside of what mechanics makes, each class with solutions known by construction."""

import numpy as np
import pytest

from lcpstep import solve_lcp
from lcpstep.lcp.judged import residual
from tests.marks import shared


def planted(W, rng):
    """A right-hand side for which a random z, about half of it positive, is a solution."""
    positive = rng.random(len(W)) < 0.5
    z, w = rng.uniform(0.1, 1.0, (2, len(W)))
    return np.where(positive, 0.0, w) - W @ np.where(positive, z, 0.0)


def solved(W, b, **options):
    solution = solve_lcp(W, b, **options)
    assert solution.solved, solution.status
    assert residual(W, b, solution.z) <= 1e-10
    return solution


@pytest.mark.parametrize("n", [2, 3, 4])
def test_singular_matrices_of_few_unknowns(n):
    rng = np.random.default_rng(n)
    for _ in range(300):
        rank = rng.integers(1, n)
        left, right = rng.normal(size=(2, n, rank))
        W = left @ right.T
        W = np.round(W) if rng.random() < 0.5 else W + 10.0 ** rng.uniform(-16, -8) * rng.normal(size=(n, n))
        solved(W, planted(W, rng))


@pytest.mark.parametrize(
    ("W", "b"),
    [
        ([[0, 2], [0, 0]], [-2, 0]),
        ([[-1, 1], [0, 0]], [-0.5, 0]),
        ([[0, 0, 0], [2, -1, 0], [2, 2, 2]], [0, -4, -6]),
    ],
)
def test_solutions_that_belong_to_no_basis(W, b):
    """Rows of the positive z depend on each other: a row of another index, whose w is zero, decides."""
    solved(np.array(W, dtype=float), np.array(b, dtype=float))


@pytest.mark.parametrize("n", [3, 6, 12])
def test_small_whole_numbers(n):
    rng = np.random.default_rng(n)
    for _ in range(100):
        W = rng.integers(-2, 3, (n, n)).astype(float)
        positive = rng.random(n) < 0.5
        z, w = rng.integers(0, 3, (2, n))
        solved(W, np.where(positive, 0.0, w) - W @ np.where(positive, z, 0.0))


@pytest.mark.parametrize("n", [20, 30, 40])
@pytest.mark.parametrize("symmetric", [False, True])
def test_indefinite_matrices(n, symmetric):
    """No method is sure to find a solution; from many starts one is found."""
    rng = np.random.default_rng(n)
    for _ in range(5):
        W = rng.normal(size=(n, n))
        W = W + W.T if symmetric else W
        solved(W, planted(W, rng))


@pytest.mark.parametrize("seed", shared([60007, 60008, 60023, 60016], 4))
def test_indefinite_matrices_that_need_many_starts(seed):
    rng = np.random.default_rng(seed)
    W = rng.normal(size=(60, 60))
    W = W + W.T
    solved(W, planted(W, rng))


@pytest.mark.parametrize("n", [9, 12, 20, 50])
@pytest.mark.parametrize("ratio", [1e8, 1e10, 1e12])
def test_chains_of_heavy_and_light_bodies_in_turn(n, ratio):
    rng = np.random.default_rng(n)
    mass = np.where(np.arange(n + 1) % 2 == 0, 1.0, ratio)
    G = np.eye(n, n + 1, k=1) - np.eye(n, n + 1)
    for _ in range(5):
        solved(G / mass @ G.T, G @ rng.normal(size=n + 1))


def test_an_obstacle_under_a_membrane():
    """An M-matrix of 400 unknowns, and the smallest membrane above the obstacle."""
    m = 20
    second = 2.0 * np.eye(m) - np.eye(m, k=1) - np.eye(m, k=-1)
    W = np.kron(np.eye(m), second) + np.kron(second, np.eye(m))
    x = np.linspace(-1.0, 1.0, m)
    height = (0.5 - x[:, None] ** 2 - x**2).ravel()
    z = solved(W, W @ height + 1e-3).z
    assert np.all(z >= 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("n", [300, 1000])
@pytest.mark.parametrize("kind", ["scaled", "triangular", "dominant"])
def test_p_matrices_that_are_not_definite(n, kind):
    rng = np.random.default_rng(n)
    if kind == "scaled":
        A, S = rng.normal(size=(2, n, n))
        W = 10.0 ** rng.uniform(-2, 2, (n, 1)) * (A @ A.T / n + 0.1 * np.eye(n) + S - S.T)
        W *= 10.0 ** rng.uniform(-2, 2, n)
    elif kind == "triangular":
        order = rng.permutation(n)
        W = (np.triu(0.1 * rng.normal(size=(n, n)), 1) + np.eye(n))[np.ix_(order, order)]
    else:
        W = rng.normal(size=(n, n)) * (rng.random((n, n)) < 0.2)
        np.fill_diagonal(W, 0.0)
        W = (W + np.diag(1.01 * np.abs(W).sum(axis=1) + 0.1)) * 10.0 ** rng.uniform(-3, 3, n)
    solved(W, planted(W, rng))


def test_what_has_no_solution_says_so_in_time():
    """Feasible, for w_1 = z_2 - 1; but w_2 = 1 forbids z_2 > 0. Padded to ten unknowns."""
    W, b = np.eye(10), np.ones(10)
    W[:2, :2], b[:2] = [[0.0, 1.0], [0.0, 0.0]], [-1.0, 1.0]
    solution = solve_lcp(W, b)
    assert not solution.solved
    assert not solve_lcp(W, b, method="enumeration").solved


@pytest.mark.parametrize("size", [1e-323, 1e-310, 1e-200])
def test_numbers_near_the_smallest_that_there_are_raise_nothing(size):
    """Their products come to nothing; feet on a line, whose gaps are such."""
    feet = np.column_stack([np.ones(5), np.linspace(-1.0, 1.0, 5)])
    W, b = feet @ np.diag([1.0, 10.0]) @ feet.T, size * np.array([-4.0, -2.0, 0.0, 2.0, 4.0])
    for method in ("auto", "lemke", "newton"):
        solution = solve_lcp(W, b, method=method)
        assert np.all(solution.z >= 0.0)
        assert np.max(np.abs(solution.z)) <= 10.0 * size


@pytest.mark.slow
def test_long_paths_count_against_the_time_of_a_search():
    """Triangular with large entries: some hundred pivots from each start, where other matrices need a dozen."""
    n, rng = 100, np.random.default_rng(18)
    W = np.triu(3.0 * rng.normal(size=(n, n)), 1) + np.diag(rng.uniform(0.1, 2, n))
    order = rng.permutation(n)
    W = W[np.ix_(order, order)]
    z = rng.uniform(0.1, 1.0, n) * (rng.random(n) < 0.5)
    b = rng.uniform(0.1, 1.0, n) * (z == 0.0) * (rng.random(n) < 0.8) - W @ z
    solution = solve_lcp(W, b)
    assert solution.solved or solution.iterations < 1.2e6  # 2.9e6, half a minute and more
