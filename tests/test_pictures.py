"""What pictures say: names and units, nothing covered, and a copy in grey that still tells things apart."""

import argparse
import itertools
import re
from dataclasses import replace

import numpy as np
import pytest

from lagrangian import labels, scenes
from lcpstep import EventDriven, Located, Moreau, SimulationInterrupted, energy, simulate
from lcpstep.accuracy.compare import compare
from lcpstep.accuracy.work_precision import Level, Study
from lcpstep.cli import own, parser
from lcpstep.cli.common import DONE
from lcpstep.plot import abs_cycle, looks, orbits
from lcpstep.plot.motion import NAMED
from lcpstep.plot.work_precision import work_precision
from tests.commands import run

APART = 0.12  # of the way from black to white: two greys that can be told apart


def grey(colour):
    """How light a colour is, 0 to 1, as a copy without colours has it."""
    from matplotlib.colors import to_rgb

    return float(np.dot(to_rgb(colour), (0.299, 0.587, 0.114)))


def apart(colours):
    return min(abs(a - b) for a, b in itertools.combinations(map(grey, colours), 2))


def test_lines_that_are_named_differ_without_their_colours():
    seen = {(look["ls"], look["lw"]) for look in map(looks.line, range(NAMED))}
    assert len(seen) == NAMED == len({looks.mark(k) for k in range(NAMED)})


def test_areas_differ_without_their_colours():
    for n in (2, 3, 4):
        assert apart([*looks.shades(n)]) > APART
    assert apart(abs_cycle.COLOURS) > APART


def test_units_stand_at_every_panel():
    """Coordinates of several units: velocities have units of their own, which no label of the axis can give."""
    _, velocity, impulse = simulate(scenes.slipping_wheel(t_end=0.1), EventDriven()).plot().axes
    names = [x.get_text() for x in velocity.get_legend().get_texts()]
    assert [name.partition(" [")[2] for name in names] == ["m/s]", "m/s]", "rad/s]"]
    assert [x.get_text() for x in impulse.texts] == ["no impacts"]
    styles = [line.get_linestyle() for line in velocity.get_lines()]
    assert len(set(styles)) == 3


def test_impulses_stand_on_a_line_over_the_whole_time():
    *_, impulse = simulate(scenes.bouncing_ball(t_end=1.0), EventDriven()).plot().axes
    assert not impulse.texts
    lines = [x for x in impulse.get_lines() if x.get_linestyle() == "-" and list(x.get_ydata()) == [0.0, 0.0]]
    assert [0, 1] in [list(line.get_xdata()) for line in lines]  # of the panel's width


@pytest.mark.parametrize("method", [EventDriven(), Located(1e-2), Located(1e-2, order=4)])
def test_velocities_are_drawn_up_to_their_impacts(method):
    """A ball strikes with sqrt(2 g h), and its velocity jumps upright."""
    motion = simulate(scenes.bouncing_ball(h0=0.02, t_end=20.0), method)
    line = motion.plot().axes[1].get_lines()[0]
    t, v = line.get_data()
    assert v.min() == pytest.approx(-np.sqrt(2.0 * 9.81 * 0.02), rel=1e-9)
    up = np.argmax(np.diff(v))
    assert t[up + 1] - t[up] < 1e-9


def test_no_line_joins_states_between_which_none_is_known():
    """At impacts a ball is at the height 0: a line through these states alone would be a ball that never rises."""
    for method, keep in ((Moreau(1e-2), "impacts"), (EventDriven(), 7), (Located(1e-2), [0.1, 0.2, 0.9])):
        motion = simulate(scenes.bouncing_ball(t_end=1.0), method, keep=keep)
        position, *_ = motion.plot().axes
        (points,) = position.get_lines()
        assert points.get_linestyle() == "None"
        assert points.get_marker() != "None"
        np.testing.assert_array_equal(points.get_xydata(), np.column_stack([motion.t, motion.q]))


def test_curves_and_modes_of_a_system_with_modes_go_over_the_whole_run():
    """Between switches beyond the last kept state too, where the state is known; the mode jumps at its switches."""
    motion = simulate(scenes.stick_slip_oscillator(), EventDriven(), keep=[0.5, 1.0])
    first, *_, mode = motion.plot().axes
    t, x = first.get_lines()[0].get_data()
    assert (t[0], t[-1]) == motion.scene.t_span
    assert np.max(np.diff(t)) < 0.02
    np.testing.assert_array_equal(x, motion.at(t)[:, 0])
    assert set(motion.switches.time) <= set(mode.get_lines()[0].get_xdata())


def test_a_run_that_kept_no_state_has_a_picture_of_its_impulses():
    def stops(t):
        raise KeyboardInterrupt

    scene = scenes.bouncing_ball(t_end=50.0)
    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(scene, Moreau(1e-5), keep=[50.0], progress=stops)
    motion = stopped.value.trajectory
    assert len(motion.t) == 0
    position, *_ = motion.plot().axes
    assert len(position.get_lines()[0].get_xdata()) == 0
    with pytest.raises(ValueError, match="t: no state of this run was kept"):
        motion.at(0.0)
    with pytest.raises(ValueError, match="trajectory: expected a run of which states are kept"):
        energy(motion)
    with pytest.raises(SimulationInterrupted) as stopped:
        simulate(scenes.stick_slip_oscillator(t_end=2e5), EventDriven(), keep=[2e5], progress=stops)
    assert " 0 states, " in repr(stopped.value.trajectory)


def test_lengths_in_millimetres_are_called_so_everywhere():
    """The film's axes, the log's velocities; impulses are in N s only where lengths are in metres."""
    ball = scenes.bouncing_ball(t_end=0.1)
    for names, unit in (((), "m"), (["height [mm]"], "mm"), (["angle [rad]"], "m")):
        motion = simulate(replace(ball, coordinates=names), EventDriven())
        data, metres = motion.to_xarray(), unit == "m"
        assert data.impact_before.attrs["units"] == f"{unit}/s"
        assert data.impact_impulse.attrs.get("units") == ("N s" if metres else None)
        assert motion.plot().axes[2].get_ylabel() == ("impulse [N s]" if metres else "impulse")
    rates = ("", "", "")
    assert labels.own_unit("m", ("x [mm]", "y [mm]", "angle [rad]", *rates)) == "mm"
    assert labels.own_unit("m/s", ("x [mm]", "y [m]", *rates[:2])) == "m/s"
    assert labels.own_unit("J", ("x [mm]", "v [mm/s]")) == ""
    assert labels.own_unit("s", ("x [mm]", "v [mm/s]")) == "s"


def test_studies_of_a_motion_in_millimetres_say_so():
    """No axis of a diagram, section, basin, orbit, attractor or comparison has metres, and no variable."""
    from lcpstep.analysis.attractors import attractors
    from lcpstep.analysis.basins import basins
    from lcpstep.analysis.bifurcation import bifurcation
    from lcpstep.analysis.orbits import periodic_orbit
    from lcpstep.cli.attractor import _dataset
    from lcpstep.explore.views import impact_labels
    from lcpstep.maps import sections
    from lcpstep.plot.attractors import attractors as attractors_drawn
    from lcpstep.plot.basins import basins as basins_drawn
    from lcpstep.plot.bifurcation import bifurcation as diagram_drawn
    from lcpstep.plot.motion import portraits, time_series
    from lcpstep.plot.sections import maps

    def make(**parameters):
        return replace(scenes.impact_oscillator(**parameters, t_end=1.0), coordinates=["x [mm]"])

    scene, method = make(), EventDriven()
    diagram = bifurcation(make, "omega", [2.8, 3.0], drop=5, keep=2)
    found = attractors(scene, method, [[0.0, 0.0]], transient=100, window=40, longest=8)
    basin = basins(scene, [-1.0, -1.0], [0.0, 1.0], (4, 4), known=found, sample=0)
    compared = [compare(scene, Located(1e-2), method)]
    units = {"q": "mm", "v": "mm/s", "impact_before": "mm/s", "impact_after": "mm/s"}
    for data in (diagram, basin, _dataset(scene, method, found, 0)):
        for name in units.keys() & set(data.variables):
            assert data[name].attrs["units"] == units[name]
    figures = (
        diagram_drawn(diagram, show=["speed", "position", "velocity"]),
        maps({"one": sections(scene, method, 4, 1)}, ""),
        attractors_drawn({"one": found.found}, "", [], scene.labels),
        basins_drawn(basin),
        orbits.orbit(periodic_orbit(scene, found.found[0].points[0], found.found[0].periods)),
        time_series(compared, [""]),
        portraits(compared, [""]),
    )
    told = [label for figure in figures for ax in figure.axes for label in (ax.get_xlabel(), ax.get_ylabel())]
    told += [*impact_labels(scene), str(simulate(scene, Located(1e-2), error=True).error)]
    assert sum("[mm" in x for x in told) == 20
    assert not [x for x in told if re.search(r"\[m\b|N s|J\b", x)]


def test_names_of_modes_cover_no_curve():
    from lcpstep.plot.figures import Figure

    scene = scenes.stick_slip_oscillator(amplitude=0.1)
    t = np.linspace(0.0, 2.0, 9)
    figure = Figure(layout="constrained")
    ax = figure.subplots()
    orbits.modes_panel(ax, scene, t, np.zeros((9, 2)), np.array(["stick"] * 4 + ["slower"] * 5))
    figure.draw_without_rendering()
    assert ax.get_legend().get_window_extent().y0 >= ax.get_window_extent().y1
    assert len({line.get_linestyle() for line in ax.get_lines()}) == 2


def test_a_new_mechanism_rests_on_its_floor(folder, capsys):
    """The first film that somebody makes: the bead's rim, and not its centre, meets the floor."""
    assert run(capsys, "new", "swing")[0] == DONE
    scene = own.made("swing.py", {})
    touching = np.arccos(0.45 / 0.5)
    assert abs(scene.gap(0.0, np.array([touching]), np.zeros(1))[0][0]) < 1e-12
    floor, _, bead = scene.drawing(0.0, np.array([touching]))
    assert floor.points[0][1] == pytest.approx(bead.centre[1] - bead.radius)
    assert "--set swing=" not in (folder / "swing.py").read_text()


def test_help_is_written_for_people():
    """A sign of per cent stands once, after its number."""
    (commands,) = (x for x in parser()._actions if isinstance(x, argparse._SubParsersAction))
    for command in commands.choices.values():
        assert not re.search(r"%%|%\(|[^0-9 ]%", command.format_help())


def test_a_measure_without_a_finite_value_has_no_panel():
    """Impacts that no other run has are infinitely late; on a logarithmic scale that is an empty panel."""
    level = {"method": "m", "settings": "", "dial": "h", "status": "DONE", "seconds": 1.0}
    levels = [
        Level(value=h, errors={"sup_position": h, "impact_time": np.inf},
              scatter={"sup_position": (h, h), "impact_time": (np.inf, np.inf)}, **level)
        for h in (0.1, 0.01)
    ]  # fmt: skip
    question = {"scene": "ball", "measures": ["sup_position", "impact_time"]}
    found = Study(question, "", {"impact_time": np.inf}, 1.0, "", levels=levels)
    shown = work_precision(found).axes
    assert [ax.get_ylabel() for ax in shown] == ["sup position", ""]


def test_each_mark_of_a_study_has_one_meaning():
    level = {"method": "m", "settings": "", "dial": "h", "status": "DONE", "seconds": 1.0}
    reasons = ({"limited": ("energy",)}, {"rounded": ("energy",)}, {"separated": True}, {})
    levels = [Level(value=0.1, errors={"energy": 1.0}, **level, **reason) for reason in reasons]
    told = str(Study({"scene": "ball", "measures": ["energy"]}, "", {}, 1.0, "", levels=levels)).splitlines()
    marks = [line.split("1.00e+00")[1] for line in told if "1.00e+00" in line]
    assert marks == ["~", "=", "!", ""]
    assert [line[0] for line in told if line[:2] in ("~ ", "= ", "! ")] == marks[:3]
