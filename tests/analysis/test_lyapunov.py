"""Growth of deviations: where a landing wipes them out, over any number of iterations, with its error."""

import math

import numpy as np
import pytest

from lcpstep.analysis.lyapunov import lyapunov, mean_growth
from lcpstep.maps import iterate


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


class Logistic:
    """x -> 4 x (1 - x), by many at a time; notes how many."""

    def __init__(self):
        self.asked = []

    def __call__(self, x):
        return 4.0 * x * (1.0 - x)

    def along(self, x, n, drop):
        self.asked.append(n)
        points = iterate(self, x, drop + n)[drop:]
        return points[1:], (4.0 - 8.0 * points[:-1])[:, :, None]


def test_the_exponent_of_any_number_of_iterations_is_summed_in_portions(monkeypatch):
    monkeypatch.setattr("lcpstep.analysis.lyapunov.PORTION", 7)
    small, reached = Logistic(), []
    found = lyapunov(small, [0.3], 5001, drop=3, progress=lambda *x: reached.append(x))
    assert max(small.asked) <= 7
    assert [x[0] for x in reached] == list(np.cumsum(small.asked[1:]))  # after those dropped
    assert reached[-1][:2] == (5001, found)
    monkeypatch.setattr("lcpstep.analysis.lyapunov.PORTION", 5001)
    monkeypatch.setattr("lcpstep.analysis.lyapunov.FIRST", 1)
    whole = Logistic()
    assert lyapunov(whole, [0.3], 5001, drop=3) == found  # to the last bit
    assert len(whole.asked) < len(small.asked)
    assert found.largest == pytest.approx(math.log(2.0), abs=4.0 * found.error)


def test_the_deviation_turns_to_where_it_grows_most_before_anything_is_averaged():
    angle, rates = 0.1, np.diag([0.9, 0.6])
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    A = (
        turn
        @ np.array([[1.0, 3.0], [0.0, 1.0]])
        @ rates
        @ np.linalg.inv(turn @ np.array([[1.0, 3.0], [0.0, 1.0]]))
    )

    class Linear:
        """x -> A x, whose largest multiplier is 0.9."""

        def __call__(self, x):
            return A @ x

        def jacobian(self, x):
            return A

    found = lyapunov(Linear(), [1.0, 1.0], 50, drop=200)
    assert found.largest == pytest.approx(math.log(0.9), abs=1e-13)
    assert found.error < 1e-13


def test_the_error_is_that_of_means_over_blocks():
    growth = np.random.default_rng(3).normal(size=4000)
    means = np.mean(growth.reshape(20, -1), axis=1)
    found = mean_growth(growth)
    assert found.largest == pytest.approx(np.mean(growth), rel=1e-12)
    assert found.error == pytest.approx(np.std(means, ddof=1) / math.sqrt(20.0), rel=1e-12)


@pytest.mark.parametrize("rounding", [-1e-16, 0.0, 1e-16])
def test_rounding_alike_in_every_iteration_is_no_exponent(rounding):
    """As of a block that every period conveys as far: standard errors are no larger than its mean."""

    class Conveyed:
        def __call__(self, x):
            return x + 0.3

        def jacobian(self, x):
            return np.array([[1.0 + 4.0 * rounding]])

    found = lyapunov(Conveyed(), [0.0], 1000)
    assert not found.chaotic
    assert abs(found.largest) < found.least
