"""What the page shows of a run, against closed forms; and what a visitor sets."""

import math

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import EventDriven, Located, simulate
from lcpstep.cli.common import made_scene
from lcpstep.explore import session as sessions
from lcpstep.explore import views
from lcpstep.explore.session import METHODS, Session, slider_range, sliding


def session(name="impact-oscillator", **more):
    def make(values, t_end):
        return made_scene(name, values, t_end)

    return Session(make, **more)


def test_curves_are_broken_where_velocities_jump_and_meet_both_sides():
    run = simulate(scenes.bouncing_ball(h0=1.0, restitution=0.5, t_end=1.0), EventDriven())
    c, (first, second) = views.curves(run), views.impacts(run)[:2]
    gaps = np.flatnonzero(np.isnan(c.v[:, 0]))
    assert first.time == pytest.approx(math.sqrt(2.0 / 9.81), rel=1e-12)
    assert c.t[gaps[0]] == first.time
    assert c.v[gaps[0] - 1, 0] == pytest.approx(first.before, rel=1e-9)
    assert c.v[gaps[0] + 1, 0] == pytest.approx(-0.5 * first.before, rel=1e-9)
    between = (c.t > first.time) & (c.t < second.time) & ~np.isnan(c.q[:, 0])
    flown = c.t[between] - first.time
    np.testing.assert_allclose(c.q[between, 0], first.after * flown - 0.5 * 9.81 * flown**2, atol=1e-9)


def test_impacts_without_a_forcing_are_mapped_on_the_next_ones():
    run = simulate(scenes.bouncing_ball(restitution=0.5, t_end=5.0), EventDriven())
    now, following, contact = views.impact_map(run)
    assert len(now) > 3
    np.testing.assert_allclose(following[:8], 0.5 * now[:8], rtol=1e-9)
    assert set(contact) == {0}


def test_impacts_of_a_periodic_orbit_fall_on_one_phase():
    run = simulate(scenes.impact_oscillator(t_end=400.0), EventDriven())
    phase, speed, _ = views.impact_map(run)
    assert np.ptp(phase[-10:]) < 1e-9
    assert np.ptp(speed[-10:]) < 1e-9
    assert views.impact_labels(run.scene)[0].startswith("phase")


def test_a_motion_without_impacts_has_an_empty_map():
    run = simulate(scenes.bouncing_ball(h0=1.0, t_end=0.1), Located(1e-2))
    assert [len(x) for x in views.impact_map(run)] == [0, 0, 0]
    assert np.isfinite(views.curves(run).v).all()


@pytest.mark.parametrize("value", [0.8, 1.0, 0.0, -3.0, 1430.8, 3, 0, 1e-6, 12])
def test_a_slider_reaches_on_both_sides_of_its_value(value):
    low, high, step = slider_range(value)
    assert low <= value <= high
    assert 0 < step < high - low


def test_only_numbers_have_sliders():
    assert sliding({"a": 1.0, "n": 2, "on": True, "kind": "x", "none": None}) == {"a": 1.0, "n": 2}


@pytest.mark.parametrize("method", METHODS)
def test_a_start_and_parameters_are_those_that_were_set(method):
    s = session("bouncing-ball", values={"restitution": 0.5}, t_end=1.0, method=method, start=(0.3, 1.0))
    run = s.run()
    assert (run.q[0, 0], run.v[0, 0], run.t[-1]) == (0.3, 1.0, 1.0)
    assert run.scene.parameters["restitution"] == 0.5
    assert "impacts" in s.message


def test_what_cannot_begin_says_why():
    s = session("bouncing-ball", start=(-0.3, 1.0))
    assert s.run() is None
    assert "inside" in s.message
    s = session("bouncing-ball", values={"restitution": 1.5})
    assert s.run() is None
    assert "restitution" in s.message


@pytest.mark.slow
def test_a_run_that_takes_too_long_shows_what_there_is(monkeypatch):
    monkeypatch.setattr(
        sessions, "PATIENCE", 0.3
    )  # the ball has ten million bounces, all allowed, in two seconds
    s = session("elastic-ball", t_end=1e7, method="event-driven")
    run = s.run()
    assert 0.0 < run.t[-1] < 1e7
    assert "stopped after 0.3 s" in s.message


def test_the_basin_is_that_of_the_parameters_on_the_rectangle_of_the_motion():
    s = session()
    low, high = views.rectangle(s.run())
    seen = []
    data = s.basin(low, high, lambda done, total: seen.append((done, total)))
    assert list(data["name"].values) == ["O(1, 1)"]
    assert data["q"].values[0] > low[0]
    assert data["v"].values[-1] < high[1]
    assert seen
