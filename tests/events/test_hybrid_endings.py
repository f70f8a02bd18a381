"""Systems with modes: what ends a run, and what is refused, is named, and what was computed is kept."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrangian import Guard, HybridScene, HybridSystem, Mode, Surface, scenes
from lcpstep import (
    EventDriven,
    LcpStepError,
    Moreau,
    SimulationError,
    SimulationInterrupted,
    Status,
    continued,
    simulate,
)
from lcpstep.model import UncompiledCallback
from tests.events.ramps import minus_one, moving_ramp, one, position
from tests.marks import compiled_only

METHOD = EventDriven()


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
    assert "mode 'fall' follows itself" in run.message
    assert "contacts" in run.message
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


SEEN = []


@compiled_only
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


def test_the_end_of_a_run_is_kept_whatever_else_is():
    scene = scenes.bilinear_oscillator(t_end=40.0)
    whole, few = simulate(scene, METHOD), simulate(scene, METHOD, keep=10**9)
    np.testing.assert_array_equal(few.t, [0.0, 40.0])
    np.testing.assert_array_equal(few.x, whole.x[[0, -1]])
    assert few.mode[-1] == whole.mode[-1]
    assert continued(few, t_end=50.0).t_span == (40.0, 50.0)
