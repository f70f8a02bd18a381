"""A joint whose driven velocity jumps moves bodies against what they rest on, which strikes at that time."""

import math

import numpy as np
import pytest

from lagrangian import Coulomb, LinearContacts, LinearJoints, LinearSystem, Scene
from lcpstep import EventDriven, Located, Status, simulate

JUMP, SPEED, END, GRAVITY = 0.5123456, 0.5, 0.9, 9.81


def motion(t, q, v, p, out):
    """At rest, and from JUMP on at SPEED to the left."""
    out[0, 0] = -SPEED * (t - JUMP) if t > JUMP else 0.0
    out[0, 1] = -SPEED if t > JUMP else 0.0
    out[0, 2] = 0.0


def between_a_floor_and_a_slope(mu, corners):
    """A body on a floor, which a joint drives up the slope 0.6 x + 0.8 y >= 0."""
    friction = None if mu is None else Coulomb(mu, [[1.0, 0.0], [0.8, -0.6]])
    contacts = LinearContacts([[0.0, 1.0], [0.6, 0.8]], 0.0, 0.5, friction=friction)
    return Scene(
        LinearSystem(np.eye(2), force=[0.0, -GRAVITY]), [0.0, 0.0], [0.0, 0.0], (0.0, END), contacts,
        joints=LinearJoints([[1.0, 0.0]], motion=motion), corners=corners,
    )  # fmt: skip


@pytest.mark.parametrize("corners", [(JUMP,), ()])
@pytest.mark.parametrize("mu", [None, 0.3])
def test_a_joint_that_jumps_drives_a_body_up_a_slope(mu, corners):
    run = simulate(between_a_floor_and_a_slope(mu, corners), EventDriven())
    x = -SPEED * (END - JUMP)
    assert (run.status, run.doubt) == (Status.DONE, "")
    np.testing.assert_allclose(run.q[-1], [x, -0.75 * x], rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.v[-1], [-SPEED, 0.75 * SPEED], rtol=0, atol=1e-12)
    if mu is None:
        pressed, joint = run.impulse.sum(axis=0), run.joint_impulse.sum()
        assert joint + 0.6 * pressed[1] == pytest.approx(-SPEED, abs=1e-12)
        assert pressed[0] + 0.8 * pressed[1] == pytest.approx(0.75 * SPEED + GRAVITY * END, abs=1e-12)


@pytest.mark.parametrize("corners", [(JUMP,), ()])
@pytest.mark.parametrize("mu", [None, 0.3])
@pytest.mark.parametrize("method", [Located(1e-3), Located(1e-3, order=4)])
def test_and_by_located_steps(method, mu, corners):
    """Its drive is what supplies the energy."""
    run = simulate(between_a_floor_and_a_slope(mu, corners), method)
    x = -SPEED * (END - JUMP)
    assert (run.status, run.doubt) == (Status.DONE, "")
    np.testing.assert_allclose(run.q[-1], [x, -0.75 * x], rtol=0, atol=1e-9)


def test_a_body_that_a_joint_lifts_off_is_let_go():
    """A lift that begins to rise at a speed takes the body off the floor; no contact strikes."""

    def lift(t, q, v, p, out):
        out[0, 0] = max(0.0, t - JUMP)
        out[0, 1] = 1.0 if t > JUMP else 0.0
        out[0, 2] = 0.0

    scene = Scene(
        LinearSystem(np.eye(2), force=[0.0, -GRAVITY]), [0.0, 0.0], [1.0, 0.0], (0.0, END),
        LinearContacts([[0.0, 1.0]], 0.0, 0.5), joints=LinearJoints([[0.0, 1.0]], motion=lift), corners=(JUMP,),
    )  # fmt: skip
    run = simulate(scene, EventDriven())
    np.testing.assert_allclose(run.q[-1], [END, END - JUMP], rtol=0, atol=1e-12)
    assert run.joint_impulse.sum() + run.impulse.sum() == pytest.approx(1.0 + GRAVITY * END, abs=1e-9)
    assert math.isclose(run.v[-1, 1], 1.0, abs_tol=1e-12)
