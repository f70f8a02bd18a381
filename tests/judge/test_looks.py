"""The judge looks at the states of a run once, and for what is dear only where something is suspected."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.judge import graze
from benchmarks.judge.agree import Reference, agrees
from benchmarks.judge.checks import between
from benchmarks.judge.graze import grazes
from benchmarks.judge.runs import run
from benchmarks.judge.told import before, look_up, looks, told_until, whole
from benchmarks.judge.variants import Variant
from benchmarks.judge.vary import base, same
from lcpstep.stepping.pieces.run import Again
from tests.judge.test_judge import CORNER

DEAR = ("located-4", "located-4-tolerance")  # whose kept states do not tell those between


@pytest.fixture
def again(monkeypatch):
    """Numbers of times at which runs were asked again for states between their steps."""
    asked, answer = [], Again.__call__

    def counted(self, times):
        asked.append(len(times))
        return answer(self, times)

    monkeypatch.setattr(Again, "__call__", counted)
    return asked


@pytest.mark.parametrize("method", DEAR)
def test_a_run_is_made_again_once_for_all_that_is_asked_of_it(method, again):
    reference = Reference(CORNER, run(CORNER, "event-driven"))
    r = run(CORNER, method)
    look_up(CORNER, r, looks(CORNER, float(r.motion.t[-1])))
    assert list(between(CORNER, r)) == []
    assert agrees(reference, r) == []
    assert len(again) == 2  # of this run, and of the one with a finer step or tolerance


@pytest.mark.parametrize("method", DEAR)
def test_states_looked_up_at_once_are_those_of_single_looks(method):
    r, single = run(CORNER, method), run(CORNER, method)
    times = looks(CORNER, CORNER.t_span[1])
    look_up(CORNER, r, times)
    for each in (times, whole(r), before(CORNER, r)):
        for x, y in zip(r.at(each), single.motion.at(each), strict=True):
            assert np.array_equal(x, y)
    assert told_until(CORNER, r) == told_until(CORNER, single)


def test_times_that_a_run_does_not_reach_are_told_by_who_asks_for_them():
    r = run(CORNER, "located-4")
    late = np.array([CORNER.t_span[1] + 1.0])
    r.ask(whole(r), late)
    with pytest.raises(ValueError, match="within"):
        r.at(late)
    assert np.array_equal(r.at(whole(r))[0], r.motion.at(whole(r))[0])


def test_grazes_are_sought_where_something_is_suspected(monkeypatch):
    sought = []
    monkeypatch.setattr("benchmarks.judge.vary.grazes", lambda *x: sought.append(1) or grazes(*x))
    r = run(CORNER, "located")
    b = base(CORNER, r)
    assert list(same(b, run(CORNER, "located"), Variant("the same", CORNER))) == []
    assert sought == []
    other = replace(CORNER, restitution=(0.5, 0.4))
    assert list(same(b, run(other, "located"), Variant("another", other))) != []
    assert sought == [1]


def test_falls_from_afar_are_those_found_sample_by_sample():
    rng = np.random.default_rng(1)
    for _ in range(100):
        g, u, far = rng.normal(size=(3, 40, 2))
        ends = (u[:-1] < -0.1) & (u[1:] >= -0.1)
        afar = g > far
        for k in range(1, len(g)):
            afar[k] |= afar[k - 1] & ~ends[k - 1]
        assert np.array_equal(graze._returns(g, u, far, 0.1), ends & afar[:-1])
