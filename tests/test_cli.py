"""The command line as a user meets it: outputs, files, exit statuses, errors that name the argument."""

import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lagrangian import scenes
from lagrangian.scenes import SCENES
from lcpstep import EventDriven, Located, Moreau, cli, load, simulate
from lcpstep.cli.common import DONE, FAILED, INTERRUPTED, USAGE
from tests.commands import run


def test_scenes_are_listed_with_one_line_each(capsys):
    status, out, _ = run(capsys, "scenes", "--json")
    assert status == DONE
    listed = json.loads(out)
    assert [x["scene"] for x in listed] == list(SCENES)
    assert all(x["about"] and x["parameters"] for x in listed)


@pytest.mark.slow
def test_compare_measures_and_draws(capsys, tmp_path):
    status, out, _ = run(
        capsys, "compare", "cam-follower", "--rpm", 358, 700, "--h", 1e-4, "--t-end", 0.3,
        "--map-periods", 50, "--out", tmp_path, "--json",
    )  # fmt: skip
    assert status == DONE
    answer = json.loads(out)
    assert [c["case"] for c in answer["comparisons"]] == ["358 rpm", "700 rpm"]
    for c in answer["comparisons"]:
        moreau, second, fourth, exact = c["methods"]
        assert c["reference"] == "the motion in closed form"
        assert moreau["steps"] == second["steps"] == 3000
        assert moreau["impacts"] == second["impacts"] == fourth["impacts"] == exact["impacts"] > 0
        assert (
            0.1 > moreau["error"] > 100 * second["error"] > 1e4 * fourth["error"] > 0 < exact["error"] < 1e-10
        )
        assert 0.0 < second["first_impacts_off"] < moreau["first_impacts_off"] < 3e-3
        assert all(x["levels"][0]["error"] > 3 * x["levels"][-1]["error"] for x in (moreau, second, fourth))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["comparison.png", "maps-660-rpm.png"]


def test_compare_prints_a_table_and_how_to_read_it_for_any_scene(capsys):
    status, out, _ = run(capsys, "compare", "impact-oscillator", "--t-end", 10, "--h", 1e-3, "--no-pictures")
    assert status == DONE
    assert "impact-oscillator" in out
    table, sentences, further = out.split("\n\n")
    assert [line.split()[0] for line in table.splitlines()[3:]] == [
        "Moreau",
        "Located,",
        "Located,",
        "EventDriven",
    ]
    assert len(sentences.splitlines()) == 3
    assert "Try next: lcpstep simulate impact-oscillator" in further


def test_a_command_names_its_own_options_where_one_is_unknown(capsys):
    with pytest.raises(SystemExit) as ended:
        cli.main(["simulate", "cam-follower", "--rpm", "500"])
    assert ended.value.code == USAGE
    said = capsys.readouterr().err
    assert said.startswith("usage: lcpstep simulate ")
    assert said.endswith("lcpstep simulate: error: unrecognized arguments: --rpm 500\n")


@pytest.mark.slow
def test_a_reader_that_has_seen_enough_is_no_error():
    reading, writing = os.pipe()
    os.close(reading)
    words = [sys.executable, "-c", "from lcpstep.cli import command; command()", "scenes"]
    done = subprocess.run(words, stdout=writing, stderr=subprocess.PIPE, check=False)
    os.close(writing)
    assert (done.returncode, done.stderr) == (FAILED, b"")


def test_what_a_comparison_says_to_try_next_names_files_as_it_is_shown_elsewhere(capsys, tmp_path):
    file = tmp_path / "swing.py"
    assert run(capsys, "new", str(file)[:-3])[0] == DONE
    _, out, _ = run(capsys, "compare", file, "--t-end", 0.1, "--h", 1e-2, "--no-pictures")
    assert f"Try next: lcpstep simulate {file} --method located --film swing.gif " in out


@pytest.mark.parametrize(
    ("scene", "reference"),
    [("coulomb-oscillator", "closed form"), ("kane-pendulum", "event-driven at a tolerance")],
)
def test_compare_offers_all_methods_where_there_is_friction(capsys, scene, reference):
    status, out, _ = run(capsys, "compare", scene, "--h", 1e-3, "--no-pictures")
    assert status == DONE
    assert reference in out
    assert "left out: " not in out


def test_angles_are_not_metres(capsys):
    _, out, _ = run(capsys, "compare", "pendulum-stop", "--t-end", 1, "--h", 1e-3, "--no-pictures")
    assert "[rad]" in out
    assert "[m]" not in out


def test_simulate_saves_the_motion(capsys, tmp_path):
    file = tmp_path / "ball.npz"
    arguments = (
        "simulate",
        "bouncing-ball",
        "--method",
        "event-driven",
        "--set",
        "restitution=0.5",
        "--out",
        file,
    )
    assert run(capsys, *arguments, "--picture", tmp_path / "new" / "ball.png")[0] == DONE
    saved = np.load(file)
    assert saved["t"][-1] == 5.0
    assert json.loads(str(saved["summary"]))["parameters"]["restitution"] == 0.5
    assert (tmp_path / "new" / "ball.png").stat().st_size > 1000
    status, _, err = run(capsys, *arguments)
    assert status == USAGE
    assert "exists already" in err


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["simulate", "bouncing-bal"], "did you mean 'bouncing-ball'"),
        (["simulate", "bouncing-ball", "--h", "0"], "h: expected a positive number"),
        (["simulate", "bouncing-ball", "--picture", "x.foo"], "--picture: expected a name that ends in .png"),
        (["simulate", "bouncing-ball", "--film", "x.avi"], "--film: expected a name that ends in .gif"),
        (["run", "missing.toml"], "there is no file 'missing.toml'"),
        (["simulate", "bouncing-ball", "--h", "nan"], "h: expected a finite number"),
        (["simulate", "bouncing-ball", "--theta", "1.5"], "theta: expected a value in [0, 1]"),
        (["simulate", "bouncing-ball", "--lcp", "lemkes"], "did you mean 'lemke'"),
        (["simulate", "bouncing-ball", "--set", "restitution=2"], "restitution: expected a value in [0, 1]"),
        (["simulate", "bouncing-ball", "--set", "bounce=2"], "unknown parameter of bouncing-ball 'bounce'"),
        (["simulate", "bouncing-ball", "--set", "h0=-1"], "q0: the initial state lies inside the obstacle"),
        (["simulate", "bouncing-ball", "--t-end", "-1"], "t_end: expected a positive number"),
        (["compare", "bouncing-ball", "--rpm", "3"], "--rpm"),
    ],
)
def test_wrong_arguments_are_named(capsys, arguments, said):
    status, _, err = run(capsys, *arguments)
    assert status == USAGE
    assert said in err


def test_every_set_counts_and_none_twice(capsys):
    """The last --set had replaced those before, and --set rpm=700 had run beside the name of another speed."""
    _, out, _ = run(
        capsys, "simulate", "bouncing-ball", "--h", 0.1, "--set", "restitution=0.5", "--set", "h0=2", "--json"
    )
    parameters = json.loads(out)["parameters"]
    assert (parameters["restitution"], parameters["h0"]) == (0.5, 2.0)
    for words, said in (
        ("simulate bouncing-ball --set h0=2 --set h0=3", "h0 is set twice, to 2 and 3"),
        ("simulate bouncing-ball --set t_end=2 --t-end 3", "t_end is set by the command itself here, or by"),
        ("compare cam-follower --rpm 358 --set rpm=700", "rpm is set by the command itself here, or by"),
        ("map logistic --set r=3 r=3.5", "r is set twice"),
    ):
        status, _, err = run(capsys, *words.split())
        assert (status, err.startswith(f"lcpstep: --set: {said}")) == (USAGE, True), err


def test_a_folder_in_the_place_of_a_file_is_told_before_the_run(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(cli.simulate, "simulate", lambda *a, **b: pytest.fail("it ran"))
    for option, name in (("--out", "x.nc"), ("--picture", "x.png"), ("--film", "x.gif")):
        (tmp_path / name).mkdir()
        status, _, err = run(
            capsys,
            "simulate",
            "pendulum-stop",
            option,
            tmp_path / name,
            *(["--overwrite"] * (name == "x.nc")),
        )
        assert status == USAGE
        assert f"{option}: {tmp_path / name} is a folder" in err


@pytest.mark.parametrize("unit", [1e3, 1.0, 1e-6])
@pytest.mark.parametrize("method", ["moreau", "located"])
def test_a_scene_has_as_many_steps_in_any_unit_of_time(capsys, tmp_path, unit, method):
    file = tmp_path / "ball.py"
    file.write_text(
        "from lagrangian import LinearContacts, LinearSystem, Scene\n"
        "def scene():\n"
        f"    ball = LinearSystem(M=1.0, force=-9.81 / {unit}**2)\n"
        f"    return Scene(ball, 1.0, 0.0, (0.0, 2.0 * {unit}), LinearContacts(G=1.0, restitution=0.5))\n"
    )
    status, out, _ = run(capsys, "simulate", file, "--method", method, "--json")
    assert (status, json.loads(out)["steps"]) == (DONE, 20_000)


def test_a_period_of_the_forcing_has_500_steps_at_least(capsys):
    arguments = "simulate", "impact-oscillator", "--t-end", 200.0, "--json"  # 800/pi periods of 500 steps
    _, out, _ = run(capsys, *arguments, "--set", "omega=8")
    assert json.loads(out)["steps"] == math.ceil(200.0 / (2.0 * math.pi / 8.0) * 500)
    _, out, _ = run(capsys, *arguments, "--h", 0.01)
    assert json.loads(out)["steps"] == 20_000


def test_a_motion_without_impacts_has_a_picture(capsys, tmp_path):
    picture = tmp_path / "flight.png"
    status, _, err = run(capsys, "simulate", "bouncing-ball", "--t-end", "0.1", "--picture", picture)
    assert (status, err) == (0, "")
    assert picture.stat().st_size > 0


def test_a_run_that_ends_early_is_a_failure(capsys, monkeypatch):
    monkeypatch.setitem(cli.simulate.METHODS, "event-driven", lambda *given: EventDriven(max_events=3))
    status, out, _ = run(capsys, "simulate", "cam-follower", "--method", "event-driven", "--json")
    assert status == FAILED
    assert json.loads(out)["status"] == "TOO_MANY_EVENTS"


def test_an_interrupt_saves_what_was_computed(capsys, tmp_path, monkeypatch):
    from contextlib import contextmanager

    @contextmanager
    def impatient(scene, title):
        def stop(t):
            if t > 2.0:
                raise KeyboardInterrupt

        yield stop

    monkeypatch.setattr(cli.simulate, "progress_bar", impatient)
    file = tmp_path / "part.npz"
    status, _, err = run(capsys, "simulate", "bouncing-ball", "--h", 2e-5, "--out", file)
    assert status == INTERRUPTED
    assert "interrupted" in err
    saved = np.load(file)
    assert 2.0 < saved["t"][-1] < 5.0
    assert json.loads(str(saved["summary"]))["status"] == "INTERRUPTED"


@pytest.mark.parametrize(
    ("method", "option", "said"),
    [
        ("moreau", ["--order", "4"], "--order: moreau has none, it belongs to located"),
        ("event-driven", ["--theta", "1"], "--theta: event-driven has none, it belongs to moreau"),
        ("located", ["--lcp", "lemke"], "--lcp: located has none, it belongs to moreau"),
        ("event-driven", ["--h", "1e-3"], "--h: event-driven has none, it belongs to moreau and located"),
    ],
)
def test_options_of_other_methods_are_refused(capsys, method, option, said):
    status, _, err = run(capsys, "simulate", "bouncing-ball", "--method", method, *option)
    assert status == USAGE
    assert said in err


@pytest.mark.slow
def test_motions_are_saved_as_what_their_names_say(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("ball.csv", "ball.nc", "ball"):
        status, out, _ = run(
            capsys, "simulate", "bouncing-ball", "--t-end", "0.1", "--h", "0.01", "--out", name
        )
        assert status == DONE
        assert f"wrote {name}" in out
    lines = (tmp_path / "ball.csv").read_text().splitlines()
    assert lines[0] == "t,q0,v0,impulse0"
    assert len(lines) == 12
    assert load("ball.nc").q[-1] == pytest.approx(1.0 - 0.5 * 9.81 * 0.01, abs=1e-12)
    status, _, err = run(capsys, "simulate", "bouncing-ball", "--out", "ball.xlsx")
    assert status == USAGE
    assert "--out: expected a name that ends in .npz, .nc, .csv" in err


def test_an_overview_names_its_curves_and_their_units():
    figure = simulate(scenes.double_pendulum(t_end=1.0), Located(1e-2)).plot()
    position, _, impulse = figure.axes
    assert [ax.get_ylabel() for ax in figure.axes] == [
        "angle [rad]",
        "angular velocity [rad/s]",
        "impulse [N s]",
    ]
    assert [x.get_text() for x in position.get_legend().get_texts()] == ["angle 1", "angle 2"]
    assert impulse.get_legend() is None
    mixed, *_ = simulate(scenes.slipping_wheel(), Moreau(1e-2)).plot().axes
    assert [x.get_text() for x in mixed.get_legend().get_texts()] == ["x [m]", "height [m]", "angle [rad]"]
    *_, many = simulate(scenes.elastic_gas(n=12), EventDriven()).plot().axes
    assert many.get_legend().get_texts()[-1].get_text() == "contact 7, and 5 more"


def test_an_overview_of_some_kept_states_draws_these():
    for keep in (7, [0.0, 0.2, 0.5], "impacts"):
        for method in (Moreau(1e-2), Located(1e-2), EventDriven()):
            motion = simulate(scenes.bouncing_ball(t_end=1.0), method, keep=keep)
            position, *_ = motion.plot().axes
            assert len(position.get_lines()[0].get_xdata()) >= len(motion.t)


def test_where_nothing_may_be_written_one_line_says_so(folder, capsys, monkeypatch):
    """A folder that cannot be made, and a file that cannot be written, by name and with what to do."""

    def forbidden(*_, **__):
        raise PermissionError(13, "Permission denied", "closed")

    for words in ("thesis 2 --out closed", "study bouncing-ball --h 1e-2 --out closed"):
        with monkeypatch.context() as patch:
            patch.setattr(Path, "mkdir", forbidden)
            status, _, err = run(capsys, *words.split())
        assert status == USAGE
        assert err.count("\n") == 1
        assert re.search(
            r"^lcpstep: closed\S*( could not be written)?: Permission denied; choose another place", err
        )


def test_negative_numbers_may_have_an_exponent(capsys, tmp_path):
    small = [
        "--set",
        "amplitude=1e-6",
        "stop=2e-7",
        "--box",
        "-1e-6",
        "-2e-7",
        "-1e-6",
        "1e-6",
        "--starts",
        "2",
    ]
    done, out, _ = run(
        capsys, "attractor", "impact-oscillator", *small, "--transient", "50", "--out", tmp_path
    )
    assert done == DONE, out
    assert "O(1, 1)" in out
