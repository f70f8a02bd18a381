"""What is said of a problem does not depend on the units of its rows and columns; numbers of any size."""

import numpy as np
import pytest
from scipy import sparse

from lcpstep.lcp import Ray, Status, residual, solve_lcp

PARALLEL = [[-1, 0, 0, 0], [0, 1, 0, 1], [0, -1, -1, 1], [-1, 0, -1, 1]]  # of the third and fourth unknown


def in_units(W, b, rows, columns):
    return 2.0 ** np.array(rows)[:, None] * np.array(W, dtype=float) * 2.0 ** np.array(columns), np.ldexp(
        b, rows
    )


def is_ray(W, b, ray):
    """Whether it keeps to its definition at some places, up to rounding of the terms."""
    for t in (0.0, 1.0, 1e3):
        z, d = ray.z + t * ray.dz, (ray.z_0 + t * ray.dz_0) * ray.d
        w, size = W @ z + b + d, abs(W) @ z + np.abs(b) + d
        if np.any(z < 0.0) or np.any(w < -1e-8 * size) or np.any(w[z > 0.0] > 1e-8 * size[z > 0.0]):
            return False
    return True


@pytest.mark.parametrize("size", [1e3, 1e6, 1e9, 1e12, 1e16])
def test_rows_whose_b_is_lost_are_refused_beside_rows_in_which_all_is_well(size):
    """z_3 = z_4 as large as one likes leaves w_3 = -1: next to b that is all, next to its terms it is nothing."""
    W, b, z = (
        np.array(PARALLEL, dtype=float),
        np.array([1.0, 0.0, -1.0, 1.0]),
        np.array([1.0, 0.0, size, size]),
    )
    assert residual(W, b, z) > 1e-3
    assert residual(sparse.csr_array(W), b, z) > 1e-3
    for method in ("lemke", "enumeration", "newton"):
        assert not solve_lcp(W, b, method).solved


def test_terms_that_cancel_beside_a_force_far_away_are_no_reason_to_refuse():
    """A column of bodies pushed at its end only; what is left of b elsewhere is rounding."""
    n = 60
    L = np.eye(n) - np.eye(n, k=-1)
    for order in (slice(None), slice(None, None, -1)):
        W, b = (L @ L.T)[order, order].copy(), np.full(n, 1e-17)
        b[0 if order.step is None else -1] = -1.0
        s = solve_lcp(W, b)
        assert s.solved
        assert residual(sparse.csr_array(W), b, s.z) <= 1e-15


@pytest.mark.parametrize(
    ("W", "b", "rows", "columns"),
    [
        ([[-2, 0, -1], [0, -2, 2], [-1, 2, 0]], [-1, 1, -1], [14, 18, 38], [32, -18, -32]),
        ([[-2, 0, -1], [0, -2, 2], [-1, 2, 0]], [-1, 1, -1], [0, 0, 0], [40, 0, -40]),
        ([[8, -2, 0], [-2, 1, -2], [0, -2, 8]], [-2, -2, 0], [37, -9, -20], [-1, 15, 40]),
    ],
)
def test_proofs_in_any_units(W, b, rows, columns):
    for method in ("lemke", "enumeration", "newton"):
        V, q = in_units(W, b, rows, columns)
        s = solve_lcp(V, q, method)
        assert s.status == Status.INFEASIBLE
        y = s.certificate
        assert np.all(y >= 0.0)
        assert np.all(V.T @ y <= 1e-14 * abs(V.T) @ y)
        assert q @ y < -1e-14 * np.abs(q) @ y


@pytest.mark.slow
def test_rays_are_what_they_say_in_any_units():
    rng, rays = np.random.default_rng(5), 0
    for _ in range(1500):
        n = rng.integers(3, 5)
        W = rng.integers(-3, 4, (n, n))
        W = W + W.T if rng.random() < 0.5 else W
        V, q = in_units(W, rng.integers(-3, 4, n).astype(float), *rng.integers(-40, 41, (2, n)))
        s = solve_lcp(V, q)
        if s.status == Status.RAY:
            assert isinstance(s.certificate, Ray)
            assert is_ray(V, q, s.certificate)
            rays += 1
    assert rays > 50


def test_bases_whose_columns_are_of_units_far_apart():
    W, b = [[5, 0, -4, 3], [-4, 4, 2, 12], [-6, 2, 5, 0], [-1, 0, -2, 13]], [-2.0, -1.0, -1.0, -1.0]
    rows, columns = [-12, -32, -15, 12], [-35, 5, -38, 31]
    s = solve_lcp(*in_units(W, b, rows, columns), "enumeration")
    assert s.solved
    assert np.ldexp(s.z, columns) == pytest.approx([161 / 64, 0, 103 / 32, 49 / 64], rel=1e-12)


@pytest.mark.parametrize("size", [1e-200, 1e200])
def test_right_hand_sides_of_any_size(size):
    """Products of impulses and velocities beyond the numbers that there are."""
    W = np.array([[1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    s = solve_lcp(W, size * np.array([-1.0, -1.0, 2.0]), "newton")
    assert s.solved
    assert s.z[0] + s.z[1] == pytest.approx(size)
    assert (
        not solve_lcp(W, size * np.array([-1.0, -2.0, -2.0]) - W[:, 0], "newton", max_iterations=1).z[2] < 0.0
    )
    assert solve_lcp(-W, size * np.array([-1.0, -1.0, 2.0]), "newton").status == Status.INFEASIBLE
