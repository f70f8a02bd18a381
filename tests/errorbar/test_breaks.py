"""Times at which runs are looked at, compiled and uncompiled."""

import math

import numpy as np
import pytest

from lcpstep.errorbar import breaks
from tests.uncompiled import kernels

KERNELS = {"compiled": breaks, "uncompiled": kernels("lcpstep.errorbar").breaks}
both = pytest.mark.parametrize("b", KERNELS.values(), ids=KERNELS)


@both
def test_times_come_once_in_their_order_and_within_bounds(b):
    x, y = np.array([3.0, 1.0, 2.0, 1.0]), np.array([2.0, 5.0, -1.0])
    assert b.increasing(x, y).tolist() == [-1.0, 1.0, 2.0, 3.0, 5.0]
    assert b.increasing(x, y, low=1.0, high=3.0).tolist() == [1.0, 2.0, 3.0]
    assert len(b.increasing(x[:0], y[:0])) == 0


@both
def test_times_are_even_and_after_given_ones(b):
    found = b.spread(1.0, 3.0, 5, np.array([1.0, 2.0, 4.0]), 3)
    assert np.allclose(found[:5], np.linspace(1.0, 3.0, 5))
    assert found[4] == 3.0
    assert found[5:].tolist() == [1.5, 1.25, 1.125, 3.0, 2.5, 2.25]


@both
def test_nodes_integrate_cubics_exactly(b):
    t = np.array([0.0, 1.0, 1.0 + 1e-3, 4.0])
    times = b.with_nodes(t)
    assert np.array_equal(times[::3], t)
    means = 0.5 * (times[1::3] ** 3 + times[2::3] ** 3)
    assert np.sum(means * np.diff(t)) == pytest.approx(64.0, rel=1e-14)
    assert b.with_nodes(t[:1]).tolist() == [0.0]


@both
def test_times_that_are_close_are_told(b):
    t = np.array([0.0, 1.0, 1.1, 1.2, 3.0])
    assert b.close(t, 0.5).tolist() == [[1.0, 1.1], [1.1, 1.2]]
    assert b.close(t[:0], math.inf).shape == (0, 2)
