"""Systems with modes against closed forms: switching times, Filippov sliding, and what goes wrong by name."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from lagrangian import Guard, Harmonic, HybridScene, HybridSystem, LinearSystem, Mode, Surface, scenes
from lcpstep import (
    EventDriven,
    LcpStepError,
    Moreau,
    SimulationError,
    SimulationInterrupted,
    Status,
    simulate,
)
from lcpstep.model import UncompiledCallback

METHOD = EventDriven()
KNOWN = [
    pytest.param(scenes.bilinear_oscillator(left=4.0, right=0.5, x0=0.3, v0=-1.0), id="bilinear"),
    pytest.param(scenes.bilinear_oscillator(), id="bilinear-stiff"),
    pytest.param(scenes.dry_friction_oscillator(), id="dry-friction"),
    pytest.param(scenes.dry_friction_oscillator(x0=-0.75), id="dry-friction-other-side"),
    pytest.param(scenes.stick_slip_oscillator(), id="stick-slip"),
    pytest.param(scenes.stick_slip_oscillator(x0=-0.9, belt=0.7), id="stick-slip-fast"),
]


def one(t, x, p, out):
    out[0] = 1.0


def minus_one(t, x, p, out):
    out[0] = -1.0


def position(t, x, p, out):
    out[0] = x[0]


def moving_ramp(modes, x0=-0.5, mode="a", t_end=10.0, surfaces=(), p=()):
    return HybridScene(HybridSystem(1, modes, surfaces), [x0], mode, (0.0, t_end), p=p)


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


def rotate(t, x, p, out):
    out[0], out[1] = -x[1] + p[0], x[0]


def towards(t, x, p, out):
    out[0], out[1] = p[1], -1.0


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


def wall(t, x, p, out):
    out[0] = x[0] - math.sin(t)


def test_sliding_on_a_moving_surface_that_is_left_by_a_touch_is_named():
    """The fields +-1 can follow sin(t) but for t = 0 and pi, where its speed is theirs."""
    modes = {"a": Mode(one), "b": Mode(minus_one)}
    system = HybridSystem(1, modes, [Surface(wall, "a", "b")])
    run = simulate(HybridScene(system, [-2.0], "a", (0.0, 6.0), period=2.0 * math.pi), METHOD)
    entered = brentq(lambda t: t - 2.0 - math.sin(t), 2.0, 3.0, xtol=1e-15)
    assert run.switches.time == pytest.approx([entered], abs=1e-12)
    assert run.status == Status.NOT_TRANSVERSAL
    assert run.t[-1] == pytest.approx(math.pi, abs=1e-4)


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


def test_modes_that_switch_for_ever_at_one_instant_are_named_and_a_surface_resolves_them():
    relay = {"up": Mode(one, [Guard(position, "down")]), "down": Mode(minus_one, [Guard(position, "up", -1)])}
    run = simulate(moving_ramp(relay, mode="up"), METHOD)
    assert run.status == Status.ENDLESS_SWITCHING
    assert run.t[-1] == pytest.approx(0.5, abs=1e-12)
    assert "up" in run.message
    assert "down" in run.message
    assert "Surface" in run.message
    surface = [Surface(position, "up", "down")]
    run = simulate(
        moving_ramp({"up": Mode(one), "down": Mode(minus_one)}, mode="up", surfaces=surface), METHOD
    )
    assert run.status == Status.DONE
    assert run.mode[-1] == "sliding"
    assert run.x[-1, 0] == 0.0


def test_infinitely_many_bounces_end_with_a_status_near_their_accumulation():
    def fall(t, x, p, out):
        out[0], out[1] = x[1], -10.0

    def bounce(t, x, p, out):
        out[0], out[1] = 0.0, -0.5 * x[1]

    system = HybridSystem(2, {"fall": Mode(fall, [Guard(position, "fall", -1, bounce)])})
    run = simulate(HybridScene(system, [5.0, 0.0], "fall", (0.0, 10.0)), METHOD)
    assert run.status == Status.ENDLESS_SWITCHING
    assert run.t[-1] == pytest.approx(3.0, abs=1e-4)
    np.testing.assert_allclose(
        run.switches.time[:12], 1.0 + 2.0 * (1.0 - 0.5 ** np.arange(12)), rtol=0, atol=1e-10
    )


def bump(t, x, p, out):
    out[0] = p[0] - (x[0] - 3.0) ** 2


@pytest.mark.parametrize("miss", [0.0, 1e-13, -1e-13])
def test_a_guard_that_is_only_touched_is_named(miss):
    run = simulate(moving_ramp({"a": Mode(one, [Guard(bump, "b")]), "b": Mode(one)}, p=[miss]), METHOD)
    assert run.status == Status.NOT_TRANSVERSAL
    assert "not transversal" in run.message
    assert "'b'" in run.message
    assert run.t[-1] == pytest.approx(3.5, abs=1e-5)


def test_the_bound_on_switches_holds():
    run = simulate(scenes.bilinear_oscillator(t_end=1e3), EventDriven(max_events=7))
    assert run.status == Status.TOO_MANY_EVENTS
    assert len(run.switches) == 7


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Guard(position, "b", 2), "guard.direction: expected 1, -1 or 0"),
        (lambda: Mode(None), "mode.field: expected a function"),
        (lambda: HybridSystem(1, {}), "modes: expected at least one mode"),
        (lambda: HybridSystem(1, {"a": Mode(one, [Guard(position, "c")])}), "guard.target: unknown mode 'c'"),
        (
            lambda: HybridSystem(1, {"a": Mode(one)}, [Surface(position, "a", "z")]),
            "surface: unknown mode 'z'",
        ),
        (lambda: moving_ramp({"a": Mode(one)}, mode="b"), "mode: unknown mode 'b'"),
        (lambda: moving_ramp({"a": Mode(one)}, t_end=-1.0), "t_span: expected t_start < t_end"),
        (lambda: moving_ramp({"a": Mode(lambda t, x, p, out: 1.0)}), "field of mode 'a'"),
        (lambda: moving_ramp({"a": Mode(one)}, x0=math.nan), "x0: expected finite numbers"),
    ],
)
def test_wrong_arguments_are_named(make, said):
    with pytest.raises(ValueError, match=said):
        make()


def test_what_no_method_can_do_is_refused():
    with pytest.raises(LcpStepError, match=r"does not treat systems with modes.*take EventDriven"):
        simulate(scenes.bilinear_oscillator(), Moreau(h=1e-3))
    modes = {"up": Mode(minus_one), "down": Mode(one)}
    leaving = moving_ramp(modes, x0=0.0, mode="sliding", surfaces=[Surface(position, "up", "down")])
    with pytest.raises(LcpStepError, match="needs both fields to point at the surface"):
        simulate(leaving, METHOD)


def test_a_motion_that_leaves_the_finite_numbers_keeps_what_was_computed():
    def blow_up(t, x, p, out):
        out[0] = x[0] * x[0]

    def end_of_the_world(t, x, p, out):
        out[0] = 1.0 + math.sqrt(0.5 - x[0])

    run = simulate(moving_ramp({"a": Mode(blow_up)}, x0=1.0, t_end=2.0), METHOD)
    assert run.status == Status.STEP_TOO_SMALL
    assert run.t[-1] == pytest.approx(1.0, abs=1e-6)
    with pytest.raises(SimulationError, match="mode 'a'") as stopped:
        simulate(moving_ramp({"a": Mode(end_of_the_world)}, x0=0.0), METHOD)
    assert 0.1 < stopped.value.trajectory.x[-1, 0] <= 0.5


def falls(t, x, p, out):
    out[0], out[1] = x[1], -9.81


def unknown_below(t, x, p, out):
    out[0] = x[0] if t < 0.3 else math.nan


def fails_below(t, x, p, out):
    if t > 0.3:
        raise ValueError("the sensor broke")
    out[0] = x[0]


def rebound(t, x, p, out):
    out[0], out[1] = 0.0, -0.5 * x[1]


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("below", [unknown_below, fails_below])
def test_a_guard_that_goes_wrong_is_not_taken_for_one_that_stays_away(below):
    ball = HybridSystem(2, {"fly": Mode(falls, [Guard(below, "fly", -1, rebound)])})
    with pytest.raises(SimulationError, match=r"guard|sensor") as caught:
        simulate(HybridScene(ball, x0=[1.0, 0.0], mode="fly", t_span=(0.0, 1.0)), EventDriven())
    assert caught.value.trajectory.t[-1] <= 0.31


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


SEEN = []


def test_functions_that_cannot_be_compiled_run_in_plain_python_with_a_notice():
    def remembered(t, x, p, out):
        SEEN.append(t)
        out[0] = x[0] - 1.0

    def on(guard):
        return moving_ramp({"a": Mode(one, [Guard(guard, "b")]), "b": Mode(minus_one)}, t_end=3.0)

    def compiled(t, x, p, out):
        out[0] = x[0] - 1.0

    fast = simulate(on(compiled), METHOD)
    with pytest.warns(UncompiledCallback, match="runs in plain Python"):
        run = simulate(on(remembered), METHOD)
    np.testing.assert_allclose(run.t, fast.t, rtol=0, atol=1e-12)
    np.testing.assert_allclose(run.switches.time, fast.switches.time, rtol=0, atol=1e-14)
    assert SEEN


def test_an_interrupted_run_keeps_what_was_computed():
    def impatient(t):
        if t > 100.0:
            raise KeyboardInterrupt

    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(scenes.bilinear_oscillator(t_end=1e5), METHOD, progress=impatient)
    part = stopped.value.trajectory
    assert part.status == Status.INTERRUPTED
    assert 100.0 < part.t[-1] < 1e5
    assert len(part.switches) >= 2.0 * 100.0 / (math.pi + math.pi / 3.0) - 1.0
    times = [10.0, 20.0, 30.0]
    kept = simulate(scenes.bilinear_oscillator(t_end=40.0), METHOD, keep=times)
    np.testing.assert_array_equal(kept.t, times)
    np.testing.assert_allclose(kept.x, part.at(times), rtol=0, atol=1e-9)
    assert list(kept.mode) == list(part.mode_at(times))
