"""Commands for scenes with modes, and exponents of their motions."""

import json
import re

import numpy as np
import pytest

from lcpstep.cli import lyapunov
from lcpstep.cli.common import DONE, INTERRUPTED, USAGE
from tests.commands import run

DRIVEN = ("driven-bilinear-oscillator",)
STICKING = ("dry-friction-oscillator", "--set", "amplitude=0.9", "drag=0.4", "omega=0.3")
BLOCK = ("stick-slip-oscillator", "--set", "amplitude=0.3", "omega=0.9")


@pytest.mark.parametrize(
    ("arguments", "said", "written"),
    [
        (
            ("attractor", *STICKING, "--box", -1, 1, -1, 1, "--starts", 4, "--transient", 40, "--window", 24),
            "O(1, 4)              share 100.0%   switches per period        4", ["attractors.nc", "attractors.png"],
        ),
        (
            ("bifurcation", *BLOCK, "--parameter", "omega", "--range", 0.8, 0.95, "--points", 4, "--drop", 20,
             "--keep", 4),
            "32 switches recorded, at most 2 in a period", ["bifurcation.nc", "bifurcation.png"],
        ),
        pytest.param(
            ("orbit", *BLOCK, "--parameter", "omega", "--range", 0.85, 1.1, "--draw", "--transient", 60),
            "flip          at omega = 1.04123526", ["branch.nc", "branch.png", "orbit.png"], marks=pytest.mark.slow,
        ),
        pytest.param(
            ("basin", *STICKING, "--position", -1, 1, "--velocity", -1, 1, "--grid", 4, 4, "--longest", 30,
             "--sample", 4),
            "O(1, 4)              share 1.00000", ["basins.nc", "basins.png"], marks=pytest.mark.thorough,
        ),
        (("orbit", "stick-slip-oscillator", "--mode", "stick", "--transient", 3), "period 8.06888787159", []),
    ],
)  # fmt: skip
def test_commands_take_scenes_with_modes(capsys, tmp_path, arguments, said, written):
    status, out, _ = run(capsys, *arguments, "--out", tmp_path / "out")
    assert status == DONE
    assert said in out
    names = sorted(x.name for x in (tmp_path / "out").glob("*.*"))
    assert names == written


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (
            ("attractor", "stick-slip-oscillator", "--box", 0, 1, 0, 1),
            "'stick-slip-oscillator' has no period",
        ),
        (("basin", "hybrid-abs", "--position", 0, 1, "--velocity", 0, 1), "'hybrid-abs' has no period"),
        (("orbit", "dry-friction-oscillator"), "driven where its parameter amplitude is not zero"),
        (("bifurcation", *DRIVEN, "--parameter", "omga", "--range", 1, 2), "did you mean 'omega'"),
        (
            ("attractor", *DRIVEN, "--box", 0, 1, 0, 1, "--method", "moreau"),
            "has modes, and is run by event-driven",
        ),
        (
            ("attractor", *DRIVEN, "--box", 0, 1, 0, 1, "--compare", 9),
            "has modes, and is run by event-driven",
        ),
        (("orbit", *BLOCK, "--mode", "stik"), "did you mean 'stick'"),
        (("orbit", *BLOCK, "--mode", "stick", "--draw"), "--range and --draw go without it"),
        (("compare", *DRIVEN), "has modes and no contacts"),
        (("study", *DRIVEN), "has modes and no contacts"),
        (("corner", *DRIVEN, "--parameter", "omega"), "has modes and no contacts"),
        (("corner", "bouncing-ball"), "expected one whose obstacle has corners"),
        (("simulate", *DRIVEN, "--energy"), "no masses and forces to balance"),
        (("simulate", *DRIVEN, "--method", "moreau"), "does not treat systems with modes"),
        (("simulate", "driven-bilinear"), "did you mean 'driven-bilinear-oscillator'"),
        (("simulate", "hybrid-abs", "--set", "crossing=maybe"), "crossing: expected true or false"),
    ],
)
def test_what_scenes_with_modes_cannot_do_is_named(capsys, tmp_path, arguments, said):
    status, _, err = run(capsys, *arguments)
    assert status == USAGE
    assert said in err


def test_simulate_saves_states_modes_and_switches(capsys, tmp_path):
    file = tmp_path / "run.npz"
    arguments = ("simulate", "bilinear-oscillator", "--out", file, "--picture", tmp_path / "run.png")
    status, out, _ = run(capsys, *arguments)
    assert status == DONE
    assert "switches: 5 to left, 5 to right" in out
    saved = np.load(file)
    assert saved["x"].shape == (len(saved["t"]), 2)
    assert set(saved["mode"]) == {"left", "right"}
    assert len(saved["switches"]) == 10
    assert (tmp_path / "run.png").stat().st_size > 1000


def test_the_exponent_of_a_linear_oscillator_is_its_damping(capsys):
    linear = ("driven-bilinear-oscillator", "--set", "left=2", "right=2", "damping=0.4", "omega=1.3")
    status, out, _ = run(capsys, "lyapunov", *linear, "--transient", 5, "--periods", 400, "--json")
    assert status == DONE
    found = json.loads(out)
    assert found["verdict"] == "not chaotic"
    assert found["largest"] == pytest.approx(-0.2 * 2.0 * np.pi / 1.3, abs=5e-3)
    chattering = run(capsys, "lyapunov", "cam-follower", "--rpm", 150, "--transient", 20, "--periods", 20)
    assert "-inf" in chattering[1]
    assert "all deviations vanish in 20 of 20 periods" in chattering[1]
    for name, said in (("stick-slip-oscillator", "has no period"), ("bouncing-ball", "has no period")):
        status, _, err = run(capsys, "lyapunov", name)
        assert status == USAGE
        assert said in err


def test_an_exponent_that_is_interrupted_is_told_as_far_as_it_came(capsys, monkeypatch):
    begun = lyapunov.lyapunov

    def until_interrupted(*arguments, progress):
        def impatient(done, found, x):
            progress(done, found, x)
            if done >= 20:
                raise KeyboardInterrupt

        return begun(*arguments, progress=impatient)

    monkeypatch.setattr(lyapunov, "lyapunov", until_interrupted)
    command = ("lyapunov", "cam-follower", "--rpm", 660, "--transient", 10, "--periods", "1e8")
    status, out, err = run(capsys, *command)
    assert status == INTERRUPTED
    done = int(re.search(r"over (\d+) periods", out)[1])
    assert 20 <= done < 100_000_000
    assert f"kept: the exponent over {done} periods" in err
    assert f"--transient 0 --periods {100_000_000 - done}" in err
    monkeypatch.undo()
    for number in ("2.5", "inf", "many"):
        with pytest.raises(SystemExit):
            run(capsys, *command[:-1], number)
    whole = run(capsys, *command[:-1], done, "--json")
    assert f"exponent {json.loads(whole[1])['largest']:.6g} +-" in out
