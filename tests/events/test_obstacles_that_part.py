"""Closed contacts whose rows depend on each other, while their obstacles part without a jump of acceleration.

At the start any of them may bear the load. What bears it a moment later is for the obstacles to decide, and all that
lie deeper are left.
"""

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, Scene, System
from lcpstep import EventDriven, Kind, Located, Status, simulate


def pressed(t, q, v, p, out):
    out[0] = -10.0
    for i in range(1, q.shape[0]):
        out[i] = 0.0


def powers(t, q, v, p, out):
    """Each obstacle goes as p[i] t^k, k = p[-1] the same for all, in the unit of its gap."""
    k = p[-1]
    for i in range(out.shape[0]):
        out[i, 0], out[i, 1] = p[i] * t**k, p[i] * k * t ** (k - 1.0)
        out[i, 2] = p[i] * k * (k - 1.0) * t ** (k - 2.0)


@pytest.mark.parametrize(
    "rates", [(0.0, -1.0), (-1.0, 0.0), (0.0, 1.0), (1.0, 0.0), (-0.3, 0.2), (0.2, -0.3, -0.1)]
)
@pytest.mark.parametrize("power", [3.0, 4.0, 5.0])
def test_the_highest_obstacle_bears_the_body_and_the_others_are_left(rates, power):
    slopes = np.array([1.5, 3.0, 0.5])[: len(rates)]
    scene = Scene(
        System(1, 4.0, pressed), q0=0.0, v0=0.0, t_span=(0.0, 0.5), p=[*rates, power],
        contacts=LinearContacts(slopes[:, None], 0.0, 0.5, motion=powers),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    highest = int(np.argmax(np.array(rates) / slopes))
    assert m.status is Status.DONE
    assert not m.doubt
    np.testing.assert_allclose(m.q[:, 0], rates[highest] / slopes[highest] * m.t**power, rtol=0, atol=1e-9)
    left = m.impacts[m.impacts.kind == Kind.RELEASE].contact
    assert sorted(left) == [c for c in range(len(rates)) if c != highest]
    lowest = np.argmin(m.impulse.sum(axis=0))
    assert m.impulse[:, lowest].sum() >= 0.0


def test_a_body_on_three_feet_leaves_the_one_that_sinks():
    """Height and tilt on three feet; that in the middle rises or sinks from rest with t^3."""
    for rate in (-0.5, 0.5):
        scene = Scene(
            System(2, np.diag([1.0, 0.1]), pressed), q0=[0.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 0.4),
            p=[0.0, rate, 0.0, 3.0],
            contacts=LinearContacts([[1.0, -0.5], [1.0, 0.0], [1.0, 0.5]], 0.0, 0.0, motion=powers),
        )  # fmt: skip
        m = simulate(scene, EventDriven())
        assert m.status is Status.DONE
        np.testing.assert_allclose(m.q[-1], [max(rate, 0.0) * 0.4**3, 0.0], rtol=0, atol=1e-9)


def weighed(t, q, v, p, out):
    for i in range(q.shape[0]):
        out[i] = 0.0
    out[1] = -10.0


SLOPES, MU = np.array([1.5, 3.0, 0.5]), np.array([0.1, 0.3, 0.05])


def rubbed(rates):
    """A body of 4 kg that slides on obstacles of these slopes, which part as t^4."""
    n = len(rates)
    normal, tangent = SLOPES[:n, None] * [0.0, 1.0], np.ones((n, 1)) * [1.0, 0.0]
    return Scene(
        System(2, 4.0 * np.eye(2), weighed), q0=[0.0, 0.0], v0=[0.6, 0.0], t_span=(0.0, 0.4), p=[*rates, 4.0],
        contacts=LinearContacts(normal, motion=powers, friction=Coulomb(mu=MU[:n], tangent=tangent)),
    )  # fmt: skip


@pytest.mark.parametrize("rates", [(0.0, -1.0), (0.0, 1.0), (1.0, 0.0), (0.2, -0.3, -0.1)])
def test_the_highest_obstacle_alone_rubs(rates):
    """X'' = -mu lambda / m with lambda = (m y'' + 10) / slope, of the obstacle that the body is on."""
    slopes, mu = SLOPES[: len(rates)], MU[: len(rates)]
    highest = int(np.argmax(np.array(rates) / slopes))
    m = simulate(rubbed(rates), EventDriven())
    y = rates[highest] / slopes[highest] * m.t**4
    x = 0.6 * m.t - mu[highest] / slopes[highest] * (2.5 * m.t**2 / 2.0 + y)
    np.testing.assert_allclose(m.q, np.stack([x, y], axis=1), rtol=0, atol=1e-11)
    assert set(m.impacts[m.impacts.kind == Kind.RELEASE].contact) == set(range(len(rates))) - {highest}


def test_a_block_slides_to_its_rest_on_the_feet_that_are_left():
    """Of three feet that in the middle sinks; friction below the centre loads the front one."""
    feet = np.array([-0.5, 0.0, 0.5])
    normal = np.stack([0.0 * feet, 1.0 + 0.0 * feet, feet], axis=1)
    scene = Scene(
        System(3, np.diag([1.0, 1.0, 0.1]), weighed), q0=[0.0, 0.0, 0.0], v0=[0.5, 0.0, 0.0],
        t_span=(0.0, 0.4), p=[0.0, -0.5, 0.0, 3.0],
        contacts=LinearContacts(normal, motion=powers, friction=Coulomb(mu=0.3, tangent=[[1.0, 0.0, 0.2]] * 3)),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    np.testing.assert_allclose(m.q[-1], [0.25 / 6.0, 0.0, 0.0], rtol=0, atol=1e-11)
    loads = [4.4 / 6.0 + 5.0 * (0.4 - 1.0 / 6.0), 0.0, 5.6 / 6.0 + 5.0 * (0.4 - 1.0 / 6.0)]
    np.testing.assert_allclose(m.impulse.sum(axis=0)[:3], loads, rtol=0, atol=1e-7)


def belts(t, q, v, p, out):
    for i in range(out.shape[0]):
        out[i] = -p[i] * t**2


def driven(t, q, v, p, out):
    out[0], out[1], out[2] = p[2], -10.0, 0.0


def along_x(t, q, v, p, out):
    for i in range(out.shape[0]):
        out[i, 0], out[i, 1], out[i, 2] = 1.0, 0.0, 0.0


def on_belts(rates, mu, push, method):
    """A block whose feet bear 6.25 N and 3.75 N, each on a belt of its own that starts as t^2."""
    feet = np.array([-0.3, 0.5])
    normal = np.stack([0.0 * feet, 1.0 + 0.0 * feet, feet], axis=1)

    rubbing = Coulomb(mu=mu, tangent=along_x, slip=belts)
    return simulate(
        Scene(
            System(3, np.diag([1.0, 1.0, 0.1]), driven), np.zeros(3), np.zeros(3), (0.0, 0.8), p=[*rates, push],
            contacts=LinearContacts(normal, friction=rubbing),
        ),
        method,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("method", "exact"),
    [(EventDriven(), 1e-9), (Located(1e-2, order=4), 1e-9), (Located(1e-3), 1e-6)],
    ids=["event-driven", "order four", "order two"],
)
def test_belts_that_part_take_a_block_along_by_the_foot_that_can(method, exact):
    """The foot with the larger load keeps to its belt up to its friction; the other one has slid since the start."""
    along = on_belts((1.0, 0.0), 0.3, 0.0, method)  # 2 t + 1.125 = 1.875 at t = 0.375
    at, v = 0.375**3 / 3.0, 0.375**2
    assert along.q[-1, 0] == pytest.approx(at + v * 0.425 + 0.75 * 0.425**2 / 2.0, abs=exact)
    pushed = on_belts(
        (0.0, 1.0), 0.6, 4.0, method
    )  # the other foot holds, as the first cannot: 4 + 2.25 > 3.75
    assert pushed.q[-1, 0] == pytest.approx(0.8**3 / 3.0, abs=exact)


def test_located_leaves_the_obstacles_that_lie_deeper():
    for rates in ((0.0, 1.0), (1.0, 0.0), (0.2, -0.3, -0.1)):
        scene = rubbed(rates)
        run, true = simulate(scene, Located(1e-2, order=4)), simulate(scene, EventDriven())
        np.testing.assert_allclose(run.q[-1], true.q[-1], rtol=0, atol=1e-11)
        assert not run.doubt
