"""Systems with modes against closed forms: switching times, Filippov sliding, resets."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from lagrangian import Guard, Harmonic, HybridScene, HybridSystem, LinearSystem, Mode, Surface, scenes
from lcpstep import EventDriven, Moreau, Status, simulate
from tests.events.ramps import minus_one, moving_ramp, one, position

METHOD = EventDriven()
KNOWN = [
    pytest.param(scenes.bilinear_oscillator(left=4.0, right=0.5, x0=0.3, v0=-1.0), id="bilinear"),
    pytest.param(scenes.bilinear_oscillator(), id="bilinear-stiff"),
    pytest.param(scenes.dry_friction_oscillator(), id="dry-friction"),
    pytest.param(scenes.dry_friction_oscillator(x0=-0.75), id="dry-friction-other-side"),
    pytest.param(scenes.stick_slip_oscillator(), id="stick-slip"),
    pytest.param(scenes.stick_slip_oscillator(x0=-0.9, belt=0.7), id="stick-slip-fast"),
]


@pytest.mark.parametrize("scene", KNOWN)
def test_motions_known_in_closed_form(scene):
    run = simulate(scene, METHOD)
    assert run.status == Status.DONE
    t = np.linspace(*scene.t_span, 1501)
    np.testing.assert_allclose(run.at(t), scene.exact(t), rtol=0, atol=5e-11)


def test_sliding_is_entered_at_the_known_time_and_place_and_rests():
    run = simulate(scenes.dry_friction_oscillator(1.05, 0.1), METHOD)
    assert list(run.switches.target) == ["right", "left", "right", "left", "stick"]
    np.testing.assert_allclose(run.switches.time, math.pi * np.arange(1, 6), rtol=0, atol=2e-11)
    at_rest = run.at(np.linspace(5.0 * math.pi + 1e-9, 20.0, 50))
    assert np.all(at_rest[:, 1] == 0.0)
    np.testing.assert_allclose(at_rest[:, 0], -0.05, rtol=0, atol=1e-11)


@pytest.mark.parametrize("amplitude", [0.15, 0.3, 2.0])
def test_sliding_is_left_and_entered_again_where_the_closed_form_says(amplitude):
    drag, omega = 0.1, 0.5
    run = simulate(scenes.dry_friction_oscillator(0.0, drag, amplitude, omega, t_end=60.0), METHOD)
    leaves = math.asin(drag / amplitude) / omega  # F sin(omega t) = drag, from x = 0
    assert run.switches.time[0] == pytest.approx(leaves, abs=1e-12)
    # then x = -drag + F sin(omega t)/(1 - omega^2) + a cos t + b sin t, until x' = 0
    forced = amplitude / (1.0 - omega**2)

    def particular(t):
        return np.array([forced * math.sin(omega * t) - drag, forced * omega * math.cos(omega * t)])

    turn = np.array([[math.cos(leaves), math.sin(leaves)], [-math.sin(leaves), math.cos(leaves)]])
    a, b = np.linalg.solve(turn, np.array([0.0, 0.0]) - particular(leaves))
    stops = brentq(
        lambda t: particular(t)[1] - a * math.sin(t) + b * math.cos(t), leaves + 0.1, leaves + 6.0, xtol=1e-14
    )
    assert run.switches.time[1] == pytest.approx(stops, abs=1e-11)
    # every further stick ends where the force has grown to what friction holds
    for start, end in zip(run.switches[:-1], run.switches[1:], strict=True):
        if start.target == "stick":
            held = amplitude * math.sin(omega * end.time) - end.before[0]
            assert abs(held) == pytest.approx(drag, abs=1e-11)
            assert np.all(run.at(np.linspace(start.time, end.time, 9)[:-1])[:, 1] == 0.0)


def circle(t, x, p, out):
    out[0] = x[0] ** 2 + x[1] ** 2 - 1.0


def test_sliding_on_a_curved_surface_stays_on_it():
    def outwards(t, x, p, out):
        out[0], out[1] = x[0] - x[1], x[1] + x[0]

    def inwards(t, x, p, out):
        out[0], out[1] = -2.0 * x[0] - 3.0 * x[1], -2.0 * x[1] + 3.0 * x[0]

    system = HybridSystem(2, {"in": Mode(outwards), "out": Mode(inwards)}, [Surface(circle, "in", "out")])
    run = simulate(HybridScene(system, [0.5, 0.0], "in", (0.0, 5.0)), METHOD)
    entered = math.log(2.0)
    assert run.switches.time == pytest.approx([entered], abs=1e-12)
    # L1 = 2, L2 = -4: F_s turns with (4 * 1 + 2 * 3)/6
    t = np.linspace(entered, 5.0, 200)[1:]
    angle = entered + 5.0 / 3.0 * (t - entered)
    np.testing.assert_allclose(
        run.at(t), np.stack([np.cos(angle), np.sin(angle)], axis=1), rtol=0, atol=1e-11
    )


def narrow_bump(t, x, p, out):
    y = p[1] * (x[0] - p[2])
    out[0] = p[0] - y * y * (1.0 + 0.1 * math.tanh(p[3] * y))


@settings(max_examples=60, deadline=None)
@example(depth=-9.0, rate=3.0, place=2.90341288222328, tilt=-1.5)
@given(st.floats(-9.0, -3.0), st.floats(0.3, 3.0), st.floats(0.2, 3.0), st.floats(-2.0, 2.0))
def test_a_pair_of_roots_inside_one_step_is_not_missed(depth, rate, place, tilt):
    """A guard that rises above zero for a moment only; the motion itself takes steps of any length."""
    d = 10.0**depth
    scene = moving_ramp(
        {"a": Mode(one, [Guard(narrow_bump, "b")]), "b": Mode(minus_one)},
        x0=0.0,
        p=[d, rate, 3.0 * place, tilt],
    )
    run = simulate(scene, METHOD)
    root = brentq(
        lambda y: d - y * y * (1.0 + 0.1 * math.tanh(tilt * y)), -2.0 * math.sqrt(d), 0.0, xtol=1e-15
    )
    assert run.switches.time == pytest.approx([3.0 * place + root / rate], abs=1e-12)


def test_no_switch_is_lost_or_added_in_a_long_run():
    scene = scenes.bilinear_oscillator(t_end=2e4)
    times = simulate(scene, METHOD, keep="impacts").switches.time
    durations = np.diff(times)
    np.testing.assert_allclose(durations[::2], math.pi / 3.0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(durations[1::2], math.pi, rtol=0, atol=1e-9)


def jump(t, x, p, out):
    out[0] = 1.0 if x[0] > 0.7 else -1.0


def test_a_guard_that_jumps_is_found_where_it_does():
    run = simulate(
        moving_ramp({"a": Mode(one, [Guard(jump, "b")]), "b": Mode(one)}, x0=0.0, t_end=2.0), METHOD
    )
    assert run.switches.time == pytest.approx([0.7], abs=1e-13)


def test_a_time_dependent_guard_and_a_reset():
    def beat(t, x, p, out):
        out[0] = math.sin(7.0 * t)

    def double(t, x, p, out):
        out[0] = 2.0 * x[0]

    def rest(t, x, p, out):
        out[0] = 0.0

    modes = {"a": Mode(rest, [Guard(beat, "a", direction=0, reset=double)])}
    scene = HybridScene(HybridSystem(1, modes), [1.0], "a", (0.0, 4.0), period=2.0 * math.pi / 7.0)
    run = simulate(scene, METHOD)
    n = int(4.0 * 7.0 / math.pi)
    np.testing.assert_allclose(run.switches.time, math.pi / 7.0 * np.arange(1, n + 1), rtol=0, atol=1e-13)
    np.testing.assert_array_equal(run.x[-1], [2.0**n])
    assert run.at(run.switches.time[2])[0] == 8.0  # the right limit
    assert run.at(np.nextafter(run.switches.time[2], 0.0))[0] == 4.0


def test_a_mode_entered_beyond_its_guard_is_left_at_once_or_not_as_the_guard_says():
    for at_once, expected in ((True, ["b"]), (False, [])):
        modes = {"a": Mode(one, [Guard(position, "b", at_once=at_once)]), "b": Mode(one)}
        run = simulate(moving_ramp(modes, x0=0.5), METHOD)
        assert list(run.switches.target) == expected


@pytest.mark.parametrize("amplitude", [0.0, 0.3, 2.0])
def test_the_friction_law_and_the_filippov_form_are_one_motion(amplitude):
    """x'' + x = -0.1 sign(x') + F sin(t/2), pressed on a floor with 1 N and mu = 0.1, against the Filippov system."""
    x0 = 1.05 if amplitude == 0.0 else 0.0
    filippov = scenes.dry_friction_oscillator(x0, amplitude=amplitude, omega=0.5, t_end=40.0)
    force = Harmonic(constant=[0.0, -1.0], sine=[amplitude, 0.0], omega=0.5)
    pressed = replace(
        scenes.coulomb_oscillator(x0, t_end=40.0),
        system=LinearSystem(M=np.eye(2), K=np.diag([1.0, 0.0]), force=force), exact=None,
    )  # fmt: skip
    t = np.linspace(0.0, 40.0, 401)[1:-1]
    expected = simulate(filippov, METHOD).at(t)[:, 0]
    errors = [np.max(np.abs(simulate(pressed, Moreau(h=h), keep=t).q[:, 0] - expected)) for h in (1e-2, 1e-3)]
    assert errors[1] < 2e-3
    assert errors[1] < 0.3 * errors[0]
