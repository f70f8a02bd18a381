"""Work-precision studies: orders known by theory, references, horizons, bad input, interruptions."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Coulomb, Harmonic, LinearContacts, LinearSystem, Scene, System, scenes
from lcpstep import EventDriven, Located, Moreau, simulate, study
from lcpstep.accuracy.horizon import growth
from lcpstep.accuracy.orders import cost_of, fitted_order
from lcpstep.accuracy.work_precision import Study
from lcpstep.cli import main
from lcpstep.cli.common import DONE, USAGE
from lcpstep.errors import LcpStepError, StudyInterrupted, UnknownName
from lcpstep.trajectory import Status
from tests.known import OSCILLATOR

SHORT = {"spread": (0.93, 1.0, 1.07), "repeats": 1}
MEASURES = ("sup_position", "l1_velocity", "impact_time", "unmatched", "penetration")


# --- fits


@pytest.mark.slow
def test_the_order_of_exact_powers_is_their_exponent():
    h = np.array([1e-1, 1e-2, 1e-3, 1e-4])
    fit = fitted_order(h, 7.0 * h**1.5)
    assert fit.slope == pytest.approx(1.5)
    assert (fit.low, fit.high) == (pytest.approx(1.5), pytest.approx(1.5))
    assert fitted_order([1e-1, 1e-2], [1.0, math.nan]) is None
    assert fitted_order([1e-1, 1e-2], [1e-1, 1e-2]) is None
    assert fitted_order([1e-1, 1e-2, 1e-3], [0.1, 0.1, 0.1]) is None


@pytest.mark.slow
def test_the_interval_holds_the_true_order_nineteen_times_in_twenty():
    rng, h, held = np.random.default_rng(1), np.geomspace(1e-4, 1e-1, 6), 0
    for _ in range(1000):
        fit = fitted_order(h, h**2 * np.exp(0.3 * rng.standard_normal(6)))
        held += fit.low <= 2.0 <= fit.high
    assert 930 <= held <= 970  # 950 +- 7


def test_the_cost_of_an_error_lies_on_the_line_between_levels_and_beyond_is_said_to_be_extrapolated():
    errors, seconds = [1e-1, 1e-2, 1e-3], [1.0, 10.0, 100.0]
    between, beyond = cost_of(10**-2.5, errors, seconds), cost_of(1e-5, errors, seconds)
    assert (between.seconds, between.extrapolated) == (pytest.approx(10**1.5), False)
    assert (beyond.seconds, beyond.extrapolated) == (pytest.approx(1e4), True)
    # a coarse level that is right by luck is not believed
    assert cost_of(2e-3, [1e-3, 1e-1, 1e-2, 1e-3], [0.1, 1.0, 10.0, 100.0]).seconds > 10.0


# --- studies


@pytest.mark.slow
def test_no_order_is_fitted_through_rounding():
    # three equal balls between walls move in straight lines: all methods that place impacts are exact, to rounding
    # that grows with every step, by an order of about -1
    G = [[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, -1.0, 1.0], [0.0, 0.0, -1.0]]
    walls = LinearContacts(G=G, offset=[0.0, 0.0, 0.0, 1.0], restitution=1.0)
    scene = Scene(LinearSystem(M=np.eye(3)), [0.2, 0.3, 0.8], [2.0, -0.6, 0.1], (0.0, 5.0), contacts=walls)
    found = study(scene, [Located(), Moreau()], **SHORT)
    assert not found.orders()["Located"]
    assert all(x.rounded for x in found.levels if x.method == "Located")
    assert any("rounding" in note for note in found.notes)
    assert not any(x.rounded for x in found.levels if x.method == "Moreau")


@pytest.mark.slow
def test_orders_of_moreau_are_those_of_theory():
    smooth = study(OSCILLATOR, [Moreau(), Moreau(theta=1.0)], **SHORT)
    assert smooth.order("Moreau").slope == pytest.approx(2.0, abs=0.05)
    assert smooth.order("Moreau(theta=1.0)").slope == pytest.approx(1.0, abs=0.1)
    impacts = study(
        scenes.bouncing_ball(t_end=2.5), Moreau(), h=2.5 / 500 / 3.0 ** np.arange(5), measures=MEASURES
    )
    for measure in ("sup_position", "l1_velocity"):
        order = impacts.order("Moreau", measure)
        assert order.low < 1.0 < order.high or order.slope == pytest.approx(1.0, abs=0.15)
    assert impacts.finished
    finest = impacts.levels[-1]
    assert finest.steps == pytest.approx(500 * 81, rel=0.03)
    assert finest.force_evaluations == pytest.approx(finest.steps + 1)
    assert finest.lcp_calls > 0
    assert finest.seconds > 0.0
    assert (
        finest.scatter["sup_position"][0]
        <= finest.errors["sup_position"]
        <= finest.scatter["sup_position"][1]
    )


def test_the_reference_of_a_motion_of_micrometres_is_tight_beside_it():
    def spring(t, q, v, p, out):
        out[0] = -4.0 * q[0]

    scene = Scene(System(1, [[1.0]], spring), 1e-6, 0.0, (0.0, 10.0), LinearContacts(1.0, restitution=1.0))
    order = study(scene, [Located(order=4)], h=[2e-2, 1e-2, 5e-3], repeats=1).order("Located(order=4)")
    assert order is not None
    assert abs(order.slope - 4.0) < 0.1


def test_a_closed_form_is_a_reference_and_is_checked():
    scene, w = Scene(system=LinearSystem(M=1.0, K=4.0), q0=1.0, v0=0.0, t_span=(0.0, 3.0), name="spring"), 2.0
    good = study(
        scene, Moreau(), h=[0.1, 0.05], reference=lambda t: (np.cos(w * t), -w * np.sin(w * t)), **SHORT
    )
    assert good.reference.startswith("closed form; the event-driven run agrees")
    one = simulate(scene, Moreau(0.1))
    assert good.levels[0].errors["sup_position"] == pytest.approx(
        np.max(np.abs(one.q[:, 0] - np.cos(2 * one.t))), rel=0.3
    )
    assert not good.notes
    scalar = study(
        scene, Moreau(), h=[0.1], reference=lambda t: (math.cos(w * t), -w * math.sin(w * t)), **SHORT
    )
    assert scalar.levels[0].errors == pytest.approx(good.levels[0].errors)
    wrong = study(
        scene, Moreau(), h=[0.1], reference=lambda t: (np.cos(1.9 * t), -1.9 * np.sin(1.9 * t)), **SHORT
    )
    assert any("one of them is wrong" in note for note in wrong.notes)
    # nobody's impact log can be believed then
    assert set(wrong.levels[0].errors) == {
        "sup_position",
        "l1_velocity",
        "graph_distance",
        "energy",
        "penetration",
    }
    with pytest.raises(ValueError, match="q0"):
        study(scene, Moreau(), h=[0.1], reference=lambda t: (np.sin(t), np.cos(t)))
    with pytest.raises(TypeError, match="reference"):
        study(scene, Moreau(), h=[0.1], reference="exact")
    with pytest.raises(ValueError, match=r"^h: expected at least one number, got none"):
        study(scene, Moreau(), h=[])


def test_a_poor_reference_is_said_to_be_one():
    found = study(
        scenes.impact_oscillator(t_end=10.0), Moreau(), h=[1e-2, 1e-4], reference=Moreau(1e-3), **SHORT
    )
    assert any("not good enough" in note for note in found.notes)
    assert "sup_position" in found.levels[1].limited
    assert found.uncertainty["sup_position"] > 1e-4
    given = study(scenes.impact_oscillator(t_end=10.0), Moreau(), h=[1e-2],
                  reference=simulate(scenes.impact_oscillator(t_end=8.0), EventDriven()), **SHORT)  # fmt: skip
    assert any("ends at t = 8 s" in note for note in given.notes)
    assert given.compared_until == 8.0


@pytest.mark.slow
def test_a_blow_of_the_disturbed_start_alone_says_nothing_of_what_the_reference_knows():
    floor = LinearContacts(G=[[0.0, 1.0]], friction=Coulomb(mu=0.01, tangent=[[1.0, 0.0]]))
    system = LinearSystem(M=np.eye(2), K=np.diag([1.0, 0.0]), force=Harmonic(constant=[0.0, -10.0]))
    scene = Scene(
        system, [1.05, 0.0], [0.0, 0.0], (0.0, 8.0), floor
    )  # at rest on the floor, where none strikes
    known = study(scene, [Located(order=4)], h=[1e-2, 5e-3]).uncertainty
    assert known["impact_time"] == known["impact_impulse"] == 0.0
    assert 0.0 < known["sup_position"] < 1e-9


@pytest.mark.slow
def test_chaos_ends_the_comparison_where_it_separates_trajectories():
    scene = scenes.cam_follower(rpm=660.0, t_end=10.0)
    found = study(scene, Moreau(), h=[2e-4, 5e-5], horizon=5.0, **SHORT)
    grown = growth(scene, EventDriven(1e-13, 1e-13))
    assert 3.0 < grown.rate < 9.0
    assert grown.horizon < 3.0
    assert 0.2 < found.compared_until <= grown.horizon
    assert any(
        "past the predictability limit" in note and "horizon asked for" in note for note in found.notes
    )
    for level in found.levels:
        assert level.steps == pytest.approx(found.compared_until / level.value, rel=0.03)
    # the phase of an elastic ball drifts in proportion to time; that is no chaos
    ball = growth(scenes.bouncing_ball(h0=0.01, restitution=1.0, t_end=1000.0), EventDriven())
    assert ball.factor[-1] > 1e3
    assert ball.horizon == math.inf


def test_disturbances_grow_in_motions_that_are_the_same_everywhere():
    # two bodies that push each other away, on a line without a place of its own: e^(sqrt(2) t) of their distance
    w = math.sqrt(2.0)
    apart = LinearSystem(M=np.eye(2), K=[[-1.0, 1.0], [1.0, -1.0]])
    grown = growth(Scene(apart, [0.01, -0.01], [-0.01 * w, 0.01 * w], (0.0, 14.0)), EventDriven())
    assert 0.8 * w < grown.rate < w  # it begins with what all have in common
    share = 0.5 * 0.5 * (math.sqrt(5.0) - 1.0) / 2.0  # of the disturbance: half the difference of the two
    assert grown.horizon == pytest.approx(math.log(2.0 * 1e4 / share) / w, rel=0.05)


def test_what_cannot_be_used_is_noted_and_the_rest_is_finished_and_saved(tmp_path):
    file = tmp_path / "study.json"
    found = study(scenes.bouncing_ball(t_end=1.0), {"mine": [Moreau()]}, h=[1e-2, -1.0, 1e-2, math.nan, 1e-3],
                  save=file, **SHORT)  # fmt: skip
    assert [x.value for x in found.levels] == pytest.approx([1e-2, 1e-3], rel=0.01)
    assert sum("h: " in note for note in found.notes) == 3
    assert any("twice" in note for note in found.notes)
    assert Study.load(file).as_dict() == found.as_dict()

    class Refuses:
        def run(self, scene, kept, progress):
            raise LcpStepError("scene: one contact is one too many")

    found = study(scenes.bouncing_ball(t_end=1.0), [Refuses(), Moreau()], h=[1e-2], **SHORT)
    assert [x.status for x in found.levels] == ["REFUSED", "DONE"]
    assert any("one too many" in note for note in found.notes)


def test_errors_of_the_size_of_rounding_make_no_order():
    drifting = Scene(system=LinearSystem(M=1.0), q0=1.0, v0=0.3, t_span=(0.0, 1.0))
    found = study(drifting, Moreau(), h=[0.1, 0.05, 0.02], **SHORT)
    assert found.order("Moreau") is None
    assert all("sup_position" in x.limited for x in found.levels)


def test_a_scene_without_reference_still_gets_its_costs():
    class Refuses:
        def run(self, scene, kept, progress):
            raise LcpStepError("scene: one contact is one too many")

    found = study(scenes.bouncing_ball(t_end=1.0), Moreau(), h=[1e-2, 1e-3], reference=Refuses(), **SHORT)
    assert any(note.startswith("no reference: scene: one contact is one too many") for note in found.notes)
    assert all(set(x.errors) == {"penetration"} and x.seconds > 0 for x in found.levels)


@pytest.mark.parametrize(
    ("bad", "error", "match"),
    [
        ({"methods": []}, ValueError, "methods"),
        ({"methods": [Moreau]}, TypeError, "methods"),
        ({"measures": ["sup_q"]}, UnknownName, "sup_position"),
        ({"h": [-1.0]}, ValueError, "h: expected positive"),
        ({"repeats": 0}, ValueError, "repeats"),
        ({"spread": []}, ValueError, "spread"),
        ({"save": "study.xls"}, ValueError, "save"),
    ],
)
def test_questions_that_make_no_sense_are_refused_by_name(bad, error, match):
    with pytest.raises(error, match=match):
        study(**{"scene": scenes.bouncing_ball(), "methods": Moreau(), **bad})


def test_an_interrupted_study_loses_nothing_and_is_carried_on(tmp_path):
    file, scene, steps = tmp_path / "study.json", scenes.bouncing_ball(t_end=1.0), [1e-2, 1e-3, 1e-4]

    def stop(line):
        if "0.0001" in line:
            raise KeyboardInterrupt

    with pytest.raises(StudyInterrupted) as caught:
        study(scene, Moreau(), h=steps, save=file, progress=stop, **SHORT)
    kept = Study.load(file)
    assert [x.value for x in caught.value.study.levels] == [x.value for x in kept.levels]
    assert len(kept.levels) == 2
    assert not kept.finished
    assert "order of" not in str(kept)  # fits take time, and whoever interrupts does not wait
    whole = study(scene, Moreau(), h=steps, save=file, **SHORT)
    assert whole.levels[:2] == kept.levels
    assert len(whole.levels) == 3
    assert Study.load(file).finished
    with pytest.raises(FileExistsError, match="another study"):
        study(scenes.bouncing_ball(t_end=2.0), Moreau(), h=steps, save=file, **SHORT)


def falling(t):
    """A ball that is let go from one metre, before it arrives."""
    t = np.asarray(t)[:, None]
    return 1.0 - 0.5 * 9.81 * t**2, -9.81 * t


def rising(t):
    """The same, thrown upwards."""
    t = np.asarray(t)[:, None]
    return 1.0 + t - 0.5 * 9.81 * t**2, 1.0 - 9.81 * t


def test_levels_of_another_scene_horizon_or_reference_are_not_taken_for_ones_own(tmp_path):
    scene = scenes.bouncing_ball(t_end=0.4)
    run = simulate(scene, EventDriven())
    first = {"horizon": math.inf, "reference": falling}
    others = [
        {"horizon": 0.2}, {"reference": rising}, {"reference": run}, {"reference": EventDriven()},
        {"scene": replace(scene, contacts=replace(scene.contacts, restitution=0.3))},
    ]  # fmt: skip

    def asked(of_it=scene, **how):
        return study(of_it, Moreau(), h=[1e-2], save=tmp_path / "study.json", **SHORT, **first | how)

    kept = asked().levels
    assert asked().levels == kept
    for other in others:
        how = dict(other)
        with pytest.raises(FileExistsError, match="another study"):
            asked(how.pop("scene", scene), **how)


def test_a_reference_that_contradicts_the_event_driven_run_limits_what_is_said():
    scene = scenes.bouncing_ball(t_end=0.4)

    def wrong(t):
        q, v = falling(t)
        return q + 1e-4 * np.sin(20.0 * np.asarray(t))[:, None], v

    found = study(scene, Located(), h=[1e-1, 1e-2, 1e-3], reference=wrong, **SHORT)
    assert found.uncertainty["sup_position"] == pytest.approx(1e-4, rel=0.01)
    assert all("sup_position" in x.limited for x in found.levels)
    assert found.order("Located") is None


def test_a_trajectory_of_another_scene_is_told_and_makes_no_chaos():
    scene = scenes.bouncing_ball(t_end=2.0)
    softer = replace(scene, contacts=replace(scene.contacts, restitution=0.3))
    other = simulate(softer, EventDriven())
    found = study(scene, Located(), h=[1e-2], reference=other, **SHORT)
    assert any("another scene" in note for note in found.notes)
    assert "exponentially" not in found.growth
    assert found.compared_until == 2.0
    for changed in ({"v0": 1.0}, {"t_span": (1.0, 2.0)}):
        with pytest.raises(ValueError, match="initial state or time"):
            study(replace(scene, **changed), Located(), h=[1e-2], reference=other, **SHORT)
    with pytest.raises(ValueError, match="error: expected a positive number"):
        study(scene, Moreau(), h=[1e-1, 1e-2, 1e-3], **SHORT).cost("Moreau", 0.0)


def test_a_run_that_ends_early_has_no_errors_but_a_reason():
    class Stops:
        def run(self, scene, kept, progress):
            run = Moreau(1e-2).run(scene, kept, progress)
            object.__setattr__(run, "status", Status.LCP_FAILED)
            object.__setattr__(run, "message", "no solution")
            return run

    found = study(scenes.bouncing_ball(t_end=1.0), [Stops(), Moreau()], h=[1e-2], **SHORT)
    assert (found.levels[0].status, found.levels[0].errors) == ("LCP_FAILED", {})
    assert any("no solution" in note for note in found.notes)
    assert found.levels[1].errors


# --- command


@pytest.mark.slow
def test_the_command_writes_tables_and_a_picture(capsys, tmp_path):
    arguments = "study impact-oscillator --methods moreau --t-end 10 --h 1e-2 4e-3 1e-3 --repeats 1"
    assert main([*arguments.split(), "--measures", "sup_position", "--out", str(tmp_path)]) == DONE
    out = capsys.readouterr().out
    assert "order of Moreau in sup_position" in out
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.csv", "study.json", "study.png"]
    stored = json.loads((tmp_path / "study.json").read_text())
    assert {"numpy", "numba", "python", "lcpstep"} <= set(stored["versions"])
    rows = [r for r in (tmp_path / "study.csv").read_text().splitlines() if not r.startswith("#")]
    assert rows[0].startswith("method,dial,value")
    assert len(rows) == 4
    assert main(["study", "impact-oscillator", "--h", "0"]) == USAGE
    assert "h: expected positive" in capsys.readouterr().err
