"""Growth of deviations where a landing wipes them out."""

import math

import numpy as np
import pytest

from lcpstep.analysis.lyapunov import lyapunov


def test_rare_landings_are_counted_and_left_out_and_frequent_ones_end_all_growth():
    class Doubling:
        """x -> 2 x mod 1, all deviations lost in every k-th iteration."""

        def __init__(self, k):
            self.k, self.count = k, 0

        def __call__(self, x):
            return (2.0 * x + 0.123) % 1.0

        def jacobian(self, x):
            self.count += 1
            return np.array([[0.0 if self.count % self.k == 0 else 2.0]])

    rare = lyapunov(Doubling(400), [0.3], 1000)
    assert (rare.largest, rare.landings) == (pytest.approx(math.log(2.0)), 2)
    assert rare.chaotic
    assert lyapunov(Doubling(10), [0.3], 1000).largest == -math.inf
