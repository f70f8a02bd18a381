"""Parameter studies as text: read, run, carried by their results; what is not understood is named."""

import numpy as np
import pytest
import xarray

from lagrangian import scenes
from lcpstep import Moreau, UnknownName, load, parameters, simulate
from lcpstep.cli.common import DONE, FAILED, INTERRUPTED, USAGE
from lcpstep.parameters import ParameterStudy
from tests.commands import run

TEXT = """
scene = "bouncing-ball"
t_end = 0.6

[method]
name = "event-driven"

[parameters]
g = 8.0

[sweep]
restitution = [0.25, 0.5]
h0 = { from = 0.25, to = 1.0, points = 4 }

[outputs]
measures = ["impacts", "strongest", "q_end"]
"""
FILES = 'file = "out.nc"\ntable = "out.csv"\npicture = "out.png"\nruns = "runs"\n'


@pytest.mark.slow
def test_a_study_is_run_over_all_combinations_and_its_result_carries_it(folder, capsys):
    (folder / "study.toml").write_text(TEXT + FILES)
    status, _, err = run(capsys, "run", "study.toml")
    assert (status, err) == (DONE, "")
    with xarray.open_dataset("out.nc") as data:
        assert data.attrs["study"] == TEXT + FILES
        assert data.strongest.dims == ("restitution", "h0")
        assert data.strongest.attrs["units"] == "N s"
        for r in (0.25, 0.5):
            for h0 in (0.25, 0.5, 0.75, 1.0):
                speed = np.sqrt(2.0 * 8.0 * h0)
                impulse = (1.0 + r) * speed if speed / 8.0 < 0.6 else 0.0
                assert float(data.strongest.sel(restitution=r, h0=h0)) == pytest.approx(impulse, rel=1e-12)
        again = ParameterStudy.read(data.attrs["study"])
    assert again == ParameterStudy.read(TEXT + FILES)
    assert (folder / "out.png").stat().st_size > 1000
    assert (folder / "out.csv").read_text().startswith("# \n# scene = ")
    runs = sorted((folder / "runs").iterdir())
    assert len(runs) == 8
    assert load(runs[5]).scene.parameters["h0"] == 0.5
    status, _, err = run(capsys, "run", "study.toml")
    assert status == USAGE
    assert "out.nc exists already; --overwrite replaces it" in err
    assert run(capsys, "run", "study.toml", "--overwrite")[0] == DONE


def test_a_study_that_was_interrupted_goes_on_with_the_runs_there_are(folder, capsys, monkeypatch):
    (folder / "study.toml").write_text(TEXT + 'file = "out.nc"\nruns = "runs"\n')
    calls = 0

    def third(*given, **named):
        nonlocal calls
        calls += 1
        if calls == 3:
            raise KeyboardInterrupt
        return simulate(*given, **named)

    monkeypatch.setattr(parameters, "simulate", third)
    status, _, err = run(capsys, "run", "study.toml")
    assert status == INTERRUPTED
    assert err.splitlines()[-2:] == [
        "lcpstep: kept: 2 runs in runs",
        "lcpstep: go on with: lcpstep run study.toml",
    ]
    assert run(capsys, "run", "study.toml")[0] == DONE
    assert calls == 3 + 6  # 8 runs, two of which there were
    with xarray.open_dataset("out.nc") as data:
        before = data.load()
    (folder / "out.nc").unlink()
    assert run(capsys, "run", "study.toml")[0] == DONE
    assert calls == 3 + 6
    with xarray.open_dataset("out.nc") as data:
        xarray.testing.assert_identical(data.drop_attrs(), before.drop_attrs())
    (folder / "out.nc").unlink()
    (folder / "study.toml").write_text((TEXT + 'runs = "runs"\n').replace("t_end = 0.6", "t_end = 0.5"))
    status, _, err = run(capsys, "run", "study.toml")
    assert status == USAGE
    assert "run-0000.nc: no run of this study; --overwrite replaces it (scene: it is not the one" in err


def test_own_scenes_and_runs_that_fail(folder, capsys):
    run(capsys, "new", "swing")
    method = '[method]\nname = "event-driven"\nmax_events = 1\n'
    (folder / "study.toml").write_text(
        f'scene = "swing.py"\nt_end = 1.0\n{method}[sweep]\nangle = [0.5, 2.0]\n'
    )
    status, out, _ = run(capsys, "run", "study.toml")
    assert status == FAILED
    assert out.count("TOO_MANY_EVENTS") + out.count("DONE") == 2


def test_a_study_without_a_sweep_is_one_run():
    study = ParameterStudy.read('scene = "bouncing-ball"')
    assert study.points == [{}]
    assert ParameterStudy.read('scene = "x"\n[sweep]\na = {from=1, to=100, points=3, scale="log"}').sweep == {
        "a": [1.0, 10.0, 100.0]
    }
    text = 'scene = "bouncing-ball"\nt_end = 0.5\n[outputs]\nmeasures = ["impacts", "q_end"]'
    found = ParameterStudy.read(text).run(lambda _: scenes.bouncing_ball(t_end=0.5))
    assert found.impacts.shape == ()
    assert found.q_end.shape == (1,)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("t_end", "t_ends"), "unknown key of study: 't_ends'; did you mean 't_end'"),
        (("[sweep]", "[sweeps]"), "did you mean 'sweep'"),
        (("measures", "measure"), "did you mean 'measures'"),
        (('"impacts"', '"impact"'), "unknown measure of study: .outputs.: 'impact'; did you mean 'impacts'"),
        (("event-driven", "event"), "did you mean 'event-driven'"),
        (
            ('"event-driven"', '"located"\nhh = 1'),
            "unknown key of study: .method. located: 'hh'; did you mean 'h'",
        ),
        (("points", "point"), "did you mean 'points'"),
        (("points = 4", "points = 4, scale = 'logs'"), "did you mean 'log'"),
        (("[0.25, 0.5]", "0.5"), r"\[sweep\]: restitution: expected a list of values"),
        (("[0.25, 0.5]", "[[0.25]]"), r"\[sweep\]: restitution: expected a number, true, false or a text"),
        (("g = 8.0", "g = [8.0]"), r"\[parameters\]: g: expected a number, true, false or a text"),
        (("measures", "table = 3\nmeasures"), r"\[outputs\]: table: expected the name of a file, got 3"),
        (("points = 4", "points = 0"), "points: expected a positive integer"),
        (("from = 0.25, ", ""), "from: missing"),
        (("t_end = 0.6", "t_end = -1"), "t_end: expected a positive number"),
        (("g = 8.0", "h0 = 8.0"), r"h0: given in \[parameters\] and in \[sweep\]"),
        (('"bouncing-ball"', "3"), "scene: expected a name"),
        (("[method]", "[method"), "no TOML"),
    ],
)
def test_what_is_not_understood_is_named(change, said):
    with pytest.raises((UnknownName, ValueError), match=said):
        ParameterStudy.read(TEXT.replace(*change))


def test_the_encoding_of_a_file_is_no_matter_of_the_machine(folder, capsys):
    file = folder / "study.toml"
    text = '# Stoßzahl\nscene = "bouncing-ball"\nt_end = 0.1\n'
    file.write_bytes(text.encode("utf-8-sig"))  # as an editor of Windows writes it
    assert run(capsys, "run", "study.toml")[0] == DONE
    file.write_bytes(text.encode("latin-1"))
    status, _, err = run(capsys, "run", "study.toml")
    assert (status, err.startswith("lcpstep: study.toml: no TOML: 'utf-8'")) == (USAGE, True)


def test_parameters_that_the_scene_does_not_have(folder, capsys):
    (folder / "study.toml").write_text(TEXT.replace("restitution", "restitutions"))
    status, _, err = run(capsys, "run", "study.toml")
    assert status == USAGE
    assert "unknown parameter of bouncing-ball 'restitutions'; did you mean 'restitution'" in err
    assert "there is no file 'nothing.toml'" in run(capsys, "run", "nothing.toml")[2]
    (folder / "study.toml").write_text('scene = "hybrid-abs"')
    assert "has modes; parameter studies take scenes with contacts" in run(capsys, "run", "study.toml")[2]


def test_error_bars_of_every_run_are_measures_too(folder, capsys):
    measures = '"position_error", "impact_time_error", "known_until"'
    text = (
        TEXT.replace('"event-driven"', '"moreau"\nh = 1e-3').replace('"q_end"', measures)
        + 'file = "out.nc"\n'
    )
    (folder / "study.toml").write_text(text)
    status, out, _ = run(capsys, "run", "study.toml")
    assert status == DONE
    assert "position_error" in out
    with xarray.open_dataset("out.nc") as data:
        assert data.position_error.attrs["units"] == "m"
        assert data.impact_time_error.attrs["units"] == "s"
        for r in (0.25, 0.5):
            for h0 in (0.25, 0.5, 0.75):
                told = data.sel(restitution=r, h0=h0)
                ball = scenes.bouncing_ball(g=8.0, restitution=r, h0=h0, t_end=0.6)
                one = simulate(ball, Moreau(1e-3))
                error = np.max(np.abs(one.q - ball.exact(one.t)[0]))
                assert 0.5 < error / told.position_error < 2.0
                assert told.known_until == 0.6
                assert 0.0 < told.impact_time_error < 0.01


def test_a_picture_without_a_sweep_is_refused_before_the_run(folder, capsys):
    (folder / "one.toml").write_text('scene = "bouncing-ball"\n[outputs]\npicture = "one.png"\n')
    status, out, err = run(capsys, "run", "one.toml")
    assert (status, out) == (USAGE, "")
    assert "one.toml: [outputs]: picture: expected a parameter in [sweep] to draw over" in err


def test_names_and_shapes_that_make_no_array_are_refused_before_any_run():
    def beads(values):
        return scenes.elastic_gas(n=int(values.get("n", 2)))

    for sweep, measures, said in (
        ("n = [2, 3]", '["impacts", "q_end"]', "measures: q_end: the scenes have 2, 3 coordinates"),
        ("steps = [2, 3]", '["steps"]', "parameter: .* 'steps'"),
        ("status = [2, 3]", '["impacts"]', "parameter: .* 'status'"),
    ):
        text = f'scene = "elastic-gas"\n[sweep]\n{sweep}\n[outputs]\nmeasures = {measures}\n'
        with pytest.raises(ValueError, match=said):
            ParameterStudy.read(text).run(beads, kept=lambda *_: pytest.fail("a run was made"))
