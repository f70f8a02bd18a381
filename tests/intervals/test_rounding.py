"""Arithmetic of bounds: it holds exact results, has no bound where there is none, and is the same compiled or not."""

import functools
import itertools
import math
from fractions import Fraction

import numpy as np
import pytest

from lcpstep.intervals import rounding
from tests.uncompiled import kernels

ENDS = [-math.inf, -3e155, -2.5, -1e-310, -0.0, 0.0, 7e-300, 0.1, 1.0, 2.5, 8e200, math.inf]
INTERVALS = [(a, b) for a, b in itertools.product(ENDS, ENDS) if a <= b and a < math.inf and b > -math.inf]
FOURS = [np.array(x) for x in zip(*[(*x, *y) for x in INTERVALS for y in INTERVALS], strict=True)]
pytestmark = pytest.mark.filterwarnings("ignore:(overflow|invalid value|divide by zero):RuntimeWarning")
MEMBERS = (0.0, 0.3, 1.0)  # shares of the way from one bound to the other


@functools.cache
def members(a, b):
    """Some numbers of an interval, exact."""
    a, b = max(a, -1e300), min(b, 1e300)
    return [Fraction(a) + Fraction(s) * (Fraction(b) - Fraction(a)) for s in MEMBERS]


@pytest.mark.parametrize(
    ("name", "exact"),
    [
        ("added", lambda x, y: x + y),
        pytest.param("subtracted", lambda x, y: x - y, marks=pytest.mark.thorough),
        pytest.param("multiplied", lambda x, y: x * y, marks=pytest.mark.slow),
    ],
)
def test_bounds_hold_exact_results(name, exact):
    lo, hi = getattr(rounding, name)(*FOURS)
    assert not np.any(np.isnan(lo) | np.isnan(hi))
    for a, b, c, d, least, most in zip(*FOURS, lo, hi, strict=True):
        for x in members(a, b):
            assert all(least <= exact(x, y) <= most for y in members(c, d)), (name, a, b, c, d)


def test_an_inverse_has_no_bounds_where_zero_is_inside():
    a, b = (np.array(x) for x in zip(*INTERVALS, strict=True))
    lo, hi = rounding.inverted(a, b)
    inside = (a <= 0.0) & (b >= 0.0)
    assert np.all(np.isinf(lo[inside]) & np.isinf(hi[inside]))
    for x, y, least, most in zip(a[~inside], b[~inside], lo[~inside], hi[~inside], strict=True):
        assert all(least <= 1 / z <= most for z in members(x, y))


@pytest.mark.parametrize("name", ["moved_out", "added", "subtracted", "multiplied", "inverted", "between"])
def test_compiled_and_not_they_are_the_same(name):
    source = getattr(kernels("lcpstep.intervals").rounding, name)
    given = {
        "moved_out": [*FOURS[:2], 8.0],
        "inverted": FOURS[:2],
        "between": [
            *FOURS[:2],
            np.sin(np.clip(FOURS[0], -9.0, 9.0)),
            np.cos(np.clip(FOURS[1], -9.0, 9.0)),
            0.25,
        ],
    }.get(name, FOURS)
    finite = np.isfinite(FOURS[0]) & np.isfinite(FOURS[1])
    if name == "between":  # Python rounds no infinity to a whole number
        given = [x[finite] if isinstance(x, np.ndarray) else x for x in given]
    for built, plain in zip(getattr(rounding, name)(*given), source(*given), strict=True):
        np.testing.assert_array_equal(built, plain)
