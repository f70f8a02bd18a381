"""The lowest place beside three samples, against functions whose turns are known."""

import math

import numpy as np
import pytest

from tests import uncompiled

KERNELS = uncompiled.kernels("lcpstep.kernels")


def sought(f, a, b):
    """The search between a and b in the end, and where it looked."""
    middle, turn, places = 0.5 * (a + b), KERNELS.turn.Turn(), []
    turn.begin(middle, 0.5 * (b - a), f(a), f(middle), f(b))
    while turn.seek():
        places.append(turn.x)
        turn.take(f(turn.x))
    return turn, places


@pytest.mark.parametrize("place", [0.3, 0.5, 0.77])
def test_a_smooth_turn_is_found_to_eight_digits_of_its_depth(place):
    turn, _ = sought(lambda x: 2.0 - math.cos(x - place), 0.0, 1.0)
    assert turn.least == pytest.approx(1.0, abs=1e-8)
    assert turn.lowest == pytest.approx(place, abs=1e-4)


@pytest.mark.parametrize("place", [-0.05, 0.0, 0.02, 0.98, 1.0, 1.05])
def test_nothing_is_looked_at_beyond_the_outer_samples(place):
    """Of a turn beside an end, or beyond it, that has no derivative there: parabolas lead away from where it is."""
    for power in np.linspace(0.3, 3.0, 28):
        turn, places = sought(lambda x, n=power: abs(x - place) ** n, 0.0, 1.0)
        assert places == [] or (min(places) >= 0.0 and max(places) <= 1.0)
        assert 0.0 <= turn.lowest <= 1.0
