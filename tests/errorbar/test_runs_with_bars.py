"""Runs with error bars: printed, pickled, interrupted, asked for by commands, and what has none is refused."""

import json
import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import identity

from lagrangian import Contacts, Harmonic, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, SimulationInterrupted, Status, simulate, study
from lcpstep.cli import main
from lcpstep.errorbar import companions, estimate
from lcpstep.errors import LcpStepError
from lcpstep.recording import Kept


def wavy(t, q, v, p, out):
    out[0] = q[0] + 0.1 * math.sin(q[0])


def wavy_q(t, q, v, p, out):
    out[0, 0] = 1.0 + 0.1 * math.cos(q[0])


def test_bars_and_runs_can_be_printed_pickled_and_written():
    contacts = Contacts(1, wavy, wavy_q, restitution=0.5)
    scene = Scene(
        system=LinearSystem(1.0, force=Harmonic(-9.81)), contacts=contacts, q0=1.0, v0=0.0, t_span=(0, 1)
    )
    run = simulate(scene, Located(1e-2), error=True)
    again = pickle.loads(pickle.dumps(run.error))
    assert str(again) == str(run.error)
    assert "m/s" in str(again)
    numbers = json.loads(json.dumps(again.as_dict()))
    assert numbers["position"]["sup"] == again.position.sup
    assert numbers["horizon"] is None
    assert simulate(scene, Located(1e-2)).error is None


def test_the_run_itself_is_the_same_with_and_without_a_bar():
    scene = scenes.cam_follower(rpm=358.0, t_end=0.5)
    for method in (Moreau(1e-4), Located(1e-3, 4), EventDriven()):
        one, other = simulate(scene, method), simulate(scene, method, error=True)
        assert np.array_equal(one.q, other.q)
        assert np.array_equal(one.impacts, other.impacts)
        assert one.counts == other.counts


def test_a_companion_that_takes_too_long_is_told(monkeypatch):
    monkeypatch.setattr(companions, "PATIENCE", 0.0)
    monkeypatch.setattr(companions, "best", lambda run: Located(1e-6, 4))
    monkeypatch.setattr(companions, "FIRST", {})
    run = simulate(scenes.impact_oscillator(t_end=50.0), Located(1e-2))
    bar = estimate.error_bar(run, True, 0.0)
    assert "takes longer than the run" in bar.reason
    assert 0.0 < bar.until < 50.0


def test_an_interrupt_leaves_the_run(monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(estimate, "error_bar", interrupted)
    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(scenes.bouncing_ball(t_end=1.0), Located(1e-2), error=True)
    assert stopped.value.trajectory.t[-1] == 1.0


def test_what_has_no_bar_is_refused_by_name():
    ball = scenes.bouncing_ball(t_end=1.0)
    with pytest.raises(TypeError, match="error: expected True or False"):
        simulate(ball, Located(1e-2), error="yes")
    with pytest.raises(LcpStepError, match="does not treat systems with modes"):
        simulate(scenes.hybrid_abs(), EventDriven(), error=True)

    n = 3000
    large = Scene(
        system=LinearSystem(identity(n, format="csr")), q0=np.zeros(n), v0=np.zeros(n), t_span=(0.0, 1.0)
    )
    with pytest.raises(LcpStepError, match=r"error: a method by dense matrices .* does not treat sparse"):
        simulate(large, Moreau(0.5), error=True)

    class Other:
        def run(self, scene, kept, progress):
            raise AssertionError

    with pytest.raises(LcpStepError, match="Moreau, Located, EventDriven"):
        simulate(ball, Other(), error=True)


def test_a_companion_takes_no_step_longer_than_the_span():
    scene = scenes.bouncing_ball(t_end=0.1)
    found = companions.followed(companions.Companion(Moreau(1.0)), scene, Kept.parse(1, scene.t_span), 0.0)
    assert list(found.t) == [0.0, 0.1]


def test_a_run_that_ends_early_has_a_bar_up_to_its_end():
    scene = scenes.bouncing_ball(t_end=3.0)
    run = simulate(scene, EventDriven(max_events=3), error=True)
    assert run.status.name == "TOO_MANY_EVENTS"
    assert run.error.until <= run.t[-1]
    assert run.error.position.sup < 1e-10


def test_a_run_that_ends_where_it_began_says_so():
    """It may have kept a state after an event there: an error had come of the span without length."""
    run = simulate(scenes.bouncing_ball(t_end=1.0), Moreau(1e-2))
    ends = {
        "t": np.zeros(2),
        "q": run.q[:2],
        "v": run.v[:2],
        "impulse": run.impulse[:2],
        "impacts": run.impacts[:0],
    }
    bar = estimate.error_bar(replace(run, status=Status.LCP_FAILED, **ends), True, 1.0)
    assert bar.reason == "the run ended where it began"
    assert bar.position.sup == math.inf
    assert bar.until == 0.0


def test_the_command_prints_it(capsys, tmp_path):
    assert main(["simulate", "bouncing-ball", "--method", "located", "--h", "1e-2", "--error"]) == 0
    assert "error bar: position" in capsys.readouterr().out
    picture = tmp_path / "motion.png"
    arguments = ["simulate", "impact-oscillator", "--h", "1e-2", "--t-end", "5", "--error", "--json"]
    assert main([*arguments, "--picture", str(picture)]) == 0
    assert json.loads(capsys.readouterr().out)["error"]["position"]["unit"] == "m"
    assert picture.stat().st_size > 0


def test_a_bar_has_the_units_of_the_coordinates():
    run = simulate(scenes.pendulum_stop(t_end=0.5), Located(1e-2), error=True)
    assert (run.error.position.unit, run.error.velocity.unit, run.error.energy.unit) == ("rad", "rad/s", "J")
    assert str(run.error).startswith(f"position {run.error.position.sup:.2g} rad, ")
    assert (estimate.unknown(run, "").position.unit, estimate.unknown(run, "").velocity.unit) == (
        "rad",
        "rad/s",
    )


def test_a_comparison_prints_the_bars_of_all_runs(capsys):
    assert (
        main(["compare", "impact-oscillator", "--t-end", "5", "--h", "1e-2", "--no-pictures", "--error"]) == 0
    )
    out = capsys.readouterr().out
    assert out.count("error bar: position") == 4


def test_a_study_compares_errors_with_bars():
    found = study(
        scenes.impact_oscillator(t_end=10.0), [Moreau(), Located()], h=[1e-2, 1e-3], repeats=1, spread=[1.0]
    )
    for level in found.levels:
        assert 0.5 < level.bars["sup_position"] < 2.0
        assert 0.5 < level.bars["l1_velocity"] < 2.0
    assert "error over error bar of Moreau: sup_position" in str(found)


def test_a_run_that_ends_before_the_first_state_asked_for_has_a_bar_that_says_so():
    calls = []

    def at_random(t, q, v, p, out):  # no step of an event-driven run meets its tolerance
        calls.append(None)
        out[0] = 100.0 * (-1.0) ** len(calls)

    scene = Scene(System(1, 1.0, lambda *a: at_random(*a)), 1.0, 0.0, (0.0, 1.0))
    run = simulate(scene, EventDriven(), keep=[0.9, 1.0], error=True)
    assert (run.status, len(run.t)) == (Status.STEP_TOO_SMALL, 0)
    assert (run.error.reason, run.error.until) == ("no state was kept", 0.0)
    assert run.error.position.sup == math.inf
    assert "no state was kept" in str(run.error)


@pytest.mark.parametrize("omega", [1.8, 2.0, 2.5, 4.0])
def test_a_small_motion_by_the_longest_steps_is_not_held_against_a_run_of_the_same_steps(omega):
    """A millimetre, in steps that the span alone keeps short: their error is far below every absolute tolerance."""

    def pull(t, q, v, p, out):
        out[0] = -p[0] * q[0]

    run = simulate(
        Scene(System(1, 1.0, pull), 1e-3, 0.0, (0.0, 5.0), p=[omega**2]), EventDriven(), error=True
    )
    t = np.linspace(0.0, 5.0, 5001)
    off = np.max(np.abs(run.at(t)[0][:, 0] - 1e-3 * np.cos(omega * t)))
    assert off > 1e-16
    assert 0.5 < off / run.error.position.sup < 2.0
