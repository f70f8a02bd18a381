"""Closed contacts whose rows depend on each other, while their obstacles part without a jump of acceleration.

At the start any of them may bear the load. What bears it a moment later is for the obstacles to decide, and all that
lie deeper are left.
"""

import numpy as np
import pytest

from lagrangian import LinearContacts, Scene, System
from lcpstep import EventDriven, Kind, Status, simulate


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
