"""What can be done with a run of modes and contacts: kept, saved, drawn, continued, and read as a map."""

from dataclasses import replace

import numpy as np
import pytest

import lcpstep
from lcpstep import LcpStepError, simulate
from lcpstep.maps import StroboscopicMap, SwitchMap
from tests.events.switching import METHOD, bilinear_with_wall, two_gravities


def test_a_run_keeps_what_is_asked_for():
    scene = two_gravities(1.8)
    whole = simulate(scene, METHOD)
    times = np.linspace(0.05, 1.75, 18)
    some = simulate(scene, METHOD, keep=times)
    np.testing.assert_allclose(some.x, whole.at(times), rtol=0, atol=1e-13)
    np.testing.assert_array_equal(some.mode, whole.mode_at(times))
    np.testing.assert_array_equal(some.at(times), some.x)
    assert some.mode_at(whole.switches.time[3]) == whole.switches.target[3]
    with pytest.raises(ValueError, match="keep=1"):
        some.at(0.051)
    events = simulate(scene, METHOD, keep="impacts")
    assert set(whole.impacts.time) | set(whole.switches.time) <= set(events.t)
    np.testing.assert_allclose(events.impulse.sum(axis=0), whole.impulse.sum(axis=0), rtol=1e-12)


def test_a_run_is_saved_drawn_tabled_and_continued(tmp_path):
    scene = bilinear_with_wall(10.0, labels=("position [m]", "velocity [m/s]"))
    run = simulate(scene, METHOD)
    again = lcpstep.load(run.save(tmp_path / "run.nc"), scene=scene)
    for name in ("t", "x", "impulse", "mode"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    for name in ("time", "impulse"):
        np.testing.assert_array_equal(again.impacts[name], run.impacts[name])
    t = np.linspace(0.0, 10.0, 77)
    np.testing.assert_array_equal(again.at(t), run.at(t))
    np.testing.assert_array_equal(again.mode_at(t), run.mode_at(t))
    assert len(run.plot().axes) == 4
    assert "impact" in run._repr_html_()
    table = run.to_dataframe()
    assert list(table.columns) == ["impulse0", "x0", "x1", "mode"]
    events = run.to_dataframe("events")
    assert len(events) == len(run.impacts) + len(run.switches)
    assert np.all(np.diff(events.time) >= 0.0)
    assert {"impact_time", "switch_time", "impulse"} <= set(run.to_xarray().variables)
    whole = simulate(replace(scene, t_span=(0.0, 20.0)), METHOD)
    rest = simulate(lcpstep.continued(run, t_end=20.0), METHOD)
    np.testing.assert_allclose(rest.at(20.0), whole.at(20.0), rtol=0, atol=1e-10)


def height_tells(t, x, p):
    return "high" if x[0] > p[2] else "low"


def test_returns_to_a_mode_are_found_and_derivatives_refused():
    scene = two_gravities()
    run, P = simulate(scene, METHOD), SwitchMap(scene, METHOD, "low")
    entered = run.switches[run.switches.target == "low"]
    np.testing.assert_allclose(P(P.entry()), entered.after[1], rtol=0, atol=1e-11)
    with pytest.raises(LcpStepError, match="velocities jump and contacts rest"):
        P.jacobian(P.entry())
    told = replace(scene, system=replace(scene.system, mode_of=height_tells), period=1.0)
    with pytest.raises(LcpStepError, match="velocities jump and contacts rest"):
        StroboscopicMap(told, METHOD)([0.7, 0.0])
