"""Contacts that strike alike in two runs are matched together, the others one by one: with the same answer."""

import math

import numpy as np
import pytest

from lcpstep.errorbar import blows, matching
from lcpstep.errorbar import partners as module
from lcpstep.errorbar.matching import Log, summary
from lcpstep.errorbar.pairs import Pairs, one_to_one
from lcpstep.errorbar.partners import partners
from lcpstep.trajectory import IMPACT_DTYPE, Kind
from tests.uncompiled import kernels

RESOLUTION = 1e-9


def log(rng, n, contacts):
    """Impacts at random, in their order."""
    found = np.zeros(n, dtype=IMPACT_DTYPE)
    found["time"], found["contact"] = np.sort(rng.uniform(0.0, 10.0, n)), rng.integers(0, contacts, n)
    found["after"] = rng.uniform(0.1, 1.0, n)
    found["before"], found["impulse"] = -found["after"], 2.0 * found["after"]
    return found


def other(rng, given, late, lost):
    """The same impacts a little earlier or later, without some of them."""
    found = given[rng.uniform(size=len(given)) >= lost].copy()
    found["time"] += late * rng.normal(size=len(found))
    return found[np.argsort(found["time"], kind="stable")]


@pytest.mark.parametrize("late", [0.0, 1e-12, 1e-6, 1e-3])
@pytest.mark.parametrize("lost", [0.0, 0.01])
@pytest.mark.parametrize("seed", range(5))
def test_matching_together_finds_what_matching_one_by_one_does(monkeypatch, late, lost, seed):
    rng = np.random.default_rng([seed, int(1e6 * late), int(100 * lost)])
    a = log(rng, 200, 7)
    b = other(rng, a, late, lost)
    fast = partners(a, b, 10.0, RESOLUTION)
    told, rest = together(a, b)
    everywhere = Pairs.none(), np.unique(np.concatenate([a["contact"], b["contact"]]))
    monkeypatch.setattr(module, "one_to_one", lambda *_: everywhere)
    slow = partners(a, b, 10.0, RESOLUTION)
    assert (fast.differs, fast.reason) == (slow.differs, slow.reason)
    for name in ("time", "impulse", "jump", "weak"):
        one, all_ones = (np.sort(getattr(x.pairs, name)) for x in (fast, slow))
        assert np.array_equal(one, all_ones)
    if late < 1e-3 and lost == 0.0:
        assert len(told.time) == 200 or late > 0.0
    assert len(told.time) + np.isin(a["contact"], rest).sum() == 200


def together(a, b):
    logs = Log(a, 10.0), Log(b, 10.0)
    return one_to_one(*logs, summary(*logs)[0], 0.0, RESOLUTION)


def test_chattering_that_ends_and_contacts_of_one_log_alone_are_left_to_the_other_way():
    a = log(np.random.default_rng(1), 20, 3)
    b = a.copy()
    a["kind"][a["contact"] == 1] = Kind.ACCUMULATION
    told, rest = together(a, b)
    assert rest.tolist() == [1]
    assert set(a["contact"][told.rows]) == {0, 2}
    nothing, none = together(a[:0], b[:0])
    assert (len(nothing.time), len(none)) == (0, 0)
    assert math.isinf(partners(a[:0], b[:0], 1.0, 1e-9).differs)


def test_kernels_match_uncompiled_as_compiled():
    plain = kernels("lcpstep.errorbar")
    rng = np.random.default_rng(7)
    a = log(rng, 60, 3)
    a["kind"][::13] = Kind.ACCUMULATION
    b = other(rng, a, 1e-2, 0.05)
    found = []
    for m, one in ((matching, blows), (plain.matching, plain.blows)):
        logs = m.Log(a, 9.0), m.Log(b, 9.0)
        most, largest, chatters = m.summary(*logs)
        rows, good, late = m.paired(*logs, most)
        told = m.without_doubt(*logs, rows, good, 1.0, 0.0, 1e-9)
        alone = [x for c in range(3) for x in one.matched(*logs, c, 0.1, 0.05)]
        found.append([[most, largest, chatters], rows, good, late, *told, *alone])
    for x, y in zip(*found, strict=True):
        assert np.array_equal(x, y)
