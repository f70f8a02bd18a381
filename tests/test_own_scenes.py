"""Scenes in files: written, run, changed; and one line for each thing that can be wrong with them."""

import re

import numpy as np
import pytest

from lcpstep.cli.common import DONE, USAGE
from tests.commands import run


def test_a_new_scene_runs_as_it_stands_by_every_method(folder, capsys):
    assert run(capsys, "new", "swing")[0] == DONE
    ends = []
    for method in ("located", "event-driven", "moreau"):
        status, out, err = run(capsys, "simulate", "swing.py", "--method", method, "--out", f"{method}.npz")
        assert (status, err) == (DONE, "")
        assert "swing by" in out
        ends.append(np.load(f"{method}.npz")["q"][-1])
    assert ends[0] == pytest.approx(ends[1], abs=1e-4)
    status, out, _ = run(
        capsys, "simulate", "swing.py", "--set", "restitution=0", "angle=1", "--t-end", "0.5", "--json"
    )
    assert '"t_end": 0.5' in out
    from lcpstep.cli import own

    film = own.made("swing.py", {}).drawing(0.0, np.array([1.0]))
    assert len(film) == 3
    status, _, err = run(capsys, "new", "swing")
    assert status == USAGE
    assert "swing.py exists already" in err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("scene = 3", "has no function scene()"),
        ("def scene():\n    return 3", "is to return a lagrangian.Scene, not 3"),
        ("def scene():\n    x = 1\n    return x / 0", "mine.py, line 3: ZeroDivisionError"),
        ("import nothing_at_all", "mine.py, line 1: ModuleNotFoundError"),
        ("def scene(:", "mine.py, line 1: SyntaxError"),
        ("def scene(stiffness):\n    pass", "mine.py: TypeError"),
        ("import sys\nsys.exit()", "line 2: SystemExit"),
    ],
)
def test_what_is_wrong_with_a_file_is_said_in_one_line(folder, capsys, text, said):
    (folder / "mine.py").write_text(text)
    status, out, err = run(capsys, "simulate", "mine.py")
    assert (status, out) == (USAGE, "")
    assert said in err
    assert err.count("\n") == 1


def test_names_and_parameters(folder, capsys):
    assert (
        "there is no file 'nowhere.py'; lcpstep new nowhere writes one"
        in run(capsys, "simulate", "nowhere.py")[2]
    )
    run(capsys, "new", "swing")
    assert "did you mean 'angle'" in run(capsys, "simulate", "swing.py", "--set", "angel=1")[2]
    assert "angle: expected a number" in run(capsys, "simulate", "swing.py", "--set", "angle=x")[2]
    assert "expected letters, digits" in run(capsys, "new", "my-scene")[2]


def test_a_scene_may_import_its_neighbour_and_bear_the_name_of_a_module(folder, capsys):
    (folder / "beside.py").write_text("HEIGHT = 2.0\n")
    (folder / "json.py").write_text(
        "from beside import HEIGHT\nfrom lagrangian import LinearContacts, LinearSystem, Scene\n"
        "def scene(mass=1):\n"
        "    falling = LinearSystem(mass, force=-9.81)\n"
        "    return Scene(falling, HEIGHT, 0.0, (0.0, 1.0), LinearContacts(1.0))\n"
    )
    status, out, _ = run(capsys, "simulate", "json.py", "--json")
    assert status == DONE
    assert '"impact": 1' in out


DRIVEN = """
import math
from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene


def scene(omega=2.0, stop=0.0):
    return Scene(
        LinearSystem(1.0, C=0.1, K=1.0, force=Harmonic(cosine=1.0, omega=omega)), -0.5, 0.0, (0.0, 10.0),
        LinearContacts(-1.0, offset=stop, restitution=0.8), period=2.0 * math.pi / omega,
        parameters={"wall": stop}, name="driven",
    )
"""


@pytest.mark.slow
def test_other_commands_take_files_too(folder, capsys):
    (folder / "driven.py").write_text(DRIVEN)
    ready, mine = "impact-oscillator", "driven.py"
    found = {}
    for scene in (ready, mine):
        status, out, err = run(capsys, "orbit", scene, "--parameter", "omega", "--range", 1.95, 2.05, "--points", 5,
                               "--out", folder / f"out {scene}")  # fmt: skip
        assert (status, err) == (DONE, "")
        found[scene] = [line for line in out.splitlines() if "wrote" not in line]
        status, _, err = run(capsys, "bifurcation", scene, "--parameter", "omega", "--range", 1.95, 2.05, "--points",
                             3, "--out", folder / f"out {scene}")  # fmt: skip
        assert (status, err) == (DONE, "")
    assert found[ready] == found[mine]
    status, out, err = run(capsys, "compare", mine, "--h", 1e-3, "--no-pictures")
    assert (status, err) == (DONE, "")
    assert "event-driven at a tolerance of 1e-13" in out


def test_a_report_has_the_unit_of_length_of_the_scene(folder, capsys):
    (folder / "drop.py").write_text(
        "from lagrangian import LinearContacts, LinearSystem, Scene\n\n\ndef scene():\n"
        "    return Scene(LinearSystem(1.0, force=-9810.0), q0=10.0, v0=0.0, t_span=(0.0, 0.1),\n"
        "                 contacts=LinearContacts(1.0), coordinates=['height [mm]'])\n"
    )
    status, out, _ = run(capsys, "simulate", "drop.py", "--energy", "--method", "event-driven")
    assert status == DONE
    assert re.search(r"largest penetration \S+ mm\n", out)
    assert not re.search(r" (J|m)\b", out)


def test_a_film_of_a_scene_without_a_drawing_is_refused_before_the_run(folder, capsys):
    (folder / "bare.py").write_text(
        "from lagrangian import LinearSystem, Scene\n\n\ndef scene():\n"
        "    return Scene(LinearSystem(1.0), 0.0, 1.0, (0.0, 1.0))\n"
    )
    status, _, err = run(capsys, "simulate", "bare.py", "--film", "bare.gif", "--out", "bare.nc")
    assert status == USAGE
    assert "--film: 'scene' has no drawing" in err
    assert not (folder / "bare.nc").exists()
