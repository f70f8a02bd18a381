"""A function that intervals cannot pass is looked at, however many windows there are, no longer than a while."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene
from lcpstep.turns import turns
from lcpstep.turns.source import FEWEST, LOOKS, MOST_LOOKS, Source


@pytest.mark.parametrize("n", [1, 10, MOST_LOOKS // LOOKS, 1000, 20_000])
def test_each_of_many_windows_is_looked_at_less(n):
    calls = []

    def parabola(t, q, v, p, out):
        calls.append(t)
        out[0, :] = t * t, 2.0 * t, 2.0

    source = Source("contacts.motion", parabola, None, (np.zeros(1), np.zeros(1), np.zeros(0)), 1, "by hand")
    a = np.linspace(0.0, 1.0, n, endpoint=False)
    seen = source.looked_at(a, a + 1.0 / n)
    assert len(calls) <= max(MOST_LOOKS, FEWEST * n)
    assert len(calls) == n * LOOKS or len(calls) > 0.5 * MOST_LOOKS
    np.testing.assert_array_equal(seen.lo[:, 0, 0], a * a)  # the first look is at the beginning
    assert np.all(seen.hi[:, 0, 0] <= (a + 1.0 / n) ** 2)
    assert np.all(seen.hi[:, 0, 1] - seen.lo[:, 0, 1] >= 0.5 * 2.0 / n)


def test_what_is_no_number_is_zero():
    def pole(t, q, v, p, out):
        out[0, :] = np.inf if t < 0.5 else np.nan

    source = Source("contacts.motion", pole, None, (np.zeros(1), np.zeros(1), np.zeros(0)), 1, "by hand")
    assert np.all(source.values(np.linspace(0.0, 1.0, 5)) == 0.0)


def test_what_moves_by_the_time_alone_is_looked_at_once_in_whatever_state_a_scene_begins():
    """Maps start a run every period, each from another state."""

    def table(t, q, v, p, out):
        out[0, :] = 0.1 * t * t, 0.2 * t, 0.2

    scene = Scene(LinearSystem(1.0), 1.0, 0.0, (0.0, 1.0), LinearContacts(1.0, motion=table), period=1.0)
    assert turns(replace(scene, q0=2.0, v0=-1.0)) is turns(scene)
