"""Every method on the problems of the literature; every claim judged from W, b and z alone."""

import numpy as np
import pytest

from lcpstep.lcp import Ray, Status, residual, solve_lcp

from .known import INFEASIBLE, KNOWN, UNSOLVABLE, fathi, murty


def natural_map(W, b, z):
    """An independent judge: max |min(z, w)|, relative to the largest numbers that meet in it."""
    W, b = np.asarray(W, float), np.asarray(b, float)
    size = np.max(np.abs(b), initial=0) + np.max(np.abs(W) @ np.abs(z), initial=0) + np.max(z, initial=0)
    return np.max(np.abs(np.minimum(z, W @ z + b)), initial=0) / (size or 1)


@pytest.mark.parametrize("known", KNOWN, ids=lambda k: k.name)
@pytest.mark.parametrize("method", ["lemke", "auto"])
def test_literature_is_solved(known, method):
    s = solve_lcp(known.W, known.b, method)
    assert s.solved
    assert s.residual == pytest.approx(residual(known.W, known.b, s.z), abs=1e-15)
    assert s.residual <= 1e-10
    assert natural_map(known.W, known.b, s.z) <= 1e-12
    assert s.z.min() >= 0
    if known.solution is not None:
        assert s.z == pytest.approx(known.solution, rel=1e-10, abs=1e-12 * np.max(known.solution))


@pytest.mark.parametrize("known", [k for k in KNOWN if len(k.b) <= 10], ids=lambda k: k.name)
def test_enumeration_agrees(known):
    s = solve_lcp(known.W, known.b, "enumeration")
    assert s.solved
    assert natural_map(known.W, known.b, s.z) <= 1e-12


@pytest.mark.parametrize("known", KNOWN, ids=lambda k: k.name)
@pytest.mark.parametrize("method", ["newton", "pgs"])
def test_others_never_lie(known, method):
    if method == "pgs" and np.min(np.diag(np.asarray(known.W))) <= 0:
        with pytest.raises(ValueError, match="W must have a positive diagonal"):
            solve_lcp(known.W, known.b, method)
        return
    s = solve_lcp(known.W, known.b, method)
    assert s.residual == pytest.approx(residual(known.W, known.b, s.z), rel=1e-6, abs=1e-15)
    assert s.solved == (s.residual <= 1e-10)


@pytest.mark.parametrize("known", INFEASIBLE, ids=lambda k: k.name)
@pytest.mark.parametrize("method", ["lemke", "enumeration", "newton", "auto"])
def test_infeasible_is_proved(known, method):
    s = solve_lcp(known.W, known.b, method)
    W, b, y = np.asarray(known.W, float), np.asarray(known.b, float), s.certificate
    assert s.status == Status.INFEASIBLE
    assert not s.solved
    assert y.min() >= 0
    assert np.all(W.T @ y <= 1e-14 * (np.abs(W).T @ y))
    assert b @ y < -1e-14 * (np.abs(b) @ y)


def test_unbounded_quadratic_programme_is_infeasible():
    s = solve_lcp([[1.0, -1], [-1, 1]], [-1.0, -1], "qp")
    assert s.status == Status.INFEASIBLE
    assert s.certificate == pytest.approx([1.0, 1.0])


@pytest.mark.parametrize("known", UNSOLVABLE, ids=lambda k: k.name)
def test_unsolvable_but_feasible_ends_in_a_ray(known):
    s = solve_lcp(known.W, known.b)
    assert s.status == Status.RAY
    assert isinstance(s.certificate, Ray)
    check_ray(known.W, known.b, s.certificate)


def check_ray(W, b, ray):
    """Feasible and complementary in the widened problem at every point of the ray."""
    assert ray.d.min() > 0
    assert max(ray.dz.max(), ray.dz_0) > 0
    assert ray.dz_0 >= 0
    assert ray.dz.min() >= 0
    for t in (0.0, 1.0, 1e3):
        z, z_0 = ray.z + t * ray.dz, ray.z_0 + t * ray.dz_0
        w = W @ z + b + z_0 * ray.d
        assert z.min() >= 0
        assert w.min() >= -1e-9 * (1 + t)
        assert np.max(z * w) <= 1e-9 * (1 + t) ** 2


@pytest.mark.parametrize("problem", [murty(20), fathi(40)], ids=lambda k: k.name)
def test_exponential_examples_take_few_iterations(problem):
    assert solve_lcp(problem.W, problem.b).iterations <= 4 * len(problem.b)


def test_hilbert_backward_error_is_rounding():
    W = 1.0 / (np.arange(8)[:, None] + np.arange(8) + 1.0)
    z = np.array([1.0, 0, 2, 0, 0, 3, 0, 1])
    s = solve_lcp(W, np.where(z > 0, 0.0, 1.0) - W @ z)
    assert s.residual <= 1e-14
    assert s.z == pytest.approx(z, abs=1e-15 * np.linalg.cond(W[np.ix_(z > 0, z > 0)]) * 100)


def test_iteration_limit_is_reported():
    rng = np.random.default_rng(0)
    G = rng.normal(size=(40, 15))
    W = G @ G.T
    b = -W @ np.maximum(rng.normal(size=40), 0) + 0.1 * rng.uniform(size=40)
    s = solve_lcp(W, b, max_iterations=3)
    assert s.solved == (s.residual <= 1e-10)
    s = solve_lcp(W, b, "pgs", max_iterations=2)
    assert s.status == Status.MAX_ITERATIONS
    assert s.iterations == 2
