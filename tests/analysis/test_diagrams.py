"""Bifurcation diagrams: every impact of a chattering motion is in them, and what is missing is told and drawn."""

from dataclasses import replace

import numpy as np
import pytest

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lagrangian.scenes import cam_follower
from lcpstep import EventDriven, Moreau, simulate
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.analysis.listed import column
from lcpstep.cli import main
from lcpstep.plot import bifurcation as pictures
from lcpstep.trajectory import Kind

pytest.importorskip("xarray")
CHATTERING = np.array([116.0, 125.0, 175.0])  # rpm: two sequences, two, one across the section


def logged(rpm, periods):
    """Phases of impacts and of ends of chattering in the last period of one long run."""
    scene = cam_follower(rpm=rpm, q0=0.0, v0=0.0)
    T = scene.period
    run = simulate(replace(scene, t_span=(0.0, periods * T)), EventDriven(), keep="impacts")
    last = run.impacts[run.impacts.time > (periods - 1) * T]
    return tuple(np.sort(last.time[last.kind == kind] / T % 1.0) for kind in (Kind.IMPACT, Kind.STICK))


def test_all_impacts_of_chattering_sequences_are_recorded():
    data = bifurcation(cam_follower, "rpm", CHATTERING, drop=20, keep=2)
    for k, rpm in enumerate(CHATTERING):
        impacts, ends = logged(rpm, 22)
        assert len(impacts) > 50
        for name, expected in (("impact_phase", impacts), ("landing_phase", ends)):
            found, period = column(data, name, k)
            assert np.sort(found[period == 1]) == pytest.approx(expected, abs=1e-9)
        assert data["impacts"].values[0, k, 1] == len(impacts)


def test_every_entry_of_the_list_says_where_it_belongs():
    box = [[0.0, -5.0], [1.0, 5.0]]
    data = bifurcation(cam_follower, "rpm", CHATTERING, start="random", box=box, runs=2, drop=5, keep=3)
    counted = np.zeros_like(data["impacts"].values)
    places = [data[f"impact_{x}"].values for x in ("run", "value", "period")]
    np.add.at(counted, tuple(places), 1)
    assert np.array_equal(counted, data["impacts"].values)
    first = data["impact_number"].values == 1
    assert np.sum(first) == np.sum(data["impacts"].values > 0)


def between_walls(w):
    """The right wall is contact 0; the other one is elsewhere, so that both are struck at other speeds."""
    block = LinearSystem(M=1.0, C=0.1, K=1.0, force=Harmonic(cosine=3.0, omega=w))
    walls = LinearContacts(G=[[-1.0], [1.0]], offset=[0.5, 0.7], restitution=0.8)
    return Scene(block, 0.0, 0.0, (0.0, 10.0), contacts=walls, period=2.0 * np.pi / w)


def test_every_impact_says_which_contact_it_is_of():
    data = bifurcation(between_walls, "w", [2.5, 2.9], drop=60, keep=2)
    for k, w in enumerate((2.5, 2.9)):
        scene = between_walls(w)
        run = simulate(replace(scene, t_span=(0.0, 62.0 * scene.period)), EventDriven(), keep="impacts")
        last = run.impacts[run.impacts.time > 60.0 * scene.period]
        contact, _ = column(data, "impact_contact", k)
        assert len(set(last.contact)) == 2
        assert np.array_equal(contact, last.contact)
        assert column(data, "impact_before", k)[0] == pytest.approx(last.before, abs=1e-9)
    ax = pictures.bifurcation(data, show=["speed"]).axes[0]
    drawn = [np.unique(np.round(line.get_ydata(), 9)) for line in ax.lines[:2]]
    for c, speeds in enumerate(drawn):
        own = data["impact_contact"].values == c
        assert np.array_equal(speeds, np.unique(np.round(data["impact_before"].values[own], 9)))


def test_time_stepping_lists_the_ends_of_chattering_where_event_driven_does():
    settings = {"drop": 20, "keep": 1}
    exact = bifurcation(cam_follower, "rpm", CHATTERING, **settings)
    stepped = bifurcation(cam_follower, "rpm", CHATTERING, method=Moreau(h=2e-5), **settings)
    for k in range(len(CHATTERING)):
        (one, _), (other, _) = (column(data, "landing_phase", k) for data in (exact, stepped))
        assert other == pytest.approx(one, abs=3e-3)


@pytest.mark.slow
def test_a_bound_that_is_reached_is_told_and_drawn(capsys, tmp_path):
    arguments = "bifurcation cam-follower --range 116 125 --points 3 --drop 5 --keep 2 --most 40"
    assert main([*arguments.split(), "--out", str(tmp_path / "cut")]) == 0
    assert "only the first 40 impacts of a period are recorded at 3 values of rpm: 116, 120.5, 125" in (
        capsys.readouterr().out
    )
    assert main([*arguments.split()[:-2], "--out", str(tmp_path / "whole")]) == 0
    assert "only the first" not in capsys.readouterr().out
    data = bifurcation(cam_follower, "rpm", CHATTERING, drop=5, keep=2, most=40)
    figure = pictures.bifurcation(data)
    (legend,) = [ax.get_legend() for ax in figure.axes if ax.get_ylabel().startswith("phase of impacts")]
    assert "more than 40 impacts a period" in legend.get_texts()[0].get_text()


def test_the_panels_are_those_asked_for_and_end_with_the_window():
    data = bifurcation(cam_follower, "rpm", [690.0, 700.0, 735.0], drop=50, keep=5)
    figure = pictures.bifurcation(data)
    assert [ax.get_ylabel().split("\n")[0] for ax in figure.axes] == [
        "phase of impacts [periods]",
        "position",
    ]
    asked = pictures.bifurcation(data, show=["velocity", "speed", "impacts"])
    assert [ax.get_ylabel().split("\n")[0] for ax in asked.axes] == [
        "velocity",
        "gap velocity",
        "impacts per period",
    ]
    assert all(ax.get_xlim() == (690.0, 735.0) for ax in (*figure.axes, *asked.axes))
    assert len(pictures.bifurcation(bifurcation(cam_follower, "rpm", CHATTERING, drop=5, keep=2)).axes) == 4


def test_corners_of_the_forcing_come_with_the_diagram():
    data = bifurcation(cam_follower, "rpm", CHATTERING, drop=2, keep=1)
    scene = cam_follower(rpm=100.0)
    for row in data["corner_phase"].values:
        assert row == pytest.approx(np.asarray(scene.corners) / scene.period, abs=1e-15)


def test_maps_show_the_phase_of_the_forcing_that_all_commands_show():
    from lcpstep.maps import sections
    from lcpstep.plot.sections import maps

    scene = cam_follower(rpm=700.0)  # its one impact lies at the phase 0.181399 of `lcpstep orbit`
    figure = maps({"event-driven": sections(scene, EventDriven(), 300, 250)}, "", lowest=0.5)
    x = figure.axes[0].get_lines()[0].get_xdata()
    assert x % 1.0 == pytest.approx(0.181399126674, abs=1e-9)
    assert figure.axes[0].get_xlim() == (0.5, 1.5)
