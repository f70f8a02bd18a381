"""States between kept ones: rows found in any order, and motions as their formulas say, compiled and uncompiled."""

import numpy as np
import pytest

from lcpstep.kernels import between
from tests.uncompiled import kernels

KERNELS = {"compiled": between, "uncompiled": kernels("lcpstep.kernels").between}
T = np.array([0.0, 0.5, 0.5, 2.0, 3.0])


@pytest.mark.parametrize("b", KERNELS.values(), ids=KERNELS)
@pytest.mark.parametrize("n", [1, 2, 5, 200])
def test_rows_are_those_that_a_search_finds_whatever_the_order(b, n):
    rng = np.random.default_rng(n)
    t = np.cumsum(rng.integers(0, 3, n)).astype(float)
    for times in (rng.uniform(-1.0, t[-1] + 1.0, 60), np.sort(rng.choice(t, 60)), np.zeros(0)):
        found = np.searchsorted(t, times, side="right") - 1
        assert np.array_equal(b.last_rows(t, times, -1, n), found)
        assert np.array_equal(b.last_rows(t, times, 0, max(n - 2, 0)), np.clip(found, 0, max(n - 2, 0)))


@pytest.mark.parametrize("b", KERNELS.values(), ids=KERNELS)
def test_steps_meet_the_states_at_their_ends(b):
    rng = np.random.default_rng(3)
    q, v = rng.normal(size=(2, 5, 2))
    ends, rows = T[[0, 2, 3, 4]], np.array([0, 2, 3, 3])
    jumps = np.array([0, 0, 0, 1, 0], dtype=np.uint8)
    near = ends - np.array([0.0, 0.0, 1e-9, 1e-9])
    late = np.array([0, 2, 2, 3])
    for motion in (b.on_lines, lambda *x: b.on_parabolas(*x[:3], jumps, *x[3:])):
        assert np.allclose(motion(T, q, v, ends, rows), (q[[0, 2, 3, 4]], v[[0, 2, 3, 4]]))
        assert np.allclose(motion(T, q, v, near, late)[0], q[[0, 2, 3, 4]], atol=1e-7)
    bent = b.on_parabolas(T, q, v, jumps, near, late)[1]
    assert np.allclose(bent[3], v[4], atol=1e-7)  # meets the next velocity
    assert not np.allclose(bent[2], v[3], atol=1e-3)  # but where that has jumped


@pytest.mark.parametrize("b", KERNELS.values(), ids=KERNELS)
def test_accelerated_states_and_dense_output(b):
    rng = np.random.default_rng(4)
    q, v, a = rng.normal(size=(3, 5, 2))
    times, rows = np.array([0.25, 1.0, 3.0]), np.array([0, 2, 4])
    tau = np.array([0.25, 0.5, 0.0])[:, None]
    expected = q[rows] + tau * v[rows] + 0.5 * tau**2 * a[rows], v[rows] + tau * a[rows]
    assert np.allclose(b.accelerated(T, q, v, a[:, None], times, rows), expected)
    F, length, s = (
        rng.normal(size=(5, 3, 4)),
        np.array([0.5, 0.0, 1.5, 1.0, 0.0]),
        tau / [[0.5], [1.5], [1.0]],
    )
    moved = s * (F[rows, 0] + (1.0 - s) * (F[rows, 1] + s * F[rows, 2]))
    found = b.by_dense_output(T, q, v, length, F, times, rows)
    assert np.allclose(np.hstack(found), np.hstack([q[rows], v[rows]]) + moved)
