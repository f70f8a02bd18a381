"""What stands in for a derivative that a scene does not give: the bias by differences, at any scale."""

import math

import numpy as np
import pytest

from lagrangian import Contacts, LinearSystem, Scene
from lcpstep.kernels.point import Point
from lcpstep.model import model


def circle_gap(t, q, v, p, out):
    out[0] = p[0] - math.hypot(q[0], q[1])


def circle_jacobian(t, q, v, p, out):
    r = math.hypot(q[0], q[1])
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def waves_gap(t, q, v, p, out):
    out[0] = 2.0 * p[0] + q[1] - p[0] * math.sin(q[0] / p[0])


def waves_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = -math.cos(q[0] / p[0]), 1.0


def exact_bias(kind, q, v, size):
    if kind == "circle":
        return -((q[0] * v[1] - q[1] * v[0]) ** 2) / math.hypot(*q) ** 3
    return math.sin(q[0] / size) / size * v[0] ** 2


GAPS = {"circle": (circle_gap, circle_jacobian), "waves": (waves_gap, waves_jacobian)}


@pytest.mark.parametrize("kind", GAPS)
@pytest.mark.parametrize("size", 10.0 ** np.arange(-7.0, 3.5))
@pytest.mark.parametrize("rate", [1e-3, 1.0, 1e3], ids="rate {:g}".format)
def test_differences_find_the_curvature_of_gaps_of_any_size(kind, size, rate):
    # a body of this size that goes round it `rate` times as fast as in a second
    q, v = size * np.array([0.3, 0.4]), size * rate * np.array([1.2, -0.7])
    gap, jacobian = GAPS[kind]
    contacts = Contacts(n_c=1, gap=gap, jacobian=jacobian)
    found = Point(model(Scene(LinearSystem(M=np.eye(2)), q, v, (0.0, 1.0), contacts, p=[size]))).gap_bias(
        0.0, q, v
    )
    exact = exact_bias(kind, q, v, size)
    assert found == pytest.approx(exact, rel=max(1e-10, 1e-12 * size, 1e-12 / rate))


def bent_gap(t, q, v, p, out):
    out[0] = q[1] - 0.5 * q[0] * abs(q[0])


def bent_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = -abs(q[0]), 1.0


def test_a_curvature_that_jumps_does_not_drown_in_ever_shorter_steps():
    contacts = Contacts(n_c=1, gap=bent_gap, jacobian=bent_jacobian)
    q, v = np.array([1e-9, 1.0]), np.array([1.0, 0.3])
    found = Point(model(Scene(LinearSystem(M=np.eye(2)), q, v, (0.0, 1.0), contacts))).gap_bias(0.0, q, v)
    assert -1.0 - 1e-6 < found < 1.0 + 1e-6  # -1 on one side of it and 1 on the other


@pytest.mark.parametrize("place", [-1e-4, -1e-6, -1e-9, 1e-9, 1e-6, 1e-4])
def test_where_a_curvature_jumps_nearby_differences_are_those_of_the_side_of_the_state(place):
    contacts = Contacts(n_c=1, gap=bent_gap, jacobian=bent_jacobian)
    q, v = np.array([place, 1.0]), np.array([3.0, 0.3])
    found = Point(model(Scene(LinearSystem(M=np.eye(2)), q, v, (0.0, 1.0), contacts))).gap_bias(0.0, q, v)
    assert found == pytest.approx(-9.0 * np.sign(place), abs=1e-7)


def test_models_of_one_scene_share_no_arrays_that_a_run_may_change():
    scene = Scene(system=LinearSystem(M=2.0, K=3.0, force=1.0), q0=0.0, v0=0.0, t_span=(0.0, 1.0))
    first, again = model(scene), model(scene)
    for name, x in first.arrays.items():
        np.testing.assert_array_equal(x, again.arrays[name])
        assert not (x.flags.writeable and np.shares_memory(x, again.arrays[name]))
    for name in (
        "p",
        "frame_now",
        "motion_now",
        "restitution",
    ):  # work space of a run, and what it sets to its own
        assert not np.shares_memory(first.arrays[name], again.arrays[name])


def jerky(t, q, v, p, out):
    """A gap that falls, but for a jerk of its speed within 1e-4 of t = 1."""
    s = (t - 1.0) / 1e-4
    out[0] = -t - ((1.0 - s * s) ** 3 if abs(s) < 1.0 else 0.0)


def jerky_gap(t, q, v, p, out):
    s = min(max((t - 1.0) / 1e-4, -1.0), 1.0)
    out[0] = q[0] + 5.0 - 0.5 * t * t - 1e-4 * (s - s**3 + 0.6 * s**5 - s**7 / 7.0)


def along(t, q, v, p, out):
    out[0, 0] = 1.0


@pytest.mark.parametrize("place", [-0.999, -0.5, 0.3, 0.999])
def test_differences_keep_to_the_smooth_interval_that_is_known(place):
    """They are 1e-3 apart where nothing is known, and see nothing of what is narrower."""
    contacts, t = Contacts(1, jerky_gap, along, jerky), 1.0 + 1e-4 * place
    point = Point(model(Scene(LinearSystem(M=1.0), 0.0, 0.0, (0.0, 2.0), contacts)))
    corners = 1.0 + 1e-4 * np.array([-1.0, -0.8, 0.0, 0.8, 1.0])
    k = int(np.searchsorted(corners, t))
    q, v = np.zeros(1), np.zeros(1)
    found = point.gap_bias(t, q, v, corners[k - 1], corners[k])
    s = (t - 1.0) / 1e-4
    assert found == pytest.approx(-1.0 + 6.0 * s * (1.0 - s * s) ** 2 / 1e-4, rel=1e-6)
