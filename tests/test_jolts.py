"""A frame whose velocity jumps puts a blow on what it carries, which forces of a frame do not have: runs say so."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Arc, CamProfile, LinearContacts, LinearJoints, LinearSystem, Scene
from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Located, Moreau, simulate

SEEING = [Located(1e-2), Located(1e-2, tolerance=1e-6), Located(1e-2, audit=True)]
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
@pytest.mark.parametrize("method", SEEING, ids=str)
def test_steps_that_see_the_motion_from_outside_need_no_blow(method, more):
    run = simulate(scene(to_and_fro, **more), method)
    np.testing.assert_allclose(run.q[-1], [5.0, 4.0], rtol=1e-12)
    assert run.doubt == ""


@pytest.mark.parametrize("more", [{}, {"corners": (0.0, 0.5), "period": 1.0}], ids=str)
@pytest.mark.parametrize("r", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("method", [EventDriven(), Located(0.05), Located(0.05, "exact")], ids=str)
def test_a_single_coordinate_is_seen_from_outside_by_flights_too(method, r, more):
    """At rest on the frame, in flight as it turns about, and between kept states: as on an obstacle that moves."""
    system, span, times = LinearSystem(2.0, force=-3.0), (0.0, 2.7), np.linspace(0.0, 2.7, 271)
    carried = Scene(
        replace(system, frame=to_and_fro), 0.2, 0.0, span, LinearContacts(1.0, restitution=r), **more
    )
    moving = LinearContacts(1.0, restitution=r, motion=to_and_fro)
    run = simulate(carried, method)
    true = simulate(Scene(system, 0.2, 1.0, span, moving, **more), EventDriven())
    assert run.doubt == ""
    np.testing.assert_allclose(run.impacts.time, true.impacts.time, rtol=1e-12)
    for t in (times, run.t):
        c = np.zeros((len(t), 1, 3))
        for k in range(len(t)):
            to_and_fro(t[k], None, None, None, c[k])
        q, v = run.at(t)
        absolute = q + c[:, :, 0], v + c[:, :, 1]
        np.testing.assert_allclose(absolute, true.at(t), rtol=0.0, atol=1e-12)


def test_runs_that_a_callback_makes_change_nothing():
    def force(t, q, v, p, out):
        simulate(scene(shaken, (0.0, 0.1)), Moreau(0.05))
        out[:] = 0.0

    system = LinearSystem(np.eye(2), frame=to_and_fro, force=force)
    run = simulate(replace(scene(to_and_fro, (0.0, 0.7)), system=system), Located(0.05))
    np.testing.assert_allclose(run.q[-1], [3.4, 2.4], rtol=1e-12)
    assert run.doubt == ""


@pytest.mark.parametrize("held", [None, "joints"])
@pytest.mark.parametrize("method", DEAF, ids=str)
def test_a_blow_is_told_without_contacts_too(method, held):
    joints = LinearJoints([[1.0, -1.0]], -1.0) if held else None
    if held and isinstance(method, Moreau) and method.tolerance:
        method = Moreau(1e-3)
    run = simulate(replace(scene(to_and_fro), contacts=None, joints=joints), method)
    assert "the velocity of the frame jumps at t = 0.5 s" in run.doubt
    assert ("Located of order 2" in run.doubt) == (held is None)


def cycloidal(t, q, v, p, out):
    """A rise of 0.1 m in 0.3 s whose speed vanishes at both ends, a dwell, and the return."""
    s, w = t % 1.0, 2.0 * np.pi / 0.3
    for i in range(len(out)):
        sign, at = (1.0, s) if s < 0.5 else (-1.0, s - 0.5)
        up = min(at, 0.3)
        out[i, 0] = (0.0 if s < 0.5 else 0.1) + sign * 0.1 / 0.3 * (up - np.sin(w * up) / w)
        out[i, 1] = sign * 0.1 / 0.3 * (1.0 - np.cos(w * up)) if at < 0.3 else 0.0
        out[i, 2] = sign * 0.1 / 0.3 * w * np.sin(w * up) if at < 0.3 else 0.0


@pytest.mark.parametrize(
    "more", [{}, {"corners": (0.0, 0.3, 0.5, 0.8), "period": 1.0}, {"period": 1.0}], ids=str
)
def test_a_speed_that_comes_to_nothing_does_not_jump(more):
    for method in (EventDriven(), Moreau(1e-3), Located(1e-2, order=4)):
        assert simulate(scene(cycloidal, **more), method).doubt == ""


@pytest.mark.parametrize("method", DEAF, ids=str)
def test_no_jump_is_told_where_there_is_none(method):
    """Smooth frames have none, nor have frames whose jumps lie at the ends of the span or outside of it."""
    for frame, span in (shaken, (0.0, 2.2)), (to_and_fro, (0.5, 1.0)), (to_and_fro, (0.6, 0.9)):
        assert simulate(scene(frame, span), method).doubt == ""


@pytest.mark.parametrize("period", [0.1, 1.0 / 3.0, 0.7])
@pytest.mark.parametrize("turns", [(3, 4), (7, 8), (10, 11)])
def test_jumps_at_the_ends_of_a_span_are_not_in_it_whatever_rounding_says(turns, period):
    def once(t, q, v, p, out):
        s = t % period
        for i in range(len(out)):
            out[i, 0], out[i, 1], out[i, 2] = s * (period - s), period - 2.0 * s, -2.0

    begin, end = (period * x for x in turns)
    span = (begin + 0.0, end)
    run = simulate(scene(once, span, period=period, corners=(0.0,)), Moreau(period / 16.0))
    assert run.doubt == ""
    longer = simulate(
        scene(once, (begin, end + 0.5 * period), period=period, corners=(0.0,)), Moreau(period / 16.0)
    )
    assert f"the velocity of the frame jumps at t = {end:.9g} s" in longer.doubt


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
