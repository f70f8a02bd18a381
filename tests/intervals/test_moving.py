"""Rates of what functions of time are, enclosed over windows."""

import math

import numpy as np
import pytest

from lcpstep.intervals import Interval, Moving, NotEnclosed, enclose
from lcpstep.intervals.moving import rate_of

N = 40
NOTHING = np.zeros(0)


def chain(t, q, v, p, out):
    s = (t - 1.3) / p[0]
    out[0] = math.exp(-s * s) * math.sin(3.0 * t) + math.sqrt(1.0 + t * t) / (2.0 + math.cos(t)) - s**3


def others(t, q, v, p, out):
    out[0] = (
        math.tanh(t) * math.atan(2.0 * t)
        - math.log(2.0 + t) * math.sinh(0.3 * t)
        + math.cosh(-t)
        + math.tan(0.1 * t)
    )


def branched(t, q, v, p, out):
    x = t - math.floor(t)
    out[0] = abs(x - 0.4) + min(x, 0.7) * max(t, 1.1) + (2.0 - x) ** -2 + (1.0 + x) ** 1.5 + math.fmod(t, 0.9)


def wrapped(t, q, v, p, out):
    out[0] = (
        np.where(t % 0.8 < 0.3, t**2, -t) + math.copysign(t, math.sin(5.0 * t)) + 2.0**t + math.asin(0.2 * t)
    )


@pytest.mark.parametrize("f", [chain, others, branched, wrapped])
@pytest.mark.parametrize("width", [1e-1, 1e-3])
def test_slopes_within_a_window_lie_between_the_bounds_of_its_rate(f, width):
    a = np.linspace(0.0013, 2.9, N)
    b = a + width
    found = enclose(f, Moving(a, b, 1.0), [], [], [0.3], (1,), rates=True)
    plain = enclose(f, Interval(a, b), [], [], [0.3], (1,))
    np.testing.assert_array_less(found.lo[:, 0, 0] - 1e-12, plain.hi[:, 0])
    out, share = np.zeros(1), np.random.default_rng(1).uniform(0.0, 1.0, 8)
    step, seen = 1e-7 * width, 0

    def value(t):
        f(t, None, None, [0.3], out)
        return float(out[0])

    for k in range(N):
        if found.branched[k]:
            continue
        for t in a[k] + share * (b[k] - a[k] - step):
            slope = (value(t + step) - value(t)) / step
            assert found.lo[k, 0, 1] - 1e-6 / width < slope < found.hi[k, 0, 1] + 1e-6 / width
            seen += 1
    assert seen > 20
    if width < 1e-2:  # and they are not wide for nothing
        assert np.median(found.hi[:, 0, 1] - found.lo[:, 0, 1]) < 0.2


def test_a_plain_interval_has_no_known_rate_and_a_number_none():
    x = rate_of(Interval(np.zeros(2), np.ones(2)))
    assert np.all(np.isinf(x.lo))
    assert np.all(np.isinf(x.hi))
    assert rate_of(3.0) == 0.0
    with np.errstate(
        invalid="ignore"
    ):  # whether infinities raise a flag on their way is the compiler's choice
        product = Moving(np.ones(1), 2.0 * np.ones(1), 1.0) * Interval(np.ones(1), np.ones(1))
    assert np.isinf(product.rate.hi[0])


def test_what_cannot_be_enclosed_says_so_as_before():
    def unknown(t, q, v, p, out):
        out[0] = math.gamma(2.0 + t)

    with pytest.raises(NotEnclosed):
        enclose(unknown, Moving(np.zeros(1), np.ones(1), 1.0), [], [], NOTHING, (1,), rates=True)
