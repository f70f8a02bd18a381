"""A scene in other units of length, time and mass gives the same events: methods have no size of their own."""

from contextlib import suppress
from functools import cache

import numpy as np
import pytest

from benchmarks.judge.draw import draw
from benchmarks.judge.variants import in_units
from lcpstep import EventDriven, LcpStepError, simulate

METHOD = EventDriven(1e-11, 1e-200, max_events=5000)  # the tolerance is relative alone
SCENES = [d for d in (draw(41, k) for k in range(80)) if d.length <= 100.0 * d.h]


@cache
def runs():
    """Scenes that can be run, and their motions."""
    made = []
    for d in SCENES:
        with suppress(LcpStepError):
            made.append((d, simulate(d.scene(), METHOD)))
    return made


@pytest.mark.parametrize(
    ("length", "time"),
    [
        pytest.param(2.0**20, 1.0, marks=pytest.mark.thorough),
        pytest.param(2.0**-20, 1.0, marks=pytest.mark.slow),
        pytest.param(1.0, 2.0**10, marks=pytest.mark.thorough),
        (2.0**10, 2.0**-10),
    ],
)
def test_events_are_the_same_in_other_units(length, time):
    """Powers of two, which nothing is rounded by."""
    compared = 0
    for d, one in runs():
        other = simulate(in_units(d, length, time, 2.0**-8).scene(), METHOD)
        a, b = one.impacts, other.impacts
        assert one.status == other.status, d
        assert len(a) == len(b), d
        np.testing.assert_array_equal(a.contact, b.contact)
        np.testing.assert_array_equal(a.kind, b.kind)
        np.testing.assert_allclose(time * a.time, b.time, rtol=1e-9)
        np.testing.assert_allclose(length / time * a.before, b.before, rtol=1e-6, atol=1e-9 * length / time)
        compared += len(a)
    assert compared > 50
