"""A scene as a functional mock-up unit, stepped by FMPy: the outputs are those of one run."""

import re
import sys
from zipfile import ZipFile

import numpy as np
import pytest

from lagrangian import scenes
from lcpstep import EventDriven, LcpStepError, Located, simulate
from lcpstep.export import Motion, fmu, let_go_at_exit
from tests.processes import python

STEP = 0.1


def test_a_motion_goes_on_beyond_its_span_as_one_run():
    ball = scenes.bouncing_ball(t_end=1.0)
    motion, whole = Motion(ball, Located(1e-3)), simulate(scenes.bouncing_ball(t_end=7.0), Located(1e-3))
    impacts = whole.impacts[whole.impacts.kind == 0]
    for t in (0.03, 0.5, 1.0, 1.7, 1.1, 6.9):
        motion.go_to(t)
        q, v = whole.at(t)
        past = impacts[impacts.time <= t]
        assert motion.value("q0") == pytest.approx(q[0], abs=1e-15)
        assert motion.value("v0") == pytest.approx(v[0], abs=1e-14)
        assert motion.value("impacts") == len(past)
        assert motion.value("impulse0") == pytest.approx(np.sum(past.impulse), rel=1e-14)
    assert motion.value("q0") == 0.0


def test_a_run_that_ends_early_is_an_error_from_there_on():
    motion = Motion(scenes.bouncing_ball(), EventDriven(max_events=2))
    motion.go_to(0.5)
    assert not motion.ended(0.5)
    motion.go_to(4.0)
    assert motion.ended(4.0)


def test_what_is_refused(tmp_path, monkeypatch):
    with pytest.raises(TypeError, match="scene: expected a Scene"):
        fmu(3, tmp_path / "ball.fmu")
    with pytest.raises(ValueError, match=r"path: expected a name that ends in \.fmu"):
        fmu(scenes.bouncing_ball(), tmp_path / "ball.zip")
    monkeypatch.setitem(sys.modules, "pythonfmu3", None)
    monkeypatch.setitem(sys.modules, "pythonfmu3.builder", None)
    with pytest.raises(LcpStepError, match=r'needs pythonfmu3: pip install "lcpstep\[fmu\]"'):
        fmu(scenes.bouncing_ball(), tmp_path / "ball.fmu")


RUN = """
import numpy as np, fmpy
r = fmpy.simulate_fmu({file!r}, stop_time={stop}, output_interval=0.1)
for row in r:
    print(*(repr(float(row[name])) for name in ("time", "q0", "v0", "impacts")))
"""


def stepped(file, stop):
    """What FMPy gets of a unit: rows of time, q0, v0, impacts."""
    text = python(RUN.format(file=str(file), stop=stop))
    return np.array([[float(x) for x in line.split()] for line in text.splitlines()])


def test_a_run_by_fmpy_is_the_run_by_located_and_comes_to_rest(tmp_path):
    pytest.importorskip("pythonfmu3")
    pytest.importorskip("fmpy")
    scene = scenes.bouncing_ball()
    got = stepped(fmu(scene, tmp_path / "ball.fmu"), 6.0)
    run = simulate(scenes.bouncing_ball(t_end=6.0), Located(5e-3))
    assert len(got) == 61
    q, v = run.at(got[:, 0])
    assert got[:, 1] == pytest.approx(q[:, 0], abs=1e-12)
    assert got[:, 2] == pytest.approx(v[:, 0], abs=1e-12)
    assert tuple(got[-1, 1:3]) == (0.0, 0.0)
    assert got[-1, 3] > 10


SEVERAL = """
import fmpy
from lagrangian import scenes
from lcpstep.export import fmu
for h0, name in ((1.0, "ball"), (2.0, "ball"), (3.0, "numpy"), (4.0, "3 bälle")):
    file = fmu(scenes.bouncing_ball(h0=h0), f"{name}.fmu")
    print(fmpy.simulate_fmu(str(file), stop_time=0.1)["q0"][-1])
"""


@pytest.mark.slow
def test_units_in_one_python_are_each_their_own_whatever_their_names(tmp_path):
    pytest.importorskip("pythonfmu3")
    pytest.importorskip("fmpy")
    fallen = 0.5 * 9.81 * 0.1**2
    assert [float(x) + fallen for x in python(SEVERAL, cwd=tmp_path).split()] == pytest.approx(
        [1.0, 2.0, 3.0, 4.0]
    )


@pytest.mark.parametrize("name", ["ball", "3 bälle", "class", "pickle", "numpy"])
def test_a_unit_has_a_module_of_its_own_and_a_name_that_is_one(tmp_path, name):
    pytest.importorskip("pythonfmu3")
    modules = set()
    for height in (1.0, 2.0):
        file = fmu(scenes.bouncing_ball(h0=height), tmp_path / "new" / f"{name}.fmu")
        with ZipFile(file) as unit:
            modules.add(unit.read("resources/slavemodule.txt"))
            described = unit.read("modelDescription.xml").decode()
        assert re.fullmatch(r"[A-Za-z_]\w*", re.search('modelIdentifier="(.*?)"', described)[1], re.ASCII)
    assert len(modules) == 2
    assert name.encode() not in modules


ENDS = """
import atexit
called, register = [], atexit.register
atexit.register = lambda f, *rest: (called.append(getattr(f, "__name__", "")), register(f, *rest))[1]
import fmpy
fmpy.simulate_fmu({file!r}, stop_time=0.1, output_interval=0.1)
print(called.count("finalizePythonInterpreter"))
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="the library lets go twice under Linux only")
def test_the_library_lets_go_of_python_before_the_process_ends(tmp_path):
    pytest.importorskip("pythonfmu3")
    pytest.importorskip("fmpy")
    file = fmu(scenes.bouncing_ball(), tmp_path / "ball.fmu")
    assert python(ENDS.format(file=str(file))) == "1"


def test_where_no_library_is_loaded_nothing_is_let_go(tmp_path, monkeypatch):
    folder = tmp_path / "binaries" / "x86_64-linux"
    folder.mkdir(parents=True)
    (folder / "other.so").write_bytes(b"")
    registered = []
    monkeypatch.setattr("atexit.register", registered.append)
    let_go_at_exit(str(tmp_path / "resources"))
    assert registered == []


@pytest.mark.slow
def test_functions_of_ones_own_go_along(tmp_path, monkeypatch):
    pytest.importorskip("pythonfmu3")
    pytest.importorskip("fmpy")
    from lcpstep.cli import main, own

    monkeypatch.chdir(tmp_path)
    assert main(["new", "swing_of_mine"]) == 0
    scene = own.made("swing_of_mine.py", {})
    file = fmu(scene, tmp_path / "swing.fmu")
    (tmp_path / "swing_of_mine.py").unlink()
    got = stepped(file, 2.0)
    q, _ = simulate(scene, Located(5e-3)).at(got[:, 0])
    assert got[:, 1] == pytest.approx(q[:, 0], abs=1e-12)


def test_a_unit_moves_by_friction():
    from lcpstep.export import Motion

    scene = scenes.coulomb_oscillator()
    motion = Motion(scene, Located(1e-3))
    motion.go_to(19.0)
    assert motion.value("q0") == pytest.approx(-0.05, abs=1e-5)
    assert motion.value("v0") == 0.0
