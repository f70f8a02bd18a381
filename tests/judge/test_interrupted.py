"""Ctrl-C while random scenes are judged: what is known is told, and workers leave it to the one that waits."""

import os
import signal
import sys

import pytest

from benchmarks.judge import __main__ as program
from benchmarks.judge.describe import Description
from benchmarks.judge.pool import Answer, answers
from tests.judge.test_judge import BALL


def test_what_was_judged_before_an_interrupt_is_told(monkeypatch, capsys):
    """Answers come in the order in which they are ready: from the first that is missing it has to go on."""

    def interrupted(asked, *_):
        for k, d in list(asked)[:3]:
            if k != 11:
                yield Answer(k, d, {"moreau": "DONE"}, [], {})
        raise KeyboardInterrupt

    monkeypatch.setattr(program, "answers", interrupted)
    monkeypatch.setattr(sys, "argv", ["judge", "--seed", "3", "--first", "10", "--scenes", "5"])
    assert program.main() == program.INTERRUPTED
    told = capsys.readouterr().out
    assert "2 scenes." in told
    assert "| moreau | 2 | 2 |" in told
    assert told.endswith("--first 11 --scenes 4\n")


class Pressed(Description):
    """A scene during whose run somebody presses Ctrl-C at the terminal."""

    def scene(self):
        os.kill(os.getpid(), signal.SIGINT)
        return super().scene()


@pytest.mark.slow
def test_workers_do_not_hear_an_interrupt_at_the_terminal():
    (answer,) = answers([(7, Pressed(**vars(BALL)))], ["event-driven"], 1)
    assert answer.endings == {"event-driven": "DONE"}
