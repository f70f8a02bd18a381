"""Ctrl-C in every command: it ends soon, says what was kept and how to go on, with exit status 130."""

import argparse
import importlib
import itertools
import shlex
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from lcpstep import cli
from lcpstep.cli import interrupt
from tests.marks import shared
from tests.processes import environment

READY = "import sys; from lcpstep.cli import command; print('ready', flush=True); command()"
AFTER = 0.5  # of a command's start [s]: long enough for it to be at work, where the machine is not busy
LIMIT = 5.0  # [s]; one second on a machine that is not busy
LONG = {
    "compare": "cam-follower --h 1e-7",
    "simulate": "cam-follower --h 1e-7 --t-end 100 --every 1000 --out motion",
    "study": "cam-follower --out out",
    "hard": "--full",
    "attractor": "cam-follower --starts 100000",
    "bifurcation": "cam-follower --window 660-760 --points 40000 --jobs 2",
    "basin": "cam-follower --rpm 358.5 --grid 2000 2000",
    "orbit": "cam-follower --rpm 700 --range 500 760 --points 4000",
    "corner": "cam-follower --points 20000 --out out",
    "abs": "--grid 400 --out out",
    "thesis": "",
    "lyapunov": "cam-follower --rpm 660 --periods 100000000",
    "run": "study.toml",
    "explore": "bouncing-ball --no-browser --port 50617",
    "map": "logistic --parameter r --range 2.8 4 --points 4000000 --out out",
}
ENDS_AT_ONCE = {"scenes", "new"}
STUDY = 'scene = "cam-follower"\nt_end = 100.0\n[method]\nh = 1e-7\n[outputs]\nruns = "runs"'
SLOW_LOOPS = {
    "adaptive": "simulate impact-oscillator --t-end 1e4 --h 1e-3 --tolerance 1e-2",
    "located": "simulate cam-follower --method located --t-end 100 --h 1e-6",
    "located, order 4": "simulate cam-follower --method located --order 4 --t-end 100 --h 1e-6",
    "event-driven": "simulate elastic-gas --method event-driven --t-end 1e5",
    "time-stepping": "basin cam-follower --rpm 358.5 --grid 300 300 --method moreau --h 1e-6",
}


def interrupted(words, folder, after, again=None):
    """Run a command, interrupt it after a time or a first file, and again; what it said, and how soon it ended."""
    process = subprocess.Popen(
        [sys.executable, "-c", READY, *words], cwd=folder, env=environment(),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert process.stdout.readline() == "ready\n"
        if isinstance(after, str):
            while process.poll() is None and not any(folder.rglob(after)):
                time.sleep(0.01)
        else:
            time.sleep(after)
        begin = time.perf_counter()
        process.send_signal(signal.SIGINT)
        if again is not None:
            time.sleep(again)
            process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    signalled = interrupt.INTERRUPTED if again is None else -signal.SIGINT  # which a shell calls 130 too
    assert process.returncode in {interrupt.INTERRUPTED, signalled}, err
    assert "Traceback" not in err
    return out, err, time.perf_counter() - begin


LOADING = """
import sys, time

class Slow:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == {module!r}:
            print("ready", flush=True)
            time.sleep(60)

import lcpstep.command
sys.meta_path.insert(0, Slow)
sys.argv[1:] = ["hard", "--full"]
lcpstep.command.run()
"""


@pytest.mark.parametrize("module", ["lcpstep.cli", "argparse", "lcpstep.cli.hard"])
def test_an_interrupt_while_modules_are_loaded_is_answered_without_a_traceback(module, tmp_path):
    process = subprocess.Popen(
        [sys.executable, "-c", LOADING.format(module=module)], cwd=tmp_path, env=environment(),
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
    finally:
        process.kill()
    assert process.returncode == interrupt.INTERRUPTED
    assert "Traceback" not in err
    assert said(err, "kept") == "nothing"
    assert said(err, "start again with") == "lcpstep hard --full"


FINALIZED = """
import argparse, os, signal, sys, time, weakref
from lcpstep.cli import interrupt

class Thing:
    pass

def struck():
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(0.01)

def main():
    thing = Thing()
    weakref.finalize(thing, struck)
    try:
        del thing
        time.sleep(0.5)
    except KeyboardInterrupt:
        print("heard")
        return interrupt.report()

interrupt.begin(argparse.Namespace(), [])
sys.exit(interrupt.ending(main))
"""


@pytest.mark.slow
def test_an_interrupt_in_a_finalizer_is_raised_when_that_is_over():
    """Python drops it there, and prints a traceback; the command was ended from outside, whatever it had to save."""
    done = subprocess.run(
        [sys.executable, "-c", FINALIZED], env=environment(), capture_output=True, text=True, timeout=60
    )
    assert done.returncode == interrupt.INTERRUPTED
    assert done.stdout == "heard\n"
    assert "Traceback" not in done.stderr


def said(err, what):
    """What a command says after these words."""
    return next(
        line.partition(f"{what}: ")[2] for line in err.splitlines() if line.startswith(f"lcpstep: {what}: ")
    )


@pytest.mark.parametrize("command", shared(LONG, 5))
def test_every_command_ends_soon_and_says_how_to_go_on(command, tmp_path):
    words = [command, *LONG[command].split()]
    (tmp_path / "study.toml").write_text(STUDY)
    _, err, seconds = interrupted(words, tmp_path, AFTER)
    assert seconds < LIMIT
    nothing = said(err, "kept") == "nothing"
    again = "lcpstep: go on with: " in err
    assert not (nothing and again)
    suggested = shlex.split(said(err, "go on with" if again else "start again with"))
    assert suggested[:2] == ["lcpstep", command]
    cli.parser().parse_args(suggested[1:])
    assert not list(tmp_path.rglob("*.partial*"))


def test_no_command_is_left_out():
    (commands,) = (x for x in cli.parser()._actions if isinstance(x, argparse._SubParsersAction))
    assert set(commands.choices) == set(LONG) | ENDS_AT_ONCE


def test_hard_cases_that_are_interrupted_go_on_with_the_scene_of_the_last_line(capsys, monkeypatch):
    table = importlib.import_module("lcpstep.hard.table")
    run_check, begun = table.run_check, []

    def impatient(check, method, bars):
        begun.append(check.scene)
        if len(begun) == 3:
            raise KeyboardInterrupt
        return run_check(check, method, bars)

    monkeypatch.setattr(table, "run_check", impatient)
    words = ["hard", "--scene", "dyadic-ball", "bouncing-ball", "--method", "located"]
    assert cli.main(words) == interrupt.INTERRUPTED
    out, err = capsys.readouterr()
    assert len(out.splitlines()) == 2
    assert said(err, "kept") == "the 2 lines above"
    assert begun[1] == "bouncing-ball"
    assert said(err, "go on with") == "lcpstep hard --scene bouncing-ball dyadic-ball --method located"


# One that is at work in a loop of C, and one whose processes are
TWICE = itertools.product(["simulate", "hard", "bifurcation", "map"], [0.0, 0.02, 0.2])


@pytest.mark.parametrize("case", shared(TWICE, 6), ids=str)
def test_a_second_one_ends_at_once_without_a_traceback(case, tmp_path):
    command, between = case
    words = [command, *LONG[command].split()]
    _, err, seconds = interrupted(words, tmp_path, AFTER, again=between)
    assert seconds < LIMIT
    assert "interrupted" in err
    assert not list(tmp_path.rglob("*.partial*"))


@pytest.mark.parametrize("loop", shared(SLOW_LOOPS, 4))
def test_no_loop_keeps_python_from_hearing(loop, tmp_path):
    _, err, seconds = interrupted(SLOW_LOOPS[loop].split(), tmp_path, AFTER)
    assert seconds < LIMIT
    assert said(err, "kept") == "nothing"


@pytest.mark.slow
def test_a_motion_that_is_interrupted_is_saved_as_far_as_it_came(tmp_path):
    words = ["simulate", *LONG["simulate"].split()]
    _, err, seconds = interrupted(words, tmp_path, AFTER)
    assert seconds < LIMIT
    assert said(err, "kept") == "motion.npz"
    assert "interrupted at t = " in err
    with np.load(tmp_path / "motion.npz") as saved:
        assert 0.0 < saved["t"][-1] < 100.0
    assert said(err, "start again with").endswith(
        "--out motion --overwrite"
    )  # which would be refused without


@pytest.mark.parametrize("name", ["motion.npz", "motion.nc", "motion.csv"])
def test_a_motion_is_saved_over_another_where_it_is_asked_to_be(name, tmp_path, capsys):
    words = ["simulate", "bouncing-ball", "--h", "0.1", "--out", str(tmp_path / name)]
    assert cli.main(words) == 0
    before = (tmp_path / name).read_bytes()
    assert cli.main([*words, "--t-end", "0.5"]) == 2
    assert "exists already; --overwrite replaces it" in capsys.readouterr().err
    assert (tmp_path / name).read_bytes() == before
    assert cli.main([*words, "--t-end", "0.5", "--overwrite"]) == 0
    assert (tmp_path / name).read_bytes() != before


@pytest.mark.slow
def test_the_command_that_is_told_goes_on_from_there(tmp_path, monkeypatch):
    words = "bifurcation cam-follower --window 660-760 --points 100 --drop 6000 --jobs 1"
    _, err, _ = interrupted(words.split(), tmp_path, "part-*.npz")
    assert "finished parts in out/parts" in said(err, "kept")
    parts = {file: file.stat().st_mtime_ns for file in tmp_path.rglob("part-*.npz")}
    monkeypatch.setattr("lcpstep.cli.studies.shutil.rmtree", lambda folder, **_: None)
    monkeypatch.chdir(tmp_path)
    assert cli.main(shlex.split(said(err, "go on with"))[1:]) == 0
    assert parts
    assert {file: file.stat().st_mtime_ns for file in parts} == parts
