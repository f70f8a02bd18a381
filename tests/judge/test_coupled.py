"""Scenes of bodies whose contacts hang together, before the judge."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge.coupled import case
from benchmarks.judge.coupled.case import judged
from benchmarks.judge.coupled.scenes import FAMILIES, Coupled, coupled
from benchmarks.judge.pool import answers
from benchmarks.judge.runs import lines, run
from tests.marks import shared

QUICK = "event-driven", "located", "moreau"


def test_they_are_of_all_families_and_printed_as_python():
    drawn = [coupled(2, k) for k in range(30)]
    assert {d.family for d in drawn} == set(FAMILIES)
    for d in drawn:
        assert eval(repr(d), {"Coupled": Coupled}) == d
    read = {}
    exec(lines(drawn[0], "event-driven").partition("motion")[0], read)
    np.testing.assert_array_equal(read["d"].scene().q0, drawn[0].scene().q0)


@pytest.mark.parametrize("family", sorted(FAMILIES))
def test_starts_are_moved_by_so_much_and_joints_hold(family):
    d = Coupled(family, (3, 1))
    moved = replace(d, moved=1e-6, way=2).scene()
    assert 1e-7 < np.max(np.abs(moved.q0 - d.scene().q0)) < 1e-5
    assert run(replace(d, moved=1e-6), "event-driven").done


def test_what_rounding_decides_is_found_and_what_grows_steadily_is_not(monkeypatch):
    """A run that turns off by 1 mm where the last bit of its start is odd, and one that grows errors by 1e9."""
    d, true = Coupled("rods", 4), run

    def turned(off):
        def run(d, name, factor=1.0, keep=1):
            r = true(d, name, factor, keep)
            r.motion.q[r.motion.t > 0.5] += off(d)
            return r

        return run

    for off, kinds in (
        (lambda d: 1e-3 * (d.way == 1), {"parts by rounding"}),
        (lambda d: 1e9 * d.moved, set()),
    ):
        monkeypatch.setattr(case, "run", turned(off))
        assert {x.kind for x in judged(d, ("event-driven",)).findings} == kinds


def test_workers_judge_them():
    (answer,) = answers([(0, Coupled("rods", (5, 0)))], ["event-driven", "moreau"], 1)
    assert answer.endings == {"event-driven": "DONE", "moreau": "DONE"}
    assert answer.findings == []


@pytest.mark.parametrize("first", shared(range(0, 60, 6), 10))
def test_random_scenes(first):
    assert [(k, x) for k in range(first, first + 6) for x in judged(coupled(1, k), QUICK).findings] == []
