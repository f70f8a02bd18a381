"""Contacts that strike alike in two runs are matched together, the others one by one: with the same answer."""

import math

import numpy as np
import pytest

from lcpstep.errorbar import partners as module
from lcpstep.errorbar.pairs import Pairs, one_to_one
from lcpstep.errorbar.partners import partners
from lcpstep.trajectory import IMPACT_DTYPE, Kind

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
    told, rest = one_to_one((a, b), *_struck(a, b), 0.0, RESOLUTION)
    monkeypatch.setattr(module, "one_to_one", lambda logs, *_: (Pairs.none(), np.unique(logs[0]["contact"])))
    slow = partners(a, b, 10.0, RESOLUTION)
    assert (fast.differs, fast.reason) == (slow.differs, slow.reason)
    for name in ("time", "impulse", "jump", "weak"):
        one, all_ones = (np.sort(getattr(x.pairs, name)) for x in (fast, slow))
        assert np.array_equal(one, all_ones)
    if late < 1e-3 and lost == 0.0:
        assert len(told.time) == 200 or late > 0.0
    assert len(told.time) + np.isin(a["contact"], rest).sum() == 200


def _struck(a, b):
    jumps = [np.abs(x["after"] - x["before"]) for x in (a, b)]
    return [np.arange(len(x)) for x in (a, b)], jumps


def test_chattering_that_ends_and_contacts_of_one_log_alone_are_left_to_the_other_way():
    a = log(np.random.default_rng(1), 20, 3)
    b = a.copy()
    a["kind"][a["contact"] == 1] = Kind.ACCUMULATION
    struck, jumps = _struck(a, b)
    struck[0] = np.flatnonzero(a["kind"] == Kind.IMPACT)
    told, rest = one_to_one((a, b), struck, jumps, 0.0, RESOLUTION)
    assert rest.tolist() == [1]
    assert set(a["contact"][told.rows]) == {0, 2}
    nothing, none = one_to_one((a[:0], b[:0]), [struck[0][:0]] * 2, [jumps[0][:0]] * 2, 0.0, RESOLUTION)
    assert (len(nothing.time), len(none), math.isinf(partners(a[:0], b[:0], 1.0, 1e-9).differs)) == (
        0,
        0,
        True,
    )
