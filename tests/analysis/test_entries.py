"""Maps from one entry into a mode to the next, and what maps of systems with modes refuse by name."""

import math

import numpy as np
import pytest

from lagrangian import Guard, HybridScene, HybridSystem, Mode, scenes
from lcpstep import EventDriven, LcpStepError, Moreau
from lcpstep.analysis.abs_cycle import limit_cycle
from lcpstep.analysis.derivative import differences
from lcpstep.analysis.fixed_points import periodic_point
from lcpstep.analysis.orbits import periodic_orbit
from lcpstep.errors import UnknownName
from lcpstep.maps import ImpactMap, NoReturn, StroboscopicMap, SwitchMap, iterate, periods

METHOD = EventDriven()


# --- what bad input gets


def test_a_scene_without_a_period_is_named():
    for scene, hint in (
        (scenes.stick_slip_oscillator(), "amplitude is not zero"),
        (scenes.hybrid_abs(), "no period"),
    ):
        with pytest.raises(ValueError, match=f"{scene.name}.*{hint}"):
            StroboscopicMap(scene, METHOD)
        with pytest.raises(ValueError, match=f"{scene.name}.*{hint}"):
            periods(scene, METHOD, [[0.0, 0.0]], 1)


def rise(t, x, p, out):
    out[0] = 1.0


def fall(t, x, p, out):
    out[0] = -1.0


def high(t, x, p, out):
    out[0] = x[0] - 1.0


def low(t, x, p, out):
    out[0] = -1.0 - x[0]


def test_a_state_that_does_not_tell_its_mode_is_refused():
    relay = HybridSystem(1, {"on": Mode(rise, [Guard(high, "off")]), "off": Mode(fall, [Guard(low, "on")])})
    scene = HybridScene(relay, [0.0], "on", (0.0, 10.0), period=1.0, name="relay")
    with pytest.raises(LcpStepError, match=r"'relay' does not tell its mode.*mode_of"):
        StroboscopicMap(scene, METHOD)([0.0])


def test_mode_of_must_name_a_mode():
    modes = {"on": Mode(rise), "off": Mode(fall)}
    with pytest.raises(ValueError, match=r"mode_of: expected one of on, off at .* got 'of'"):
        HybridScene(HybridSystem(1, modes, mode_of=lambda t, x, p: "of"), [0.0], "on", (0.0, 1.0))
    with pytest.raises(ValueError, match="mode_of: expected a function"):
        HybridSystem(1, modes, mode_of="on")


def test_labels_are_one_for_each_state():
    with pytest.raises(ValueError, match="labels: expected 1 names of states"):
        HybridScene(HybridSystem(1, {"on": Mode(rise)}), [0.0], "on", (0.0, 1.0), labels=("a", "b"))


def test_time_stepping_of_modes_is_refused_by_name():
    scene = scenes.driven_bilinear_oscillator()
    with pytest.raises(LcpStepError, match=r"a system with modes is run by lcpstep\.EventDriven"):
        periods(scene, Moreau(1e-3), [[0.0, 0.0]], 1)


# --- from one entry into a mode to the next


@pytest.mark.parametrize(
    ("belt", "static", "kinetic"), [(0.2, 1.0, 0.6), (0.05, 1.3, 0.4), (1.1, 2.0, 1.9), (0.7, 0.8, 0.1)]
)
def test_the_block_on_a_belt_has_its_period_and_multiplier_zero(belt, static, kinetic):
    P = SwitchMap(scenes.stick_slip_oscillator(belt, static, kinetic), METHOD, "stick")
    found = periodic_point(P, P.entry())
    a = static - kinetic
    assert P.duration(found.points[0]) == pytest.approx(
        2.0 * a / belt + math.pi + 2.0 * math.atan(belt / a), abs=1e-10
    )
    assert found.points[0] == pytest.approx([2.0 * kinetic - static, belt], abs=1e-10)
    assert np.max(np.abs(found.multipliers)) < 1e-9
    other = SwitchMap(scenes.stick_slip_oscillator(belt, static, kinetic), METHOD, "slower")
    assert other.duration(other.entry()) == pytest.approx(P.duration(P.entry()), abs=1e-10)


def test_the_cycle_of_the_controller_is_dead_beat_on_every_section():
    scene = scenes.hybrid_abs()
    cycle = limit_cycle(scene)
    for mode in "0123":
        P = SwitchMap(scene, METHOD, mode)
        found = periodic_point(P, iterate(P, P.entry(), 3)[-1])
        assert P.duration(found.points[0]) == pytest.approx(cycle.period, rel=1e-9)
        assert np.max(np.abs(found.multipliers)) < 1e-6


def test_the_derivative_of_the_map_between_entries_is_that_of_its_differences():
    free = SwitchMap(scenes.bilinear_oscillator(damping=0.2, x0=-0.5), METHOD, "right")
    driven = SwitchMap(scenes.driven_bilinear_oscillator(), METHOD, "right")
    for P, x in ((free, [0.0, 0.7]), (driven, [1.0, 0.0, 0.8])):
        found, expected = P.jacobian(x), differences(P, x)
        # A start beside x = 0 is not on the section; along it both must agree
        along = [k for k in range(len(x)) if k != len(x) - 2]
        np.testing.assert_allclose(found[:, along], expected[:, along], atol=1e-8)


def test_the_orbit_between_entries_is_that_of_the_stroboscopic_map():
    scene = scenes.driven_bilinear_oscillator()
    orbit = periodic_orbit(scene, StroboscopicMap(scene, METHOD).follow([0.0, 0.0], 300).final[0], 3)
    P = SwitchMap(scene, METHOD, "right")
    start = next(s for s in orbit.run().switches if s.target == "right")
    x = np.append(2.0 * math.pi * (start.time / scene.period % 1.0), start.after)
    n = int(np.sum(orbit.run().switches.target == "right"))
    found = periodic_point(P, x, n)
    assert sum(P.duration(y) for y in found.points) == pytest.approx(3.0 * scene.period, abs=1e-9)
    seen = sorted(found.multipliers, key=abs, reverse=True)[:2]
    assert np.sort_complex(seen) == pytest.approx(np.sort_complex(orbit.multipliers), abs=1e-7)


def test_maps_between_events_name_what_they_cannot_take():
    with pytest.raises(UnknownName, match="did you mean 'stick'"):
        SwitchMap(scenes.stick_slip_oscillator(), METHOD, "stik")
    with pytest.raises(ValueError, match="for a scene with contacts see ImpactMap"):
        SwitchMap(scenes.bouncing_ball(), METHOD, "up")
    with pytest.raises(ValueError, match="for one with modes see SwitchMap"):
        ImpactMap(scenes.driven_bilinear_oscillator(), METHOD)
    with pytest.raises(NoReturn, match="no entry into mode 'right' within 3 s"):
        SwitchMap(scenes.bilinear_oscillator(left=0.01), METHOD, "right", limit=3.0)([0.0, 0.1])
