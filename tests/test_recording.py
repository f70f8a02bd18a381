"""The impact log is in the order of time; states stay the same wherever room is made for them."""

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, Located, Moreau, recording, simulate
from lcpstep.recording import in_order
from lcpstep.trajectory import Kind


def events(*rows):
    """Events of (time, contact), each with its place in the list as impulse."""
    return np.array([(t, c, -1.0, 0.0, k, Kind.IMPACT) for k, (t, c) in enumerate(rows)], dtype=float)


def test_events_in_order_stay_as_they_are():
    given = events((0.0, 1), (0.5, 0), (0.5, 2), (0.7, 0))
    np.testing.assert_array_equal(in_order(given, 1.0), given)


def test_the_end_of_a_sequence_stands_where_it_comes():
    log = in_order(events((0.4, 0), (0.6, 0), (0.5, 2), (0.5, 1), (0.7, 1)), 1.0)
    assert log[:, 0].tolist() == [0.4, 0.5, 0.5, 0.6, 0.7]
    assert log[:, 4].tolist() == [0, 2, 3, 1, 4]


def test_what_a_contact_does_next_ends_its_sequence():
    log = in_order(events((0.4, 0), (0.6, 0), (0.5, 1), (0.55, 0)), 1.0)
    assert log[:, 0].tolist() == [0.4, 0.5, 0.55, 0.55]
    assert log[:, 4].tolist() == [0, 2, 1, 3]


def test_nothing_is_logged_after_the_end_of_the_span():
    assert in_order(events((0.5, 0), (1.0 + 2e-16, 0)), 1.0)[:, 0].tolist() == [0.5, 1.0]


@pytest.mark.parametrize("method", [EventDriven(1e-6, 1e-6), Located(0.01), Located(0.01, 4)])
def test_one_ball_comes_to_rest_while_another_hops(method):
    """Two balls that know nothing of each other: one elastic, with hops of 1e-3 s, one at rest after 0.2 s."""
    u = 0.1 * 9.81 / 2.0  # hops of 0.1, 0.05, 0.025 ... s
    contacts = LinearContacts(G=np.eye(2), restitution=(0.5, 1.0))
    system = LinearSystem(M=np.eye(2), force=(-9.81, -9.81))
    scene = Scene(system, (0.0, 0.0), (u, 9.81 * 0.5e-3), (0.0, 0.3), contacts)
    log = simulate(scene, method).impacts
    assert np.all(np.diff(log.time) >= 0.0)
    hops = log.time[(log.contact == 1) & (log.kind == Kind.IMPACT)]
    np.testing.assert_allclose(hops, 1e-3 * np.arange(1, len(hops) + 1), atol=1e-7)
    (end,) = log[(log.contact == 0) & (log.kind == Kind.ACCUMULATION)].time
    assert end == pytest.approx(0.2, abs=1e-6)


@pytest.mark.parametrize("method", [EventDriven(), Located(0.01), Located(0.01, 4)])
@pytest.mark.parametrize(("J", "end", "restitution"), [(0.8, 0.6, (0.5, 0.3)), (0.5, 1.0, (0.0, 0.5))])
def test_a_rocking_bar_comes_to_rest_in_order(method, J, end, restitution):
    """Two ends whose impacts drive each other off; one sequence is summed up while the other goes on."""
    contacts = LinearContacts(G=[[1.0, 1.0], [1.0, -end]], restitution=restitution)
    system = LinearSystem(M=np.diag([1.0, J]), force=(-9.81, 0.0))
    run = simulate(Scene(system, (0.05, 0.03), (0.0, 0.0), (0.0, 2.0), contacts), method)
    assert np.all(np.diff(run.impacts.time) >= 0.0)
    np.testing.assert_allclose(run.at(2.0)[0], 0.0, atol=1e-9)
    assert np.min(run.impulse) >= 0.0


def test_an_impact_in_the_last_step_is_within_the_span():
    """Three steps of 0.0333 s end at 0.09990000000000002, the span at 0.0999."""
    scene = Scene(
        LinearSystem(M=1.0), 0.4 * 0.0333, -0.2, (0.0, 0.0999), LinearContacts(G=1.0, restitution=0.5)
    )
    log = simulate(scene, Moreau(0.0333)).impacts
    assert len(log) == 1
    assert np.max(log.time) == 0.0999


@pytest.mark.parametrize(
    "method", [EventDriven(), Located(1e-5), Moreau(1e-5)], ids=lambda m: type(m).__name__
)
def test_a_run_within_a_run_changes_nothing_of_it(method):
    """Buffers stay for the next run of a thread, but not while one uses them."""
    scene, other = scenes.bouncing_ball(t_end=1.2), scenes.bouncing_ball(h0=0.7, t_end=1.0)
    alone, within = simulate(scene, method), []
    run = simulate(scene, method, progress=lambda t: within.append(simulate(other, method)))
    assert len(within) > 0
    for name in ("t", "q", "v", "impulse", "impacts"):
        np.testing.assert_array_equal(getattr(run, name), getattr(alone, name))
        np.testing.assert_array_equal(getattr(within[-1], name), getattr(simulate(other, method), name))


WAYS = [
    (scenes.bouncing_ball(t_end=2.0), Moreau(h=1e-3)),
    (scenes.impact_oscillator(t_end=20.0), Moreau(h=0.1, tolerance=1e-4)),
    (scenes.impact_oscillator(t_end=20.0), Located(h=1e-2)),
    (scenes.cam_follower(660.0, t_end=0.2), Located(h=1e-4)),  # in a frame of its own
    (scenes.cam_follower(660.0, t_end=0.2), Located(h=1e-2, tolerance=1e-6)),
    (scenes.bouncing_ball(t_end=2.0), Located(h=1e-2, order=4)),
    (scenes.bouncing_ball(t_end=2.0), EventDriven()),
    (scenes.double_pendulum(), EventDriven()),
    (scenes.double_pendulum(), Moreau(h=1e-2)),
    (scenes.stick_slip_belt(), EventDriven()),
    (scenes.slider_crank(), Located(h=1e-3)),
    (scenes.falling_rod(), EventDriven()),
    (scenes.newtons_cradle(), Moreau(h=1e-3)),
]


@pytest.mark.parametrize("keep", [1, 3, "impacts"])
@pytest.mark.parametrize(("scene", "method"), WAYS)
def test_states_are_the_same_however_often_room_is_made(scene, method, keep, monkeypatch):
    at_once = simulate(scene, method, keep=keep)
    for name in ("FIRST", "EXPECTED", "UNKNOWN"):
        monkeypatch.setattr(recording, name, 0)
    little_by_little = simulate(scene, method, keep=keep)
    for name in ("t", "q", "v", "impulse", "joint_impulse", "friction_impulse"):
        mine, other = getattr(little_by_little, name), getattr(at_once, name)
        size = np.max(np.abs(other), initial=0.0)  # where a frame is, is known up to a rounding of the time
        np.testing.assert_allclose(mine, other, rtol=0.0, atol=1e-14 * size, err_msg=name)
    inside = np.linspace(*at_once.t[[0, -1]], 50) if keep == 1 else at_once.t
    for mine, other in zip(little_by_little.at(inside), at_once.at(inside), strict=True):
        np.testing.assert_allclose(mine, other, rtol=0.0, atol=1e-13)


def test_a_short_run_of_unknown_length_holds_no_more_than_it_has_written():
    m = simulate(scenes.bouncing_ball(t_end=0.1), EventDriven())
    assert len(m.t) < 40
    assert all(x.base is None or x.base.size < 100 for x in (m.t, m.q, m.v, m.impulse))
