"""What is kept of an event-driven run, and the states in between."""

import math

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.trajectory import Kind, Status
from tests.models import ball_on_table, bowl_scene, pendulum

SCENES = [
    pytest.param(scenes.bouncing_ball(t_end=5.0), id="ball"),
    pytest.param(scenes.cam_follower(t_end=0.5), id="cam-follower"),
    pytest.param(scenes.cam_follower(rpm=140.0, q0=0.0, v0=0.0, t_end=0.5), id="slow cam"),
    pytest.param(ball_on_table(0.01, 40.0, 0.3, 0.02, 0.0, 0.5), id="table"),
    pytest.param(pendulum(1.0, 0.5, 10.0), id="pendulum"),
    pytest.param(bowl_scene([0.5, 0.0], [0.0, 0.0], 4.0), id="bowl"),
]
every_scene = pytest.mark.parametrize("scene", SCENES)


def assert_same_log(m, other):
    for name in ("time", "contact", "before", "after", "impulse", "kind"):
        np.testing.assert_array_equal(m.impacts[name], other.impacts[name])


@every_scene
def test_rows_are_in_order_and_span_the_run(scene):
    m = simulate(scene, EventDriven())
    assert (m.t[0], m.t[-1]) == scene.t_span
    assert np.all(np.diff(m.t) >= 0.0)
    assert m.q.shape == m.v.shape == (len(m.t), scene.n_q)
    assert m.impulse.shape == (len(m.t), scene.n_c)
    assert m.counts.events == len(m.impacts)
    np.testing.assert_array_equal(m.q[0], scene.q0)
    assert m.status is Status.DONE


@every_scene
@pytest.mark.parametrize("keep", [2, 7, 10**6, "impacts"])
def test_kept_rows_are_rows_of_the_full_run(scene, keep):
    full, part = simulate(scene, EventDriven()), simulate(scene, EventDriven(), keep=keep)
    assert len(part.t) <= len(full.t)
    assert (part.t[0], part.t[-1]) == scene.t_span
    for t, q, v in zip(part.t, part.q, part.v, strict=True):
        same = np.flatnonzero(full.t == t)
        assert len(same) >= 1
        assert any(np.array_equal(full.q[i], q) and np.array_equal(full.v[i], v) for i in same)
    assert_same_log(part, full)


@every_scene
def test_every_impact_has_a_row_right_after_it(scene):
    m = simulate(scene, EventDriven(), keep="impacts")
    assert set(m.impacts.time[m.impacts.kind == 0]) <= set(m.t)
    for e, following in zip(m.impacts, [*m.impacts[1:], None], strict=True):
        k = np.flatnonzero(m.t == e.time)
        if e.kind == Kind.IMPACT and (following is None or following.kind != Kind.ACCUMULATION):
            assert scene.gap(m.t[k[-1]], m.q[k[-1]], m.v[k[-1]])[1][0] == pytest.approx(e.after, abs=1e-11)
        elif e.kind == Kind.IMPACT:  # the hops that follow are too low to be told from contact
            assert scene.gap(m.t[k[-1]], m.q[k[-1]], m.v[k[-1]])[1][0] == pytest.approx(0.0, abs=2 * e.after)


@every_scene
def test_states_at_given_times_are_those_of_the_full_run(scene):
    t_end = scene.t_span[1]
    times = np.unique(np.concatenate([np.linspace(0.0, t_end, 57), [1e-9, t_end * (1 - 1e-12)]]))
    full, part = simulate(scene, EventDriven()), simulate(scene, EventDriven(), keep=times)
    np.testing.assert_array_equal(part.t, times)
    q, v = full.at(times)
    np.testing.assert_allclose(part.q, q, rtol=0, atol=1e-11)
    np.testing.assert_allclose(part.v, v, rtol=0, atol=1e-9)
    assert_same_log(part, full)


HELD = {  # scene, since when, and what holds it
    "bowl": (scenes.bowl(), 0.5, lambda q: np.hypot(q[:, 0], q[:, 1]) - 1.0),
    "rod": (scenes.pendulum_stop(form="rod"), 0.0, lambda q: np.hypot(q[:, 0], q[:, 1]) - 1.0),
    "rough corner": (scenes.rocking_block(form="corners"), 0.0, lambda q: np.min(corners(q), axis=0)),
}


def corners(q):
    """Heights of the lower corners of the block."""
    s, c = np.sin(q[:, 2]), np.cos(q[:, 2])
    return q[:, 1] - 0.4 * c + 0.1 * np.stack([-s, s])


@pytest.mark.parametrize("name", HELD)
def test_states_at_given_times_lie_on_what_holds_them(name):
    scene, since, gap = HELD[name]
    m = simulate(scene, EventDriven(1e-8, 1e-8), keep=np.linspace(*scene.t_span, 501))
    assert np.max(np.abs(gap(m.q[m.t >= since]))) < 1e-15


@every_scene
def test_the_state_at_a_row_is_the_row(scene):
    m = simulate(scene, EventDriven())
    last = np.append(np.diff(m.t) > 0.0, True)  # of several rows at one time, the right limit
    q, v = m.at(m.t[last])
    np.testing.assert_array_equal(q, m.q[last])
    np.testing.assert_array_equal(v, m.v[last])


@every_scene
def test_positions_are_continuous_across_rows(scene):
    m = simulate(scene, EventDriven())
    t = m.t[1:-1]
    step = 1e-9
    q, v = m.at(t - step)
    there, after = m.at(t)
    fastest = np.max(np.abs(v)) + np.max(np.abs(after))
    # a step of 1e-9 s at the speeds of the motion
    assert np.max(np.abs(there - q)) < 2 * step * fastest + 1e-12


def test_the_velocity_at_an_impact_is_the_one_after_it():
    m = simulate(scenes.bouncing_ball(t_end=1.0), EventDriven())
    e = m.impacts[0]
    assert m.at(e.time)[1][0] == pytest.approx(e.after, rel=1e-15)
    assert m.at(np.nextafter(e.time, 0.0))[1][0] == pytest.approx(e.before, rel=1e-14)


def test_the_given_time_of_an_impact_gets_the_state_after_it():
    t = 1.0  # the dyadic ball falls from 1 with g = 2
    m = simulate(
        scenes.bouncing_ball(h0=1.0, g=2.0, restitution=0.5, t_end=2.0), EventDriven(), keep=[0.5, t, 1.5]
    )
    np.testing.assert_allclose(m.v[:, 0], [-1.0, 1.0, 0.0], rtol=0, atol=1e-15)


def test_states_after_events_are_enough_to_know_the_closed_form_in_between():
    scene = scenes.cam_follower(t_end=0.5)
    full, part = simulate(scene, EventDriven()), simulate(scene, EventDriven(), keep="impacts")
    times = np.linspace(0.0, 0.5, 101)
    np.testing.assert_allclose(part.at(times)[0], full.at(times)[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("keep", [2, [0.1, 0.2], "impacts"])
def test_states_that_were_not_kept_are_not_made_up(keep):
    m = simulate(pendulum(1.0, 0.5, 10.0), EventDriven(), keep=keep)
    np.testing.assert_array_equal(m.at(m.t)[0], m.q)
    with pytest.raises(ValueError, match=r"^t: .*not known"):
        m.at(0.15)


@pytest.mark.parametrize(("t", "said"), [
    (-1e-9, "times within"), (5.0 + 1e-9, "times within"), (math.nan, "finite"), (math.inf, "finite"),
    ([1.0, 6.0], "times within"),
])  # fmt: skip
def test_times_outside_the_run_are_refused(t, said):
    with pytest.raises(ValueError, match=f"^t: expected {said}"):
        simulate(scenes.bouncing_ball(), EventDriven()).at(t)


@pytest.mark.parametrize(
    "keep", [0, -1, True, 2.5, "all", [], [1.0, 1.0], [-0.1], [5.1], [0.0, math.nan, 1.0]]
)
def test_what_cannot_be_kept_is_refused(keep):
    with pytest.raises(ValueError, match=r"^keep: "):
        simulate(scenes.bouncing_ball(), EventDriven(), keep=keep)


def test_rows_and_logs_longer_than_their_buffers_are_complete():
    scene = scenes.bouncing_ball(h0=1.0, g=8.0, restitution=1.0, t_end=10_000.0)
    m = simulate(scene, EventDriven())
    assert len(m.impacts) == 10_000
    # half a unit of the last place of 1e4 at most for each of 1e4 bounces
    np.testing.assert_allclose(m.impacts.time, 0.5 + np.arange(10_000), rtol=0, atol=1e4 * 1e-12)
    np.testing.assert_allclose(m.at(np.arange(1, 10_000) + 0.0)[0], 1.0, rtol=0, atol=1e-9)
    few = simulate(scene, EventDriven(), keep=np.arange(0.0, 10_000.5, 0.5))
    np.testing.assert_allclose(few.q[::2], 1.0, rtol=0, atol=1e-9)
    assert len(few.t) == 20_001


@pytest.mark.parametrize("bodies", [1, 2])
@pytest.mark.parametrize("known", [True, False], ids=["linear", "by functions"])
@pytest.mark.parametrize(
    "method",
    [
        EventDriven(), EventDriven(1e-6, 1e-6), Located(0.01), Located(0.01, 4), Located(0.1, tolerance=1e-5),
        Located(0.1, 4, tolerance=1e-5), Moreau(0.01), Moreau(0.1, tolerance=1e-3),
    ],
    ids=str,
)  # fmt: skip
def test_a_state_asked_for_at_the_end_is_there_where_an_impact_falls_on_it(method, known, bodies):
    def none(t, q, v, p, out):
        out[:] = 0.0

    for speed, end in ((1.0, 3.0), (2.0, 1.5), (3.0, 1.0), (-0.5, 2.0), (-1.0, 3.0)):
        system = LinearSystem(np.eye(bodies)) if known else System(bodies, np.eye(bodies), none)
        contacts = LinearContacts(-np.sign(speed) * np.eye(bodies), [abs(speed) * end] * bodies, 0.5)
        scene = Scene(system, [0.0] * bodies, [speed] * bodies, (0.0, end), contacts=contacts)
        for times in ([end], [0.0, 0.5 * end, end], np.linspace(0.0, end, 7)):
            run = simulate(scene, method, keep=times)
            np.testing.assert_array_equal(run.t, times)
            np.testing.assert_allclose(run.q[-1], speed * end, rtol=1e-3)
