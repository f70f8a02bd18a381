"""Cam profiles: the derivatives of the lift, what happens at corners, and chains that do not close."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import mpf

from lagrangian import Arc, CamProfile, scenes
from lagrangian.profiles import rotating_cam
from lagrangian.scenes.cam_follower import PROFILE
from tests.differences import derivative, second_derivative
from tests.exact import cam_lift

CORNERS = PROFILE.corners()
MIDDLES = [
    (a + b) / 2 for a, b in zip(CORNERS, np.append(CORNERS[1:], CORNERS[0] + 2 * math.pi), strict=True)
]
ANGLES = np.array([m % (2 * math.pi) for m in MIDDLES])
angles = st.floats(0.0, 2 * math.pi, exclude_max=True).filter(lambda b: np.min(np.abs(CORNERS - b)) > 1e-9)
ONE_SIDED = 1e-12  # how far off a corner its two sides are looked at [rad]


def arc_at(beta):
    """The arc that the angle lies on."""
    folded = beta if beta <= math.pi else 2 * math.pi - beta
    return next(arc for arc in PROFILE.arcs if folded <= arc.end)


@given(angles)
def test_lift_and_derivatives_agree_with_the_formulas_in_fifty_digits(beta):
    exact = [float(x) for x in cam_lift(mpf(beta), mpf(beta))]
    # c'' of the nose divides by root^3, root = 0.15: its rounding is some ten units of the last place
    np.testing.assert_allclose(PROFILE.lift(beta), exact, rtol=0, atol=2e-14)


@pytest.mark.parametrize("beta", ANGLES)
def test_derivatives_agree_with_differences(beta):
    step = 2e-3  # the narrowest arc bends within 0.1 rad: truncation (step/0.1)^8 = 3e-14
    _, dc, ddc = PROFILE.lift(beta)
    assert dc == pytest.approx(derivative(lambda b: PROFILE.lift(b)[0], beta, step), abs=1e-12)
    assert ddc == pytest.approx(derivative(lambda b: PROFILE.lift(b)[1], beta, step), abs=1e-11)
    assert ddc == pytest.approx(second_derivative(lambda b: PROFILE.lift(b)[0], beta, step), abs=1e-9)


@given(angles)
def test_every_arc_has_the_curvature_of_its_circle(beta):
    c, dc, ddc = PROFILE.lift(beta)
    r = c + PROFILE.offset
    curvature = (r * r + 2 * dc * dc - r * ddc) / (r * r + dc * dc) ** 1.5
    assert curvature == pytest.approx(1.0 / arc_at(beta).rho, rel=1e-13)


def test_the_cam_has_six_corners_symmetric_about_its_nose():
    assert len(CORNERS) == 6
    np.testing.assert_allclose(CORNERS + CORNERS[::-1], 2 * math.pi, rtol=1e-15)
    np.testing.assert_allclose(
        CORNERS[:3],
        [math.pi / 2, math.pi / 2 + 1.050328174371336, math.pi / 2 + 1.22173047639603],
        rtol=1e-15,
    )


@pytest.mark.parametrize("corner", CORNERS)
def test_lift_and_slope_are_continuous_at_corners_and_the_curvature_jumps(corner):
    before, after = PROFILE.lift(corner - ONE_SIDED), PROFILE.lift(corner + ONE_SIDED)
    # the published constants have 14 digits; c' < 0.5, |c''| < 5 on a distance of 2e-12
    np.testing.assert_allclose(after[:1], before[:1], rtol=0, atol=3e-14 + 2 * ONE_SIDED * 0.5)
    np.testing.assert_allclose(after[1:2], before[1:2], rtol=0, atol=1e-13 + 2 * ONE_SIDED * 5)
    inverse = [1.0 / arc_at(corner + side * ONE_SIDED).rho for side in (-1, 1)]
    r, dc = before[0] + PROFILE.offset, before[1]
    # the curvature of a polar curve is linear in r'': its jump gives that of c''
    jump = -(inverse[1] - inverse[0]) * (r * r + dc * dc) ** 1.5 / r
    assert after[2] - before[2] == pytest.approx(jump, rel=1e-10)
    assert abs(jump) > 0.1


@pytest.mark.parametrize("turning", [1.0, -1.0])
@pytest.mark.parametrize("corner", CORNERS[:3])
def test_on_a_corner_the_lift_is_that_of_the_arc_that_begins_there(corner, turning):
    out, nothing = np.zeros((2, 1, 3)), np.zeros(1)
    for t, at in ((0.0, out[0]), (ONE_SIDED, out[1])):
        rotating_cam(t, nothing, nothing, PROFILE.pack(turning, corner), at)
    np.testing.assert_allclose(out[0], out[1], rtol=0, atol=1e-10)


def test_the_first_arc_of_a_cam_without_symmetry_begins_at_zero():
    arcs = (Arc(math.pi, 0.1, math.pi / 2, 0.5), Arc(2 * math.pi, 0.05, math.pi / 2, math.sqrt(0.2425)))
    cam, nothing = CamProfile(arcs=arcs, symmetric=False), np.zeros(1)
    for turning, arc in ((1.0, arcs[0]), (-1.0, arcs[1])):
        out = np.zeros((1, 3))
        rotating_cam(0.0, nothing, nothing, cam.pack(turning, 0.0), out)
        root = math.sqrt(arc.rho**2 - arc.kappa**2)
        np.testing.assert_allclose(out[0], [root, turning * arc.kappa, arc.kappa**2 / root], rtol=1e-12)


def test_the_cam_is_pushed_up_from_the_very_start_of_the_lift():
    scene, out = scenes.cam_follower(rpm=358.0), np.zeros((1, 3))
    scene.system.frame(0.0, scene.q0, scene.v0, scene.p, out)
    _, _, ddc = cam_lift(mpf(math.pi / 2), mpf(math.pi / 2 + ONE_SIDED))
    assert out[0, 2] == pytest.approx(float(ddc) * (2 * math.pi * 358 / 60) ** 2, rel=1e-13)
    assert out[0, 2] == pytest.approx(297.6, abs=0.05)


@pytest.mark.parametrize("rpm", [60.0, 358.0])
@pytest.mark.parametrize("turns", [-2, 0, 1000])
def test_the_turning_cam_gives_time_derivatives(rpm, turns):
    omega = 2 * math.pi * rpm / 60
    p, out = PROFILE.pack(omega, math.pi / 2), np.zeros((1, 3))
    nothing = np.zeros(1)
    for beta in ANGLES:
        t = (beta - math.pi / 2 + 2 * math.pi * turns) / omega
        rotating_cam(t, nothing, nothing, p, out)
        c, dc, ddc = PROFILE.lift(beta)
        rounding = 8e-16 * 2 * math.pi * (abs(turns) + 1) * 5  # of the angle, times |c'''| < 5 .. 40
        np.testing.assert_allclose(
            out[0] / [1, omega, omega**2], [c, dc, ddc], rtol=0, atol=8 * rounding + 1e-13
        )


def test_a_cam_without_symmetry_uses_all_its_arcs():
    eccentric = CamProfile(arcs=(Arc(end=2 * math.pi, kappa=0.1, psi=0.3, rho=0.5),), symmetric=False)
    for beta in (0.2, 2.0, 4.0, 6.0):
        x, y = 0.1 * math.cos(beta - 0.3), 0.1 * math.sin(beta - 0.3)
        assert eccentric.lift(beta)[0] == pytest.approx(x + math.sqrt(0.25 - y * y), rel=1e-15)
        assert eccentric.lift(beta)[1] == pytest.approx(
            derivative(lambda b: eccentric.lift(b)[0], beta, 1e-2), abs=1e-12
        )


DWELL = Arc(end=math.pi, kappa=0.0, psi=0.0, rho=0.4)


@pytest.mark.parametrize(
    "arcs",
    [
        (),
        (Arc(end=3.0, kappa=0.0, psi=0.0, rho=0.4),),  # does not reach pi
        (Arc(end=2.0, kappa=0.0, psi=0.0, rho=0.4), Arc(end=1.0, kappa=0.0, psi=0.0, rho=0.4), DWELL),
        (Arc(end=0.0, kappa=0.0, psi=0.0, rho=0.4), DWELL),
        (Arc(end=1.0, kappa=0.0, psi=0.0, rho=0.5), DWELL),  # the lift jumps
        (Arc(end=math.nan, kappa=0.0, psi=0.0, rho=0.4), DWELL),
        (Arc(end=math.pi, kappa=math.nan, psi=0.0, rho=0.4),),
        (Arc(end=1.0, kappa=0.5, psi=0.0, rho=0.1), DWELL),  # the axis lies outside the circle
    ],
    ids=["none", "open", "unordered", "empty", "step", "nan end", "nan radius", "no intersection"],
)
def test_chains_that_are_no_cam_are_refused_by_name(arcs):
    with pytest.raises(ValueError, match=r"^arcs: "):
        CamProfile(arcs=arcs)


def test_the_cam_at_rest_is_refused_by_name():
    with pytest.raises(ValueError, match=r"^rpm: "):
        scenes.cam_follower(rpm=0.0)
    with pytest.raises(ValueError, match=r"^omega: "):
        PROFILE.pack(math.nan, 0.0)
