"""How far loops are: told by the outermost, steadily, to whoever listens in the thread; and bars on a terminal."""

import os
import re
import select
import struct
import subprocess
import sys
import time

import pytest

from lagrangian import scenes
from lcpstep import EventDriven, Located, Moreau, pace, simulate
from lcpstep.analysis.attractors import attractors
from lcpstep.maps import StroboscopicMap, iterate, periods
from tests.marks import shared
from tests.processes import environment

CAM = scenes.cam_follower(rpm=660.0)


def heard(work):
    """What is told while something is done: shares, in their order."""
    said = []
    with pace.telling(lambda done, total: said.append(done / total)):
        work()
    return said


@pytest.mark.parametrize(
    "work",
    [
        lambda: simulate(scenes.cam_follower(t_end=20.0), EventDriven()),
        lambda: simulate(scenes.cam_follower(t_end=0.5), Moreau(1e-4)),
        lambda: simulate(scenes.cam_follower(t_end=0.5), Located(1e-3)),
        lambda: periods(CAM, EventDriven(), [[0.4, 0.4]] * 3, 50),
        lambda: periods(CAM, Moreau(1e-3), [[0.4, 0.4]] * 3, 5),
        lambda: periods(scenes.SCENES["stick-slip-oscillator"].make(amplitude=0.2), EventDriven(), [[1.0, 0.1]], 5),
        lambda: iterate(StroboscopicMap(CAM, EventDriven()), [0.4, 0.4], 20),
    ],
    ids=["events", "moreau", "located", "map", "lockstep", "modes", "iterated"],
)  # fmt: skip
def test_a_loop_tells_its_share_from_the_start_on_and_never_less_than_before(work):
    said = heard(work)
    assert said
    assert said == sorted(said)
    assert said[0] >= 0.0
    assert said[-1] <= 1.0 + 1e-12


def test_loops_within_a_counted_one_tell_of_its_items_and_never_go_back():
    def work():
        for _ in pace.counted([1, 2], weights=[1.0, 3.0]):
            iterate(lambda x: 0.5 * x, [1.0], 2)
            pace.tell(1, 4)

    assert heard(work) == [0.0, 0.0, 0.125, 0.125, 0.25, 0.25, 0.625, 0.625]


def test_a_counted_loop_that_is_left_gives_the_listener_back():
    def leave():
        for _ in pace.counted(range(9)):
            raise ValueError("enough")

    def work():
        with pytest.raises(ValueError, match="enough"):
            leave()
        pace.tell(1, 2)

    assert heard(work) == [0.0, 0.5]


def test_nobody_listens_any_more_afterwards():
    assert heard(lambda: pace.tell(1, 2)) == [0.5]
    pace.tell(1, 2)
    assert list(pace.counted("ab")) == ["a", "b"]


def test_listening_changes_no_result():
    starts = [[0.4, 0.4], [1.2, -30.0]]
    quiet = attractors(CAM, EventDriven(), starts, transient=50)
    with pace.telling(lambda done, total: None):
        told = attractors(CAM, EventDriven(), starts, transient=50)
    assert [a.name for a in told.found] == [a.name for a in quiet.found]
    assert told.found[0].cloud.tobytes() == quiet.found[0].cloud.tobytes()


BARS = 10


def left(written):
    """The texts that tell of time left."""
    return [text for text in written if re.search(r"<(\d\d:\d\d)", text)]


def on_terminal(*words, seconds):
    """What a command writes to a terminal; it is ended after some seconds, or as soon as that has enough bars."""
    fcntl, pty, termios = (pytest.importorskip(name) for name in ("fcntl", "pty", "termios"))
    master, slave = pty.openpty()
    fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
    command = [sys.executable, "-m", "lcpstep.cli", *words]
    process = subprocess.Popen(command, env=environment(), stdout=slave, stderr=slave, stdin=slave)
    os.close(slave)
    written, end = [], time.monotonic() + seconds
    while time.monotonic() < end and len(left(written)) < BARS:
        if not select.select([master], [], [], 0.1)[0]:  # a silent one is not waited for
            continue
        try:
            text = os.read(master, 4096).decode(errors="replace")
        except OSError:  # its end is closed
            break
        if not text:
            break
        written.append(text)
    process.terminate()
    process.wait()
    os.close(master)
    return written


@pytest.mark.parametrize(
    "words",
    shared(
        [
            ["simulate", "cam-follower", "--h", "1e-6", "--t-end", "20"],
            ["attractor", "cam-follower", "--method", "moreau", "--starts", "200", "--out", "{out}"],
            ["orbit", "cam-follower", "--rpm", "700", "--method", "moreau", "--h", "1e-6", "--out", "{out}"],
            ["study", "cam-follower", "--out", "{out}"],
            ["lyapunov", "cam-follower", "--periods", "3000000"],
            ["corner", "cam-follower", "--out", "{out}"],
            ["corner", "cam-follower", "--chattering", "114", "200"],
            ["basin", "cam-follower", "--rpm", "660", "--method", "moreau", "--h", "1e-5", "--out", "{out}"],
            ["hard", "--full"],
            ["thesis", "4.5", "4.12", "--out", "{out}"],
        ],
        5,
    ),
    ids=lambda words: words[0],
)
def test_a_bar_on_a_terminal_shows_the_time_left(words, tmp_path):
    written = on_terminal(*(w.format(out=tmp_path) for w in words), seconds=12.0)
    assert len(left(written)) >= BARS, written[-3:]


def test_progress_rises_to_the_end():
    for method in (Moreau(1e-5), EventDriven()):
        times = []
        simulate(scenes.impact_oscillator(t_end=5.0), method, progress=times.append)
        assert times == sorted(times)
        assert times[-1] == pytest.approx(5.0, rel=1e-12)


def test_an_error_of_the_progress_callback_is_not_swallowed():
    def broken(t):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        simulate(scenes.bouncing_ball(), Moreau(1e-2), progress=broken)
