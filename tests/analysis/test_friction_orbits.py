"""Orbits that stick and slip: multipliers against closed forms, differences, each other; dead-beat ones are zero."""

import numpy as np
import pytest

from lagrangian import scenes
from lagrangian.scenes.belts import shaken_multipliers, stick_slip_period
from lcpstep import EventDriven
from lcpstep.analysis.fixed_points import periodic_point
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.cli import main
from lcpstep.errors import UnknownName
from lcpstep.maps import EventMap, NoReturn, StroboscopicMap, iterate

SWAYING = {"amplitude": 0.5, "omega": 0.9, "mu": 0.3}


def near(found, expected, within):
    """Whether two sets of complex numbers are the same."""
    return np.max(np.abs(np.sort_complex(found) - np.sort_complex(np.asarray(expected)))) < within


@pytest.mark.parametrize(("mu", "amplitude", "omega"), [(0.1, 1.0, 1.5), (0.05, 1.0, 0.8), (0.2, 3.0, 2.5)])
def test_den_hartogs_orbit_is_found_with_its_multipliers_in_closed_form(mu, amplitude, omega):
    scene = scenes.mass_on_shaken_belt(mu, amplitude, omega)
    share = 0.13
    start = np.concatenate([part[0] for part in scene.exact(np.array([share * scene.period]))])
    orbit = periodic_orbit(scene, start + np.array([1e-2, 0.0, -1e-2, 0.0]), phase=share)
    assert np.max(np.abs(orbit.x[0] - start)) < 1e-10
    assert near(orbit.multipliers, [*shaken_multipliers(mu, amplitude, omega), 0.0, 0.0], 1e-10)


def test_an_orbit_that_is_taken_along_has_one_multiplier_and_dead_beat_ones():
    scene = scenes.mass_on_belt(**SWAYING)
    orbit = periodic_orbit(scene, [0.3, 0.0, 0.1, 0.0])
    assert orbit.residual < 1e-11
    assert orbit.name == "O(1, 0)"
    assert np.max(np.abs(orbit.multipliers[1:])) < 1e-14
    P, d = StroboscopicMap(scene, EventDriven()), 1e-4
    ends = [P(orbit.x[0] + [k * d, 0.0, 0.0, 0.0])[[0, 2]] for k in (1, -1, 2, -2)]
    slope = (8.0 * (ends[0] - ends[1]) - ends[2] + ends[3]) / (12.0 * d)
    other = [P(orbit.x[0] + [0.0, 0.0, k * d, 0.0])[[0, 2]] for k in (1, -1, 2, -2)]
    J = np.stack([slope, (8.0 * (other[0] - other[1]) - other[2] + other[3]) / (12.0 * d)], axis=1)
    assert abs(np.linalg.det(J)) < 1e-8
    assert np.trace(J) == pytest.approx(orbit.multipliers[0].real, abs=1e-7)


def test_the_map_from_slip_to_slip_has_the_same_multiplier_and_its_derivative_is_that_of_differences():
    scene = scenes.mass_on_belt(**SWAYING)
    P = EventMap(scene, EventDriven(), "slip".upper())
    found = periodic_point(P, iterate(P, P.entry(), 10)[-1])
    x = found.points[0]
    assert P.duration(x) == pytest.approx(scene.period, abs=1e-10)
    orbit = periodic_orbit(scene, [0.3, 0.0, 0.1, 0.0])
    assert found.multipliers[0].real == pytest.approx(orbit.multipliers[0].real, abs=1e-9)
    assert np.max(np.abs(found.multipliers[1:])) < 1e-13

    def belt(phase):
        return 0.2 - 0.5 * 0.9 * np.sin(phase)

    def moved(k, d):  # neighbours that the belt takes along: the mass is as fast as it is
        return np.array([x[0] + k * d[0], x[1] + k * d[1], 0.0, belt(x[0] + k * d[0]), 0.0])

    J, step = P.jacobian(x), 1e-4
    for d in (np.array([step, step]), np.array([0.0, step])):  # outside of the cone: they slip at once
        u = np.array([d[0], d[1], 0.0, -0.45 * np.cos(x[0]) * d[0], 0.0])
        one, two = (P(moved(k, d)) - x for k in (1.0, 2.0))
        assert np.max(np.abs((4.0 * one - two) / 2.0 - J @ u)) < 1e-3 * step


@pytest.mark.parametrize("kind", ["SLIP", "STICK_TANGENT"])
def test_the_stick_slip_orbit_is_dead_beat_and_has_its_period(kind):
    for belt, mu, mu_s in ((0.2, 0.6, 1.0), (0.5, 0.3, 0.4)):
        P = EventMap(scenes.stick_slip_belt(belt, mu, mu_s), EventDriven(), kind)
        found = periodic_point(P, P.entry())
        assert abs(P.duration(found.points[0]) - stick_slip_period(belt, mu, mu_s)) < 1e-11
        assert np.max(np.abs(found.multipliers)) < 1e-10


@pytest.mark.slow
def test_the_woodpecker_has_a_stable_orbit_whatever_the_tolerance():
    found = []
    for tolerance in (1e-9, 1e-12):
        scene = scenes.woodpecker(t_end=0.3)
        P = EventMap(scene, EventDriven(tolerance, tolerance), "IMPACT", contact=0, cyclic=(0,))
        point = periodic_point(P, iterate(P, P.entry(), 3)[-1])
        found.append((P.duration(point.points[0]), point, P))
    (period, coarse, _), (finer, fine, P) = found
    assert abs(period - finer) < 1e-8
    assert finer == pytest.approx(0.1459760651, abs=2e-10)
    assert fine.multipliers[0].real == pytest.approx(-0.839155654, abs=1e-8)
    assert coarse.multipliers[0].real == pytest.approx(-0.839155654, abs=1e-5)
    assert np.max(np.abs(fine.multipliers[1:])) < 1e-9
    assert P.advance(fine.points[0])[0] < 0.0  # it goes down
    x, J, d = fine.points[0], P.jacobian(fine.points[0]), 1e-6
    for u in np.eye(5)[[0, 2, 3, 4]]:  # the second coordinate is on the surface of the pole
        slope = (8.0 * (P(x + d * u) - P(x - d * u)) - P(x + 2 * d * u) + P(x - 2 * d * u)) / (12.0 * d)
        assert np.max(np.abs(slope - J @ u)) < 1e-5


@pytest.mark.slow
def test_an_orbit_is_followed_over_the_speed_of_the_belt():
    def make(belt):
        return scenes.mass_on_belt(belt=belt, **SWAYING)

    orbit = periodic_orbit(make(0.1), [0.3, 0.0, 0.1, 0.0])
    branch = continue_orbit(make, orbit, 0.1, (0.05, 0.15))
    assert abs(branch.points.p[-1] - 0.15) < 1e-12
    assert all(o.residual < 1e-10 for o in branch.orbits)


def test_what_is_no_event_of_the_scene_is_named():
    scene = scenes.coulomb_oscillator()
    with pytest.raises(UnknownName, match="kind of events"):
        EventMap(scene, EventDriven(), "SLIPS")
    with pytest.raises(ValueError, match="contact: expected one of 1"):
        EventMap(scene, EventDriven(), "SLIP", contact=1)
    with pytest.raises(ValueError, match="cyclic: expected coordinates below 2"):
        EventMap(scene, EventDriven(), "SLIP", cyclic=(2,))
    with pytest.raises(NoReturn, match="no SLIP of contact 0 within"):
        EventMap(scene, EventDriven(), "SLIP", limit=30.0).entry()


@pytest.mark.slow
def test_the_commands_take_scenes_with_friction(tmp_path, capsys):
    assert main(["orbit", "woodpecker", "--event", "impact", "--cyclic", "0", "--transient", "3"]) == 0
    said = capsys.readouterr().out
    assert "period 0.14597606" in said
    assert "coordinates left out move on by [-0.019" in said
    swaying = [f"{name}={value}" for name, value in SWAYING.items()]
    out = ["--out", str(tmp_path), "--set", *swaying]
    assert main(["orbit", "mass-on-belt", "--transient", "20", *out]) == 0
    assert "O(1, 0), stable" in capsys.readouterr().out
    few = ["--starts", "3", "--transient", "20", "--window", "20", "--longest", "5", "--points", "10"]
    assert main(["attractor", "mass-on-belt", "--box", "-1", "1", "-1", "1", *few, *out]) == 0
    assert "O(1, 0)" in capsys.readouterr().out
    few = ["--parameter", "belt", "--range", "0", "0.4", "--points", "3", "--drop", "5", "--keep", "4"]
    random = ["--start", "random", "--runs", "2", "--box", "-1", "1", "-1", "1"]
    assert main(["bifurcation", "mass-on-belt", *few, *random, *out]) == 0
    assert "0 runs ended early" in capsys.readouterr().out
