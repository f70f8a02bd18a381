"""Scenes as people write them, before the judge."""

import pytest

from benchmarks.judge.case import judged
from benchmarks.judge.describe import Description
from benchmarks.judge.runs import WAYS, run
from benchmarks.judge.tidy import FAMILIES, tidy
from tests.judge.test_scenes import QUICK, new
from tests.marks import shared


def test_they_are_of_all_families_and_printed_as_python():
    drawn = [tidy(2, k) for k in range(100)]
    assert {d.family for d in drawn} == set(FAMILIES)
    for k, d in enumerate(drawn):
        assert eval(repr(d), {"Description": Description}) == d == tidy(2, k)


def test_they_begin_outside_of_obstacles():
    for k in range(100):
        assert run(tidy(3, k), "event-driven").status != "refused"


def test_twenty_scenes():
    assert [(k, x) for k in range(20) for x in new(judged(tidy(5, k), QUICK, share=0.1).findings)] == []


@pytest.mark.parametrize("first", shared(range(0, 400, 20), 10))
def test_some_hundred_scenes_by_every_method(first):
    numbers = range(first, first + 20)
    assert [(k, x) for k in numbers for x in new(judged(tidy(1, k), tuple(WAYS), share=0.1).findings)] == []
