"""Curves of the distance of two runs: what counts, what is left out, and the integrals, compiled and uncompiled."""

import numpy as np
import pytest

from lcpstep.errorbar import curves
from lcpstep.errorbar.breaks import with_nodes
from tests.uncompiled import kernels

KERNELS = {"compiled": curves, "uncompiled": kernels("lcpstep.errorbar").curves}
both = pytest.mark.parametrize("c", KERNELS.values(), ids=KERNELS)
NOTHING = np.zeros(0)
EPS = np.finfo(float).eps


def states(times, x):
    """Two runs in two coordinates, of which one is x(t) from the other, with velocity and energy likewise."""
    q = np.column_stack([x(times), -2.0 * x(times)])
    still = np.zeros_like(q)
    return (q, 3.0 * q, 5.0 * x(times)), (still, still, 0.0 * times)


def marks(times, *chosen):
    found = np.zeros(len(times), dtype=bool)
    found[list(chosen)] = True
    return found


@both
def test_the_largest_and_the_integral_are_those_of_a_polynomial(c):
    t = np.cumsum(np.random.default_rng(1).uniform(0.1, 1.0, 12))
    times, factors = with_nodes(t), np.array([1.0, 2.0, 3.0, 6.0, 5.0])
    one, other = states(times, lambda t: t**3)
    largest, integral, floor, size = c.curves(t, times, one, other, marks(times), marks(NOTHING), NOTHING)
    assert np.allclose(largest, t[:, None] ** 3 * factors, rtol=1e-14)
    assert np.allclose(integral, 0.25 * (t**4 - t[0] ** 4)[:, None] * factors, rtol=1e-12)
    assert size == pytest.approx(t[-1] ** 3 - t[0] ** 3)  # half of that of the second coordinate
    assert np.allclose(floor[:2], 4.0 * EPS * t[-1] ** 3 * np.array([1.0 + 3.0 * t[-1], 2.0 + 6.0 * t[-1]]))


@both
def test_times_left_out_do_not_count_but_for_positions_and_hidden_ones_are_those_before(c):
    t = np.array([0.0, 1.0, 2.0, 3.0])
    one, other = states(t, lambda t: np.array([1.0, 9.0, 2.0, 7.0]))
    largest, integral, *_ = c.curves(t, t, one, other, marks(t, 1), marks(t, 0, 3), NOTHING)
    assert np.allclose(largest[:, 0], [1.0, 9.0, 9.0, 9.0])
    assert np.allclose(largest[:, 4], [5.0, 5.0, 10.0, 35.0])
    assert np.allclose(integral[:, 0], [0.0, 5.0, 10.5, 15.0])
    assert np.allclose(integral[:, 4], 5.0 * np.array([0.0, 9.0, 14.5, 16.5]))  # of 9, 9, 2, 2


@both
def test_even_times_add_what_they_alone_tell_more(c):
    t = np.arange(7.0)
    one, other = states(t, lambda t: np.array([4.0, 0.0, 4.0, 0.0, 1.0, 3.0, 1.0]))
    plain, more = (
        c.curves(t, t, one, other, marks(t), marks(NOTHING), even)[1] for even in (NOTHING, t[::2].copy())
    )
    assert np.allclose(more[:, 0] - plain[:, 0], [0.0, 0.0, 4.0, 4.0, 6.5, 6.5, 6.5])


@both
def test_what_is_not_a_number_stays(c):
    t = np.arange(3.0)
    one, other = states(t, lambda t: np.array([1.0, np.nan, 2.0]))
    largest = c.curves(t, t, one, other, marks(t), marks(NOTHING), NOTHING)[0]
    assert np.isfinite(largest[0]).all()
    assert np.isnan(largest[1:]).all()


@both
def test_intervals_are_joined_and_asked_for_their_times(c):
    some = np.array([[5.0, 6.0], [0.0, 3.0], [1.0, 2.0], [6.5, 7.0], [9.0, 9.0]])
    found = c.merged(some, 0.25)
    assert np.array_equal(found, [[-0.25, 3.25], [4.75, 7.25], [8.75, 9.25]])
    assert len(c.merged(some[:0], 0.25)) == 0
    t = np.array([-1.0, -0.25, 3.25, 3.3, 7.25, 8.0, 9.0])
    assert c.within(found, t).tolist() == [False, True, True, False, True, False, True]
    assert not c.within(found[:0], t).any()
    assert c.looked_into(found, np.linspace(0.0, 9.0, 10), 3).tolist() == [True, False, False]
