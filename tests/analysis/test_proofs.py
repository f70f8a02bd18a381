"""Proved orbits against closed forms; what is disturbed, touched or of another kind is refused by name."""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, scenes
from lagrangian.profiles import rotating_cam
from lagrangian.scenes.cam_follower import PROFILE
from lagrangian.scenes.table import sine_table
from lcpstep import EventDriven
from lcpstep.analysis import prove
from lcpstep.analysis.orbits import moved, periodic_orbit
from lcpstep.analysis.proofs import NotProved
from lcpstep.maps import StroboscopicMap, iterate
from tests.analysis.proved import (
    attracting,
    ball,
    holds,
    on_table_orbit,
    settled,
    sine,
    two_masses,
    two_walls,
)


@pytest.fixture(autouse=True)
def _digits():
    with mpmath.workdps(50):
        yield


@pytest.fixture(scope="module")
def cam_orbit():
    return periodic_orbit(scenes.cam_follower(rpm=700.0), [1.33, -66.2])


def table_truth(A, w, r, g):
    """Phase and velocities of the impact once a period, and the moduli of its multipliers, in 50 digits."""
    A, w, r, g = map(mpmath.mpf, (A, w, r, g))
    phase = mpmath.acos(mpmath.pi * g * (1 - r) / (A * w**2 * (1 + r)))
    before = -2 * mpmath.pi * g / (w * (1 + r))
    trace = 1 + r**2 - (1 + r) ** 2 * A * w**2 * mpmath.sin(phase) / g
    moduli = [abs(z) for z in mpmath.polyroots([1, -trace, r**2], maxsteps=200, extraprec=200)]
    return phase / w, before, sorted(moduli, reverse=True)


@pytest.mark.parametrize(
    ("A", "w", "r"), [(0.01, 35.0, 0.5), (0.0123, 33.0, 0.61), (0.02, 30.0, 0.37), (0.01, 38.0, 0.5)]
)
def test_a_ball_on_a_table_has_its_orbit_in_closed_form(A, w, r):
    time, before, moduli = table_truth(A, w, r, 9.81)
    proof = prove(on_table_orbit(sine_table, (A, w, 0.0), r))
    (impact,) = proof.impacts
    turned = time + 2 * mpmath.pi / mpmath.mpf(w)  # the section is at half a period
    assert holds(impact.time, turned)
    assert holds(impact.before, before)
    assert holds(impact.after, -mpmath.mpf(r) * before)
    assert all(holds(m, truth) for m, truth in zip(proof.multipliers, moduli, strict=True))
    assert proof.stability == ("stable" if moduli[0] < 1 else "unstable")
    assert holds(proof.period, 2 * mpmath.pi / mpmath.mpf(w))


@pytest.mark.parametrize("beyond", [1e-2, 1e-4, 1e-6, 1e-8])
def test_the_neighbourhood_of_the_only_orbit_leaves_out_the_other_one_beyond_a_fold(beyond):
    A, r, g = 0.01, 0.5, 9.81
    w = math.sqrt(math.pi * g * (1.0 - r) / (A * (1.0 + r))) * (1.0 + beyond)
    proof = prove(on_table_orbit(sine_table, (A, w, 0.0), r))
    phase = math.acos(min(1.0, math.pi * g * (1.0 - r) / (A * w**2 * (1.0 + r))))
    apart = (
        2.0 * phase / w,
        2.0 * A * math.sin(phase),
    )  # the other strikes as long before the table's quickest
    assert proof.unique.time < apart[0] or proof.unique.position < apart[1]
    assert proof.unique.time > 1e-3 * apart[0]


def oscillator_truth(orbit, zeta, w, a, stop, r):
    """Time and velocity of the impact of a damped oscillator that strikes once a period, by its closed form."""
    zeta, w, a, stop, r = map(mpmath.mpf, (zeta, w, a, stop, r))
    amplitude = a / (1 - w**2 + 2j * zeta * w)
    turn, decay = mpmath.sqrt(1 - zeta**2), 2 * mpmath.pi / w

    def free(t):
        z = amplitude * mpmath.expjpi(w * t / mpmath.pi)
        return z.real, (1j * w * z).real

    def equations(t, v):
        x, y = free(t)[0], free(t)[1]
        c, d = stop - x, v - y  # what swings freely, just after
        e = (d + zeta * c) / turn
        s, co, f = mpmath.sin(turn * decay), mpmath.cos(turn * decay), mpmath.exp(-zeta * decay)
        position = f * (c * co + e * s) + x
        speed = f * (-zeta * (c * co + e * s) + turn * (-c * s + e * co)) + y
        return position - stop, v + r * speed

    found = mpmath.findroot(equations, (mpmath.mpf(orbit.time[0]), -mpmath.mpf(orbit.after[0])))
    return found[0], found[1] / r


@pytest.mark.parametrize(
    ("zeta", "w", "a", "stop", "r"),
    [(0.05, 2.0, 1.0, 0.0, 0.8), (0.05, 2.8, 1.0, 0.0, 0.8), (0.11, 1.9, 0.7, 0.05, 0.55), (0.0, 2.1, 1.0, -0.1, 0.7),
     (0.03, 2.0, 1.0, 0.0, 1.0)],
)  # fmt: skip
def test_a_driven_impact_oscillator_has_its_orbit_in_closed_form(zeta, w, a, stop, r):
    orbit = attracting(scenes.impact_oscillator(zeta, w, a, stop, r))
    time, before = oscillator_truth(orbit, zeta, w, a, stop, r)
    proof = prove(orbit)
    assert proof.name == "O(1, 1)"
    assert holds(proof.impacts[0].time, time)
    assert holds(proof.impacts[0].before, before)
    product = mpmath.mpf(r) ** 2 * mpmath.exp(-4 * mpmath.pi * mpmath.mpf(zeta) / mpmath.mpf(w))
    assert abs(ball(proof.multipliers[0])[0] * ball(proof.multipliers[1])[0] - product) < 1e-25


def test_more_bits_give_more_digits_and_fewer_give_the_same_orbit(cam_orbit):
    wide, narrow = prove(cam_orbit, bits=64), prove(cam_orbit, bits=256)
    assert ball(wide.impacts[0].time)[1] > 1e-22
    assert wide.impacts[0].time.lower <= ball(narrow.impacts[0].time)[0] <= wide.impacts[0].time.upper
    assert ball(narrow.impacts[0].time)[1] < 1e-65
    assert wide.stability == narrow.stability == "stable"


@pytest.mark.parametrize("bits", [0, 53, math.nan, "many", 2**40])
def test_a_precision_that_is_none_is_refused(cam_orbit, bits):
    with pytest.raises(ValueError, match=r"^bits: "):
        prove(cam_orbit, bits=bits)


def test_the_cam_follower_at_700_rpm_is_proved_in_both_coordinates(cam_orbit):
    proof = prove(cam_orbit)
    absolute = scenes.cam_follower(rpm=700.0, coordinates="absolute")
    other = prove(periodic_orbit(absolute, cam_orbit.x[0] + absolute.x0 - scenes.cam_follower(rpm=700.0).x0))
    assert proof.name == "O(1, 1)"
    assert proof.stability == "stable"
    for name in ("time", "before", "after"):
        mine, its = (getattr(p.impacts[0], name) for p in (proof, other))
        assert abs(ball(mine)[0] - ball(its)[0]) < 1e-25
    assert holds(proof.multipliers[0], mpmath.mpf(0.8))  # without damping the product is r^2, a complex pair
    assert 1e-6 < proof.unique.time < 1e-2
    lines = str(proof)
    assert "exists" in lines
    assert "touches nothing" in lines


def test_the_section_does_not_matter(cam_orbit):
    proofs = [prove(moved(cam_orbit, phase)) for phase in (0.1, 0.45, 0.9)]
    reference = prove(cam_orbit)
    for proof in proofs:
        turns = (ball(proof.impacts[0].time)[0] - ball(reference.impacts[0].time)[0]) / ball(proof.period)[0]
        assert abs(turns - mpmath.nint(turns)) < 1e-24
        assert abs(ball(proof.impacts[0].before)[0] - ball(reference.impacts[0].before)[0]) < 1e-24


@pytest.mark.slow
def test_an_orbit_of_two_periods_is_proved_and_one_that_repeats_earlier_is_not(cam_orbit):
    start = iterate(StroboscopicMap(scenes.cam_follower(rpm=739.35), EventDriven()), [0.8, -74.0], 1000)[-1]
    orbit = periodic_orbit(scenes.cam_follower(rpm=739.35), start, 2)
    proof = prove(orbit)
    assert (proof.name, proof.stability) == ("O(2, 2)", "stable")
    assert [float(ball(m)[0]) for m in proof.multipliers] == pytest.approx(
        np.abs(orbit.multipliers), rel=1e-7
    )
    states = np.array([[float(ball(x)[0]) for x in row] for row in proof.x])
    assert states == pytest.approx(orbit.x, rel=1e-9)
    with pytest.raises(NotProved, match="the orbit given is none"):
        prove(replace(orbit, x=orbit.x * [[1.0], [1.001]]))
    twice = periodic_orbit(cam_orbit.scene, cam_orbit.x[0], 2)
    with pytest.raises(NotProved, match="repeats after 1"):
        prove(twice)


@pytest.mark.slow
def test_the_orbit_of_eight_impacts_at_358_rpm_is_proved():
    orbit = attracting(scenes.cam_follower(rpm=358.0), 3)
    proof = prove(orbit)
    assert (proof.name, proof.stability, len(proof.impacts)) == ("O(3, 8)", "stable", 8)
    found = [float(ball(m)[0]) for m in proof.multipliers]
    assert found == pytest.approx(np.abs(orbit.multipliers), rel=1e-6)


def turning(omega, lead, turns=1, force=None):
    """A follower on the cam, turning either way, in a period of some turns."""
    one = 2.0 * math.pi / abs(omega)
    corners = np.sort(((PROFILE.corners() - lead) / omega) % one)
    return Scene(
        LinearSystem(M=1.221, C=2.0, K=1430.8, frame=rotating_cam, force=force), q0=0.5, v0=0.0, t_span=(0.0, 1.0),
        contacts=LinearContacts(1.0, restitution=0.8), p=PROFILE.pack(omega, lead), period=turns * one,
        corners=np.concatenate([corners + k * one for k in range(turns)]), name="turning",
    )  # fmt: skip


@pytest.mark.slow
def test_a_symmetric_cam_that_turns_back_gives_the_same_orbit_and_so_does_a_longer_period():
    w = 24.0 * math.pi
    proofs = [prove(attracting(turning(*case))) for case in ((w, 0.3), (-w, 0.3), (-w, -2.0), (w, 0.3, 2))]
    assert [proof.name for proof in proofs] == ["O(1, 1)"] * 3 + ["O(1, 2)"]
    speeds = [ball(impact.before)[0] for proof in proofs for impact in proof.impacts]
    assert max(speeds) - min(speeds) < 1e-25


def test_a_force_and_a_cam_of_two_frequencies_are_taken_together():
    w = 24.0 * math.pi
    force = Harmonic(constant=-3.0, cosine=5.0, sine=20.0, omega=2.0 * w)
    orbit = attracting(turning(-w, 0.3, force=force))
    proof = prove(orbit)
    assert float(ball(proof.multipliers[0])[0]) == pytest.approx(abs(orbit.multipliers[0]), rel=1e-7)


def test_a_frame_that_the_user_wrote_moves_as_the_obstacle_does():
    orbit = on_table_orbit(sine)
    scene = replace(
        orbit.scene,
        system=LinearSystem(M=1.0, force=-9.81, frame=sine),
        contacts=LinearContacts(1.0, restitution=0.5),
    )
    A, w, _ = scene.p
    half = math.pi  # of the table's turn, where the section is
    start = orbit.x[0] - [A * math.sin(half), A * w * math.cos(half)]
    relative = prove(periodic_orbit(scene, start, phase=0.5))
    assert abs(ball(relative.impacts[0].before)[0] - ball(prove(orbit).impacts[0].before)[0]) < 1e-25


def test_the_steady_motion_of_an_oscillator_that_strikes_nothing_is_proved():
    zeta, w, a = mpmath.mpf(2.0 * 0.2) / 2, mpmath.mpf(1.7), mpmath.mpf(0.9)
    amplitude = a / (1 - w**2 + 2j * zeta * w)
    size = float(abs(amplitude))
    scene = scenes.impact_oscillator(0.2, 1.7, 0.9, stop=size * (1.0 + 1e-9), q0=0.0)
    orbit = periodic_orbit(scene, [float(amplitude.real), float((1j * w * amplitude).real)])
    proof = prove(orbit)
    assert (proof.name, proof.stability, proof.impacts) == ("O(1, 0)", "stable", ())
    assert holds(proof.x[0][0], amplitude.real)
    assert holds(proof.x[0][1], (1j * w * amplitude).real)
    assert holds(proof.multipliers[0], mpmath.exp(-2 * mpmath.pi * zeta / w))
    assert "no other without impacts" in str(proof)
    for stop in (size * (1.0 - 1e-9), 0.5 * size):
        lower = scenes.impact_oscillator(0.2, 1.7, 0.9, stop=stop, q0=-1.0)
        with pytest.raises(NotProved, match="passes through contact 0"):
            prove(replace(orbit, scene=lower))
    with pytest.raises(NotProved, match="repeats after 1"):
        prove(periodic_orbit(scene, orbit.x[0], 2))


def test_an_elastic_orbit_without_damping_is_neither_stable_nor_unstable():
    proof = prove(elastic())
    assert proof.stability == "not decided"
    assert all(abs(ball(m)[0] - 1) < 1e-20 for m in proof.multipliers)


def elastic():
    """An oscillator that loses nothing, at a stop that it strikes once a turn of the force."""
    scene = scenes.impact_oscillator(zeta=0.0, omega=2.3, restitution=1.0)
    # x = A cos(2.3 t) + B cos t is even, and at zero after half a turn, where its velocity is turned round
    A = 1.0 / (1.0 - 2.3**2)
    half = 0.5 * scene.period
    B = A / math.cos(half)
    return periodic_orbit(scene, [A + B, 0.0])


def test_an_orbit_between_two_walls_is_proved_and_is_as_symmetric_as_they_are():
    proof = prove(settled(two_walls()))
    assert [impact.contact for impact in proof.impacts] == [1, 0, 0, 1]
    for early, late in zip(proof.impacts[:2], proof.impacts[2:], strict=True):
        assert abs(ball(late.time)[0] - ball(early.time)[0] - ball(proof.period)[0] / 2) < 1e-25
        assert abs(ball(late.before)[0] - ball(early.before)[0]) < 1e-25


def test_an_orbit_of_two_masses_is_proved_with_the_multipliers_of_the_variations():
    orbit = attracting(two_masses())
    proof = prove(orbit)
    known = sorted(np.abs(orbit.multipliers), reverse=True)
    assert [float(ball(m)[0]) for m in proof.multipliers] == pytest.approx(known, rel=1e-7)
    trace = mpmath.mpf(0.2) + mpmath.mpf(0.1) / mpmath.mpf(0.5)  # of M^-1 C
    product = mpmath.mpf(0.6) ** 2 * mpmath.exp(-trace * 2 * mpmath.pi / mpmath.mpf(1.3))
    assert abs(mpmath.fprod(ball(m)[0] for m in proof.multipliers) - product) < 1e-24


def swinging(t, q, v, p, out):
    """A table of two harmonics, as a user writes it."""
    a, b = p[1] * t, 2.0 * p[1] * t
    out[0, 0] = p[0] * (math.sin(a) + 0.1 * math.cos(b))
    out[0, 1] = p[0] * p[1] * (math.cos(a) - 0.2 * math.sin(b))
    out[0, 2] = -p[0] * p[1] ** 2 * (math.sin(a) + 0.4 * math.cos(b))


def test_a_table_that_the_user_wrote_gives_the_orbit_of_the_one_that_is_known():
    known, mine = (prove(on_table_orbit(f)) for f in (sine_table, sine))
    assert abs(ball(known.impacts[0].time)[0] - ball(mine.impacts[0].time)[0]) < 1e-15  # 2 pi/35 is rounded
    assert abs(ball(known.multipliers[0])[0] - ball(mine.multipliers[0])[0]) < 1e-12
    orbit = on_table_orbit(swinging)
    moduli = [float(ball(m)[0]) for m in prove(orbit).multipliers]
    assert moduli == pytest.approx(np.abs(orbit.multipliers), rel=1e-7)
