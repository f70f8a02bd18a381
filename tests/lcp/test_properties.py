"""What must hold for any problem: planted solutions are found, and units, order and guesses change nothing."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from lcpstep.lcp import Status, residual, solve_lcp, solve_lcp_batch

sizes = st.integers(1, 12)
seeds = st.integers(0, 2**32 - 1)


def definite(rng, n):
    G = rng.normal(size=(n, n))
    return G @ G.T + 0.1 * np.eye(n)


def planted(rng, W):
    """A b whose solution is the z returned, and is not degenerate."""
    n = len(W)
    positive = rng.random(n) < 0.5
    z = np.where(positive, rng.uniform(0.5, 2, n), 0.0)
    return np.where(positive, 0.0, rng.uniform(0.5, 2, n)) - W @ z, z


@given(sizes, seeds)
def test_planted_solution_of_a_definite_problem_is_found(n, seed):
    rng = np.random.default_rng(seed)
    W = definite(rng, n)
    W = W + (lambda A: A - A.T)(rng.normal(size=(n, n)))
    b, z = planted(rng, W)
    s = solve_lcp(W, b)
    assert s.solved
    assert s.residual <= 1e-13
    assert s.z == pytest.approx(z, abs=1e-11 * np.linalg.cond(W))


@given(sizes, seeds, st.sampled_from(["rank", "duplicated", "parallel", "chain", "skew"]))
def test_semidefinite_problems_are_solved(n, seed, kind):
    rng = np.random.default_rng(seed)
    G = rng.normal(size=(n, n))
    if kind == "rank":
        G = rng.normal(size=(n, (n + 1) // 2))
    elif kind == "duplicated":
        G = G[rng.integers(0, (n + 2) // 3, n)]
    elif kind == "parallel":
        G = G[rng.integers(0, (n + 2) // 3, n)] + 1e-7 * G
    elif kind == "chain":
        G = np.diff(np.eye(n + 1), axis=0) * 10.0 ** rng.uniform(-4, 4, n + 1)
    W = G - G.T if kind == "skew" else G @ G.T
    b, _ = planted(rng, W)
    s = solve_lcp(W, b)
    assert s.solved
    assert residual(W, b, s.z) <= 1e-10


@given(sizes, seeds)
def test_every_claim_on_any_matrix_is_true(n, seed):
    rng = np.random.default_rng(seed)
    W, b = rng.integers(-2, 3, (n, n)).astype(float), rng.integers(-2, 3, n).astype(float)
    s = solve_lcp(W, b)
    assert s.solved == (residual(W, b, s.z) <= 1e-10)
    if s.status == Status.INFEASIBLE:
        y = s.certificate
        assert y.min() >= 0
        assert np.all(W.T @ y <= 1e-14 * (np.abs(W).T @ y))
        assert b @ y < 0
    if n <= 8:
        assert solve_lcp(W, b, "enumeration").solved == s.solved


@given(sizes, seeds)
def test_units_change_nothing(n, seed):
    rng = np.random.default_rng(seed)
    W = definite(rng, n)
    b, z = planted(rng, W)
    rows, columns = 10.0 ** rng.integers(-12, 13, n), 10.0 ** rng.integers(-12, 13, n)
    s = solve_lcp(rows[:, None] * W * columns, rows * b)
    assert s.solved
    assert s.residual <= 1e-13
    assert s.z * columns == pytest.approx(z, abs=1e-11 * np.linalg.cond(W))


@given(seeds)
def test_residual_has_no_unit(seed):
    rng = np.random.default_rng(seed)
    W, b, z = rng.normal(size=(6, 6)), rng.normal(size=6), rng.normal(size=6) * (rng.random(6) < 0.7)
    rows, columns = 2.0 ** rng.integers(-40, 41, 6), 2.0 ** rng.integers(-40, 41, 6)
    assert residual(rows[:, None] * W * columns, rows * b, z / columns) == residual(W, b, z)


@given(sizes, seeds)
def test_order_changes_nothing(n, seed):
    rng = np.random.default_rng(seed)
    W = definite(rng, n)
    b, _ = planted(rng, W)
    order = rng.permutation(n)
    a, c = solve_lcp(W, b), solve_lcp(W[np.ix_(order, order)], b[order])
    assert c.z == pytest.approx(a.z[order], abs=1e-12 * np.linalg.cond(W))


@given(sizes, seeds)
def test_any_guess_is_harmless_and_a_good_one_is_quick(n, seed):
    rng = np.random.default_rng(seed)
    W = definite(rng, n)
    b, z = planted(rng, W)
    s = solve_lcp(W, b, guess=rng.normal(size=n))
    assert s.solved
    assert s.z == pytest.approx(z, abs=1e-11 * np.linalg.cond(W))
    assume(z.any())
    assert n == 1 or solve_lcp(W, b, guess=s).iterations <= 1


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 40), st.integers(1, 6), seeds)
def test_batch_is_one_by_one(m, n, seed):
    rng = np.random.default_rng(seed)
    Ws = rng.normal(size=(m, n, n))
    bs = rng.normal(size=(m, n))
    batch = solve_lcp_batch(Ws, bs)
    for i in range(m):
        alone = solve_lcp(Ws[i], bs[i])
        assert batch.solved[i] == alone.solved
        assert np.array_equal(batch.z[i], alone.z)
        assert np.array_equal(batch.w[i], alone.w)
    shared = solve_lcp_batch(definite(rng, n), bs)
    assert shared.solved.all()


@pytest.mark.parametrize("n", [5, 30])
def test_decoupled_problems_of_very_different_size(n):
    scale = 10.0 ** np.linspace(-20, 20, n)
    s = solve_lcp(np.diag(np.ones(n)), np.where(np.arange(n) % 2, -1.0, 1.0) * scale)
    assert s.solved
    assert s.z == pytest.approx(np.where(np.arange(n) % 2, scale, 0.0), rel=1e-13, abs=0)
