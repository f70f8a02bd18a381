"""A frame whose velocity jumps puts a blow on what it carries, which forces of a frame do not have: runs say so."""

import numpy as np
import pytest

from lagrangian import Arc, CamProfile, LinearContacts, LinearSystem, Scene
from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Located, Moreau, simulate

DEAF = [EventDriven(), Located(1e-2, order=4), Moreau(1e-3), Moreau(1e-3, tolerance=1e-3)]


def to_and_fro(t, q, v, p, out):
    """Up at 1 m/s for half a second, and down again."""
    s = t % 1.0
    for i in range(len(out)):
        out[i, 0] = s if s < 0.5 else 1.0 - s
        out[i, 1] = 1.0 if s < 0.5 else -1.0
        out[i, 2] = 0.0


def shaken(t, q, v, p, out):
    """The same times, smooth."""
    out[:, 0], out[:, 1] = 0.1 * np.sin(2.0 * np.pi * t), 0.2 * np.pi * np.cos(2.0 * np.pi * t)
    out[:, 2] = -0.4 * np.pi**2 * np.sin(2.0 * np.pi * t)


def scene(frame, t_span=(0.0, 2.2), **more):
    system = LinearSystem(np.eye(2), frame=frame)
    return Scene(system, [3.0, 2.0], [0.0, 0.0], t_span, LinearContacts(np.eye(2)), **more)


@pytest.mark.parametrize("more", [{}, {"corners": (0.5,)}, {"period": 1.0}], ids=str)
@pytest.mark.parametrize("method", DEAF, ids=str)
def test_a_blow_of_the_frame_is_told_where_steps_do_not_see_it(method, more):
    """Nothing acts on the bodies: they go on at 1 m/s where the frame turns about, and are 2 m further off it."""
    run = simulate(scene(to_and_fro, **more), method)
    assert "the velocity of the frame jumps at t = 0.5 s" in run.doubt
    assert not np.allclose(run.q[-1], [5.0, 4.0], atol=0.1)


@pytest.mark.parametrize("more", [{}, {"corners": (0.5,)}, {"period": 1.0}], ids=str)
def test_steps_that_see_the_motion_from_outside_need_no_blow(more):
    run = simulate(scene(to_and_fro, **more), Located(1e-2))
    np.testing.assert_allclose(run.q[-1], [5.0, 4.0], rtol=1e-12)
    assert run.doubt == ""


@pytest.mark.parametrize("method", DEAF, ids=str)
def test_no_jump_is_told_where_there_is_none(method):
    """Smooth frames have none, nor have frames whose jumps lie at the ends of the span or outside of it."""
    for frame, span in (shaken, (0.0, 2.2)), (to_and_fro, (0.5, 1.0)), (to_and_fro, (0.6, 0.9)):
        assert simulate(scene(frame, span), method).doubt == ""


def test_the_first_jump_within_the_span_is_told_of_a_period():
    run = simulate(scene(to_and_fro, (3.7, 5.0), period=1.0), Moreau(1e-2))
    assert "jumps at t = 4 s" in run.doubt


def kinked():
    """A circle about the axis up to a radian, then one about another centre, which meets it at an angle."""
    end, kappa = 1.0, 0.1
    rho = np.hypot(0.5 + kappa * np.cos(end), kappa * np.sin(end))
    return CamProfile((Arc(end, 0.0, 0.0, 0.5), Arc(np.pi, kappa, np.pi, float(rho))), offset=0.5)


def test_a_cam_with_a_kink_is_told_in_relative_coordinates_alone():
    """There Moreau steps miss the blow of 2.4 m/s; in absolute ones the obstacle has it."""
    told = {}
    for coordinates in ("relative", "absolute"):
        scene = cam_follower(rpm=300.0, profile=kinked(), coordinates=coordinates, t_end=1.0)
        told[coordinates] = [simulate(scene, x).doubt for x in (Moreau(1e-4), Located(1e-3, order=4))]
    assert all("the velocity of the frame jumps at t = 0.118169011 s" in x for x in told["relative"])
    assert told["absolute"] == ["", ""]


@pytest.mark.parametrize("method", DEAF[1:3], ids=str)
def test_corners_of_a_smooth_cam_are_no_jumps(method):
    assert simulate(cam_follower(rpm=300.0, t_end=0.5), method).doubt == ""
