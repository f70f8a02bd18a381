"""Quadratic programmes, Newton's method, Gauss-Seidel and the automatic choice."""

import numpy as np
import pytest
import scipy.sparse as sp

from lcpstep.lcp import Status, residual, solve_lcp

QP = ["qp", "qp:osqp", "qp:daqp", "qp:quadprog", "qp:piqp", "qp:proxqp", "qp:clarabel"]


def chain(n, rng, masses=0.0):
    """Beads in a row, all touching, thrown together; masses spread over 10^-masses to 10^masses."""
    inverse = 10.0 ** rng.uniform(-masses, masses, n + 1)
    W = sp.diags_array(
        [-inverse[1:-1], inverse[:-1] + inverse[1:], -inverse[1:-1]], offsets=[-1, 0, 1], format="csr"
    )
    return W, np.diff(rng.normal(size=n + 1))


def packing(side, rng):
    """Square packing, a disc touching its neighbours right and above: more contacts than it needs."""
    number = np.arange(side * side).reshape(side, side)
    pairs = np.concatenate(
        [
            np.stack((number[:, :-1].ravel(), number[:, 1:].ravel()), 1),
            np.stack((number[:-1].ravel(), number[1:].ravel()), 1),
        ]
    )
    horizontal = np.arange(len(pairs)) < len(pairs) // 2
    rows = np.repeat(np.arange(len(pairs)), 2)
    G = sp.coo_array(
        (np.tile([-1.0, 1.0], len(pairs)), (rows, 2 * pairs.ravel() + ~np.repeat(horizontal, 2)))
    )
    G = G.tocsr()
    return (G @ G.T).tocsr(), G @ rng.normal(size=G.shape[1])


def solver_or_skip(method):
    import qpsolvers

    name = method.partition(":")[2] or "osqp"
    if name not in qpsolvers.available_solvers:
        pytest.skip(f"{name} is not installed")


@pytest.mark.parametrize("method", QP)
def test_quadratic_programme_of_what_needs_no_impulse(method):
    """By clarabel a scene at rest had ended: its own answer was as large as its tolerance."""
    solver_or_skip(method)
    W = np.array([[2.19680847, -0.83981743], [-0.83981743, 4.66804814]])
    for b in ([0.0, 0.0], [0.0, 1e-3], [1.0, 0.0]):
        s = solve_lcp(W, np.array(b), method)
        assert s.solved
        assert not s.z.any()


@pytest.mark.parametrize("method", QP)
@pytest.mark.parametrize(
    ("b", "solution"),
    [
        ([-2.0, 2.0, 2.0, 0.0], [1.0, 0.0, 0.0, 0.0]),
        ([-1.0, 1.0, 0.0, 1.0, -1.0], [0.5, 0.0, 0.0, 0.0, 0.5]),
        ([-1.0, -1.0, -2.0, 2.0, 2.0, 1.0, 0.0, 0.0], [1.8, 2.6, 2.4, 0.2, 0.0, 0.0, 0.0, 0.0]),
    ],
)
def test_quadratic_programme_with_parts_that_nothing_drives(method, b, solution):
    """What was left of their zeros was all that their rows consisted of, and was refused."""
    solver_or_skip(method)
    n = len(b)
    W = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    s = solve_lcp(W, np.array(b), method)
    assert s.solved
    assert s.z == pytest.approx(np.array(solution), abs=1e-14)


@pytest.mark.parametrize("method", QP)
@pytest.mark.parametrize("n", [1, 2, 10, 40])
@pytest.mark.parametrize("rank", [1.0, 0.5])
def test_quadratic_programme_reaches_its_accuracy(method, n, rank):
    solver_or_skip(method)
    rng = np.random.default_rng(n)
    G = rng.normal(size=(n, max(int(rank * n), 1)))
    W = G @ G.T
    z = np.maximum(rng.normal(size=n), 0)
    s = solve_lcp(W, np.where(z > 0, 0, rng.random(n)) - W @ z, method)
    assert s.solved
    assert s.residual <= 1e-12


@pytest.mark.parametrize("method", QP)
def test_quadratic_programme_takes_sparse_and_scaled_matrices(method):
    solver_or_skip(method)
    rng = np.random.default_rng(5)
    W, b = chain(30, rng)
    d = 10.0 ** rng.integers(-6, 7, 30)
    s = solve_lcp((sp.diags_array(d) @ W @ sp.diags_array(d)).tocsc(), d * b, method)
    assert s.solved
    assert s.z * d == pytest.approx(solve_lcp(W, b).z, abs=1e-12)


@pytest.mark.parametrize("as_sparse", [False, True])
@pytest.mark.parametrize(
    ("W", "why"),
    [
        ([[1.0, 2.0], [0.0, 1.0]], r"W\[0, 1\] = 2 but W\[1, 0\] = 0"),
        ([[1.0, 2.0], [2.0, 1.0]], "eigenvalue is -1"),
        ([[1.0, 0.0], [0.0, -3.0]], r"W\[1, 1\] = -3 is negative"),
        ([[0.0, 1.0], [1.0, 1.0]], "eigenvalue is -0.6"),
    ],
)
def test_quadratic_programme_refuses_other_matrices_and_says_why(W, why, as_sparse):
    with pytest.raises(ValueError, match=why):
        solve_lcp(sp.csr_array(W) if as_sparse else W, [-1.0, 1.0], "qp")


def test_quadratic_programme_is_silent(capfd):
    W, b = chain(5, np.random.default_rng(0))
    for method in ("qp", "qp:piqp"):
        solver_or_skip(method)
        solve_lcp(W, b, method)
        solve_lcp(W, np.abs(b), method)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("method", ["newton", "auto"])
@pytest.mark.parametrize("masses", [0.0, 4.0])
def test_long_chain_is_solved_to_rounding(method, masses):
    W, b = chain(2000, np.random.default_rng(1), masses)
    s = solve_lcp(W, b, method)
    assert s.solved
    assert s.residual <= 1e-13
    assert s.method == "newton"
    assert s.z.min() >= 0


@pytest.mark.parametrize("method", ["newton", "auto"])
def test_chain_in_any_order_is_recognised(method):
    rng = np.random.default_rng(2)
    W, b = chain(500, rng, 1.0)
    order = rng.permutation(500)
    s, t = solve_lcp(W, b, method), solve_lcp(W[order][:, order], b[order], method)
    assert t.solved
    assert t.z == pytest.approx(s.z[order], rel=1e-9, abs=1e-12 * s.z.max())


@pytest.mark.parametrize("side", [5, 20])
def test_redundant_packing_is_solved(side):
    W, b = packing(side, np.random.default_rng(3))
    s = solve_lcp(W, b, "auto")
    assert s.solved
    assert residual(W, b, s.z) <= 1e-12


def test_column_at_rest_is_solved_in_one_step():
    n = 3000
    W, _ = chain(n, np.random.default_rng(0))
    s = solve_lcp(W, -np.ones(n), "auto")
    assert s.iterations == 1
    assert s.residual <= 1e-12
    assert s.z == pytest.approx(0.5 * np.arange(1, n + 1) * np.arange(n, 0, -1), rel=1e-9)


def test_newton_is_warm_started():
    W, b = chain(1000, np.random.default_rng(4))
    s = solve_lcp(W, b, "newton")
    assert solve_lcp(W, b, "newton", guess=s).iterations == 1


def test_newton_matches_pivoting_on_dense_matrices():
    rng = np.random.default_rng(6)
    G = rng.normal(size=(80, 80))
    W = G @ G.T + (lambda A: A - A.T)(rng.normal(size=(80, 80)))
    b = rng.normal(size=80)
    s = solve_lcp(W, b, "newton")
    assert s.solved
    assert s.z == pytest.approx(solve_lcp(W, b).z, abs=1e-9 * np.linalg.cond(W))


def test_gauss_seidel_is_approximate_and_says_so():
    rng = np.random.default_rng(7)
    G = rng.normal(size=(10, 20))
    W, b = G @ G.T, rng.normal(size=10)
    s = solve_lcp(W, b, "pgs")
    assert s.solved
    assert s.z == pytest.approx(solve_lcp(W, b).z, abs=1e-7)
    W, b = chain(1000, rng)
    s = solve_lcp(W, -np.abs(b), "pgs")
    assert s.status == Status.MAX_ITERATIONS
    assert s.residual > 1e-10
    with pytest.raises(ValueError, match=r"W must have a positive diagonal.*W\[1, 1\] = -1"):
        solve_lcp([[1.0, 0], [0, -1]], [1.0, 1], "pgs")


@pytest.mark.slow
def test_automatic_choice_falls_back_to_pivoting():
    """A bimatrix game is not monotone, so Newton's method does not end; its neighbours make it large."""
    rng, k, n = np.random.default_rng(8), 30, 500
    game = np.zeros((2 * k, 2 * k))
    game[:k, k:], game[k:, :k] = rng.uniform(1, 2, (k, k)), rng.uniform(1, 2, (k, k))
    W, b = sp.block_diag([game, sp.eye_array(n - 2 * k)], format="csr"), -np.ones(n)
    assert not solve_lcp(W, b, "newton").solved
    s = solve_lcp(W, b, "auto")
    assert s.solved
    assert s.residual <= 1e-13


@pytest.mark.slow
@pytest.mark.parametrize("n", [10_000, 100_000])
def test_very_long_chain(n):
    W, b = chain(n, np.random.default_rng(9), 2.0)
    s = solve_lcp(W, b, "auto")
    assert s.solved
    assert s.residual <= 1e-12


@pytest.mark.slow
def test_large_packing():
    W, b = packing(60, np.random.default_rng(10))
    s = solve_lcp(W, b, "auto")
    assert s.solved
    assert s.residual <= 1e-12
