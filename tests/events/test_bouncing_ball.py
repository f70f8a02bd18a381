"""The bouncing ball, event by event: geometric impacts, their accumulation, and rest."""

import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import LinearContacts, LinearSystem, Scene, scenes
from lcpstep import EventDriven, simulate
from lcpstep.trajectory import Kind, Status
from tests.known import ball_height

EPS = np.finfo(float).eps


def of_kind(m, kind):
    return m.impacts[m.impacts.kind == kind]


def flights(h0, g, r, n):
    """Times and speeds of the first n impacts."""
    fall, k = math.sqrt(2 * h0 / g), np.arange(n)
    times = fall * (1 + 2 * np.concatenate([[0.0], np.cumsum(r ** k[1:])]))
    return times, g * fall * r**k


@pytest.mark.parametrize("r", [0.1, 0.5, 0.8, 0.95])
@pytest.mark.parametrize("h0", [1e-4, 1.0, 1e4])
def test_impacts_are_geometric_and_accumulate(h0, r):
    g, fall = 9.81, math.sqrt(2 * h0 / 9.81)
    end = fall * (1 + r) / (1 - r)
    m = simulate(scenes.bouncing_ball(h0=h0, restitution=r, t_end=1.5 * end), EventDriven())
    impacts = of_kind(m, Kind.IMPACT)
    times, speeds = flights(h0, g, r, len(impacts))
    assert len(impacts) >= 4  # the lowest and softest ball falls below the tolerance after four
    # every flight adds the rounding of its time and speed
    np.testing.assert_allclose(impacts.time / end, times / end, rtol=0, atol=1e-14)
    np.testing.assert_allclose(-impacts.before, speeds, rtol=1e-13)
    np.testing.assert_allclose(impacts.after, -r * impacts.before, rtol=2 * EPS)
    np.testing.assert_allclose(impacts.impulse, impacts.after - impacts.before, rtol=4 * EPS)
    assert [e.kind for e in m.impacts[-2:]] == [Kind.ACCUMULATION, Kind.STICK]
    assert of_kind(m, Kind.ACCUMULATION).time[0] == pytest.approx(end, rel=1e-14)
    assert m.status is Status.DONE


def test_after_the_accumulation_the_ball_is_at_rest():
    m = simulate(scenes.bouncing_ball(t_end=5.0), EventDriven())
    end = of_kind(m, Kind.ACCUMULATION).time[0]
    later = np.linspace(end, 5.0, 101)
    q, v = m.at(later)
    assert np.all(q == 0.0)
    assert np.all(v == 0.0)
    assert np.all(m.q[m.t >= end] == 0.0)


def test_the_height_is_that_of_the_parabolas_at_any_time():
    m = simulate(scenes.bouncing_ball(t_end=5.0), EventDriven())
    times = np.linspace(0.0, 5.0, 997)
    # the chatter map leaves out hops lower than the tolerance 1e-12
    np.testing.assert_allclose(m.at(times)[0][:, 0], ball_height(1.0, 9.81, 0.8)(times), rtol=0, atol=2e-12)


def test_a_dyadic_ball_is_exact():
    m = simulate(scenes.bouncing_ball(h0=1.0, g=2.0, restitution=0.5, t_end=4.0), EventDriven())
    impacts = of_kind(m, Kind.IMPACT)
    k = np.arange(len(impacts))
    assert len(impacts) >= 15
    np.testing.assert_array_equal(impacts.time, 3.0 - 2.0 ** (1 - k))
    np.testing.assert_allclose(impacts.before, -(2.0 ** (1 - k)), rtol=1e-14)
    assert of_kind(m, Kind.ACCUMULATION).time[0] == 3.0


def test_a_dyadic_ball_does_not_mind_where_events_fall():
    # impacts at the ends of scan intervals, or just off them: the span decides the length of these
    for t_end in (
        4.0,
        3.0,
        2.5,
        2.0 * (1 + EPS),
        2.0,
        2.0 * (1 - EPS / 2),
        1.0,
        1.0 - EPS / 2,
        50.0,
        100.0,
        200.0,
    ):
        log = simulate(
            scenes.bouncing_ball(h0=1.0, g=2.0, restitution=0.5, t_end=t_end), EventDriven()
        ).impacts
        expected = 3.0 - 2.0 ** (1.0 - np.arange(15))
        expected = expected[expected <= t_end]
        np.testing.assert_array_equal(log.time[log.kind == Kind.IMPACT][:15], expected)


def elastic(bounces):
    g, h0 = 9.81, 1.0
    fall = math.sqrt(2 * h0 / g)
    m = simulate(
        scenes.bouncing_ball(restitution=1.0, t_end=2 * fall * bounces), EventDriven(), keep="impacts"
    )
    impacts = of_kind(m, Kind.IMPACT)
    assert len(impacts) == bounces
    # speeds and periods are rounded at every bounce: a random walk of 1e-16, and 1e-16 of the time itself
    energy = 0.5 * impacts.before**2
    assert np.max(np.abs(energy / (g * h0) - 1.0)) < 1e-16 * bounces
    expected = fall * (1 + 2 * np.arange(bounces))
    assert np.max(np.abs(impacts.time - expected)) / (2 * fall) < 1e-9
    assert m.status is Status.DONE


def test_an_elastic_ball_keeps_energy_and_phase_over_a_hundred_thousand_bounces():
    elastic(100_000)


@pytest.mark.slow
def test_an_elastic_ball_keeps_energy_and_phase_over_a_million_bounces():
    elastic(1_000_000)


@pytest.mark.parametrize("t_start", [-7.0, 1e3, 1e5])
def test_spans_may_begin_anywhere(t_start):
    scene = Scene(
        system=LinearSystem(M=1.0, force=-9.81), contacts=LinearContacts(G=1.0, restitution=0.8),
        q0=1.0, v0=0.0, t_span=(t_start, t_start + 5.0),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    # times are known to rounding, some eighty of them one after the other
    expected = t_start + 9 * math.sqrt(2 / 9.81)
    assert of_kind(m, Kind.ACCUMULATION).time[0] == pytest.approx(expected, abs=80 * EPS * (abs(t_start) + 5))


@pytest.mark.parametrize("mass", [1e-3, 1e3])
def test_impulses_scale_with_the_mass(mass):
    scene = Scene(
        system=LinearSystem(M=mass, force=-9.81 * mass), contacts=LinearContacts(G=1.0, restitution=0.8),
        q0=1.0, v0=0.0, t_span=(0.0, 1.0),
    )  # fmt: skip
    e = simulate(scene, EventDriven()).impacts[0]
    assert e.impulse == pytest.approx(1.8 * mass * math.sqrt(2 * 9.81), rel=1e-14)


@pytest.mark.parametrize("scale", [-2.0, 0.5, 3.0])
def test_gaps_may_be_measured_in_any_unit_and_direction(scale):
    # gap = |scale| (height); the coordinate points down for negative scales
    scene = Scene(
        system=LinearSystem(M=1.0, force=-9.81 * np.sign(scale)),
        contacts=LinearContacts(G=scale, offset=1.0, restitution=0.8),
        q0=-1.0 / scale + np.sign(scale), v0=0.0, t_span=(0.0, 5.0),
    )  # fmt: skip
    m = simulate(scene, EventDriven())
    impacts = of_kind(m, Kind.IMPACT)
    times, speeds = flights(1.0, 9.81, 0.8, len(impacts))
    np.testing.assert_allclose(impacts.time[:40], times[:40], rtol=1e-12)
    np.testing.assert_allclose(-impacts.before[:10], abs(scale) * speeds[:10], rtol=1e-12)
    assert m.q[-1, 0] == pytest.approx(-1.0 / scale, abs=1e-15)


@pytest.mark.parametrize("start", [0.0, 1.0, 1e6])
@pytest.mark.parametrize("neighbours", [1, 2, 5])
def test_a_span_of_neighbouring_times_ends_where_it_began(start, neighbours):
    """In a few units of the last place of the time a ball falls by less than rounding."""
    end = start + neighbours * np.spacing(max(start, 1.0))
    scene = replace(scenes.bouncing_ball(), t_span=(start, end))
    run = simulate(scene, EventDriven())
    assert run.status == Status.DONE, run.message
    assert run.t[-1] == end
    np.testing.assert_allclose(run.q[-1], scene.q0, rtol=1e-15)
