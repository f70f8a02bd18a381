"""The Runge-Kutta method: its coefficients, its order, its errors and dense output, and the control of its steps."""

import math

import numpy as np
import pytest
from scipy.integrate import DOP853

from lcpstep.kernels import dop853, status
from lcpstep.trajectory import Status
from tests import uncompiled

KERNELS = uncompiled.kernels()
TOLERANCE = 1e-10


class Field(KERNELS.rungekutta.RungeKutta):
    """A field given as a Python function."""

    def __init__(self, f, y, positions=0, **options):
        super().__init__(len(y), positions, TOLERANCE, TOLERANCE, **options)
        self.f, self.state[:] = f, y

    def rates(self, t, y, dy):
        dy[: self.n] = self.f(t, y[: self.n])
        return bool(np.all(np.isfinite(dy[: self.n])))

    def walk(self, t, end, scan=1.0):
        """Times and states of steps to the end, or to where it cannot go on, and the status there."""
        found, code = [(t, self.state.copy())], Status.DONE
        while t < end:
            code = self.take_step(t, end - t, scan)
            if code != Status.DONE:
                break
            t += self.length
            self.state[:] = self.y_new[: self.n]
            found.append((t, self.state.copy()))
        return *map(np.array, zip(*found, strict=True)), Status(code)


def test_statuses_are_those_that_people_read():
    assert all(getattr(status, s.name) == s for s in Status)


def pendulum(t, y):
    return np.array([y[1], -math.sin(y[0]) + 0.1 * math.cos(3.0 * t)])


def test_coefficients_are_those_of_scipy():
    weights = dop853.table(dop853.WEIGHTS)
    assert np.array_equal(weights[:12, :12], DOP853.A)
    assert np.array_equal(weights[12, :12], DOP853.B)
    assert np.array_equal(weights[13:], DOP853.A_EXTRA)
    assert np.array_equal(dop853.TIMES, [*DOP853.C, 1.0, *DOP853.C_EXTRA])
    assert np.array_equal(dop853.table(dop853.DENSE), DOP853.D)
    errors = dop853.table([dop853.ERROR_3, dop853.ERROR_5])
    assert np.array_equal(errors[:, :13], [DOP853.E3, DOP853.E5])


def test_a_step_its_error_and_its_dense_output_are_those_of_scipy():
    start, h = np.array([0.4, 1.1]), 0.3
    other = DOP853(pendulum, 0.2, start, 9.0, rtol=TOLERANCE, atol=TOLERANCE, first_step=h, max_step=h)
    own = Field(pendulum, start)
    assert own.step(0.2, h)
    error = own.error_norm(h)
    other.step()
    while other.step_size < h:  # scipy has refused the step
        h = other.step_size
        own.step(0.2, h)
        error = own.error_norm(h)
    scale = TOLERANCE + TOLERANCE * np.maximum(np.abs(start), np.abs(other.y))
    assert error == pytest.approx(other._estimate_error_norm(other.K, h, scale), rel=1e-3)
    assert own.y_new[:2] == pytest.approx(other.y, rel=1e-15, abs=1e-15)
    own.complete(0.2, h)
    dense, between = other.dense_output(), np.zeros(2)
    for x in (0.0, 0.1, 0.5, 0.77, 1.0):
        own.at(x, between)
        assert between == pytest.approx(dense(0.2 + x * h), rel=1e-15, abs=1e-15)


def test_the_step_is_of_order_eight_and_the_dense_output_of_order_seven():
    def errors(h):
        own, between = Field(lambda t, y: np.array([y[1], -y[0]]), [0.0, 1.0]), np.zeros(2)
        own.step(0.0, h)
        own.complete(0.0, h)
        own.at(0.4, between)
        return abs(own.y_new[0] - math.sin(h)), abs(between[0] - math.sin(0.4 * h))

    (end, inside), (end_half, inside_half) = errors(1.0), errors(0.5)
    assert math.log2(end / end_half) > 8.5  # of one step: one more than the order
    assert math.log2(inside / inside_half) > 7.5


@pytest.mark.parametrize("positions", [0, 1])
def test_steps_that_are_controlled_meet_the_tolerance(positions):
    t, y, ended = Field(pendulum, [0.4, 1.1], positions).walk(0.0, 12.0)
    exact = DOP853(pendulum, 0.0, np.array([0.4, 1.1]), 12.0, rtol=1e-13, atol=1e-14)
    while exact.status == "running":
        exact.step()
    assert ended == Status.DONE
    assert t[-1] == pytest.approx(12.0)
    assert y[-1] == pytest.approx(exact.y, abs=100 * TOLERANCE)


@pytest.mark.parametrize("w", [1.0, 100.0])
@pytest.mark.parametrize("size", [1e-13, 1e-20, 1e-30])
def test_a_motion_below_the_tolerance_is_followed_by_steps_that_see_its_periods(w, size):
    """Any step would meet the tolerance; those of many periods had made it grow up to there."""
    field = Field(lambda t, y: np.array([y[1], -w * w * y[0]]), [size, 0.0], 1)
    t, y, ended = field.walk(0.0, 200.0 / w, scan=40.0 / w)
    assert ended == Status.DONE
    assert len(t) < 400
    assert np.hypot(y[:, 0], y[:, 1] / w) == pytest.approx(np.full(len(t), size), rel=0.4, abs=0.0)


def test_forces_that_cancel_to_rounding_need_no_short_steps():
    """What is left of their sum is no motion, and has no less of an error by shorter steps."""
    noise = np.random.default_rng(1).normal(size=10_000)
    t, _, ended = Field(lambda t, y: np.array([y[1], 1e-15 * noise[int(97.0 * t)]]), [0.0, 0.0], 1).walk(
        0.0, 100.0
    )
    assert ended == Status.DONE
    assert len(t) < 1000


def test_a_field_that_ends_is_left_where_it_is_not_finite():
    def root(t, y):
        return np.array([math.sqrt(1.0 - t) if t < 1.0 else math.nan])

    t, _, ended = Field(root, [0.0]).walk(0.0, 2.0)
    assert ended == Status.NOT_FINITE
    assert t[-1] == pytest.approx(1.0, abs=1e-6)


def test_a_field_that_never_answers_alike_is_refused():
    noise = np.random.default_rng(1)
    _, _, ended = Field(lambda t, y: noise.normal(size=1), [0.0]).walk(0.0, 1.0)
    assert ended == Status.STEP_TOO_SMALL


def test_at_an_equilibrium_rounding_of_the_state_is_no_motion():
    """Of slip and torque, no positions and velocities: steps had shrunk there to resolve roundings of 1600 N m."""

    def slip_and_torque(t, y):
        return [3.0 * (0.35 - y[0]) + math.sin(y[1] - 1600.0), 0.7 * (1600.0 - y[1]) - 0.2 * (y[0] - 0.35)]

    field = Field(slip_and_torque, [0.5, 1500.0])
    _, found, code = field.walk(0.0, 300.0, scan=300.0)
    assert code == Status.DONE
    assert found[-1] == pytest.approx([0.35, 1600.0], abs=1e-9)
    assert field.evaluations < 10_000
