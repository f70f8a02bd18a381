"""Proved speeds of bifurcations against closed forms, other methods, and motions on both sides."""

import math
from dataclasses import replace

import mpmath
import pytest

from lagrangian import Harmonic, scenes
from lagrangian.scenes.table import sine_table
from lcpstep.analysis import prove_speed
from lcpstep.analysis.corners import corner_impact
from lcpstep.analysis.orbits import periodic_orbit
from lcpstep.analysis.proofs import NotProved
from tests.analysis.proved import attracting, ball, holds, on_table_orbit, sine, two_masses


def cam(rpm):
    return scenes.cam_follower(rpm=rpm)


@pytest.fixture(autouse=True)
def _digits():
    with mpmath.workdps(50):
        yield


@pytest.fixture(scope="module")
def orbit():
    return periodic_orbit(cam(700.0), [1.33, -66.2])


@pytest.mark.slow
def test_the_corner_impact_of_the_cam_follower_is_enclosed_to_twelve_digits(orbit):
    found = corner_impact(cam, 674.0, orbit.x[0])
    proof = prove_speed(found)
    middle, radius = ball(proof.rpm)
    # 673.23444500381 by 40-digit differences of the period in closed form
    assert abs(middle - mpmath.mpf("673.23444500381")) < 1e-11
    assert radius < 1e-12
    assert 673.234445004 - 5e-10 < proof.rpm.lower < proof.rpm.upper < 673.234445004 + 5e-10
    assert proof.impacts[0].time.lower - 1e-12 < found.time < proof.impacts[0].time.upper + 1e-12
    assert (proof.kind, proof.name) == ("corner", "O(1, 1)")
    assert "673.2344450038" in str(proof)


def test_a_corner_impact_is_found_from_an_orbit_some_rpm_away(orbit):
    near = periodic_orbit(cam(675.0), orbit.x[0])
    assert ball(prove_speed(near, "corner").rpm)[0] == pytest.approx(673.23444500381, abs=1e-11)


def test_the_flip_of_the_cam_follower_is_where_continuation_has_it(orbit):
    near = periodic_orbit(cam(739.0), orbit.x[0])
    proof = prove_speed(near, "flip")
    assert ball(proof.rpm)[0] == pytest.approx(739.3197802, abs=5e-8)
    beside = [
        periodic_orbit(cam(float(ball(proof.rpm)[0]) + d), near.x[0]).multipliers[0].real
        for d in (-1e-6, 1e-6)
    ]
    assert beside[0] > -1.0 > beside[1]


@pytest.mark.parametrize(("A", "r"), [(0.01, 0.5), (0.017, 0.62), (0.008, 0.3)])
def test_the_flip_of_a_ball_on_a_table_has_a_closed_form(A, r):
    # trace = -(1 + r^2): A w^2 sin(phase) = 2 g (1 + r^2)/(1 + r)^2, and A w^2 cos(phase) = pi g (1 - r)/(1 + r)
    a, e, g = mpmath.mpf(A), mpmath.mpf(r), mpmath.mpf(9.81)
    truth = mpmath.sqrt(
        mpmath.hypot(2 * g * (1 + e**2) / (1 + e) ** 2, mpmath.pi * g * (1 - e) / (1 + e)) / a
    )
    proof = prove_speed(on_table_orbit(sine_table, (A, float(truth) * 0.99, 0.0), r), "flip")
    assert holds(proof.omega, truth)
    assert holds(proof.rpm, 30 * truth / mpmath.pi, 1e-24)


@pytest.mark.parametrize(("A", "r"), [(0.01, 0.5), (0.017, 0.62), (0.008, 0.3)])
def test_the_fold_of_a_ball_on_a_table_has_a_closed_form(A, r):
    # Two orbits meet where cos(phase) = 1, and there is none below
    a, e, g = mpmath.mpf(A), mpmath.mpf(r), mpmath.mpf(9.81)
    truth = mpmath.sqrt(mpmath.pi * g * (1 - e) / (a * (1 + e)))
    proof = prove_speed(on_table_orbit(sine_table, (A, float(truth) * 1.003, 0.0), r), "fold")
    assert holds(proof.omega, truth)
    assert abs(ball(proof.impacts[0].before)[0] + 2 * mpmath.pi * g / (truth * (1 + e))) < 1e-24


def test_all_lengths_and_loads_of_the_same_proportions_have_the_same_speed(orbit):
    # m, k and g0 scaled together change nothing but the forces
    other = scenes.cam_follower(rpm=739.0, m=2.442, k=2861.6)
    proofs = [prove_speed(periodic_orbit(scene, orbit.x[0]), "flip") for scene in (cam(739.0), other)]
    assert abs(ball(proofs[0].rpm)[0] - ball(proofs[1].rpm)[0]) < 1e-25


def test_an_obstacle_without_corners_has_no_corner_impact():
    with pytest.raises(NotProved, match="no corners"):
        prove_speed(on_table_orbit(sine_table), "corner")


def test_the_speed_of_a_table_that_the_user_wrote_cannot_be_varied():
    with pytest.raises(NotProved, match="callback"):
        prove_speed(on_table_orbit(sine), "flip")


def masses(omega):
    scene = two_masses()
    force = Harmonic(cosine=scene.system.force.cosine, omega=omega)
    return replace(scene, system=replace(scene.system, force=force), period=2.0 * math.pi / omega)


@pytest.mark.slow
def test_the_flip_of_two_masses_is_where_a_multiplier_passes_minus_one():
    orbit = attracting(masses(1.95))
    flip = float(ball(prove_speed(orbit, "flip").omega)[0])
    assert flip == pytest.approx(1.98183937222, abs=1e-10)  # by continuation
    beside = [periodic_orbit(masses(flip + d), orbit.x[0]).multipliers[0].real for d in (-1e-6, 1e-6)]
    assert beside[0] > -1.0 > beside[1]
