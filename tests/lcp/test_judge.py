"""The judge itself: what it passes and what it refuses."""

import numpy as np
import pytest
import scipy.sparse as sp

from lcpstep.lcp import residual
from lcpstep.lcp.judge import is_proof

W = np.array([[2.0, 1.0], [1.0, 2.0]])
b = np.array([-1.0, 1.0])


def test_solution_is_passed_and_its_opposites_refused():
    assert residual(W, b, [0.5, 0.0]) == 0.0
    assert residual(W, b, [0.0, 0.0]) == 1.0  # w_0 = -1, nothing to cancel it
    assert residual(W, b, [-0.5, 0.0]) == 1.0
    assert residual(W, b, [1.0, 0.0]) == pytest.approx(1 / 3)  # w_0 = 1 of terms 2 and 1
    assert residual(W, b, [0.5 + 1e-6, 0.0]) == pytest.approx(1e-6, rel=1e-3)


@pytest.mark.parametrize("z", [[np.nan, 0.0], [np.inf, 0.0]])
def test_what_is_no_number_is_refused(z):
    assert residual(W, b, z) == np.inf
    assert residual(sp.csr_array(W), b, np.array(z)) == np.inf


def test_an_unknown_that_no_row_feels_must_be_zero():
    assert residual([[0.0]], [1.0], [3.0]) == 1.0
    assert residual([[0.0]], [1.0], [-1e-300]) == 1.0
    assert residual([[0.0]], [0.0], [3.0]) == 0.0


def test_an_answer_in_which_b_is_lost_is_refused():
    """z = (t, t) leaves w = b = -1 for this infeasible problem, yet w is small next to its terms."""
    A, q = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([-1.0, -1.0])
    for t in (1e6, 1e9, 1e11, 1e13, 1e18):
        assert residual(A, q, [t, t]) == 1.0
        assert residual(sp.csr_array(A), q, np.array([t, t])) == 1.0
        assert residual(A, 0 * q, [t, t]) == 0.0


def test_sparse_and_dense_agree():
    rng = np.random.default_rng(3)
    for _ in range(200):
        A = rng.normal(size=(6, 6)) * (rng.random((6, 6)) < 0.4)
        q, z = rng.normal(size=6), rng.normal(size=6) * (rng.random(6) < 0.6)
        assert residual(sp.csr_array(A), q, z) == pytest.approx(residual(A, q, z), rel=1e-12, abs=1e-15)


def test_proof_of_infeasibility_is_checked():
    A, q = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.array([-1.0, -1.0])
    assert is_proof(A, q, np.array([1.0, 1.0]))
    assert not is_proof(A, q, np.array([1.0, 0.9]))  # W^T y is not <= 0
    assert not is_proof(A, -q, np.array([1.0, 1.0]))  # b^T y is not < 0
    assert not is_proof(A, q, np.array([-1.0, -1.0]))
    assert not is_proof(A, q, np.array([np.nan, 1.0]))
