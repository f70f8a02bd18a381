"""Problems with W = G A^-1 G^T, never formed: against pivoting on the W that is."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from lcpstep import solve_lcp
from lcpstep.lcp import saddle as compiled
from lcpstep.lcp.saddle import Problem, Saddle
from tests.uncompiled import kernels


def solved(A, G, r, c, chosen=False):
    saddle = Saddle(sparse.csr_array(A), sparse.csr_array(G))
    everywhere = np.ones(len(c), dtype=bool)
    return saddle.solve(Problem(r, c, np.abs(c), everywhere), everywhere & chosen, np.zeros(len(c)))


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(st.integers(1, 60), st.integers(0, 60), st.integers(0, 2**32 - 1), st.booleans(), st.booleans())
def test_it_finds_what_pivoting_finds(n, m, seed, chosen, gyroscopic):
    rng = np.random.default_rng(seed)
    B = rng.normal(size=(n, n)) * (rng.random((n, n)) < 2.0 / n)
    A = np.diag(rng.uniform(0.5, 2.0, n)) + B @ B.T + (B - B.T if gyroscopic else 0.0)
    G = rng.normal(size=(m, n)) * (rng.random((m, n)) < 3.0 / n)
    r, c = rng.normal(size=n), np.abs(G) @ rng.uniform(-1.0, 1.0, n)
    c[~G.any(axis=1)] = 1.0
    point = solved(A, G, r, c, chosen)
    W, b = G @ np.linalg.solve(A, G.T), G @ np.linalg.solve(A, r) + c
    reference = solve_lcp(W, b)
    if (
        not reference.solved or reference.method != "lemke"
    ):  # the problem is all but lost in the rounding of W
        return
    assert point.residual < 1e-13
    # the motion is unique, the impulses of redundant contacts are not
    far = np.abs(point.x - np.linalg.solve(A, r + G.T @ reference.z))
    assert np.all(far <= 1e-8 + forming_costs(A, G, W, b, reference.z))


def forming_costs(A, G, W, b, z):
    """What rounding in W and b may move the motion by, which is much where active contacts nearly depend."""
    a = z > 0.0
    rounding = np.finfo(float).eps * np.linalg.cond(A) * (np.abs(W) @ z + np.abs(b))[a]
    return np.abs(np.linalg.solve(A, G[a].T) @ np.linalg.pinv(W[np.ix_(a, a)])) @ rounding


@pytest.mark.parametrize("chosen", [False, True])
@pytest.mark.parametrize("n", [3, 300, 3000])
def test_a_column_carries_its_weight_whatever_the_guess(n, chosen):
    G = sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1])
    point = solved(sparse.eye_array(n), G, np.full(n, -1.0), np.zeros(n), chosen)
    np.testing.assert_allclose(point.z, np.arange(n, 0, -1), rtol=1e-12)


@pytest.mark.parametrize("feet", [2, 7, 500])
def test_a_block_on_many_feet_is_carried(feet):
    G = np.column_stack([np.ones(feet), np.linspace(-1.0, 1.0, feet)])
    point = solved(np.eye(2), G, np.array([-1.0, 0.25]), np.zeros(feet))
    assert point.solved
    assert np.min(point.z) >= -1e-15
    np.testing.assert_allclose(G.T @ point.z, [1.0, -0.25], rtol=0, atol=1e-13)
    np.testing.assert_allclose(point.x, 0.0, rtol=0, atol=1e-13)


def test_a_grid_without_a_narrow_band_is_solved():
    # discs on a hexagonal lattice in a box, pulled at random: redundant contacts, no band
    k, rng = 20, np.random.default_rng(4)
    places = np.array([(i + 0.5 * (j % 2), j * np.sqrt(0.75)) for j in range(k) for i in range(k)])
    near = np.linalg.norm(places[:, None] - places[None], axis=2)
    first, second = np.nonzero(np.triu(near < 1.01, 1))
    normal = places[second] - places[first]
    rows = np.repeat(np.arange(len(first)), 4)
    columns = np.column_stack([2 * first, 2 * first + 1, 2 * second, 2 * second + 1]).ravel()
    G = sparse.csr_array(
        (np.column_stack([-normal, normal]).ravel(), (rows, columns)), shape=(len(first), 2 * k * k)
    )
    floor = np.flatnonzero(places[:, 1] == 0.0)
    G = sparse.vstack([G, sparse.eye_array(2 * k * k).tocsr()[2 * floor + 1]])
    r = rng.normal(size=2 * k * k)
    r[1::2] -= 1.0
    for chosen in (False, True):
        assert solved(sparse.eye_array(2 * k * k), G, r, np.zeros(G.shape[0]), chosen).residual < 1e-14


def test_what_has_no_solution_is_refused():
    # one body between two walls that come closer
    assert not solved(np.eye(1), [[1.0], [-1.0]], np.zeros(1), np.array([-1.0, -1.0])).solved
    assert not solved(np.eye(1), [[0.0]], np.zeros(1), np.array([-1.0])).solved
    assert not solved(np.zeros((2, 2)), np.eye(2), -np.ones(2), np.zeros(2)).solved
    assert not solved(np.eye(2), np.eye(2), np.zeros(2), np.array([np.nan, 1.0])).solved
    assert not solved(np.eye(2), np.eye(2), np.array([np.nan, 0.0]), np.ones(2)).solved


def chain(n):
    """Rows of a floor and of the gaps between n bodies."""
    return sparse.diags_array([np.ones(n), -np.ones(n - 1)], offsets=[0, -1]).tocsr()


@pytest.mark.parametrize("springs", [0.0, 1.0])
def test_what_nothing_strikes_is_left_out_and_the_answer_is_that_of_the_whole(springs):
    n, rng = 400, np.random.default_rng(2)
    G = chain(n)
    A = (sparse.diags_array(rng.uniform(0.5, 2.0, n)) + springs * (G.T @ G)).tocsr()
    saddle, c = Saddle(A, G), rng.uniform(0.1, 1.0, n)
    c[[100, 103, 300]] = -1.0
    rows = np.ones(n, dtype=bool)
    rows[[90, 110, 320]] = False  # these hold nothing together
    c[[90, 320]] = -1.0  # nor do they count
    point = saddle.solve(Problem(np.zeros(n), c, np.abs(c), rows), c < 0.0, np.zeros(n))
    assert point.solved
    reached = np.flatnonzero(rows) if springs else np.r_[91:110, 111:320]
    np.testing.assert_array_equal(np.sort(saddle.rows), reached)
    z = np.zeros(n)
    z[rows] = solve_lcp(
        (G @ sparse.linalg.spsolve(A.tocsc(), G.T.tocsc())).toarray()[np.ix_(rows, rows)], c[rows]
    ).z
    np.testing.assert_allclose(point.z, z, rtol=0, atol=1e-12)
    np.testing.assert_allclose(A @ point.x, G.T @ z, rtol=0, atol=1e-12)
    nothing = saddle.solve(Problem(np.zeros(n), np.abs(c), np.abs(c), rows), rows, np.zeros(n))
    assert (len(saddle.rows), nothing.x.any(), nothing.z.any(), nothing.residual) == (0, False, False, 0.0)


@pytest.mark.parametrize("springs", [0.0, 1.0])
def test_kernels_give_the_same_bits_uncompiled(springs, monkeypatch):
    n, rng = 40, np.random.default_rng(3)
    G = chain(n)
    A, r, c = (sparse.eye_array(n) + springs * (G.T @ G)).tocsr(), rng.normal(size=n), rng.normal(size=n)
    answers = [solved(A, G, r, c, True)]
    plain = kernels("lcpstep.lcp")
    monkeypatch.setattr(compiled, "Part", plain.part.Part)
    monkeypatch.setattr(compiled, "Attempt", plain.attempt.Attempt)
    monkeypatch.setattr(compiled, "SparseRows", plain.sparse_rows.SparseRows)
    answers.append(solved(A, G, r, c, True))
    assert answers[0].z.any()
    np.testing.assert_array_equal(answers[0].x, answers[1].x)
    np.testing.assert_array_equal(answers[0].z, answers[1].z)
    assert answers[0].residual == answers[1].residual
