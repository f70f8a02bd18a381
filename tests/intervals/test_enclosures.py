"""Bounds of functions over windows hold what mpmath and the functions themselves give."""

import functools
import math
from math import sin as sine

import mpmath
import numpy as np
import pytest

from lagrangian.profiles import rotating_cam
from lagrangian.scenes import cam_follower
from lcpstep.intervals import Interval, NotEnclosed, enclose

RNG = np.random.default_rng(20)
NOTHING = np.zeros(0)
TABLE = np.array([0.0, 1.0, 0.5, 2.0, -1.0])


def over(f, a, b, p=NOTHING, shape=(1,)):
    """Bounds of f over windows of time."""
    return enclose(f, Interval(np.asarray(a, dtype=float), np.asarray(b, dtype=float)), [], [], p, shape)


def of_time(f):
    """A function of one number as a callback."""

    def callback(t, q, v, p, out):
        out[0] = f(t)

    return callback


JUDGED = {
    "exp": mpmath.iv.exp, "sin": mpmath.iv.sin, "cos": mpmath.iv.cos, "sqrt": mpmath.iv.sqrt, "log": mpmath.iv.log,
}  # fmt: skip


@pytest.mark.parametrize("name", sorted(JUDGED))
def test_functions_of_math_enclose_as_tightly_as_mpmath(name):
    a = RNG.uniform(0.1, 20.0, 200)
    b = a + 10.0 ** RNG.uniform(-8, 0.5, 200)
    found = over(of_time(getattr(math, name)), a, b)
    assert not found.branched.any()
    for k in range(200):
        true = JUDGED[name](mpmath.iv.mpf([a[k], b[k]]))
        lo, hi = float(true.a), float(true.b)
        slack = 1e-14 * max(abs(lo), abs(hi), 1e-300)
        # bounds of what numpy gives: mpmath's are rounded to its own digits
        assert lo - 3 * slack <= found.lo[k, 0] <= lo + slack
        assert hi - slack <= found.hi[k, 0] <= hi + 3 * slack


def branches(t, q, v, p, out):
    """A burr, a remainder, a table and more: what users write."""
    x = t % 1.0
    k = int(4.0 * x)
    share = 4.0 * x - k
    out[0] = TABLE[k] + share * (TABLE[k + 1] - TABLE[k])
    s = (x - 0.4) / 0.05
    out[1] = (1.0 - s * s) ** 3 if abs(s) < 1.0 else 0.0
    out[2] = max(sine(3.0 * t), 0.25) - min(t, 2.0, 1.5)
    out[3] = np.interp(x, [0.0, 0.3, 1.0], [1.0, -2.0, 1.0]) + np.sqrt(t) * helper(t)
    out[4] = (
        np.where(t > 1.0, t**2, 1.0)
        + math.hypot(t, 1.0)
        + math.atan2(t, 2.0)
        - math.copysign(1.0, t - 1.0)
        + math.tan(0.4 * t)
    )


def helper(t):
    """Called by a callback."""
    total = 0.0
    for k in range(3):
        total += math.cos(k * t) / (1.0 + t**2)
    return total


def test_bounds_hold_every_value_of_a_function_with_branches():
    a = RNG.uniform(0.05, 2.5, 300)
    b = a + 10.0 ** RNG.uniform(-6, -0.7, 300)
    found = over(branches, a, b, shape=(5,))
    for _ in range(40):
        t = RNG.uniform(a, b)
        for k in range(300):
            out = np.zeros(5)
            branches(t[k], None, None, None, out)
            assert np.all(found.lo[k] <= out)
            assert np.all(out <= found.hi[k])
    narrow = b - a < 1e-4
    assert np.max((found.hi - found.lo)[narrow & ~found.branched]) < 0.03


def test_windows_without_a_branch_are_told_from_those_with_one():
    found = over(of_time(lambda t: abs(t - 1.0)), [0.0, 0.9, 1.1], [0.8, 1.2, 2.0])
    assert found.branched.tolist() == [False, True, False]
    np.testing.assert_allclose(found.lo[:, 0], [0.2, 0.0, 0.1], atol=1e-12)


def test_a_ready_profile_is_enclosed():
    scene = cam_follower()
    ends = np.linspace(0.0, 2.0 * scene.period, 401)
    z = [Interval(np.zeros(400), np.zeros(400))]
    p = np.array(scene.p)
    found = enclose(rotating_cam, Interval(ends[:-1], ends[1:]), z, z, p, (1, 3))
    for _ in range(10):
        for k, t in enumerate(RNG.uniform(ends[:-1], ends[1:])):
            out = np.zeros((1, 3))
            rotating_cam(t, None, None, p, out)
            assert np.all(found.lo[k] <= out)
            assert np.all(out <= found.hi[k])


def force(t, q, v, p, out):
    """A function of the state, as arrays and by components."""
    out[:] = -p[0] * q + v * np.sin(q)
    out[0] += q[1] * v[0] ** 2 / (1.0 + q[0] * q[0])


def test_functions_of_the_state_are_enclosed():
    q, v = RNG.uniform(-1, 1, (2, 50, 2))
    dq, dv = 10.0 ** RNG.uniform(-6, -1, (2, 50, 2))
    boxes = [[Interval(x[:, i], x[:, i] + d[:, i]) for i in range(2)] for x, d in ((q, dq), (v, dv))]
    found = enclose(force, Interval(np.zeros(50), np.ones(50)), *boxes, np.array([3.0]), (2,))
    for _ in range(20):
        x, y = q + RNG.uniform(0, 1, (50, 2)) * dq, v + RNG.uniform(0, 1, (50, 2)) * dv
        for k in range(50):
            out = np.zeros(2)
            force(0.5, x[k], y[k], [3.0], out)
            assert np.all(found.lo[k] <= out)
            assert np.all(out <= found.hi[k])


def test_partial_functions_and_closures_are_taken():
    def make(height):
        def inner(t, q, v, p, out, scale):
            out[0] = scale * height * math.sin(t)

        return inner

    found = over(functools.partial(make(2.0), scale=3.0), [0.0], [1.0])
    assert found.hi[0, 0] == pytest.approx(6.0 * math.sin(1.0))


def between_places(t, q, v, p, out):
    """A look-up that no interval can make."""
    out[0] = TABLE[math.floor(t)] + float(str(t))


@pytest.mark.parametrize(
    ("f", "why"),
    [
        (between_places, r"between_places \(test_enclosures.py, line \d+\)"),
        (of_time(math.gamma), r"callback \(test_enclosures.py"),
        (of_time(lambda t: math.sqrt(t - 5.0)), "square root of a negative number"),
    ],
)
def test_what_cannot_be_enclosed_says_where_and_why(f, why):
    with pytest.raises(NotEnclosed, match=why):
        over(f, [0.1], [0.2])


def caught(t):
    """What numbers below zero give, intervals do not raise."""
    try:
        return math.log(t - 0.5)
    except ValueError:
        return 50.0


def matched(t):
    """By a pattern that asks for True itself."""
    match t > 0.5:
        case True:
            return 1.0
        case _:
            return 2.0


def endless(t):
    """Kepler's equation by Newton's method, until a step is small."""
    x, step = t, 1.0
    while abs(step) > 1e-12:
        step = (x - 0.5 * math.sin(x) - t) / (1.0 - 0.5 * math.cos(x))
        x -= step
    return x


def always(t):
    """A loop that ends by what rounding makes of numbers."""
    while t + 1.0 > t:
        t += 0.0
    return t


@pytest.mark.parametrize(
    ("f", "why"),
    [
        (caught, r"caught \(test_enclosures.py, line \d+\): it catches an exception"),
        (matched, r"matched \(test_enclosures.py, line \d+\): it asks whether something is True"),
        (endless, "more than 32 ways"),
        (always, "decides more than 10000 times"),
        (lambda t: np.interp(t, [0.0, 1.0], [1.0, 2.0], period=1.0), "a table that is repeated"),
        (lambda t: 1.0 if type(t) is float else 2.0, "of what kind a number is"),
    ],
)
def test_what_numbers_decide_otherwise_is_refused(f, why):
    with pytest.raises(NotEnclosed, match=why):
        over(of_time(f), [0.1, 0.45], [0.2, 0.6])


@pytest.mark.parametrize(
    "f",
    [
        lambda t: 1.0 if (t > 3.0) == (t > 6.0) else 2.0,
        lambda t: 1.0 if (t > 3.0) != (t > 6.0) else 2.0,
        lambda t: 1.0 if (t > 3.0) ^ (t > 6.0) else 2.0,
        lambda t: 1.0 if (t > 3.0) == True else 2.0,  # noqa: E712
        lambda t: (t > 3.0) * t + 1.0,
        lambda t: int(t > 3.0) + float(t > 6.0),
        lambda t: 1.0 if isinstance(t, (int, float)) else 2.0,
        lambda t: np.interp(t, [2.0, 4.0, 7.0], [1.0, -1.0, 5.0], left=8.0, right=-8.0),
    ],
)
def test_conditions_are_compared_and_counted_as_truth_values_are(f):
    a = np.linspace(0.0, 9.0, 40)
    b = a + np.where(np.arange(40) % 2 == 0, 0.05, 0.6)
    found = over(of_time(f), a, b)
    for k in range(40):
        values = [f(float(t)) for t in np.linspace(a[k], b[k], 30)]
        assert found.lo[k, 0] <= min(values)
        assert max(values) <= found.hi[k, 0]
        assert found.hi[k, 0] - found.lo[k, 0] <= max(values) - min(values) + 20.0 * (b[k] - a[k])


@pytest.mark.parametrize("f", [lambda t: math.hypot(t - 3.0, 0.0), lambda t: ((t - 3.0) ** 2) ** 0.5])
def test_a_square_root_has_a_corner_at_zero(f):
    found = over(of_time(f), [1.0, 2.9, 4.0], [2.0, 3.1, 5.0])
    np.testing.assert_array_equal(found.branched, [False, True, False])


def test_globals_and_closures_count_as_they_are_now():
    scale = 1.0

    def f(t):
        return scale * t + HEIGHT

    global HEIGHT
    callback = of_time(f)
    HEIGHT = 1.0
    assert over(callback, [0.0], [1.0]).hi[0, 0] == pytest.approx(2.0)
    HEIGHT, scale = 5.0, 3.0
    assert over(callback, [0.0], [1.0]).hi[0, 0] == pytest.approx(8.0)


HEIGHT = 0.0
