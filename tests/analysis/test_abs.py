"""The hybrid anti-lock controller: cycle, dead-beat multiplier, basins, bifurcations against exact values."""

import json
import math
import re

import numpy as np
import pytest
from scipy.optimize import brentq

from lagrangian.scenes.hybrid_abs import holding_torque, hybrid_abs
from lcpstep import EventDriven, LcpStepError, Status, simulate
from lcpstep.analysis.abs_basins import allowed_bias, basins, margins
from lcpstep.analysis.abs_cycle import CYCLE, EQUILIBRIUM, LOCK, OUTCOMES, NoCycle, limit_cycle, peak
from lcpstep.analysis.abs_parameters import bifurcation, edge, has_cycle, vanishing, with_thresholds
from lcpstep.cli import main
from lcpstep.cli.abs import _text
from lcpstep.errors import StudyInterrupted

MODELS = ["slip", "constant"]
WET = {"road": "wet", "torque_max": 1000.0, "torque_min": 630.0}


def isocline(scene, torque, low, high):
    return brentq(lambda s: holding_torque(s, scene.p) - torque, low, high, xtol=1e-15)


@pytest.mark.parametrize(
    "settings", [{"model": "slip"}, {"model": "constant"}, WET], ids=["slip", "constant", "wet"]
)
def test_the_cycle_is_dead_beat_and_closes(settings):
    scene = hybrid_abs(**settings)
    cycle = limit_cycle(scene)
    assert cycle.states == ("2", "3", "0", "1")
    assert abs(cycle.multiplier) < 1e-11
    assert abs(cycle.multiplier_by_differences) < 1e-10
    top, bottom = scene.parameters["torque_max"], scene.parameters["torque_min"]
    np.testing.assert_allclose(cycle.torque, [top, bottom, bottom, top], rtol=1e-14)
    np.testing.assert_allclose(cycle.slip[[0, 2]], [0.35, 0.08], rtol=0, atol=1e-13)
    # torques are ramps of known duration
    ramp = (top - bottom) / scene.parameters["rate"]
    assert cycle.times[1] - cycle.times[0] == pytest.approx(ramp, abs=1e-14)
    assert cycle.times[3] - cycle.times[2] == pytest.approx(ramp, abs=1e-13)
    # the motion along the cycle is the eigenvector of the multiplier one
    p, slip, torque = np.asarray(scene.p), *[cycle.slip[0], cycle.torque[0]]
    omega = 1.0 / (1.0 if settings.get("model") != "constant" else 1.0 / (1.0 - slip))
    F = np.array([-0.3 / 30.0 * omega * (holding_torque(slip, p) - torque), -scene.parameters["rate"]])
    np.testing.assert_allclose(cycle.monodromy @ F, F, rtol=1e-7)


@pytest.mark.parametrize("model", MODELS)
def test_the_time_in_a_held_state_is_an_integral(model):
    from scipy.integrate import quad

    scene = hybrid_abs(model=model)
    cycle, p = limit_cycle(scene), np.asarray(scene.p)

    def slowness(s):
        factor = (1.0 - s) if model == "constant" else 1.0
        return -30.0 / (0.3 * factor * (holding_torque(s, p) - 1600.0))

    held = quad(slowness, cycle.slip[3], 0.35, epsabs=1e-13, epsrel=1e-13)[0]
    assert cycle.period - cycle.times[3] == pytest.approx(held, abs=1e-10)


@pytest.mark.parametrize(
    "settings",
    [
        pytest.param({"model": "slip"}, id="slip", marks=pytest.mark.thorough),
        pytest.param({"model": "constant"}, id="constant", marks=pytest.mark.thorough),
        pytest.param(WET, id="wet", marks=pytest.mark.slow),
    ],
)
def test_the_cycle_vanishes_where_the_threshold_meets_the_top_of_the_isocline(settings):
    scene = hybrid_abs(**settings)
    _, top = peak(scene)
    fine = np.linspace(0.05, 0.4, 350_001)
    assert top >= max(holding_torque(s, scene.p) for s in fine[::1000])
    assert vanishing(scene) == pytest.approx(top, abs=1e-9)


def test_the_cycle_is_lost_to_a_locked_wheel_where_it_meets_the_falling_isocline():
    scene = hybrid_abs()
    right = isocline(scene, 1000.0, 0.3, 0.9)
    upper = edge(lambda T: has_cycle(with_thresholds(scene, torque_max=T)), 1600.0, 1700.0, 1e-7)
    cycle = limit_cycle(with_thresholds(scene, torque_max=upper - 1e-6))
    assert cycle.slip[1] == pytest.approx(right, abs=1e-6)
    with pytest.raises(NoCycle, match="the wheel locks in state 3") as lost:
        limit_cycle(with_thresholds(scene, torque_max=upper + 1e-3))
    assert lost.value.outcome == "the wheel locks in state 3"


def test_the_allowed_error_of_the_slip_is_the_distance_to_the_falling_isocline():
    scene = hybrid_abs()
    cycle = limit_cycle(scene)
    by_state = {m.state: m for m in margins(scene, cycle)}
    right = isocline(scene, 1000.0, 0.3, 0.9)
    assert by_state["3"].up == pytest.approx(right - cycle.slip[1], abs=2e-9)
    assert 0.0 < by_state["2"].up < by_state["3"].up  # the error grows on the way
    assert by_state["3"].down is None


def test_a_constant_error_of_the_slip_is_allowed_up_to_the_rising_isocline():
    scene = hybrid_abs()
    low, high = allowed_bias(scene, "slip")
    assert high == pytest.approx(0.08 - isocline(scene, 1000.0, 0.0, 0.16), abs=2e-9)
    assert -margins(scene, limit_cycle(scene))[0].up == pytest.approx(low, abs=1e-2)
    assert low < 0.0
    with pytest.raises(ValueError, match="expected slip or torque"):
        allowed_bias(scene, "speed")


def falling(scene, torque):
    """Slip above which the wheel locks under a torque that is held."""
    return 1.0 if holding_torque(1.0, scene.p) > torque else isocline(scene, torque, 0.162, 1.0)


def test_basins_of_held_states_are_bounded_by_the_isocline():
    scene = hybrid_abs()
    slip, torque = np.array([0.02, 0.12, 0.2, 0.45, 0.7]), np.array([600.0, 1150.0, 1300.0])
    labels = basins(scene, slip, torque).labels
    below, top = set(), peak(scene)[1]
    for i, s in enumerate(slip):
        for j, T in enumerate(torque):
            rests = s < 0.35 and top > T and s < falling(scene, T)
            locks = s > 0.08 and (top < T or s > falling(scene, T))
            assert (labels[1, i, j] == EQUILIBRIUM) == rests
            assert (labels[3, i, j] == LOCK) == locks
            below.add((rests, locks))
    assert len(below) == 3  # all cases occur
    assert labels[3, 1, 1] == EQUILIBRIUM  # slip 0.12 falls towards the rising isocline, above lambda_min
    assert labels[3, 3, 0] == CYCLE
    assert set(np.unique(labels)) <= {CYCLE, LOCK, EQUILIBRIUM}
    assert OUTCOMES[LOCK] == "wheel lock"


def test_period_grows_as_the_cycle_vanishes():
    scene = hybrid_abs()
    top = peak(scene)[1]
    found = bifurcation(scene, [top - 1.0, top + 2e-3, top + 8e-3, 1600.0, 1700.0])
    assert np.isnan(found.period[[0, 4]]).all()
    # the passage of the top takes pi/sqrt(a b (T - max Psi)): twice as long for a quarter of the distance
    fall = (found.period[1] - found.period[3]) / (found.period[2] - found.period[3])
    assert fall == pytest.approx(2.0, abs=0.02)


def test_a_wheel_locks_rests_and_turns_again_as_the_torque_falls():
    scene = hybrid_abs(road="dry", slip=0.9, torque=1400.0, state=2, torque_min=300.0)
    run = simulate(scene, EventDriven())
    assert list(run.switches.target[:2]) == ["2 locked", "2"]
    freed = run.switches[1]
    p = np.asarray(scene.p)
    assert freed.before[1] == pytest.approx(holding_torque(1.0, p), abs=1e-9)
    assert freed.time == pytest.approx((1400.0 - holding_torque(1.0, p)) / 1e4, abs=1e-13)
    t = np.linspace(run.switches[0].time + 1e-6, freed.time - 1e-6, 9)
    assert np.all(run.at(t)[:, 0] == 1.0)


def test_the_full_model_stands_still_in_the_end_and_has_no_cycle():
    scene = hybrid_abs(model="full", t_end=8.0)
    run = simulate(scene, EventDriven())
    assert run.status == Status.DONE
    assert run.mode[-1] == "standing"
    # the momentum lost is that of the road's force
    t = np.linspace(0.0, run.switches.time[-1], 20_001)
    x = run.at(t)
    p = np.asarray(scene.p)
    force = np.array([9.81 * (p[0] * (1.0 - math.exp(-s * p[1])) - s * p[2]) for s in x[:, 0]])
    assert x[0, 2] - x[-1, 2] == pytest.approx(np.trapezoid(force, t), abs=1e-4)
    with pytest.raises(LcpStepError, match="needs a reduced model"):
        limit_cycle(scene)


def test_the_dry_thresholds_lock_the_wheel_on_a_wet_road():
    with pytest.raises(NoCycle, match="wheel locks in state 3"):
        limit_cycle(hybrid_abs(road="wet"))


@pytest.mark.slow
def test_the_command_writes_what_it_prints(capsys, tmp_path):
    arguments = ["abs", "--grid", "4", "--points", "4", "--out", str(tmp_path), "--json"]
    assert main(arguments) == 0
    printed = json.loads(capsys.readouterr().out)
    saved = json.loads((tmp_path / "abs.json").read_text())
    assert saved == printed
    assert saved["vanishes_below"] == pytest.approx(saved["peak"]["torque"], abs=1e-9)
    assert sum(saved["basins"]["shares"]["0"].values()) == pytest.approx(1.0)
    assert f"limit cycle of period {saved['cycle']['period']:.12f} s" in _text(saved)
    assert np.load(tmp_path / "abs-basins.npz")["labels"].shape == (4, 4, 4)
    assert (tmp_path / "abs.png").stat().st_size > 1000
    assert main(arguments) == 2
    assert "exists already" in capsys.readouterr().err
    assert main(["abs", "--torque-min", "1700"]) == 2
    assert "torque_min: expected less" in capsys.readouterr().err
    quick = ["--grid", "0", "--points", "2", "--overwrite", "--no-picture", "--out", str(tmp_path)]
    assert main(["abs", "--road", "wet", *quick]) == 0
    said = capsys.readouterr().out
    assert "the wheel locks in state 3" in said
    assert re.findall(r"wrote (.*)", said) == [str(tmp_path / "abs.json")]


def test_the_command_runs_a_stop_of_the_full_model(capsys, tmp_path):
    assert main(["abs", "--model", "full", "--out", str(tmp_path), "--json"]) == 0
    stop = json.loads(capsys.readouterr().out)
    assert stop["end"] == "stands"
    assert (tmp_path / "abs.png").stat().st_size > 1000
    # v dv = a dx: between the decelerations of the smallest and largest friction used
    assert (30.0**2 - 1.0) / (2.0 * 9.81 * 1.01) < stop["distance"] < (30.0**2 - 1.0) / (2.0 * 9.81 * 0.59)
    # at constant speed the cycle goes on; as the speed falls the slip outruns the controller, and stays locked
    locked = [s for s in stop["switches"] if s["state"] == "3 locked"]
    assert stop["locked"] == locked[0]["time"]
    last = locked[0]["time"] + (locked[0]["speed"] - 1.0) / (9.81 * (1.11 * (1.0 - math.exp(-23.99)) - 0.52))
    assert stop["time"] == pytest.approx(last, abs=1e-9)
    run = simulate(hybrid_abs(model="full", t_end=8.0), EventDriven())
    t = np.linspace(0.0, stop["time"], 200_001)
    assert stop["distance"] == pytest.approx(np.trapezoid(run.at(t)[:, 2], t), abs=1e-6)


def test_an_interrupt_of_the_basins_keeps_what_was_computed():
    def impatient(done):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(StudyInterrupted) as stopped:
        basins(hybrid_abs(), [0.1, 0.5], [500.0, 1100.0], impatient)
    labels = stopped.value.study.labels
    assert np.all(labels[0] >= 0)
    assert np.all(labels[2:] == -1)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"road": "ice"}, "road: expected one of dry, wet"),
        ({"model": "v"}, "model: expected one of slip, constant, full"),
        ({"torque_min": 1700.0}, "torque_min: expected less than torque_max"),
        ({"slip_min": 0.4}, "slip_min: expected less than slip_max"),
        ({"rate": 0.0}, "rate: expected a positive number"),
        ({"state": 4}, "state: expected 0, 1, 2 or 3"),
        ({"slip": 1.5}, "slip: expected a value in"),
    ],
)
def test_wrong_arguments_are_named(settings, said):
    with pytest.raises(ValueError, match=said):
        hybrid_abs(**settings)


def test_an_edge_needs_both_sides():
    with pytest.raises(ValueError, match="expected the cycle at 1700"):
        edge(lambda T: has_cycle(with_thresholds(hybrid_abs(), torque_max=T)), 1700.0, 1800.0, 1e-3)
