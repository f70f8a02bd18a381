"""The entry for steppers, on one set of work arrays, without allocation."""

import numpy as np
import pytest

from lcpstep.lcp import Status, residual, solve_lcp
from lcpstep.lcp.kernel import solve
from lcpstep.lcp.workspace import Workspace
from tests.uncompiled import kernels, without_what_is_built

plain = kernels()


def test_one_workspace_serves_every_smaller_size():
    rng, work = np.random.default_rng(0), Workspace(30)
    for n in (30, 1, 7, 2, 3, 30):
        G = rng.normal(size=(20, n, n))
        W, b, z = G @ G.swapaxes(1, 2), rng.normal(size=(20, n)), np.zeros((20, n))
        before = W.copy(), b.copy()
        assert not any(solve(*problem, work) for problem in zip(W, b, z, strict=True))
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
    assert solve(np.array([[W]]), np.array([b]), out, Workspace(1)) == status
    assert out[0] == z


def test_not_a_number_is_not_solved():
    for n in (1, 2, 3, 9):
        W, b = np.eye(n), -np.ones(n)
        W[0, 0] = np.nan
        assert solve(W, b, np.zeros(n), Workspace(n)) != Status.SOLVED
        assert solve(np.eye(n), b * np.nan, np.zeros(n), Workspace(n)) != Status.SOLVED


def test_rows_of_small_numbers_alone_have_their_answers_refined():
    """A point slides as another lands, and 1e-16 acts between them: of a first answer one row is rounding alone."""
    W, b = np.zeros((6, 6)), np.array([0.0, -4.6, -5.7, 1.2, 0.0, 0.0])
    mu = np.array([0.04, 0.76])
    W[:4, :4] = np.diag([1.2, 1.1, 1.2, 1.1])
    W[0, 3] = W[3, 0] = 1e-16
    W[1, 2] = W[2, 1] = -2e-16
    W[0, 2] = W[2, 0] = 1e-16
    W[2, 3] = W[3, 2] = -2e-16
    W[:4, :2] -= W[:4, 2:4] * mu
    W[2:4, 4:], W[4:, :2], W[4:, 2:4] = np.eye(2), np.diag(2.0 * mu), -np.eye(2)
    z = np.zeros(6)
    assert solve(W, b, z, Workspace(6)) == Status.SOLVED
    assert residual(W, b, z) <= 1e-13


def problems():
    """Random ones of every kind: definite, dependent, indefinite, with ties, without an answer."""
    rng = np.random.default_rng(1)
    for k in range(120):
        n = 1 + k % 12 if k % 20 else 45
        G = rng.normal(size=(n, max(n - k % 3, 1)))
        A = rng.integers(-2, 3, size=(n, n)).astype(float)
        W = (G @ G.T, A, A @ A.T, -np.abs(A), G @ G.T + A - A.T)[k % 5]
        yield W, rng.integers(-3, 3, size=n).astype(float), np.maximum(rng.normal(size=n), 0.0) * (k % 2)


def test_the_same_source_runs_as_plain_python_to_the_last_bit():
    for W, b, guess in problems():
        n = len(b)
        z, expected, work, other = guess.copy(), guess.copy(), plain.workspace.Workspace(n), Workspace(n)
        with np.errstate(all="ignore"):
            status = plain.kernel.solve(W, b, z, work)
        assert status == solve(W, b, expected, other)
        assert z.tobytes() == expected.tobytes()
        assert (work.iterations, work.residual) == (other.iterations, other.residual)


NOTHING_BUILT = """
import numpy as np
import lcpstep.rows
from lcpstep.lcp import residual, solve_lcp, solve_lcp_batch
W, b = np.array([[2.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 2.0]]), np.array([-1.0, -3.0, -1.0])
print(lcpstep.rows.__file__.endswith(".py"))
for method in ("lemke", "enumeration", "pgs", "newton"):
    print(residual(W, b, solve_lcp(W, b, method).z) < 1e-10)
print(solve_lcp(-W, b).status.name, solve_lcp_batch(np.array([W, W]), np.array([b, b])).solved.all())
"""


@pytest.mark.slow
def test_everything_is_solved_where_nothing_is_built():
    assert without_what_is_built(NOTHING_BUILT).split() == ["True"] * 5 + ["INFEASIBLE", "True"]


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
