"""The first detachment of the cam-follower, found by simulating it; release at and between corners."""

import math
from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf

from lagrangian import scenes
from lcpstep import EventDriven, simulate
from lcpstep.trajectory import Kind, Status
from tests.exact import CAM_ARCS, cam_lift

TINY = mpf(10) ** -30
STIFFNESS = mpf(1430.8) / mpf(1.221)  # k/m [1/s^2]


def parting_speed(beta, within):
    """Speed at which c'' = -(k/m) c at the angle beta, by the arc on which `within` lies [rpm]."""
    c, _, ddc = cam_lift(beta, within)
    return float(mp.sqrt(-STIFFNESS * c / ddc) * 60 / (2 * mp.pi))


FLANK_END, NOSE_END = CAM_ARCS[1][0], CAM_ARCS[2][0]
FIRST_DETACHMENT = parting_speed(FLANK_END, FLANK_END + TINY)
DETACHMENT_AT_THE_END = parting_speed(NOSE_END, NOSE_END - TINY)


def run(rpm, start=0.0, turns=1.0, coordinates="relative"):
    """Follower that starts at rest on the cam, `start` turns after the beginning of the lift."""
    made = scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0, t_end=1.0, coordinates=coordinates)
    span = (start * made.period, (start + turns) * made.period)
    m = simulate(replace(made, t_span=span), EventDriven(max_events=10_000))
    assert m.status is Status.DONE, m.message
    return m


def released(m):
    return m.impacts.time[m.impacts.kind == Kind.RELEASE]


def bisect(holds, low, high):
    """Speed from which on `holds`, to 1e-10 relative."""
    assert not holds(low)
    assert holds(high)
    while high - low > 1e-10 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if holds(middle) else (middle, high)
    return 0.5 * (low + high)


def test_the_formula_gives_the_published_speeds():
    assert pytest.approx(114.979, abs=5e-4) == FIRST_DETACHMENT
    assert pytest.approx(134.873, abs=5e-4) == DETACHMENT_AT_THE_END


@pytest.mark.parametrize("coordinates", ["relative", "absolute"])
def test_the_follower_first_leaves_the_cam_at_the_speed_of_the_formula(coordinates):
    made = scenes.cam_follower(q0=0.0, v0=0.0, coordinates=coordinates)
    assert made.q0[0] >= 0.0
    found = bisect(lambda rpm: len(released(run(rpm, coordinates=coordinates))) > 0, 100.0, 130.0)
    assert found == pytest.approx(FIRST_DETACHMENT, rel=1e-8)


def test_it_leaves_at_the_corner_of_flank_and_nose():
    m = run(FIRST_DETACHMENT * (1 + 1e-6))
    corner = float(FLANK_END - mp.pi / 2) / (2 * math.pi) * m.scene.period
    assert released(m)[0] == pytest.approx(corner, rel=1e-14)


@pytest.mark.parametrize("below", [1e-9, 1e-6, 1e-3, 0.1])
def test_below_that_speed_it_never_leaves(below):
    m = run(FIRST_DETACHMENT * (1 - below), turns=5.0)
    assert [e.kind for e in m.impacts] == [Kind.STICK]
    assert np.all(m.q == 0.0)
    assert m.status is Status.DONE


def test_the_detachment_point_reaches_the_end_of_the_nose_at_the_speed_of_the_formula():
    # from the top dwell down: it leaves on the falling nose, the sooner the faster the cam turns
    def at_the_end(rpm):
        m = run(rpm, start=0.25, turns=0.3)
        corner = float(3 * mp.pi / 2 - NOSE_END) / (2 * math.pi) * m.scene.period
        return released(m)[0] - corner < 1e-12

    assert bisect(at_the_end, 120.0, 150.0) == pytest.approx(DETACHMENT_AT_THE_END, rel=1e-8)


@pytest.mark.parametrize("rpm", [116.0, 120.0, 125.0, 130.0, 134.0])
def test_between_the_two_speeds_it_leaves_where_the_contact_force_vanishes(rpm):
    m = run(rpm, start=0.25, turns=0.3)
    omega = 2 * mp.pi * mpf(rpm) / 60
    beta = omega * mpf(float(released(m)[0])) + mp.pi / 2
    c, _, ddc = cam_lift(beta, beta)
    assert abs(float(omega**2 * ddc + STIFFNESS * c)) < 1e-10 * float(STIFFNESS)


@pytest.mark.parametrize("rpm", [FIRST_DETACHMENT, DETACHMENT_AT_THE_END])
@pytest.mark.parametrize("ulps", range(-3, 4))
def test_runs_at_and_around_those_speeds_end(rpm, ulps):
    for _ in range(abs(ulps)):
        rpm = float(np.nextafter(rpm, math.copysign(math.inf, ulps)))
    m = run(rpm, turns=3.0)
    assert m.status is Status.DONE
    assert len(m.impacts) < 1000


@pytest.mark.parametrize("corner", range(6))
@pytest.mark.parametrize("rpm", [100.0, 140.0, 358.0])
def test_runs_that_start_on_a_corner_end(corner, rpm):
    made = scenes.cam_follower(rpm=rpm)
    start = made.corners[corner] / made.period
    m = run(rpm, start=start, turns=2.0)
    assert m.status is Status.DONE
    assert np.min(m.q) > -1e-14


@pytest.mark.parametrize("q0", [0.0, 1e-16, 1e-13, 1e-9])
def test_runs_that_start_hardly_above_the_cam_end(q0):
    m = simulate(scenes.cam_follower(rpm=150.0, q0=q0, v0=0.0, t_end=1.0), EventDriven())
    assert m.status is Status.DONE
    assert np.min(m.q) > -1e-14


def test_no_row_of_a_run_lies_below_the_cam_and_none_between_rows():
    m = simulate(scenes.cam_follower(rpm=200.0, q0=0.0, v0=0.0, t_end=2.0), EventDriven())
    times = np.linspace(0.0, 2.0, 20001)
    assert np.min(m.at(times)[0]) > -1e-13


@pytest.mark.parametrize("at", [0.25, 0.3, 1.0 / 3.0])
@pytest.mark.parametrize("falling", [0, 1])
@pytest.mark.parametrize("after", [-0.5, 0.5])
def test_where_the_obstacles_velocity_jumps_u_minus_is_taken_before_it_and_u_plus_after(at, falling, after):
    scene = scenes.jumping_table(at=at, after=after, falling=falling)
    m = simulate(scene, EventDriven())
    times = (np.arange(499) + 0.123) / 499.0
    q, v = m.at(times)
    exact = scene.exact(times)
    np.testing.assert_allclose(q, exact[0], rtol=0, atol=1e-13)
    np.testing.assert_allclose(v, exact[1], rtol=0, atol=1e-7)  # of a hop just before the accumulation
    _, v_jump = m.at(at)
    if falling:  # struck with g t, it leaves the new velocity with half of that
        assert v_jump[0] == pytest.approx(after + 0.5 * 9.81 * at, rel=1e-12)
    else:  # taken along, or left where it was
        assert v_jump[0] == pytest.approx(max(after, 0.0), abs=1e-12)
